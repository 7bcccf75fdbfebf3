#include "shadows/factors/factor_sides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "linespace/predicates.h"
#include "shadows/factors/coplanar_cover.h"
#include "shadows/factors/exchange_geometry.h"
#include "shadows/factors/exposed_parts.h"

namespace sightline::internal {
namespace {

std::vector<PointList> polygons_of(const Scene& scene, const FormFactorSurface& surface) {
  std::vector<PointList> polygons;
  for (const int f : surface.faces) {
    polygons.push_back(listed_polygon(scene, f, surface.back));
  }
  return polygons;
}

/// To which all faces of the surface belong, or -1.
int object_of(const Scene& scene, const FormFactorSurface& surface) {
  const int object = scene.faces()[surface.faces.front()].object;
  const bool all = std::ranges::all_of(
      surface.faces, [&](int f) { return scene.faces()[f].object == object; });
  return all ? object : -1;
}

/// Adds the sides of the surfaces; of buried parts the area alone.
void add_surfaces(const Scene& scene, std::span<const FormFactorSurface> surfaces,
                  const ExposedParts& exposed, FactorScene& result) {
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    double area = 0, seen = 0;
    const std::vector<PointList> polygons = polygons_of(scene, surfaces[i]);
    for (const PointList& p : polygons) area += area_of(p);
    bool buried = false;
    const int object = object_of(scene, surfaces[i]);
    for (PointList& p : merged_convex(polygons)) {
      for (PointList& part : exposed.of(p, buried)) {
        seen += area_of(part);
        result.sides.push_back({std::move(part), static_cast<int>(i), object});
      }
    }
    result.areas.push_back(area);
    result.buried.push_back(buried ? area - seen : 0);
  }
}

/// For every face side, whether some surface has it.
std::vector<std::array<bool, 2>> asked(const Scene& scene,
                                       std::span<const FormFactorSurface> surfaces) {
  std::vector<std::array<bool, 2>> is_asked(scene.faces().size(), {false, false});
  for (const FormFactorSurface& s : surfaces) {
    for (const int f : s.faces) is_asked[f][s.back ? 1 : 0] = true;
  }
  return is_asked;
}

void add_elsewhere(const Scene& scene, std::span<const FormFactorSurface> surfaces,
                   const ExposedParts& exposed, FactorScene& result) {
  const auto is_asked = asked(scene, surfaces);
  std::vector<PointList> fronts, others, backs;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const int face = static_cast<int>(f);
    fronts.push_back(listed_polygon(scene, face, false));
    if (!is_asked[f][0]) others.push_back(fronts.back());
    if (is_asked[f][1]) fronts.push_back(listed_polygon(scene, face, true));
    // The back of a solid's face is seen from within only, where all is buried.
    const bool inner = scene.solid_behind(face) && !scene.turned(face);
    if (!is_asked[f][1] && !inner) backs.push_back(listed_polygon(scene, face, true));
  }
  bool buried = false;
  const auto add = [&](const PointList& polygon, Elsewhere what) {
    for (PointList& part : exposed.of(polygon, buried)) {
      result.elsewhere.push_back({std::move(part), what});
    }
  };
  for (const PointList& p : merged_convex(others)) add(p, kOthers);
  // Where a front and a back lie together the front counts, and one of several backs.
  CoplanarCover cover(fronts);
  for (const PointList& p : merged_convex(backs)) {
    for (const PointList& part : cover.uncovered(p)) add(part, kBacks);
    cover.add(p);
  }
}

/// The six sides of the scene's box, seen from within, without the faces that lie in
/// them.
void add_windows(const Scene& scene, FactorScene& result) {
  const auto& [low, high] = scene.bounds();
  std::vector<PointList> faces;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    for (const bool back : {false, true}) {
      faces.push_back(listed_polygon(scene, static_cast<int>(f), back));
    }
  }
  const CoplanarCover cover(faces);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (!(low[u] < high[u] && low[v] < high[v])) continue;
    for (const bool upper : {false, true}) {
      PointList window(4, upper ? high : low);
      window[0][u] = window[3][u] = low[u];
      window[1][u] = window[2][u] = high[u];
      window[0][v] = window[1][v] = low[v];
      window[2][v] = window[3][v] = high[v];
      if (upper) std::ranges::reverse(window);
      for (PointList& part : cover.uncovered(window)) {
        result.elsewhere.push_back({std::move(part), kOutside});
      }
    }
  }
}

