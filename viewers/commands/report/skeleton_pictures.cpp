#include "viewers/commands/report/skeleton_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "viewers/answer.h"
#include "viewers/envelope.h"
#include "viewers/json_text.h"
#include "viewers/kinds.h"
#include "viewers/palette.h"
#include "viewers/picture.h"

namespace sightline::viewers {
namespace {

/// How many strips and nodes a picture and a strip block take before they tell less.
constexpr std::size_t kDrawnNodes = 2500, kDrawnStrips = 400;

int object_of_vertex(const Scene& scene, int vertex) {
  return scene.edges()[scene.edges_at(vertex)[0]].object;
}

/// The largest set of EV arcs with one key; arcs without a key do not count.
template <typename Key>
std::vector<int> busiest(const Skeleton& skeleton, const Key& key) {
  std::map<int, std::vector<int>> by_key;
  for (std::size_t i = 0; i < skeleton.ev_count(); ++i) {
    if (const std::optional<int> k = key(skeleton.arcs[i])) {
      by_key[*k].push_back(static_cast<int>(i));
    }
  }
  std::vector<int> best;
  for (auto& [k, arcs] : by_key) {
    if (arcs.size() > best.size()) best = std::move(arcs);
  }
  return best;
}

std::optional<int> showiest_eee(const Scene& scene, const Skeleton& skeleton,
                                const std::vector<char>& inner) {
  std::optional<int> best;
  std::pair<bool, double> best_score;
  for (std::size_t i = skeleton.ev_count(); i < skeleton.arcs.size(); ++i) {
    const SkeletonArc& arc = skeleton.arcs[i];
    const bool all_inner = std::ranges::all_of(
        arc.edges(), [&](int e) { return inner[scene.edges()[e].object] != 0; });
    const bool both_eeee = std::ranges::all_of(arc.nodes, [&](std::uint32_t n) {
      return skeleton.nodes[n].kind == NodeKind::EEEE;
    });
    // A smaller one that shows both its EEEE ends still tells more.
    const std::pair score{all_inner, (both_eeee ? 8 : 1) * spanned_volume(scene, arc)};
    if (best && score <= best_score) continue;
    best_score = score;
    best = static_cast<int>(i);
  }
  return best;
}

std::optional<int> showiest_eeee(const Scene& scene, const Skeleton& skeleton) {
  // Of each node the smallest surface that ends there: all of them are to be seen.
  std::vector<std::optional<double>> smallest(skeleton.nodes.size());
  for (const SkeletonArc& arc : skeleton.eee()) {
    const double volume = spanned_volume(scene, arc);
    for (const std::uint32_t n : arc.nodes) {
      smallest[n] = std::min(smallest[n].value_or(volume), volume);
    }
  }
  std::optional<int> best;
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    if (skeleton.nodes[i].kind != NodeKind::EEEE || !smallest[i]) continue;
    if (best && *smallest[i] <= *smallest[*best]) continue;
    best = static_cast<int>(i);
  }
  return best;
}

PagePicture strips_picture(const SceneView& view, const Canvas& canvas,
                           const Scene& scene, const Skeleton& skeleton,
                           const std::vector<RuledStrip>& strips) {
  SceneView marked = view;
  const double crowd = static_cast<double>(strips.size());
  const auto opacity = static_cast<float>(std::clamp(6 / (crowd + 1), 0.05, 0.3));
  for (const RuledStrip& strip : strips) {
    add_strip(marked, scene, skeleton, strip, opacity);
  }
  return {"", encode_png(canvas.picture(marked.drawing)), "", ""};
}

std::string node_legend(const Json& counts) {
  std::string html = "<span class=legend>";
  for (const auto& [kind, count] : counts.items()) {
    if (!count.is_number() || count == 0) continue;
    html += fmt::format("<span><i class=chip style=\"background:{}\"></i>{}</span>",
                        hex(colour_of_kind(kind)), kind);
  }
  return html + "</span>";
}

std::string drawn_of(std::size_t drawn, std::size_t all, const char* what) {
  return drawn == all ? fmt::format("All {} {}.", all, what)
                      : fmt::format("{} of {} {}, evenly chosen.", drawn, all, what);
}

std::string pair_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                         const Skeleton& skeleton, const std::vector<int>& arcs) {
  SceneView marked = view;
  const double crowd = static_cast<double>(arcs.size());
  add_arcs(marked.drawing, scene, skeleton, arcs,
           static_cast<float>(std::clamp(2.5 / (crowd + 1), 0.02, 0.25)));
  std::set<int> ends;
  for (const int a : arcs) {
    for (const std::uint32_t n : skeleton.arcs[a].nodes) ends.insert(static_cast<int>(n));
  }
  add_nodes(marked.drawing, skeleton, std::vector<int>(ends.begin(), ends.end()),
            static_cast<float>(std::clamp(80 / (crowd + 1), 0.2, 0.9)), 1.4F);
  return encode_png(canvas.picture(marked.drawing));
}

