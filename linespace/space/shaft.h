// Conservative box tests in double: against the hull of a vertex or an edge and an edge,
// and against the shadow of a convex occluder.  "Outside" and "inside" are proofs, valid
// whatever the rounding; "maybe" costs only time.

#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// A box as centre and half sizes, rounded so that it contains the original.
struct CentredBox {
  std::array<double, 3> centre, half;
};

inline CentredBox centred(const Box& box) {
  CentredBox c;
  for (int i = 0; i < 3; ++i) {
    c.centre[i] = 0.5 * (box.min[i] + box.max[i]);
    // The subtractions below are each rounded once: 4 units cover both.
    const double h = std::max(box.max[i] - c.centre[i], c.centre[i] - box.min[i]);
    c.half[i] = h * (1 + 4 * kUnit);
  }
  return c;
}

/// The affine function f(x) = normal . (x - origin) + offset with every rounding error
/// accounted for, where the box is given relative to the origin.
///
/// The normal is a difference of products known to within `slack` a component, so that
/// over a box with centre c and half sizes h, both relative to the origin,
///   |f(x) - (normal . c + offset)| <= sum |normal_i| h_i + slack_i (|c_i| + h_i) +
///   error.
struct BoundedPlane {
  std::array<double, 3> normal;
  std::array<double, 3> slack;
  double offset = 0;
  double error = 0;

  /// Largest value over the box is surely negative.
  [[nodiscard]] bool negative_on(const std::array<double, 3>& c,
                                 const std::array<double, 3>& h) const {
    double value = offset + error;
    for (int i = 0; i < 3; ++i) {
      value += normal[i] * c[i] + std::abs(normal[i]) * h[i] +
               slack[i] * (std::abs(c[i]) + h[i]);
    }
    return value < 0;
  }
  /// Not less than the largest value over the box of all x with low <= x <= high, both
  /// relative to the origin; zero where every term is zero exactly, so that what touches
  /// the plane is told from what crosses it.
  [[nodiscard]] double upper_on(const std::array<double, 3>& low,
                                const std::array<double, 3>& high) const {
    double value = offset + error;
    for (int i = 0; i < 3; ++i) {
      const double n0 = normal[i] - slack[i];
      const double n1 = normal[i] + slack[i];
      value +=
          std::max((low[i] < 0 ? n0 : n1) * low[i], (high[i] < 0 ? n0 : n1) * high[i]);
    }
    return value;
  }
  /// Smallest value over the box is surely positive.
  [[nodiscard]] bool positive_on(const std::array<double, 3>& c,
                                 const std::array<double, 3>& h) const {
    double value = offset - error;
    for (int i = 0; i < 3; ++i) {
      value += normal[i] * c[i] - std::abs(normal[i]) * h[i] -
               slack[i] * (std::abs(c[i]) + h[i]);
    }
    return value > 0;
  }
};

/// The plane through origin, p and q with f > 0 in front of (origin, p, q).  With u and w
/// the differences to p and q, a component u_j w_k - u_k w_j is computed to within
/// 5 e (|u_j w_k| + |u_k w_j|) (two roundings of differences, one of product, one of
/// the sum); negative_on adds at most 12 e of each term when it sums up, and the centre
/// relative to the origin was rounded once.  32 e covers all of it.
inline BoundedPlane plane_from(const Point& origin, const Point& p, const Point& q) {
  const Point u = p - origin;
  const Point w = q - origin;
  BoundedPlane plane;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double a = u[j] * w[k];
    const double b = u[k] * w[j];
    plane.normal[i] = a - b;
    plane.slack[i] = 32 * kUnit * (std::abs(a) + std::abs(b));
  }
  return plane;
}

