#include "skeleton/ask/viewing_part.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/swaths/eee_curve.h"
#include "skeleton/ask/far_pieces.h"

namespace sightline::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxHalvings = 12;
// Points of edges in the frame are off by at most this: two roundings of each end, three
// of the point between them, coordinates at most 1.
constexpr double kPointError = 16 * kUnit;
// Lengths l are quotients of such: relative.
constexpr double kSlack = 1 + 0x1p-40;
// Coordinate of the cube's sides: the scene ends a little before.
constexpr double kWall = 1;

// The parameters on the first and the last edge, the second off by at most `error`.
struct Slice {
  double s = 0, t = 0, error = 0;
};

// A slice of the arc between two parameters.  t is off its chord by at most `bulge`.
struct Stretch {
  Slice a, b;
  double bulge = 0;
};

// A linear function over a stretch: its values on both sides, off by at most `error`.
struct Ends {
  double a, b, error;
};

// The largest numerator / denominator over the stretch where the second is positive all
// along: the quotient is monotone.  Infinite where that is not certain.
double largest_ratio(const Ends& over, const Ends& under) {
  const double at_a = under.a - under.error;
  const double at_b = under.b - under.error;
  if (!(at_a > 0 && at_b > 0)) return kInfinity;
  const double most =
      std::max((over.a + over.error) / at_a, (over.b + over.error) / at_b);
  return most > 0 ? most * kSlack : most / kSlack;
}
// The least such quotient of the least numerator and the largest denominator.
double smallest_ratio(const Ends& over, const Ends& under) {
  const double at_a = under.a + under.error;
  const double at_b = under.b + under.error;
  const double least =
      std::min((over.a - over.error) / at_a, (over.b - over.error) / at_b);
  return least > 0 ? least / kSlack : least * kSlack;
}

class Family {
 public:
  Family(const Scene& scene, const Frame& frame, const SkeletonArc& arc)
      : range(arc.range), scene_(scene), ev_(arc.is_ev()) {
    if (ev_) {
      first_ = {arc.vertex(), arc.vertex()};
      last_ = points_of(arc.edge());
    } else {
      const auto& [first, second, last] = arc.edges();
      first_ = points_of(first);
      last_ = points_of(last);
      const BoundedForm form =
          OuterPair{&scene, first_, last_}.form({points_of(second), second});
      for (int k = 0; k < 2; ++k) {
        f0_[k] = form.f[k][0];
        f1_[k] = form.f[k][1];
      }
      // Three roundings of a value between two.
      form_error_ = 1.01 * form.error + 8 * kUnit * form.largest;
    }
    for (int k = 0; k < 2; ++k) {
      first_at_[k] = frame(scene.point(first_[k]));
      last_at_[k] = frame(scene.point(last_[k]));
    }
    // No crossing is farther from the arc, whose ends are rounded themselves.
    range = {std::max(0.0, range[0] - kShortestPiece),
             std::min(1.0, range[1] + kShortestPiece)};
  }

  std::array<double, 2> range;

  // nullopt where the doubles cannot tell t.
  [[nodiscard]] std::optional<Slice> slice(double s) const {
    if (ev_) return Slice{s, s, 0};
    const auto [over, apart] = quotient(s);
    if (!(std::abs(apart) > 32 * form_error_)) return std::nullopt;
    // (F0 + e) / (F0 - F1 + 2e), at most 1 itself.
    return Slice{s, std::clamp(over / apart, 0.0, 1.0),
                 4 * form_error_ / std::abs(apart) + 4 * kUnit};
  }

  // With x = (s - a) / (b - a) and t from 0 to 1: t = x / (x + r (1 - x)), r = w(b) /
  // w(a) and w = F0 - F1; it differs from x most where its derivative is 1, by |sqrt r -
  // 1| / (sqrt r + 1) = tanh(|log r| / 4).
  [[nodiscard]] Stretch stretch(const Slice& a, const Slice& b) const {
    Stretch out{a, b, 0};
    if (ev_) return out;
    const double wa = std::abs(quotient(a.s)[1]);
    const double wb = std::abs(quotient(b.s)[1]);
    // Of a logarithm: relative errors, each less than 1/16.
    const double error = 3 * form_error_ * (1 / wa + 1 / wb);
    out.bulge = 1.01 * std::tanh((std::abs(std::log(wb / wa)) + error) / 4) *
                (std::abs(b.t - a.t) + a.error + b.error);
    return out;
  }