std::string object_name(const Scene& scene, int edge) {
  return html_escaped(scene.objects()[scene.edges()[edge].object].name);
}

constexpr Colour kGeneratorEdge{0.95F, 0.35F, 0.05F};

PagePicture eee_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                        const Skeleton& skeleton, int id) {
  const SkeletonArc& arc = skeleton.arcs[id];
  SceneView marked = view;
  add_eee_arc(marked.drawing, scene, arc, 0.45F);
  const Colour colour = colour_of_kind(kind_name(arc));
  const auto swath = swath_of(scene, arc);
  constexpr int kLines = 24;
  for (int i = 1; swath && i < kLines; ++i) {
    const double s =
        arc.range[0] + (arc.range[1] - arc.range[0]) * static_cast<double>(i) / kLines;
    marked.drawing.strokes.push_back({swath->line(s), colour, 1.1F, 0.75F, 0.12F});
  }
  for (const int e : arc.edges()) {
    add_edge(marked.drawing, scene, e, kGeneratorEdge, 4.0F, 0.35F);
  }
  const std::vector<int> ends(arc.nodes.begin(), arc.nodes.end());
  add_nodes(marked.drawing, skeleton, ends, 1, 2.6F);
  const auto kind = [&](int end) { return kind_name(skeleton.nodes[arc.nodes[end]]); };
  return {
      "eee.png", encode_png(canvas.picture(marked.drawing)), "An EEE surface",
      fmt::format(
          "All lines that touch three edges (orange) of {}, {} and {}, in this order, "
          "with nothing between: one EEE line set, a piece of a ruled quadric, drawn "
          "between its outer edges. It ends in the lines of kind {} and {}. An eye "
          "that crosses this curved surface beyond the edges sees them part or join.",
          object_name(scene, arc.edges()[0]), object_name(scene, arc.edges()[1]),
          object_name(scene, arc.edges()[2]), kind(0), kind(1))};
}

PagePicture eeee_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                         const Skeleton& skeleton, int id) {
  const SkeletonNode& node = skeleton.nodes[id];
  SceneView marked = view;
  std::string names;
  for (const Generator& g : skeleton.generators(node)) {
    if (g.kind != GeneratorKind::Edge || g.id < 0) continue;
    add_edge(marked.drawing, scene, g.id, kGeneratorEdge, 4.0F, 0.35F);
    if (!names.empty()) names += ", ";
    names += object_name(scene, g.id);
  }
  std::size_t arcs = 0;
  for (const SkeletonArc& arc : skeleton.eee()) {
    if (std::ranges::find(arc.nodes, static_cast<std::uint32_t>(id)) == arc.nodes.end()) {
      continue;
    }
    add_eee_arc(marked.drawing, scene, arc, 0.3F);
    ++arcs;
  }
  marked.drawing.strokes.push_back(
      {node.segment, colour_of_kind(kind_name(node)), 3.2F, 1, 0.5F});
  return {
      "eeee.png", encode_png(canvas.picture(marked.drawing)), "An EEEE line",
      fmt::format("The line that touches four edges (orange) of {}, in this order: no "
                  "small move keeps all four contacts. {} EEE line sets end in it and "
                  "are drawn as surfaces.",
                  names, arcs)};
}

/// `arcs`: all EV arcs of one vertex, in the scene as `view` shows it.
PagePicture vertex_picture(const SceneView& view, const Canvas& canvas,
                           const Scene& scene, const SkeletonLines& lines,
                           const Skeleton& skeleton, const std::vector<int>& arcs) {
  const std::vector<RuledStrip> strips = strips_of(scene, lines, skeleton, arcs);
  PagePicture picture = strips_picture(view, canvas, scene, skeleton, strips);
  picture.file = "vertex.png";
  picture.title = "All events of one vertex";
  const Point& v = scene.point(skeleton.arcs[arcs[0]].vertex());
  picture.caption = fmt::format(
      "{} The vertex at ({:.4g}, {:.4g}, {:.4g}) and the silhouette edges it sees: "
      "each "
      "veil is one EV line set, out to the faces that end it. A light in that vertex "
      "would cast these shadow edges.",
      drawn_of(strips.size(), arcs.size(), "line sets"), v.x(), v.y(), v.z());
  return picture;
}

/// `arcs`: all EV arcs of one edge.
PagePicture edge_picture(const SceneView& view, const Canvas& canvas, const Scene& scene,
                         const SkeletonLines& lines, const Skeleton& skeleton,
                         const std::vector<int>& arcs) {
  const std::vector<RuledStrip> strips = strips_of(scene, lines, skeleton, arcs);
  PagePicture picture = strips_picture(view, canvas, scene, skeleton, strips);
  picture.file = "edge.png";
  picture.title = "All events of one edge";
  picture.caption = drawn_of(strips.size(), arcs.size(), "line sets") +
                    " The edge that most vertices see, out to the faces behind it. An "
                    "EV line set is a fan through its vertex.";
  return picture;
}

