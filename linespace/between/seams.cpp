#include "linespace/seams.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "linespace/between/seams.h"
#include "linespace/contacts/contact.h"
#include "linespace/predicates.h"
#include "linespace/space/bvh.h"
#include "linespace/work/deadline.h"
#include "linespace/work/stage.h"

namespace sightline {

using namespace internal;

namespace {

// Twice the area times the normal; corners relative to the first, over the largest
// extent, so that no product leaves the range of doubles.
Point normal_of(const Polygon& polygon) {
  double extent = 0;
  for (const Point& p : polygon) {
    extent = std::max(extent, (p - polygon[0]).cwiseAbs().maxCoeff());
  }
  Point normal = Point::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Point u = (polygon[i - 1] - polygon[0]) / extent;
    const Point v = (polygon[i] - polygon[0]) / extent;
    normal += u.cross(v);
  }
  return normal;
}

Polygon without_repeats(const Polygon& polygon) {
  Polygon corners;
  for (const Point& p : polygon) {
    if (corners.empty() || p != corners.back()) corners.push_back(p);
  }
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  return corners;
}

double largest_coordinate(const Polygon& polygon) {
  double largest = 0;
  for (const Point& p : polygon) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

// Where the lines beside two sides, both `by` outside, meet: the sides end at `corner`
// and have these outer normals, at most a right angle apart.
Point mitre(const Point& corner, const Point& u, const Point& v, double by) {
  Point p = corner + (by / (1 + u.dot(v))) * (u + v);
  for (double& x : p) {
    if (std::abs(x) < kSmallestCoordinate) x = 0;  // it was 0 but for a rounding
    x = std::clamp(x, -kLargestCoordinate, kLargestCoordinate);
  }
  return p;
}

// The outer corners at one corner: one, or two where it is cut off.
std::vector<Point> outer_corners(const Point& corner, const Point& before,
                                 const Point& after, const Point& normal, double by) {
  const Point u = before.cross(normal), v = after.cross(normal);
  if (before.dot(after) >= 0) return {mitre(corner, u, v, by)};
  const Point middle = (before - after).normalized();
  return {mitre(corner, u, middle, by), mitre(corner, middle, v, by)};
}

}  // namespace

std::vector<Polygon> flaps(const Polygon& given, double by) {
  const Polygon polygon = without_repeats(given);
  const std::size_t n = polygon.size();
  if (n < 3 || by == 0) return {};
  const Point normal = normal_of(polygon).normalized();
  if (!(normal.norm() > 0.5)) return {};
  by += 0x1p-50 * (largest_coordinate(polygon) + by);
  std::vector<Point> directions(n);
  for (std::size_t i = 0; i < n; ++i) {
    directions[i] = (polygon[(i + 1) % n] - polygon[i]).stableNormalized();
  }
  std::vector<std::vector<Point>> outer(n);
  for (std::size_t i = 0; i < n; ++i) {
    outer[i] =
        outer_corners(polygon[i], directions[(i + n - 1) % n], directions[i], normal, by);
  }
  std::vector<Polygon> result;
  const auto add = [&](const Point& a, const Point& b, const Point& c) {
    if (!collinear(a, b, c)) result.push_back({a, b, c});
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    if (outer[i].size() == 2) add(polygon[i], outer[i][0], outer[i][1]);
    add(polygon[i], outer[i].back(), outer[next].front());
    add(polygon[i], outer[next].front(), polygon[next]);
  }
  return result;
}

namespace internal {

std::vector<int> polygons_met(std::span<const Polygon> polygons,
                              const std::array<ExactPosition, 2>& segment) {
  const Box reach = box_of(std::array{segment[0].nearest, segment[1].nearest});
  PolygonSoup soup;
  std::vector<int> number;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const Box box = box_of(polygons[i]);
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis) {
      // Nearest doubles are half an ulp off.
      const double slack =
          0x1p-52 * std::max(std::abs(reach.min[axis]), std::abs(reach.max[axis]));
      apart |= box.min[axis] > reach.max[axis] + slack ||
               box.max[axis] < reach.min[axis] - slack;
    }
    if (apart) continue;
    std::vector<int>& ring = soup.polygons.emplace_back();
    for (const Point& p : polygons[i]) {
      ring.push_back(static_cast<int>(soup.vertices.size()));
      soup.vertices.push_back(p);
    }
    number.push_back(static_cast<int>(i));
  }
  std::vector<int> met;
  if (number.empty()) return met;
  const Scene scene(std::move(soup));
  std::vector<int> faces(scene.faces().size());
  for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = static_cast<int>(f);
  const auto exact = [](const ExactPosition& p) {
    return ExactPoint{Rational(p.exact[0]), Rational(p.exact[1]), Rational(p.exact[2])};
  };
  const LineScan scan(scene, faces, exact(segment[0]), exact(segment[1]));
  for (int contact = 0; contact < scan.size(); ++contact) {
    if (scan.to(contact) < 0 || scan.from(contact) > 1) continue;
    for (const Touch& touch : scan.touches(contact)) {
      met.push_back(number[scene.faces()[touch.face].source]);
    }
  }
  std::ranges::sort(met);
  met.erase(std::unique(met.begin(), met.end()), met.end());
  return met;
}

