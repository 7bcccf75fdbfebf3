#include "shadows/mesh/mesh_maker.h"

#include <algorithm>
#include <cmath>

#include "linespace/numbers/exact_position.h"
#include "linespace/picture/classes.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {

int StructureTable::number_of(std::vector<SeenBoundary> boundaries) {
  Key key;
  for (SeenBoundary& b : boundaries) {
    b.corners.clear();
    key.emplace_back(b.source_face, b.sides);
  }
  const auto [it, is_new] =
      numbers_.emplace(std::move(key), static_cast<int>(structures_.size()));
  if (is_new) structures_.push_back(std::move(boundaries));
  return it->second;
}

std::vector<std::vector<SeenBoundary>> StructureTable::take() {
  return std::move(structures_);
}

namespace {

// Of the map's edges, and of the mesh's: first comes the kind.
using Name = ReceiverCurves::Name;

bool is_always_edge(ShadowEdgeKind kind) {
  return kind == ShadowEdgeKind::Boundary || kind == ShadowEdgeKind::Contact ||
         kind == ShadowEdgeKind::Plane;
}

int order_of(ShadowEdgeKind kind) {
  switch (kind) {
    case ShadowEdgeKind::Boundary:
    case ShadowEdgeKind::Contact:
      return 0;
    case ShadowEdgeKind::Plane:
    case ShadowEdgeKind::Face:
    case ShadowEdgeKind::EE:
      return 1;
    case ShadowEdgeKind::EV:
    case ShadowEdgeKind::EEE:
      break;
  }
  return 2;
}

class MeshMaker {
 public:
  MeshMaker(const ReceiverPlane& plane, const ReceiverCurves& curves, int facet,
            const LightEvents& events, const BackprojectionIndex& light,
            StructureTable& structures, const Request& request)
      : plane_(&plane),
        curves_(&curves),
        events_(&events),
        light_(&light),
        request_(&request),
        structures_(&structures),
        map_(curves.curves, plane.outline()) {
    out_.mesh.facet = facet;
    out_.mesh.frame = plane.frame();
  }

  MeshAndAreas make() {
    ask_faces();
    name_edges();
    join_faces();
    join_edges();
    add_faces();
    add_edges();
    count_umbrae();
    return std::move(out_);
  }

 private:
  struct FaceSeen {
    ShadowClass shadow;
    std::vector<SeenBoundary> boundaries;
    PlanePoint inside;
    int structure;
  };

  [[nodiscard]] Backprojection ask(const PlanePoint& p) const {
    const ShadowPoint point{exact_position(plane_->lift(p)),
                            exact_position(plane_->normal())};
    return light_->from(point, {.boundaries = true});
  }

  void ask_faces() {
    seen_.resize(map_.face_count());
    Stage stage(*request_, "what faces of the mesh see");
    for_each_of(0, seen_.size(), seen_.size(), *request_, stage, [&](std::size_t f) {
      seen_[f].inside = map_.interior_point(static_cast<int>(f));
      Backprojection of_face = ask(seen_[f].inside);
      seen_[f].shadow = of_face.shadow;
      seen_[f].boundaries = std::move(of_face.boundaries);
    });
    for (FaceSeen& f : seen_)
      f.structure = structures_->number_of(std::move(f.boundaries));
  }

  // Of all that runs along an edge the first kind counts; its generators are the union of
  // those of that kind.
  void name_edges() {
    for (int e = 0; e < map_.edge_count(); ++e) {
      Name name{ShadowEdgeKind::Boundary, {}};
      if (!map_.on_outline(e)) {
        name.kind = ShadowEdgeKind::EEE;
        for (const int c : map_.curves(e))
          name.kind = std::min(name.kind, curves_->names[c].kind);
        for (const int c : map_.curves(e)) {
          if (curves_->names[c].kind != name.kind) continue;
          const auto& more = curves_->names[c].generators;
          name.generators.insert(name.generators.end(), more.begin(), more.end());
        }
        std::ranges::sort(name.generators);
        name.generators.erase(std::ranges::unique(name.generators).begin(),
                              name.generators.end());
      }
      names_.push_back(std::move(name));
    }
  }

  [[nodiscard]] int structure_at(int half_edge) const {
    const int f = map_.face(half_edge);
    return f == PlanarMap::kOutside ? -1 : seen_[f].structure;
  }

