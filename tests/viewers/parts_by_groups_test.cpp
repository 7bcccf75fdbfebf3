// A part of the skeleton, built on its own, is that part of the whole.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <set>

#include "linespace/mesh_io.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_lines.h"
#include "tests/support/generators.h"
#include "viewers/drawing.h"
#include "viewers/kinds.h"

namespace sightline::viewers {
namespace {

struct Selection {
  std::optional<std::array<std::string, 2>> between;
  std::optional<std::string> through;
};

Skeleton build_selected(const Scene& scene, SkeletonRequest request,
                        const Selection& selection) {
  if (selection.between) {
    request.part.between_faces = {scene.faces_named((*selection.between)[0]),
                                  scene.faces_named((*selection.between)[1])};
  }
  if (selection.through) {
    request.part.through_faces = scene.faces_named(*selection.through);
    request.part.through_far_ends = true;
  }
  return build_skeleton(scene, request);
}

// Arcs and nodes as values: numbers of nodes differ between a part and the whole.
using NodeValue = std::pair<std::string, std::vector<Generator>>;
using ArcValue = std::tuple<std::vector<int>, double, double, NodeValue, NodeValue>;

NodeValue value_of(const Skeleton& skeleton, const SkeletonNode& node) {
  const auto generators = skeleton.generators(node);
  std::vector<Generator> forward(generators.begin(), generators.end());
  std::vector<Generator> backward(generators.rbegin(), generators.rend());
  return {kind_name(node) + (node.end ? " end" : "") + (node.second ? " second" : ""),
          std::min(forward, backward)};
}

template <typename Arc>
ArcValue value_of(const Skeleton& skeleton, const Arc& arc, std::vector<int> generators) {
  return {std::move(generators), arc.range[0], arc.range[1],
          value_of(skeleton, skeleton.nodes[arc.nodes[0]]),
          value_of(skeleton, skeleton.nodes[arc.nodes[1]])};
}

struct Values {
  std::vector<ArcValue> ev, eee;  // in order
  std::multiset<NodeValue> nodes;
};

using KeepEv = std::function<bool(const SkeletonArc&)>;
using KeepEee = std::function<bool(const SkeletonArc&)>;

/// The arcs kept, the nodes at their ends, and the EVE nodes both of whose EV arcs are.
Values values_of(const Skeleton& skeleton, bool with_ev, const KeepEv& keep_ev,
                 const KeepEee& keep_eee) {
  Values values;
  std::set<std::uint32_t> nodes;
  std::set<std::pair<int, int>> kept_ev;
  for (const SkeletonArc& arc : skeleton.ev()) {
    if (!keep_ev(arc)) continue;
    kept_ev.emplace(arc.vertex(), arc.edge());
    values.ev.push_back(value_of(skeleton, arc, {arc.vertex(), arc.edge()}));
    nodes.insert(arc.nodes.begin(), arc.nodes.end());
  }
  for (const SkeletonArc& arc : skeleton.eee()) {
    if (!keep_eee(arc)) continue;
    values.eee.push_back(
        value_of(skeleton, arc, {arc.edges().begin(), arc.edges().end()}));
    nodes.insert(arc.nodes.begin(), arc.nodes.end());
  }
  for (std::uint32_t n = 0; with_ev && n < skeleton.nodes.size(); ++n) {
    if (skeleton.nodes[n].kind != NodeKind::EVE) continue;
    const auto g = skeleton.generators(skeleton.nodes[n]);
    if (kept_ev.contains({g[1].id, g[0].id}) && kept_ev.contains({g[1].id, g[2].id})) {
      nodes.insert(n);
    }
  }
  for (const std::uint32_t n : nodes) {
    values.nodes.insert(value_of(skeleton, skeleton.nodes[n]));
  }
  return values;
}

Values all_values(const Skeleton& skeleton) {
  Values values = values_of(
      skeleton, false, [](const SkeletonArc&) { return true; },
      [](const SkeletonArc&) { return true; });
  values.nodes.clear();
  for (const SkeletonNode& node : skeleton.nodes) {
    values.nodes.insert(value_of(skeleton, node));
  }
  return values;
}

/// What differs, in a few words; a whole skeleton would fill the screen.  `others`: nodes
/// of the whole; lines through aligned corners end no arc and have any kind.
void expect_same(const Values& found, const Values& expected,
                 const std::multiset<NodeValue>& others) {
  EXPECT_EQ(found.ev.size(), expected.ev.size());
  EXPECT_EQ(found.eee.size(), expected.eee.size());
  EXPECT_TRUE(found.ev == expected.ev);
  EXPECT_TRUE(found.eee == expected.eee);
  EXPECT_TRUE(std::ranges::includes(found.nodes, expected.nodes));
  EXPECT_TRUE(std::ranges::includes(others, found.nodes));
  EXPECT_LE(found.nodes.size(), expected.nodes.size() + expected.nodes.size() / 100);
}

/// Objects by name, as the test's own notion of a group.
struct Owner {
  const Scene& scene;
  std::string name;

