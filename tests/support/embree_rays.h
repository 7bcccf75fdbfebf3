// Embree's own view of a scene, robust and in floats: what benchmarks of rays compare
// with.

#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <vector>

#include "linespace/scene.h"

namespace sightline::testing {

/// The faces of a scene as Embree's triangles, with the robust flag and its best build.
/// Owns the device; keeps no reference to the scene.
class EmbreeTriangles {
 public:
  explicit EmbreeTriangles(const Scene& scene) {
    std::vector<float> vertices;
    for (const Point& p : scene.points()) {
      for (const double x : p) vertices.push_back(static_cast<float>(x));
    }
    std::vector<unsigned> corners;
    for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
      const auto ids = scene.face_points(f);
      for (std::size_t i = 1; i + 1 < ids.size(); ++i) {
        for (const int p : {ids[0], ids[i], ids[i + 1]}) {
          corners.push_back(static_cast<unsigned>(p));
        }
      }
    }
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::copy(vertices.begin(), vertices.end(),
              static_cast<float*>(rtcSetNewGeometryBuffer(
                  geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                  3 * sizeof(float), vertices.size() / 3)));
    std::copy(corners.begin(), corners.end(),
              static_cast<unsigned*>(rtcSetNewGeometryBuffer(
                  geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                  3 * sizeof(unsigned), corners.size() / 3)));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeTriangles() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeTriangles(const EmbreeTriangles&) = delete;
  EmbreeTriangles& operator=(const EmbreeTriangles&) = delete;

  [[nodiscard]] RTCScene scene() const { return scene_; }

 private:
  RTCDevice device_ = rtcNewDevice(nullptr);
  RTCScene scene_ = rtcNewScene(device_);
};

/// From a (parameter 0) to b (parameter 1), of which [near, far] is asked about.
inline RTCRay embree_ray(const Point& a, const Point& b, float near = 0, float far = 1) {
  const Point d = b - a;
  RTCRay ray{};
  ray.org_x = static_cast<float>(a[0]);
  ray.org_y = static_cast<float>(a[1]);
  ray.org_z = static_cast<float>(a[2]);
  ray.dir_x = static_cast<float>(d[0]);
  ray.dir_y = static_cast<float>(d[1]);
  ray.dir_z = static_cast<float>(d[2]);
  ray.tnear = near;
  ray.tfar = far;
  ray.mask = ~0U;
  return ray;
}

}  // namespace sightline::testing
