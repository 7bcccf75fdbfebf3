#include "linespace/picture/line_cut.h"

#include <cmath>
#include <tuple>

namespace sightline::internal {
namespace {

std::strong_ordering ordering(int sign) { return sign <=> 0; }

bool accurate(const LongValue& v) { return v.error <= 0x1p-36L * std::abs(v.value); }

}  // namespace

std::array<Rational, 2> LineCuts::exact_weights(const LineCut& cut) const {
  std::array<Rational, 2> w;
  for (int i = 0; i < 2; ++i) {
    w[i] = cut.kind == LineCut::Kind::Side
               ? eye_->exact_orient_value(cut.p, cut.q, ends_[i])
               : eye_->scene().exact_plane_value(cut.p, eye_->scene().exact(ends_[i]));
  }
  return {abs(w[0]), abs(w[1])};
}

Rational LineCuts::exact(const LineCut& cut) const {
  if (cut.kind == LineCut::Kind::Start) return 0;
  if (cut.kind == LineCut::Kind::Finish) return 1;
  const auto [w0, w1] = exact_weights(cut);
  return quotient(w0, Rational(w0 + w1));
}

std::array<Rational, 2> LineCuts::shares(const ExactPoint& w) const {
  const ExactPoint &u = eye_->exact_vector(ends_[0]), &v = eye_->exact_vector(ends_[1]);
  const ExactPoint whole = exact_cross(u, v);
  const std::size_t i = whole[0] != 0 ? 0 : whole[1] != 0 ? 1 : 2;
  return {quotient(exact_cross(w, v)[i], whole[i]),
          quotient(exact_cross(u, w)[i], whole[i])};
}

Rational LineCuts::nearness(const ExactPoint& w) const {
  const auto [s, t] = shares(w);
  return s * eye_->exact_height(ends_[0]) + t * eye_->exact_height(ends_[1]);
}

LineCut LineCuts::weighted(LineCut cut, LongValue at0, LongValue at1) const {
  if (accurate(at0) && accurate(at1)) {
    cut.w0 = std::abs(at0.value);
    cut.w1 = std::abs(at1.value);
    cut.error = at0.error / cut.w0 + at1.error / cut.w1;
  } else {
    // Brought to size 1, so that neither leaves the range of doubles.
    const auto [w0, w1] = exact_weights(cut);
    const Rational sum = w0 + w1;
    cut.w0 = long_double(quotient(w0, sum));
    cut.w1 = long_double(quotient(w1, sum));
    cut.error = 0x1p-61L;
  }
  cut.at = cut.w0 / (cut.w0 + cut.w1);
  // d at = at (1 - at) (d w0 / w0 - d w1 / w1), and the rounding of the quotient.
  cut.error = 2 * cut.error * cut.at * (cut.w1 / (cut.w0 + cut.w1)) + 0x1p-62L * cut.at;
  return cut;
}

LineCut LineCuts::at_side(int p, int q) const {
  return weighted({.kind = LineCut::Kind::Side, .p = p, .q = q},
                  eye_->orient_value(p, q, ends_[0]), eye_->orient_value(p, q, ends_[1]));
}

SideAgainstEdge<LineCut> LineCuts::against(int left, int right, int line) const {
  SideAgainstEdge<LineCut> side{
      eye_->orient(left, right, ends_[0]), eye_->orient(left, right, ends_[1]), {}};
  if (side.start == Sign::Negative && side.end == Sign::Positive) {
    if (line >= 0)
      std::tie(left, right) = std::tuple_cat(eye_->scene().lines()[line].ends);
    side.at = at_side(left, right);
  }
  return side;
}

LineCut LineCuts::at_plane(int face) const {
  const LineCut cut{.kind = LineCut::Kind::Plane, .p = face};
  const ViewScene& scene = eye_->scene();
  if (scene.is_constructed(ends_[0]) || scene.is_constructed(ends_[1])) {
    return weighted(cut, {0, 1}, {0, 1});
  }
  const PlaneSide& plane = scene.silhouettes().face_plane(face);
  const auto value = [&](int point) {
    const BoundedValue v = plane.value(scene.scene().point(point));
    return LongValue{v.value, v.error};
  };
  return weighted(cut, value(ends_[0]), value(ends_[1]));
}

std::strong_ordering LineCuts::compare(const LineCut& a, const LineCut& b) const {
  using Kind = LineCut::Kind;
  if (a.kind == Kind::Start || b.kind == Kind::Start) {
    return ordering((a.kind != Kind::Start) - (b.kind != Kind::Start));
  }
  if (a.kind == Kind::Finish || b.kind == Kind::Finish) {
    return ordering((a.kind == Kind::Finish) - (b.kind == Kind::Finish));
  }
  if (a.kind == b.kind && a.p == b.p && a.q == b.q) return std::strong_ordering::equal;
  const long double difference = a.at - b.at;
  if (std::abs(difference) > a.error + b.error) {
    ++thread_stage_counts().by_double;
    return ordering(difference > 0 ? 1 : -1);
  }
  if (thread_precision == Precision::Double) {
    return ordering((difference > 0) - (difference < 0));
  }
  ++thread_stage_counts().by_exact;
  const auto [a0, a1] = exact_weights(a);
  const auto [b0, b1] = exact_weights(b);
  return ordering(Rational(a0 * b1 - b0 * a1).sign());
}

std::ptrdiff_t LineCuts::rank(std::span<const LineCut> at, const LineCut& cut) const {
  const auto before = [&](const LineCut& x, const LineCut& y) {
    return compare(x, y) < 0;
  };
  return std::ranges::lower_bound(at, cut, before) - at.begin();
}

}  // namespace sightline::internal
