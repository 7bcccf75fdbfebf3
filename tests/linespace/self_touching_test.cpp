// Which faces of an object meet beyond what they share, against all pairs; and that many
// copies, fans and stars cost no more than they have faces.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <ctime>
#include <random>

#include "linespace/scene.h"
#include "linespace/scene/face_pair.h"

namespace sightline {
namespace {

/// All polygons that meet another of their object, by asking every pair.
std::vector<int> touching_by_pairs(const Scene& scene) {
  internal::FacePair pair(scene);
  std::vector<char> touches(scene.soup().polygons.size(), 0);
  const auto faces = scene.faces();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t g = f + 1; g < faces.size(); ++g) {
      if (faces[f].object != faces[g].object || faces[f].source == faces[g].source) {
        continue;
      }
      if (pair.meet(static_cast<int>(f), static_cast<int>(g))) {
        touches[faces[f].source] = touches[faces[g].source] = 1;
      }
    }
  }
  std::vector<int> found;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (touches[i] != 0) found.push_back(static_cast<int>(i));
  }
  return found;
}

/// Some pieces of the two polygons meet.
bool meet(const Scene& scene, int p, int q) {
  internal::FacePair pair(scene);
  const auto faces = scene.faces();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t g = 0; g < faces.size(); ++g) {
      if (faces[f].source == p && faces[g].source == q &&
          pair.meet(static_cast<int>(f), static_cast<int>(g))) {
        return true;
      }
    }
  }
  return false;
}

class RandomFaces {
 public:
  explicit RandomFaces(unsigned seed) : random_(seed) {}

  /// Faces with corners on a grid, of which many have corner 0, or the side from 0 to 1;
  /// every shape that is told apart: triangles, quads, corners on a straight side, and
  /// polygons that become several pieces.
  PolygonSoup soup() {
    PolygonSoup s;
    const int size = 1 + static_cast<int>(random_() % 4);
    for (int i = 0; i < 60; ++i) {
      s.vertices.emplace_back(coordinate(size), coordinate(size), coordinate(size));
    }
    const unsigned kind = random_() % 4;
    const int n = 10 + static_cast<int>(random_() % 60);
    for (int i = 0; i < n; ++i) {
      std::vector<int> polygon;
      if (kind > 0 && random_() % 8 != 0) polygon.push_back(0);
      if (kind > 1 && random_() % 8 != 0) polygon.push_back(1);
      while (polygon.size() < 3) polygon.push_back(vertex());
      if (random_() % 3 == 0) add_fourth(s, polygon);
      if (random_() % 4 == 0) add_middle(s, polygon);
      if (random_() % 4 == 0) prolong(s, polygon);
      if (random_() % 2 == 0) std::reverse(polygon.begin(), polygon.end());
      s.polygons.push_back(std::move(polygon));
    }
    s.groups = {{"one", {}}, {"two", {}}};
    for (int f = 0; f < n; ++f) s.groups[random_() % 7 == 0].faces.push_back(f);
    return s;
  }

 private:
  double coordinate(int size) { return static_cast<int>(random_() % (2 * size + 1)); }
  int vertex() { return static_cast<int>(random_() % 60); }
  // A parallelogram.
  static void add_fourth(PolygonSoup& s, std::vector<int>& polygon) {
    const Point p =
        s.vertices[polygon[0]] + s.vertices[polygon[2]] - s.vertices[polygon[1]];
    polygon.push_back(static_cast<int>(s.vertices.size()));
    s.vertices.push_back(p);
  }
  // A corner in the middle of a side.
  static void add_middle(PolygonSoup& s, std::vector<int>& polygon) {
    const Point p = (s.vertices[polygon[0]] + s.vertices[polygon[1]]) / 2;
    polygon.insert(polygon.begin() + 1, static_cast<int>(s.vertices.size()));
    s.vertices.push_back(p);
  }
  // A side goes on straight beyond its second corner.
  void prolong(PolygonSoup& s, std::vector<int>& polygon) {
    const Point p =
        s.vertices[polygon[1]] +
        (1 + random_() % 2) * (s.vertices[polygon[1]] - s.vertices[polygon[0]]);
    polygon.insert(polygon.begin() + 2, static_cast<int>(s.vertices.size()));
    s.vertices.push_back(p);
  }

