#include "linespace/swath.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "linespace/swaths/exact_swath.h"
#include "linespace/swaths/quadratic_root.h"

namespace sightline {
namespace {

using internal::Quadratic;
using internal::QuadraticRoot;
using internal::Ring;

double orient(const Point& a, const Point& b, const Point& c, const Point& d) {
  return (b - a).cross(c - a).dot(d - a);
}

// How far along the last edge, with b between b0 and b1, as a share of the way.
double share(double b, double b0, double b1) {
  return b1 == b0 ? 0.5 : std::clamp((b - b0) / (b1 - b0), 0.0, 1.0);
}

bool is_zero(const Quadratic<Ring>& h) {
  return internal::is_zero(h.h0) && internal::is_zero(h.h1) && internal::is_zero(h.h2);
}

}  // namespace

struct Swath::Position::Exact {
  QuadraticRoot root;
};

Swath::Position::Position(double s)
    : exact_(std::make_shared<Exact>(Exact{{Ring(s), 0, 1, 0}})), value_(s) {}

Swath::Position::Position(std::shared_ptr<const Exact> exact)
    : exact_(std::move(exact)), value_(exact_->root.rounded()) {}

Sign Swath::Position::compare(const Position& a, const Position& b) {
  return internal::compare(a.exact_->root, b.exact_->root);
}

struct Swath::Impl {
  Impl(bool pencil_, const std::array<Point, 2>& first, const std::array<Point, 2>& last,
       const std::array<Point, 2>& middle = {})
      : pencil(pencil_), p(first), q(last), m(middle) {}

  bool pencil;                // through a vertex
  std::array<Point, 2> p, q;  // the first generator, the last
  std::array<Point, 2> m;     // of three edges: the middle one
  double f[2][2] = {};        // F_b(a) at the ends a of the first edge

  // The polynomials, made when they are first asked for: drawing needs none.
  const internal::ExactSwath& exact() const {
    std::call_once(made_, [this] {
      exact_ = pencil ? internal::exact_swath(p[0], {q[0], q[1]})
                      : internal::exact_swath({p[0], p[1]}, {m[0], m[1]}, {q[0], q[1]});
    });
    return exact_;
  }

  // Those of the roots in [0, 1].
  static Positions positions(const std::vector<QuadraticRoot>& roots) {
    const QuadraticRoot zero{0, 0, 1, 0}, one{1, 0, 1, 0};
    Positions out;
    for (const QuadraticRoot& r : roots) {
      if (internal::compare(r, zero) == Sign::Negative) continue;
      if (internal::compare(r, one) == Sign::Positive) continue;
      out.at.push_back(Position(std::make_shared<Position::Exact>(Position::Exact{r})));
    }
    return out;
  }
  static Positions in_plane(const PlaneThrough& plane, const internal::MovingPoint& x) {
    const auto [at0, at1] = values(plane, x);
    if (internal::is_zero(at0) && internal::is_zero(at1)) return {true, {}};
    if (internal::is_zero(at0 - at1)) return {};
    return positions({internal::linear_root(at0, at1)});
  }

