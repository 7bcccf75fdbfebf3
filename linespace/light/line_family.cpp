#include "linespace/light/line_family.h"

#include <algorithm>
#include <cmath>

namespace sightline::internal {
namespace {

// (1-s) a + s b.
template <class T, std::size_t N>
std::array<T, N> mix(const std::array<T, N>& a, const std::array<T, N>& b, const T& s) {
  const T rest = T{1} - s;
  std::array<T, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = rest * a[i] + s * b[i];
  return out;
}

template <class T>
std::array<Four<T>, 2> last_points(const Four<T>& a0, const Four<T>& a1,
                                   const Six<T>& middle, const Four<T>& b0,
                                   const Four<T>& b1) {
  const auto at = [&](const Four<T>& a) {
    return combination(side(join(a, b0), middle), b1, side(join(a, b1), middle), b0);
  };
  return {at(a0), at(a1)};
}

template <class T>
Six<T> sum(const Six<T>& a, const Six<T>& b) {
  Six<T> out;
  for (int i = 0; i < 6; ++i) out[i] = a[i] + b[i];
  return out;
}

template <class T>
std::array<Six<T>, 3> lines_of(const std::array<Four<T>, 2>& x,
                               const std::array<Four<T>, 2>& y, bool pencil) {
  if (pencil) return {join(x[0], y[0]), Six<T>{}, join(x[0], y[1])};
  return {join(x[0], y[0]), sum(join(x[0], y[1]), join(x[1], y[0])), join(x[1], y[1])};
}

Approx evaluate(const FormOf<Approx>& h, bool linear, double at) {
  const Approx s{at, 0};
  const Approx rest = Approx{1, 0} - s;
  if (linear) return rest * h[0] + s * h[2];
  return rest * (rest * h[0] + s * h[1]) + s * (s * h[2]);
}

// An enclosure of a root known to 2^-48 of itself.
void enclose(const QuadraticRoot& root, FamilyCut& cut) {
  const double s = root.rounded();
  const double error = 2 * std::abs(s) * kQuotientError + 0x1p-990;
  cut.lo = std::max(0.0, s - error);
  cut.hi = std::min(1.0, s + error);
}

bool inside(const QuadraticRoot& root) {
  return compare(root, QuadraticRoot{0, 0, 1, 0}) == Sign::Positive &&
         compare(root, QuadraticRoot{1, 0, 1, 0}) == Sign::Negative;
}

}  // namespace

FamilyLine::FamilyLine(const LineFamily& family, const Ring& s) : family_(family), s_(s) {
  const double v = CGAL::to_double(s);
  const Approx near{v, Ring(v) == s ? 0 : std::abs(v) * 2 * kHalfUlp};
  x_ = mix(family.x_[0], family.x_[1], near);
  y_ = mix(family.y_[0], family.y_[1], near);
  l_ = join(x_, y_);
}

const FamilyLine::Exact& FamilyLine::exact() const {
  if (!exact_) {
    const LineFamily::Ends& ends = family_.exact_ends();
    Exact& e = exact_.emplace();
    e.x = mix(ends.x[0], ends.x[1], s_);
    e.y = mix(ends.y[0], ends.y[1], s_);
    e.l = join(e.x, e.y);
  }
  return *exact_;
}

Sign FamilyLine::side_to(const LightLine& line) const {
  return decide(side(l_, line.near), [&] { return side(exact().l, line.exact); });
}

LineFamily::LineFamily(const LightPoint& v, const LightPoint& e0, const LightPoint& e1)
    : v_(&v), e_{&e0, &e1}, x_{v.near, v.near}, y_{e0.near, e1.near} {
  l_ = lines_of(x_, y_, true);
}

LineFamily::LineFamily(const LightLine& first, const LightLine& middle,
                       const LightLine& last)
    : first_(&first), middle_(&middle), last_(&last) {
  const auto& [a0, a1] = first.ends;
  const auto& [b0, b1] = last.ends;
  x_ = {a0->near, a1->near};
  y_ = last_points(a0->near, a1->near, middle.near, b0->near, b1->near);
  l_ = lines_of(x_, y_, false);
}

const LineFamily::Ends& LineFamily::exact_ends() const {
  if (ends_) return *ends_;
  Ends& ends = ends_.emplace();
  if (is_pencil()) {
    ends.x = {v_->exact, v_->exact};
    ends.y = {e_[0]->exact, e_[1]->exact};
  } else {
    const auto& [a0, a1] = first_->ends;
    const auto& [b0, b1] = last_->ends;
    ends.x = {a0->exact, a1->exact};
    ends.y = last_points(a0->exact, a1->exact, middle_->exact, b0->exact, b1->exact);
  }
  return ends;
}

FormOf<Approx> LineFamily::form(const LightLine& line) const {
  if (is_pencil()) return {side(l_[0], line.near), Approx{}, side(l_[2], line.near)};
  return {side(l_[0], line.near), side(l_[1], line.near), side(l_[2], line.near)};
}

FormOf<Ring> LineFamily::exact_form(const LightLine& line) const {
  if (!exact_l_) {
    const Ends& ends = exact_ends();
    exact_l_ = lines_of(ends.x, ends.y, is_pencil());
  }
  const auto& l = *exact_l_;
  if (is_pencil()) return {side(l[0], line.exact), Ring(0), side(l[2], line.exact)};
  return {side(l[0], line.exact), side(l[1], line.exact), side(l[2], line.exact)};
}

std::optional<Sign> LineFamily::constant_sign(const FormOf<Approx>& h) const {
  if (!is_certain(h[0]) || !is_certain(h[2])) return std::nullopt;
  const bool positive = h[0].v > 0;
  if (positive != (h[2].v > 0)) return std::nullopt;
  if (!is_pencil()) {
    // A coefficient in the middle of the other sign does not matter while it is small:
    // h0 (1-s)^2 + h2 s^2 is at least 2 sqrt(h0 h2) s (1-s).
    const Approx with = positive ? h[1] : Approx{} - h[1];
    if (with.v < with.e) {
      const Approx least = Approx{4, 0} * (h[0] * h[2]) - h[1] * h[1];
      if (!(least.v > least.e)) return std::nullopt;
    }
  }
  return positive ? Sign::Positive : Sign::Negative;
}

void LineFamily::add_roots(const LightLine& line, const FormOf<Approx>& h,
                           const CutCause& cause, std::vector<FamilyCut>& out) const {
  if (constant_sign(h)) return;
  FamilyCut cut;
  cut.cause = cause;
  cut.of = FamilyCut::Of::Line;
  cut.line = &line;
  if (!is_certain(h[0]) || !is_certain(h[2])) return add_exact_roots(line, cause, out);
  if (is_pencil()) {
    cut.rising = h[0].v < 0;
    return add_root(h, h[0].v / (h[0].v - h[2].v), cut, out);
  }
  const double a = h[0].v - h[1].v + h[2].v;
  const double b = h[1].v - 2 * h[0].v;
  const double d = b * b - 4 * a * h[0].v;
  const double q = -0.5 * (b + std::copysign(std::sqrt(std::max(0.0, d)), b));
  const double both[] = {q / a, h[0].v / q};
  if ((h[0].v > 0) != (h[2].v > 0)) {
    // One of the two is inside.
    cut.rising = h[0].v < 0;
    const bool take_first = both[0] >= 0 && both[0] <= 1;
    return add_root(h, take_first ? both[0] : both[1], cut, out);
  }
  const Approx least = h[1] * h[1] - Approx{4, 0} * (h[0] * h[2]);
  if (!is_certain(least)) return add_exact_roots(line, cause, out);
  if (least.v < 0) return;
  const double low = std::min(both[0], both[1]);
  const double high = std::max(both[0], both[1]);
  cut.rising = h[0].v < 0;
  add_root(h, low, cut, out);
  cut.rising = !cut.rising;
  add_root(h, high, cut, out);
}

// Encloses the root near s, where the form rises or falls as the cut says.
void LineFamily::add_root(const FormOf<Approx>& h, double s, FamilyCut cut,
                          std::vector<FamilyCut>& out) const {
  for (double width = 0x1p-50; width < 0x1p-20; width *= 64) {
    cut.lo = std::max(0.0, s - width);
    cut.hi = std::min(1.0, s + width);
    const Approx at_lo = evaluate(h, is_pencil(), cut.lo);
    const Approx at_hi = evaluate(h, is_pencil(), cut.hi);
    if (is_certain(at_lo) && is_certain(at_hi) && (at_lo.v < 0) == cut.rising &&
        (at_hi.v > 0) == cut.rising) {
      out.push_back(cut);
      return;
    }
  }
  const QuadraticRoot root = exact(cut);
  if (!inside(root)) return;
  enclose(root, cut);
  out.push_back(cut);
}

void LineFamily::add_exact_roots(const LightLine& line, const CutCause& cause,
                                 std::vector<FamilyCut>& out) const {
  const FormOf<Ring> h = exact_form(line);
  std::vector<QuadraticRoot> found;
  if (is_pencil()) {
    if (sign_of(h[0]) != sign_of(h[2])) found = {linear_root(h[0], h[2])};
  } else {
    found = roots({h[0], h[1], h[2]});
  }
  for (const QuadraticRoot& root : found) {
    if (!inside(root)) continue;
    FamilyCut cut;
    cut.cause = cause;
    cut.of = FamilyCut::Of::Given;
    cut.given = std::make_shared<const QuadraticRoot>(root);
    enclose(root, cut);
    out.push_back(cut);
  }
}

void LineFamily::add_plane_root(const LightPlane& plane, bool at_first,
                                const CutCause& cause,
                                std::vector<FamilyCut>& out) const {
  const auto& points = at_first ? x_ : y_;
  const FormOf<Approx> h{value(plane.near, points[0]), Approx{},
                         value(plane.near, points[1])};
  FamilyCut cut;
  cut.cause = cause;
  cut.of = at_first ? FamilyCut::Of::PlaneAtFirst : FamilyCut::Of::PlaneAtLast;
  cut.plane = &plane;
  if (is_certain(h[0]) && is_certain(h[2]) && (h[0].v > 0) == (h[2].v > 0)) return;
  const auto [at0, at1] = exact_values(cut);
  if (sign_of(at0) != -sign_of(at1) || is_zero(at0)) return;
  enclose(exact(cut), cut);
  out.push_back(cut);
}

std::array<Ring, 2> LineFamily::exact_values(const FamilyCut& cut) const {
  const Ends& ends = exact_ends();
  const auto& points = cut.of == FamilyCut::Of::PlaneAtFirst ? ends.x : ends.y;
  return {value(cut.plane->exact, points[0]), value(cut.plane->exact, points[1])};
}

FamilyCut LineFamily::start() { return {}; }
FamilyCut LineFamily::end() {
  FamilyCut cut;
  cut.lo = cut.hi = 1;
  cut.of = FamilyCut::Of::End;
  cut.cause = {CutCause::Kind::Limit, 1, 0};
  return cut;
}

QuadraticRoot LineFamily::exact(const FamilyCut& cut) const {
  switch (cut.of) {
    case FamilyCut::Of::Start:
      return {0, 0, 1, 0};
    case FamilyCut::Of::End:
      return {1, 0, 1, 0};
    case FamilyCut::Of::Given:
      return *cut.given;
    case FamilyCut::Of::Line: {
      const FormOf<Ring> h = exact_form(*cut.line);
      if (is_pencil()) return linear_root(h[0], h[2]);
      return root({h[0], h[1], h[2]}, cut.rising);
    }
    default: {
      const auto [at0, at1] = exact_values(cut);
      return linear_root(at0, at1);
    }
  }
}

void LineFamily::refine(FamilyCut& cut) const {
  if (cut.lo < cut.hi) enclose(exact(cut), cut);
}

Sign LineFamily::compare(const FamilyCut& a, const FamilyCut& b) const {
  if (a.hi < b.lo) return Sign::Negative;
  if (b.hi < a.lo) return Sign::Positive;
  if (a.of == FamilyCut::Of::Line && b.of == a.of && a.line == b.line &&
      a.rising == b.rising) {
    return Sign::Zero;
  }
  return internal::compare(exact(a), exact(b));
}

}  // namespace sightline::internal
