#include "aspect/cells/space_cells.h"

#include <algorithm>
#include <optional>

#include "linespace/work/stage.h"

namespace sightline::internal {
namespace {

// The line of two planes in homogeneous coordinates, dual to join().
template <class T>
Six<T> meet(const Four<T>& p, const Four<T>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
          p[0] * q[1] - p[1] * q[0], p[0] * q[3] - q[0] * p[3],
          p[1] * q[3] - q[1] * p[3], p[2] * q[3] - q[2] * p[3]};
}

// The product of a plane's normal with the line's direction.
template <class T>
T slope(const Six<T>& line, const Four<T>& p) {
  return line[0] * p[0] + line[1] * p[1] + line[2] * p[2];
}

// The foot of the line, its point nearest to the origin, is m x u / (u . u), where u is
// its direction and m = q3 p - p3 q of its planes p . x + p3 = 0 and q . x + q3 = 0.  The
// value of a plane there, times u . u.
template <class T>
T value_at_foot(const Six<T>& l, const Four<T>& p) {
  const std::array<T, 3> u{l[0], l[1], l[2]}, m{l[3], l[4], l[5]};
  const T x = m[1] * u[2] - m[2] * u[1], y = m[2] * u[0] - m[0] * u[2],
          z = m[0] * u[1] - m[1] * u[0];
  const T uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
  return p[0] * x + p[1] * y + p[2] * z + p[3] * uu;
}

class Planes {
 public:
  Planes(std::span<const LightPlane> planes, const Request& request)
      : planes_(planes),
        request_(&request),
        out_{SignTable(static_cast<int>(planes.size())), {}, {}, 0, 0} {}

  SpaceCells find() {
    Stage stage(*request_, "cells of planes");
    const auto n = static_cast<int>(planes_.size());
    for (int i = 0; i < n; ++i) {
      stage.check(static_cast<double>(i) / n);
      for (int j = i + 1; j < n; ++j) walk(i, j);
    }
    std::ranges::sort(out_.walls);
    out_.walls.erase(std::ranges::unique(out_.walls).begin(), out_.walls.end());
    out_.unbounded.resize(out_.cells.size(), false);
    return std::move(out_);
  }

 private:
  // Where another plane crosses the line: at -value / slope from its foot.
  struct Crossing {
    int plane;
    bool falls;  // the plane's value falls along the line
    double lo, hi;
  };
  struct Line {
    Six<Approx> near;
    std::optional<Six<Ring>> exact;  // when asked for
    int i, j;
  };

  const Six<Ring>& exact(Line& line) const {
    if (!line.exact) line.exact = meet(planes_[line.i].exact, planes_[line.j].exact);
    return *line.exact;
  }
  Sign slope_sign(Line& line, int k) const {
    return decide(slope(line.near, planes_[k].near),
                  [&] { return slope(exact(line), planes_[k].exact); });
  }
  Sign foot_sign(Line& line, int k) const {
    return decide(value_at_foot(line.near, planes_[k].near),
                  [&] { return value_at_foot(exact(line), planes_[k].exact); });
  }
  // The sign of where k crosses minus where l does.
  Sign order(Line& line, const Crossing& k, const Crossing& l) const {
    if (k.hi < l.lo) return Sign::Negative;
    if (l.hi < k.lo) return Sign::Positive;
    // -vk/sk < -vl/sl.
    const auto& p = planes_[k.plane].exact;
    const auto& q = planes_[l.plane].exact;
    const Six<Ring>& u = exact(line);
    const Sign s = sign_of(
        Ring(value_at_foot(u, q) * slope(u, p) - value_at_foot(u, p) * slope(u, q)));
    return k.falls == l.falls ? s : -s;
  }

  [[nodiscard]] std::vector<Crossing> sorted(Line& line,
                                             std::vector<Crossing> all) const {
    std::ranges::sort(all, [&](const Crossing& x, const Crossing& y) {
      return order(line, x, y) == Sign::Negative;
    });
    return all;
  }

