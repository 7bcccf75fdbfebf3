#include "linespace/line_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "linespace/predicates.h"

namespace sightline {

std::array<std::uint64_t, 4> philox(std::array<std::uint64_t, 4> counter,
                                    std::array<std::uint64_t, 2> key) {
  __extension__ using Wide = unsigned __int128;
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const Wide x = Wide{0xD2E7470EE14C6C93} * counter[0];
    const Wide y = Wide{0xCA5A826395121157} * counter[2];
    const auto high = [](Wide w) { return static_cast<std::uint64_t>(w >> 64); };
    counter = {high(y) ^ counter[1] ^ key[0], static_cast<std::uint64_t>(y),
               high(x) ^ counter[3] ^ key[1], static_cast<std::uint64_t>(x)};
    key[0] += 0x9E3779B97F4A7C15;  // the golden ratio
    key[1] += 0xBB67AE8584CAA73B;  // sqrt(3) - 1
  }
  return counter;
}

void SampleNumbers::refill() {
  block_ = philox({next_block_++, sample_, 0, 0}, {seed_, 0});
  used_ = 0;
}

namespace {

struct DiskPoint {
  double x, y, squared_radius;
};

// Uniform in the unit disk, its centre excepted.
DiskPoint random_disk_point(SampleNumbers& numbers) {
  for (;;) {
    const double x = 2 * numbers.uniform() - 1;
    const double y = 2 * numbers.uniform() - 1;
    const double s = x * x + y * y;
    if (s < 1 && s > 0) return {x, y, s};
  }
}

// Density proportional to the cosine to the unit vector n, on n's side: a uniform point
// of the unit sphere that touches the plane from n's side, seen from the point of
// contact.
Point cosine_direction(const Point& n, SampleNumbers& numbers) {
  for (;;) {
    const Point d = n + random_direction(numbers);
    const double squared = d.squaredNorm();
    // Closer to the point of contact, rounding spoils the direction; this leaves out a
    // share of 2^-41 of all directions, those within 2^-20 of the plane.
    if (squared > 0x1p-40) return d / std::sqrt(squared);
  }
}

// Area times the unit normal of a planar polygon.
Point vector_area(std::span<const Point> corners) {
  Point sum = Point::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  }
  return sum / 2;
}

std::vector<std::vector<Point>> box_faces(const Point& low, const Point& high) {
  constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  std::vector<std::vector<Point>> faces;
  for (const auto& side : kSides) {
    auto& face = faces.emplace_back();
    for (const int i : side) {
      face.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                        (i & 4 ? high : low).z());
    }
  }
  return faces;
}

}  // namespace

Point random_direction(SampleNumbers& numbers) {
  const DiskPoint p = random_disk_point(numbers);
  const double scale = 2 * std::sqrt(1 - p.squared_radius);
  return {p.x * scale, p.y * scale, 1 - 2 * p.squared_radius};
}

Chord line_by_two_points(const Ball& ball, SampleNumbers& numbers) {
  const Point from = ball.centre + ball.radius * random_direction(numbers);
  return {from, ball.centre + ball.radius * random_direction(numbers)};
}

Chord line_by_direction(const Ball& ball, SampleNumbers& numbers) {
  const Point along = random_direction(numbers);
  const Point across = along.unitOrthogonal();
  const DiskPoint p = random_disk_point(numbers);
  const Point middle =
      ball.centre + ball.radius * (p.x * across + p.y * along.cross(across));
  const Point half = ball.radius * std::sqrt(1 - p.squared_radius) * along;
  return {middle - half, middle + half};
}

PolygonSampler::PolygonSampler(std::span<const std::vector<Point>> polygons) {
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    add(static_cast<int>(i), polygons[i]);
  }
  check_area();
}

PolygonSampler::PolygonSampler(const Scene& scene, std::span<const int> faces) {
  std::vector<Point> corners;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    corners.clear();
    for (const int p : scene.face_points(faces[i])) corners.push_back(scene.point(p));
    add(static_cast<int>(i), corners);
  }
  check_area();
}

