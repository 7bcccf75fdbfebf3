#include "skeleton/nodes/node_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "linespace/numbers/rational.h"
#include "linespace/sight/free_segment.h"
#include "linespace/sight/line_probe.h"
#include "linespace/work/stop_scope.h"
#include "skeleton/nodes/known_lines.h"

namespace sightline::internal {
namespace {

// Positions on a line, which is given by its points at 0 and 1.
struct Reach {
  const std::array<ExactPoint, 2>& line;
  std::optional<Rational> from, to;  // none: without bound

  [[nodiscard]] bool has(const Rational& t) const {
    return (!from || *from <= t) && (!to || t <= *to);
  }
  [[nodiscard]] bool has(const ExactPoint& p) const {
    const ExactPoint way = exact_difference(line[1], line[0]);
    std::size_t axis = 0;
    while (axis < 2 && way[axis] == 0) ++axis;
    return has(quotient(Rational(p[axis] - line[0][axis]), way[axis]));
  }
};

// What a contact is made of, within reach: corners, edges that are not flat, faces the
// line lies in.
std::vector<Generator> generators_of(const Silhouettes& g, const LineScan& scan,
                                     int contact, const Reach* reach = nullptr) {
  const Scene& scene = g.scene();
  std::vector<Generator> found;
  std::vector<int> facets;
  const auto add_edge = [&](int edge) {
    if (edge >= 0) found.push_back(g.named(edge));
  };
  // 1. Faces of the contact that the reach leaves out: those met only beyond its ends.
  const bool bounded = reach != nullptr && (reach->from || reach->to);
  const auto near =
      bounded ? scan.faces_within(contact, reach->from, reach->to) : std::vector<int>{};
  const auto in_reach = [&](int face) {
    return !bounded || std::ranges::binary_search(near, face);
  };
  // 2. What each face is touched in: a corner, a side, or along a stretch inside of it,
  // where the face itself is the generator.  A point inside a face that the line crosses
  // is none.
  for (const Touch& t : scan.touches(contact)) {
    if (!in_reach(t.face)) continue;
    const auto corners = scene.face_points(t.face);
    if (t.kind == TouchKind::Corner) {
      // Not every vertex of the file is a corner: none is in the middle of a wall.
      const int p = corners[t.index];
      if (g.star_of_point(p) >= 0) found.push_back({GeneratorKind::Vertex, p});
      // An edge that goes straight on here, whoever else has a corner.
      const auto n = static_cast<int>(corners.size());
      for (const int side : {t.index, (t.index + n - 1) % n}) {
        const int edge = scene.edge_of_side(t.face, side);
        if (edge < 0) continue;
        const auto& ends = scene.edges()[edge].points;
        if (ends[0] != p && ends[1] != p) add_edge(edge);
      }
    } else if (t.kind == TouchKind::Edge) {
      add_edge(scene.edge_of_side(t.face, t.index));
    } else if (t.kind == TouchKind::EdgeOn) {
      facets.push_back(scene.faces()[t.face].facet);
    }
  }
  // 3. A face that the line lies in tells no corners of its own: those on the line are
  // generators, too.
  for (const int p : scan.edge_on_corners(contact)) {
    const bool reached = !bounded || reach->has(exact_point(scene.point(p)));
    if (reached && g.star_of_point(p) >= 0) found.push_back({GeneratorKind::Vertex, p});
  }
  sort_unique(facets);
  // 4. A side through which the line leaves an edge-on face says nothing new: every line
  // in the face's plane leaves it through some side.
  std::erase_if(found, [&](const Generator& x) {
    if (x.kind != GeneratorKind::Edge) return false;
    // Of edges that coincide one stands for all: the facets at any of them count.
    const int ridge = g.ridge_of_edge(x.id);
    if (ridge >= 0) return share(g.ridges()[ridge].all_facets, facets);
    const auto& sides = scene.edges()[x.id].sides;
    return std::any_of(sides.begin(), sides.end(), [&](const Edge::Side& s) {
      return std::binary_search(facets.begin(), facets.end(),
                                scene.faces()[s.face].facet);
    });
  });
  // 5. The facets come last and the list is sorted: equal contacts have equal lists.
  for (const int f : facets) found.push_back({GeneratorKind::Face, f});
  sort_unique(found);
  return found;
}

// From the first to the last of these contacts of a line; none where one of them blocks:
// an end contact is met by a segment that ends there, but not by others that it stops.
std::optional<std::array<Rational, 2>> free_part(const LineScan& scan, int first,
                                                 int last) {
  for (int c = first; c <= last; ++c) {
    if (scan.blocked(c)) return std::nullopt;
  }
  return std::array<Rational, 2>{scan.from(first), scan.to(last)};
}

// The kind that exactly these contacts make, in the order of the line or reversed.
std::optional<NodeKind> kind_of(std::vector<std::vector<Generator>> groups) {
  std::erase_if(groups, [](const auto& x) { return x.empty(); });
  const auto is = [](const std::vector<Generator>& group,
                     std::initializer_list<GeneratorKind> kinds) {
    return std::equal(group.begin(), group.end(), kinds.begin(), kinds.end(),
                      [](const Generator& x, GeneratorKind k) { return x.kind == k; });
  };
  constexpr auto v = GeneratorKind::Vertex;
  constexpr auto e = GeneratorKind::Edge;
  constexpr auto f = GeneratorKind::Face;
  for (int turn = 0; turn < 2; ++turn) {
    const auto n = groups.size();
    if (n == 2 && is(groups[0], {v}) && is(groups[1], {v})) return NodeKind::VV;
    if (n == 2 && is(groups[0], {v, f}) && is(groups[1], {e})) return NodeKind::FvE;
    if (n == 3 && is(groups[0], {v}) && is(groups[1], {e}) && is(groups[2], {e})) {
      return NodeKind::VEE;
    }
    if (n == 3 && is(groups[0], {e}) && is(groups[1], {v}) && is(groups[2], {e})) {
      return NodeKind::EVE;
    }
    if (n == 4 && is(groups[0], {e}) && is(groups[1], {e}) && is(groups[2], {e}) &&
        is(groups[3], {e})) {
      return NodeKind::EEEE;
    }
    if (n == 3 && is(groups[0], {f}) && is(groups[1], {e}) && is(groups[2], {e})) {
      return NodeKind::FEE;
    }
    if (n == 3 && is(groups[0], {e}) && is(groups[1], {f}) && is(groups[2], {e})) {
      return NodeKind::FEE;
    }
    std::reverse(groups.begin(), groups.end());
  }
  return std::nullopt;
}

// Two contacts on one and the same object: all generators of each are on it alone.
bool two_on_one_object(const Silhouettes& g,
                       const std::vector<std::vector<Generator>>& groups) {
  std::vector<std::int32_t> single;
  for (const auto& group : groups) {
    std::vector<std::int32_t> o;
    for (const Generator& x : group) {
      const auto more = g.objects_of(x);
      o.insert(o.end(), more.begin(), more.end());
    }
    sort_unique(o);
    if (o.size() != 1) continue;
    if (std::find(single.begin(), single.end(), o[0]) != single.end()) return true;
    single.push_back(o[0]);
  }
  return false;
}

// The facets whose inside the line crosses at a contact, ascending; not those with an
// edge or a corner there.
std::vector<std::int32_t> crossed_facets(const Silhouettes& g, const LineScan& scan,
                                         int contact) {
  const Scene& scene = g.scene();
  std::vector<std::int32_t> facets;
  std::vector<std::int32_t> met_at_border;
  for (const Touch& t : scan.touches(contact)) {
    const int facet = scene.faces()[t.face].facet;
    const int n = static_cast<int>(scene.face_points(t.face).size());
    const auto is_edge = [&](int side) { return scene.edge_of_side(t.face, side) >= 0; };
    const bool at_border = t.kind == TouchKind::EdgeOn ||
                           (t.kind == TouchKind::Edge && is_edge(t.index)) ||
                           (t.kind == TouchKind::Corner &&
                            (is_edge(t.index) || is_edge((t.index + n - 1) % n)));
    (at_border ? met_at_border : facets).push_back(facet);
  }
  sort_unique(facets);
  std::erase_if(facets, [&](std::int32_t f) {
    return std::find(met_at_border.begin(), met_at_border.end(), f) !=
           met_at_border.end();
  });
  return facets;
}

// Lines of an EV or EEE arc, without further contacts: the last of them is where one of
// its outer edges enters a face (Pierce), or two edges at its corner line up (Saddle).
// `contacts`: those that the groups are of.  The corner of an EV arc is listed first,
// then the face.
void name_end_of_arc(const Silhouettes& g, const LineScan& scan,
                     std::span<const int> contacts,
                     const std::vector<std::vector<Generator>>& groups,
                     NodeContacts& node) {
  if (node.kind != NodeKind::Degenerate || groups.size() < 2 || groups.size() > 3) return;
  std::vector<Generator> line;
  for (const auto& group : groups) {
    if (group.size() != 1) return;
    line.push_back(group[0]);
  }
  const std::size_t n = line.size();
  const auto is = [&](std::size_t i, GeneratorKind kind) { return line[i].kind == kind; };
  constexpr auto e = GeneratorKind::Edge;
  const bool ev = n == 2 && is(0, e) != is(1, e) && !is(0, GeneratorKind::Face) &&
                  !is(1, GeneratorKind::Face);
  const bool eee = n == 3 && is(0, e) && is(1, e) && is(2, e);
  if (!ev && !eee) return;
  std::size_t faces = 0;
  std::size_t at = 0;
  std::int32_t face = -1;
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<std::int32_t> crossed = crossed_facets(g, scan, contacts[i]);
    faces += crossed.size();
    if (crossed.empty()) continue;
    at = i;
    face = crossed[0];
  }
  if (faces > 1 || (faces == 0 && !ev)) return;
  if (faces == 1 && (!is(at, e) || (at > 0 && at + 1 < n))) return;
  node.kind = faces == 0 ? NodeKind::Saddle : NodeKind::Pierce;
  node.end = false;
  node.ends = {};
  if (faces == 1) {
    line.insert(line.begin() + (at == 0 ? 1 : static_cast<std::ptrdiff_t>(at)),
                {GeneratorKind::Face, face});
  }
  node.turned = ev ? is(0, e) : line.back() < line.front();
  if (node.turned) std::reverse(line.begin(), line.end());
  node.generators = std::move(line);
}

NodeContacts node_of(const Silhouettes& g,
                     const std::vector<std::vector<Generator>>& groups) {
  NodeContacts node;
  node.kind = kind_of(groups).value_or(NodeKind::Degenerate);
  node.self = two_on_one_object(g, groups);
  for (const auto& group : groups) {
    node.generators.insert(node.generators.end(), group.begin(), group.end());
  }
  return node;
}

}  // namespace