  void join_faces() {
    faces_.emplace(seen_.size());
    kept_.assign(map_.edge_count(), true);
    for (int e = 0; e < map_.edge_count(); ++e) {
      if (is_always_edge(names_[e].kind) ||
          structure_at(2 * e) != structure_at(2 * e + 1))
        continue;
      kept_[e] = false;
      faces_->join(map_.face(2 * e), map_.face(2 * e + 1));
    }
  }

  // Two edges that end at a vertex where nothing else does are one, if they are of one
  // kind and go on straight or along one curve.
  void join_edges() {
    edges_.emplace(map_.edge_count());
    at_vertex_.resize(map_.vertex_count());
    for (int e = 0; e < map_.edge_count(); ++e) {
      if (!kept_[e]) continue;
      at_vertex_[map_.origin(2 * e)].push_back(2 * e);
      at_vertex_[map_.origin(2 * e + 1)].push_back(2 * e + 1);
    }
    inner_.assign(map_.vertex_count(), true);
    for (int v = 0; v < map_.vertex_count(); ++v) {
      const auto& here = at_vertex_[v];
      if (here.empty()) continue;
      inner_[v] = here.size() == 2 && goes_on(here[0] / 2, here[1] / 2);
      if (inner_[v]) edges_->join(here[0] / 2, here[1] / 2);
    }
  }

  [[nodiscard]] bool goes_on(int e, int f) const {
    return names_[e].kind == names_[f].kind &&
           map_.implicit_form(e) == map_.implicit_form(f);
  }

  [[nodiscard]] bool is_away(const PlanePoint& p) const {
    const ExactPoint x = plane_->lift(p);
    for (const SourcePatch& patch : events_->patches) {
      const auto& n = patch.plane.exact;
      Rational h = rational(n[3]);
      for (int i = 0; i < 3; ++i) h += rational(n[i]) * x[i];
      if (h <= 0) continue;
      for (const LightPoint* c : patch.corners) {
        Rational above = 0;
        const Rational w = rational(c->exact[3]);
        for (int i = 0; i < 3; ++i)
          above += plane_->normal()[i] * (rational(c->exact[i]) / w - x[i]);
        if (above > 0) return false;
      }
    }
    return true;
  }

  void add_faces() {
    number_.assign(seen_.size(), -1);
    const auto& outline = plane_->outline();
    double size = 0;
    for (const auto& ring : outline) {
      for (const PlanePoint& p : ring) {
        size = std::max({size, std::abs(nearest_double(p[0] - outline[0][0][0])),
                         std::abs(nearest_double(p[1] - outline[0][0][1]))});
      }
    }
    for (int f = 0; f < map_.face_count(); ++f) {
      const int root = faces_->root(f);
      const double area = map_.area(f) * plane_->area_factor();
      if (root == f) {
        number_[f] = static_cast<int>(out_.mesh.faces.size());
        const ExactPoint inside = plane_->lift(seen_[f].inside);
        const bool away =
            seen_[f].shadow == ShadowClass::Umbra && is_away(seen_[f].inside);
        out_.mesh.faces.push_back(
            {seen_[f].shadow, seen_[f].structure, 0, away, rounded(inside)});
      } else {
        number_[f] = number_[root];
      }
      ShadowMesh::Face& face = out_.mesh.faces[number_[f]];
      face.area += area;
      out_.areas[static_cast<int>(face.shadow)] += area;
      if (face.away) out_.away_area += area;
    }
    // planar_map.h: some 1e-15 of the square of the size for each edge of a face.
    out_.error_bound =
        4e-15 * size * size * plane_->area_factor() * map_.half_edge_count();
  }

  // From each end of a chain of the map's edges along it.
  void add_edges() {
    vertex_number_.assign(map_.vertex_count(), -1);
    std::vector<bool> done(map_.edge_count(), false);
    const auto begin_at = [&](int h) {
      if (!done[h / 2]) add_edge(h, done);
    };
    for (int v = 0; v < map_.vertex_count(); ++v) {
      if (inner_[v]) continue;
      for (const int h : at_vertex_[v]) begin_at(h);
    }
    for (int e = 0; e < map_.edge_count(); ++e) {  // closed curves
      if (kept_[e]) begin_at(2 * e);
    }
  }