/// Lies in a side of the scene's box and faces outwards.
bool leaves_at_once(const Scene& scene, const PointList& polygon) {
  const auto& [low, high] = scene.bounds();
  const auto c = spanning_corners(polygon);
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  for (int axis = 0; axis < 3; ++axis) {
    const double wall = normal[axis] > 0 ? high[axis] : low[axis];
    if (normal[axis] != 0 &&
        std::ranges::all_of(polygon, [&](const Point& p) { return p[axis] == wall; })) {
      return true;
    }
  }
  return false;
}

/// Convex objects one by one, then what else has material behind it, then the rest.
void add_blockers(const Scene& scene, FactorScene& result) {
  std::vector<PointList> solid, thin;
  const auto add = [&](std::vector<PointList> polygons, int object) {
    for (PointList& p : merged_convex(std::move(polygons))) {
      result.blockers.push_back(std::move(p));
      result.blocker_object.push_back(object);
    }
  };
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    const Object& object = scene.objects()[o];
    std::vector<PointList> own;
    for (const int f : object.faces) {
      auto& list = !scene.solid_behind(f)                ? thin
                   : object.convex && !object.inside_out ? own
                                                         : solid;
      list.push_back(listed_polygon(scene, f, false));
    }
    add(std::move(own), static_cast<int>(o));
  }
  add(std::move(solid), -1);
  result.solid_blockers = result.blockers.size();
  add(std::move(thin), -1);
}

}  // namespace

double coincident_area(const Scene& scene) {
  std::vector<PointList> fronts;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    fronts.push_back(listed_polygon(scene, static_cast<int>(f), false));
  }
  double sum = 0;
  CoplanarCover cover({});
  for (const PointList& p : fronts) {
    if (!cover.touches(p)) {
      cover.add(p);
      continue;
    }
    double open = 0;
    for (const PointList& part : cover.uncovered(p)) open += area_of(part);
    const double covered = area_of(p) - open;
    if (covered > 1e-12 * area_of(p)) sum += covered;
    cover.add(p);
  }
  return sum;
}

PointList listed_polygon(const Scene& scene, int face, bool back) {
  PointList polygon;
  for (const int p : scene.face_points(face)) polygon.push_back(scene.point(p));
  if (scene.turned(face) != back) std::ranges::reverse(polygon);
  return polygon;
}

double area_of(std::span<const Point> polygon) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * sum.norm();
}

std::vector<std::vector<FactorSide>> sides_by_face(
    const Scene& scene, std::span<const FormFactorSurface> surfaces) {
  std::vector<std::vector<FactorSide>> sides(2 * scene.faces().size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (const int f : surfaces[i].faces) {
      sides[2 * f + (surfaces[i].back ? 1 : 0)].push_back(
          {listed_polygon(scene, f, surfaces[i].back), static_cast<int>(i)});
    }
  }
  std::vector<PointList> fronts;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const int face = static_cast<int>(f);
    fronts.push_back(listed_polygon(scene, face, false));
    if (sides[2 * f].empty()) sides[2 * f].push_back({fronts.back(), kOthers});
    if (!sides[2 * f + 1].empty()) fronts.push_back(listed_polygon(scene, face, true));
  }
  CoplanarCover cover(fronts);
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    if (!sides[2 * f + 1].empty()) continue;
    const PointList back = listed_polygon(scene, static_cast<int>(f), true);
    for (PointList& part : cover.uncovered(back)) {
      sides[2 * f + 1].push_back({std::move(part), kBacks});
    }
    cover.add(back);
  }
  return sides;
}

FactorScene factor_scene(const Scene& scene,
                         std::span<const FormFactorSurface> surfaces) {
  FactorScene result;
  const ExposedParts exposed(scene);
  add_surfaces(scene, surfaces, exposed, result);
  add_elsewhere(scene, surfaces, exposed, result);
  add_windows(scene, result);
  result.leaving.assign(surfaces.size(), 0);
  result.leaving_normal.assign(surfaces.size(), Eigen::Vector3d::Zero());
  for (const FactorSide& side : result.sides) {
    if (leaves_at_once(scene, side.polygon)) {
      const auto c = spanning_corners(side.polygon);
      const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
      result.leaving[side.of] += area_of(side.polygon);
      result.leaving_normal[side.of] += area_of(side.polygon) * normal;
    }
  }
  add_blockers(scene, result);
  result.coincident_area = coincident_area(scene);
  return result;
}

}  // namespace sightline::internal