/// The plane through a, b and c, as a function of positions relative to `origin`.
inline BoundedPlane plane_seen_from(const Point& origin, const Point& a, const Point& b,
                                    const Point& c) {
  BoundedPlane plane = plane_from(a, b, c);
  const Point d = origin - a;
  for (int i = 0; i < 3; ++i) {
    plane.offset += plane.normal[i] * d[i];
    plane.error +=
        (plane.slack[i] + 8 * kUnit * std::abs(plane.normal[i])) * std::abs(d[i]);
  }
  plane.error *= 1 + 8 * kUnit;
  return plane;
}

/// The hull of a vertex and an edge, of two edges, of an edge and a box, or of two boxes:
/// all segments between the two.
class Shaft {
 public:
  /// How far the points of the first edge may be off, in each coordinate.
  using Pad = std::array<double, 3>;

  Shaft(const Point& v, const Point& e0, const Point& e1) : origin_(v) {
    const std::array<Point, 3> points{v, e0, e1};
    const auto corners = bound(points);
    const Point& u = corners[1];
    const Point& w = corners[2];
    const Point n = u.cross(w);
    add_axis(n, corners);
    add_axis(n.cross(u), corners);
    add_axis(n.cross(w), corners);
    add_axis(n.cross(w - u), corners);
  }

  Shaft(const Point& p0, const Point& p1, const Point& q0, const Point& q1,
        const Pad& pad = {})
      : origin_(p0), pad_(pad) {
    const std::array<Point, 4> points{p0, p1, q0, q1};
    const auto corners = bound(points);
    const Point& p = corners[1];
    const Point& q = corners[2];
    const Point& r = corners[3];
    add_axes_across(0.5 * (q + r - p), corners);
    add_axis(p.cross(q), corners);
    add_axis(p.cross(r), corners);
    add_axis(q.cross(r), corners);
    add_axis((q - p).cross(r - p), corners);
  }

  Shaft(const Point& p0, const Point& p1, const Box& box, const Pad& pad = {})
      : origin_(p0), pad_(pad) {
    std::array<Point, 10> points{p0, p1};
    for (int c = 0; c < 8; ++c) points[2 + c] = corner(box, c);
    const auto corners = bound(points);
    const Point& p = corners[1];
    const Point along = 0.5 * (corners[2] + corners[9] - p);
    add_axes_across(along, corners);
    const Point n = p.cross(along);
    add_axis(n, corners);
    add_axis(n.cross(along), corners);
  }

  Shaft(const Box& from, const Box& to) : origin_(corner(from, 0)) {
    std::array<Point, 16> points;
    for (int c = 0; c < 8; ++c) {
      points[c] = corner(from, c);
      points[8 + c] = corner(to, c);
    }
    const auto corners = bound(points);
    add_axes_across(corners[8] + corners[15] - corners[7], corners);
  }

  /// False proves that no point of the closed box lies in the closed hull.
  [[nodiscard]] bool may_meet(const Box& box) const {
    std::array<double, 3> c, h;
    for (int i = 0; i < 3; ++i) {
      if (box.min[i] > max_[i] || box.max[i] < min_[i]) return false;
      const double centre = 0.5 * (box.min[i] + box.max[i]);
      h[i] = std::max(box.max[i] - centre, centre - box.min[i]);
      c[i] = centre - origin_[i];
      // 16 e covers the roundings of centre, its offset, the products and the sums.
      h[i] += 16 * kUnit * (std::abs(c[i]) + h[i]);
    }
    for (int k = 0; k < count_; ++k) {
      const Axis& axis = axes_[k];
      double middle = 0;
      double radius = 0;
      for (int i = 0; i < 3; ++i) {
        middle += axis.direction[i] * c[i];
        radius += std::abs(axis.direction[i]) * h[i];
      }
      if (middle - radius > axis.max || middle + radius < axis.min) return false;
    }
    return true;
  }

 private:
  /// Any direction separates if the projections are disjoint, however it was computed.
  struct Axis {
    Point direction;
    double min, max;
  };

  [[nodiscard]] static Point corner(const Box& box, int c) {
    Point p;
    for (int i = 0; i < 3; ++i) p[i] = (c >> i & 1) != 0 ? box.max[i] : box.min[i];
    return p;
  }

