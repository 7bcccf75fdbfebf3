// A viewpoint walks through a scene: which visual events it crosses, in order, and which
// of them still separate the two ends.  One task, top to bottom.

#include <cstdio>
#include <string>

#include "linespace/mesh_io.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/end_index.h"
#include "skeleton/view_events.h"

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : "examples/scenes/room.obj";
  const sightline::Scene scene(sightline::read_mesh(file));
  const sightline::Skeleton skeleton = sightline::build_skeleton(scene);

  // What all arcs' lines end on, once; then every question is a look-up.
  const sightline::EndIndex ends(scene, skeleton);
  const sightline::ViewEvents events(scene, skeleton, ends);

  const sightline::Point from{1, 1, 1}, to{2, 2, 1.5};
  const auto crossed = events.crossed(from, to);
  for (const auto& event : crossed) {
    std::printf("%s u = %.6f  ", event.tie ? "=" : " ", event.u);
    switch (event.kind) {
      case sightline::EventKind::EV: {
        const auto& arc = skeleton.arcs[event.id];
        std::printf("EV: vertex %d and edge %d line up\n", arc.vertex(), arc.edge());
        break;
      }
      case sightline::EventKind::EEE: {
        const auto& e = skeleton.arcs[event.id].edges();
        std::printf("EEE: edges %d, %d, %d cross in one point\n", e[0], e[1], e[2]);
        break;
      }
      case sightline::EventKind::F:
        std::printf("F: facet %u turns\n", event.id);
        break;
    }
  }
  std::printf("%zu events, %zu of which separate the two views\n", crossed.size(),
              events.separating(from, to).size());

  // All events that a facet sees, for the one that sees most.
  int best = 0;
  for (int f = 0; f < static_cast<int>(scene.facets().size()); ++f) {
    if (ends.seen_from(f).size() > ends.seen_from(best).size()) best = f;
  }
  std::printf("facet %d of %s sees %zu events\n", best,
              scene.objects()[scene.facets()[best].object].name.c_str(),
              ends.seen_from(best).size());
  return crossed.empty() ? 1 : 0;
}
