#include "linespace/light/patch_space.h"

#include <algorithm>
#include <map>

#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

PatchSpace::PatchSpace(const LightSpace& s, const SourcePatch& p, int n)
    : space(s), patch(p), number(n) {
  for (const SourcePatch::Side& side : p.sides) {
    sides.push_back(light_line(*side.ends[0], *side.ends[1]));
  }
  for (std::size_t i = 0; i < s.scene().points().size(); ++i) {
    const LightPoint& x = s.point(static_cast<int>(i));
    heights.push_back(value(p.plane.near, x.near));
    signs.push_back(sign_at(p.plane, x));
  }
  for (std::size_t f = 0; f < s.faces().size(); ++f) {
    const auto corners = s.scene().face_points(static_cast<int>(f));
    if (std::ranges::any_of(corners, [&](int c) { return in_front(c); })) {
      front_faces.push_back(static_cast<int>(f));
    }
  }
  for (std::size_t e = 0; e < s.edges().size(); ++e) {
    if (edge_in_front(static_cast<int>(e))) front_edges.push_back(static_cast<int>(e));
  }
  faces_in_front.assign(s.faces().size(), 0);
  for (const int f : front_faces) faces_in_front[f] = 1;
  for (const Point& h : p.hull) hull.push_back(light_point(h).near);
  find_points();
}

void PatchSpace::find_points() {
  const Scene& scene = space.scene();
  std::map<int, std::vector<int>> edges_at;
  for (const int e : front_edges) {
    for (const int p : space.edges()[e].points) edges_at[p].push_back(e);
  }
  for (const int p : scene.corners()) {
    if (!in_front(p)) continue;
    PencilPoint point{{LightFeature::Kind::Vertex, p}, &space.point(p), {}, {}, {}, {}};
    for (const int f : scene.faces_at(p)) {
      point.objects.push_back(scene.faces()[f].object);
      point.facets.push_back(scene.faces()[f].facet);
    }
    sort_unique(point.objects);
    sort_unique(point.facets);
    point.edges = edges_at[p];
    points.push_back(std::move(point));
  }
  for (std::size_t i = 0; i < space.touches().size(); ++i) {
    const EdgeTouch& touch = space.touches()[i];
    if (sign_at(patch.plane, touch.point) != Sign::Positive) continue;
    points.push_back({{LightFeature::Kind::Touch, static_cast<int>(i)},
                      &touch.point,
                      {},
                      {},
                      {touch.edges[0], touch.edges[1]},
                      {}});
  }
  own_points = points.size();
  for (std::size_t i = 0; i < patch.corners.size(); ++i) {
    const LightPoint* c = patch.corners[i];
    PencilPoint point{
        {LightFeature::Kind::SourceCorner, static_cast<int>(i)}, c, {}, {}, {}, {}};
    for (std::size_t s = 0; s < sides.size(); ++s) {
      if (sides[s].ends[0] == c || sides[s].ends[1] == c || is_on_line(*c, sides[s])) {
        point.sides.push_back(static_cast<int>(s));
      }
    }
    points.push_back(std::move(point));
  }
}

bool is_on_line(const LightPoint& v, const LightLine& l) {
  const Four<Approx> near = plane_of(l.near, v.near);
  if (std::ranges::any_of(near, [](const Approx& x) { return is_certain(x); })) {
    return false;
  }
  const Four<Ring> exact = plane_of(l.exact, v.exact);
  return std::ranges::all_of(exact, [](const Ring& x) { return is_zero(x); });
}

}  // namespace sightline::internal
