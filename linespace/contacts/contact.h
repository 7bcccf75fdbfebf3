// The one contact test: how a line given by exact points meets a set of faces, contact by
// contact, and whether each contact blocks or only grazes.
// For occlusion.cpp and the skeleton; CGAL's numbers stay below the public headers.
// The definitions, with a picture and a test for each case, are in docs/contacts.md.

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/occlusion.h"

namespace sightline::internal {

/// All contacts of the *whole line* through two points a != b with the given faces, kept
/// so that parts of the line can be judged on their own.  Touching faces are grouped by
/// geometry, whatever object they are of.  Keeps a reference to the scene.  Positions are
/// parameters t of a + t (b - a).
/// Cost: about 20 ns for a face that a floating-point filter rejects, a microsecond of
/// exact arithmetic for one that is met.
class LineScan {
 public:
  /// `faces`: each once; any superset of those that the line meets where it is of
  /// interest.
  LineScan(const Scene& scene, std::span<const int> faces, const ExactPoint& a,
           const ExactPoint& b);
  /// The same without rationals in the signs.
  LineScan(const Scene& scene, std::span<const int> faces, const Point& a,
           const Point& b);
  ~LineScan();
  LineScan(LineScan&&) noexcept;

  /// Number of contacts; they are numbered in order along the line.
  [[nodiscard]] int size() const;
  [[nodiscard]] const Rational& from(int contact) const;
  [[nodiscard]] const Rational& to(int contact) const;
  /// Signs of from(contact) - s and to(contact) - s for s = 0 or 1, where the two points
  /// are: mostly without the exact numbers.
  [[nodiscard]] int from_against(int contact, int s) const;
  [[nodiscard]] int to_against(int contact, int s) const;
  /// from(contact) == to(contact), as of most.
  [[nodiscard]] bool is_point(int contact) const;
  /// By face id, each face once.
  [[nodiscard]] std::vector<Touch> touches(int contact) const;
  /// Point ids, ascending, of the corners of its faces in a plane with the line that lie
  /// on the line: where such a face's stretch begins, ends, or has a straight corner.
  [[nodiscard]] std::vector<int> edge_on_corners(int contact) const;
  /// Faces of the contact that meet the line at exactly this position, ascending.
  [[nodiscard]] std::vector<int> faces_at(int contact, const Rational& t) const;
  /// Faces of the contact that meet the closed part [lo, hi] of the line, ascending;
  /// none: without bound.
  [[nodiscard]] std::vector<int> faces_within(int contact,
                                              const std::optional<Rational>& lo,
                                              const std::optional<Rational>& hi) const;
  /// Positions at which a face of the contact begins or ends, ascending, without repeats.
  [[nodiscard]] std::vector<Rational> instants(int contact) const;

  [[nodiscard]] bool blocked(int contact) const;
  /// Whether the contact blocks the open part (lo, hi) of the line: judged by the faces
  /// crossed strictly between and by the edge-on stretches cut to that part.
  [[nodiscard]] bool blocked_between(int contact, const Rational& lo,
                                     const Rational& hi) const;
  /// Whether the contact blocks a line that begins at lo and ends at hi.  Where lo or hi
  /// lies on faces in a plane with the line, nearby lines that are in material there do
  /// not count: a line along a wall is on the wall's free side.
  /// `solid_behind(face)`: behind the face is material.
  [[nodiscard]] bool blocked_between(int contact, const Rational& lo, const Rational& hi,
                                     const std::function<bool(int)>& solid_behind) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::internal
