#include "shadows/irradiance/seen_formula.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace sightline::internal {
namespace {

// Far above what roundings do to the sine of an angle between two lines: beyond it exact
// numbers need not be asked.
constexpr double kClear = 1e-9;

ExactPoint way_of(const std::array<ExactPoint, 2>& ends) {
  return exact_difference(ends[1], ends[0]);
}

}  // namespace

double SeenFormula::value(const Point& p, const Eigen::Vector3d& normal) const {
  double sum = 0;
  for (const Loop& loop : loops) {
    const auto across = [&](int k) -> Eigen::Vector3d {
      return (sides[k].at - p).cross(sides[k].way);
    };
    // Towards the corner where side k begins, for the normals of the planes through p of
    // the side before and of side k.
    const auto corner = [&](int k, const Eigen::Vector3d& before,
                            const Eigen::Vector3d& own) -> Eigen::Vector3d {
      const Eigen::Vector3d way =
          sides[k].meets ? Eigen::Vector3d(sides[k].corner - p) : before.cross(own);
      return loop.facing.dot(way) > 0 ? Eigen::Vector3d(-way) : way;
    };
    const Eigen::Vector3d first = across(loop.first);
    const Eigen::Vector3d start = corner(loop.first, across(loop.last - 1), first);
    Eigen::Vector3d own = first, from = start;
    for (int k = loop.first; k < loop.last; ++k) {
      const bool closes = k + 1 == loop.last;
      const Eigen::Vector3d next = closes ? first : across(k + 1);
      const Eigen::Vector3d to = closes ? start : corner(k + 1, own, next);
      const double length = own.norm();
      if (length > 0) {
        const double angle = std::atan2(from.cross(to).dot(own), length * from.dot(to));
        sum += angle * normal.dot(own) / length;
      }
      own = next;
      from = to;
    }
  }
  // The part seen lies on the left of its sides.
  return -sum / (2 * std::numbers::pi);
}

FormulaMaker::FormulaMaker(const SourceScene& source, int face)
    : source_(&source), face_(face) {
  for (std::size_t p = 0; p < source.planes().size(); ++p) {
    const SourcePlane& plane = source.planes()[p];
    for (const int f : plane.source_face) planes_[f] = static_cast<int>(p);
    for (const auto& sides : plane.sides) {
      for (const SourcePlane::Side& side : sides) source_sides_[side.name] = side.ends;
    }
  }
}

// The line in which the plane of a face cuts that of the source.
std::optional<FormulaMaker::Line> FormulaMaker::in_source_plane(int face,
                                                                int plane) const {
  struct Plane {
    ExactPoint normal;
    Rational height;
  };
  const auto plane_of = [&](int f) {
    const auto t = plane_points(source_->scene().scene(), f);
    const ExactPoint a = source_->scene().exact(t[0]);
    Plane out{exact_cross(exact_difference(source_->scene().exact(t[1]), a),
                          exact_difference(source_->scene().exact(t[2]), a)),
              0};
    out.height = exact_dot(out.normal, a);
    return out;
  };
  const Plane x = plane_of(face), y = plane_of(source_->planes()[plane].faces.front());
  const ExactPoint way = exact_cross(x.normal, y.normal);
  const Rational squared = exact_dot(way, way);
  if (squared == 0) return std::nullopt;
  ExactPoint mixed;
  for (int i = 0; i < 3; ++i) mixed[i] = x.height * y.normal[i] - y.height * x.normal[i];
  ExactPoint from = exact_cross(mixed, way), to;
  for (int i = 0; i < 3; ++i) {
    from[i] /= squared;
    to[i] = from[i] + way[i];
  }
  return Line{{from, to}, true};
}