  [[nodiscard]] Point first(const Slice& at) const {
    return first_at_[0] + at.s * (first_at_[1] - first_at_[0]);
  }
  [[nodiscard]] Point last(const Slice& at) const {
    return last_at_[0] + at.t * (last_at_[1] - last_at_[0]);
  }
  // What the last contact may be off by, on an axis.
  [[nodiscard]] double last_error(const Stretch& x, int axis) const {
    return kPointError + (std::max(x.a.error, x.b.error) + x.bulge) *
                             std::abs(last_at_[1][axis] - last_at_[0][axis]);
  }

  // The values of a plane at the first and at the last contact.
  [[nodiscard]] std::array<Ends, 2> plane(const Stretch& x, const PlaneSide& p) const {
    const auto along = [&](const std::array<std::int32_t, 2>& e, double at_a, double at_b,
                           double off) {
      const BoundedValue v = p.value(scene_.point(e[0]));
      const BoundedValue w = p.value(scene_.point(e[1]));
      const double difference = w.value - v.value;
      return Ends{v.value + at_a * difference, v.value + at_b * difference,
                  1.01 * std::max(v.error, w.error) +
                      8 * kUnit * (std::abs(v.value) + std::abs(w.value)) +
                      off * std::abs(difference)};
    };
    return {along(first_, x.a.s, x.b.s, 0),
            along(last_, x.a.t, x.b.t, std::max(x.a.error, x.b.error) + x.bulge)};
  }

 private:
  [[nodiscard]] std::array<std::int32_t, 2> points_of(int edge) const {
    const auto& p = scene_.edges()[edge].points;
    return {p[0], p[1]};
  }
  // F0 and F0 - F1.
  [[nodiscard]] std::array<double, 2> quotient(double s) const {
    const double f0 = f0_[0] * (1 - s) + f0_[1] * s;
    const double f1 = f1_[0] * (1 - s) + f1_[1] * s;
    return {f0, f0 - f1};
  }

  const Scene& scene_;
  bool ev_;
  std::array<std::int32_t, 2> first_{}, last_{};
  std::array<Point, 2> first_at_, last_at_;
  std::array<double, 2> f0_{}, f1_{};
  double form_error_ = 0;
};

// N and D over a stretch.
struct Rays {
  std::array<Point, 2> near, way;  // at both its sides
  Point near_error, far_error;

  [[nodiscard]] Point at(int side, double l) const { return near[side] + l * way[side]; }
  // What at() is off by, and the direction.
  [[nodiscard]] double error(double l, int axis) const {
    return (1 + l) * near_error[axis] + l * far_error[axis];
  }
  [[nodiscard]] double way_error(int axis) const {
    return near_error[axis] + far_error[axis];
  }
};

// Writes the boxes of one wing of an arc: 0 before the first contact, 1 beyond the last.
class Boxes {
 public:
  Boxes(const Family& family, int wing, double fine, std::vector<ChartBox>& out)
      : family_(family), wing_(wing), fine_(fine), out_(out) {}

