// How the whole skeleton grows, as CSV on standard output and fits as comment lines (#).
//
//   skeleton_scaling law [DENSITY [SCENES_PER_SIZE [LARGEST]]]
//     k random disjoint polytopes with n edges in all, k = 12 to LARGEST (default 200):
//     the numbers of nodes by kind beside the law C k sqrt(n k) of Zhang, Everett,
//     Lazard, Weibel and Whitesides (2008).  docs/pictures/skeleton_law.gp draws it.
//   skeleton_scaling polytopes|city LARGEST [double]
//     one scene each of 500, 750, ... polygons up to LARGEST: seconds, bytes, arcs.
//   skeleton_scaling streets LARGEST [ev] [polygon]
//     six cities side by side, of 1,000, 1,585, ... polygons up to LARGEST: wall and
//     processor time, arcs, the share of signs that took exact numbers; the exponents
//     with which arcs and processor time grew since the size before; processor time an
//     arc over that of the random city.
//   skeleton_scaling CITY POLYGONS views
//     processor time, in one thread, of the EV arcs of all corners in both modes, and of
//     the exact views from the same corners: the pieces of lines that they see
//     (`pieces`), and all of them (`views`).
//   skeleton_scaling CITY POLYGONS [ev] [polygon]
//     one of these, with a hash of the whole answer: CITY is random, street, square, sunk
//     or floating (both street cities), square-sunk or touching (a grid city).

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

#include "linespace/picture/eye_star.h"
#include "linespace/picture/view_window.h"
#include "linespace/point_view.h"
#include "linespace/scene.h"
#include "linespace/view/line_view.h"
#include "linespace/view/possibly_seen.h"
#include "skeleton/build.h"
#include "tests/support/generators.h"

namespace {

using namespace sightline;  // NOLINT(google-build-using-namespace)

/// The cities of `streets`; `random` is testing::city.
PolygonSoup city_of(const std::string& name, int polygons) {
  if (name == "random") return testing::city(1, polygons);
  if (name == "touching") return testing::grid_city(1, polygons, {.may_touch = true});
  testing::StreetCityOptions options;
  options.square = name.starts_with("square");
  if (name.ends_with("sunk")) options.bottom = -1;
  if (name.ends_with("floating")) options.bottom = 0.001;
  return testing::street_city(1, polygons, options);
}
constexpr std::array kCities{"random",      "street",   "square",  "sunk",
                             "square-sunk", "floating", "touching"};
constexpr std::size_t kSideBySide = 6;

constexpr std::array kKinds{"VV", "VEE", "EVE", "FvE", "EEEE", "FEE", "all"};

struct Row {
  double k = 0, edges = 0, polygons = 0, seconds = 0, processor_seconds = 0;
  double arcs = 0, eee_arcs = 0;  // of all, EEE
  double exact_share = 0;         // of the signs
  std::uint64_t hash = 0;         // of the answer
  std::array<double, kKinds.size()> nodes{};
};

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Of arcs and nodes with all that is told of them, in their order (FNV-1a).  Ranges and
/// points are rounded to 2^-28: their last bits depend on which of several cuts that
/// coincide is told.
std::uint64_t hash_of(const Skeleton& skeleton) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](const auto& value) {
    std::array<unsigned char, sizeof(value)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(value));
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  };
  const auto add_arc = [&](const auto& arc) {
    for (const bool flag : {arc.self, arc.ends[0], arc.ends[1]}) add(flag);
    for (const double x : arc.range) add(std::floor(x * 0x1p28 + 0.317));
    for (const std::uint32_t node : arc.nodes) add(node);
  };
  for (const SkeletonArc& arc : skeleton.ev()) {
    add(arc.vertex()), add(arc.edge());
    add_arc(arc);
  }
  for (const SkeletonArc& arc : skeleton.eee()) {
    for (const std::int32_t edge : arc.edges()) add(edge);
    add_arc(arc);
  }
  for (const SkeletonNode& node : skeleton.nodes) {
    add(node.kind);
    for (const bool flag : {node.self, node.end, node.second, node.ends[0], node.ends[1]})
      add(flag);
    for (const Generator& x : skeleton.generators(node)) add(x.kind), add(x.id);
    for (const Point& p : node.segment) {
      for (const double x : p) add(std::floor(x * 0x1p28 + 0.317));
    }
  }
  return hash;
}

Row measure(const PolygonSoup& soup, const SkeletonRequest& request) {
  const Scene scene(soup);
  const double processor_before = processor_seconds();
  const auto start = std::chrono::steady_clock::now();
  const Skeleton skeleton = build_skeleton(scene, request);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  Row row;
  row.processor_seconds = processor_seconds() - processor_before;
  row.eee_arcs = static_cast<double>(skeleton.eee().size());
  const StageCounts& signs = skeleton.predicates;
  row.exact_share =
      static_cast<double>(signs.by_exact) /
      static_cast<double>(signs.by_double + signs.by_interval + signs.by_exact);
  row.hash = hash_of(skeleton);
  row.k = static_cast<double>(scene.objects().size());
  row.edges = static_cast<double>(scene.edges().size());
  row.polygons = static_cast<double>(soup.polygons.size());
  row.seconds = spent.count();
  row.arcs = static_cast<double>(skeleton.ev().size() + skeleton.eee().size());
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
      rows.push_back(
          measure(testing::random_polytopes(seed, k, {.density = density}), {}));
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
    SkeletonRequest request;
    request.precision = precision;
    const Row row = measure(soup, request);
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

void print_city(const char* name, const Row& row) {
  std::printf("%s,%.0f,%.0f,%.0f,%.2f,%.2f,%.3f,%.2f", name, row.polygons,
              row.arcs - row.eee_arcs, row.eee_arcs, row.seconds, row.processor_seconds,
              100 * row.exact_share, 1e6 * row.processor_seconds / row.arcs);
}

constexpr const char* kCityHeader =
    "city,polygons,ev_arcs,eee_arcs,seconds,processor_seconds,exact_percent,"
    "processor_microseconds_an_arc";

// Of y in x, between the last two.
double last_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  return std::log(y[n - 1] / y[n - 2]) / std::log(x[n - 1] / x[n - 2]);
}