NodeContacts node_along(const Silhouettes& g,
                        const std::vector<std::vector<Generator>>& groups) {
  NodeContacts node = node_of(g, groups);
  std::vector<Generator> reversed;
  for (auto group = groups.rbegin(); group != groups.rend(); ++group) {
    reversed.insert(reversed.end(), group->begin(), group->end());
  }
  node.turned = reversed < node.generators;
  node.both_ways = reversed == node.generators;
  if (node.turned) node.generators = reversed;
  return node;
}

NodeContacts contacts_between(const Silhouettes& g, const LineScan& scan) {
  std::vector<std::vector<Generator>> groups;
  std::vector<int> contacts;
  bool free = true;
  for (int i = 0; i < scan.size(); ++i) {
    if (!meets_segment(scan, i)) continue;
    free = free && !blocks_segment(g, scan, i);
    groups.push_back(generators_of(g, scan, i));
    contacts.push_back(i);
  }
  NodeContacts node = node_of(g, groups);
  node.end = !free;
  if (!free && g.polygon()) node.ends = blocked_ends(g, scan).value_or(node.ends);
  name_end_of_arc(g, scan, contacts, groups, node);
  return node;
}

NodeContacts contacts_along(const Silhouettes& g, const LineScan& scan,
                            const std::array<ExactPoint, 2>& line, bool end, bool grazes,
                            const LineName* name) {
  // 1. The contacts that the line is given by: the one at position 0 and the one at 1.
  int first = -1;
  int last = -1;
  for (int c = 0; c < scan.size() && scan.from_against(c, 1) <= 0; ++c) {
    if (scan.from_against(c, 0) <= 0 && scan.to_against(c, 0) >= 0) first = c;
    if (scan.to_against(c, 1) >= 0) last = c;
  }
  // Without a contact at both the line is none of a node.
  if (first < 0 || last < 0) return {};
  const bool polygon = g.polygon();
  // 2. Polygon mode: which of the two contacts the line ends at, so that nothing is seen
  // beyond.
  std::array<bool, 2> stops_at{};
  if (polygon && !grazes && end) {
    stops_at = blocked_ends(g, scan).value_or(std::array<bool, 2>{
        blocks_segment(g, scan, first), blocks_segment(g, scan, last)});
  }
  // 3. The other contacts on the maximal free segment, step by step beyond the two.  In
  // polygon mode the contact that ends the segment counts, too, where it has generators.
  const auto go_on = [&](int contact, int step) -> FreeEnd {
    FreeEnd reached = last_contact(g, scan, contact, step);
    const int next = reached.contact + step;
    if (!polygon || grazes || reached.stop) return reached;
    const bool ends = next >= 0 && next < scan.size() && scan.blocked(next) &&
                      !generators_of(g, scan, next).empty();
    return ends ? FreeEnd{next, stop_in(g, scan, next, step)} : reached;
  };
  // A contact that ends the line is its last one; it may stop the line within itself, at
  // a position that FreeEnd tells.
  const auto end_at = [&](int contact, int step, bool stops) -> FreeEnd {
    return stops ? FreeEnd{contact, stop_in(g, scan, contact, step)}
                 : go_on(contact, step);
  };
  FreeEnd low = end_at(first, -1, stops_at[0]);
  FreeEnd high = end_at(last, 1, stops_at[1]);
  first = low.contact;
  last = high.contact;
  // 4. The generators of each contact, as far as the segment reaches: what lies behind
  // the foot of a wall, in the plane of another, is not reached.
  std::vector<std::vector<Generator>> groups;
  const Reach reach{line, std::move(low.stop), std::move(high.stop)};
  std::vector<int> contacts;
  for (int c = first; c <= last; ++c) {
    groups.push_back(generators_of(g, scan, c, &reach));
    contacts.push_back(c);
  }
  // 5. Its kind, and the segment between its outermost contacts.  Generators are listed
  // from the end with the smaller one; `turned` says that this is the far end.
  NodeContacts node = node_along(g, groups);
  name_end_of_arc(g, scan, contacts, groups, node);
  const auto point_at = [&](const Rational& t) {
    return rounded(t == 0 ? line[0] : t == 1 ? line[1] : along(line[0], line[1], t));
  };
  node.segment = {point_at(scan.from(first)), point_at(scan.to(last))};
  if (node.turned) std::swap(node.segment[0], node.segment[1]);
  // 6. What only some kinds have.  A degenerate line is named by itself: its contacts do
  // not tell it from others.
  if (ends_one_arc(node.kind)) return node;
  if (node.kind == NodeKind::Degenerate) {
    node.line = name != nullptr ? *name : name_of_line(line);
    if (!polygon && !node.both_ways) node.free_part = free_part(scan, first, last);
  }
  // FEE: a line along a face that ends where the face does.
  const bool stops = reach.from || reach.to;
  node.end = end || (node.kind == NodeKind::FEE && stops);
  if (polygon && (!grazes || node.end)) {
    // Along the line; the node tells them in the order of its generators.
    const std::array<bool, 2> ends{stops_at[0] || reach.from, stops_at[1] || reach.to};
    node.ends = {ends[node.turned ? 1 : 0], ends[node.turned ? 0 : 1]};
    node.end = node.end || ends[0] || ends[1];
  }
  return node;
}

LineContacts contacts_of_line(const Silhouettes& g, KnownLines& known,
                              const std::array<ExactPoint, 2>& line,
                              const LineQuestion& question) {
  const bool may_be_known = !g.polygon() && !question.end.value_or(false);
  if (may_be_known) {
    if (const NodeContacts* before = known.find(line)) return {*before, {}, false};
  }
  const Point a = rounded(line[0]);
  const Point b = rounded(line[1]);
  // In polygon mode the wall that ends the line may be listed, with all that touches it.
  const auto faces =
      g.polygon() ? faces_near_line(g, a, b) : faces_near_free_segment(g, a, b);
  const LineScan scan(g.scene(), faces, line[0], line[1]);
  LineContacts found;
  if (question.end) {
    found.end = *question.end;
  } else if (!is_free(g, scan)) {
    found.between = contacts_between(g, scan);
    found.end = found.between->end;
  }
  found.along = contacts_along(g, scan, line, found.end, question.grazes,
                               may_be_known ? &known.name() : nullptr);
  if (question.between && !found.between && found.along.kind != NodeKind::Degenerate) {
    found.between = contacts_between(g, scan);
  }
  if (may_be_known && !found.end) known.keep(found.along);
  return found;
}

}  // namespace sightline::internal
