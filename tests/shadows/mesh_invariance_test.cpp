// The same mesh of a scene whose polygons are listed in another order or cut into
// triangles, whose axes are permuted, whose coordinates are multiplied by powers of two,
// and on one and two threads.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "shadows/shadow_mesh.h"
#include "tests/shadows/mesh_proof/small_lit_scenes.h"

namespace sightline::testing {
namespace {

/// What must not change of a receiver.
struct Figures {
  std::array<int, kShadowEdgeKinds> kinds{};
  std::map<std::pair<int, int>, int>
      orders;  // how many edges by kind and order; -1: none
  std::size_t vertices = 0;
  std::vector<std::array<double, 3>> faces;  // class, away, area; ascending
  std::array<double, 5> areas{};
  int umbra_components = 0;
};

std::map<std::string, Figures> figures_of(const ShadowScene& lit, int threads,
                                          std::size_t* structures) {
  const Scene scene(lit.soup);
  std::vector<Receiver> receivers;
  for (const Object& o : scene.objects()) receivers.push_back({o.name, o.faces, true});
  Request request;
  request.threads = threads;
  const Shadows shadows = find_shadows(
      scene, light_source(scene, lit.lights, lit.two_sided), receivers, request);
  *structures = shadows.structures.size();
  std::map<std::string, Figures> result;
  for (const ReceiverShadows& r : shadows.receivers) {
    Figures& f = result[r.name];
    f.areas = {r.area, r.umbra_area, r.penumbra_area, r.lit_area, r.away_area};
    f.umbra_components = r.umbra_components;
    for (const ShadowMesh& mesh : r.meshes) {
      f.vertices += mesh.vertices.size();
      for (const ShadowMesh::Edge& e : mesh.edges) {
        ++f.kinds[static_cast<int>(e.kind)];
        ++f.orders[{static_cast<int>(e.kind), e.order.value_or(-1)}];
      }
      for (const ShadowMesh::Face& face : mesh.faces) {
        f.faces.push_back(
            {static_cast<double>(face.shadow), face.away ? 1.0 : 0.0, face.area});
      }
    }
    std::ranges::sort(f.faces);
  }
  return result;
}

/// `scale`: of areas.
void expect_same(const ShadowScene& lit, const ShadowScene& other, double scale,
                 int threads) {
  std::size_t structures = 0, other_structures = 0;
  const auto figures = figures_of(lit, 1, &structures);
  const auto others = figures_of(other, threads, &other_structures);
  EXPECT_EQ(structures, other_structures);
  ASSERT_EQ(figures.size(), others.size());
  for (const auto& [name, f] : figures) {
    SCOPED_TRACE(name);
    const Figures& g = others.at(name);
    EXPECT_EQ(f.kinds, g.kinds);
    EXPECT_EQ(f.orders, g.orders);
    EXPECT_EQ(f.vertices, g.vertices);
    EXPECT_EQ(f.umbra_components, g.umbra_components);
    for (std::size_t i = 0; i < f.areas.size(); ++i)
      EXPECT_NEAR(f.areas[i] * scale, g.areas[i], 1e-12 * f.areas[0] * scale);
    ASSERT_EQ(f.faces.size(), g.faces.size());
    for (std::size_t i = 0; i < f.faces.size(); ++i) {
      EXPECT_EQ(f.faces[i][0], g.faces[i][0]);
      EXPECT_EQ(f.faces[i][1], g.faces[i][1]);
      EXPECT_NEAR(f.faces[i][2] * scale, g.faces[i][2], 1e-12 * f.areas[0] * scale);
    }
  }
}

/// Polygons and groups in another order, polygons beginning elsewhere.
ShadowScene reordered(const ShadowScene& lit) {
  ShadowScene result = lit;
  std::mt19937_64 random(7);
  std::vector<int> order(lit.soup.polygons.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::ranges::shuffle(order, random);
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<int>(i);
    result.soup.polygons[i] = lit.soup.polygons[order[i]];
    std::ranges::rotate(result.soup.polygons[i], result.soup.polygons[i].begin() + 1);
  }
  for (PolygonSoup::Group& group : result.soup.groups) {
    for (int& f : group.faces) f = place[f];
    std::ranges::sort(group.faces);
  }
  std::ranges::reverse(result.soup.groups);
  return result;
}

/// Coordinates in the order of `axes`; an odd one turns all polygons.
ShadowScene with_axes(const ShadowScene& lit, const std::array<int, 3>& axes) {
  ShadowScene result = lit;
  for (Point& p : result.soup.vertices) p = Point(p[axes[0]], p[axes[1]], p[axes[2]]);
  const int odd = (axes[0] > axes[1]) + (axes[0] > axes[2]) + (axes[1] > axes[2]);
  if (odd % 2 == 1) {
    for (auto& polygon : result.soup.polygons) std::ranges::reverse(polygon);
  }
  return result;
}

ShadowScene scaled(const ShadowScene& lit, double scale) {
  ShadowScene result = lit;
  for (Point& p : result.soup.vertices) p *= scale;
  return result;
}

/// Quadrilaterals as two triangles, along either diagonal.
ShadowScene in_triangles(const ShadowScene& lit) {
  ShadowScene result{lit.name, {}, lit.lights, lit.two_sided};
  result.soup.vertices = lit.soup.vertices;
  int number = 0;
  for (const PolygonSoup::Group& group : lit.soup.groups) {
    PolygonSoup::Group cut{.name = group.name, .faces = {}};
    const auto add = [&](std::vector<int> polygon) {
      cut.faces.push_back(static_cast<int>(result.soup.polygons.size()));
      result.soup.polygons.push_back(std::move(polygon));
    };
    for (const int f : group.faces) {
      const std::vector<int>& p = lit.soup.polygons[f];
      if (p.size() != 4) {
        add(p);
        continue;
      }
      const std::size_t k = static_cast<std::size_t>(number++) % 2;
      add({p[k], p[k + 1], p[k + 2]});
      add({p[k], p[k + 2], p[(k + 3) % 4]});
    }
    result.soup.groups.push_back(std::move(cut));
  }
  return result;
}

class MeshInvariance : public ::testing::Test {
 protected:
  template <class Change>
  void compare(const Change& change, double scale, int threads = 1) {
    for (const ShadowScene& lit : small_lit_scenes()) {
      SCOPED_TRACE(lit.name);
      expect_same(lit, change(lit), scale, threads);
    }
  }
};

TEST_F(MeshInvariance, OrderOfPolygonsAndGroups) { compare(reordered, 1); }

TEST_F(MeshInvariance, Axes) {
  for (const auto& axes : {std::array{1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}})
    compare([&](const ShadowScene& lit) { return with_axes(lit, axes); }, 1);
}

TEST_F(MeshInvariance, PowersOfTwo) {
  for (const double scale : {0x1p-30, 0x1p20})
    compare([&](const ShadowScene& lit) { return scaled(lit, scale); }, scale * scale);
}

TEST_F(MeshInvariance, QuadrilateralsAsTriangles) { compare(in_triangles, 1); }

TEST_F(MeshInvariance, OneAndTwoThreads) {
  compare([](const ShadowScene& lit) { return lit; }, 1, 2);
}

}  // namespace
}  // namespace sightline::testing
