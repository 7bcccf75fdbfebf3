// What points see of a light, as JSON and as rows of a table.

#pragma once

#include <string>
#include <string_view>

#include "shadows/light_seen.h"
#include "viewers/answer.h"
#include "viewers/queries/shadow_questions.h"

namespace sightline::viewers {

// The words of CONTRACT.md, section shadows.
[[nodiscard]] std::string_view name(ShadowClass shadow);  ///< "umbra", ...
/// "source 3", "edge 12", "cut 7" or "horizon".
[[nodiscard]] std::string told(const SeenSide& side);

/// [{"source_face", "sides": [[names in line], ...]}, ...], a boundary an item.
[[nodiscard]] Json structure_json(const std::vector<SeenBoundary>& boundaries);

/// One of "points" in the answer of `sightline shadows`.
struct ShadowJsonOptions {
  bool structure = false, gradient = false;
};
[[nodiscard]] Json shadow_json(const ShadowQuestion& question, const Backprojection& seen,
                               const ShadowJsonOptions& options);

inline constexpr std::string_view kShadowCsvHead =
    "point,x,y,z,class,visible_fraction,form_factor\n";
/// form_factor is empty without a normal; coordinates are rounded.
[[nodiscard]] std::string shadow_csv(std::size_t number, const ShadowQuestion& question,
                                     const Backprojection& seen);

}  // namespace sightline::viewers