  // Of lines that end on the plane `end`, or go on for ever.
  void add(double from, double to, const std::optional<PlaneSide>& end) {
    const auto a = family_.slice(from);
    const auto b = family_.slice(to);
    if (!a || !b) {
      everywhere(out_);
      return;
    }
    end_ = end;
    const Stretch x = family_.stretch(*a, *b);
    inside(x, 0, kInfinity, 0);
    if (end_) return;
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool negative : {false, true}) {
        axis_ = axis;
        sigma_ = negative ? -1 : 1;
        outside(x, -kInfinity, kInfinity, 0);
      }
    }
  }

  static void everywhere(std::vector<ChartBox>& out) {
    for (int chart = 0; chart < kCharts; ++chart) {
      out.push_back({chart, *grid_box({{-1, -1, -1}, {1, 1, 1}}), {}});
    }
  }

 private:
  [[nodiscard]] Rays rays(const Stretch& x) const {
    Rays out;
    const std::array<Point, 2> p{family_.first(x.a), family_.first(x.b)};
    const std::array<Point, 2> q{family_.last(x.a), family_.last(x.b)};
    Point last_error;
    for (int i = 0; i < 3; ++i) last_error[i] = family_.last_error(x, i);
    const Point first_error = Point::Constant(kPointError);
    out.near = wing_ == 1 ? q : p;
    const auto& far = wing_ == 1 ? p : q;
    for (int k = 0; k < 2; ++k) out.way[k] = out.near[k] - far[k];
    out.near_error = wing_ == 1 ? last_error : first_error;
    out.far_error = wing_ == 1 ? first_error : last_error;
    return out;
  }

  [[nodiscard]] static Ends near_on(const Rays& r, int axis, double sigma) {
    return {sigma * r.near[0][axis], sigma * r.near[1][axis], r.near_error[axis]};
  }
  [[nodiscard]] static Ends way_on(const Rays& r, int axis, double sigma) {
    return {sigma * r.way[0][axis], sigma * r.way[1][axis], r.way_error(axis)};
  }

  // How far lines go at most before they leave the cube.
  [[nodiscard]] static double exit_of(const Rays& r) {
    double least = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sigma : {-1.0, 1.0}) {
        const Ends near = near_on(r, axis, sigma);
        least =
            std::min(least, largest_ratio({kWall - near.a, kWall - near.b, near.error},
                                          way_on(r, axis, sigma)));
      }
    }
    return least;
  }

  // How far they go at most before they meet the plane that ends them: the first contact
  // is on its near side.
  [[nodiscard]] double end_of(const Stretch& x) const {
    const auto values = family_.plane(x, *end_);
    const Ends& first = values[0];
    const double sign = first.a > 0 ? 1 : -1;
    if (!(sign * first.a > first.error && sign * first.b > first.error)) return kInfinity;
    const Ends& near = values[wing_];
    const Ends& far = values[1 - wing_];
    return largest_ratio(
        {sign * near.a, sign * near.b, near.error},
        {sign * (far.a - near.a), sign * (far.b - near.b), far.error + near.error});
  }

  [[nodiscard]] static double size_of(const Box& box) {
    double size = 1;
    for (int i = 0; i < 3; ++i) {
      const double low = std::max(box.min[i], -1.0);
      const double high = std::min(box.max[i], 1.0);
      size *= std::max(0.0, high - low) + kFineGrain;
    }
    return size;
  }

  // What a surface is inside of: the hull of four points, each off by at most `error`.
  struct Corners {
    std::array<Point, 4> at, error;

    [[nodiscard]] Box box() const {
      Box out{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
      for (int k = 0; k < 4; ++k) {
        for (int i = 0; i < 3; ++i) {
          out.min[i] = std::min(out.min[i], at[k][i] - error[k][i]);
          out.max[i] = std::max(out.max[i], at[k][i] + error[k][i]);
        }
      }
      return out;
    }
    // Across both diagonals: where the four are in one plane, along that.
    [[nodiscard]] Slab slab() const {
      Slab out = Slab::across((at[3] - at[0]).cross(at[2] - at[1]));
      const Point n = out.normal();
      double low = kInfinity;
      double high = -kInfinity;
      for (int k = 0; k < 4; ++k) {
        const double middle = n.dot(at[k]);
        const double off = n.cwiseAbs().dot(error[k]) + 8 * kUnit * at[k].norm();
        low = std::min(low, middle - off);
        high = std::max(high, middle + off);
      }
      out.set(low, high);
      return out;
    }
  };

  void keep(int chart, const Box& box, const std::optional<Corners>& corners) {
    const auto grid = grid_box(box);
    if (grid) out_.push_back({chart, *grid, corners ? corners->slab() : Slab{}});
  }

  [[nodiscard]] std::array<std::optional<Stretch>, 2> halves(const Stretch& x) const {
    const auto middle = family_.slice(0.5 * (x.a.s + x.b.s));
    if (!middle) return {};
    return {family_.stretch(x.a, *middle), family_.stretch(*middle, x.b)};
  }

  // ---- In the cube ------------------------------------------------------------------

  void inside(const Stretch& x, double from, double to, int depth) {
    const Rays r = rays(x);
    const double exit = exit_of(r);
    const double end = end_ ? end_of(x) : kInfinity;
    to = std::min({to, exit, end});
    if (to < from) return;
    const bool open = to == kInfinity;
    std::optional<Corners> corners;
    if (!open) corners = corners_inside(r, from, to);
    const Box box = open ? Box{{-1, -1, -1}, {1, 1, 1}} : corners->box();
    if (size_of(box) > fine_ && depth < kMaxHalvings) {
      const double across = std::max((r.at(1, from) - r.at(0, from)).norm(),
                                     open ? 0 : (r.at(1, to) - r.at(0, to)).norm());
      const double along =
          open ? 0 : (to - from) * std::max(r.way[0].norm(), r.way[1].norm());
      if (along > across) {
        const double middle = 0.5 * (from + to);
        inside(x, from, middle, depth + 1);
        inside(x, middle, to, depth + 1);
        return;
      }
      const auto both = halves(x);
      if (both[0] && both[1]) {
        inside(*both[0], from, to, depth + 1);
        inside(*both[1], from, to, depth + 1);
        return;
      }
    }
    keep(0, box, corners);
  }

  [[nodiscard]] static Corners corners_inside(const Rays& r, double from, double to) {
    Corners out;
    int k = 0;
    for (const double l : {from, to}) {
      for (int side = 0; side < 2; ++side, ++k) {
        out.at[k] = r.at(side, l);
        for (int i = 0; i < 3; ++i) out.error[k][i] = r.error(l, i);
      }
    }
    return out;
  }

  // ---- Beyond it --------------------------------------------------------------------

  void outside(const Stretch& x, double from, double to, int depth) {
    const Rays r = rays(x);
    const Ends near = near_on(r, axis_, sigma_);
    const Ends way = way_on(r, axis_, sigma_);
    const double fastest = std::max(way.a, way.b) + way.error;
    if (fastest <= 0) return;
    from = std::max(
        {from, 0.0,
         smallest_ratio({kWall - near.a, kWall - near.b, near.error}, positive(way))});
    if (from >= to) return;
    const std::optional<Corners> corners = corners_outside(r, from, to);
    const bool certain = corners.has_value();
    const std::optional<Box> box = certain ? corners->box() : rough_box(r, from);
    if (!box || !grid_box(*box)) return;
    if (size_of(*box) > fine_ && depth < kMaxHalvings) {
      const double middle = certain ? middle_outside(r, from, to) : kInfinity;
      if (middle > from && middle < to && is_long(r, from, to)) {
        outside(x, from, middle, depth + 1);
        outside(x, middle, to, depth + 1);
        return;
      }
      const auto both = halves(x);
      if (both[0] && both[1]) {
        outside(*both[0], from, to, depth + 1);
        outside(*both[1], from, to, depth + 1);
        return;
      }
    }
    keep(chart_of(axis_, sigma_ < 0), *box, corners);
  }

  // For a lower bound of l: where the way is not positive no line arrives.
  [[nodiscard]] static Ends positive(const Ends& way) {
    const double least = 0x1p-60;
    return {std::max(way.a, least), std::max(way.b, least), way.error};
  }

  // X and its weight at l, the direction and 0 for infinite l.
  struct Corner {
    Point x, error;
    double weight;
  };
  [[nodiscard]] static Corner corner(const Rays& r, int side, double l) {
    const bool finite = l < kInfinity;
    Corner out{finite ? r.at(side, l) : r.way[side], {}, finite ? 1.0 : 0.0};
    for (int i = 0; i < 3; ++i) out.error[i] = finite ? r.error(l, i) : r.way_error(i);
    return out;
  }

  // nullopt where a corner is not certainly in front.
  [[nodiscard]] std::optional<Corners> corners_outside(const Rays& r, double from,
                                                       double to) const {
    Corners out;
    int k = 0;
    for (const double l : {from, to}) {
      for (int side = 0; side < 2; ++side, ++k) {
        const Corner c = corner(r, side, l);
        const double in_front = sigma_ * c.x[axis_];
        const double low = in_front - c.error[axis_];
        const double high = in_front + c.error[axis_];
        if (!(low > 0.5 * high)) return std::nullopt;
        for (int i = 0; i < 3; ++i) {
          const double least = i == axis_ ? c.weight : c.x[i] - c.error[i];
          const double most = i == axis_ ? c.weight : c.x[i] + c.error[i];
          const double min = least / (least > 0 ? high : low);
          const double max = most / (most > 0 ? low : high);
          out.at[k][i] = 0.5 * (min + max);
          out.error[k][i] = 0.5 * (max - min) + kPointError * (1 + std::max(max, -min));
        }
      }
    }
    return out;
  }

  // By bounds on each axis alone, of all that lies beyond `from`.
  [[nodiscard]] std::optional<Box> rough_box(const Rays& r, double from) const {
    const auto most = [](const Ends& x) { return std::max(x.a, x.b) + x.error; };
    const double ahead = most(near_on(r, axis_, sigma_));
    const double fastest = most(way_on(r, axis_, sigma_));
    Box box{{-1, -1, -1}, {1, 1, 1}};
    box.min[axis_] = 0;
    for (int i = 0; i < 3; ++i) {
      for (const double tau : {-1.0, 1.0}) {
        const double rate = most(way_on(r, i, tau));
        if (i == axis_ || !(rate < 0)) continue;
        // tau X_i <= start + (l - from) rate, 1 <= sigma X_axis <= ahead + l fastest.
        const double start = most(near_on(r, i, tau)) + from * rate;
        const double bound =
            start > 0 ? start
                      : std::max(start / std::max(kWall, ahead + from * fastest),
                                 rate / fastest);
        const double limit = std::min(1.0, bound + 0x1p-40);
        if (tau > 0) {
          box.max[i] = limit;
        } else {
          box.min[i] = -limit;
        }
      }
      if (box.min[i] > box.max[i]) return std::nullopt;
    }
    return box;
  }

  [[nodiscard]] double front(const Rays& r, double l) const {
    return sigma_ * (l < kInfinity ? r.at(0, l) : r.way[0])[axis_];
  }
  // Half way in the chart.
  [[nodiscard]] double middle_outside(const Rays& r, double from, double to) const {
    const double w = 0.5 * (1 / front(r, from) + (to < kInfinity ? 1 / front(r, to) : 0));
    return (1 / w - sigma_ * r.near[0][axis_]) / (sigma_ * r.way[0][axis_]);
  }
  // Longer along the lines than across, in the chart.
  [[nodiscard]] bool is_long(const Rays& r, double from, double to) const {
    const auto image = [&](int side, double l) {
      const Corner c = corner(r, side, l);
      Point p = c.x / (sigma_ * c.x[axis_]);
      p[axis_] = c.weight / (sigma_ * c.x[axis_]);
      return p;
    };
    const double along = (image(0, from) - image(0, to)).norm();
    const double across = std::max((image(0, from) - image(1, from)).norm(),
                                   (image(0, to) - image(1, to)).norm());
    return along > across;
  }

  const Family& family_;
  int wing_;
  double fine_;
  std::vector<ChartBox>& out_;
  std::optional<PlaneSide> end_;
  int axis_ = 0;  // of the chart at hand
  double sigma_ = 1;
};

