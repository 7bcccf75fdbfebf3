#include "linespace/path/seen_elements.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::internal {

SeenElements::SeenElements(const PathScene& scene, const PointView& view)
    : scene_(&scene),
      view_(&view),
      has_horizon_(view.place != EyePlace::Free && view.place != EyePlace::Inside) {
  for (const MapRegion& r : view.regions) planes_.push_back(plane(r));
  for (const SeenFacet& f : view.facets) shown_facets_.insert(f.facet);
  add_edges();
  add_vertices();
}

std::optional<SeenElements::Plane> SeenElements::plane(const MapRegion& region) const {
  if (region.facets.empty()) return std::nullopt;
  const Scene& scene = scene_->scene().scene();
  const Facet& facet = scene.facets()[region.facets.front()];
  if (!facet.planar) return std::nullopt;
  const auto t = plane_points(scene, facet.faces.front());
  const ExactPoint at = exact_point(scene.point(t[0]));
  ExactPoint n = exact_cross(exact_difference(exact_point(scene.point(t[1])), at),
                             exact_difference(exact_point(scene.point(t[2])), at));
  const ExactPosition& eye = view_->eye.at;
  ExactPoint way;
  for (int i = 0; i < 3; ++i) {
    way[i] = eye.is_double[i] ? Rational(eye.nearest[i]) : Rational(eye.exact[i]);
  }
  if (view_->eye.kind == Viewpoint::Kind::Eye) way = exact_difference(way, at);
  const int side = exact_dot(n, way).sign();
  if (side == 0) return std::nullopt;
  // Scaled, lest it underflow.
  const Rational size = std::max({abs(n[0]), abs(n[1]), abs(n[2])});
  for (Rational& x : n) x /= size * side;
  return Plane{rounded(n).normalized(), rounded(at)};
}

// On some side of the edge what is seen is not known to contain the line.
bool SeenElements::lies_behind(const MapEdge& edge, int line) const {
  for (const int region : {edge.left, edge.right}) {
    if (region < 0) continue;
    const MapRegion& r = view_->regions[region];
    if (r.facets.empty()) return true;
    const int face = scene_->scene().scene().facets()[r.facets.front()].faces.front();
    for (const int end : scene_->scene().lines()[line].ends) {
      if (!planes_[region] || scene_->scene().plane_side(face, end) != Sign::Zero)
        return true;
    }
  }
  return false;
}

void SeenElements::add_edges() {
  regions_at_.resize(view_->vertices.size());
  lines_at_.resize(view_->vertices.size());
  for (int e = 0; e < static_cast<int>(view_->edges.size()); ++e) {
    const MapEdge& edge = view_->edges[e];
    for (const int line : scene_->lines_of(edge.line)) {
      const int whole = scene_->scene().whole_line(line);
      shown_lines_.insert(whole);
      if (has_horizon_ || lies_behind(edge, line)) edges_of_line_[whole].push_back(e);
      for (const int v : edge.ends) lines_at_[v].push_back(line);
    }
    for (const int v : edge.ends) {
      for (const int r : {edge.left, edge.right}) {
        if (r >= 0) regions_at_[v].insert(r);
      }
    }
  }
}

void SeenElements::add_vertices() {
  const auto whole = [&](int line) { return scene_->scene().whole_line(line); };
  for (int v = 0; v < static_cast<int>(view_->vertices.size()); ++v) {
    const MapVertex& vertex = view_->vertices[v];
    if (vertex.kind == MapVertexKind::T) {
      for (const int near : scene_->lines_of(vertex.near)) {
        for (const int far : scene_->lines_of(vertex.far))
          vertices_of_pair_[{whole(near), whole(far)}].push_back(v);
      }
      continue;
    }
    if (vertex.kind == MapVertexKind::Corner) {
      vertices_of_point_[scene_->point_of(vertex.corner)].push_back(v);
      continue;
    }
    // A touch of the lines that end there, or anything in which they end or touch.
    for (const int line : lines_at_[v]) {
      for (const int p : scene_->points_on(line)) {
        auto& vertices = vertices_of_point_[p];
        if (vertices.empty() || vertices.back() != v) vertices.push_back(v);
      }
      if (vertex.kind == MapVertexKind::Touch) continue;
      for (const int other : lines_at_[v]) {
        if (whole(other) != whole(line))
          vertices_of_pair_[{whole(line), whole(other)}].push_back(v);
      }
    }
  }
}

