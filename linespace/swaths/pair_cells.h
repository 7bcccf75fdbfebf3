// Which parts of the square of segments between two edges are certainly hidden, and which
// faces and middle edges matter in the others: found by halving it, in bounded doubles.
//
// Segments P(s)Q(t) with (s, t) in a cell [s0, s1] x [t0, t1] all pass through a convex
// occluder when those of the four corners do: from P(s0) to Q(t0) and to Q(t1) it is
// passed at two points, and the chord of these is crossed on the way to every Q(t); the
// same from P(s1); then from every Q(t) to P(s0) and P(s1).  The sides' forms and planes
// are (bi)linear on a cell, so that one sign at all corners is one sign throughout.
// Everything here is proof or "maybe": what stays undecided costs time only.

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "linespace/swaths/eee_curve.h"

namespace sightline::internal {

class PairCells {
 public:
  /// A linear function on an edge by its values at the ends, each off by `error` at most,
  /// and whether these are zero exactly.
  struct Linear {
    double at0, at1, error;
    bool zero0, zero1;
  };
  /// A side of a face as it is oriented; `middle` is its ridge, -1 for none.
  struct Side {
    const BoundedForm* form;
    std::int32_t middle;
    bool forward;
  };

  /// An outer edge: the values of its wedge's planes a and b along the other edge,
  /// whether lines touch it from behind both and from in front of both, its length, and
  /// the range of parameters outside of which no line is free.
  struct Edge {
    std::array<Linear, 2> planes;
    std::array<bool, 2> touched_on;
    double length;
    std::array<double, 2> visible{0, 1};
  };

  /// Begins a pair.
  void begin(const Edge& first, const Edge& last);
  /// A face between the edges, with its plane's values along the first and along the
  /// last; faces of one convex occluder share a number; `front_only` when segments enter
  /// the face's solid before they can leave it.
  void add_face(int face, std::int64_t occluder, bool front_only, const Linear& p,
                const Linear& q, std::span<const Side> sides);
  /// Divides the part of the square whose segments begin between s0 and s1 on the first
  /// edge; that range is the whole edge halved any number of times.  All faces must have
  /// been added.  Returns a face of the one occluder that hides the whole part, -1 if
  /// there is none.  `is_middle(ridge)` says whether a ridge may be a middle edge.
  [[nodiscard]] int divide(double s0, double s1,
                           const std::function<bool(int)>& is_middle);
  /// The part is known to be hidden by this occluder, of which all faces were added.
  void hide(double s0, double s1, std::int64_t occluder);
  /// After the last part.
  void finish();

  /// Ridges whose curves pass cells that are not proved hidden, each once.
  [[nodiscard]] std::span<const std::int32_t> middles() const { return middles_; }
  /// Replaces `faces` by those that can block lines of the curve of a form with
  /// parameters from..to on the first edge; `turned`: the form and the parameters are
  /// those of the edges in the other order.
  [[nodiscard]] bool faces_along(const BoundedForm& form, bool turned, double from,
                                 double to, std::vector<std::int32_t>& faces);

 private:
  struct Face {
    std::int32_t id;
    std::int32_t occluder;  // position in occluders_
    bool front_only;
    Linear p, q;
    std::uint32_t first_side, side_count;
  };
  struct Cell {
    double s0, s1, t0, t1;
  };
  struct Leaf {
    Cell cell;
    std::uint32_t first, count;  // in leaf_faces_
    bool hidden;
  };
  /// Sets of corners of a cell.
  struct Corners {
    unsigned closed = 0;  ///< whose segments surely pass through an occluder or touch it
    unsigned inside = 0;  ///< and surely pass its inside
  };

  [[nodiscard]] Cell visible(const Cell& cell) const;
  int visit(const Cell& cell, int depth, std::size_t begin, std::size_t end);
  [[nodiscard]] std::optional<Corners> passage(const Face& face, const Cell& cell);
  void add_leaf(const Cell& cell, std::size_t begin, int occluder);

  Edge first_{}, last_{};
  std::vector<Face> faces_;
  std::vector<Side> sides_;
  std::vector<std::int64_t> occluders_;
  std::vector<Corners> masks_;       // of occluders, in the cell at hand
  std::vector<std::int32_t> list_;   // stack of faces of the cells above
  std::vector<std::int32_t> mixed_;  // middles of the cell at hand
  std::vector<Leaf> leaves_;
  std::vector<std::int32_t> leaf_faces_;  // positions in faces_
  std::vector<std::int32_t> middles_;
  std::vector<std::uint32_t> stamps_;  // of faces_, for faces_along
  std::uint32_t stamp_ = 0;
  const std::function<bool(int)>* is_middle_ = nullptr;
};

}  // namespace sightline::internal
