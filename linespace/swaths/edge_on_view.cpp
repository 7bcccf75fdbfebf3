// Everything lies in one plane.  What x sees can change only in the directions of corners
// and of crossings of segments; so they are sorted around x, and between two of them one
// line decides.  A face that crosses the plane hides what is behind its segment; where
// none does, the contacts of the line say the rest.

#include "linespace/swaths/edge_on_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/sight/free_segment.h"
#include "linespace/sight/line_probe.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/swaths/eee_curve.h"

namespace sightline::internal {
namespace {

// A number off by at most `error`.
struct Approx {
  double value = 0, error = 0;

  // Zero where it is not certain.  The errors below are rounded themselves, some ten
  // times one after the other: 2^-40 of each is plenty.
  [[nodiscard]] Sign sign() const { return certain_sign(value, error * (1 + 0x1p-40)); }
};
Approx operator+(const Approx& a, const Approx& b) {
  const double v = a.value + b.value;
  return {v, a.error + b.error + kUnit * std::abs(v)};
}
Approx operator-(const Approx& a, const Approx& b) {
  return a + Approx{-b.value, b.error};
}
Approx operator*(const Approx& a, const Approx& b) {
  const double v = a.value * b.value;
  return {v, std::abs(a.value) * b.error + std::abs(b.value) * a.error +
                 a.error * b.error + kUnit * std::abs(v)};
}

// From x to a point, in two of the three coordinates.
template <class T>
using Way = std::array<T, 2>;
template <class T>
Way<T> operator+(const Way<T>& a, const Way<T>& b) {
  return {T(a[0] + b[0]), T(a[1] + b[1])};
}
template <class T>
Way<T> operator-(const Way<T>& a, const Way<T>& b) {
  return {T(a[0] - b[0]), T(a[1] - b[1])};
}
template <class T>
T cross(const Way<T>& a, const Way<T>& b) {
  return a[0] * b[1] - a[1] * b[0];
}
Sign sign_of(const Rational& x) { return static_cast<Sign>(x.sign()); }

class EdgeOnView {
 public:
  EdgeOnView(const Silhouettes& g, int facet, const PlaneThrough& plane, const Point& a,
             const Point& b)
      : g_(g), scene_(g.scene()), facet_(facet), side_(plane) {
    plane_ = {exact_point(plane.a), exact_point(plane.b), exact_point(plane.c)};
    const Rational at_a = height(a);
    const Rational at_b = height(b);
    x_ = along(exact_point(a), exact_point(b), quotient(at_a, at_a - at_b));
    near_ = rounded(x_);
    const ExactPoint normal = exact_cross(exact_difference(plane_[1], plane_[0]),
                                          exact_difference(plane_[2], plane_[0]));
    for (int i = 0; i < 3; ++i) {
      if (abs(normal[i]) > abs(normal[axis_])) axis_ = i;
    }
    kept_ = {(axis_ + 1) % 3, (axis_ + 2) % 3};
    for (int i = 0; i < 2; ++i) slope_[i] = -normal[kept_[i]] / normal[axis_];
    for (int i = 0; i < 3; ++i) {
      const double off = 4 * kUnit * std::abs(near_[i]);
      box_.min[i] = near_[i] - off;
      box_.max[i] = near_[i] + off;
    }
  }

  bool seen() {
    add_sides();
    add_others();
    for (const int sign : {-1, 1}) {
      add_direction({Rational(sign), Rational(0)});
      add_direction({Rational(0), Rational(sign)});
    }
    sort();
    for (const Segment& side : sides_) {
      for_gaps(side, [&](Gap& gap) {
        if (gap.side < 0 || nearer(gap, side, sides_[gap.side])) {
          gap.side = static_cast<int>(&side - sides_.data());
        }
      });
    }
    for (const Segment& s : crossing_) {
      for_gaps(s, [&](Gap& gap) {
        if (gap.side >= 0 && !gap.hidden) gap.hidden = nearer(gap, s, sides_[gap.side]);
      });
    }
    return std::any_of(gaps_.begin(), gaps_.end(), [&](const Gap& gap) {
      return gap.side >= 0 && !gap.hidden && is_free(gap);
    });
  }

