#include "viewers/envelope.h"

namespace sightline::viewers {

std::vector<char> envelope_objects(const Scene& scene) {
  const auto [low, high] = scene.bounds();
  std::vector<char> envelope;
  for (const Object& object : scene.objects()) {
    Point from = high, to = low;
    for (const int f : object.faces) {
      for (const int p : scene.face_points(f)) {
        from = from.cwiseMin(scene.point(p));
        to = to.cwiseMax(scene.point(p));
      }
    }
    const bool reaches =
        (from.array() == low.array()).any() || (to.array() == high.array()).any();
    const bool thin = ((to - from).array() <= 0.1 * (high - low).array()).any();
    envelope.push_back(reaches && thin ? 1 : 0);
  }
  return envelope;
}

}  // namespace sightline::viewers