std::optional<int> FormulaMaker::line_of(const SeenSide& side, int plane) {
  const auto [it, is_new] = numbers_.try_emplace({side.kind, side.id, plane}, -1);
  if (!is_new) return it->second < 0 ? std::nullopt : std::optional(it->second);
  const ViewScene& view = source_->scene();
  std::optional<Line> line;
  if (side.kind == SeenSide::Kind::Source || side.kind == SeenSide::Kind::Edge) {
    const auto [a, b] = side.kind == SeenSide::Kind::Source ? source_sides_.at(side.id)
                                                            : view.lines()[side.id].ends;
    // All lines of the receiver's plane are seen in one, the horizon.
    const Rational at_a = view.exact_plane_value(face_, view.exact(a)),
                   at_b = view.exact_plane_value(face_, view.exact(b));
    if (at_a == 0 && at_b == 0) {
      const auto horizon = line_of({SeenSide::Kind::Horizon, 0}, plane);
      it->second = horizon.value_or(-1);
      return horizon;
    }
    const SourcePlane& of_side = source_->planes()[plane];
    const bool on_source = source_->side(of_side, a) == Sign::Zero &&
                           source_->side(of_side, b) == Sign::Zero;
    line = Line{{view.exact(a), view.exact(b)}, on_source};
  } else if (side.kind == SeenSide::Kind::Horizon) {
    line = in_source_plane(face_, plane);
  } else if (view.scene().facets()[side.id].planar) {
    line = in_source_plane(view.scene().facets()[side.id].faces.front(), plane);
  }
  if (!line) return std::nullopt;
  // Of length 1 at most, so that it does not leave the range of doubles.
  ExactPoint way = way_of(line->ends);
  Rational size = 0;
  for (const Rational& x : way) size = std::max(size, Rational(abs(x)));
  for (Rational& x : way) x /= size;
  line->at = rounded(line->ends[0]);
  line->way = rounded(way).normalized();
  it->second = static_cast<int>(lines_.size());
  lines_.push_back(std::move(*line));
  return it->second;
}

bool FormulaMaker::same(int line, int other) {
  if (line == other) return true;
  const Line &x = lines_[line], &y = lines_[other];
  if (x.way.cross(y.way).norm() > kClear) return false;
  const ExactPoint way = way_of(x.ends);
  return exact_cross(way, way_of(y.ends)) == ExactPoint{} &&
         exact_cross(way, exact_difference(y.ends[0], x.ends[0])) == ExactPoint{};
}

// The point of both lines; nullopt where they are skew or parallel.
std::optional<Point> FormulaMaker::meeting(int line, int other) {
  const auto [it, is_new] =
      meetings_.try_emplace({std::min(line, other), std::max(line, other)}, std::nullopt);
  if (!is_new) return it->second;
  const Line &x = lines_[line], &y = lines_[other];
  const Eigen::Vector3d between = y.at - x.at, normal = x.way.cross(y.way);
  if (std::abs(between.dot(normal)) > kClear * (x.at.norm() + y.at.norm())) return {};
  const ExactPoint u = way_of(x.ends), v = way_of(y.ends), n = exact_cross(u, v);
  const ExactPoint w = exact_difference(y.ends[0], x.ends[0]);
  if (n == ExactPoint{} || exact_dot(n, w) != 0) return {};
  const Rational s = exact_dot(exact_cross(w, v), n) / exact_dot(n, n);
  it->second = rounded(along(x.ends[0], x.ends[1], s));
  return it->second;
}

bool FormulaMaker::add_loop(const SeenBoundary& boundary, SeenFormula& out) {
  const int plane = planes_.at(boundary.source_face);
  std::vector<int> lines;
  for (const auto& names : boundary.sides) {
    // Several that all points of a face see in one are one line, or in their plane.
    const std::optional<int> line = line_of(names.front(), plane);
    if (!line) return false;
    if (lines.empty() || !same(lines.back(), *line)) lines.push_back(*line);
  }
  while (lines.size() > 1 && same(lines.front(), lines.back())) lines.pop_back();
  const Scene& scene = source_->scene().scene();
  const SourcePlane& of_loop = source_->planes()[plane];
  const auto t = plane_points(scene, of_loop.faces.front());
  const Point a = scene.point(t[0]);
  Eigen::Vector3d facing = (scene.point(t[1]) - a).cross(scene.point(t[2]) - a);
  if (!of_loop.fronts.front()) facing = -facing;
  const int first = static_cast<int>(out.sides.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const int before = lines[(k + lines.size() - 1) % lines.size()];
    const Line& line = lines_[lines[k]];
    const std::optional<Point> corner = meeting(before, lines[k]);
    out.sides.push_back({line.at, line.way, line.on_source, corner.has_value(),
                         corner.value_or(Point::Zero())});
  }
  out.loops.push_back(
      {first, static_cast<int>(out.sides.size()), a, facing.normalized()});
  return true;
}

std::optional<SeenFormula> FormulaMaker::formula(
    const std::vector<SeenBoundary>& boundaries) {
  SeenFormula out;
  for (const SeenBoundary& boundary : boundaries) {
    if (!add_loop(boundary, out)) return std::nullopt;
  }
  return out;
}

}  // namespace sightline::internal