  [[nodiscard]] bool vertex(int p) const {
    return std::ranges::any_of(scene.faces_at(p), [&](int f) {
      return scene.objects()[scene.faces()[f].object].name == name;
    });
  }
  [[nodiscard]] bool edge(int e) const {
    return std::ranges::any_of(scene.edges()[e].sides, [&](const Edge::Side& side) {
      return scene.objects()[scene.faces()[side.face].object].name == name;
    });
  }
};

/// Some lines of the arc end on the owner.
bool ends_on(const SkeletonLines& lines, const auto& arc, const Owner& owner) {
  const auto there = [&](const std::vector<int>& faces) {
    return std::ranges::any_of(faces, [&](int f) {
      return owner.scene.objects()[owner.scene.faces()[f].object].name == owner.name;
    });
  };
  return std::ranges::any_of(lines.pieces(arc), [&](const SkeletonLines::Piece& p) {
    return there(p.line.from_faces) || there(p.line.to_faces);
  });
}

void expect_parts_of_the_whole(const Scene& scene, const SkeletonRequest& request,
                               const std::string& first, const std::string& second) {
  const Skeleton whole = build_skeleton(scene, request);
  const std::multiset<NodeValue> all = all_values(whole).nodes;
  const Owner a{scene, first}, b{scene, second};
  const auto between = [&](const auto& x, const auto& y) {
    return (x(a) && y(b)) || (x(b) && y(a));
  };
  Selection selection;
  selection.between = {first, second};
  const Skeleton pair = build_selected(scene, request, selection);
  expect_same(all_values(pair),
              values_of(
                  whole, request.ev,
                  [&](const SkeletonArc& arc) {
                    return between([&](const Owner& o) { return o.vertex(arc.vertex()); },
                                   [&](const Owner& o) { return o.edge(arc.edge()); });
                  },
                  [&](const SkeletonArc& arc) {
                    return between(
                        [&](const Owner& o) { return o.edge(arc.edges()[0]); },
                        [&](const Owner& o) { return o.edge(arc.edges()[2]); });
                  }),
              all);
  // One group alone: what has an outer contact on it.
  SkeletonRequest of_one = request;
  of_one.part.between_faces[0] = scene.faces_named(first);
  expect_same(all_values(build_skeleton(scene, of_one)),
              values_of(
                  whole, request.ev,
                  [&](const SkeletonArc& arc) {
                    return a.vertex(arc.vertex()) || a.edge(arc.edge());
                  },
                  [&](const SkeletonArc& arc) {
                    return a.edge(arc.edges()[0]) || a.edge(arc.edges()[2]);
                  }),
              all);
  selection = {};
  selection.through = first;
  const SkeletonLines lines(scene);
  int ends_there = 0;
  const Skeleton part = build_selected(scene, request, selection);
  expect_same(all_values(part),
              values_of(
                  whole, request.ev,
                  [&](const SkeletonArc& arc) {
                    if (a.vertex(arc.vertex()) || a.edge(arc.edge())) return true;
                    const bool ends = ends_on(lines, arc, a);
                    ends_there += ends;
                    return ends;
                  },
                  [&](const SkeletonArc& arc) {
                    return std::ranges::any_of(arc.edges(),
                                               [&](int e) { return a.edge(e); }) ||
                           ends_on(lines, arc, a);
                  }),
              all);
  EXPECT_EQ(ends_there > 0, request.ev) << "no line ends on " << first;
  // No node is there twice.
  for (const Skeleton* one : {&whole, &pair, &part}) {
    const std::multiset<NodeValue> seen = all_values(*one).nodes;
    for (const NodeValue& node : seen) EXPECT_EQ(seen.count(node), 1U);
  }
  EXPECT_EQ(part.eee().empty(), !request.eee);
  EXPECT_EQ(part.ev().empty(), !request.ev);
}

TEST(PartsByGroups, PartsAreThoseOfTheWholeRoom) {
  const Scene room(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj"));
  for (const auto& [ev, eee] :
       {std::pair(true, true), std::pair(true, false), std::pair(false, true)}) {
    SkeletonRequest request;
    request.ev = ev;
    request.eee = eee;
    SCOPED_TRACE(::testing::Message() << "EV " << ev << ", EEE " << eee);
    expect_parts_of_the_whole(room, request, "lamp_shade", "tilted_box");
    expect_parts_of_the_whole(room, request, "floor", "crate");
  }
}

TEST(PartsByGroups, PartsAreThoseOfTheWholeAmongPolytopes) {
  for (const std::uint64_t seed : {1, 2}) {
    const Scene scene(testing::random_polytopes(seed, 10));
    expect_parts_of_the_whole(scene, {}, scene.objects()[0].name,
                              scene.objects()[5].name);
  }
}

TEST(PartsByGroups, FaceRangesAreGroups) {
  const Scene room(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj"));
  Selection by_name, by_range;
  by_name.through = "floor";
  by_range.through = "#0-5";
  expect_same(all_values(build_selected(room, {}, by_name)),
              all_values(build_selected(room, {}, by_range)),
              all_values(build_selected(room, {}, by_range)).nodes);
  by_name.through = "nothing";
  EXPECT_THROW((void)build_selected(room, {}, by_name), InvalidInput);
}

TEST(PartsByGroups, KindsLeaveOutWhatWasNotAsked) {
  const Scene room(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj"));
  SkeletonRequest request;
  request.ev = false;
  const Skeleton eee = build_selected(room, request, {});
  EXPECT_TRUE(eee.ev().empty());
  EXPECT_EQ(eee.vertices_asked, 0U);
  std::set<std::uint32_t> ends;
  for (const SkeletonArc& arc : eee.eee())
    ends.insert(arc.nodes.begin(), arc.nodes.end());
  EXPECT_EQ(ends.size(), eee.nodes.size());
  const Skeleton both = build_selected(room, {}, {});
  EXPECT_EQ(all_values(eee).eee.size(), both.eee().size());
}

}  // namespace
}  // namespace sightline::viewers