// What is seen in the region lies before y, or contains it.
bool SeenElements::hides(int region, const Point& y) const {
  const auto& plane = planes_[region];
  if (!plane || has_horizon_) return false;
  return plane->normal.dot(y - plane->at) < -kDepthMargin * scene_->size();
}

bool SeenElements::any_shows(const std::vector<int>& vertices, const Point& y) const {
  return std::ranges::any_of(vertices, [&](int v) {
    return std::ranges::any_of(regions_at_[v], [&](int r) { return !hides(r, y); });
  });
}

bool SeenElements::may_show_behind_point(int point, const Point& y) const {
  const auto it = vertices_of_point_.find(point);
  return it != vertices_of_point_.end() && any_shows(it->second, y);
}

bool SeenElements::may_show_behind_pair(const LinePair& pair, const Point& y) const {
  const auto it = vertices_of_pair_.find(pair);
  return it != vertices_of_pair_.end() && any_shows(it->second, y);
}

// The ratio on a whole line at which an edge of the map ends; nullopt where that is not
// known.
std::optional<double> SeenElements::end(const RoundedEye& eye, int line,
                                        int vertex) const {
  const MapVertex& v = view_->vertices[vertex];
  const PathLine& on = scene_->lines()[line];
  if (v.kind == MapVertexKind::Corner) {
    const Eigen::Vector3d way = on.b.rounded - on.a.rounded;
    const Point p = scene_->scene().position(v.corner);
    return way.dot(p - on.a.rounded) / way.squaredNorm();
  }
  if (v.kind != MapVertexKind::T) return std::nullopt;
  for (const MapLine& name : {v.near, v.far}) {
    const auto lines = scene_->lines_of(name);
    if (lines.size() != 1) return std::nullopt;
    if (scene_->scene().whole_line(lines[0]) == line) continue;
    return seen_crossing(eye, on, scene_->lines()[lines[0]], scene_->size());
  }
  return std::nullopt;
}

bool SeenElements::may_show_point(const RoundedEye& eye, int line, int point) const {
  const auto it = edges_of_line_.find(line);
  if (it == edges_of_line_.end()) return false;
  const Point& x = scene_->points()[point].at.rounded;
  const auto seen = seen_in_line(eye, scene_->lines()[line], x, scene_->size());
  return std::ranges::any_of(it->second, [&](int e) {
    const MapEdge& edge = view_->edges[e];
    const bool shown = (edge.left >= 0 && !hides(edge.left, x)) ||
                       (edge.right >= 0 && !hides(edge.right, x));
    if (!shown || !seen) return shown;
    const auto from = end(eye, line, edge.ends[0]), to = end(eye, line, edge.ends[1]);
    if (!from || !to) return true;
    return seen->ratio > std::min(*from, *to) - kRatioMargin &&
           seen->ratio < std::max(*from, *to) + kRatioMargin;
  });
}

bool SeenElements::shows_facet(int facet) const {
  if (shown_facets_.contains(facet)) return true;
  const Scene& scene = scene_->scene().scene();
  for (const int f : scene.facets()[facet].faces) {
    for (int k = 0; k < scene.faces()[f].corner_count; ++k) {
      const int line = scene_->scene().line_of_side(f, k);
      if (line >= 0 && shown_lines_.contains(scene_->scene().whole_line(line)))
        return true;
    }
  }
  return false;
}

}  // namespace sightline::internal
