// The sections of the page that tell of light: shadows, and form factors.

#pragma once

#include <string>
#include <vector>

#include "viewers/page.h"

namespace sightline::viewers {

/// Areas and meshes by group, below the pictures; empty where the report has no such
/// part.
[[nodiscard]] std::string shadows_section(const Json& report,
                                          const std::vector<PagePicture>& pictures);

/// The matrix, each factor the darker the larger, and where the rest of each row goes;
/// empty where the report has no such part.
[[nodiscard]] std::string factors_section(const Json& report);

}  // namespace sightline::viewers