  void walk(int i, int j) {
    Line line{meet(planes_[i].near, planes_[j].near), std::nullopt, i, j};
    // Parallel planes have no line.
    const auto zero = [&](int axis) {
      return decide(line.near[axis], [&] { return exact(line)[axis]; }) == Sign::Zero;
    };
    if (zero(0) && zero(1) && zero(2)) return;
    std::vector<SignTable::Word> signs(out_.cells.words(), 0);
    const auto set = [&](int k, bool positive) { SignTable::set(signs, k, positive); };
    std::vector<int> through{i, j};
    std::vector<Crossing> crossings;
    for (int k = 0; k < static_cast<int>(planes_.size()); ++k) {
      if (k == i || k == j) continue;
      const Sign s = slope_sign(line, k);
      if (s == Sign::Zero) {
        const Sign at = foot_sign(line, k);
        if (at == Sign::Zero) {
          if (k < j) return;  // told with the first two planes through it
          through.push_back(k);
        } else {
          set(k, at == Sign::Positive);
        }
        continue;
      }
      const Approx v = value_at_foot(line.near, planes_[k].near);
      const Approx t = Approx{-v.v, v.e} / slope(line.near, planes_[k].near);
      const bool known = is_certain(slope(line.near, planes_[k].near));
      constexpr double kFar = std::numeric_limits<double>::infinity();
      crossings.push_back(
          {k, s == Sign::Negative, known ? t.v - t.e : -kFar, known ? t.v + t.e : kFar});
      set(k, s == Sign::Negative);
    }
    crossings = sorted(line, std::move(crossings));
    add_sectors(line, through, signs, true);
    for (std::size_t k = 0; k < crossings.size();) {
      std::size_t next = k;
      while (next < crossings.size() &&
             (next == k || order(line, crossings[k], crossings[next]) == Sign::Zero)) {
        set(crossings[next].plane, !crossings[next].falls);
        ++next;
      }
      // Told on the line of the first two planes through it.
      const bool is_first =
          std::all_of(crossings.begin() + static_cast<std::ptrdiff_t>(k),
                      crossings.begin() + static_cast<std::ptrdiff_t>(next),
                      [&](const Crossing& c) { return c.plane > j; });
      out_.vertices += is_first ? 1 : 0;
      k = next;
      add_sectors(line, through, signs, k == crossings.size());
    }
  }

  // The walls around a piece of the line.
  void add_sectors(Line& line, const std::vector<int>& through,
                   std::vector<SignTable::Word>& signs, bool unbounded) {
    ++out_.edges;
    for (const int p : through) {
      for (const bool turned : {false, true}) {
        for (const int q : through) {
          if (q == p) continue;
          SignTable::set(signs, q, across(line, p, q) != turned);
        }
        const int negative = out_.cells.number_with(signs, p, false);
        const int positive = out_.cells.number_with(signs, p, true);
        out_.walls.push_back({p, negative, positive});
        if (!unbounded) continue;
        out_.unbounded.resize(out_.cells.size(), false);
        out_.unbounded[negative] = out_.unbounded[positive] = true;
      }
    }
  }

  // In plane p, on the side of the line to which direction x normal p points: is that
  // before plane q?
  [[nodiscard]] bool across(Line& line, int p, int q) const {
    const auto side = []<class T>(const Six<T>& u, const Four<T>& n, const Four<T>& m) {
      return m[0] * (u[1] * n[2] - u[2] * n[1]) + m[1] * (u[2] * n[0] - u[0] * n[2]) +
             m[2] * (u[0] * n[1] - u[1] * n[0]);
    };
    return decide(side(line.near, planes_[p].near, planes_[q].near), [&] {
             return side(exact(line), planes_[p].exact, planes_[q].exact);
           }) == Sign::Positive;
  }

  std::span<const LightPlane> planes_;
  const Request* request_;
  SpaceCells out_;
};

}  // namespace

SpaceCells space_cells(std::span<const LightPlane> planes, const Request& request) {
  return Planes(planes, request).find();
}

}  // namespace sightline::internal
