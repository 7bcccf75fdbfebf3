// What stops a line between two boxes: the blocker of a segment, and how far a line runs
// free.  One task, top to bottom.

#include <cstdio>
#include <utility>

#include "linespace/occlusion.h"
#include "linespace/scene.h"

namespace {

// Adds the box [min, max] to the soup as one group, its faces seen from outside.
void add_box(sightline::PolygonSoup& soup, const char* name, const sightline::Point& min,
             const sightline::Point& max) {
  const int v = static_cast<int>(soup.vertices.size());
  const int f = static_cast<int>(soup.polygons.size());
  for (int i = 0; i < 8; ++i) {
    soup.vertices.emplace_back((i & 1 ? max : min).x(), (i & 2 ? max : min).y(),
                               (i & 4 ? max : min).z());
  }
  constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& side : kSides) {
    soup.polygons.push_back({v + side[0], v + side[1], v + side[2], v + side[3]});
  }
  soup.groups.push_back({name, {f, f + 1, f + 2, f + 3, f + 4, f + 5}});
}

}  // namespace

int main() {
  // Two boxes, and an eye on either side of them.
  sightline::PolygonSoup soup;
  add_box(soup, "tower", {0, 0, 0}, {1, 1, 4});
  add_box(soup, "hut", {3, 0, 0}, {4, 1, 1});
  const sightline::Scene scene(std::move(soup));
  const sightline::OcclusionIndex index(scene);

  // At mid height the tower stands in the way: the blocker says which face does.
  const sightline::Point eye(-2, 0.5, 2);
  const auto blocker = index.first_blocker(eye, {6, 0.5, 2});
  if (!blocker) return 1;
  const int object = scene.faces()[blocker->touches.front().face].object;
  std::printf("blocked by %s after %g of the way\n", scene.objects()[object].name.c_str(),
              blocker->from);

  // Along the tower's roof the line grazes: it is free all the way to infinity.
  const auto free = index.maximal_free_segment({-2, 0.5, 4}, {6, 0.5, 4});
  if (!free) return 1;
  std::printf("over the roof: free from %g to %g, grazing %zu time(s)\n", free->from,
              free->to, free->contacts.size());

  const bool as_expected = scene.objects()[object].name == "tower" &&
                           blocker->from == 0.25 && free->from_faces.empty() &&
                           free->to_faces.empty() && free->contacts.size() == 1;
  return as_expected ? 0 : 1;
}