 private:
  // A point of the plane where a mesh edge crosses it or a corner lies in it, by the ids
  // of the two points, or given exactly.
  struct Direction {
    std::int32_t p = -1, q = -1;
    Way<Approx> way;
    std::optional<Way<Rational>> exact;
    int rank = 0;  // around x; the same for the same direction
  };
  struct Segment {
    int from, to;  // directions
  };
  // Between a direction and the next: all lines meet the same side of the facet first.
  struct Gap {
    int from, to;
    int side = -1;
    bool hidden = false;
  };

  [[nodiscard]] Rational height(const Point& p) const {
    return exact_orient(plane_[0], plane_[1], plane_[2], exact_point(p));
  }

  // ---- Directions -------------------------------------------------------------------

  int direction_of(std::int32_t p, std::int32_t q) {
    const auto [at, is_new] =
        by_points_.try_emplace(std::minmax(p, q), static_cast<int>(directions_.size()));
    if (!is_new) return at->second;
    Direction d{at->first.first, at->first.second, {}, {}, 0};
    const Point& a = scene_.point(d.p);
    const Point& b = scene_.point(d.q);
    double t = 0;
    double off = 0;
    if (d.p != d.q) {
      const BoundedValue va = side_.value(a);
      const BoundedValue vb = side_.value(b);
      const double size = std::abs(va.value) + std::abs(vb.value);
      // A quotient x / (x + y) of values off by less than half of themselves; or else all
      // that is known is that it is between 0 and 1.
      const bool certain =
          va.error < 0.5 * std::abs(va.value) && vb.error < 0.5 * std::abs(vb.value);
      t = certain ? va.value / (va.value - vb.value) : 0.5;
      off = certain ? 4 * (va.error + vb.error) / size + 4 * kUnit : 0.5;
    }
    for (int i = 0; i < 2; ++i) {
      const int k = kept_[i];
      const double step = b[k] - a[k];
      const double size = std::abs(a[k]) + std::abs(b[k]) + std::abs(near_[k]);
      d.way[i] = {a[k] - near_[k] + t * step, off * std::abs(step) + 8 * kUnit * size};
    }
    directions_.push_back(std::move(d));
    return at->second;
  }

  void add_direction(const Way<Rational>& way) {
    Direction d;
    for (int i = 0; i < 2; ++i) {
      const double v = way[i].convert_to<double>();
      d.way[i] = {v, 4 * kUnit * std::abs(v)};
    }
    d.exact = way;
    directions_.push_back(std::move(d));
  }

  const Way<Rational>& exact(int id) {
    Direction& d = directions_[id];
    if (!d.exact) {
      ExactPoint at = exact_point(scene_.point(d.p));
      if (d.p != d.q) {
        const Rational a = height(scene_.point(d.p));
        const Rational b = height(scene_.point(d.q));
        at = along(at, exact_point(scene_.point(d.q)), quotient(a, a - b));
      }
      d.exact = {at[kept_[0]] - x_[kept_[0]], at[kept_[1]] - x_[kept_[1]]};
    }
    return *d.exact;
  }

  // Of a form in ways: by doubles, or else exactly.
  template <class Form>
  Sign decide(Form&& form) {
    const Sign s =
        form([&](int id) -> const auto& { return directions_[id].way; }).sign();
    if (s != Sign::Zero) return s;
    return sign_of(Rational(form([&](int id) -> const auto& { return exact(id); })));
  }

  Sign turn(int a, int b) {
    if (a == b) return Sign::Zero;
    return decide([&](auto&& way) { return cross(way(a), way(b)); });
  }
  Sign coordinate(int id, int i) {
    return decide([&](auto&& way) { return way(id)[i]; });
  }

  // ---- What lies in the plane -------------------------------------------------------

