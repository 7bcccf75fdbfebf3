// Parts of a skeleton asked for on their own are those parts of the whole: near a point,
// between two boxes, between and through objects, above a feature size, within a budget.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <tuple>

#include "linespace/scene.h"
#include "skeleton/build.h"
#include "tests/support/exact.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using testing::dot;
using testing::exact;
using testing::Rational;
using testing::Vec3;

/// Generators and range of an arc.
using Value = std::tuple<std::array<std::int32_t, 3>, double, double>;
using FfValue = std::pair<int, int>;

Value value_of(const SkeletonArc& a) { return {a.generators, a.range[0], a.range[1]}; }

/// What belongs to a part, told in the test's own words.
struct Rule {
  std::function<bool(const SkeletonArc&)> ev;
  std::function<bool(const SkeletonArc&)> eee;
  std::function<bool(int facet, int other)> ff;
};

SkeletonRequest everything() {
  SkeletonRequest request;
  request.ff = true;
  return request;
}

class Parts : public ::testing::Test {
 protected:
  Parts()
      : scene_(testing::random_polytopes(5, 14, {.max_vertices = 8, .density = 0.2})),
        whole_(build_skeleton(scene_, everything())) {}

  void expect_part(const SkeletonRequest& request, const Rule& rule) {
    const Skeleton part = build_skeleton(scene_, request);
    EXPECT_TRUE(part.complete);
    std::vector<Value> ev, ev_here;
    for (const SkeletonArc& a : whole_.ev()) {
      if (rule.ev(a)) ev.push_back(value_of(a));
    }
    for (const SkeletonArc& a : part.ev()) ev_here.push_back(value_of(a));
    EXPECT_TRUE(ev_here == ev) << ev_here.size() << " EV arcs for " << ev.size();
    std::vector<Value> eee, eee_here;
    for (const SkeletonArc& a : whole_.eee()) {
      if (rule.eee(a)) eee.push_back(value_of(a));
    }
    for (const SkeletonArc& a : part.eee()) eee_here.push_back(value_of(a));
    EXPECT_TRUE(eee_here == eee) << eee_here.size() << " EEE arcs for " << eee.size();
    std::multiset<FfValue> ff, ff_here;
    const auto facets = [](const Skeleton& s, const SkeletonNode& n) {
      const auto g = s.generators(n);
      return FfValue{g[0].id, g[1].id};
    };
    for (const SkeletonNode& n : whole_.nodes) {
      if (n.kind != NodeKind::FF) continue;
      const FfValue f = facets(whole_, n);
      if (rule.ff(f.first, f.second)) ff.insert(f);
    }
    for (const SkeletonNode& n : part.nodes) {
      if (n.kind == NodeKind::FF) ff_here.insert(facets(part, n));
    }
    EXPECT_TRUE(ff_here == ff) << ff_here.size() << " FF nodes for " << ff.size();
    // A test that sees nothing, or everything, tests nothing.
    EXPECT_GT(ev.size(), 0u);
    EXPECT_GT(eee.size(), 0u);
    EXPECT_LT(ev.size(), whole_.ev().size());
    EXPECT_LT(eee.size(), whole_.eee().size());
  }

  [[nodiscard]] Vec3 at(int p) const { return exact(scene_.point(p)); }
  [[nodiscard]] std::array<int, 2> ends(int e) const { return scene_.edges()[e].points; }
  [[nodiscard]] bool vertex_in(int p, const std::array<Point, 2>& box) const {
    const Point& x = scene_.point(p);
    return (x.array() >= box[0].array()).all() && (x.array() <= box[1].array()).all();
  }
  [[nodiscard]] bool edge_in(int e, const std::array<Point, 2>& box) const {
    return vertex_in(ends(e)[0], box) && vertex_in(ends(e)[1], box);
  }
  [[nodiscard]] std::set<int> corners_of(int facet) const {
    std::set<int> corners;
    for (const int f : scene_.facets()[facet].faces) {
      for (const int p : scene_.face_points(f)) corners.insert(p);
    }
    return corners;
  }
  [[nodiscard]] bool facet_in(int f, const std::array<Point, 2>& box) const {
    return std::ranges::all_of(corners_of(f), [&](int p) { return vertex_in(p, box); });
  }
  /// Some side of the facet.
  [[nodiscard]] bool some_side(int facet, const std::function<bool(int)>& has) const {
    for (std::size_t e = 0; e < scene_.edges().size(); ++e) {
      for (const Edge::Side& s : scene_.edges()[e].sides) {
        if (scene_.faces()[s.face].facet == facet && has(static_cast<int>(e)))
          return true;
      }
    }
    return false;
  }
  [[nodiscard]] int object_of_vertex(int p) const {
    return scene_.faces()[scene_.faces_at(p)[0]].object;
  }

