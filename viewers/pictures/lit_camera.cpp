#include "viewers/pictures/lit_camera.h"

#include <cmath>
#include <map>
#include <vector>

#include "viewers/camera.h"

namespace sightline::viewers {
namespace {

PictureCamera as_picture(const Camera& camera, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  const double fov = 2 * std::atan(aspect * std::tan(camera.field_of_view / 2));
  return {camera.eye, camera.target, camera.up, fov, width, height};
}

/// Eyes around a box, and in it near its sides, all the way around.
void add_eyes(const std::array<Point, 2>& box, int up_axis, double aspect,
              std::vector<Camera>& cameras) {
  constexpr int kTurns = 8;
  // Radians above the horizon; shares of the box's half size.
  constexpr double kElevation = 0.6, kNearSide = 0.85, kAboveMiddle = 0.35;
  const Point middle = (box[0] + box[1]) / 2, half = (box[1] - box[0]) / 2;
  for (int turn = 0; turn < kTurns; ++turn) {
    const double share = static_cast<double>(turn) / kTurns;
    cameras.push_back(frame(box, eye_direction(up_axis, kElevation, share),
                            Point::Unit(up_axis), aspect));
    // As far from the middle as the box's sides allow in this direction.
    Point way = eye_direction(up_axis, 0, share);
    way *= kNearSide / way.cwiseAbs().maxCoeff();
    way[up_axis] = kAboveMiddle;
    const Point eye = middle + way.cwiseProduct(half);
    const Point at = middle - kAboveMiddle * half[up_axis] * Point::Unit(up_axis);
    if ((at - eye).norm() > 0)
      cameras.push_back(look_from(eye, at, box, up_axis, aspect));
  }
}

/// The sum over facets that are lit somewhere of the root of their pixels.
double score(const Scene& scene, const std::vector<LitPixel>& pixels) {
  struct Shown {
    int pixels = 0;
    bool lit = false;
  };
  std::map<int, Shown> facets;
  for (const LitPixel& pixel : pixels) {
    if (pixel.kind != LitPixel::Kind::Surface) continue;
    Shown& shown = facets[scene.faces()[pixel.face].facet];
    ++shown.pixels;
    shown.lit = shown.lit || pixel.value > 0;
  }
  double sum = 0;
  for (const auto& [facet, shown] : facets) {
    if (shown.lit) sum += std::sqrt(shown.pixels);
  }
  return sum;
}

}  // namespace

PictureCamera lit_camera(const OcclusionIndex& occlusion,
                         const BackprojectionIndex& light, const LightSource& source,
                         const std::array<Point, 2>& box, int up_axis, int width,
                         int height, const Request& request) {
  constexpr int kSmall = 40, kRays = 4;
  const double aspect = static_cast<double>(width) / height;
  const Scene& scene = occlusion.scene();
  std::vector<Camera> cameras;
  add_eyes(box, up_axis, aspect, cameras);
  add_eyes(scene.bounds(), up_axis, aspect, cameras);
  PictureCamera best = as_picture(cameras.front(), width, height);
  double most = 0;
  for (const Camera& camera : cameras) {
    PictureCamera picture = as_picture(camera, kSmall, kSmall * height / width);
    const double here =
        score(scene, lit_picture(occlusion, light, source, picture, kRays, 1, request));
    if (here <= most) continue;
    most = here;
    best = picture;
    best.width = width;
    best.height = height;
  }
  return best;
}

}  // namespace sightline::viewers
