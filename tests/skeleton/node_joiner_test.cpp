// One node for each line: told apart by what determines lines, whatever way they are
// told.

#include "skeleton/nodes/node_joiner.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "skeleton/nodes/node_contacts.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

using Silhouettes = std::vector<Generator>;

Generator vertex(int id) { return {GeneratorKind::Vertex, id}; }
Generator edge(int id) { return {GeneratorKind::Edge, id}; }
Generator facet(int id) { return {GeneratorKind::Face, id}; }

SkeletonNode node(NodeKind kind, bool end = false, bool second = false) {
  SkeletonNode n;
  n.kind = kind;
  n.end = end;
  n.second = second;
  return n;
}

TEST(NodeJoiner, ToldFromEitherEndALineIsOneNode) {
  Skeleton skeleton;
  NodeJoiner nodes(skeleton);
  const auto vv = nodes.join(node(NodeKind::VV), Silhouettes{vertex(7), vertex(3)}, true);
  EXPECT_EQ(nodes.join(node(NodeKind::VV), Silhouettes{vertex(3), vertex(7)}, true), vv);
  EXPECT_EQ(skeleton.generators(skeleton.nodes[vv]).front(), vertex(3));
  const Silhouettes many{edge(1), edge(5), vertex(2), edge(9), edge(4)};
  const auto degenerate = nodes.join(node(NodeKind::Degenerate), many, true);
  EXPECT_EQ(nodes.join(node(NodeKind::Degenerate),
                       Silhouettes(many.rbegin(), many.rend()), true),
            degenerate);
  const auto fve =
      nodes.join(node(NodeKind::FvE), Silhouettes{vertex(1), facet(2), edge(3)}, true);
  EXPECT_EQ(
      nodes.join(node(NodeKind::FvE), Silhouettes{vertex(1), edge(3), facet(2)}, true),
      fve);
  EXPECT_EQ(skeleton.nodes.size(), 3U);
}

// Lines of a pencil in a plane may touch the same edges.
TEST(NodeJoiner, LinesWithTheSameGeneratorsAreToldApartByTheirLines) {
  Skeleton skeleton;
  NodeJoiner nodes(skeleton);
  const Silhouettes contacts{edge(1), facet(2), facet(3)};
  const auto first = nodes.join(node(NodeKind::Degenerate), contacts, true, "17");
  EXPECT_NE(nodes.join(node(NodeKind::Degenerate), contacts, true, "18"), first);
  EXPECT_EQ(nodes.join(node(NodeKind::Degenerate),
                       Silhouettes(contacts.rbegin(), contacts.rend()), true, "17"),
            first);
  EXPECT_EQ(skeleton.nodes.size(), 2U);
}

// All hashes are 0: only what nodes are tells them apart.
TEST(NodeJoiner, NothingDependsOnHashes) {
  Skeleton skeleton;
  NodeJoiner nodes(skeleton, 0);
  testing::Random random(2);
  std::map<std::tuple<Silhouettes, std::string>, std::uint32_t> known;
  for (int i = 0; i < 4000; ++i) {
    const Silhouettes contacts{edge(random.integer(0, 3)), facet(5), facet(9)};
    const std::string line(static_cast<std::size_t>(random.integer(0, 40)), 'x');
    const auto number = nodes.join(node(NodeKind::Degenerate), contacts, true, line);
    const auto [at, is_new] =
        known.try_emplace({contacts, line}, static_cast<std::uint32_t>(known.size()));
    ASSERT_EQ(number, at->second);
  }
  EXPECT_GT(known.size(), 150U);
}

// The name of a line through two points, and through two others of it.
TEST(LineName, IsOneForEachLine) {
  testing::Random random(3);
  std::map<std::string, int> names;
  int lines = 0;
  const auto point = [&] {
    return exact_point({double(random.integer(-3, 3)), double(random.integer(-3, 3)),
                        random.integer(-3, 3) / 4.0});
  };
  for (int i = 0; i < 2000; ++i) {
    const ExactPoint a = point(), b = point();
    if (a == b) continue;
    const LineName name = name_of_line({a, b});
    ++lines;
    const Rational s(random.integer(-20, 20), random.integer(1, 9));
    const Rational t = s + Rational(random.integer(1, 20), 7);
    EXPECT_EQ(name_of_line({along(a, b, s), along(a, b, t)}), name);
    EXPECT_EQ(name_of_line({along(a, b, t), along(a, b, s)}), name);
    // Another line through the same point, or in the same direction.
    ExactPoint off = b;
    off[i % 3] += Rational(1, 1 << 30) / Rational(1LL << 60);
    const ExactPoint way = exact_difference(off, b);
    if (exact_cross(exact_difference(b, a), way) == ExactPoint{}) continue;
    EXPECT_NE(name_of_line({a, off}), name);
    const ExactPoint beside{a[0] + way[0], a[1] + way[1], a[2] + way[2]};
    EXPECT_NE(name_of_line({beside, off}), name);
  }
  EXPECT_GT(lines, 1900);
}

