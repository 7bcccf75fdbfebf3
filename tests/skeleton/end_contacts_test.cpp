// Polygon mode: the lines of an arc end in its end contacts.  Pieces and events against a
// naive walk along exact lines through convex solids.

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "linespace/mesh_io.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/end_index.h"
#include "skeleton/skeleton_lines.h"
#include "skeleton/view_events.h"
#include "tests/support/eee_scenes.h"
#include "tests/support/exact.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

using testing::Rational;
using testing::Vec3;

Vec3 at(const std::array<Vec3, 2>& line, const Rational& t) {
  return line[0] + t * (line[1] - line[0]);
}

/// Disjoint convex solids, one a group, fronts outwards; everything in rationals.
class Solids {
 public:
  explicit Solids(const PolygonSoup& soup) {
    for (const auto& group : soup.groups) {
      solids_.emplace_back();
      for (const int f : group.faces) {
        const auto& c = soup.polygons[f];
        const Vec3 a = testing::exact(soup.vertices[c[0]]);
        const Vec3 b = testing::exact(soup.vertices[c[1]]);
        const Vec3 n = testing::cross(b - a, testing::exact(soup.vertices[c[2]]) - a);
        solids_.back().push_back({n, testing::dot(n, a), f});
      }
    }
  }

  /// Where the line first enters a solid on its way from position 1 on (wing 1), or from
  /// position 0 back (wing 0), and the polygons that it enters by; nullopt: nowhere.
  struct End {
    Rational position;
    std::vector<int> polygons;
  };
  [[nodiscard]] std::optional<End> end(const std::array<Vec3, 2>& line, int wing) const {
    std::optional<End> nearest;
    for (const auto& solid : solids_) {
      const auto inside = interior(solid, line);
      if (!inside || (wing == 1 ? (*inside)[1] <= 1 : (*inside)[0] >= 0)) continue;
      const Rational& entry = (*inside)[1 - wing];
      if (nearest &&
          (wing == 1 ? entry >= nearest->position : entry <= nearest->position)) {
        continue;
      }
      nearest = {entry, {}};
      for (const Plane& plane : solid) {
        if (plane(at(line, entry)) == 0) nearest->polygons.push_back(plane.polygon);
      }
      std::sort(nearest->polygons.begin(), nearest->polygons.end());
    }
    return nearest;
  }

  /// How long the part of the line between two positions runs inside solids at most.
  [[nodiscard]] double inside_between(const std::array<Vec3, 2>& line,
                                      const Rational& from, const Rational& to) const {
    Rational longest = 0;
    for (const auto& solid : solids_) {
      const auto inside = interior(solid, line);
      if (!inside) continue;
      longest = std::max(
          longest, Rational(std::min((*inside)[1], to) - std::max((*inside)[0], from)));
    }
    return static_cast<double>(longest);
  }

 private:
  struct Plane {
    Vec3 normal;
    Rational offset;
    int polygon;
    Rational operator()(const Vec3& p) const { return testing::dot(normal, p) - offset; }
  };

  static std::optional<std::array<Rational, 2>> interior(
      const std::vector<Plane>& solid, const std::array<Vec3, 2>& line) {
    std::optional<Rational> from, to;
    for (const Plane& plane : solid) {
      const Rational x = plane(line[0]);
      const Rational rate = plane(line[1]) - x;
      if (rate == 0) {
        if (x >= 0) return std::nullopt;
        continue;
      }
      const Rational t = -x / rate;
      if (rate < 0 && (!from || t > *from)) from = t;
      if (rate > 0 && (!to || t < *to)) to = t;
    }
    if (*from >= *to) return std::nullopt;
    return std::array<Rational, 2>{*from, *to};
  }

  std::vector<std::vector<Plane>> solids_;
};

class Lines {
 public:
  explicit Lines(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] std::array<Vec3, 2> line(const SkeletonArc& arc, double s) const {
    if (arc.is_ev()) {
      return {testing::exact(scene_.point(arc.vertex())),
              at(edge(arc.edge()), Rational(s))};
    }
    const Vec3 p = at(edge(arc.edges()[0]), Rational(s));
    const auto [m0, m1] = edge(arc.edges()[1]);
    const auto last = edge(arc.edges()[2]);
    const Vec3 n = testing::cross(m0 - p, m1 - p);
    const Rational x = testing::dot(n, last[0] - p);
    const Rational y = testing::dot(n, last[1] - p);
    return {p, at(last, x / (x - y))};
  }

 private:
  [[nodiscard]] std::array<Vec3, 2> edge(int id) const {
    const auto& points = scene_.edges()[id].points;
    return {testing::exact(scene_.point(points[0])),
            testing::exact(scene_.point(points[1]))};
  }
  const Scene& scene_;
};