  Scene scene_;
  Skeleton whole_;
};

TEST_F(Parts, NearAPoint) {
  const Point centre = 0.5 * (scene_.bounds()[0] + scene_.bounds()[1]);
  const double radius = 1.5;
  SkeletonRequest request = everything();
  request.part.near = {centre, radius};
  // The nearest of many points along an edge, to compare with the exact answer: closer
  // ones than the sampling's error do not occur here.
  const auto edge_near = [&](int e) {
    const Point p = scene_.point(ends(e)[0]), q = scene_.point(ends(e)[1]);
    double nearest = 1e9;
    for (int i = 0; i <= 100000; ++i) {
      nearest = std::min(nearest, (p + i * 1e-5 * (q - p) - centre).norm());
    }
    EXPECT_GT(std::abs(nearest - radius), 1e-4);
    return nearest <= radius;
  };
  std::vector<bool> near;
  for (std::size_t e = 0; e < scene_.edges().size(); ++e) {
    near.push_back(edge_near(static_cast<int>(e)));
  }
  expect_part(request, {[&](const SkeletonArc& a) {
                          return (scene_.point(a.vertex()) - centre).norm() <= radius &&
                                 near[a.edge()];
                        },
                        [&](const SkeletonArc& a) {
                          return near[a.edges()[0]] && near[a.edges()[1]] &&
                                 near[a.edges()[2]];
                        },
                        [&](int f, int g) {
                          const auto here = [&](int e) { return bool(near[e]); };
                          return some_side(f, here) && some_side(g, here);
                        }});
}

// The edge x = 1, z = 1 of the first box is 5 from the centre, and seen from the corner
// (3, 0, 0.5) of the second, which is nearer: decided exactly.
TEST(PartsOfBoxes, ABallThatTouchesAnEdge) {
  const Scene scene(
      testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{3, 0, -1}, {4, 1, 0.5}}}));
  const auto arcs = [&](double radius) {
    SkeletonRequest request;
    request.part.near = {{4, 0.5, 5}, radius};
    return build_skeleton(scene, request).ev_count();
  };
  EXPECT_GT(arcs(5), arcs(std::nextafter(5, 0)));
  EXPECT_EQ(arcs(5), arcs(std::nextafter(5, 6)));
}

TEST_F(Parts, BetweenTwoBoxes) {
  const auto& [low, high] = scene_.bounds();
  const Point size = high - low;
  const std::array<Point, 2> left = {low, low + Point(0.55 * size[0], size[1], size[2])};
  const std::array<Point, 2> right = {low + Point(0.35 * size[0], 0, 0), high};
  SkeletonRequest request = everything();
  request.part.between_boxes = {left, right};
  expect_part(request,
              {[&](const SkeletonArc& a) {
                 return (vertex_in(a.vertex(), left) && edge_in(a.edge(), right)) ||
                        (vertex_in(a.vertex(), right) && edge_in(a.edge(), left));
               },
               [&](const SkeletonArc& a) {
                 return (edge_in(a.edges()[0], left) && edge_in(a.edges()[2], right)) ||
                        (edge_in(a.edges()[0], right) && edge_in(a.edges()[2], left));
               },
               [&](int f, int g) {
                 return (facet_in(f, left) && facet_in(g, right)) ||
                        (facet_in(f, right) && facet_in(g, left));
               }});
}

