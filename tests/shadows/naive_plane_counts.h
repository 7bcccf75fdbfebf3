// Vertices and edges of a planar map, counted in doubles and with tolerances, and the
// face of a point by the parity of crossings: to check the exact map on small input.
// Shares nothing with it but the types of its input and its accessors.

#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "shadows/planar/planar_map.h"

namespace sightline::internal {

struct NaiveCounts {
  int vertices, edges;
};

namespace naive {

using Polynomial = std::vector<double>;  // constant first

inline Polynomial times(const Polynomial& f, const Polynomial& g) {
  Polynomial p(f.size() + g.size() - 1, 0.0);
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (std::size_t j = 0; j < g.size(); ++j) p[i + j] += f[i] * g[j];
  }
  return p;
}

// All complex roots nearly on the real line: eigenvalues of the companion matrix.
inline std::vector<double> real_roots(Polynomial f) {
  double largest = 0;
  for (const double c : f) largest = std::max(largest, std::abs(c));
  while (!f.empty() && std::abs(f.back()) <= 1e-11 * largest) f.pop_back();
  const int n = static_cast<int>(f.size()) - 1;
  if (n < 1) return {};
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    if (i > 0) companion(i, i - 1) = 1;
    companion(i, n - 1) = -f[i] / f[n];
  }
  std::vector<double> roots;
  for (const std::complex<double>& r : companion.eigenvalues()) {
    if (std::abs(r.imag()) < 1e-4) roots.push_back(r.real());
  }
  return roots;
}

struct Curve {
  Polynomial x, y, w;
  double from, to;
  // x^2, x y, y^2, x w, y w, w^2
  std::array<double, 6> conic;

  [[nodiscard]] Eigen::Vector2d at(double s) const {
    const auto value = [&](const Polynomial& f) { return f[0] + s * (f[1] + s * f[2]); };
    return Eigen::Vector2d(value(x), value(y)) / value(w);
  }
};

// The conic through X(s) for all s: the null vector of its values at five parameters and
// the line's own of a line, squared.
inline std::array<double, 6> conic_of(const Curve& c) {
  Eigen::MatrixXd rows(9, 6);
  for (int i = 0; i < 9; ++i) {
    const Eigen::Vector2d p = c.at(c.from + (c.to - c.from) * i / 8);
    rows.row(i) << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y(), 1;
  }
  Eigen::MatrixXd line(9, 3);
  line = rows.rightCols(3);
  const Eigen::JacobiSVD<Eigen::MatrixXd> flat(line, Eigen::ComputeFullV);
  if (flat.singularValues()(2) < 1e-9 * flat.singularValues()(0)) {
    const Eigen::Vector3d l = flat.matrixV().col(2);
    return {0, 0, 0, l[0], l[1], l[2]};
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  std::array<double, 6> out;
  for (int i = 0; i < 6; ++i) out[i] = svd.matrixV()(i, 5);
  return out;
}

inline double value(const std::array<double, 6>& f, const Eigen::Vector2d& p) {
  const double size = std::max(1.0, p.cwiseAbs().maxCoeff());
  const bool straight = f[0] == 0 && f[1] == 0 && f[2] == 0;
  return (f[0] * p.x() * p.x() + f[1] * p.x() * p.y() + f[2] * p.y() * p.y() +
          f[3] * p.x() + f[4] * p.y() + f[5]) /
         (straight ? size : size * size);
}

inline double end_value(const CurveEnd& e) {
  const double c = nearest_double(e.polynomial[0]), b = nearest_double(e.polynomial[1]),
               a = nearest_double(e.polynomial[2]);
  if (a == 0) return -c / b;
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const double u = (-b - root) / (2 * a), v = (-b + root) / (2 * a);
  return e.larger ? std::max(u, v) : std::min(u, v);
}

inline Curve curve_of(const PlaneCurve& c) {
  const auto polynomial = [](const RationalQuadratic& f) {
    return Polynomial{nearest_double(f[0]), nearest_double(f[1]), nearest_double(f[2])};
  };
  Curve out{polynomial(c.x),   polynomial(c.y), polynomial(c.w),
            end_value(c.from), end_value(c.to), {}};
  out.conic = conic_of(out);
  return out;
}

constexpr double kSame = 1e-6;

// Parameters on a at which it meets b.
inline void append_meeting(const Curve& a, const Curve& b, std::vector<double>& out) {
  const auto& f = b.conic;
  Polynomial g(5, 0.0);
  const auto add = [&](double c, const Polynomial& p) {
    for (std::size_t i = 0; i < p.size() && i < 5; ++i) g[i] += c * p[i];
  };
  if (f[0] == 0 && f[1] == 0 && f[2] == 0) {
    add(f[3], a.x);
    add(f[4], a.y);
    add(f[5], a.w);
  } else {
    add(f[0], times(a.x, a.x));
    add(f[1], times(a.x, a.y));
    add(f[2], times(a.y, a.y));
    add(f[3], times(a.x, a.w));
    add(f[4], times(a.y, a.w));
    add(f[5], times(a.w, a.w));
  }
  double most = 0;
  for (int i = 0; i <= 8; ++i) {
    most = std::max(most, std::abs(value(f, a.at(a.from + (a.to - a.from) * i / 8))));
  }
  std::vector<double> roots;
  if (most < 1e-12) {
    // One conic or line: the ends of b.
    for (const double t : {b.from, b.to}) {
      const Eigen::Vector2d p = b.at(t);
      Polynomial h(3);
      const bool by_x = std::abs(a.at(a.to).x() - a.at(a.from).x()) >
                        std::abs(a.at(a.to).y() - a.at(a.from).y());
      for (int i = 0; i < 3; ++i) {
        h[i] = (by_x ? a.x[i] : a.y[i]) - (by_x ? p.x() : p.y()) * a.w[i];
      }
      for (const double s : real_roots(h)) {
        if ((a.at(s) - p).norm() < kSame) roots.push_back(s);
      }
    }
  } else {
    roots = real_roots(g);
  }
  for (double s : roots) {
    if (s < a.from - kSame || s > a.to + kSame) continue;
    s = std::clamp(s, a.from, a.to);
    const Eigen::Vector2d p = a.at(s);
    // Nearest point of b, by sampling and golden section.
    double best = b.from, least = 1e300;
    const int steps = 400;
    for (int i = 0; i <= steps; ++i) {
      const double t = b.from + (b.to - b.from) * i / steps;
      if (const double d = (b.at(t) - p).norm(); d < least) {
        least = d;
        best = t;
      }
    }
    double lo = std::max(b.from, best - (b.to - b.from) / steps);
    double hi = std::min(b.to, best + (b.to - b.from) / steps);
    for (int i = 0; i < 100; ++i) {
      const double u = lo + 0.382 * (hi - lo), v = lo + 0.618 * (hi - lo);
      const bool left = (b.at(u) - p).norm() < (b.at(v) - p).norm();
      (left ? hi : lo) = left ? v : u;
    }
    if ((b.at(0.5 * (lo + hi)) - p).norm() < kSame) out.push_back(s);
  }
}

}  // namespace naive

