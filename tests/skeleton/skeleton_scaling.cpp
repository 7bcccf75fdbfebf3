// How the whole skeleton grows, as CSV on standard output and fits as comment lines (#).
//
//   skeleton_scaling law [DENSITY [SCENES_PER_SIZE [LARGEST]]]
//     k random disjoint polytopes with n edges in all, k = 12 to LARGEST (default 200):
//     the numbers of nodes by kind beside the law C k sqrt(n k) of Zhang, Everett,
//     Lazard, Weibel and Whitesides (2008).  docs/pictures/skeleton_law.gp draws it.
//   skeleton_scaling polytopes|city LARGEST [double]
//     one scene each of 500, 750, ... polygons up to LARGEST: seconds, bytes, arcs.

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/skeleton.h"
#include "tests/support/generators.h"

namespace {

using namespace sightline;  // NOLINT(google-build-using-namespace)

constexpr std::array kKinds{"VV", "VEE", "EVE", "FvE", "EEEE", "FEE", "all"};

struct Row {
  double k = 0, edges = 0, polygons = 0, seconds = 0, arcs = 0;
  std::array<double, kKinds.size()> nodes{};
};

Row measure(const PolygonSoup& soup, Precision precision) {
  const Scene scene(soup);
  SkeletonRequest request;
  request.precision = precision;
  const auto start = std::chrono::steady_clock::now();
  const Skeleton skeleton = build_skeleton(scene, request);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  Row row;
  row.k = static_cast<double>(scene.objects().size());
  row.edges = static_cast<double>(scene.edges().size());
  row.polygons = static_cast<double>(soup.polygons.size());
  row.seconds = spent.count();
  row.arcs = static_cast<double>(skeleton.arcs.size() + skeleton.eee_arcs.size());
  for (const SkeletonNode& node : skeleton.nodes) {
    const auto kind = static_cast<std::size_t>(node.kind);
    if (kind < kKinds.size() - 1) ++row.nodes[kind];
    ++row.nodes.back();
  }
  return row;
}

// Least squares of log y = a + b log x; b, exp(a), and the largest factor off.
struct Fit {
  double exponent, constant, off;
};
Fit fit(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]);
    const double v = std::log(y[i]);
    n += 1, sx += u, sy += v, sxx += u * u, sxy += u * v;
  }
  Fit f{};
  f.exponent = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  const double a = (sy - f.exponent * sx) / n;
  f.constant = std::exp(a);
  for (std::size_t i = 0; i < x.size(); ++i) {
    f.off = std::max(f.off, std::abs(std::log(y[i]) - a - f.exponent * std::log(x[i])));
  }
  f.off = std::exp(f.off);
  return f;
}

void law(double density, int scenes_per_size, int largest) {
  std::printf("k,edges,seed,seconds");
  for (const char* kind : kKinds) std::printf(",%s", kind);
  std::printf("\n");
  std::vector<Row> rows;
  for (const int k : {12, 25, 50, 100, 141, 200}) {
    if (k > largest) break;
    for (int i = 1; i <= scenes_per_size; ++i) {
      const auto seed = static_cast<std::uint64_t>(1000 * k + i);
      rows.push_back(measure(testing::random_polytopes(seed, k, {.density = density}),
                             Precision::Exact));
      const Row& row = rows.back();
      std::printf("%d,%.0f,%d,%.3f", k, row.edges, i, row.seconds);
      for (const double count : row.nodes) std::printf(",%.0f", count);
      std::printf("\n");
      std::fflush(stdout);
    }
  }
  std::printf(
      "# kind, mean C and its standard deviation for C k sqrt(n k), least, most; "
      "exponent of k sqrt(n k) if free, factor at most off\n");
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    std::vector<double> size, count, c;
    for (const Row& row : rows) {
      if (row.nodes[kind] == 0) continue;
      size.push_back(row.k * std::sqrt(row.edges * row.k));
      count.push_back(row.nodes[kind]);
      c.push_back(count.back() / size.back());
    }
    if (c.size() < 3) continue;
    double mean = 0, variance = 0;
    for (const double x : c) mean += x / static_cast<double>(c.size());
    for (const double x : c) {
      variance += (x - mean) * (x - mean) / static_cast<double>(c.size() - 1);
    }
    const Fit f = fit(size, count);
    std::printf("# %s: C = %.4f +- %.4f (%.4f to %.4f); exponent %.3f, off by %.2f\n",
                kKinds[kind], mean, std::sqrt(variance),
                *std::min_element(c.begin(), c.end()),
                *std::max_element(c.begin(), c.end()), f.exponent, f.off);
  }
}

void growth(bool city, int largest, Precision precision) {
  std::printf("polygons,edges,seconds,arcs,nodes,peak_mib\n");
  std::vector<double> polygons, seconds, arcs;
  for (double wanted = 500; wanted <= 1.001 * largest; wanted *= 1.4953) {  // 10^(1/5.72)
    const int size = static_cast<int>(std::lround(wanted));
    const PolygonSoup soup =
        city ? testing::city(1, size)
             : testing::random_polytopes(1, size / 8, {.density = 0.2});
    const Row row = measure(soup, precision);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::printf("%.0f,%.0f,%.3f,%.0f,%.0f,%ld\n", row.polygons, row.edges, row.seconds,
                row.arcs, row.nodes.back(), usage.ru_maxrss / 1024);
    std::fflush(stdout);
    polygons.push_back(row.polygons);
    seconds.push_back(row.seconds);
    arcs.push_back(row.arcs);
  }
  if (polygons.size() < 3) return;
  std::printf("# exponents over %.0f to %.0f polygons: seconds %.3f, arcs %.3f\n",
              polygons.front(), polygons.back(), fit(polygons, seconds).exponent,
              fit(polygons, arcs).exponent);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "law") {
    law(argc > 2 ? std::atof(argv[2]) : 0.1, argc > 3 ? std::atoi(argv[3]) : 6,
        argc > 4 ? std::atoi(argv[4]) : 200);
    return 0;
  }
  if ((what == "polytopes" || what == "city") && argc > 2) {
    growth(what == "city", std::atoi(argv[2]),
           argc > 3 && std::strcmp(argv[3], "double") == 0 ? Precision::Double
                                                           : Precision::Exact);
    return 0;
  }
  std::fprintf(stderr,
               "usage: skeleton_scaling law [DENSITY [SCENES_PER_SIZE [LARGEST]]]\n"
               "       skeleton_scaling polytopes|city LARGEST [double]\n");
  return 2;
}
