// Orders of edges: the power of the distance with which the formula of the face on one
// side departs from the exact form factor.  mesh_proof_soak looks at 1,000 edges.

#include "tests/shadows/mesh_proof/mesh_orders.h"

#include <gtest/gtest.h>

#include "tests/shadows/mesh_proof/small_lit_scenes.h"

namespace sightline::testing {
namespace {

TEST(MeshOrders, FormulasDepartWithTheStatedPower) {
  EdgeOrders sum;
  int number = 0;
  for (const ShadowScene& lit : small_lit_scenes()) {
    if (number++ % 3 == 2) continue;  // aligned
    const EdgeOrders orders = edge_orders(lit, 6, 3, 1);
    for (const std::string& difference : orders.differences) ADD_FAILURE() << difference;
    sum += orders;
  }
  EXPECT_GT(sum.edges, 60);
}

}  // namespace
}  // namespace sightline::testing
