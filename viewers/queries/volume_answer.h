// Shadow volumes, and blockers that a feature size leaves out, as JSON and in words.

#pragma once

#include <string>
#include <vector>

#include "shadows/shadow_volumes.h"
#include "shadows/small_blockers.h"
#include "viewers/answer.h"

namespace sightline::viewers {

/// "umbra" and "penumbra": {"volume", "vertices", "sides": [{"kind", "generators",
/// "corners"}]}, the second with the outer surface, its volume without the umbra;
/// "lit_volume", "away_volume", "solid_volume".
[[nodiscard]] Json volumes_json(const ShadowVolumes& volumes);
/// A line for people.
[[nodiscard]] std::string told(const ShadowVolumes& volumes);

/// What `--feature-size` left out of the receivers' scene.
struct LeftOut {
  double feature_size = 0;
  std::vector<SmallPart> parts = {};
  double bound = 0;  ///< of the form factor's change
  /// As `--without` names them: "#i-j".
  [[nodiscard]] std::vector<std::string> names() const;
};
/// Adds "feature_size", "left_out": [{"group", "polygons", "diagonal"}] and
/// "form_factor_error_bound".
void add_left_out(Json& answer, const Scene& scene, const LeftOut& left_out);
[[nodiscard]] std::string told(const LeftOut& left_out);

}  // namespace sightline::viewers
