#include "linespace/view/view_measures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/multiprecision/gmp.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include "linespace/picture/classes.h"

namespace sightline::internal {
namespace {

using LongEigen = Eigen::Matrix<long double, 3, 1>;

LongEigen eigen(const LongVector& v) { return {v[0], v[1], v[2]}; }

// What a sum of long doubles may be off, relatively, before an area is summed up in
// rational numbers: a hundredth of the 1e-12 that are promised.
constexpr long double kAreaError = 1e-14L;
// Steradians: each edge adds an error of some 2^-60, so that the sum over a million edges
// has a certain sign if it is larger.
constexpr long double kCertainSign = 1e-12L;

// Enough digits for eyes as near a face as doubles and fractions of doubles come.
using LongFloat = boost::multiprecision::number<boost::multiprecision::gmp_float<80>>;

// A sum over the edges of a boundary, each with a point of reference: that of the first
// edge, if none is given.
struct Sum {
  std::optional<int> reference;  // a point of the graph
  long double value = 0, error = 0;
  LongEigen gradient = LongEigen::Zero();
  std::vector<int> half_edges;  // of the boundary
};

// Of three points nearly on one great circle around the eye, the angle 2 atan2(det, rest)
// is not known well from long doubles.  Where two are nearly opposite both numbers
// vanish; and where the three go round the eye, as those of a face do that the eye is
// very near to, `rest` is negative, and the sign of `det`, which is off by some 2^-60,
// tells one half of all directions from the other.
bool is_doubtful(long double det, long double rest) {
  return std::max(std::abs(det), std::abs(rest)) < 0x1p-12L ||
         (rest < 0 && std::abs(det) < 0x1p-50L);
}

class Measurer {
 public:
  Measurer(const EyeSpace& eye, const ViewGraph& graph) : eye_(&eye), graph_(&graph) {
    for (const PicturePoint& p : graph.points) points_.push_back(accurate(p));
  }

  void add(Sum& sum, int half_edge) const {
    const int from = graph_->origin(half_edge), to = graph_->origin(half_edge ^ 1);
    if (!sum.reference) sum.reference = from;
    sum.half_edges.push_back(half_edge);
    const LongEigen &r = points_[*sum.reference], &u = points_[from], &v = points_[to];
    const LongEigen du = u - r, dv = v - r;
    const long double det = r.dot(du.cross(dv));
    if (eye_->is_direction()) {  // twice the area of a triangle
      sum.value += det / 2;
      sum.error += 0x1p-60L * (du.norm() + dv.norm()) * (1 + r.norm());
      return;
    }
    // Its solid angle (van Oosterom and Strackee, 1983).
    const long double rest = 1 + r.dot(u) + u.dot(v) + v.dot(r);
    sum.value += is_doubtful(det, rest)
                     ? accurate_angle(graph_->points[*sum.reference].exact(), from, to)
                     : 2 * std::atan2(det, rest);
  }

  // Round the eye, seen from a point: a boundary that no half-sphere holds has another
  // reference.
  [[nodiscard]] bool within_half_sphere(std::span<const int> half_edges) const {
    const LongEigen& r = points_[graph_->origin(half_edges.front())];
    return std::ranges::all_of(
        half_edges, [&](int h) { return r.dot(points_[graph_->origin(h)]) > 0x1p-3L; });
  }
  /// Boundaries round the eye: any point of the sphere will do that is not on them.
  [[nodiscard]] long double angle_around(std::span<const int> half_edges) const {
    const LongEigen r(0.36L, -0.48L, 0.8L);
    const ExactPoint exact_r{Rational(0.36), Rational(-0.48), Rational(0.8)};
    long double sum = 0;
    for (const int h : half_edges) {
      const int from = graph_->origin(h), to = graph_->origin(h ^ 1);
      const LongEigen &u = points_[from], &v = points_[to];
      const long double det = r.dot(u.cross(v));
      const long double rest = 1 + r.dot(u) + u.dot(v) + v.dot(r);
      sum += is_doubtful(det, rest) ? accurate_angle(exact_r, from, to)
                                    : 2 * std::atan2(det, rest);
    }
    return sum;
  }

