// The stretch of an edge over which a convex outline is seen, against the half-spaces of
// all of its sides at points between any two positions where one is crossed.

#include "linespace/swaths/outline_stretch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <vector>

#include "linespace/numbers/rational.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

using Vector = std::array<int, 3>;  // from the viewpoint

int determinant(const Vector& u, const Vector& v, const Vector& w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

Sign sign_of(int x) { return static_cast<Sign>((x > 0) - (x < 0)); }

// Where a function that is linear along the edge vanishes, from its values at the ends.
Rational root(int at_start, int at_end) {
  return Rational(at_start) / Rational(at_start - at_end);
}

struct Question {
  Vector start, end;               // of the edge
  std::vector<Vector> corners;     // of the outline, convex in a plane
  std::vector<std::size_t> order;  // in which its sides are given
  Sign front;
};

struct Part {
  Rational from = 0, to = 1;
};

Vector vector(testing::Random& random, int size) {
  return {random.integer(-size, size), random.integer(-size, size),
          random.integer(-size, size)};
}

// On a small grid, so that corners are often in line with the edge and with its ends.
bool make(testing::Random& random, Question& q) {
  static const std::vector<std::vector<std::array<int, 2>>> kOutlines{
      {{0, 0}, {1, 0}, {0, 1}},
      {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
      {{0, 0}, {1, 0}, {2, 0}, {1, 1}},
      {{1, 0}, {2, 0}, {2, 1}, {1, 2}, {0, 2}, {0, 1}}};
  const auto& outline =
      kOutlines[random.integer(0, static_cast<int>(kOutlines.size()) - 1)];
  const Vector o = vector(random, 3), u = vector(random, 2), v = vector(random, 2);
  if (determinant(o, u, v) == 0) return false;
  q.corners.clear();
  for (const auto& [x, y] : outline) {
    q.corners.push_back({o[0] + x * u[0] + y * v[0], o[1] + x * u[1] + y * v[1],
                         o[2] + x * u[2] + y * v[2]});
  }
  q.start = vector(random, 3);
  q.end = vector(random, 3);
  const int seen = determinant(q.corners[0], q.corners[1], q.corners.back());
  q.front = sign_of(-seen);
  // The edge is not seen end-on.
  const Vector x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  if (determinant(q.start, q.end, x) == 0 && determinant(q.start, q.end, y) == 0 &&
      determinant(q.start, q.end, z) == 0) {
    return false;
  }
  q.order.resize(q.corners.size());
  std::iota(q.order.begin(), q.order.end(), 0U);
  if (random.one_in(2)) std::swap(q.order[0], q.order[random.integer(1, 2)]);
  return true;
}

bool narrow(const Question& q, Part& stretch, int& asked) {
  const auto side = [&](std::size_t k) {
    const std::size_t i = q.order[k];
    return std::array{q.corners[i], q.corners[(i + 1) % q.corners.size()]};
  };
  return narrow_to_outline(
      stretch, q.corners.size(), q.front,
      [&](std::size_t k) {
        const auto [tail, head] = side(k);
        return std::array{sign_of(determinant(q.start, q.end, tail)),
                          sign_of(determinant(q.start, q.end, head))};
      },
      [&](std::size_t k, bool to_right) {
        ++asked;
        auto [left, right] = side(k);
        if (!to_right) std::swap(left, right);
        const int a = -determinant(left, right, q.start);
        const int b = -determinant(left, right, q.end);
        return SideAgainstEdge<Rational>{sign_of(a), sign_of(b),
                                         a < 0 && b > 0 ? root(a, b) : Rational(-1)};
      });
}

// The plane of the outline is 0 where this is, and positive on the viewpoint's side.
std::array<int, 2> before_plane(const Question& q) {
  const auto value = [&](const Vector& p) {
    std::array<Vector, 3> d;
    const std::array<Vector, 3> from{q.corners[1], q.corners.back(), p};
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) d[k][i] = from[k][i] - q.corners[0][i];
    }
    return determinant(d[0], d[1], d[2]);
  };
  const int here = value({0, 0, 0}) > 0 ? 1 : -1;
  return {here * value(q.start), here * value(q.end)};
}

// Between neighbouring positions at which anything may change.
std::vector<Rational> middles(const Question& q) {
  std::vector<Rational> at{0, 1};
  const auto add = [&](int a, int b) {
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) at.push_back(root(a, b));
  };
  for (std::size_t k = 0; k < q.corners.size(); ++k) {
    const Vector &p = q.corners[k], &r = q.corners[(k + 1) % q.corners.size()];
    add(determinant(p, r, q.start), determinant(p, r, q.end));
  }
  const auto [a, b] = before_plane(q);
  add(a, b);
  std::ranges::sort(at);
  std::vector<Rational> found;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (at[i] != at[i + 1]) found.push_back((at[i] + at[i + 1]) / 2);
  }
  return found;
}

bool seen_over(const Question& q, const Rational& t) {
  for (std::size_t k = 0; k < q.corners.size(); ++k) {
    const Vector &p = q.corners[k], &r = q.corners[(k + 1) % q.corners.size()];
    const Rational inside =
        (1 - t) * -determinant(p, r, q.start) + t * -determinant(p, r, q.end);
    if (inside * static_cast<int>(q.front) < 0) return false;
  }
  return true;
}

TEST(OutlineStretch, IsWhereAllSidesSaySo) {
  testing::Random random(7);
  int stretches = 0, touching = 0, none = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    Question q;
    if (!make(random, q)) continue;
    Part stretch;
    int asked = 0;
    const bool found = narrow(q, stretch, asked);
    ASSERT_LE(asked, 2);
    bool any = false;
    for (const Rational& t : middles(q)) {
      const bool within = found && stretch.from < t && t < stretch.to;
      ASSERT_EQ(within, seen_over(q, t)) << "trial " << trial << " at " << t;
      any |= within;
    }
    int left = 0, right = 0;
    for (const Vector& c : q.corners) {
      const int side = determinant(q.start, q.end, c);
      left += side < 0 ? 1 : 0;
      right += side > 0 ? 1 : 0;
    }
    const bool beside = left == 0 || right == 0;
    (any ? (beside ? touching : stretches) : none)++;
  }
  EXPECT_GT(stretches, 10000);
  EXPECT_GT(touching, 500);
  EXPECT_GT(none, 10000);
}

TEST(OutlineStretch, BehindThePlane) {
  testing::Random random(8);
  int shorter = 0, gone = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    Question q;
    if (!make(random, q)) continue;
    const auto [a, b] = before_plane(q);
    if (!((a < 0 && b > 0) || (a > 0 && b < 0))) continue;
    Part stretch;
    int asked = 0;
    if (!narrow(q, stretch, asked)) continue;
    const Part whole = stretch;
    narrow_to_behind(stretch, a < 0, root(a, b), std::less<>());
    for (const Rational& t : middles(q)) {
      const bool behind = (1 - t) * a + t * b < 0;
      ASSERT_EQ(stretch.from < t && t < stretch.to, seen_over(q, t) && behind)
          << "trial " << trial << " at " << t;
    }
    if (whole.from >= whole.to) continue;
    if (stretch.from >= stretch.to) ++gone;
    if (stretch.from < stretch.to &&
        (stretch.from > whole.from || stretch.to < whole.to)) {
      ++shorter;
    }
  }
  EXPECT_GT(shorter, 1000);
  EXPECT_GT(gone, 1000);
}

}  // namespace
}  // namespace sightline::internal
