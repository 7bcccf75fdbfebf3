// How long the exact view of a city takes, beside Embree's id buffer, as CSV on standard
// output: a line for each city and kind of eye, medians over the eyes.  One thread; the
// index is built before.
//
//   street: 1.75 above the streets.  The id buffer's rays go to all sides.
//   above:  from above and outside.  The id buffer's rays fill the cone round the city.
//
// Columns: city, eyes, polygons, facets seen, edges of the map, milliseconds of the exact
// view and of the one in doubles, share of views in which doubles see other facets or
// count other edges, milliseconds of the id buffer and the share of the seen facets that
// it misses.  The last lines have the exponents of time against map edges.
//
// usage: view_speed [EYES [LARGEST]]

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <set>
#include <vector>

#include "linespace/point_view.h"
#include "tests/support/embree_rays.h"
#include "tests/support/generators.h"

namespace {

using namespace sightline;           // NOLINT(google-build-using-namespace)
using namespace sightline::testing;  // NOLINT(google-build-using-namespace)

double milliseconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

double median(std::vector<double> x) {
  std::ranges::sort(x);
  return x[x.size() / 2];
}

std::vector<Point> eyes_of(const Scene& scene, bool street, int count) {
  Random random(3);
  const auto& [low, high] = scene.bounds();
  const double width = high[0] - low[0];
  std::vector<Point> eyes;
  for (int i = 0; i < count; ++i) {
    if (street) {
      // Lots are 10 wide, and their last unit is free of boxes.
      const int lots = static_cast<int>(width / 10);
      Point p(10 * random.integer(1, lots - 2) - random.uniform(0.1, 0.9),
              random.uniform(low[1] + 12, high[1] - 12), 1.75);
      if (random.one_in(2)) std::swap(p[0], p[1]);
      eyes.push_back(p);
    } else {
      eyes.emplace_back(low[0] - random.uniform(0.2, 0.5) * width,
                        low[1] - random.uniform(0.2, 0.5) * width,
                        random.uniform(0.3, 0.7) * width);
    }
  }
  return eyes;
}

// The facets that 2^18 rays meet first.
class IdBuffer {
 public:
  explicit IdBuffer(const Scene& scene) : scene_(&scene), embree_(scene) {
    for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
      for (int k = 2; k < scene.faces()[f].corner_count; ++k)
        facets_.push_back(scene.faces()[f].facet);
    }
  }

  [[nodiscard]] std::set<int> seen(const Point& eye, bool all_around) const {
    constexpr int kSide = 512;
    const auto& [low, high] = scene_->bounds();
    const Point middle = 0.5 * (low + high);
    const Eigen::Vector3d ahead = (middle - eye).normalized();
    const Eigen::Vector3d right = ahead.cross(Point(0, 0, 1)).normalized();
    const Eigen::Vector3d up = right.cross(ahead);
    const double half = 0.5 * (high - low).norm() / (middle - eye).norm();
    std::vector<int> ids;
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const double x = 2 * (column + 0.5) / kSide - 1, y = 2 * (row + 0.5) / kSide - 1;
        Eigen::Vector3d way = ahead + half * (x * right + y * up);
        if (all_around) {  // equal areas of the sphere
          const double r = std::sqrt(1 - y * y);
          way = {r * std::cos(std::numbers::pi * x), r * std::sin(std::numbers::pi * x),
                 y};
        }
        RTCRayHit hit{};
        hit.ray = embree_ray(eye, eye + way, 0, 1e30F);
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(embree_.scene(), &context, &hit);
        if (hit.hit.geomID != RTC_INVALID_GEOMETRY_ID)
          ids.push_back(facets_[hit.hit.primID]);
      }
    }
    return {ids.begin(), ids.end()};
  }

 private:
  const Scene* scene_;
  EmbreeTriangles embree_;
  std::vector<int> facets_;  // of triangles
};

struct Row {
  double edges, time;
};

Row measure(const char* city, const Scene& scene, const PointViewIndex& index,
            const IdBuffer& buffer, bool street, int eyes) {
  std::vector<double> exact, doubles, rays, edges, facets, missed;
  int wrong = 0;
  Request in_doubles;
  in_doubles.precision = Precision::Double;
  for (const Point& p : eyes_of(scene, street, eyes)) {
    double start = milliseconds();
    const PointView view = index.view(eye_at(p));
    exact.push_back(milliseconds() - start);
    start = milliseconds();
    const PointView rough = index.view(eye_at(p), in_doubles);
    doubles.push_back(milliseconds() - start);
    wrong += rough.facets.size() != view.facets.size() ||
             rough.edges.size() != view.edges.size();
    start = milliseconds();
    const std::set<int> met = buffer.seen(p, street);
    rays.push_back(milliseconds() - start);
    const auto unseen = std::ranges::count_if(
        view.facets, [&](const SeenFacet& f) { return !met.contains(f.facet); });
    missed.push_back(static_cast<double>(unseen) /
                     static_cast<double>(view.facets.size()));
    edges.push_back(static_cast<double>(view.edges.size()));
    facets.push_back(static_cast<double>(view.facets.size()));
  }
  std::printf("%s,%s,%zu,%.0f,%.0f,%.2f,%.2f,%.3f,%.1f,%.3f\n", city,
              street ? "street" : "above", scene.faces().size(), median(facets),
              median(edges), median(exact), median(doubles),
              static_cast<double>(wrong) / eyes, median(rays), median(missed));
  std::fflush(stdout);
  return {median(edges), median(exact)};
}

}  // namespace

int main(int argc, char** argv) {
  const int eyes = argc > 1 ? std::atoi(argv[1]) : 20;
  const int largest = argc > 2 ? std::atoi(argv[2]) : 10000;
  std::printf(
      "city,eyes,polygons,facets,edges,exact_ms,double_ms,double_wrong,id_buffer_ms,"
      "id_buffer_missed\n");
  for (const bool square : {false, true}) {
    const char* const name = square ? "square" : "street";
    std::vector<Row> rows[2];
    for (const int n : {996, 9996, 99996}) {
      if (n > largest) break;
      StreetCityOptions options;
      options.square = square;
      const Scene scene(street_city(1, n, options));
      const PointViewIndex index(scene);
      const IdBuffer buffer(scene);
      for (const bool street : {true, false})
        rows[street ? 0 : 1].push_back(measure(name, scene, index, buffer, street, eyes));
    }
    for (const bool street : {true, false}) {
      const auto& r = rows[street ? 0 : 1];
      if (r.size() < 2) continue;
      std::printf("# %s, %s: time grows as the power %.2f of the map's edges\n", name,
                  street ? "street" : "above",
                  std::log(r.back().time / r.front().time) /
                      std::log(r.back().edges / r.front().edges));
    }
  }
}