  /// Returns the points relative to the origin.
  template <std::size_t N>
  std::array<Point, N> bound(const std::array<Point, N>& points) {
    std::array<Point, N> relative;
    for (int i = 0; i < 3; ++i) min_[i] = max_[i] = points[0][i];
    for (std::size_t k = 0; k < N; ++k) {
      relative[k] = points[k] - origin_;
      for (int i = 0; i < 3; ++i) {
        min_[i] = std::min(min_[i], points[k][i]);
        max_[i] = std::max(max_[i], points[k][i]);
      }
    }
    for (int i = 0; i < 3; ++i) {
      // Two units cover the rounding of what is off by one or more.
      min_[i] -= 2 * pad_[i];
      max_[i] += 2 * pad_[i];
    }
    return relative;
  }

  template <std::size_t N>
  void add_axis(const Point& m, const std::array<Point, N>& corners) {
    double low = 0;
    double high = 0;
    double largest = 0;
    for (const Point& x : corners) {
      double at = 0;
      double size = 0;
      for (int i = 0; i < 3; ++i) {
        at += m[i] * x[i];
        size += std::abs(m[i] * x[i]);
      }
      low = std::min(low, at);
      high = std::max(high, at);
      largest = std::max(largest, size);
    }
    double error = 16 * kUnit * largest;
    for (int i = 0; i < 3; ++i) error += 2 * std::abs(m[i]) * pad_[i];
    axes_[count_++] = {m, low - error, high + error};
  }

  /// Across the way, the first to try: most boxes are beside a shaft.
  template <std::size_t N>
  void add_axes_across(const Point& along, const std::array<Point, N>& corners) {
    add_axis({-along[1], along[0], 0}, corners);
    add_axis({0, -along[2], along[1]}, corners);
    add_axis({along[2], 0, -along[0]}, corners);
  }

  Point origin_;
  Pad pad_{};
  std::array<double, 3> min_, max_;
  std::array<Axis, 7> axes_{};
  int count_ = 0;
};

/// What an occluder is proved to do to all segments between a point and a set.
enum class Hides : std::uint8_t {
  No,       ///< nothing
  Touches,  ///< each meets the closed occluder
  Inside    ///< each passes its inside
};

/// Where a convex occluder hides everything from a point: inside all its planes.
struct Shadow {
  std::vector<BoundedPlane> planes;  ///< relative to the viewpoint, negative inside

  /// False where hides() would find nothing for whatever the point is in the middle of:
  /// faster.
  [[nodiscard]] bool near(const std::array<double, 3>& x) const {
    return std::none_of(planes.begin(), planes.end(), [&](const BoundedPlane& p) {
      return p.offset + (p.normal[0] * x[0] + p.normal[1] * x[1] + p.normal[2] * x[2]) >
             0;
    });
  }
  /// No point of the box with these corners, relative to the viewpoint, is inside, but
  /// for rounding.
  [[nodiscard]] bool beside(const std::array<double, 3>& low,
                            const std::array<double, 3>& high) const {
    return std::any_of(planes.begin(), planes.end(), [&](const BoundedPlane& p) {
      double least = p.offset;
      for (int i = 0; i < 3; ++i) {
        least += std::min(p.normal[i] * low[i], p.normal[i] * high[i]);
      }
      return least > 0;
    });
  }
  /// Of the box with these corners, relative to the viewpoint.
  [[nodiscard]] Hides hides(const std::array<double, 3>& low,
                            const std::array<double, 3>& high) const {
    Hides all = planes.empty() ? Hides::No : Hides::Inside;
    for (const BoundedPlane& plane : planes) {
      const double value = plane.upper_on(low, high);
      if (value > 0) return Hides::No;
      if (value == 0) all = Hides::Touches;
    }
    return all;
  }
};

}  // namespace sightline::internal
