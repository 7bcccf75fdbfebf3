// What is drawn at a point of an edge, or at a corner, for an eye in a given direction:
// the rule of docs/polygon_mode.md, "One rule", from the faces around the point alone.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

/// An eye at an exact point; sides of planes are looked at in double first.
class Eye {
 public:
  explicit Eye(ExactPoint at);
  /// Sign of orient3d(a, b, c, eye).
  [[nodiscard]] Sign side(const Point& a, const Point& b, const Point& c) const;

 private:
  ExactPoint at_;
  Point rounded_;
  double error_;
};

/// The faces around the points of an edge, as half-planes that begin there, and the
/// *sectors* between neighbouring ones.
class EdgeFan {
 public:
  /// Which part of a turn a sector fills: less than half, half, more than half (or all).
  enum class Turn : std::uint8_t { Narrow, Flat, Wide };
  struct Leaf {
    std::int32_t third;  ///< a point of the half-plane
    std::int32_t facet;
    /// Inside a closed object: next to it counter-clockwise (seen against e0 e1),
    /// clockwise.
    bool solid_after, solid_before;
    bool own;  ///< a face of the edge itself, not of another one there
  };
  /// From one leaf counter-clockwise to the next.
  struct Sector {
    int from, to;
    Turn turn;
    bool free;  ///< not inside a closed object, as far as the faces here tell
  };

  EdgeFan(const Silhouettes& silhouettes, const Point& e0, const Point& e1);
  /// Adds a face in a plane with the edge's line: one half-plane where the line runs
  /// along its side, two where inside.  Others are met in a point, and left out.
  void add(int face, bool own = true);
  /// Adds the half-plane of a face's plane with that point.
  void add_half(int face, std::int32_t third, bool own = true);
  /// To be called when all faces are added: leaves in one half-plane become one.
  void close();

  [[nodiscard]] std::span<const Leaf> leaves() const { return leaves_; }
  [[nodiscard]] std::span<const Sector> sectors() const { return sectors_; }
  /// How the line to an eye that is not on the edge's line meets it; None where nothing
  /// is drawn, none of the faces seen there is the edge's own, or the eye is inside.
  [[nodiscard]] EdgeContact contact(const Eye& eye) const {
    return look(eye).value_or(EdgeContact::None);
  }
  [[nodiscard]] bool from_inside(const Eye& eye) const { return !look(eye); }
  /// Lines along a leaf from its side end at the edge: no gap on either side of it.
  [[nodiscard]] bool ends_along(int leaf) const;

 private:
  enum class Angle : std::uint8_t { Same, FirstHalf, Opposite, SecondHalf };
  [[nodiscard]] std::optional<EdgeContact> look(const Eye& eye) const;
  [[nodiscard]] Angle angle(const Leaf& from, const Leaf& to) const;
  [[nodiscard]] bool before(const Leaf& a, const Leaf& b) const;

  const Silhouettes& g_;
  const Scene& scene_;
  Point e0_, e1_;
  std::vector<Leaf> leaves_;
  std::vector<Sector> sectors_;
};

/// Whether the end contact of a line with the ridge, at 0 or at 1 (`last`) of the scan's
/// line, is drawn for an eye on that line, all faces there considered.
[[nodiscard]] bool drawn_end(const Silhouettes& silhouettes, const Ridge& ridge,
                             const LineScan& scan, bool last, const Eye& eye);

/// Whether a corner at which the line to the eye ends is seen as one: the lines drawn
/// there are neither none nor one straight line, and the eye is outside all solids there.
/// True from outside where the line lies in the plane of a face at the corner.
/// Cost: the cube of the number of edges there, some of it exact.
[[nodiscard]] bool drawn_corner(const Silhouettes& silhouettes, const Star& star,
                                const Eye& eye);

}  // namespace sightline::internal