struct Answers {
  Scene scene;
  Skeleton skeleton;
  EndIndex ends;
  ViewEvents events;
  explicit Answers(const PolygonSoup& soup)
      : scene(soup),
        skeleton(polygon_skeleton(scene)),
        ends(scene, skeleton),
        events(scene, skeleton, ends) {}
  static Skeleton polygon_skeleton(const Scene& scene) {
    SkeletonRequest request;
    request.events = EventMode::Polygon;
    return build_skeleton(scene, request);
  }
  template <class Visit>
  void each_arc(Visit&& visit) const {
    for (std::uint32_t i = 0; i < skeleton.arcs.size(); ++i) visit(skeleton.arcs[i], i);
  }
};

// Not near an end of the range, where one arc passes into another.
double within(const std::array<double, 2>& range, testing::Random& random) {
  const double margin = 0.01 * (range[1] - range[0]);
  return random.uniform(range[0] + margin, range[1] - margin);
}

// Every arc at a random line: its piece ends where a walk along the line first enters a
// solid, at an end contact in the contact itself.
TEST(EndContacts, PiecesEndWhereLinesEnterASolid) {
  int arcs = 0, ended = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    const PolygonSoup soup = testing::eee_scene(seed);
    const Answers answers(soup);
    const Solids solids(soup);
    const Lines exact(answers.scene);
    const SkeletonLines lines(answers.scene);
    testing::Random random(seed);
    answers.each_arc([&](const SkeletonArc& arc, std::uint32_t) {
      if (arc.range[1] - arc.range[0] < 1e-6) return;
      const double s = within(arc.range, random);
      const auto pieces = lines.ends(arc);
      std::size_t k = 0;
      while (k + 1 < pieces.size() && s > pieces[k].range[1]) ++k;
      if (std::min(s - pieces[k].range[0], pieces[k].range[1] - s) < 1e-9) return;
      const auto line = exact.line(arc, s);
      ++arcs;
      for (int wing = 0; wing < 2; ++wing) {
        ended += arc.ends[wing];
        const auto end = solids.end(line, wing);
        std::vector<int> polygons;
        for (const int f : pieces[k].faces[wing]) {
          polygons.push_back(answers.scene.faces()[f].source);
        }
        std::sort(polygons.begin(), polygons.end());
        if (polygons == (end ? end->polygons : std::vector<int>{})) continue;
        if (++wrong <= 5) ADD_FAILURE() << "seed " << seed << ", wing " << wing;
      }
    });
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(ended, 5000);
  std::printf("%d arcs, %d end contacts\n", arcs, ended);
}

// An eye on a random line of an arc, beyond a contact, moves a little across it: the
// event is told iff no solid is between the eye and the contacts.
TEST(EndContacts, EventsAreToldWhereTheEyeSeesThem) {
  int seen = 0, hidden = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const PolygonSoup soup = testing::eee_scene(seed);
    const Answers answers(soup);
    const Solids solids(soup);
    const Lines exact(answers.scene);
    testing::Random random(seed);
    const double size = (answers.scene.bounds()[1] - answers.scene.bounds()[0]).norm();
    answers.each_arc([&](const SkeletonArc& arc, std::uint32_t number) {
      if (arc.range[1] - arc.range[0] < 0.02 || !random.one_in(6)) return;
      const auto line = exact.line(arc, within(arc.range, random));
      const int wing = random.integer(0, 1);
      const double beyond = random.uniform(0.02, 1.5);
      const double t = wing == 1 ? 1 + beyond : -beyond;
      const auto end = solids.end(line, wing);
      double reach = 1e9;
      if (end) reach = std::abs(static_cast<double>(end->position) - wing);
      if (std::abs(reach - beyond) < 0.01) return;
      const bool expected = reach > beyond;
      const Vec3 x = at(line, Rational(t));
      Point eye, across;
      for (int i = 0; i < 3; ++i) {
        eye[i] = static_cast<double>(x[i]);
        across[i] = random.uniform(-1, 1);
      }
      const Point step = 1e-5 * size * across;
      int told = 0;
      for (const ViewEvent& e : answers.events.crossed(eye - step, eye + step)) {
        const EventKind kind = arc.is_ev() ? EventKind::EV : EventKind::EEE;
        told += e.kind == kind && e.id == number && e.side == wing;
      }
      ++(expected ? seen : hidden);
      if ((told > 0) != expected && ++wrong <= 5) {
        ADD_FAILURE() << "seed " << seed << ": told " << told << ", wing " << wing
                      << ", at " << eye.transpose() << ", free for " << reach << " of "
                      << beyond;
      }
    });
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(seen, 500);
  EXPECT_GT(hidden, 500);
  std::printf("%d seen, %d hidden\n", seen, hidden);
}