 private:
  mutable std::once_flag made_;
  mutable internal::ExactSwath exact_;
};

std::optional<Swath> Swath::through(const Point& vertex, const LineThrough& edge) {
  if (collinear(vertex, edge.from, edge.to)) return std::nullopt;
  return Swath(std::make_shared<Impl>(true, std::array{vertex, vertex},
                                      std::array{edge.from, edge.to}));
}

std::optional<Swath> Swath::through(const LineThrough& first, const LineThrough& middle,
                                    const LineThrough& last) {
  auto impl = std::make_shared<Impl>(false, std::array{first.from, first.to},
                                     std::array{last.from, last.to},
                                     std::array{middle.from, middle.to});
  const auto& [m0, m1] = impl->m;
  bool all_meet = true;
  for (const int a : {0, 1}) {
    for (const int b : {0, 1}) {
      const Point &p = impl->p[a], &q = impl->q[b];
      impl->f[a][b] = orient(p, q, m0, m1);
      all_meet = all_meet && orient3d(p, q, m0, m1) == Sign::Zero;
    }
  }
  if (all_meet) return std::nullopt;
  return Swath(std::move(impl));
}

Swath::Positions Swath::meeting(const LineThrough& line) const {
  const Quadratic<Ring> h = impl_->exact().meeting(line);
  if (is_zero(h)) return {true, {}};
  return Impl::positions(internal::roots(h));
}

Swath::Positions Swath::first_in(const PlaneThrough& plane) const {
  return Impl::in_plane(plane, impl_->exact().first);
}

Swath::Positions Swath::last_in(const PlaneThrough& plane) const {
  return Impl::in_plane(plane, impl_->exact().last);
}

Swath::Trace Swath::trace(const PlaneThrough& plane) const {
  const std::array<Quadratic<Ring>, 4> exact = impl_->exact().trace(plane);
  std::array<internal::Surd, 12> monomials;
  for (int i = 0; i < 4; ++i) {
    const auto& [h0, h1, h2] = exact[i];
    monomials[3 * i] = {h0, 0};
    monomials[3 * i + 1] = {h1 - 2 * h0, 0};
    monomials[3 * i + 2] = {h0 - h1 + h2, 0};
  }
  const std::array<double, 12> rounded = internal::scaled(monomials, Ring(0));
  Trace out{{}, !impl_->pencil};
  for (int i = 0; i < 12; ++i) out.coefficients[i / 3][i % 3] = rounded[i];
  return out;
}

Point Swath::Trace::at(double s) const {
  std::array<double, 4> value;
  for (int i = 0; i < 4; ++i) {
    const auto& [c0, c1, c2] = coefficients[i];
    value[i] = c0 + s * (c1 + s * c2);
  }
  return Point(value[0], value[1], value[2]) / value[3];
}

double Swath::last_parameter(double s) const {
  if (impl_->pencil) return s;
  const auto& f = impl_->f;
  const double f0 = (1 - s) * f[0][0] + s * f[1][0];
  const double f1 = (1 - s) * f[0][1] + s * f[1][1];
  const double t = f0 / (f0 - f1);
  return std::isfinite(t) ? std::clamp(t, 0.0, 1.0) : 0.5;
}

std::array<Point, 2> Swath::line(double s) const {
  const double t = last_parameter(s);
  const auto &p = impl_->p, &q = impl_->q;
  return {(1 - s) * p[0] + s * p[1], (1 - t) * q[0] + t * q[1]};
}

std::vector<std::array<Point, 2>> Swath::rungs(std::array<double, 2> range,
                                               double deviation) const {
  if (impl_->pencil) return {line(range[0]), line(range[1])};  // a triangle
  // Intervals still to be drawn, the next one last.  Depth ends where doubles do.
  std::vector<std::array<double, 2>> waiting{range};
  std::vector<std::array<Point, 2>> out{line(range[0])};
  while (!waiting.empty()) {
    const auto [from, to] = waiting.back();
    waiting.pop_back();
    const std::array<Point, 2> end = line(to);
    const Point change = (end[0] - out.back()[0]) - (end[1] - out.back()[1]);
    const double middle = from + 0.5 * (to - from);
    // At a = 1/2, b = 1 / (1 + k).
    const double b =
        share(last_parameter(middle), last_parameter(from), last_parameter(to));
    // The smallest normal double keeps k finite where b is 0.
    const double root_k =
        std::sqrt((1 - b) / std::max(b, std::numeric_limits<double>::min()));
    const bool fine = change.norm() <= 2 * (1 + root_k) * deviation;
    if (fine || !(middle > from && middle < to)) {
      out.push_back(end);
    } else {
      waiting.push_back({middle, to});
      waiting.push_back({from, middle});
    }
  }
  return out;
}

double Swath::spanned_volume(std::array<double, 2> range) const {
  const auto [p0, q0] = line(range[0]);
  const auto [p1, q1] = line(range[1]);
  return std::abs(orient(p0, q0, p1, q1)) / 6;
}

}  // namespace sightline
