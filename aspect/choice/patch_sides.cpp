#include "aspect/choice/patch_sides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "linespace/numbers/rational.h"
#include "linespace/picture/view_scene.h"

namespace sightline::internal {
namespace {

ExactPoint exact_normal(const Scene& scene, int face) {
  const auto p = scene.face_points(face);
  const ExactPoint a = exact_point(scene.point(p[0]));
  return exact_cross(exact_difference(exact_point(scene.point(p[1])), a),
                     exact_difference(exact_point(scene.point(p[2])), a));
}

void measure(const Scene& scene, PatchSide& side) {
  side.area = 0;
  for (const int facet : side.facets) {
    for (const int f : scene.facets()[facet].faces) {
      side.faces.push_back(f);
      const auto p = scene.face_points(f);
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t k = 1; k + 1 < p.size(); ++k) {
        sum += (scene.point(p[k]) - scene.point(p[0]))
                   .cross(scene.point(p[k + 1]) - scene.point(p[0]));
      }
      side.area += sum.norm() / 2;
    }
  }
  std::ranges::sort(side.faces);
  const auto p = scene.face_points(scene.facets()[side.facets[0]].faces[0]);
  side.plane = {scene.point(p[0]), scene.point(p[side.front ? 1 : 2]),
                scene.point(p[side.front ? 2 : 1])};
  side.on = side.plane[0];
  const Eigen::Vector3d u = side.plane[1] - side.on, v = side.plane[2] - side.on;
  side.normal = u.cross(v);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    side.slack[i] = std::abs(u[j] * v[k]) + std::abs(u[k] * v[j]);
  }
}

// Parallel planes have nearly one direction of normals; which of these are parallel
// exactly, and in which order, rationals decide.
void group_parallel(const Scene& scene, std::vector<PatchSide>& sides) {
  struct Leader {
    int side;
    ExactPoint normal;
  };
  std::map<std::array<long, 3>, std::vector<Leader>> leaders;
  std::vector<std::pair<Rational, int>> heights;  // with sides
  constexpr double kCells = 1e6;
  for (int s = 0; s < static_cast<int>(sides.size()); ++s) {
    PatchSide& side = sides[s];
    const ExactPoint n = exact_normal(scene, scene.facets()[side.facets[0]].faces[0]);
    Eigen::Vector3d d = side.normal.normalized();
    int largest = 0;
    d.cwiseAbs().maxCoeff(&largest);
    if (d[largest] < 0) d = -d;
    std::vector<Leader>& near =
        leaders[{std::lround(d[0] * kCells), std::lround(d[1] * kCells),
                 std::lround(d[2] * kCells)}];
    const auto leader = std::ranges::find_if(near, [&](const Leader& l) {
      const ExactPoint c = exact_cross(l.normal, n);
      return c[0] == 0 && c[1] == 0 && c[2] == 0;
    });
    const bool is_new = leader == near.end();
    side.group = is_new ? s : leader->side;
    if (is_new) near.push_back({s, n});
    const ExactPoint& axis = is_new ? near.back().normal : leader->normal;
    const PatchSide& first = sides[side.group];
    side.along = (exact_dot(axis, n) > 0) == (side.front == first.front);
    Rational height = exact_dot(axis, exact_point(side.on));
    if (!first.front) height = -height;
    heights.emplace_back(std::move(height), s);
  }
  std::ranges::sort(heights, [&](const auto& a, const auto& b) {
    const int ga = sides[a.second].group, gb = sides[b.second].group;
    return ga != gb ? ga < gb : a.first < b.first;
  });
  for (std::size_t i = 0; i < heights.size(); ++i) {
    PatchSide& side = sides[heights[i].second];
    side.rank = 0;
    if (i == 0 || sides[heights[i - 1].second].group != side.group) continue;
    const int before = sides[heights[i - 1].second].rank;
    side.rank = before + (heights[i].first == heights[i - 1].first ? 0 : 1);
  }
}

}  // namespace

std::vector<PatchSide> patch_sides(const PointViewIndex& index,
                                   const ViewpointRequest& request) {
  const Scene& scene = index.shared().scene();
  std::map<int, PatchSide> by_patch;
  for (int facet = 0; facet < static_cast<int>(scene.facets().size()); ++facet) {
    for (const bool front : {true, false}) {
      PatchSide& side =
          by_patch.try_emplace(index.patch_of(facet, front), PatchSide{}).first->second;
      if (side.facets.empty()) side.front = front;
      side.facets.push_back(facet);
    }
  }
  std::vector<PatchSide> out;
  for (auto& [patch, side] : by_patch) {
    side.patch = patch;
    measure(scene, side);
    const bool wanted = request.of.empty() || std::ranges::any_of(side.faces, [&](int f) {
                          return std::ranges::binary_search(request.of, f);
                        });
    const auto into_material = [&](int facet) {
      return index.patch_of(facet, true) != patch &&
             std::ranges::all_of(scene.facets()[facet].faces,
                                 [&](int f) { return scene.solid_behind(f); });
    };
    if (!wanted || std::ranges::all_of(side.facets, into_material)) continue;
    const int object = scene.facets()[side.facets[0]].object;
    const bool alone = std::ranges::all_of(
        side.facets, [&](int f) { return scene.facets()[f].object == object; });
    const Object& o = scene.objects()[object];
    side.solid = alone && o.closed && o.convex && !o.inside_out ? object : -1;
    out.push_back(std::move(side));
  }
  group_parallel(scene, out);
  std::ranges::stable_sort(
      out, {}, [](const PatchSide& side) { return std::pair(side.group, side.rank); });
  return out;
}

}  // namespace sightline::internal