void check_seam(double seam) {
  if (!(seam >= 0 && seam <= std::numeric_limits<double>::max())) {
    throw InvalidInput("the seam is not a finite number from 0 on");
  }
}

}  // namespace internal

SeamAnswer polygon_visibility(const VisibilityQuestion& question, double seam,
                              const VisibilityRequest& request) {
  check_seam(seam);
  const internal::Deadline deadline(request);
  SeamAnswer result;
  result.grown = question;
  std::vector<int> owner(question.occluders.size());
  for (std::size_t i = 0; i < owner.size(); ++i) owner[i] = static_cast<int>(i);
  for (std::size_t i = 0; i < question.occluders.size(); ++i) {
    for (Polygon& flap : flaps(question.occluders[i], seam / 2)) {
      result.grown.occluders.push_back(std::move(flap));
      owner.push_back(static_cast<int>(i));
    }
  }
  const auto to_owners = [&](std::vector<int>& occluders) {
    for (int& occluder : occluders) occluder = owner[occluder];
    std::ranges::sort(occluders);
    occluders.erase(std::unique(occluders.begin(), occluders.end()), occluders.end());
  };
  result.answer = polygon_visibility(result.grown, request);
  to_owners(result.answer.occluders);
  if (seam == 0 || result.answer.verdict != Verdict::Hidden) return result;
  VisibilityRequest rest = request;
  rest.budget_seconds = deadline.what_is_left(request).budget_seconds;
  const VisibilityAnswer open = polygon_visibility(question, rest);
  result.answer.cost += open.cost;
  result.closed_unknown = open.verdict == Verdict::Undecided;
  if (open.verdict == Verdict::Visible) {
    ClosedSeam& closed = result.closed.emplace(ClosedSeam{*open.witness, {}});
    closed.occluders = polygons_met(result.grown.occluders, closed.segment);
    to_owners(closed.occluders);
  }
  return result;
}

ClosedPairs closed_pairs(const Scene& scene, const FaceVisibility& grown,
                         std::span<const int> as, std::span<const int> bs,
                         const GroupAnswer& group, bool all_pairs,
                         const VisibilityRequest& request) {
  ClosedPairs result;
  if (!all_pairs && group.verdict != Verdict::Hidden) return result;
  GroupAnswer open;
  try {
    open = FaceVisibility(scene, request).between(as, bs, all_pairs, request);
  } catch (const Stopped&) {
    open.pairs_undecided = 1;
  }
  result.complete = open.pairs_undecided == 0;
  const auto add = [&](const FacePairAnswer& pair) {
    if (pair.answer.verdict != Verdict::Visible) return;
    const auto& segment = *pair.answer.witness;
    result.pairs.push_back(
        {pair.a, pair.b, {segment, grown.met(pair.a, pair.b, segment)}});
  };
  if (!all_pairs) {
    if (open.visible) add(*open.visible);
    return result;
  }
  for (std::size_t i = 0; i < open.pairs.size(); ++i) {
    if (group.pairs[i].answer.verdict == Verdict::Hidden) add(open.pairs[i]);
  }
  return result;
}

}  // namespace sightline
