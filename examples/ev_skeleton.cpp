// Where the view of a scene changes: its EV skeleton, counted by kind, and one arc
// with its corner and edge.  One task, top to bottom.

#include <cstdio>
#include <map>
#include <string>

#include "linespace/mesh_io.h"
#include "linespace/scene.h"
#include "skeleton/build.h"

int main(int argc, char** argv) {
  // A file becomes a scene once, validated; from then on it is immutable.
  const std::string file = argc > 1 ? argv[1] : "examples/scenes/room.obj";
  const sightline::Scene scene(sightline::read_mesh(file));

  // EV arcs only, of the whole scene, exact, on all cores; the request may also name a
  // region, a budget, ...
  sightline::SkeletonRequest request;
  request.eee = false;
  const sightline::Skeleton skeleton = sightline::build_skeleton(scene, request);

  // Nodes at which the line ends on a corner, rather than grazes it, are told apart.
  using Kind = sightline::NodeKind;
  std::map<Kind, int> grazing;
  int ending = 0;
  for (const auto& node : skeleton.nodes) {
    node.end ? ++ending : ++grazing[node.kind];
  }
  std::printf("%s: %zu faces, %zu EV arcs\n", file.c_str(), scene.faces().size(),
              skeleton.ev().size());
  std::printf("VV %d, VEE %d, EVE %d, FvE %d, degenerate %d, ending %d\n",
              grazing[Kind::VV], grazing[Kind::VEE], grazing[Kind::EVE],
              grazing[Kind::FvE], grazing[Kind::Degenerate], ending);

  // Every arc knows its generators: here a corner and an edge of which it sees a part.
  if (skeleton.ev().empty()) return 1;
  const auto& arc = skeleton.ev().front();
  const auto& vertex = scene.point(arc.vertex());
  std::printf("the corner (%g %g %g) sees edge %d from %g to %g\n", vertex.x(),
              vertex.y(), vertex.z(), arc.edge(), arc.range[0], arc.range[1]);
  return skeleton.complete ? 0 : 1;
}
