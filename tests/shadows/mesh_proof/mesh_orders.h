// How the form factor of the face on one side of an edge, continued across, departs from
// the exact one.

#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "shadows/shadow_mesh.h"
#include "tests/shadows/mesh_proof/mesh_plane.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {

struct EdgeOrders {
  int edges = 0, points = 0;
  int left_out = 0;  ///< points without a formula, or too near to another edge
  std::array<int, kShadowEdgeKinds> by_kind{};  ///< edges
  double most_off = 0;                          ///< of a power from the order
  std::vector<std::string> differences;
  EdgeOrders& operator+=(const EdgeOrders& more);
};
std::ostream& operator<<(std::ostream& out, const EdgeOrders& orders);

/// At most `edges` edges of all objects' meshes, `points` of each.  The power is that of
/// the best line through the logarithms at 2^-8, ..., 2^-12 of the way across the face
/// beyond; those from 2^-4 on are told where it is not the order.  Left out are edges at
/// which edges in line with the horizon begin or end.
[[nodiscard]] EdgeOrders edge_orders(const ShadowScene& lit, int edges, int points,
                                     std::uint64_t seed);

}  // namespace sightline::testing