  void add_sides() {
    for (const int f : scene_.facets()[facet_].faces) {
      const auto corners = scene_.face_points(f);
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const int p = corners[k];
        const int q = corners[(k + 1) % corners.size()];
        sides_.push_back({direction_of(p, p), direction_of(q, q)});
        for (int i = 0; i < 3; ++i) {
          box_.min[i] = std::min(box_.min[i], scene_.point(p)[i]);
          box_.max[i] = std::max(box_.max[i], scene_.point(p)[i]);
        }
      }
    }
  }

  // Faces of others between x and the facet.
  void add_others() {
    g_.face_tree().traverse([&](const Box& box) { return boxes_meet(box, box_); },
                            [&](std::uint32_t item) {
                              const int f = static_cast<int>(item);
                              const bool other = scene_.faces()[f].facet != facet_;
                              if (other && boxes_meet(g_.face_box(f), box_)) add_face(f);
                            });
    for (const Segment& side : sides_) {
      for (const Segment& s : crossing_) add_crossing(side, s);
      for (const Segment& s : touching_) add_crossing(side, s);
    }
    for (std::size_t i = 0; i < touching_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) add_crossing(touching_[i], touching_[j]);
    }
  }

  void add_face(int face) {
    const auto corners = scene_.face_points(face);
    const std::size_t n = corners.size();
    std::vector<Sign> signs;
    bool front = false;
    bool back = false;
    for (const int p : corners) {
      signs.push_back(side_(scene_.point(p)));
      front |= signs.back() == Sign::Positive;
      back |= signs.back() == Sign::Negative;
    }
    const bool crosses = front && back;
    std::vector<int> met;
    for (std::size_t k = 0; k < n; ++k) {
      const int p = corners[k];
      const int q = corners[(k + 1) % n];
      const Sign next = signs[(k + 1) % n];
      if (signs[k] == Sign::Zero) {
        met.push_back(direction_of(p, p));
        if (next == Sign::Zero && !crosses) {
          touching_.push_back({met.back(), direction_of(q, q)});
        }
      } else if (next == -signs[k]) {
        met.push_back(direction_of(p, q));
      }
    }
    if (crosses && met.size() == 2) crossing_.push_back({met[0], met[1]});
  }

  // A direction where two segments cross in one point inside both.
  void add_crossing(const Segment& a, const Segment& b) {
    const auto side = [&](const Segment& of, int id) {
      return decide([&](auto&& way) {
        return cross(way(of.to) - way(of.from), way(id) - way(of.from));
      });
    };
    if (a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to) return;
    if (surely_apart(a, b)) return;
    const Sign from = side(a, b.from);
    if (from == Sign::Zero || side(a, b.to) != -from) return;
    const Sign other = side(b, a.from);
    if (other == Sign::Zero || side(b, a.to) != -other) return;
    const Way<Rational> u = exact(a.from);
    const Way<Rational> step = exact(a.to) - u;
    const Way<Rational> v = exact(b.from);
    const Way<Rational> way = exact(b.to) - v;
    const Rational t = quotient(cross(step, Way<Rational>(u - v)), cross(step, way));
    add_direction({v[0] + t * way[0], v[1] + t * way[1]});
  }

  [[nodiscard]] bool surely_apart(const Segment& a, const Segment& b) const {
    for (int i = 0; i < 2; ++i) {
      const auto low = [&](int id) {
        const Approx& x = directions_[id].way[i];
        return x.value - x.error;
      };
      const auto high = [&](int id) {
        const Approx& x = directions_[id].way[i];
        return x.value + x.error;
      };
      if (std::max(high(a.from), high(a.to)) < std::min(low(b.from), low(b.to)) ||
          std::max(high(b.from), high(b.to)) < std::min(low(a.from), low(a.to))) {
        return true;
      }
    }
    return false;
  }

  // ---- Around the viewpoint ---------------------------------------------------------

