#include "tests/shadows/mesh_proof/mesh_areas.h"

#include <algorithm>
#include <cmath>

#include "shadows/shadow_mesh.h"

namespace sightline::testing {

GroundAreas ground_areas(const ShadowScene& lit) {
  const Scene scene(lit.soup);
  const auto faces = naive_shadow_faces(scene, faces_of_groups(scene, lit.lights),
                                        faces_of_groups(scene, lit.two_sided));
  const Object& object = scene.objects()[0];
  const Shadows shadows =
      find_shadows(scene, light_source(scene, lit.lights, lit.two_sided),
                   {{object.name, object.faces}});
  const ReceiverShadows& ground = shadows.receivers.at(0);
  std::vector<double> ends;
  for (const Eigen::Vector2d& v : ground.meshes.at(0).vertices) ends.push_back(v[1]);
  GroundAreas result{
      naive_shadow_areas(faces, NaiveShadow(faces), object.faces.at(0), ends, 1e-11), 0};
  const NaiveShadowAreas& right = result.right;
  result.off = std::max({std::abs(ground.umbra_area - right.umbra),
                         std::abs(ground.penumbra_area - right.penumbra),
                         std::abs(ground.lit_area - right.lit)}) /
               ground.area;
  return result;
}

}  // namespace sightline::testing