// Two arcs of the same generators that are not told apart: their lines are asked
// together.
bool beside_another(const Skeleton& skeleton, std::uint32_t arc) {
  const auto beside = [](const SkeletonArc& x, const SkeletonArc& y) {
    return x.kind == y.kind && x.generators == y.generators &&
           x.range[0] <= y.range[1] + kShortestPiece &&
           y.range[0] <= x.range[1] + kShortestPiece;
  };
  const std::vector<SkeletonArc>& arcs = skeleton.arcs;
  return (arc > 0 && beside(arcs[arc], arcs[arc - 1])) ||
         (arc + 1 < arcs.size() && beside(arcs[arc], arcs[arc + 1]));
}

}  // namespace

Frame::Frame(const Scene& scene) {
  const auto& [low, high] = scene.bounds();
  centre = 0.5 * low + 0.5 * high;
  const double half = std::max((high - centre).maxCoeff(), (centre - low).maxCoeff());
  scale = half > 0 ? 0.998 / half : 1;
}

void viewing_boxes(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends,
                   const Frame& frame, std::uint32_t arc, double fine,
                   std::vector<ChartBox>& out) {
  const Family family(scene, frame, skeleton.arcs[arc]);
  const auto pieces = ends.pieces(arc);
  const bool told =
      !pieces.empty() && ends.bounds_all(arc) && !beside_another(skeleton, arc);
  const std::array<bool, 2>& ended = skeleton.arcs[arc].ends;
  for (int wing = 0; wing < 2; ++wing) {
    if (ended[wing]) continue;  // nobody beyond an end contact sees the arc
    Boxes boxes(family, wing, fine, out);
    if (!told) {
      boxes.add(family.range[0], family.range[1], std::nullopt);
      continue;
    }
    for (std::size_t k = 0; k < pieces.size();) {
      std::size_t next = k + 1;
      const std::int32_t facet = pieces[k].facets[wing];
      while (next < pieces.size() && pieces[next].facets[wing] == facet) ++next;
      const double from = k == 0 ? family.range[0] : pieces[k].from - kShortestPiece;
      const double to =
          next == pieces.size() ? family.range[1] : pieces[next].from + kShortestPiece;
      std::optional<PlaneSide> end;
      if (facet != kOutside && scene.facets()[facet].planar) {
        end = PlaneSide(face_plane_through(scene, scene.facets()[facet].faces.front()));
      }
      boxes.add(std::max(0.0, from), std::min(1.0, to), end);
      k = next;
    }
  }
}

}  // namespace sightline::internal
