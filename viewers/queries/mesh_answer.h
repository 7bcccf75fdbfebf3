// Shadows on receivers, as JSON and as rows of a table.

#pragma once

#include <string>
#include <string_view>

#include "shadows/shadow_mesh.h"
#include "viewers/answer.h"

namespace sightline::viewers {

/// "EV", "contact", ...: the words of CONTRACT.md, section shadows.
[[nodiscard]] std::string_view name(ShadowEdgeKind kind);

/// Adds "receivers" and "mesh", the counts of all together; with_lists also what the
/// meshes are made of, and "structures", which their faces number.
void add_shadows(Json& answer, const Shadows& shadows, bool with_lists);

inline constexpr std::string_view kReceiverCsvHead =
    "receiver,area,umbra_area,penumbra_area,lit_area,away_area,area_error_bound,"
    "umbra_components,vertices,edges,faces,structures\n";
[[nodiscard]] std::string receiver_csv(const ReceiverShadows& receiver);

}  // namespace sightline::viewers
