// Which ways a line may be moved along three edges, against lines that were moved so.

#include <gtest/gtest.h>

#include "linespace/portals/nearby.h"
#include "tests/support/random_geometry.h"

namespace sightline::internal {
namespace {

using testing::RandomGeometry;
using Vector = Eigen::Vector3d;

struct Moved {
  ExactLine line, moved;
  std::vector<LineThrough> edges;  // three that both touch, and others that `line` does
};

/// All coordinates are small integers, but for a step of 2^-20 from `line` to `moved`.
Moved moved_line(RandomGeometry& random, int others) {
  const auto any = [&random] {
    return Vector(random.integer(-6, 6), random.integer(-6, 6), random.integer(-6, 6));
  };
  const Vector at = any(), d = any() + Vector(20, 0, 0), a = any(), w = any();
  const double step = 0x1p-20;
  std::vector<LineThrough> edges;
  const int first = random.integer(-5, 5);
  for (int i = 0; i < 3 + others; ++i) {
    const double t = first + 2 * i;
    const Vector p = at + t * d;
    const Vector u = i < 3 ? Vector(a + t * w) : any();
    edges.push_back({p - u, p + 2 * u});
  }
  return {ExactLine::through(at, at + d),
          ExactLine::through(at + step * a, at + step * a + d + step * w), edges};
}

TEST(NearbyLines, MayPassWhatAMovedLinePasses) {
  RandomGeometry random(1);
  int asked = 0, refused = 0;
  for (int seed = 0; seed < 1000; ++seed) {
    const Moved m = moved_line(random, 4);
    std::vector<NearbyLines::Edge> edges, turned;
    int decided = 0;
    for (std::size_t h = 0; h < m.edges.size(); ++h) {
      const Sign side = m.moved.side(m.edges[h]);
      if (m.edges[h].from == m.edges[h].to || m.line.is_parallel(m.edges[h])) break;
      if (h < 3 && side != Sign::Zero) break;
      decided += side != Sign::Zero ? 1 : 0;
      const bool positive = side == Sign::Positive;
      edges.push_back(
          {m.edges[h], positive ? AllowedSide::Positive : AllowedSide::Negative});
      turned.push_back(
          {m.edges[h], positive ? AllowedSide::Negative : AllowedSide::Positive});
    }
    if (edges.size() < m.edges.size() || decided < 4) continue;
    ++asked;
    // As the moved line passes them, or one moved the other way does.
    const NearbyLines lines(m.line, edges);
    const NearbyLines::Way way = lines.way(0, 1, 2);
    EXPECT_TRUE(lines.may_pass(way)) << seed;
    EXPECT_TRUE(NearbyLines(m.line, turned).may_pass(way)) << seed;
    for (const int i : {0, 1, 2}) EXPECT_TRUE(lines.may_touch(way, i)) << seed;
    // Some one way and some the other way.
    edges[3 + seed % 4] = turned[3 + seed % 4];
    refused += NearbyLines(m.line, edges).may_pass(way) ? 0 : 1;
    // What is not on the way cannot be touched.
    edges[3 + seed % 4].allowed = AllowedSide::None;
    refused += NearbyLines(m.line, edges).may_pass(way) ? 0 : 1;
    edges[3 + seed % 4].allowed = AllowedSide::Any;
    EXPECT_TRUE(NearbyLines(m.line, edges).may_pass(way)) << seed;
  }
  EXPECT_GT(asked, 700);
  EXPECT_GT(refused, 2 * asked * 98 / 100);
}

// Edges on one regulus, and others that leave it to the second order only.
TEST(NearbyLines, MayTouchWhatIsCoplanarToTheFirstOrder) {
  RandomGeometry random(2);
  for (int seed = 0; seed < 300; ++seed) {
    const double w = random.integer(1, 3);
    std::vector<NearbyLines::Edge> edges;
    for (int i = 0; i < 6; ++i) {
      const Vector p(5 * i, 0, 0), u(i < 4 ? 0 : random.integer(1, 2), 1, w * i);
      edges.push_back({{p - u, p + u}, AllowedSide::Positive});
    }
    const NearbyLines lines(ExactLine::through({0, 0, 0}, {1, 0, 0}), edges);
    const NearbyLines::Way way = lines.way(0, 1, 2);
    for (int h = 0; h < 6; ++h) EXPECT_TRUE(lines.may_touch(way, h));
    EXPECT_TRUE(lines.may_pass(way));
  }
}

}  // namespace
}  // namespace sightline::internal
