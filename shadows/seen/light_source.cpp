#include "shadows/light_source.h"

#include <algorithm>

namespace sightline {

LightSource light_source(const Scene& scene, std::span<const std::string> names,
                         std::span<const std::string> both_sides) {
  LightSource source;
  const auto sort = [](std::vector<int>& faces) {
    std::ranges::sort(faces);
    faces.erase(std::ranges::unique(faces).begin(), faces.end());
  };
  std::string all;
  for (const std::string& name : names) {
    const std::vector<int> faces = scene.faces_named(name);
    source.faces.insert(source.faces.end(), faces.begin(), faces.end());
    all += (all.empty() ? "" : ", ") + name;
  }
  sort(source.faces);
  if (source.faces.empty())
    throw InvalidInput("the light " + all + " has no face with an area");
  for (const std::string& name : both_sides) {
    for (const int f : scene.faces_named(name)) {
      if (std::ranges::binary_search(source.faces, f)) source.both_sides.push_back(f);
    }
  }
  sort(source.both_sides);
  return source;
}

}  // namespace sightline
