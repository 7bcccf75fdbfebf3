// Scenes with area lights as people have them, and points on which what they see of the
// lights is compared with the naive answer.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "linespace/scene.h"
#include "tests/support/naive_shadow.h"

namespace sightline::testing {

struct ShadowScene {
  std::string name;
  PolygonSoup soup;
  /// Groups, also `#i-j`: as `--light` and `--both-sides` name them.
  std::vector<std::string> lights, two_sided = {};
};

/// 72 scenes of 8 to 60 faces, the same on every machine.  Lights: in mid air, flush with
/// their ceiling, let into it, touching a wall, a window as part of a wall, L-shaped,
/// holed, several at once, on one another, closed lamps, bent by rounding, shining from
/// both sides.  Blockers: in general position and aligned, touching, crossing each other
/// and the light, sheets and solids, rooms.
[[nodiscard]] std::vector<ShadowScene> shadow_scenes();

/// Face ids of groups, ascending, each once.
[[nodiscard]] std::vector<int> faces_of_groups(const Scene& scene,
                                               const std::vector<std::string>& groups);

[[nodiscard]] NaiveShadow naive_shadow(const Scene& scene, const ShadowScene& lit);

struct AskedPoint {
  Vec3 at;
  std::optional<Vec3> normal;
};

/// Points in the scene's box and a little beyond, doubles; half of them on faces, as near
/// as doubles come, with the face's normal.
[[nodiscard]] std::vector<AskedPoint> random_asked_points(const Scene& scene,
                                                          std::uint64_t seed, int count);

/// Points on events, exactly: small integers, on lines through a corner and an edge,
/// through three edges, in planes of faces, on faces, edges and corners, on lines through
/// a point of an edge and a corner of another; some moved by 2^-60.
[[nodiscard]] std::vector<AskedPoint> event_asked_points(const Scene& scene,
                                                         std::uint64_t seed, int count);

}  // namespace sightline::testing