TEST_F(Parts, BetweenObjectsThroughOthersInARegion) {
  const std::vector<int> a = {0, 1, 2, 3, 4, 5}, b = {4, 6, 7, 8, 9, 10},
                         source = {2, 7, 9, 12};
  std::array<Point, 2> region = scene_.bounds();
  region[1][2] = 0.8 * region[1][2] + 0.2 * region[0][2];
  SkeletonRequest request = everything();
  request.part.outer_objects = {a, b};
  request.part.through_objects = source;
  request.part.region = region;
  const auto in = [](const std::vector<int>& set, int o) {
    return std::ranges::find(set, o) != set.end();
  };
  const auto pair = [&](int x, int y) {
    return (in(a, x) && in(b, y)) || (in(b, x) && in(a, y));
  };
  const auto object = [&](int e) { return scene_.edges()[e].object; };
  expect_part(request,
              {[&](const SkeletonArc& arc) {
                 const int x = object_of_vertex(arc.vertex()), y = object(arc.edge());
                 return pair(x, y) && (in(source, x) || in(source, y)) &&
                        vertex_in(arc.vertex(), region) && edge_in(arc.edge(), region);
               },
               [&](const SkeletonArc& arc) {
                 bool through = false, inside = true;
                 for (const int e : arc.edges()) {
                   through |= in(source, object(e));
                   inside &= edge_in(e, region);
                 }
                 return pair(object(arc.edges()[0]), object(arc.edges()[2])) && through &&
                        inside;
               },
               [&](int f, int g) {
                 const int x = scene_.facets()[f].object, y = scene_.facets()[g].object;
                 return pair(x, y) && (in(source, x) || in(source, y)) &&
                        facet_in(f, region) && facet_in(g, region);
               }});
}

TEST_F(Parts, AboveAFeatureSize) {
  const auto edge_length2 = [&](int e) {
    const Vec3 d = at(ends(e)[1]) - at(ends(e)[0]);
    return dot(d, d);
  };
  // One that an edge has exactly.
  double exactly = 0;
  for (std::size_t e = 0; e < scene_.edges().size() && exactly == 0; ++e) {
    const Rational squared = edge_length2(static_cast<int>(e));
    const double root = std::sqrt(squared.convert_to<double>());
    if (Rational(root) * Rational(root) == squared) exactly = root;
  }
  std::set<Value> last;
  for (const double size : {exactly > 0 ? exactly : 0.4, 0.5, 0.8}) {
    SCOPED_TRACE(size);
    const auto large = [&](int e) {
      return edge_length2(e) >= Rational(size) * Rational(size);
    };
    const auto corner = [&](int p) {
      return std::ranges::any_of(scene_.edges_at(p), large);
    };
    const auto extent = [&](const SkeletonArc& a) {
      const auto [p, q] = ends(a.edge());
      return (a.range[1] - a.range[0]) * (scene_.point(q) - scene_.point(p)).norm();
    };
    SkeletonRequest request = everything();
    request.part.feature_size = size;
    expect_part(
        request,
        {[&](const SkeletonArc& a) {
           return large(a.edge()) && corner(a.vertex()) && extent(a) >= size;
         },
         [&](const SkeletonArc& a) {
           return large(a.edges()[0]) && large(a.edges()[1]) && large(a.edges()[2]);
         },
         [&](int f, int g) { return some_side(f, large) && some_side(g, large); }});
    // Whatever is missing is listed.
    const Skeleton part = build_skeleton(scene_, request);
    std::set<Value> here;
    for (const SkeletonArc& a : part.ev()) here.insert(value_of(a));
    std::set<int> edges(part.simplified.edges.begin(), part.simplified.edges.end());
    std::set<int> corners(part.simplified.vertices.begin(),
                          part.simplified.vertices.end());
    std::set<Value> shorts;
    for (const auto& a : part.simplified.arcs) {
      shorts.insert({{a.vertex, a.edge, -1}, a.range[0], a.range[1]});
    }
    for (const SkeletonArc& a : whole_.ev()) {
      const bool listed = edges.contains(a.edge()) || corners.contains(a.vertex()) ||
                          shorts.contains(value_of(a));
      EXPECT_NE(listed, here.contains(value_of(a)));
    }
    EXPECT_EQ(part.simplified.feature_size, size);
    // Fewer at a larger size.
    EXPECT_TRUE(last.empty() || std::ranges::includes(last, here));
    last = here;
  }
}

// Decided exactly: an edge of just that length is large enough.
TEST(FeatureSize, AnEdgeOfThatLengthStays) {
  const Scene scene(
      testing::boxes_soup({{{0, 0, 0}, {1, 1, 1}}, {{3, 0.5, 0.25}, {4, 1.5, 1.25}}}));
  const auto left_out = [&](double size) {
    SkeletonRequest request;
    request.part.feature_size = size;
    return build_skeleton(scene, request).simplified.edges.size();
  };
  EXPECT_EQ(left_out(1), 0u);
  EXPECT_EQ(left_out(std::nextafter(1, 2)), 24u);
}

