#include "linespace/path/path_names.h"

#include <algorithm>
#include <tuple>

namespace sightline::internal {
namespace {

// The map of a view in words: vertices by what they are in the scene, edges by their
// lines and ends, regions by their patches and walks.  Unlike PointView::structure it is
// there for views that are not general.
class MapText {
 public:
  MapText(const PathScene& scene, const PointView& view) : scene_(&scene), view_(&view) {}

  using Words = std::vector<int>;
  // Ascending, each list sorted as far as its order says nothing.
  struct Text {
    std::vector<Words> edges;
    std::vector<std::vector<Words>> regions;
    friend bool operator==(const Text&, const Text&) = default;
  };

  [[nodiscard]] Text text() const {
    const std::vector<Words> vertices = vertex_words();
    std::vector<Words> edges;
    std::vector<bool> turned;
    for (const MapEdge& e : view_->edges) {
      const Words *from = &vertices[e.ends[0]], *to = &vertices[e.ends[1]];
      turned.push_back(*to < *from);
      if (turned.back()) std::swap(from, to);
      // As in PointView::structure, a boundary counts as a silhouette.
      const MapEdgeKind kind =
          e.kind == MapEdgeKind::Boundary ? MapEdgeKind::Silhouette : e.kind;
      Words words{whole(e.line), static_cast<int>(kind)};
      words.insert(words.end(), from->begin(), from->end());
      words.push_back(-2);
      words.insert(words.end(), to->begin(), to->end());
      edges.push_back(std::move(words));
    }
    Text text;
    text.edges = edges;
    std::ranges::sort(text.edges);
    const auto rank = [&](int e) {
      return static_cast<int>(std::ranges::lower_bound(text.edges, edges[e]) -
                              text.edges.begin());
    };
    for (const MapRegion& r : view_->regions) {
      std::vector<Words> walks;
      for (const auto& boundary : r.boundary) {
        Words walk;
        for (const int h : boundary) {
          const bool back = (h % 2 == 1) != turned[h / 2];
          walk.push_back(2 * rank(h / 2) + (back ? 1 : 0));
        }
        std::ranges::rotate(walk, std::ranges::min_element(walk));
        walks.push_back(std::move(walk));
      }
      std::ranges::sort(walks);
      walks.push_back(r.patches);
      text.regions.push_back(std::move(walks));
    }
    std::ranges::sort(text.regions);
    return text;
  }

 private:
  [[nodiscard]] int whole(const MapLine& name) const {
    const auto lines = scene_->lines_of(name);
    return lines.empty() ? -1 : scene_->scene().whole_line(lines[0]);
  }

  [[nodiscard]] std::vector<Words> vertex_words() const {
    std::vector<Words> ending(view_->vertices.size());
    for (const MapEdge& e : view_->edges) {
      for (const int v : e.ends) ending[v].push_back(whole(e.line));
    }
    std::vector<Words> words;
    for (std::size_t v = 0; v < ending.size(); ++v) {
      const MapVertex& vertex = view_->vertices[v];
      Words& some = words.emplace_back(Words{static_cast<int>(vertex.kind)});
      if (vertex.kind == MapVertexKind::Corner) {
        some.push_back(vertex.corner);
      } else if (vertex.kind == MapVertexKind::T) {
        some.push_back(whole(vertex.near));
        some.push_back(whole(vertex.far));
      } else {
        std::ranges::sort(ending[v]);
        some.insert(some.end(), ending[v].begin(), ending[v].end());
      }
    }
    return words;
  }