  /// Of a boundary so small that the sign of its sum is in doubt.
  [[nodiscard]] long double accurate_sum(std::span<const int> half_edges) const {
    const ExactPoint& r = graph_->points[graph_->origin(half_edges.front())].exact();
    long double sum = 0;
    for (const int h : half_edges)
      sum += accurate_angle(r, graph_->origin(h), graph_->origin(h ^ 1));
    return sum;
  }

  // Of the solid angle on the left of a half-edge, with the eye.  The arc has the normal
  // N in the picture of true directions u = (P - E) / |P - E|.  A step s of the eye moves
  // the direction of a fixed point at distance r by -s / r across the arc; so the area
  // changes by the integral of -(s . N) / r over the arc, where 1 / r is linear in u.
  [[nodiscard]] LongEigen gradient(int half_edge) const {
    const auto [a, b] = eye_->scene().lines()[graph_->edges[half_edge / 2].line].ends;
    const LongEigen p = -eigen(eye_->vector(a)), q = -eigen(eye_->vector(b));
    const LongEigen from = -points_[graph_->origin(half_edge)];
    const LongEigen to = -points_[graph_->origin(half_edge ^ 1)];
    LongEigen normal = p.cross(q).normalized();
    if (half_edge % 2 == 1) normal = -normal;
    // The point of the line nearest to the eye.
    const LongEigen along = q - p;
    const LongEigen foot = p - along * (p.dot(along) / along.squaredNorm());
    const LongEigen swept = LongEigen(to - from).cross(normal);
    return -normal * (foot.dot(swept) / foot.squaredNorm());
  }

  // Areas of a direction's picture: where much cancels, in rational numbers.
  [[nodiscard]] double value(const Sum& sum) const {
    if (!eye_->is_direction()) return static_cast<double>(sum.value);
    long double area = sum.value;
    if (!(sum.error < kAreaError * std::abs(area))) area = exact_area(sum);
    return static_cast<double>(area * eye_->area_factor());
  }

 private:
  // Vectors to all digits of a long double.
  [[nodiscard]] LongEigen accurate(const PicturePoint& p) const {
    if (p.error() <= 0x1p-58L) return eigen(p.vector());
    const ExactPoint& v = p.exact();
    const LongEigen w(long_double(v[0]), long_double(v[1]), long_double(v[2]));
    return eye_->is_direction() ? LongEigen(w / w[2]) : LongEigen(w / w.norm());
  }

  [[nodiscard]] long double exact_area(const Sum& sum) const {
    Rational twice;
    for (const int h : sum.half_edges) {
      const ExactPoint& u = graph_->points[graph_->origin(h)].exact();
      const ExactPoint& v = graph_->points[graph_->origin(h ^ 1)].exact();
      twice += (u[0] * v[1] - u[1] * v[0]) / (u[2] * v[2]);
    }
    return long_double(twice) / 2;
  }

  // 2 atan2 of both, over vectors a, b, c of any length: det(a, b, c) and
  // |a| |b| |c| + (a . b) |c| + (b . c) |a| + (c . a) |b|.
  [[nodiscard]] long double accurate_angle(const ExactPoint& r, int from, int to) const {
    const std::array<const ExactPoint*, 3> points{&r, &graph_->points[from].exact(),
                                                  &graph_->points[to].exact()};
    std::array<std::array<LongFloat, 3>, 3> v;
    std::array<LongFloat, 3> length;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) v[i][j] = LongFloat((*points[i])[j]);
      length[i] = sqrt(dot(v[i], v[i]));
    }
    const LongFloat det = dot(v[0], cross(v[1], v[2]));
    LongFloat rest = length[0] * length[1] * length[2];
    for (int i = 0; i < 3; ++i) {
      rest += dot(v[i], v[(i + 1) % 3]) * length[(i + 2) % 3];
    }
    const LongFloat size = abs(det) + abs(rest);
    if (size == 0) return 0;
    return 2 * std::atan2(LongFloat(det / size).convert_to<long double>(),
                          LongFloat(rest / size).convert_to<long double>());
  }

