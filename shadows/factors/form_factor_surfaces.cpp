#include "shadows/form_factor_surfaces.h"

#include <algorithm>
#include <map>

namespace sightline {

std::vector<FormFactorSurface> surfaces_of(const Scene& scene, const SurfaceWish& wish) {
  std::vector<std::string> names = wish.groups;
  if (names.empty()) {
    for (const Object& object : scene.objects()) names.push_back(object.name);
  }
  std::vector<FormFactorSurface> surfaces;
  const auto add = [&](const std::string& name, std::vector<int> faces, bool both) {
    if (faces.empty()) return;
    surfaces.push_back({name, faces, false});
    if (both) surfaces.push_back({name + "/back", std::move(faces), true});
  };
  for (const std::string& name : wish.both_sides) (void)scene.faces_named(name);
  for (const std::string& name : names) {
    const std::vector<int> faces = scene.faces_named(name);
    const bool both = std::ranges::find(wish.both_sides, name) != wish.both_sides.end();
    if (!wish.each_face) {
      add(name, faces, both);
      continue;
    }
    std::map<int, std::vector<int>> by_polygon;
    for (const int f : faces) by_polygon[scene.faces()[f].source].push_back(f);
    for (auto& [polygon, of_polygon] : by_polygon) {
      add(name + "/" + std::to_string(polygon), std::move(of_polygon), both);
    }
  }
  return surfaces;
}

}  // namespace sightline
