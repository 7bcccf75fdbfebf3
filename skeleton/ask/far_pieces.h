// What lies at both far ends of an arc's lines, piece by piece: the faces first met
// beyond the two outer contacts, and the parameters where they change.
//
// The lines of an arc are extended beyond the outer contacts P(s) and Q(s).  A face is
// met by those lines for which all its sides have one sign: parts of the arc between
// cuts, roots of degree 1 (EV) or 2 (EEE).  Of the faces met on one side of the arc the
// nearest ends the free segment.  So the pieces are the lower envelope of these parts.
// In general position nothing else can end it; every other position is told, and left to
// the contact test.
//
// Where an outer contact is an end contact (polygon mode) the lines end in it, and
// nothing is looked for beyond it.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "linespace/sight/face_crossings.h"
#include "linespace/silhouettes/silhouettes.h"
#include "skeleton/build/edge_pair.h"
#include "skeleton/graph.h"

namespace sightline::internal {

/// A part of an arc whose lines end on one face, or nowhere, at either side.
struct FarPiece {
  /// Parameters, off by at most kRangeError.
  std::array<double, 2> range;
  /// The face on which the lines end before the first contact (an EV arc's vertex), and
  /// beyond the last.  -1 where they leave the scene; also on a side where the outer
  /// contact is an end contact: end_faces() has the faces there.
  std::array<int, 2> faces;
  /// Certain that no line of the arc goes on farther than this and the neighbouring
  /// pieces say: not one where two pieces meet either, nor one at an end of the arc.
  bool bounds_all = false;
};

/// Parts shorter than this are left out: their ends are not told apart.
inline constexpr double kShortestPiece = 4 * kRangeError;

/// Finds pieces, one arc after the other.  Keeps references; immutable.
class FarPieces {
 public:
  FarPieces(const Silhouettes& silhouettes, const Carriers& carriers,
            const FaceCrossings& crossings)
      : g_(silhouettes), carriers_(carriers), crossings_(crossings) {}

  /// The pieces in order, neighbours different; nullopt where some sign is zero all along
  /// or two faces are met in one point or cross each other, or where the faces at an end
  /// contact change along the arc: then the contacts have to be asked.
  [[nodiscard]] std::optional<std::vector<FarPiece>> of(const SkeletonArc& arc) const;

  /// The faces at the first, at the last contact, ascending, where it is an end contact;
  /// empty where it is none.  Requires that of() has an answer.
  [[nodiscard]] std::array<std::vector<int>, 2> end_faces(const SkeletonArc& arc) const;

  /// All parameters inside an EEE arc's range where its far ends can change, in order,
  /// whatever the position; its ends included.
  [[nodiscard]] std::vector<double> stops(const SkeletonArc& arc) const;

 private:
  [[nodiscard]] std::optional<std::vector<FarPiece>> of_ev(const SkeletonArc& arc) const;
  [[nodiscard]] std::optional<std::vector<FarPiece>> of_eee(const SkeletonArc& arc) const;
  template <class Family>
  void add_crossing_stops(const Family& family, std::span<const int> faces,
                          std::vector<double>& out) const;

  const Silhouettes& g_;
  const Carriers& carriers_;
  const FaceCrossings& crossings_;
};

}  // namespace sightline::internal
