#include "tests/support/naive_ev.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tests/support/naive_solids_internal.h"

namespace sightline::testing {
namespace {

/// A node as found from its definition, with what is needed to recognise it as an arc's
/// end: its vertex, its last edge, and where on that edge it is.
struct FoundNode {
  NodeKey key;
  Number parameter;
};

class Enumeration {
 public:
  Enumeration(const PolygonSoup& soup, bool end_contacts)
      : s_(soup), end_contacts_(end_contacts) {
    const int n = static_cast<int>(s_.vertices.size());
    for (int v = 0; v < n; ++v) {
      find_planes(v);
      find_vv(v);
      find_vertex_edge_edge(v);
    }
    for (int f = 0; f < static_cast<int>(s_.faces.size()); ++f) find_fve(f);
    for (int v = 0; v < n; ++v) {
      find_planes(v);
      for (int e = 0; e < static_cast<int>(s_.edges.size()); ++e) find_arcs(v, e);
    }
    if (!end_contacts_) check_identity();
    result_.sort();
  }
  CanonicalSkeleton take() { return std::move(result_); }

 private:
  [[nodiscard]] Vector point_on(int e, const Number& s) const {
    const Vector& a = s_.vertices[s_.edges[e].a];
    return a + s * (s_.vertices[s_.edges[e].b] - a);
  }
  /// Where edge e's line crosses a plane it is not parallel to.
  [[nodiscard]] Number crossing(int e, const Plane& plane) const {
    const Number at_a = plane(s_.vertices[s_.edges[e].a]);
    const Number at_b = plane(s_.vertices[s_.edges[e].b]);
    return at_a / (at_a - at_b);
  }

  /// The planes through v and every edge not at v, and the side of each vertex.
  void find_planes(int v);
  void find_vv(int v);
  void find_vertex_edge_edge(int v);
  void find_fve(int f);
  void find_arcs(int v, int e);
  /// The node at which the arcs of (v, e) end at parameter s.
  [[nodiscard]] const NodeKey& end_node(int v, int e, const Number& s) const;
  void check_identity() const;

  [[nodiscard]] bool crosses(int e, int other) const {
    return side_[e][s_.edges[other].a] * side_[e][s_.edges[other].b] < 0;
  }

  /// Such a contact can be an outermost one.
  [[nodiscard]] bool can_be_outer(Met met) const {
    return met == Met::Graze || (met == Met::End && end_contacts_);
  }
  static std::string name(const std::string& kind, Met first, Met last) {
    return first == Met::End || last == Met::End ? kind + "_end" : kind;
  }