TEST_F(Parts, FeatureSizeZeroIsEverything) {
  SkeletonRequest request = everything();
  request.part.feature_size = 0;
  const Skeleton all = build_skeleton(scene_, request);
  EXPECT_EQ(all.generator_pool, whole_.generator_pool);
  EXPECT_EQ(all.ev().size(), whole_.ev().size());
  EXPECT_TRUE(all.simplified.edges.empty());
}

TEST(FeatureSize, SmallObjectsOccludeAndAreListed) {
  // A small cube half way between two large ones.
  const std::vector<testing::AlignedBox> two = {{{0, 0, 0}, {1, 1, 1}},
                                                {{4, 0.1, 0.2}, {5, 1.3, 1.4}}};
  std::vector<testing::AlignedBox> three = two;
  three.push_back({{2, 0.45, 0.46}, {2.1, 0.56, 0.57}});
  const Scene without(testing::boxes_soup(two)), with(testing::boxes_soup(three));
  SkeletonRequest request;
  request.part.feature_size = 0.2;
  const Skeleton part = build_skeleton(with, request);
  EXPECT_EQ(part.simplified.objects, std::vector<std::int32_t>{2});
  EXPECT_EQ(part.simplified.edges.size(), 12u);
  EXPECT_EQ(part.simplified.vertices.size(), 8u);
  const auto small = [&](const Generator& g) {
    return g.kind == GeneratorKind::Edge && with.edges()[g.id].object == 2;
  };
  for (const SkeletonArc& a : part.ev()) EXPECT_NE(with.edges()[a.edge()].object, 2);
  // Arcs of the large ones are cut where the small one is in the way.
  EXPECT_GT(part.ev().size(), build_skeleton(without, request).ev_count());
  EXPECT_TRUE(std::ranges::any_of(part.generator_pool, small));
}

TEST_F(Parts, ASizeBudgetGivesTheSamePrefix) {
  for (const double share : {0.05, 0.5, 0.9, 0.999}) {
    SCOPED_TRACE(share);
    SkeletonRequest request = everything();
    request.budget_bytes =
        static_cast<std::size_t>(share * static_cast<double>(whole_.bytes()));
    request.threads = 1;
    const Skeleton one = build_skeleton(scene_, request);
    request.threads = 4;
    const Skeleton four = build_skeleton(scene_, request);
    EXPECT_FALSE(one.complete);
    EXPECT_EQ(one.stopped_by, StoppedBy::Bytes);
    EXPECT_LT(one.vertices_done + one.edges_done + one.facets_done,
              one.vertices_asked + one.edges_asked + one.facets_asked);
    EXPECT_EQ(one.edges_asked, whole_.edges_asked);
    EXPECT_EQ(one.generator_pool, four.generator_pool);
    ASSERT_EQ(one.arcs.size(), four.arcs.size());
    ASSERT_EQ(one.ev_count(), four.ev_count());
    // The first that reached it is the last.
    EXPECT_GE(one.bytes(), request.budget_bytes);
    ASSERT_LE(one.ev_count(), whole_.ev_count());
    for (std::size_t i = 0; i < one.ev_count(); ++i) {
      EXPECT_EQ(value_of(one.arcs[i]), value_of(whole_.arcs[i]));
    }
    ASSERT_LE(one.eee().size(), whole_.eee().size());
    for (std::size_t i = 0; i < one.eee().size(); ++i) {
      EXPECT_EQ(value_of(one.eee()[i]), value_of(whole_.eee()[i]));
    }
  }
  SkeletonRequest request = everything();
  request.budget_bytes = whole_.bytes() + 1;
  EXPECT_TRUE(build_skeleton(scene_, request).complete);
}

TEST_F(Parts, ATimeBudgetSaysSo) {
  SkeletonRequest request = everything();
  request.budget_seconds = 0;
  const Skeleton none = build_skeleton(scene_, request);
  EXPECT_FALSE(none.complete);
  EXPECT_EQ(none.stopped_by, StoppedBy::Seconds);
  EXPECT_EQ(whole_.stopped_by, StoppedBy::Nothing);
}

}  // namespace
}  // namespace sightline