  std::mt19937 random_;
};

TEST(SelfTouching, NamesThePolygonsThatAllPairsTellAndOnePartnerEach) {
  std::size_t touching = 0, alone = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene(RandomFaces(seed).soup());
    std::vector<int> named;
    for (const Defect& defect : find_self_touching(scene)) {
      ASSERT_EQ(defect.kind, "self-touching");
      ASSERT_EQ(defect.faces.size(), 2u);
      named.push_back(defect.faces[0]);
      if (seed % 20 == 0) {
        EXPECT_TRUE(meet(scene, defect.faces[0], defect.faces[1]));
      }
    }
    ASSERT_EQ(named, touching_by_pairs(scene));
    touching += named.size();
    alone += scene.soup().polygons.size() - named.size();
  }
  EXPECT_GT(touching, 3'000u);
  EXPECT_GT(alone, 600u);
}

/// Triangles at a corner, or around a side, of which few meet: most are thin, and in
/// directions of their own; some are long, and some repeat a plane or a side's line.
PolygonSoup sparse_star(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto any = [&] { return Point(unit(random), unit(random), unit(random)); };
  const bool upright = seed % 4 < 2;
  const Point apex = upright ? Point(0, 0, 0) : any();
  const Point top = upright ? Point(0, 0, 1) : Point(apex + any());
  PolygonSoup s;
  s.vertices = {apex, top};
  const auto add = [&](const Point& p) {
    s.vertices.push_back(p);
    return static_cast<int>(s.vertices.size()) - 1;
  };
  for (int i = 0; i < 40; ++i) {
    const Point p = any();
    if (seed % 2 == 0) {
      s.polygons.push_back({0, 1, add(p)});
      if (random() % 40 == 0) {  // goes on beyond the side
        s.polygons.back().insert(s.polygons.back().begin() + 2, add(2 * top - apex));
      }
    } else {
      const Point q = random() % 40 == 0 ? any() : Point(p + 0.01 * any());
      s.polygons.push_back({0, add(p), add(q)});
    }
    if (random() % 40 == 0) {  // another one, larger, in the same half-plane
      const auto& polygon = s.polygons[random() % s.polygons.size()];
      const Point r = s.vertices[polygon.back()];
      s.polygons.push_back({0, polygon[1], add(apex + 2 * (r - apex))});
    }
    if (upright && random() % 30 == 0) {
      s.polygons.push_back({0, 1, add({unit(random), 0, unit(random)})});
    }
  }
  return s;
}