  Solids s_;
  bool end_contacts_;
  CanonicalSkeleton result_;
  std::vector<std::optional<Plane>> plane_;  // of the current vertex, by edge
  std::vector<std::vector<int>> side_;       // by edge, then vertex
  std::map<std::pair<int, int>, NodeKey> vv_;
  std::map<std::pair<int, int>, std::vector<FoundNode>> ends_;  // by vertex and edge
};

void Enumeration::find_planes(int v) {
  plane_.assign(s_.edges.size(), std::nullopt);
  side_.assign(s_.edges.size(), {});
  for (std::size_t e = 0; e < s_.edges.size(); ++e) {
    const SolidEdge& edge = s_.edges[e];
    if (edge.a == v || edge.b == v) continue;
    plane_[e] = plane_through(s_.vertices[v], s_.vertices[edge.a], s_.vertices[edge.b]);
    side_[e].assign(s_.vertices.size(), 0);
    for (std::size_t w = 0; w < s_.vertices.size(); ++w) {
      const int i = static_cast<int>(w);
      if (i == v || i == edge.a || i == edge.b) continue;
      side_[e][w] = sign_of((*plane_[e])(s_.vertices[w]));
      const bool one_solid =
          edge.solid == s_.solid_of_vertex[v] && edge.solid == s_.solid_of_vertex[w];
      if (side_[e][w] == 0 && !one_solid) throw NotGeneral("four coplanar vertices");
    }
  }
}

void Enumeration::find_vv(int v) {
  for (int w = v + 1; w < static_cast<int>(s_.vertices.size()); ++w) {
    if (s_.solid_of_vertex[v] == s_.solid_of_vertex[w]) continue;
    const Vector& p = s_.vertices[v];
    const Vector& q = s_.vertices[w];
    const Met at_v = s_.met_at_vertex(v, q - p), at_w = s_.met_at_vertex(w, p - q);
    if (!can_be_outer(at_v) || !can_be_outer(at_w)) continue;
    if (!s_.is_free(p, q)) continue;
    NodeKey key = node_key(name("VV", at_v, at_w),
                           {s_.vertex_key(v, at_v), s_.vertex_key(w, at_w)});
    vv_[{v, w}] = key;
    result_.nodes.push_back(std::move(key));
  }
}

void Enumeration::find_vertex_edge_edge(int v) {
  const int n = static_cast<int>(s_.edges.size());
  const Vector& p = s_.vertices[v];
  for (int e = 0; e < n; ++e) {
    if (s_.edges[e].solid == s_.solid_of_vertex[v]) continue;
    for (int f = e + 1; f < n; ++f) {
      if (s_.edges[f].solid == s_.solid_of_vertex[v] ||
          s_.edges[f].solid == s_.edges[e].solid) {
        continue;
      }
      // The line through v that meets both edges' lines lies in both planes; it meets the
      // edges themselves iff each crosses the plane through v and the other.
      if (!crosses(e, f) || !crosses(f, e)) continue;
      const Number on_e = crossing(e, *plane_[f]);
      const Number on_f = crossing(f, *plane_[e]);
      const Vector x = point_on(e, on_e);
      const Vector y = point_on(f, on_f);
      const Vector direction = y - p;
      // x = p + position * direction, y is at position 1.
      const Number squared = dot(direction, direction);
      const Number position = dot(x - p, direction) / squared;
      if (sign_of(position) < 0) {
        const Met at_e = s_.met_at_edge<Number>(e, direction);
        const Met at_f = s_.met_at_edge<Number>(f, p - y);
        if (!can_be_outer(at_e) || !can_be_outer(at_f)) continue;
        if (!s_.supports_at_vertex(v, direction) || !s_.is_free(x, y)) continue;
        result_.nodes.push_back(
            node_key(name("EVE", at_e, at_f),
                     {s_.edge_key(e, at_e), s_.vertex_key(v), s_.edge_key(f, at_f)}));
        continue;
      }
      const bool e_first = position < 1;
      const int near = e_first ? e : f, far = e_first ? f : e;
      const Met at_v = s_.met_at_vertex(v, direction);
      const Met at_far = s_.met_at_edge<Number>(far, p - y);
      if (!can_be_outer(at_v) || !can_be_outer(at_far)) continue;
      if (!s_.supports_at_edge(near, direction)) continue;
      if (!s_.is_free(p, e_first ? y : x)) continue;
      NodeKey key =
          node_key(name("VEE", at_v, at_far),
                   {s_.vertex_key(v, at_v), s_.edge_key(near), s_.edge_key(far, at_far)});
      ends_[{v, far}].push_back({key, e_first ? on_f : on_e});
      result_.nodes.push_back(std::move(key));
    }
  }
}

void Enumeration::find_fve(int f) {
  const SolidFace& face = s_.faces[f];
  const int corners = static_cast<int>(face.vertices.size());
  for (int e = 0; e < static_cast<int>(s_.edges.size()); ++e) {
    const SolidEdge& edge = s_.edges[e];
    if (edge.solid == face.solid) continue;
    if (sign_of(face.plane(s_.vertices[edge.a])) *
            sign_of(face.plane(s_.vertices[edge.b])) >=
        0) {
      continue;
    }
    const Number parameter = crossing(e, face.plane);
    const Vector x = point_on(e, parameter);
    for (int i = 0; i < corners; ++i) {
      const int v = face.vertices[i];
      const Vector& p = s_.vertices[v];
      const Vector direction = x - p;
      // Along the face: one of the line's two directions points between the sides at v.
      const Vector to_next = s_.vertices[face.vertices[(i + 1) % corners]] - p;
      const Vector to_previous =
          s_.vertices[face.vertices[(i + corners - 1) % corners]] - p;
      const Vector& normal = face.plane.normal;
      const int left_of_next = sign_of(dot(normal, cross(to_next, direction)));
      const int right_of_previous = sign_of(dot(normal, cross(direction, to_previous)));
      if (left_of_next * right_of_previous <= 0) continue;
      const Met at_e = s_.met_at_edge<Number>(e, p - x);
      if (!can_be_outer(at_e) || !s_.is_free(p, x)) continue;
      NodeKey key = node_key(name("FvE", Met::Graze, at_e),
                             {s_.face_key(f), s_.vertex_key(v), s_.edge_key(e, at_e)});
      ends_[{v, e}].push_back({key, parameter});
      result_.nodes.push_back(std::move(key));
    }
  }
}

void Enumeration::find_arcs(int v, int e) {
  const SolidEdge& edge = s_.edges[e];
  if (edge.solid == s_.solid_of_vertex[v]) return;
  const Vector& p = s_.vertices[v];
  // e lies in the planes of both its faces, so a line from v to a point of e is on the
  // same side of them wherever the point is.
  const Met at_edge = s_.met_at_edge<Number>(e, p - s_.vertices[edge.a]);
  if (!can_be_outer(at_edge)) return;

  // Between neighbouring critical parameters nothing changes.
  std::vector<Number> critical;
  const auto add = [&](const Plane& plane) {
    const Number at_a = plane(s_.vertices[edge.a]);
    const Number at_b = plane(s_.vertices[edge.b]);
    if (sign_of(at_a) * sign_of(at_b) < 0) critical.push_back(at_a / (at_a - at_b));
  };
  for (int f = 0; f < static_cast<int>(s_.edges.size()); ++f) {
    // An edge strictly on one side of the plane through v and e meets no line of theirs.
    if (f == e || !plane_[f]) continue;
    if (side_[e][s_.edges[f].a] * side_[e][s_.edges[f].b] > 0) continue;
    add(*plane_[f]);
  }
  for (const SolidFace& face : s_.faces) add(face.plane);
  std::ranges::sort(critical);
  const auto repeated = std::ranges::unique(critical);
  critical.erase(repeated.begin(), repeated.end());

  // The contact at v, if the line is in.
  const auto is_in = [&](const Number& s) -> std::optional<Met> {
    const Vector x = point_on(e, s);
    const Met met = s_.met_at_vertex(v, x - p);
    if (!can_be_outer(met) || !s_.is_free(p, x)) return std::nullopt;
    return met;
  };
  std::vector<Number> bounds = {Number(0)};
  bounds.insert(bounds.end(), critical.begin(), critical.end());
  bounds.emplace_back(1);
  // Maximal runs [first, last] of bounds between which every line is in.
  struct Run {
    std::size_t first, last;
    Met at_v;
  };
  std::vector<Run> runs;
  std::optional<Met> was_inside;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    const bool at_bound = i > 0 && is_in(bounds[i]);
    const std::optional<Met> inside = is_in((bounds[i] + bounds[i + 1]) / 2);
    if (i > 0 && !at_bound && (inside || was_inside)) {
      throw std::logic_error("a component is not closed");
    }
    if (at_bound && !inside && !was_inside) throw NotGeneral("an isolated line");
    if (inside && was_inside == inside) {
      runs.back().last = i + 1;
    } else if (inside) {
      runs.push_back({i, i + 1, *inside});
    }
    was_inside = inside;
  }
  for (const auto& [first, last, at_v] : runs) {
    ArcKey arc = arc_key("EV", {s_.vertex_key(v, at_v), s_.edge_key(e, at_edge)}, false,
                         {end_node(v, e, bounds[first]), end_node(v, e, bounds[last])});
    if (s_.coordinates[edge.b] < s_.coordinates[edge.a]) {
      std::swap(arc.nodes[0], arc.nodes[1]);
    }
    result_.arcs.push_back(std::move(arc));
  }
}

const NodeKey& Enumeration::end_node(int v, int e, const Number& s) const {
  if (s == 0 || s == 1) {
    const int w = s == 0 ? s_.edges[e].a : s_.edges[e].b;
    const auto found = vv_.find({std::min(v, w), std::max(v, w)});
    if (found == vv_.end()) throw std::logic_error("an arc ends at no VV");
    return found->second;
  }
  const NodeKey* result = nullptr;
  if (const auto nodes = ends_.find({v, e}); nodes != ends_.end()) {
    for (const FoundNode& node : nodes->second) {
      if (node.parameter != s) continue;
      if (result) throw NotGeneral("two nodes on one line");
      result = &node.key;
    }
  }
  if (!result) throw std::logic_error("an arc ends at no VEE and no FvE");
  return *result;
}

void Enumeration::check_identity() const {
  auto n = result_.counts();
  if (2 * n["EV"] != 4 * n["VV"] + n["VEE"] + n["FvE"]) {
    throw std::logic_error("2 EV = 4 VV + VEE + FvE does not hold");
  }
}

}  // namespace

CanonicalSkeleton naive_ev(const PolygonSoup& soup, bool end_contacts) {
  return Enumeration(soup, end_contacts).take();
}

}  // namespace sightline::testing
