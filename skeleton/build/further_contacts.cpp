#include "skeleton/build/further_contacts.h"

#include <utility>

#include "linespace/sight/line_probe.h"
#include "linespace/work/stop_scope.h"
#include "skeleton/nodes/known_lines.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {
namespace {

// Gives the node of that number its kind and its generators.
void name_node(VertexView& view, std::uint32_t id, const NodeContacts& contacts) {
  SkeletonNode& node = view.nodes[id];
  node.kind = contacts.kind;
  node.self = contacts.self;
  node.first_generator = static_cast<std::uint32_t>(view.pool.size());
  node.generator_count = static_cast<std::uint32_t>(contacts.generators.size());
  view.pool.insert(view.pool.end(), contacts.generators.begin(),
                   contacts.generators.end());
}

// Looks at the nodes of one view along their whole maximal free segments.
class FurtherContacts {
 public:
  FurtherContacts(const Silhouettes& g, const Star& star, LineProbe& probe,
                  KnownLines& known, VertexView& view)
      : g_(g),
        scene_(g.scene()),
        star_(star),
        probe_(probe),
        known_(known),
        view_(view),
        v_(scene_.point(star.point)),
        from_(exact_point(v_)),
        done_(view.nodes.size(), 0) {}

  // The node's line passes the cut of the arc's edge and `other`: the point of the arc on
  // the other side of an EVE node; without it, the viewpoint.
  void look_at(std::uint32_t id, std::size_t arc, const Cut& cut,
               const ExactPoint* other);

  [[nodiscard]] ExactPoint point_on(std::size_t arc, const Cut& cut) const {
    const LineThrough line = line_of(arc);
    return along(exact_point(line.from), exact_point(line.to),
                 exact_parameter(scene_, line, cut));
  }

 private:
  [[nodiscard]] LineThrough line_of(std::size_t arc) const {
    const auto& p = scene_.edges()[view_.arcs[arc].edge()].points;
    return {scene_.point(p[0]), scene_.point(p[1])};
  }
  [[nodiscard]] bool may_touch_more(const SkeletonNode& node, const LineThrough& edge,
                                    const Cut& cut) const;
  [[nodiscard]] bool may_end_along_face(const SkeletonNode& node,
                                        const LineThrough& edge) const;
  void take(std::uint32_t id, NodeContacts& all);

  const Silhouettes& g_;
  const Scene& scene_;
  const Star& star_;
  LineProbe& probe_;
  KnownLines& known_;
  VertexView& view_;
  const Point& v_;
  const ExactPoint from_;  // the viewpoint
  std::vector<std::uint8_t> done_;
};

// False proves that the line through the viewpoint and the cut touches nothing but the
// node's generators.
bool FurtherContacts::may_touch_more(const SkeletonNode& node, const LineThrough& edge,
                                     const Cut& cut) const {
  const Point& e0 = edge.from;
  const Point& e1 = edge.to;
  const Point x = e0 + cut.parameter() * (e1 - e0);
  // Half the enclosure, and the roundings of a difference, a product and a sum.
  const double error =
      (0.5 * (cut.hi - cut.lo) + 4 * kUnit) * (e1 - e0).cwiseAbs().sum() +
      4 * kUnit * (e0.cwiseAbs().sum() + x.cwiseAbs().sum());
  return probe_.may_touch_more(
      v_, x, error, {view_.pool.data() + node.first_generator, node.generator_count});
}

// FvE: the line leaves its face at a corner or, polygon mode, may be stopped on its way
// along the face by what touches it.
bool FurtherContacts::may_end_along_face(const SkeletonNode& node,
                                         const LineThrough& edge) const {
  if (node.kind != NodeKind::FvE) return false;
  const PlaneSide plane({v_, edge.from, edge.to});
  for (std::uint32_t k = 0; k < node.generator_count; ++k) {
    const Generator& x = view_.pool[node.first_generator + k];
    if (x.kind != GeneratorKind::Face) continue;
    if (g_.polygon() && g_.facet_touched(x.id)) return true;
    for (const int f : scene_.facets()[x.id].faces) {
      for (const int w : scene_.face_points(f)) {
        if (w != star_.point && plane(scene_.point(w)) == Sign::Zero) return true;
      }
    }
  }
  return false;
}

void FurtherContacts::look_at(std::uint32_t id, std::size_t arc, const Cut& cut,
                              const ExactPoint* other) {
  if (done_[id]) return;
  done_[id] = 1;
  SkeletonNode& node = view_.nodes[id];
  const LineThrough edge = line_of(arc);
  if (!view_.special[id] && !may_end_along_face(node, edge) &&
      !may_touch_more(node, edge, cut)) {
    return;
  }
  hear_stop_now();
  const ExactPoint x = point_on(arc, cut);
  const ExactPoint& start = other ? *other : from_;
  LineQuestion question{.grazes = view_.grazes[id] != 0};
  const bool named = view_.special[id] != VertexView::kUnnamed;
  if (named) question.end = node.end;
  question.between = !named;
  LineContacts found = contacts_of_line(g_, known_, {start, x}, question);
  NodeContacts& all = found.along;
  if (!named) {
    const bool keep = all.generators.empty() || all.kind != NodeKind::Degenerate;
    name_node(view_, id, keep ? found.between.value_or(NodeContacts{}) : NodeContacts{});
    node.end = found.end;
  }
  take(id, all);
}

// Gives the node the contacts of its whole line, where they are more than it has.
void FurtherContacts::take(std::uint32_t id, NodeContacts& all) {
  SkeletonNode& node = view_.nodes[id];
  if (all.generators.empty()) return;
  // Nothing new: only which outer contacts end the line.
  if (all.kind == node.kind && all.kind != NodeKind::Degenerate) {
    if (!g_.polygon() || ends_one_arc(all.kind)) return;
    const bool turned = view_.pool[node.first_generator] != all.generators.front();
    node.ends = {all.ends[turned ? 1 : 0], all.ends[turned ? 0 : 1]};
    node.end = all.end;
    return;
  }
  if (g_.polygon() && !ends_one_arc(all.kind)) {
    node.ends = all.ends;
    node.end = all.end;
  }
  node.segment = all.segment;
  view_.lines[id] = std::move(all.line);
  name_node(view_, id, all);
}

}  // namespace

void find_further_contacts(const Silhouettes& g, const Star& star, LineProbe& probe,
                           KnownLines& known, VertexView& view) {
  FurtherContacts contacts(g, star, probe, known, view);
  for (std::size_t i = 0; i < view.arcs.size(); ++i) {
    contacts.look_at(view.arcs[i].nodes[0], i, view.intervals[i].from, nullptr);
    contacts.look_at(view.arcs[i].nodes[1], i, view.intervals[i].to, nullptr);
  }
  for (const VertexView::LineUp& eve : view.line_ups) {
    // Where an outer contact ends the line it is not met from the vertex.
    const bool ends = !view.grazes[eve.node];
    const ExactPoint other =
        ends ? contacts.point_on(eve.other_arc, eve.other_cut) : ExactPoint{};
    contacts.look_at(eve.node, eve.arc, eve.cut, ends ? &other : nullptr);
  }
}

}  // namespace sightline::internal
