#include "tests/shadows/volume_scenes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "linespace/numbers/exact_position.h"
#include "linespace/predicates.h"
#include "shadows/backprojection.h"
#include "tests/support/add_polygons.h"
#include "tests/support/random_geometry.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {
namespace {

using internal::ExactPoint;
using internal::Rational;

// The corners of a convex polygon among points of one plane, counter-clockwise seen from
// where `towards` is in front.
std::vector<Point> polygon_of(const std::vector<Point>& points, const Point& towards) {
  std::vector<Point> loop{*std::ranges::min_element(points, [](auto& a, auto& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  })};
  do {
    const Point at = loop.back();
    std::optional<Point> next;
    for (const Point& p : points) {
      if (p == at) continue;
      if (!next) {
        next = p;
        continue;
      }
      const Sign turn = orient3d(at, *next, p, towards);
      if (turn == Sign::Negative ||
          (turn == Sign::Zero && (p - at).norm() > (*next - at).norm()))
        next = p;
    }
    loop.push_back(*next);
  } while (loop.back() != loop.front() && loop.size() < 100);
  loop.pop_back();
  return loop;
}

// The facets of the hull of points, by brute force; none where all are in one plane.
std::vector<std::vector<Point>> hull_of(const std::vector<Point>& points) {
  std::vector<std::vector<Point>> facets;
  std::set<std::vector<int>> known;
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        if (collinear(points[i], points[j], points[k])) continue;
        std::vector<int> on;
        bool front = false, behind = false;
        for (int l = 0; l < n; ++l) {
          const Sign s = orient3d(points[i], points[j], points[k], points[l]);
          if (s == Sign::Zero) on.push_back(l);
          front |= s == Sign::Positive;
          behind |= s == Sign::Negative;
        }
        if (front || !behind || !known.insert(on).second) continue;
        std::vector<Point> its;
        for (const int l : on) its.push_back(points[l]);
        const Point away = point_off_plane(points[i], points[j], points[k]);
        const bool out =
            orient3d(points[i], points[j], points[k], away) == Sign::Positive;
        std::vector<Point> loop = polygon_of(its, away);
        if (!out) std::ranges::reverse(loop);
        facets.push_back(std::move(loop));
      }
    }
  }
  return facets;
}

class SceneMaker {
 public:
  explicit SceneMaker(std::uint64_t seed) : random_(seed), small_(seed % 2 == 1) {}

  PolygonSoup make() {
    PolygonSoup soup;
    const Point above(0, 0, small_ ? random_.integer(0, 3) : 3);
    add_polygons(soup, "lamp", random_.one_in(3) ? body(above, false) : polygon(above));
    add_polygons(soup, "solid",
                 random_.one_in(4) ? polygon(Point::Zero()) : body(Point::Zero(), true));
    const double far = 9;
    add_polygons(soup, "far",
                 {{{-far, -far, -far}, {-far, -8, -far}, {-far, -far, -8}},
                  {{far, far, far}, {far, 8, far}, {far, far, 8}}});
    return soup;
  }

 private:
  // Few digits, so that means of corners of volumes have few enough for the naive way.
  double number() {
    return small_ ? random_.integer(-2, 2) : random_.integer(-128, 128) / 64.0;
  }
  Point point(const Point& middle) {
    const double x = number(), y = number();
    return middle + Point(x, y, number() / (small_ ? 1 : 2));
  }

  // A polyhedron: a box or a hull of points.
  std::vector<std::vector<Point>> body(const Point& middle, bool many) {
    std::vector<std::vector<Point>> facets;
    while (facets.empty()) {
      std::vector<Point> points;
      if (random_.one_in(2)) {
        const Point a = point(middle), b = point(middle);
        for (int k = 0; k < 8; ++k) {
          points.emplace_back((k & 1) != 0 ? a.x() : b.x(), (k & 2) != 0 ? a.y() : b.y(),
                              (k & 4) != 0 ? a.z() : b.z());
        }
      } else {
        const int count = random_.integer(4, many ? 9 : 6);
        for (int k = 0; k < count; ++k) points.push_back(point(middle));
      }
      facets = hull_of(points);
    }
    return facets;
  }

