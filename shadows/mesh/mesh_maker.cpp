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
    count_umbrae();
    drop_edges();
    add_faces();
    find_chains();
    add_edges();
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
  [[nodiscard]] Name name_of(const PlanarMap& map, int e) const {
    if (map.on_outline(e)) return {ShadowEdgeKind::Boundary, {}};
    Name name{ShadowEdgeKind::EEE, {}};
    for (const int c : map.curves(e))
      name.kind = std::min(name.kind, curves_->names[c].kind);
    for (const int c : map.curves(e)) {
      if (curves_->names[c].kind == name.kind) add(name, curves_->names[c].generators);
    }
    return name;
  }
  static void add(Name& name, const std::vector<std::string>& generators) {
    name.generators.insert(name.generators.end(), generators.begin(), generators.end());
    std::ranges::sort(name.generators);
    name.generators.erase(std::ranges::unique(name.generators).begin(),
                          name.generators.end());
  }

  // The mesh is the map without the edges along which nothing changes.
  void drop_edges() {
    std::vector<int> dropped;
    for (int e = 0; e < map_.edge_count(); ++e) {
      if (map_.on_outline(e) || is_always_edge(name_of(map_, e).kind)) continue;
      const int left = map_.face(2 * e), right = map_.face(2 * e + 1);
      if (seen_[left].structure == seen_[right].structure) dropped.push_back(e);
    }
    ReducedMap reduced = map_.without(dropped);
    mesh_ = std::move(reduced.map);
    some_face_.assign(mesh_->face_count(), -1);
    for (int f = map_.face_count(); f-- > 0;) some_face_[reduced.face_of[f]] = f;
    for (int e = 0; e < mesh_->edge_count(); ++e) names_.push_back(name_of(*mesh_, e));
  }

  // Two edges that end at a vertex where nothing else does are one, if they are of one
  // kind and go on straight or along one curve, by whatever generators.
  void find_chains() {
    for (int v = 0; v < mesh_->vertex_count(); ++v) {
      const auto star = mesh_->star(v);
      inner_.push_back(star.size() == 2 && goes_on(star[0] / 2, star[1] / 2));
    }
  }

  [[nodiscard]] bool goes_on(int e, int f) const {
    return names_[e].kind == names_[f].kind &&
           mesh_->implicit_form(e) == mesh_->implicit_form(f);
  }

  [[nodiscard]] bool is_away(const PlanePoint& p) const {
    const ExactPoint x = plane_->lift(p);
    for (const SourcePatch& patch : events_->patches) {
      const auto& n = patch.plane.exact;
      Rational h = rational(n[3]);
      for (int i = 0; i < 3; ++i) h += rational(n[i]) * x[i];
      if (h <= 0) continue;
      // Not its corners, of which some are feet of blockers beside the source.
      for (const Point& c : patch.hull) {
        Rational above = 0;
        for (int i = 0; i < 3; ++i)
          above += plane_->normal()[i] * (Rational(c[i]) - x[i]);
        if (above > 0) return false;
      }
    }
    return true;
  }

  void add_faces() {
    for (int f = 0; f < mesh_->face_count(); ++f) {
      const FaceSeen& seen = seen_[some_face_[f]];
      const ShadowMesh::Face face{
          seen.shadow, seen.structure, mesh_->area(f) * plane_->area_factor(),
          seen.shadow == ShadowClass::Umbra && is_away(seen.inside),
          rounded(plane_->lift(seen.inside))};
      out_.areas[static_cast<int>(face.shadow)] += face.area;
      if (face.away) out_.away_area += face.area;
      out_.mesh.faces.push_back(face);
    }
    for (int v = 0; v < mesh_->vertex_count(); ++v) number_.push_back(-1);
    // planar_map.h: some 1e-15 of the square of the size for each edge of a face.
    const double size = plane_->size();
    out_.error_bound =
        4e-15 * size * size * plane_->area_factor() * mesh_->half_edge_count();
  }

  // From each end of a chain of the map's edges along it; then the closed ones.
  void add_edges() {
    std::vector<bool> done(mesh_->edge_count(), false);
    for (int v = 0; v < mesh_->vertex_count(); ++v) {
      if (inner_[v]) continue;
      for (const int h : mesh_->star(v)) {
        if (!done[h / 2]) add_edge(h, done);
      }
    }
    for (int e = 0; e < mesh_->edge_count(); ++e) {
      if (!done[e]) add_edge(2 * e, done);
    }
  }

  void add_edge(int first, std::vector<bool>& done) {
    ShadowMesh::Edge edge;
    edge.left = mesh_->face(first);
    edge.right = mesh_->face(first ^ 1);
    const auto conic = mesh_->implicit_form(first / 2);
    for (int i = 0; i < 6; ++i) edge.conic[i] = nearest_double(conic[i]);
    edge.ends[0] = vertex(mesh_->origin(first));
    Name name{names_[first / 2].kind, {}};
    int h = first;
    while (true) {
      done[h / 2] = true;
      add(name, names_[h / 2].generators);
      append(h, edge.polyline);
      const int v = mesh_->target(h);
      if (!inner_[v]) break;
      const auto star = mesh_->star(v);
      const int next = star[0] == (h ^ 1) ? star[1] : star[0];
      if (done[next / 2]) break;
      h = next;
    }
    edge.ends[1] = vertex(mesh_->target(h));
    edge.kind = name.kind;
    edge.generators = std::move(name.generators);
    const bool changes = structure_at(edge.left) != structure_at(edge.right);
    if (edge.kind != ShadowEdgeKind::Boundary && changes)
      edge.order = order_of(edge.kind);
    out_.mesh.edges.push_back(std::move(edge));
  }

  [[nodiscard]] int structure_at(int face) const {
    return face < 0 ? -1 : out_.mesh.faces[face].structure;
  }

  void append(int h, std::vector<Eigen::Vector2d>& polyline) const {
    constexpr int kSteps = 8;  // of a conic's piece
    const int e = h / 2, steps = mesh_->straight(e) ? 1 : kSteps;
    for (int i = polyline.empty() ? 0 : 1; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      polyline.push_back(mesh_->point(e, h % 2 == 0 ? t : 1 - t));
    }
  }

  int vertex(int v) {
    if (number_[v] < 0) {
      number_[v] = static_cast<int>(out_.mesh.vertices.size());
      out_.mesh.vertices.push_back(mesh_->vertex(v).at);
    }
    return number_[v];
  }

  // Umbra goes on across an edge whose points are umbra, too.
  void count_umbrae() {
    Classes parts(seen_.size());
    for (int e = 0; e < map_.edge_count(); ++e) {
      const int f = map_.face(2 * e), g = map_.face(2 * e + 1);
      if (f == PlanarMap::kOutside || g == PlanarMap::kOutside || f == g) continue;
      if (seen_[f].shadow != ShadowClass::Umbra || seen_[g].shadow != ShadowClass::Umbra)
        continue;
      const bool everywhere = !is_always_edge(name_of(map_, e).kind);
      if (everywhere || ask(map_.exact_point(e)).shadow == ShadowClass::Umbra)
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
  PlanarMap map_;               // of all curves
  std::vector<FaceSeen> seen_;  // by face of map_
  // The map without edges along which nothing changes, and of that:
  std::optional<PlanarMap> mesh_;
  std::vector<int> some_face_;  // by face, one of map_ that is a part of it
  std::vector<Name> names_;     // by edge
  std::vector<bool> inner_;     // by vertex: an edge of the answer goes on there
  std::vector<int> number_;     // by vertex, in the answer; -1 not yet
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
