// The whole lines of a skeleton: all contacts in order along the maximal free segment,
// and what ends it on either side.  Exact, and found only where somebody asks.

#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "linespace/exact_position.h"
#include "linespace/occlusion.h"
#include "skeleton/graph.h"

namespace sightline {

/// Keeps a reference to the scene.  Immutable once built; safe to share between threads.
class SkeletonLines {
 public:
  /// Hears the request's budget, stop, progress and threads.  Throws Stopped.
  explicit SkeletonLines(const Scene& scene, const Request& request = {});
  ~SkeletonLines();
  SkeletonLines(SkeletonLines&&) noexcept;

  /// The line of an arc at a parameter s strictly inside its range, exactly.  EV: through
  /// the vertex (position 0) and the point of the edge at s (position 1).  EEE: through
  /// the point of the first edge at s (position 0), the middle edge, and the last edge
  /// (position 1); nullopt when the plane of that point and the middle edge is parallel
  /// to the last edge, which happens only outside the arc.  Where an outer contact is an
  /// end contact the free segment ends there, and it is the first or the last of the
  /// contacts, blocked.  Cost: some 10 microseconds.
  [[nodiscard]] std::optional<FreeSegment> line(const SkeletonArc& arc, double s) const;

  /// The points of line(arc, s) at positions 0 and 1, exactly.  Of s with few digits they
  /// have few.  nullopt where line(arc, s) is.
  [[nodiscard]] std::optional<std::array<ExactPosition, 2>> points(const SkeletonArc& arc,
                                                                   double s) const;
  /// Two points of a node's line, exactly; nullopt where its generators do not tell the
  /// line (as in line() below), and where it has no rational points.
  [[nodiscard]] std::optional<std::array<ExactPosition, 2>> points(
      const Skeleton& skeleton, const SkeletonNode& node) const;

  /// A part of an arc whose lines have the same faces at both far ends.
  struct Piece {
    std::array<double, 2> range;  ///< parameters along the (first) edge, rounded
    FreeSegment line;             ///< at the middle of the range
  };
  /// The parts of an arc in order.  Parts shorter than 2^-38 of the edge may be left out
  /// (a neighbour's range then covers theirs).  Cost: EV about a millisecond, more where
  /// many faces meet the arc's plane; EEE some 10 microseconds a piece and what ends()
  /// costs.
  [[nodiscard]] std::vector<Piece> pieces(const SkeletonArc& arc) const;

  /// A piece without its line: the faces touched by the contact that ends it, before the
  /// first contact (position 0) and beyond the last; empty for the outside.  An end
  /// contact ends its lines itself.
  struct EndPiece {
    std::array<double, 2> range;
    std::array<std::vector<int>, 2> faces;
    /// Certain that no line of the arc goes on farther than this and the neighbouring
    /// pieces say, the lines where two pieces meet and those at the arc's ends included:
    /// these may graze past both in degenerate positions.
    bool bounds_all = false;
  };
  /// What pieces() says of the far ends.  Cost: some 10 microseconds where no sign is
  /// zero; else that of pieces() on every part where anything could change.
  [[nodiscard]] std::vector<EndPiece> ends(const SkeletonArc& arc) const;

  /// The line of a node of any kind, from its first contact (position 0) to its last (1):
  /// its contacts in order, each with the edges, corners and faces that it touches.
  /// Faces, order and what blocks are exact.  Positions are rounded; those of EEEE lines
  /// and others through edges alone, which are irrational, are off by at most 2^-44 times
  /// the size of the scene's coordinates, by the distance of the outer contacts, times 1
  /// + |position|.  A corner at which a line ends (`end`) is a blocked contact.
  ///
  /// nullopt for Saddle nodes and degenerate ones whose generators leave the line a
  /// choice, and where a contact blocks between the outer ones (some lines along a face
  /// that end where it does; precision Double).  In the plane of a facet that is flat
  /// only by tolerance the line may pass some of its faces an ulp away.  Cost: some 10 to
  /// 100 microseconds; a millisecond where the line is irrational.
  [[nodiscard]] std::optional<FreeSegment> line(const Skeleton& skeleton,
                                                const SkeletonNode& node) const;

 private:
  [[nodiscard]] std::vector<Piece> ev_pieces(const SkeletonArc& arc) const;
  [[nodiscard]] std::vector<Piece> eee_pieces(const SkeletonArc& arc) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
