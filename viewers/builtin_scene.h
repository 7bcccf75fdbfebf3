// The scene that `sightline analyse` takes when none is named: examples/scenes/room.obj,
// compiled in.

#pragma once

#include <string_view>

namespace sightline::viewers {

/// The file's name and its bytes.
inline constexpr std::string_view kBuiltinSceneName = "room.obj";
[[nodiscard]] std::string_view builtin_scene();
/// The group of it that is a light.
inline constexpr std::string_view kBuiltinSceneLight = "lamp_shade";

}  // namespace sightline::viewers
