// Growing occluders: what flaps cover, and what a seam's width closes and leaves open.

#include "linespace/seams.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "linespace/mesh_io.h"
#include "linespace/visibility_cover.h"
#include "tests/support/generators.h"
#include "tests/support/seam_questions.h"

namespace sightline::testing {
namespace {

using Flat = Eigen::Vector2d;

double distance_to_segment(const Flat& p, const Flat& a, const Flat& b) {
  const Flat along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm();
}

bool inside(const Flat& p, const std::vector<Flat>& ring) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Flat side = ring[(i + 1) % ring.size()] - ring[i], to = p - ring[i];
    const double turn = side.x() * to.y() - side.y() * to.x();
    left |= turn > 0;
    right |= turn < 0;
  }
  return !(left && right);
}

double distance(const Flat& p, const std::vector<Flat>& ring) {
  if (inside(p, ring)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    least = std::min(least, distance_to_segment(p, ring[i], ring[(i + 1) % ring.size()]));
  }
  return least;
}

// Convex: points on an ellipse, thin ones among them.
std::vector<Flat> convex_ring(Random& random) {
  std::vector<double> angles(random.integer(3, 7));
  for (double& angle : angles) angle = random.uniform(0, 6.28);
  std::ranges::sort(angles);
  const double height = std::ldexp(1.0, -random.integer(0, 6));
  std::vector<Flat> ring;
  for (const double angle : angles) {
    ring.emplace_back(std::cos(angle), height * std::sin(angle));
  }
  return ring;
}

TEST(Flaps, CoverWhatIsNearAndNothingFar) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const std::vector<Flat> ring = convex_ring(random);
    const Point origin = random.direction();
    const Point u = random.direction();
    const Point v = u.cross(random.direction()).normalized();
    const auto lifted = [&](const Flat& p) {
      return Point(origin + p.x() * u + p.y() * v);
    };
    const auto flat = [&](const Point& p) {
      return Flat((p - origin).dot(u), (p - origin).dot(v));
    };
    Polygon polygon;
    for (const Flat& p : ring) polygon.push_back(lifted(p));
    const double by = random.uniform(0.01, 0.5);
    std::vector<std::vector<Flat>> parts{ring};
    for (const Polygon& flap : flaps(polygon, by)) {
      std::vector<Flat>& part = parts.emplace_back();
      for (const Point& p : flap) {
        part.push_back(flat(p));
        EXPECT_LT(distance(part.back(), ring), std::sqrt(2) * by + 1e-9) << seed;
        EXPECT_LT(std::abs((p - origin).dot(u.cross(v))), 1e-12) << seed;
      }
    }
    for (int i = 0; i < 400; ++i) {
      const Flat p(random.uniform(-2, 2), random.uniform(-2, 2));
      if (distance(p, ring) > by) continue;
      EXPECT_TRUE(std::ranges::any_of(parts, [&](const auto& part) {
        return distance(p, part) < 1e-12;
      })) << seed;
    }
  }
}

TEST(Flaps, OfWhatHasNoAreaAreNone) {
  EXPECT_TRUE(flaps({{0, 0, 0}, {1, 0, 0}}, 1).empty());
  EXPECT_TRUE(flaps({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 1).empty());
  EXPECT_TRUE(flaps({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0).empty());
}

VisibilityQuestion question_of(const VisibilityInstance& instance) {
  return {instance.a, instance.b, instance.occluders};
}

double scaled(double width, const SeamQuestion& q) {
  return std::ldexp(width, q.exponent);
}

// A seam twice as wide as the gap closes it, one of half its width does not.
TEST(Seams, CloseGapsThatAreNarrowerAndNoOthers) {
  int closed = 0, open = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const SeamQuestion q = seam_question(seed);
    if (!q.visible || !*q.visible) continue;
    const VisibilityQuestion question = question_of(q.instance);
    const SeamAnswer wide = polygon_visibility(question, scaled(2 * q.width, q));
    EXPECT_EQ(wide.answer.verdict, Verdict::Hidden) << seed;
    ASSERT_TRUE(wide.closed) << seed;
    // Some triangle of each of the two pieces closes the segment.
    EXPECT_FALSE(wide.closed->occluders.empty()) << seed;
    for (const int occluder : wide.closed->occluders) EXPECT_LT(occluder, 4) << seed;
    ++closed;
    if (q.width < 0x1p-44) continue;  // what growing adds for rounding is as wide
    const SeamAnswer narrow = polygon_visibility(question, scaled(q.width / 2, q));
    EXPECT_EQ(narrow.answer.verdict, Verdict::Visible) << seed;
    EXPECT_FALSE(narrow.closed) << seed;
    ++open;
  }
  EXPECT_GT(closed, 50);
  EXPECT_GT(open, 30);
}

TEST(Seams, OfWidthNothingChangeNothing) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const VisibilityQuestion question = question_of(seam_question(seed).instance);
    const SeamAnswer same = polygon_visibility(question, 0);
    const VisibilityAnswer plain = polygon_visibility(question);
    EXPECT_EQ(same.answer.verdict, plain.verdict) << seed;
    EXPECT_EQ(same.answer.cost.cells, plain.cost.cells) << seed;
    EXPECT_FALSE(same.closed) << seed;
  }
}