void PolygonSampler::add(int polygon, std::span<const Point> corners) {
  const Point normal = vector_area(corners).normalized();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Point to_b = corners[i] - corners[0], to_c = corners[i + 1] - corners[0];
    const double area = to_b.cross(to_c).norm() / 2;
    const double start = ends_.empty() ? 0 : ends_.back();
    if (start + area == start) continue;  // no share of the numbers
    triangles_.push_back({corners[0], to_b, to_c, normal, polygon});
    ends_.push_back(start + area);
  }
}

void PolygonSampler::check_area() const {
  if (ends_.empty()) throw InvalidInput("polygons to sample: no area");
  if (!std::isfinite(ends_.back())) {
    throw InvalidInput("polygons to sample: the area is not finite");
  }
}

PolygonSampler::Sample PolygonSampler::point(SampleNumbers& numbers) const {
  const double at = numbers.uniform() * ends_.back();
  // The product may round up to the whole area.
  const auto end = std::upper_bound(ends_.begin(), ends_.end() - 1, at);
  const auto i = static_cast<std::size_t>(end - ends_.begin());
  const Triangle& t = triangles_[i];
  // Where in its share of the areas the number fell is uniform again.
  const double start = i > 0 ? ends_[i - 1] : 0;
  double u = std::min(1.0, (at - start) / (ends_[i] - start)), v = numbers.uniform();
  if (u + v > 1) {  // the other half of the parallelogram
    u = 1 - u;
    v = 1 - v;
  }
  Point p = t.a + (u * t.to_b + v * t.to_c);
  for (double& x : p) {
    if (!is_admissible(x)) x = 0;
  }
  return {p, t.polygon, t.normal};
}

ConvexBodyLines::ConvexBodyLines(std::vector<std::vector<Point>> faces)
    : boundary_(faces) {
  for (const auto& face : faces) {
    const Point area = vector_area(face);
    if (area.isZero(0)) continue;
    corners_.push_back(face[0]);
    normals_.push_back(area.normalized());
  }
}

ConvexBodyLines::ConvexBodyLines(const Point& low, const Point& high)
    : ConvexBodyLines(box_faces(low, high)) {}

Chord ConvexBodyLines::line(SampleNumbers& numbers) const {
  const PolygonSampler::Sample entry = boundary_.point(numbers);
  const Point along = cosine_direction(-entry.normal, numbers);
  double exit = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const double slope = normals_[i].dot(along);
    if (slope <= 0) continue;
    exit = std::min(exit, normals_[i].dot(corners_[i] - entry.point) / slope);
  }
  // Next to an edge the exit can come out an ulp before the entry.
  return {entry.point, entry.point + std::max(exit, 0.0) * along};
}

PairSegment segment_between(const PolygonSampler& a, const PolygonSampler& b,
                            SampleNumbers& numbers) {
  PairSegment out{a.point(numbers), b.point(numbers), 0};
  const Point r = out.b.point - out.a.point;
  const double squared = r.squaredNorm();
  if (squared > 0) {
    // Divided twice, since the fourth power of a length may overflow.
    out.measure = std::abs(out.a.normal.dot(r)) / squared *
                  (std::abs(out.b.normal.dot(r)) / squared) * a.area() * b.area();
  }
  return out;
}

std::optional<Chord> line_through(const PolygonSampler& a, std::span<const Point> b,
                                  SampleNumbers& numbers, int most_tries) {
  const Point area = vector_area(b);
  for (int tries = 0; tries < most_tries; ++tries) {
    const PolygonSampler::Sample from = a.point(numbers);
    const double side = numbers.bits() & 1 ? 1 : -1;
    const Point along = cosine_direction(side * from.normal, numbers);
    const double slope = area.dot(along);
    const double t = area.dot(b[0] - from.point) / slope;
    if (!(t > 0 && std::isfinite(t))) continue;  // in b's plane, too
    // Left of every side as b's front sees it, or right of every side.
    bool left = true, right = true;
    for (std::size_t i = 0; i < b.size(); ++i) {
      const Point& p = b[i];
      const Point& q = b[(i + 1) % b.size()];
      const double s = (p - from.point).cross(q - from.point).dot(along);
      left = left && s >= 0;
      right = right && s <= 0;
    }
    if (left || right) return Chord{from.point, from.point + t * along};
  }
  return std::nullopt;
}

}  // namespace sightline