/// `arcs`: all EV arcs between two objects.
PagePicture objects_picture(const SceneView& view, const Canvas& canvas,
                            const Scene& scene, const Skeleton& skeleton,
                            const std::vector<int>& arcs) {
  const SkeletonArc& one = skeleton.arcs[arcs[0]];
  return {"pair.png", pair_picture(view, canvas, scene, skeleton, arcs),
          "Between two objects",
          fmt::format(
              "All {} EV arcs between {} and {}, each the triangle between its vertex "
              "and its part of the edge, with the lines at their ends. {}",
              arcs.size(),
              html_escaped(scene.objects()[object_of_vertex(scene, one.vertex())].name),
              html_escaped(scene.objects()[scene.edges()[one.edge()].object].name),
              "The same pair: <code>sightline skeleton --between A B</code>.")};
}

/// Nodes of all kinds, fainter the more there are.
PagePicture nodes_picture(const SceneView& view, const Canvas& canvas,
                          const Skeleton& skeleton) {
  SceneView overview = view;
  const std::vector<int> nodes = evenly_spread(skeleton.nodes.size(), kDrawnNodes);
  const double crowd = static_cast<double>(nodes.size());
  add_nodes(overview.drawing, skeleton, nodes,
            static_cast<float>(std::clamp(300 / (crowd + 1), 0.16, 0.9)),
            crowd > 500 ? 1.1F : 1.8F);
  return {"nodes.png", encode_png(canvas.picture(overview.drawing)),
          "Extremal stabbing lines",
          drawn_of(nodes.size(), skeleton.nodes.size(),
                   "lines, each between its outermost contacts") +
              " " + node_legend(node_counts(skeleton))};
}

}  // namespace

Highlights find_highlights(const Scene& scene, const Skeleton& skeleton) {
  std::vector<char> inner = envelope_objects(scene);
  const bool any = std::ranges::count(inner, 0) > 0;
  for (char& i : inner) i = any ? !i : 1;
  const int objects = static_cast<int>(scene.objects().size());
  const auto vertex_object = [&](const SkeletonArc& a) {
    return object_of_vertex(scene, a.vertex());
  };
  const auto edge_object = [&](const SkeletonArc& a) {
    return scene.edges()[a.edge()].object;
  };
  using Key = std::optional<int>;
  Highlights found;
  found.vertex = busiest(skeleton, [&](const SkeletonArc& a) {
    return inner[vertex_object(a)] ? Key(a.vertex()) : Key();
  });
  found.edge = busiest(skeleton, [&](const SkeletonArc& a) {
    return inner[edge_object(a)] ? Key(a.edge()) : Key();
  });
  if (objects < 40000) {  // the pair's number fits an int
    found.pair = busiest(skeleton, [&](const SkeletonArc& a) {
      const int u = vertex_object(a), v = edge_object(a);
      if (u == v || !inner[u] || !inner[v]) return Key();
      return Key(std::min(u, v) * objects + std::max(u, v));
    });
  }
  found.eee = showiest_eee(scene, skeleton, inner);
  found.eeee = showiest_eeee(scene, skeleton);
  return found;
}

std::vector<RuledStrip> strips_of(const Scene& scene, const SkeletonLines& lines,
                                  const Skeleton& skeleton,
                                  const std::vector<int>& arcs) {
  std::vector<RuledStrip> strips;
  for (const int arc : arcs) {
    if (strips.size() == kDrawnStrips) break;
    strips.push_back(ruled_strip(scene, lines, skeleton, arc, 17));
  }
  return strips;
}

std::vector<PagePicture> draw_pictures(const Scene& scene, const SkeletonLines& lines,
                                       const Skeleton& skeleton,
                                       const Highlights& highlights,
                                       const std::optional<std::array<Point, 2>>& region,
                                       int up_axis, const Request& request) {
  ViewOptions view_options;
  view_options.request = request;
  view_options.up_axis = up_axis;
  view_options.focus = region;
  SceneView view = view_scene(scene, view_options);
  if (region) add_box(view.drawing, *region, {0.84F, 0.15F, 0.24F});
  const Canvas canvas(view.drawing, view.camera, {.request = request});
  std::vector<PagePicture> pictures;
  if (!highlights.vertex.empty()) {
    pictures.push_back(
        vertex_picture(view, canvas, scene, lines, skeleton, highlights.vertex));
  }
  if (!highlights.edge.empty()) {
    pictures.push_back(
        edge_picture(view, canvas, scene, lines, skeleton, highlights.edge));
  }
  if (!highlights.pair.empty()) {
    pictures.push_back(objects_picture(view, canvas, scene, skeleton, highlights.pair));
  }
  if (highlights.eee) {
    pictures.push_back(eee_picture(view, canvas, scene, skeleton, *highlights.eee));
  }
  if (highlights.eeee) {
    pictures.push_back(eeee_picture(view, canvas, scene, skeleton, *highlights.eeee));
  }
  pictures.push_back(nodes_picture(view, canvas, skeleton));
  return pictures;
}

}  // namespace sightline::viewers
