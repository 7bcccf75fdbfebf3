// The scene that `sightline analyse` takes when none is named: examples/scenes/room.obj,
// compiled in.

#pragma once

#include <string_view>

namespace sightline::viewers {

/// The file's name and its bytes.
inline constexpr std::string_view kBuiltinSceneName = "room.obj";
[[nodiscard]] std::string_view builtin_scene();

}  // namespace sightline::viewers