  bool turns_before(int a, int b) {
    const bool first = in_first_half(a);
    if (first != in_first_half(b)) return first;
    return turn(a, b) == Sign::Positive;
  }
  bool in_first_half(int id) {
    const Sign v = coordinate(id, 1);
    return v == Sign::Positive ||
           (v == Sign::Zero && coordinate(id, 0) == Sign::Positive);
  }

  void sort() {
    std::vector<int> order;
    for (int id = 0; id < static_cast<int>(directions_.size()); ++id) {
      const bool at_viewpoint =
          coordinate(id, 0) == Sign::Zero && coordinate(id, 1) == Sign::Zero;
      if (!at_viewpoint) order.push_back(id);
    }
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return turns_before(a, b); });
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k == 0 || turns_before(order[k - 1], order[k])) gaps_.push_back({order[k], -1});
      directions_[order[k]].rank = static_cast<int>(gaps_.size()) - 1;
    }
    for (std::size_t k = 0; k < gaps_.size(); ++k) {
      gaps_[k].to = gaps_[(k + 1) % gaps_.size()].from;
    }
  }

  // Visits all gaps in which lines meet the segment.
  template <class Visit>
  void for_gaps(const Segment& s, Visit&& visit) {
    const Sign way_round = turn(s.from, s.to);
    if (way_round == Sign::Zero) return;
    int k = directions_[s.from].rank;
    int end = directions_[s.to].rank;
    if (way_round == Sign::Negative) std::swap(k, end);
    for (; k != end; k = (k + 1) % static_cast<int>(gaps_.size())) visit(gaps_[k]);
  }

  // Whether the gap's middle line meets one segment before another: a line along m meets
  // that from p to q at cross(p, q) / cross(m, q - p).
  bool nearer(const Gap& gap, const Segment& a, const Segment& b) {
    // m is less than a quarter turn from both sides: the axes are among the directions.
    const auto over = [](auto&& way, const Segment& s) {
      return cross(way(s.from), way(s.to));
    };
    const auto under = [&](auto&& way, const Segment& s) {
      return cross(way(gap.from) + way(gap.to), way(s.to) - way(s.from));
    };
    // Both quotients are positive: cross(p, q) has the sign of what divides it.
    const Sign ahead = decide([&](auto&& way) {
      return over(way, a) * under(way, b) - over(way, b) * under(way, a);
    });
    return ahead * turn(a.from, a.to) * turn(b.from, b.to) == Sign::Negative;
  }

  bool is_free(const Gap& gap) {
    const Segment& side = sides_[gap.side];
    const Way<Rational> middle = exact(gap.from) + exact(gap.to);
    const Way<Rational> p = exact(side.from);
    const Way<Rational> q = exact(side.to);
    const Rational t = quotient(cross(p, q), cross(middle, Way<Rational>(q - p)));
    ExactPoint w;
    w[axis_] = x_[axis_];
    for (int i = 0; i < 2; ++i) {
      const Rational step = t * middle[i];
      w[kept_[i]] = x_[kept_[i]] + step;
      w[axis_] += slope_[i] * step;
    }
    return free_between(g_,
                        LineScan(scene_, faces_near_line(g_, near_, rounded(w)), x_, w));
  }

  const Silhouettes& g_;
  const Scene& scene_;
  int facet_;
  std::array<ExactPoint, 3> plane_;
  PlaneSide side_;
  int axis_ = 0;  // the coordinate left out: the plane is not parallel to it
  std::array<int, 2> kept_{};
  std::array<Rational, 2> slope_;  // of the one left out along the others
  ExactPoint x_;
  Point near_;  // x, rounded
  Box box_{};
  std::map<std::pair<std::int32_t, std::int32_t>, int> by_points_;
  std::vector<Direction> directions_;
  std::vector<Segment> sides_;                // of the facet's faces
  std::vector<Segment> crossing_, touching_;  // of other faces
  std::vector<Gap> gaps_;
};

}  // namespace

bool sees_edge_on(const Silhouettes& g, int facet, const PlaneThrough& plane,
                  const Point& a, const Point& b) {
  return EdgeOnView(g, facet, plane, a, b).seen();
}

}  // namespace sightline::internal
