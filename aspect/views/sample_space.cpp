#include "aspect/views/sample_space.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace sightline::internal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

void add_pair(std::vector<std::array<int, 2>>& pairs, int a, int b) {
  pairs.push_back({std::min(a, b), std::max(a, b)});
}

void sort_pairs(std::vector<std::array<int, 2>>& pairs) {
  std::ranges::sort(pairs);
  pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
}

// An icosahedron whose triangles are cut into four, again and again.
Samples geodesic_sphere(int least) {
  Samples out;
  const double g = std::numbers::phi;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-g, g}) {
      out.at.emplace_back(0, a, b);
      out.at.emplace_back(a, b, 0);
      out.at.emplace_back(b, 0, a);
    }
  }
  std::vector<std::array<int, 3>> triangles;
  const auto near = [&](int i, int j) { return (out.at[i] - out.at[j]).norm() < 2.1; };
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (near(i, j) && near(j, k) && near(i, k)) triangles.push_back({i, j, k});
      }
    }
  }
  for (Point& p : out.at) p.normalize();
  while (static_cast<int>(out.at.size()) < least) {
    std::map<std::array<int, 2>, int> middles;
    const auto middle = [&](int i, int j) {
      const std::array key{std::min(i, j), std::max(i, j)};
      const auto [it, is_new] = middles.emplace(key, static_cast<int>(out.at.size()));
      if (is_new) out.at.push_back((out.at[i] + out.at[j]).normalized());
      return it->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  for (const auto& [a, b, c] : triangles) {
    add_pair(out.neighbours, a, b);
    add_pair(out.neighbours, b, c);
    add_pair(out.neighbours, c, a);
  }
  sort_pairs(out.neighbours);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.3711, Point(1, 2, 3).normalized())).toRotationMatrix();
  for (Point& p : out.at) p = turn * p;
  return out;
}

Samples grid(const std::array<Point, 2>& box, int least) {
  Samples out;
  const Point size = box[1] - box[0];
  int n = 1;
  while (static_cast<long>(n) * n * n < least) ++n;
  // A hair off the middle, which symmetric scenes have planes through.
  const Point off(0.4870, 0.5091, 0.4957);
  const auto id = [n](int x, int y, int z) { return (z * n + y) * n + x; };
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const Point cell(x, y, z);
        out.at.push_back(box[0] + ((cell + off) / n).cwiseProduct(size));
        if (x + 1 < n) add_pair(out.neighbours, id(x, y, z), id(x + 1, y, z));
        if (y + 1 < n) add_pair(out.neighbours, id(x, y, z), id(x, y + 1, z));
        if (z + 1 < n) add_pair(out.neighbours, id(x, y, z), id(x, y, z + 1));
      }
    }
  }
  return out;
}

using Base = CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>;
using Structure = CGAL::Triangulation_data_structure_3<Base>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, Structure>;

}  // namespace

// Of points on the sphere it is their hull: the triangulation with the centre.
std::vector<std::array<int, 2>> neighbours_of(const std::vector<Point>& at,
                                              Projection projection) {
  const bool sphere = projection == Projection::Orthographic;
  std::vector<std::array<int, 2>> out;
  std::vector<std::pair<Kernel::Point_3, int>> points;
  for (std::size_t i = 0; i < at.size(); ++i) {
    points.emplace_back(Kernel::Point_3(at[i][0], at[i][1], at[i][2]),
                        static_cast<int>(i));
  }
  if (sphere) points.emplace_back(Kernel::Point_3(0, 0, 0), -1);
  const Delaunay triangulation(points.begin(), points.end());
  for (auto e = triangulation.finite_edges_begin(); e != triangulation.finite_edges_end();
       ++e) {
    const int a = e->first->vertex(e->second)->info();
    const int b = e->first->vertex(e->third)->info();
    if (a >= 0 && b >= 0) add_pair(out, a, b);
  }
  sort_pairs(out);
  return out;
}

std::array<Point, 2> view_box(const Scene& scene, const AspectRequest& request) {
  if (request.bounds) return *request.bounds;
  const Point size = scene.bounds()[1] - scene.bounds()[0];
  return {scene.bounds()[0] - size, scene.bounds()[1] + size};
}

double view_weight(const Scene& scene, const AspectRequest& request) {
  if (request.projection == Projection::Orthographic) return 4 * std::numbers::pi;
  const auto [low, high] = view_box(scene, request);
  return (high - low).prod();
}

std::vector<Point> random_samples(const Scene& scene, const AspectRequest& request,
                                  int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Point> out;
  if (request.projection == Projection::Orthographic) {
    std::normal_distribution<double> normal;
    while (static_cast<int>(out.size()) < count) {
      const Point p(normal(random), normal(random), normal(random));
      if (p.norm() > 0) out.push_back(p.normalized());
    }
    return out;
  }
  const auto [low, high] = view_box(scene, request);
  while (static_cast<int>(out.size()) < count) {
    Point p;
    for (int i = 0; i < 3; ++i)
      p[i] = std::uniform_real_distribution<double>(low[i], high[i])(random);
    out.push_back(p);
  }
  return out;
}

Samples samples_of(const Scene& scene, const AspectRequest& request) {
  const bool sphere = request.projection == Projection::Orthographic;
  if (request.sampling == Sampling::Regular) {
    return sphere ? geodesic_sphere(request.samples)
                  : grid(view_box(scene, request), request.samples);
  }
  Samples out;
  out.at = random_samples(scene, request, request.samples, request.seed);
  out.neighbours = neighbours_of(out.at, request.projection);
  return out;
}

}  // namespace sightline::internal
