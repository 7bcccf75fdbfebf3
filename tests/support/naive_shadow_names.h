// What the borders of what a point sees of a light may lie on, with one name for what is
// one edge: for naive_shadow.h's .cpp files only.

#pragma once

#include <map>
#include <optional>
#include <vector>

#include "tests/support/naive_shadow_rays.h"

namespace sightline::testing {

/// A line in space: its direction and its moment, canonical.
struct SpaceLine {
  std::array<Integer, 6> at;
  friend bool operator<(const SpaceLine& a, const SpaceLine& b) { return a.at < b.at; }
};
[[nodiscard]] SpaceLine line_through(const Vec3& a, const Vec3& b);

class SideNames {
 public:
  explicit SideNames(const std::vector<NaiveShadowFace>& faces);

  /// What the side from a to b of a face is at its inner point x: an edge of the scene or
  /// of a light's outline, a fold of a bent polygon, or nothing.
  [[nodiscard]] std::optional<NaiveSideName> name(int face, const Vec3& a, const Vec3& b,
                                                  const Vec3& x) const;
  /// x is on the outline of the light of which the face is a part.
  [[nodiscard]] bool on_outline(int face, const Vec3& a, const Vec3& b,
                                const Vec3& x) const;

 private:
  enum class What { Edge, Fold, Nothing };
  [[nodiscard]] What what(int face, const Vec3& a, const Vec3& b, const Vec3& x) const;

  const std::vector<NaiveShadowFace>& faces_;
  std::vector<std::vector<int>> coplanar_;  ///< others in the plane of a face
  std::map<SpaceLine, std::vector<std::array<Vec3, 2>>> edges_;  ///< joined
};

}  // namespace sightline::testing
