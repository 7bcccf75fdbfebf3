// An interactive window for VTK files; needs a display.

#pragma once

#include <filesystem>

namespace sightline::viewers {

/// True when a window could be opened: a DISPLAY is named.
[[nodiscard]] bool has_display();

/// Shows a .vtm or .vtp file of write_vtk until the window is closed; returns at once
/// after the first frame when `once`.
void show_window(const std::filesystem::path& file, bool once = false);

}  // namespace sightline::viewers