  void add_edge(int first, std::vector<bool>& done) {
    ShadowMesh::Edge edge;
    edge.kind = names_[first / 2].kind;
    edge.left = face_number(first);
    edge.right = face_number(first ^ 1);
    if (edge.kind != ShadowEdgeKind::Boundary &&
        structure_at(first) != structure_at(first ^ 1))
      edge.order = order_of(edge.kind);
    const auto conic = map_.implicit_form(first / 2);
    for (int i = 0; i < 6; ++i) edge.conic[i] = nearest_double(conic[i]);
    edge.ends[0] = vertex(map_.origin(first));
    int h = first;
    while (true) {
      done[h / 2] = true;
      const auto& generators = names_[h / 2].generators;
      edge.generators.insert(edge.generators.end(), generators.begin(), generators.end());
      append(h, edge.polyline);
      const int v = map_.target(h);
      if (!inner_[v]) break;
      const auto& here = at_vertex_[v];
      h = here[0] == (h ^ 1) ? here[1] : here[0];
      if (done[h / 2]) break;
    }
    std::ranges::sort(edge.generators);
    edge.generators.erase(std::ranges::unique(edge.generators).begin(),
                          edge.generators.end());
    edge.ends[1] = vertex(map_.target(h));
    out_.mesh.edges.push_back(std::move(edge));
  }

  void append(int h, std::vector<Eigen::Vector2d>& polyline) const {
    const int e = h / 2;
    std::vector<Eigen::Vector2d> points;
    constexpr int kSteps = 8;
    const int steps = map_.straight(e) ? 1 : kSteps;
    for (int i = 0; i <= steps; ++i)
      points.push_back(map_.point(e, static_cast<double>(i) / steps));
    if (h % 2 == 1) std::ranges::reverse(points);
    polyline.insert(polyline.end(), points.begin() + (polyline.empty() ? 0 : 1),
                    points.end());
  }

  [[nodiscard]] int face_number(int half_edge) const {
    const int f = map_.face(half_edge);
    return f == PlanarMap::kOutside ? -1 : number_[f];
  }

  int vertex(int v) {
    if (vertex_number_[v] < 0) {
      vertex_number_[v] = static_cast<int>(out_.mesh.vertices.size());
      out_.mesh.vertices.push_back(map_.vertex(v).at);
    }
    return vertex_number_[v];
  }

  // Umbra goes on across an edge whose points are umbra, too.
  void count_umbrae() {
    Classes parts(seen_.size());
    for (int e = 0; e < map_.edge_count(); ++e) {
      const int f = map_.face(2 * e), g = map_.face(2 * e + 1);
      if (f == PlanarMap::kOutside || g == PlanarMap::kOutside || f == g) continue;
      if (seen_[f].shadow != ShadowClass::Umbra || seen_[g].shadow != ShadowClass::Umbra)
        continue;
      if (!kept_[e] || ask(map_.exact_point(e)).shadow == ShadowClass::Umbra)
        parts.join(f, g);
    }
    for (int f = 0; f < map_.face_count(); ++f) {
      if (seen_[f].shadow == ShadowClass::Umbra && parts.root(f) == f)
        ++out_.umbra_components;
    }
  }

  const ReceiverPlane* plane_;
  const ReceiverCurves* curves_;
  const LightEvents* events_;
  const BackprojectionIndex* light_;
  const Request* request_;
  StructureTable* structures_;
  PlanarMap map_;
  std::vector<FaceSeen> seen_;  // by face of the map
  std::vector<Name> names_;     // by edge of the map
  std::vector<bool> kept_;
  std::optional<Classes> faces_, edges_;
  std::vector<std::vector<int>> at_vertex_;  // half-edges that are kept
  std::vector<bool> inner_;  // vertices at which nothing that is kept ends
  std::vector<int> number_, vertex_number_;
  MeshAndAreas out_;
};

}  // namespace

MeshAndAreas make_mesh(const ReceiverPlane& plane, const ReceiverCurves& curves,
                       int facet, const LightEvents& events,
                       const BackprojectionIndex& light, StructureTable& structures,
                       const Request& request) {
  return MeshMaker(plane, curves, facet, events, light, structures, request).make();
}

}  // namespace sightline::internal
