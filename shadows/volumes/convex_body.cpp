#include "shadows/volumes/convex_body.h"

#include <algorithm>
#include <map>
#include <set>

#include "linespace/numbers/rational.h"
#include "linespace/predicates.h"
#include "shadows/planar/plane_curve.h"

namespace sightline::internal {
namespace {

ExactPoint exact(const LightPoint& p) {
  const Rational w = rational(p.exact[3]);
  return {rational(p.exact[0]) / w, rational(p.exact[1]) / w, rational(p.exact[2]) / w};
}

bool on_line(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p) {
  return exact_cross(exact_difference(b, a), exact_difference(p, a)) == ExactPoint{};
}

// The outline lies on the hull: so nothing is left out within it.
bool fills_its_hull(const SourcePatch& patch) {
  std::vector<ExactPoint> hull;
  for (const Point& p : patch.hull) hull.push_back(exact_point(p));
  return std::ranges::all_of(patch.sides, [&](const SourcePatch::Side& side) {
    if (side.foot_of >= 0) return true;
    const ExactPoint a = exact(*side.ends[0]), b = exact(*side.ends[1]);
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const ExactPoint &p = hull[k], &q = hull[(k + 1) % hull.size()];
      if (on_line(p, q, a) && on_line(p, q, b)) return true;
    }
    return false;
  });
}

int point_at(const Scene& scene, std::span<const int> faces, const Point& at) {
  for (const int f : faces) {
    for (const int p : scene.face_points(f)) {
      if (scene.point(p) == at) return p;
    }
  }
  return -1;
}

ConvexBody polygon_body(const Scene& scene, const SourcePatch& patch) {
  ConvexBody body;
  body.flat = true;
  const int n = static_cast<int>(patch.hull.size());
  for (int k = 0; k < n; ++k) {
    body.corners.push_back({patch.hull[k], point_at(scene, patch.faces, patch.hull[k])});
    body.sides.push_back({{k, (k + 1) % n}, -1});
  }
  for (const int f : patch.faces) {
    const auto points = scene.face_points(f);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int p = points[i], q = points[(i + 1) % points.size()];
      for (ConvexBody::Side& side : body.sides) {
        const std::array ends{body.corners[side.ends[0]].at,
                              body.corners[side.ends[1]].at};
        if (collinear(ends[0], ends[1], scene.point(p)) &&
            collinear(ends[0], ends[1], scene.point(q)))
          side.edge = scene.edge_of_side(f, static_cast<int>(i));
      }
    }
  }
  const int facet = scene.faces()[patch.faces.front()].facet;
  const std::vector<Point>& h = patch.hull;
  body.planes = {{{h[0], h[1], h[2]}, facet}, {{h[2], h[1], h[0]}, facet}};
  return body;
}

ConvexBody closed_body(const Scene& scene, const Object& object) {
  ConvexBody body;
  std::map<int, int> positions;
  std::set<std::array<int, 2>> known;
  for (const int f : object.faces) {
    const auto points = scene.face_points(f);
    body.planes.push_back(
        {{scene.point(points[0]), scene.point(points[1]), scene.point(points[2])},
         scene.faces()[f].facet});
    std::vector<int> loop;
    for (const int p : points) {
      const auto [at, fresh] =
          positions.try_emplace(p, static_cast<int>(body.corners.size()));
      if (fresh) body.corners.push_back({scene.point(p), p});
      loop.push_back(at->second);
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      if (!known.insert({std::min(a, b), std::max(a, b)}).second) continue;
      body.sides.push_back({{a, b}, scene.edge_of_side(f, static_cast<int>(i))});
    }
  }
  return body;
}

}  // namespace

ConvexBody convex_body(const Scene& scene, std::span<const int> faces, FaceSide side,
                       const std::string& what) {
  if (faces.empty()) throw InvalidInput(what + ": no face that has an area");
  const Object& object = scene.objects()[scene.faces()[faces.front()].object];
  const auto foreign = std::ranges::find_if(faces, [&](int f) {
    return scene.faces()[f].object != scene.faces()[faces.front()].object;
  });
  // 1. All of a closed object.
  if (foreign == faces.end() && object.closed &&
      std::ranges::equal(faces, object.faces)) {
    if (!object.convex)
      throw InvalidInput(what + ": object '" + object.name + "' is not convex");
    if (object.inside_out) {
      throw InvalidInput(what + ": object '" + object.name +
                         "' is listed inside out, with air inside");
    }
    return closed_body(scene, object);
  }
  // 2. A polygon.
  const std::vector<SourcePatch> patches = source_patches(scene, faces, side);
  if (patches.size() != 1) {
    throw InvalidInput(what + ": its faces, polygon " +
                       std::to_string(scene.faces()[faces.front()].source) +
                       " of object '" + object.name +
                       "' among them, are neither all of one closed convex object nor in "
                       "one plane facing alike");
  }
  if (!fills_its_hull(patches.front())) {
    throw InvalidInput(what + ": the faces of object '" + object.name +
                       "' are no convex polygon");
  }
  return polygon_body(scene, patches.front());
}

}  // namespace sightline::internal