  const PathScene* scene_;
  const PointView* view_;
};

PathEventKind kind_of(AccidentKind kind) {
  switch (kind) {
    case AccidentKind::EdgeOn:
    case AccidentKind::EndOn:
      return PathEventKind::F;
    case AccidentKind::CornerOnEdge:
    case AccidentKind::CornerOnCorner:
    case AccidentKind::AlongEdge:
      return PathEventKind::EV;
    case AccidentKind::ThreeEdges:
      return PathEventKind::EEE;
    case AccidentKind::OnScene:
      return PathEventKind::Through;
  }
  return PathEventKind::EV;
}

// Facets on which the eye lies.
std::vector<int> facets_under(const Scene& scene, const PointView& view) {
  std::vector<int> facets;
  for (const int id : view.place_ids) {
    if (view.place == EyePlace::Facet) facets.push_back(id);
    if (view.place == EyePlace::Edge) {
      for (const Edge::Side& side : scene.edges()[id].sides)
        facets.push_back(scene.faces()[side.face].facet);
    }
    if (view.place == EyePlace::Corner) {
      for (const int face : scene.faces_at(id))
        facets.push_back(scene.faces()[face].facet);
    }
  }
  return facets;
}

}  // namespace

bool same_structure(const PathScene& scene, const PointView& x, const PointView& y) {
  if (x.general && y.general) return x.structure == y.structure;
  return MapText(scene, x).text() == MapText(scene, y).text();
}

std::vector<int> seen_only_in(const PointView& x, const PointView& y) {
  std::vector<int> facets;
  for (const SeenFacet& f : x.facets) {
    const bool there = std::ranges::any_of(y.facets, [&](const SeenFacet& h) {
      return h.facet == f.facet && h.front == f.front;
    });
    if (!there) facets.push_back(f.facet);
  }
  return facets;
}

namespace {

// From the facet's plane all that lies in it is seen in one line.  Does that alone bring
// the event's generators together: all of them, or two of three edges?
bool made_by(const Scene& scene, int facet, const PathEvent& event) {
  const auto t = plane_points(scene, scene.facets()[facet].faces.front());
  const auto holds = [&](int p) {
    return orient3d(scene.point(t[0]), scene.point(t[1]), scene.point(t[2]),
                    scene.point(p)) == Sign::Zero;
  };
  const auto beside = std::ranges::count_if(event.generators, [&](const Generator& g) {
    if (g.kind == GeneratorKind::Vertex) return !holds(g.id);
    if (g.kind == GeneratorKind::Edge) {
      return !std::ranges::all_of(scene.edges()[g.id].points, holds);
    }
    return g.id != facet;
  });
  const auto all = std::ssize(event.generators);
  return beside == 0 || (event.kind == PathEventKind::EEE && beside == 1 && all > 2);
}

}  // namespace

std::vector<PathEvent> events_of(const Scene& scene, const PointView& at,
                                 std::span<const Accident> before,
                                 std::span<const Accident> after) {
  const auto goes_on = [&](const Accident& a) {
    return std::ranges::binary_search(before, a) && std::ranges::binary_search(after, a);
  };
  const std::vector<int> under = facets_under(scene, at);
  std::vector<PathEvent> events, lesser;
  for (const Accident& a : at.accidents) {
    if (goes_on(a)) continue;
    const bool passed = a.kind == AccidentKind::EdgeOn &&
                        std::ranges::find(under, a.generators[0].id) != under.end();
    if (passed) continue;
    // An edge seen end-on is seen so with its facets; overlapping edges end somewhere.
    const bool less = a.kind == AccidentKind::EndOn || a.kind == AccidentKind::AlongEdge;
    (less ? lesser : events).push_back({kind_of(a.kind), a.generators});
  }
  if (events.empty()) events = std::move(lesser);
  // What lies in the plane of a facet that is seen edge-on belongs to that event.
  std::vector<int> edge_on = under;
  for (const Accident& a : at.accidents) {
    if (a.kind == AccidentKind::EdgeOn) edge_on.push_back(a.generators[0].id);
  }
  const auto part_of_another = [&](const PathEvent& e) {
    if (e.kind == PathEventKind::F || e.kind == PathEventKind::Through) return false;
    return std::ranges::any_of(edge_on,
                               [&](int facet) { return made_by(scene, facet, e); });
  };
  if (!std::ranges::all_of(events, part_of_another)) {
    std::erase_if(events, part_of_another);
  }
  std::ranges::sort(events);
  events.erase(std::ranges::unique(events).begin(), events.end());
  return events;
}

PathEvent event_of(const PathScene& scene, const Candidate& candidate) {
  PathEvent event{};
  const auto add_line = [&](int line) {
    const MapLine& name = scene.scene().lines()[line].name;
    if (name.edge >= 0) {
      event.generators.push_back({GeneratorKind::Edge, name.edge});
    } else {
      for (const int f : name.facets)
        event.generators.push_back({GeneratorKind::Face, f});
    }
  };
  const auto add_point = [&](int point) {
    const ScenePoint& p = scene.points()[point];
    if (p.id >= 0) {
      event.generators.push_back({GeneratorKind::Vertex, p.id});
    } else {
      for (const int line : p.lines) add_line(line);
    }
  };
  switch (candidate.kind) {
    case Candidate::Kind::LinePoint:
      event.kind = PathEventKind::EV;
      add_line(candidate.a);
      add_point(candidate.c);
      break;
    case Candidate::Kind::PointLine:
      event.kind = PathEventKind::EV;
      add_point(candidate.a);
      add_line(candidate.c);
      break;
    case Candidate::Kind::PairLine:
      event.kind = PathEventKind::EEE;
      for (const int line : {candidate.a, candidate.b, candidate.c}) add_line(line);
      break;
    case Candidate::Kind::EyeOnLine:
      event.kind = PathEventKind::Through;
      add_line(candidate.a);
      break;
    case Candidate::Kind::Plane:
      event.kind = PathEventKind::F;
      event.generators.push_back({GeneratorKind::Face, candidate.a});
      break;
  }
  std::ranges::sort(event.generators);
  event.generators.erase(std::ranges::unique(event.generators).begin(),
                         event.generators.end());
  return event;
}

bool is_seen(const Candidate& candidate, const PathScene& scene,
             const SeenElements& before, const SeenElements& after) {
  if (candidate.kind != Candidate::Kind::PairLine) return true;
  const int third = scene.scene().whole_line(candidate.c);
  for (const int line : {candidate.a, candidate.b}) {
    for (const LinePair& pair : {LinePair{line, third}, LinePair{third, line}}) {
      if (before.pairs().contains(pair) || after.pairs().contains(pair)) return true;
    }
  }
  return false;
}

}  // namespace sightline::internal
