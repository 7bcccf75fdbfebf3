// All visual events of a scene, EV and EEE, counted by kind, and one EEE arc with its
// edges and the lines that it ends in.  One task, top to bottom.

#include <cstdio>
#include <map>
#include <string>

#include "linespace/mesh_io.h"
#include "linespace/scene.h"
#include "skeleton/build.h"

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : "examples/scenes/cornell.obj";
  const sightline::Scene scene(sightline::read_mesh(file));

  // Both kinds of critical line sets, with the lines at their ends shared between them.
  const sightline::Skeleton skeleton = sightline::build_skeleton(scene);

  using Kind = sightline::NodeKind;
  std::map<Kind, int> count;
  for (const auto& node : skeleton.nodes) {
    if (!node.end) ++count[node.kind];
  }
  std::printf("%s: %zu faces, %zu EV arcs, %zu EEE arcs\n", file.c_str(),
              scene.faces().size(), skeleton.ev().size(), skeleton.eee().size());
  std::printf("VV %d, VEE %d, EVE %d, EEEE %d, FvE %d, FEE %d, degenerate %d\n",
              count[Kind::VV], count[Kind::VEE], count[Kind::EVE], count[Kind::EEEE],
              count[Kind::FvE], count[Kind::FEE], count[Kind::Degenerate]);

  // An EEE arc: all lines through a stretch of its first edge, its middle and last edge.
  if (!skeleton.eee().empty()) {
    const auto& arc = skeleton.eee().front();
    std::printf("edges %d, %d, %d: from %g to %g along the first\n", arc.edges()[0],
                arc.edges()[1], arc.edges()[2], arc.range[0], arc.range[1]);
    for (const auto n : arc.nodes) {
      const auto& [a, b] = skeleton.nodes[n].segment;
      std::printf("  ends in the line (%g %g %g) to (%g %g %g)\n", a.x(), a.y(), a.z(),
                  b.x(), b.y(), b.z());
    }
  }
  return skeleton.complete ? 0 : 1;
}
