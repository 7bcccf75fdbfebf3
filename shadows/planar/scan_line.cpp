#include "shadows/planar/scan_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shadows/planar/arcs/arc_box.h"
#include "shadows/planar/arcs/ball_roots.h"

namespace sightline::internal {
namespace {

// In which order the half-edges 2e and 2e + 1 stand: F of the scan line is positive to
// the left of its direction, so that a half-edge that comes from its negative side has
// its own left side before the crossing.
int half_edge(int edge, bool from_negative) { return 2 * edge + (from_negative ? 0 : 1); }

// The coordinate of a vertex that a scan line compares, enclosed, as the sign of F.
std::optional<Sign> side_of_vertex(const PlanarVertex& v, bool horizontal, double at) {
  const double x = horizontal ? v.at.y() : v.at.x();
  // x - at rounds by less than this.
  const double error = v.error + 4 * kUnit * (std::abs(x) + std::abs(at));
  if (!(std::abs(x - at) > error)) return std::nullopt;
  return (x > at) == horizontal ? Sign::Positive : Sign::Negative;
}

}  // namespace

PlaneSupport ScanLine::support() const {
  const Integer n = numerator(at), m = denominator(at);
  return line_support(horizontal ? std::array<Integer, 3>{0, m, -n}
                                 : std::array<Integer, 3>{m, 0, -n});
}

ScanIndex::ScanIndex(const PlanarData& map) {
  std::vector<DoubleRange> x, y;
  constexpr double kFar = std::numeric_limits<double>::max();
  for (int e = 0; e < static_cast<int>(map.edges.size()); ++e) {
    const PlaneSupport& support = map.support_of_edge(e);
    std::optional<PointRange> box;
    if (support.straight) {
      const PlanarVertex& p = map.vertices[map.edges[e].ends[0]];
      const PlanarVertex& q = map.vertices[map.edges[e].ends[1]];
      const double error = 2 * std::max(p.error, q.error);
      box = {
          {std::min(p.at.x(), q.at.x()) - error, std::max(p.at.x(), q.at.x()) + error},
          {std::min(p.at.y(), q.at.y()) - error, std::max(p.at.y(), q.at.y()) + error}};
    } else {
      box = box_of(support, {map.position(e, 0).range.lo, map.position(e, 1).range.hi});
    }
    x.push_back(box ? box->x : DoubleRange{-kFar, kFar});
    y.push_back(box ? box->y : DoubleRange{-kFar, kFar});
  }
  by_x_ = rows(std::move(x));
  by_y_ = rows(std::move(y));
}

ScanIndex::Rows ScanIndex::rows(std::vector<DoubleRange> ranges) {
  Rows out;
  // The middles of edges; what lies further out is counted to the first or last row.
  double from = std::numeric_limits<double>::max(), to = -from;
  for (const DoubleRange& r : ranges) {
    from = std::min(from, r.middle());
    to = std::max(to, r.middle());
  }
  const double count = std::ceil(std::sqrt(static_cast<double>(ranges.size())));
  out.from = from;
  out.width = to > from ? (to - from) / count : 1;
  out.edges.resize(static_cast<std::size_t>(count) + 1);
  for (int e = 0; e < static_cast<int>(ranges.size()); ++e) {
    const int last = out.row(ranges[e].hi);
    for (int i = out.row(ranges[e].lo); i <= last; ++i) out.edges[i].push_back(e);
  }
  out.ranges = std::move(ranges);
  return out;
}

int ScanIndex::Rows::row(double x) const {
  const double last = static_cast<double>(edges.size()) - 1;
  return static_cast<int>(std::clamp((x - from) / width, 0.0, last));
}

std::vector<int> ScanIndex::edges_at(bool horizontal, double at) const {
  const Rows& rows = horizontal ? by_y_ : by_x_;
  std::vector<int> out;
  for (const int e : rows.edges[rows.row(at)]) {
    if (rows.ranges[e].lo <= at && at <= rows.ranges[e].hi) out.push_back(e);
  }
  return out;
}

std::optional<std::vector<ScanHit>> hits_by_doubles(const PlanarData& map,
                                                    std::span<const int> edges,
                                                    bool horizontal, double at) {
  std::vector<ScanHit> hits;
  std::optional<PlaneSupport> line;
  for (const int e : edges) {
    const PlanarEdge& edge = map.edges[e];
    const auto from = side_of_vertex(map.vertices[edge.ends[0]], horizontal, at);
    const auto to = side_of_vertex(map.vertices[edge.ends[1]], horizontal, at);
    if (!from || !to) return std::nullopt;
    const PlaneSupport& support = map.support_of_edge(e);
    if (support.straight && *from == *to) continue;
    if (!line) line = ScanLine{horizontal, Rational(at)}.support();
    if (support.straight) {
      const auto s = substitute<BallNumber>(*line, support);
      const std::optional<DoubleRange> r = range_of_quotient(-s.f[0], s.f[1]);
      if (!r) return std::nullopt;
      hits.push_back({half_edge(e, *from == Sign::Negative), *r, {}});
      continue;
    }
    const auto s = substitute<BallNumber>(support, *line);
    const double lo = map.position(e, 0).range.lo, hi = map.position(e, 1).range.hi;
    const auto roots = simple_roots({s.f, s.degree}, lo, hi);
    if (!roots) return std::nullopt;
    if (roots->size() % 2 != (*from != *to)) return std::nullopt;
    bool from_negative = *from == Sign::Negative;
    for (const DoubleRange& root : *roots) {
      const BallNumber p = ball(root);
      const auto z = [&](int i) { return s.z[i][0] + p * (s.z[i][1] + p * s.z[i][2]); };
      const std::optional<DoubleRange> r = range_of_quotient(z(1), z(0));
      if (!r) return std::nullopt;
      hits.push_back({half_edge(e, from_negative), *r, {}});
      from_negative = !from_negative;
    }
  }
  return hits;
}

namespace {

ExactParameter exact_position(const PlanarData& map, int e, int end) {
  ArcParameter at = map.position(e, end);
  return exact(map.geometry->all.supports,
               map.geometry->all.arcs[map.edges[e].arc].support, at);
}

// Appends the crossings with one edge; false where it touches or ends on the line.
bool append_exact_hits(const PlanarData& map, int e, const PlaneSupport& line,
                       std::vector<ScanHit>& hits) {
  const PlaneSupport& support = map.support_of_edge(e);
  const Substitution<Ring> s = substitute<Ring>(support, line);
  const Polynomial1 f = integer_polynomial(s.f);
  if (f.empty()) return false;  // the edge lies on it
  const ExactParameter from = exact_position(map, e, 0), to = exact_position(map, e, 1);
  Sign sign = sign_at(f, from);
  if (sign == Sign::Zero || sign_at(f, to) == Sign::Zero) return false;
  const Quadratic<Ring> h{s.f[0], 2 * s.f[0] + s.f[1], s.f[0] + s.f[1] + s.f[2]};
  const std::vector<QuadraticRoot> all_roots = roots(h);
  for (QuadraticRoot root : all_roots) {
    const ExactParameter p = root;
    if (compare(p, from) != Sign::Positive || compare(p, to) != Sign::Negative) continue;
    if (is_zero(root.d)) {
      root.b = 0;
      if (!support.straight && all_roots.size() == 1 && !is_zero(s.f[2])) return false;
    }
    const QuadraticRoot at =
        exact_ratio(value_at(s.z[1], root), value_at(s.z[0], root), root.d);
    hits.push_back({half_edge(e, sign == Sign::Negative), range(ball(at)), at});
    sign = -sign;
  }
  return true;
}

}  // namespace

std::optional<std::vector<ScanHit>> exact_hits(const PlanarData& map,
                                               std::span<const int> edges,
                                               const ScanLine& line) {
  const PlaneSupport support = line.support();
  std::vector<ScanHit> hits;
  for (const int e : edges) {
    if (!append_exact_hits(map, e, support, hits)) return std::nullopt;
  }
  return hits;
}

}  // namespace sightline::internal