// Of EV events told on random paths: the line from the farther contact to the eye is
// exact, and runs inside no solid.
struct EventCount {
  int events = 0, ended = 0;
};

void expect_events_in_front(const PolygonSoup& soup, std::uint64_t seed, int paths,
                            EventCount& count) {
  SCOPED_TRACE(seed);
  const Answers answers(soup);
  const Solids solids(soup);
  testing::Random random(seed);
  const auto meeting = [](const std::array<Vec3, 2>& line, const Vec3& p, const Vec3& q,
                          const Vec3& r) {
    const Vec3 n = testing::cross(q - p, r - p);
    const Rational x = testing::dot(n, line[0] - p);
    return at(line, x / (x - testing::dot(n, line[1] - p)));
  };
  for (int path = 0; path < paths; ++path) {
    const Point a = testing::grid_point(random, answers.scene, 0.3);
    const Point b = testing::grid_point(random, answers.scene, 0.3);
    for (const ViewEvent& e : answers.events.crossed(a, b)) {
      if (e.kind != EventKind::EV) continue;
      const SkeletonArc& arc = answers.skeleton.arcs[e.id];
      const auto& edge = answers.scene.edges()[arc.edge()].points;
      const std::array<Vec3, 2> way{testing::exact(a), testing::exact(b)};
      const std::array<Vec3, 2> e01{testing::exact(answers.scene.point(edge[0])),
                                    testing::exact(answers.scene.point(edge[1]))};
      const Vec3 v = testing::exact(answers.scene.point(arc.vertex()));
      const Vec3 eye = meeting(way, v, e01[0], e01[1]);
      const Vec3 on_edge = meeting(e01, v, way[0], way[1]);
      ++count.events;
      count.ended += arc.ends[0] || arc.ends[1];
      EXPECT_FALSE(arc.ends[e.side]);
      EXPECT_LE(solids.inside_between({e.side == 1 ? v : on_edge, eye}, 0, 1), 0)
          << "path " << path << " arc " << e.id;
    }
  }
}

TEST(EndContacts, NoEventIsToldBehindASolid) {
  EventCount count;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    expect_events_in_front(testing::eee_scene(seed), seed, 10, count);
  }
  EXPECT_GT(count.events, 2000);
  EXPECT_GT(count.ended, 500);
  std::printf("%d events, %d of arcs with an end contact\n", count.events, count.ended);
}

// Two solids, as in the report below: tetrahedra, larger polytopes, boxes with corners on
// a small grid.
TEST(EndContacts, NoEventIsToldBehindEitherOfTwoSolids) {
  EventCount count;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const PolygonSoup soup =
        seed % 3 == 0   ? testing::random_boxes(seed, 2, {.grid = 6})
        : seed % 3 == 1 ? testing::random_polytopes(
                              seed, 2, {.max_vertices = 4, .density = 0.3, .bits = 4})
                        : testing::random_polytopes(seed, 2, {.density = 0.3});
    expect_events_in_front(soup, seed, 6, count);
  }
  EXPECT_GT(count.events, 1500);
  EXPECT_GT(count.ended, 100);
  std::printf("%d events, %d of arcs with an end contact\n", count.events, count.ended);
}

// A report of an outside check: behind the edge (3,9,1)-(10,1,2) of one tetrahedron an
// event of a corner of the other was told, through the first one's inside.
TEST(EndContacts, NoEventThroughTheTetrahedronInFront) {
  const PolygonSoup soup =
      read_mesh(std::string(SIGHTLINE_TEST_DATA) + "/skeleton/two_tetrahedra.obj");
  const Answers answers(soup);
  for (const ViewEvent& e :
       answers.events.crossed({-25.75, -0.25, -1.0625}, {-24.5, -0.25, -1.25})) {
    if (e.kind == EventKind::F) continue;
    ASSERT_EQ(e.kind, EventKind::EV);
    EXPECT_FALSE(answers.scene.point(answers.skeleton.arcs[e.id].vertex()) ==
                 Point(27, 11, 3));
  }
  // What lies beyond an end contact is what the contact itself is on.
  const SkeletonLines lines(answers.scene);
  answers.each_arc([&](const SkeletonArc& arc, std::uint32_t number) {
    for (int wing = 0; wing < 2; ++wing) {
      if (!arc.ends[wing]) continue;
      for (const auto& piece : lines.ends(arc)) EXPECT_FALSE(piece.faces[wing].empty());
      for (const auto& piece : answers.ends.pieces(number)) {
        EXPECT_NE(piece.facets[wing], kOutside);
      }
    }
  });
}

}  // namespace
}  // namespace sightline