  // A triangle, or a polygon across an axis; it faces down or anywhere.
  std::vector<std::vector<Point>> polygon(const Point& middle) {
    while (true) {
      const bool triangle = random_.one_in(2);
      const int axis = random_.one_in(2) ? 2 : random_.integer(0, 2);
      std::vector<Point> points;
      for (int k = 0; k < (triangle ? 3 : 5); ++k) {
        points.push_back(point(middle));
        if (!triangle) points.back()[axis] = points.front()[axis];
      }
      bool flat = true;
      for (const Point& p : points) flat &= collinear(points[0], points[1], p);
      if (flat) continue;
      std::size_t third = 2;
      while (collinear(points[0], points[1], points[third])) ++third;
      std::vector<Point> loop =
          polygon_of(points, point_off_plane(points[0], points[1], points[third]));
      const Point below = middle - Point(0, 0, 20);
      if (orient3d(loop[0], loop[1], loop[2], below) == Sign::Negative &&
          !random_.one_in(5))
        std::ranges::reverse(loop);
      return {loop};
    }
  }

  RandomGeometry random_;
  bool small_;
};

// Random points, and means of corners of the volumes and of the solid.
class PointMaker {
 public:
  PointMaker(std::uint64_t seed, const ShadowVolumes& volumes, const Scene& scene)
      : random_(seed), most_(seed % 2 == 1 ? 3 : 1) {
    for (const ShadowVolume* volume : {&volumes.umbra(), &volumes.shadow()}) {
      for (const ShadowVolume::Side& side : volume->sides) {
        sides_.emplace_back();
        for (const int c : side.corners)
          sides_.back().push_back(internal::exact_point(volume->vertices[c]));
      }
    }
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      sides_.emplace_back();
      for (const int p : scene.face_points(static_cast<int>(f)))
        sides_.back().push_back(internal::exact_point(scene.point(p)));
    }
  }

  ExactPoint next() {
    switch (random_.integer(0, 3)) {
      case 0:
        return internal::exact_point(Point(random_.uniform(-9, 9), random_.uniform(-9, 9),
                                           random_.uniform(-9, 9)));
      case 1: {
        const auto number = [&] { return Rational(random_.integer(-12, 12), 2); };
        const Rational x = number(), y = number();
        return {x, y, number()};
      }
      default:
        break;
    }
    // On a side, an edge or a corner; or a hair off.
    const auto& side = sides_[random_.integer(0, static_cast<int>(sides_.size()) - 1)];
    const int n = static_cast<int>(side.size());
    const int first = random_.integer(0, n - 1), count = random_.integer(1, most_);
    ExactPoint sum{0, 0, 0};
    Rational weights = 0;
    for (int k = 0; k < count; ++k) {
      const Rational w = random_.integer(1, 4);
      for (int i = 0; i < 3; ++i) sum[i] += w * side[(first + k) % n][i];
      weights += w;
    }
    for (Rational& x : sum) x /= weights;
    if (random_.one_in(4)) sum[random_.integer(0, 2)] += Rational(0x1p-60);
    return sum;
  }

 private:
  RandomGeometry random_;
  int most_;  // corners that a mean is of: in general scenes it would have many digits
  std::vector<std::vector<ExactPoint>> sides_;
};

}  // namespace

PolygonSoup volume_scene(std::uint64_t seed) { return SceneMaker(seed).make(); }

std::optional<std::string> volume_difference(std::uint64_t seed, int count,
                                             VolumeCounts& counts) {
  const std::vector<std::string> lamp{"lamp"}, far{"far"};
  const Scene whole(volume_scene(seed));
  const Scene scene = scene_without(whole, far);
  ++counts.scenes;
  std::optional<ShadowVolumes> volumes;
  try {
    volumes.emplace(whole, light_source(whole, lamp), whole.faces_named("solid"));
  } catch (const InvalidInput& error) {
    ++counts.refused;
    if (std::string(error.what()).find("cuts the source") != std::string::npos)
      return std::nullopt;
    return "seed " + std::to_string(seed) + ": " + error.what();
  }
  const ShadowScene lit{"", scene.soup(), lamp};
  const NaiveShadow naive = naive_shadow(scene, lit);
  const BackprojectionIndex index(scene, light_source(scene, lamp));
  PointMaker points(seed, *volumes, scene);
  for (int i = 0; i < count; ++i) {
    const ExactPoint p = points.next();
    const ExactPosition at = internal::exact_position(p);
    const int ours = static_cast<int>(volumes->at(at));
    const int seen = static_cast<int>(index.from({at, std::nullopt}).shadow);
    const int right = static_cast<int>(naive.at({p[0], p[1], p[2]}).light);
    ++counts.points;
    ++(right == 0 ? counts.umbra : right == 1 ? counts.penumbra : counts.lit);
    if (ours == right && seen == right) continue;
    std::ostringstream out;
    out << "seed " << seed << " at " << p[0] << ',' << p[1] << ',' << p[2] << ": volumes "
        << ours << ", backprojection " << seen << ", naive " << right;
    return out.str();
  }
  return std::nullopt;
}

}  // namespace sightline::testing
