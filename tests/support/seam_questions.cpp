#include "tests/support/seam_questions.h"

#include <Eigen/Geometry>
#include <cmath>

#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

// Turning a number of size 1 to 3 rounds it by less than this, in all its steps.
constexpr double kRounded = 0x1p-46;

using Map = Eigen::Matrix3d;

// Rows are unit vectors, orthogonal up to rounding.
Map rotation(Random& random) {
  const Point u = random.direction();
  const Point v = random.direction();
  const Point w = u.cross(v).normalized();
  Map map;
  map << u.transpose(), w.cross(u).transpose(), w.transpose();
  return map;
}

double power_of_two(Random& random, int low, int high) {
  return std::ldexp(random.uniform(1, 2), random.integer(low, high - 1));
}

// A rectangle of the wall, in the plane x = 1, as two triangles.
void add_piece(std::vector<std::vector<Point>>& triangles, double from, double to) {
  const Point a(1, from, -2), b(1, to, -2), c(1, to, 2), d(1, from, 2);
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

std::vector<Point> triangle_at(Random& random, double x) {
  std::vector<Point> corners;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.1 * i + random.uniform(0, 1.5);
    corners.emplace_back(x + random.uniform(-0.2, 0.2), std::cos(angle), std::sin(angle));
  }
  return corners;
}

}  // namespace

SeamQuestion seam_question(std::uint64_t seed) {
  Random random(seed);
  SeamQuestion q;
  q.kind = static_cast<SeamKind>(seed % 4);
  const double end = random.uniform(-0.2, 0.2);
  double begin = end;
  if (q.kind == SeamKind::Overlap) begin -= power_of_two(random, -54, -20);
  if (q.kind == SeamKind::OneUlp) begin = std::nextafter(end, 1.0);
  if (q.kind == SeamKind::Gap) begin += power_of_two(random, -54, -20);
  q.width = begin - end;
  q.instance.a = triangle_at(random, 0);
  q.instance.b = triangle_at(random, 2);
  add_piece(q.instance.occluders, -3, end);
  add_piece(q.instance.occluders, begin, 3);
  const bool turned = seed / 4 % 4 != 0;
  const Map map = turned ? rotation(random) : Map::Identity();
  q.exponent = random.integer(-80, 80);
  const auto move = [&](std::vector<Point>& polygon) {
    for (Point& p : polygon) p = std::ldexp(1.0, q.exponent) * Point(map * p);
  };
  move(q.instance.a);
  move(q.instance.b);
  for (auto& piece : q.instance.occluders) move(piece);
  const double least = turned ? kRounded : 0;
  if (q.width > least) q.visible = true;
  if (q.width < -least || q.width == 0) q.visible = false;
  return q;
}

}  // namespace sightline::testing