TEST(Seams, OfASceneAreListedWithWhatClosesThem) {
  const Scene scene(
      read_mesh(std::string(SIGHTLINE_TEST_DATA) + "/visibility/hairline_seam.obj"));
  const std::vector<int> as = scene.faces_named("A"), bs = scene.faces_named("B");
  const FaceVisibility grown(scene, {}, 1e-9);
  VisibilityRequest request;
  request.keep_cover = true;
  for (const bool all_pairs : {false, true}) {
    const GroupAnswer group = grown.between(as, bs, all_pairs, request);
    EXPECT_EQ(group.verdict, Verdict::Hidden);
    const ClosedPairs closed =
        closed_pairs(scene, grown, as, bs, group, all_pairs, VisibilityRequest{});
    EXPECT_TRUE(closed.complete);
    ASSERT_EQ(closed.pairs.size(), 1U);
    EXPECT_EQ(closed.pairs[0].seam.occluders, (std::vector{2, 3}));
  }
  const FacePairAnswer pair = grown.between(as[0], bs[0], request);
  ASSERT_TRUE(pair.answer.cover);
  EXPECT_EQ(check_cover(grown.question_of(pair), *pair.answer.cover), std::nullopt);
  // Without a seam it is open, and growing by less than the gap leaves it so.
  EXPECT_EQ(FaceVisibility(scene).between(as[0], bs[0]).answer.verdict, Verdict::Visible);
}

TEST(Seams, NeighbourOfASideIsWhatClosesIt) {
  // A floor's hole of 0.1 between four quads around it; one of them is not beside it.
  PolygonSoup soup = boxes_soup({{{0, 0, 0}, {1, 1, 0.5}}, {{0, 0, 3}, {1, 1, 3.5}}});
  const auto quad = [&](double x0, double x1) {
    const int v = static_cast<int>(soup.vertices.size());
    for (const auto& [x, y] : {std::array{x0, -9.0}, {x1, -9.0}, {x1, 9.0}, {x0, 9.0}}) {
      soup.vertices.emplace_back(x, y, 2);
    }
    soup.groups.push_back(
        {"wall" + std::to_string(v), {static_cast<int>(soup.polygons.size())}});
    soup.polygons.push_back({v, v + 1, v + 2, v + 3});
    return static_cast<int>(soup.polygons.size()) - 1;
  };
  quad(-9, -4);
  const int left = quad(-4, 0.5), right = quad(0.6, 9);
  const Scene scene(soup);
  const std::vector<int> as = scene.faces_named("box0"), bs = scene.faces_named("box1");
  for (const double seam : {0.09, 0.11}) {
    const FaceVisibility grown(scene, {}, seam);
    const GroupAnswer group = grown.between(as, bs, false);
    EXPECT_EQ(group.verdict, seam < 0.1 ? Verdict::Visible : Verdict::Hidden) << seam;
    const ClosedPairs closed = closed_pairs(scene, grown, as, bs, group, false);
    ASSERT_EQ(closed.pairs.size(), seam < 0.1 ? 0U : 1U) << seam;
    if (seam < 0.1) continue;
    for (const int face : closed.pairs[0].seam.occluders) {
      EXPECT_TRUE(scene.faces()[face].source == left ||
                  scene.faces()[face].source == right);
    }
  }
}

TEST(Seams, ThatAreNoWidthAreRefused) {
  const VisibilityQuestion question = question_of(seam_question(0).instance);
  for (const double seam :
       {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)polygon_visibility(question, seam), InvalidInput);
  }
}

}  // namespace
}  // namespace sightline::testing