TEST(NodeJoiner, LinesOfOtherGeneratorsOrKindsAreOtherNodes) {
  Skeleton skeleton;
  NodeJoiner nodes(skeleton);
  const Silhouettes vee{vertex(1), edge(2), edge(3)};
  const auto first = nodes.join(node(NodeKind::VEE), vee, true);
  EXPECT_NE(
      nodes.join(node(NodeKind::VEE), Silhouettes{vertex(1), edge(3), edge(2)}, true),
      first);
  EXPECT_NE(nodes.join(node(NodeKind::EVE), vee, true), first);
  EXPECT_NE(nodes.join(node(NodeKind::VEE), Silhouettes{edge(1), edge(2), edge(3)}, true),
            first);
  const Silhouettes four{edge(1), edge(2), edge(3), edge(4)};
  EXPECT_NE(nodes.join(node(NodeKind::EEEE, false, false), four, true),
            nodes.join(node(NodeKind::EEEE, false, true), four, true));
  const Silhouettes pair{vertex(1), vertex(2)};
  EXPECT_NE(nodes.join(node(NodeKind::VV, false), pair, true),
            nodes.join(node(NodeKind::VV, true), pair, true));
  EXPECT_EQ(nodes.join(node(NodeKind::VEE), vee, true), first);
}

// Against a map, with so few ids that most are found again and many share a hash bucket.
TEST(NodeJoiner, NumbersAreThoseOfAMap) {
  Skeleton skeleton;
  NodeJoiner nodes(skeleton);
  std::map<std::tuple<int, bool, Silhouettes>, std::uint32_t> known;
  testing::Random random(1);
  std::vector<std::pair<SkeletonNode, Silhouettes>> asked;
  for (int i = 0; i < 60000; ++i) {
    const bool third = random.one_in(3);
    const NodeKind kind = third ? NodeKind::VEE : NodeKind::FEE;
    const auto id = [&] { return random.integer(0, 30); };
    asked.push_back(
        {node(kind), {third ? vertex(id()) : facet(id()), edge(id()), edge(id())}});
  }
  nodes.join_each(
      asked.size(),
      [&](std::size_t i) {
        return std::pair(asked[i].first.kind,
                         std::span<const Generator>(asked[i].second));
      },
      [&](std::size_t i) {
        const auto& [n, generators] = asked[i];
        const auto number = nodes.join(n, generators, true);
        const auto key = std::tuple(static_cast<int>(n.kind), n.second, generators);
        const auto [at, is_new] =
            known.try_emplace(key, static_cast<std::uint32_t>(known.size()));
        EXPECT_EQ(number, at->second);
      });
  EXPECT_EQ(skeleton.nodes.size(), known.size());
  EXPECT_LT(known.size(), asked.size() * 9 / 10);
}

TEST(NodeJoiner, WhatWasForgottenIsNew) {
  Skeleton skeleton;
  NodeJoiner nodes(skeleton);
  const Silhouettes four{edge(1), edge(2), edge(3), edge(4)};
  const auto first = nodes.join_eeee(node(NodeKind::EEEE), four, true);
  EXPECT_EQ(nodes.join_eeee(node(NodeKind::EEEE), four, true), first);
  nodes.forget_eeee();
  EXPECT_NE(nodes.join_eeee(node(NodeKind::EEEE), four, true), first);
}

TEST(NodeJoiner, ALineThatMayBeFoundElsewhereIsNotForgotten) {
  Skeleton skeleton;
  NodeJoiner nodes(skeleton);
  const Silhouettes four{edge(1), edge(2), edge(3), edge(4)};
  const auto first = nodes.join(node(NodeKind::EEEE), four, true);
  nodes.forget_eeee();
  EXPECT_EQ(nodes.join(node(NodeKind::EEEE), four, true), first);
}

}  // namespace
}  // namespace sightline::internal
