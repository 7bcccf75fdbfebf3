// Uses each installed module once: a scene of two tetrahedra, what blocks a line through
// one, and how many critical line sets the pair has.

#include <linespace/occlusion.h>
#include <linespace/predicates.h>
#include <linespace/scene.h>
#include <skeleton/build.h>

#include <cstdio>
#include <utility>
#include <vector>

int main() {
  using sightline::Point;

  sightline::PolygonSoup soup;
  for (const double x : {0.0, 3.0}) {
    const int first = static_cast<int>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), {Point(x, 0, 0), Point(x + 1, 0.1, 0.2),
                                               Point(x, 1, 0.1), Point(x + 0.2, 0.3, 1)});
    for (const std::vector<int>& face : {std::vector{0, 2, 1}, std::vector{0, 1, 3},
                                         std::vector{1, 2, 3}, std::vector{2, 0, 3}}) {
      soup.polygons.push_back({first + face[0], first + face[1], first + face[2]});
    }
  }
  const sightline::Scene scene(std::move(soup));
  const sightline::OcclusionIndex index(scene);
  const sightline::Skeleton skeleton = sightline::build_skeleton(scene);

  const bool blocked = !index.is_free({-1, 0.35, 0.3}, {2, 0.35, 0.3});
  std::printf("%zu objects, %s, %zu arcs\n", scene.objects().size(),
              blocked ? "blocked" : "free", skeleton.ev().size());
  const bool as_expected =
      scene.objects().size() == 2 && blocked && !skeleton.ev().empty();
  return as_expected ? 0 : 1;
}
