// What a point sees of area lights, by brute force in exact integers, written from the
// contract's definitions ("sightline shadows"), to check the module `shadows`; shares no
// code, clipping or formula with it.
//
// The rays from the point to a source face are a convex cone.  Everything is taken away
// that another face hides, face after face; what is left is a list of disjoint convex
// cones.  Their areas and form factors are added up, their borders are the structure.

#pragma once

#include <array>
#include <compare>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "linespace/scene.h"
#include "tests/support/exact.h"

namespace sightline::testing {

struct NaiveShadowFace {
  /// Convex, exactly plane, counter-clockwise seen from the front that the file gives it;
  /// some may be collinear, the first three are not.
  std::vector<Vec3> corners;
  int polygon;  ///< pieces of one polygon of the file have one number
  int object;   ///< objects may be closed; which are is found here
  bool source = false;
  bool two_sided = false;
};

/// The scene's faces as its file lists them, also where the scene has turned them.
/// sources, two_sided: face ids.
[[nodiscard]] std::vector<NaiveShadowFace> naive_shadow_faces(
    const Scene& scene, std::span<const int> sources,
    std::span<const int> two_sided = {});

enum class NaiveLight { Umbra, Penumbra, Lit };

struct NaiveLightAt {
  NaiveLight light;                        ///< exact
  long double visible_fraction;            ///< to some 1e-18
  std::optional<long double> form_factor;  ///< to some 1e-18; none without a normal
};

/// Something that a side of a boundary lies on.
struct NaiveSideName {
  /// Edge: a side of the source or an edge of the scene, those of one line that touch or
  /// overlap joined.  Cut: the line where a blocker cuts the source.
  enum class Kind { Edge, Cut, Horizon, Fold };
  Kind kind;
  /// Edge: its ends, the smaller first.  Cut: the ends of what is cut.  Fold: the ends of
  /// a diagonal of a polygon that rounding has bent.
  std::array<Vec3, 2> ends{};
  friend bool operator==(const NaiveSideName& a, const NaiveSideName& b) {
    return a.kind == b.kind && a.ends == b.ends;
  }
  friend std::weak_ordering operator<=>(const NaiveSideName& a, const NaiveSideName& b) {
    if (a.kind != b.kind) return a.kind <=> b.kind;
    return a.ends < b.ends   ? std::weak_ordering::less
           : b.ends < a.ends ? std::weak_ordering::greater
                             : std::weak_ordering::equivalent;
  }
};

/// A side of a boundary: all that it lies on, ascending.
using NaiveSide = std::vector<NaiveSideName>;

struct NaiveSeenSource {
  /// Polygons of the file that make up the source face, coplanar, facing alike and
  /// touching; ascending.
  std::vector<int> polygons;
  /// Each begins with its smallest rotation; ascending.  The seen part is on the left.
  std::vector<std::vector<NaiveSide>> boundaries;
  /// Where each side begins, rounded, and whether the one before it lies on the same
  /// line.
  struct Corner {
    Point at;
    bool straight;
  };
  std::vector<std::vector<Corner>> corners;
};

/// Immutable; safe to share between threads.
class NaiveShadow {
 public:
  explicit NaiveShadow(std::vector<NaiveShadowFace> faces);
  ~NaiveShadow();

  [[nodiscard]] NaiveLightAt at(const Vec3& p,
                                const std::optional<Vec3>& normal = {}) const;
  /// The same fraction without rounding.  nullopt where the sources that show p their
  /// fronts do not lie in parallel planes.
  [[nodiscard]] std::optional<Rational> exact_fraction(
      const Vec3& p, const std::optional<Vec3>& normal = {}) const;
  /// Source faces of which some area is seen, by their polygons.
  [[nodiscard]] std::vector<NaiveSeenSource> structure(
      const Vec3& p, const std::optional<Vec3>& normal = {}) const;

  struct Setup;

 private:
  std::unique_ptr<const Setup> setup_;
};

/// A structure as a text: equal for equal structures.
[[nodiscard]] std::string text_of(const std::vector<NaiveSeenSource>& structure);

}  // namespace sightline::testing