inline NaiveCounts naive_counts(std::span<const PlaneCurve> input,
                                const PlaneOutline& outline) {
  using naive::Curve;
  std::vector<Curve> curves;
  for (const PlaneCurve& c : input) curves.push_back(naive::curve_of(c));
  for (const auto& ring : outline) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      curves.push_back(
          naive::curve_of(plane_segment(0, ring[i], ring[(i + 1) % ring.size()])));
    }
  }
  std::vector<Eigen::Vector2d> vertices;
  const auto vertex = [&](const Eigen::Vector2d& p) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if ((vertices[i] - p).norm() < 10 * naive::kSame) return static_cast<int>(i);
    }
    vertices.push_back(p);
    return static_cast<int>(vertices.size()) - 1;
  };
  // An edge: its two vertices and its middle, so that pieces that coincide are one.
  struct Edge {
    std::array<int, 2> ends;
    const Curve* curve;
    double from, to;
  };
  std::vector<Edge> edges;
  for (const Curve& a : curves) {
    std::vector<double> at{a.from, a.to};
    for (const Curve& b : curves) {
      if (&a != &b) naive::append_meeting(a, b, at);
    }
    std::ranges::sort(at);
    std::vector<std::pair<int, double>> along;
    for (const double s : at) {
      const int v = vertex(a.at(s));
      if (along.empty() || along.back().first != v) along.push_back({v, s});
    }
    for (std::size_t i = 0; i + 1 < along.size(); ++i) {
      const Edge e{{std::minmax(along[i].first, along[i + 1].first).first,
                    std::minmax(along[i].first, along[i + 1].first).second},
                   &a,
                   along[i].second,
                   along[i + 1].second};
      const Eigen::Vector2d middle = a.at(0.5 * (e.from + e.to));
      const bool known = std::ranges::any_of(edges, [&](const Edge& f) {
        if (f.ends != e.ends) return false;
        double least = 1e300;
        for (int k = 0; k <= 4000; ++k) {
          const double t = f.from + (f.to - f.from) * k / 4000;
          least = std::min(least, (f.curve->at(t) - middle).norm());
        }
        const double step =
            (f.curve->at(f.from) - f.curve->at(f.to)).norm() / 1000 + 1e-6;
        return least < step && std::abs(naive::value(f.curve->conic, middle)) < 1e-10;
      });
      if (!known) edges.push_back(e);
    }
  }
  return {static_cast<int>(vertices.size()), static_cast<int>(edges.size())};
}

/// Faces whose boundaries have an odd number of crossings with a ray from p to the right.
inline std::vector<int> naive_faces_around(const PlanarMap& map,
                                           const Eigen::Vector2d& p) {
  std::vector<int> crossings(map.face_count(), 0);
  for (int e = 0; e < map.edge_count(); ++e) {
    const std::vector<Eigen::Vector2d> line = map.polyline(e, 1e-7);
    int count = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d &a = line[i], &b = line[i + 1];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) ++count;
    }
    for (const int h : {2 * e, 2 * e + 1}) {
      if (map.face(h) >= 0) crossings[map.face(h)] += count;
    }
  }
  std::vector<int> around;
  for (int f = 0; f < map.face_count(); ++f) {
    if (crossings[f] % 2 == 1) around.push_back(f);
  }
  return around;
}

}  // namespace sightline::internal