TEST(SelfTouching, FindsTheFewThatMeetInStarsAndFans) {
  std::size_t touching = 0, alone = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene(sparse_star(seed));
    std::vector<int> named;
    for (const Defect& defect : find_self_touching(scene)) {
      named.push_back(defect.faces[0]);
    }
    EXPECT_EQ(named, touching_by_pairs(scene));
    touching += named.size();
    alone += scene.soup().polygons.size() - named.size();
  }
  EXPECT_GT(touching, 1'000u);
  EXPECT_GT(alone, 20'000u);
}

/// Processor time.
double seconds_of(const PolygonSoup& soup, std::size_t defects) {
  const std::clock_t start = std::clock();
  EXPECT_EQ(find_self_touching(Scene(soup)).size(), defects);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

constexpr int kFaces = 30'000;
constexpr double kTurn = 2 * 3.14159265358979323846 / kFaces;

// All pairs of 30,000 faces would take a minute.
TEST(SelfTouching, CostsLittleWhereManyFacesMeetLawfully) {
  PolygonSoup stacked;  // nearly copies
  stacked.vertices = {{0, 0, 0}, {1, 0, 0}};
  for (int i = 0; i < kFaces; ++i) {
    stacked.vertices.emplace_back(0, 1 + 1e-6 * i, 0);
    stacked.polygons.push_back({0, 1, i + 2});
  }
  EXPECT_LT(seconds_of(stacked, kFaces), 2);

  PolygonSoup around_a_side;
  around_a_side.vertices = {{0, 0, 0}, {0, 0, 1}};
  for (int i = 0; i < kFaces; ++i) {
    around_a_side.vertices.emplace_back(std::cos(i * kTurn), std::sin(i * kTurn), 0.5);
    around_a_side.polygons.push_back({0, 1, i + 2});
  }
  EXPECT_LT(seconds_of(around_a_side, 0), 2);

  PolygonSoup disc;
  disc.vertices = {{0, 0, 0}};
  for (int i = 0; i < kFaces; ++i) {
    disc.vertices.emplace_back(std::cos(i * kTurn), std::sin(i * kTurn), 0);
    disc.polygons.push_back({0, i + 1, (i + 1) % kFaces + 1});
  }
  EXPECT_LT(seconds_of(disc, 0), 2);
}

/// Long thin triangles askew, in bundles that each run one way; few of them meet.
PolygonSoup bundles(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto any = [&] { return Point(unit(random), unit(random), unit(random)); };
  PolygonSoup s;
  const int ways = 1 + static_cast<int>(seed % 3);
  for (int way = 0; way < ways; ++way) {
    const Point along = any(), place = 0.3 * any();
    for (int i = 0; i < 100; ++i) {
      const int n = static_cast<int>(s.vertices.size());
      const Point at = place + 0.1 * any();
      s.vertices.push_back(at);
      s.vertices.push_back(at + along + 1e-4 * any());
      s.vertices.push_back(at + 0.01 * any());
      s.polygons.push_back({n, n + 1, n + 2});
    }
  }
  return s;
}

TEST(SelfTouching, FindsThinFacesAskewThatMeet) {
  std::size_t touching = 0, alone = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    PolygonSoup soup = bundles(seed);
    soup.groups = {{"all", {}}};
    for (std::size_t f = 0; f < soup.polygons.size(); ++f)
      soup.groups[0].faces.push_back(static_cast<int>(f));
    const Scene scene(soup);
    std::vector<int> named;
    for (const Defect& defect : find_self_touching(scene))
      named.push_back(defect.faces[0]);
    ASSERT_EQ(named, touching_by_pairs(scene));
    touching += named.size();
    alone += scene.soup().polygons.size() - named.size();
  }
  EXPECT_GT(touching, 500u);
  EXPECT_GT(alone, 500u);
}

// Two caps of thin triangles, close together and turned in space: with boxes along the
// axes they took 13 s.
TEST(SelfTouching, CostsLittleWhereThinFacesRunAskew) {
  PolygonSoup flat;
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.7, Point(1, 2, 3).normalized()));
  const auto add = [&](double x, double y, double z) {
    flat.vertices.push_back(turn * Point(x, y, z));
  };
  constexpr int kSides = kFaces;
  const double side = kTurn;
  add(0, 0, 0);
  add(0, 0, 0.01);
  for (const double z : {0.0, 0.01}) {
    for (int i = 0; i < kSides; ++i) add(std::cos(i * side), std::sin(i * side), z);
  }
  for (int i = 0; i < kSides; ++i) {
    const int a = i + 2, b = (i + 1) % kSides + 2, c = a + kSides, d = b + kSides;
    for (const std::vector<int>& face :
         std::vector<std::vector<int>>{{0, b, a}, {1, c, d}, {a, b, d}, {a, d, c}}) {
      flat.polygons.push_back(face);
    }
  }
  EXPECT_LT(seconds_of(flat, 0), 4);
}

}  // namespace
}  // namespace sightline