void streets(int largest, const SkeletonRequest& request) {
  std::printf("%s,arcs_exponent,processor_exponent,times_random\n", kCityHeader);
  std::array<std::vector<double>, kSideBySide> polygons, seconds, arcs;
  for (double wanted = 1000; wanted <= 1.001 * largest; wanted *= 1.58489) {  // 10^(1/5)
    for (std::size_t i = 0; i < kSideBySide; ++i) {
      const Row row =
          measure(city_of(kCities[i], static_cast<int>(std::lround(wanted))), request);
      polygons[i].push_back(row.polygons);
      seconds[i].push_back(row.processor_seconds);
      arcs[i].push_back(row.arcs);
      print_city(kCities[i], row);
      const double times =
          (seconds[i].back() / arcs[i].back()) / (seconds[0].back() / arcs[0].back());
      if (polygons[i].size() == 1) {
        std::printf(",,,%.2f\n", times);
      } else {
        std::printf(",%.2f,%.2f,%.2f\n", last_exponent(polygons[i], arcs[i]),
                    last_exponent(polygons[i], seconds[i]), times);
      }
      std::fflush(stdout);
    }
  }
  if (polygons[0].size() < 3) return;
  for (std::size_t i = 0; i < kSideBySide; ++i) {
    std::printf("# %s: exponents of processor time %.3f, arcs %.3f\n", kCities[i],
                fit(polygons[i], seconds[i]).exponent,
                fit(polygons[i], arcs[i]).exponent);
  }
}

/// How many pieces of edges an eye sees, found as its view finds them.
std::size_t pieces_from(const internal::ViewScene& scene, const Point& eye) {
  const internal::EyeSpace space(scene, eye_at(eye));
  const auto seen = internal::possibly_seen(space);
  const internal::EyeStar star(space);
  const internal::Window window(space);
  internal::LineViewer viewer(space, star, window, seen);
  std::vector<std::uint8_t> asked(scene.lines().size());
  std::vector<internal::LinePiece> pieces;
  for (int f = 0; f < static_cast<int>(seen.size()); ++f) {
    if (seen[f] == 0) continue;
    for (int k = 0; k < scene.scene().faces()[f].corner_count; ++k) {
      const int line = scene.line_of_side(f, k);
      if (line >= 0 && asked[line]++ == 0) viewer.view(line, pieces);
    }
  }
  return pieces.size();
}

void views(const std::string& city, int polygons) {
  const Scene scene(city_of(city, polygons));
  const PointViewIndex index(scene);
  double start = processor_seconds();
  const auto lap = [&] {
    const double before = start;
    start = processor_seconds();
    return start - before;
  };
  std::printf("city,polygons,corners,ev,ev_polygon,pieces,views\n%s,%zu,%zu",
              city.c_str(), scene.faces().size(), scene.corners().size());
  for (const EventMode mode : {EventMode::Solid, EventMode::Polygon}) {
    SkeletonRequest request;
    request.eee = false;
    request.threads = 1;
    request.events = mode;
    lap();
    const std::size_t arcs = build_skeleton(scene, request).arcs.size();
    std::printf(",%.2f", lap());
    std::fprintf(stderr, "%zu arcs\n", arcs);
  }
  std::size_t pieces = 0, edges = 0;
  for (const int corner : scene.corners())
    pieces += pieces_from(index.shared(), scene.point(corner));
  std::printf(",%.2f", lap());
  for (const int corner : scene.corners())
    edges += index.view(eye_at(scene.point(corner))).edges.size();
  std::printf(",%.2f\n", lap());
  std::fprintf(stderr, "%zu pieces, %zu edges of maps\n", pieces, edges);
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
  SkeletonRequest request;
  for (int i = 3; i < argc; ++i) {
    if (std::strcmp(argv[i], "ev") == 0) request.eee = false;
    if (std::strcmp(argv[i], "polygon") == 0) request.events = EventMode::Polygon;
  }
  if (what == "streets" && argc > 2) {
    streets(std::atoi(argv[2]), request);
    return 0;
  }
  const bool is_city = std::find(kCities.begin(), kCities.end(), what) != kCities.end();
  if (is_city && argc > 3 && std::strcmp(argv[3], "views") == 0) {
    views(what, std::atoi(argv[2]));
    return 0;
  }
  if (is_city && argc > 2) {
    const Row row = measure(city_of(what, std::atoi(argv[2])), request);
    std::printf("%s,hash\n", kCityHeader);
    print_city(what.c_str(), row);
    std::printf(",%016lx\n", static_cast<unsigned long>(row.hash));
    return 0;
  }
  std::fprintf(stderr,
               "usage: skeleton_scaling law [DENSITY [SCENES_PER_SIZE [LARGEST]]]\n"
               "       skeleton_scaling polytopes|city LARGEST [double]\n"
               "       skeleton_scaling streets LARGEST [ev] [polygon]\n"
               "       skeleton_scaling random|street|square|sunk|square-sunk|floating|"
               "touching POLYGONS views|[ev] [polygon]\n");
  return 2;
}