  const EyeSpace* eye_;
  const ViewGraph* graph_;
  std::vector<LongEigen> points_;
};

// Connected parts of what is seen of each facet: regions that share an edge beside which
// the facet goes on.
std::map<int, int> count_pieces(const ViewGraph& graph) {
  std::vector<std::pair<int, int>> parts;  // facet side, region
  for (int r = 0; r < static_cast<int>(graph.regions.size()); ++r) {
    for (const int side : graph.regions[r]) {
      if (side != kNoSight) parts.emplace_back(side, r);
    }
  }
  std::ranges::sort(parts);
  const auto number = [&](int side, int region) {
    return static_cast<int>(std::ranges::lower_bound(parts, std::pair(side, region)) -
                            parts.begin());
  };
  Classes classes(parts.size());
  std::map<int, int> pieces;
  for (const auto& [side, region] : parts) ++pieces[side];
  for (int e = 0; e < static_cast<int>(graph.edges.size()); ++e) {
    const int left = graph.left(e), right = graph.right(e);
    if (left == right) continue;
    for (const int side : graph.regions[left]) {
      if (side == kNoSight || !std::ranges::binary_search(graph.regions[right], side))
        continue;
      if (classes.join(number(side, left), number(side, right))) --pieces[side];
    }
  }
  return pieces;
}

}  // namespace

ViewMeasures measure(const EyeSpace& eye, const ViewGraph& graph,
                     const std::vector<int>& region_of,
                     const std::vector<bool>& background) {
  const Measurer measurer(eye, graph);
  std::map<int, Sum> facets;
  std::vector<Sum> regions(background.size());
  for (int h = 0; h < static_cast<int>(graph.region.size()); ++h) {
    const int here = graph.region[h], there = graph.region[h ^ 1];
    if (region_of[here] < 0) continue;
    if (region_of[here] != region_of[there]) measurer.add(regions[region_of[here]], h);
    for (const int side : graph.regions[here]) {
      if (std::ranges::binary_search(graph.regions[there], side)) continue;
      Sum& sum = facets[side];
      measurer.add(sum, h);
      if (!eye.is_direction()) sum.gradient += measurer.gradient(h);
    }
  }
  ViewMeasures measures;
  const auto pieces = count_pieces(graph);
  for (const auto& [side, sum] : facets) {
    measures.facets.push_back(
        {side, pieces.at(side), measurer.value(sum), sum.gradient.cast<double>()});
  }
  double of_facets = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    measures.regions.emplace_back(std::nullopt);
    const double value = measurer.value(regions[r]);
    // What reaches round the picture of a direction has a boundary that runs clockwise.
    if (background[r] && (!eye.is_direction() || value <= 0)) continue;
    measures.regions[r] = value;
    of_facets += value;
  }
  if (eye.is_direction()) return measures;
  // Sums tell solid angles up to whole spheres.
  constexpr double kSphere = 4 * std::numbers::pi;
  const bool only_one = std::ranges::count(background, true) == 1 &&
                        std::ranges::none_of(region_of, [](int r) { return r < 0; });
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (!background[r]) continue;
    if (only_one) {
      measures.regions[r] = kSphere - of_facets;
      continue;
    }
    // The boundary of what lies around all else runs clockwise, seen from near it.
    const auto& edges = regions[r].half_edges;
    const bool small = edges.empty() || measurer.within_half_sphere(edges);
    long double value = small ? regions[r].value : measurer.angle_around(edges);
    // A hole of a sheet seen nearly edge-on is narrow, and may be wide.
    const long double off_whole =
        std::abs(std::remainder(value, static_cast<long double>(kSphere)));
    if (!edges.empty() && off_whole < kCertainSign) value = measurer.accurate_sum(edges);
    measures.regions[r] = static_cast<double>(value > 0 ? value : value + kSphere);
  }
  return measures;
}

}  // namespace sightline::internal
