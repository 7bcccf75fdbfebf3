#include "linespace/silhouettes/star_turns.h"

#include <algorithm>

#include "linespace/silhouettes/plane_values.h"

namespace sightline::internal {

StarTurns::StarTurns(const Scene& scene, const Star& star, const Point& e0,
                     const Point& e1)
    : scene_(scene),
      star_(star),
      edge_{e0, e1},
      rays_(star.rays.size()),
      turns_(rays_ * rays_),
      signs_(rays_ * rays_, 0) {
  for (std::size_t i = 0; i < rays_ && !degenerate_; ++i) {
    for (std::size_t j = i + 1; j < rays_ && !degenerate_; ++j) add(i, j, e0, e1);
  }
  std::sort(cuts_.begin(), cuts_.end(), [&](const Cut& a, const Cut& b) {
    return compare(scene_, edge_, a, b) == Sign::Negative;
  });
}

void StarTurns::add(std::size_t i, std::size_t j, const Point& e0, const Point& e1) {
  const Point& at = scene_.point(star_.point);
  const std::int32_t p = star_.rays[i];
  const std::int32_t q = star_.rays[j];
  const auto [x0, x1, s0, s1] =
      plane_values(PlaneSide({at, scene_.point(p), scene_.point(q)}), e0, e1);
  // Opposite rays span no plane: zero at both ends, and harmless.
  degenerate_ = (s0 == Sign::Zero || s1 == Sign::Zero) &&
                !collinear(at, scene_.point(p), scene_.point(q));
  Turn& t = turns_[i * rays_ + j];
  t = {s0, s1, {}};
  if (degenerate_ || s0 == s1) return;
  int facet = -1;
  for (const Star::Sector& s : star_.sectors) {
    const auto a = static_cast<std::size_t>(s.from);
    const auto b = static_cast<std::size_t>(s.to);
    if ((a != i || b != j) && (a != j || b != i)) continue;
    doubled_ |= facet >= 0 && facet != s.facet;
    facet = s.facet;
  }
  t.cut = make_cut(facet < 0 ? CutKind::Saddle : CutKind::Support, facet,
                   {star_.point, p, q}, x0, x1);
  cuts_.push_back(t.cut);
}

// The direction of the ray, or what follows it counter-clockwise, is in some face.
bool StarTurns::covered(std::size_t ray) const {
  return std::ranges::any_of(star_.sectors, [&](const Star::Sector& s) {
    auto a = static_cast<std::size_t>(s.from);
    auto b = static_cast<std::size_t>(s.to);
    if (signs_[a * rays_ + b] < 0) std::swap(a, b);
    if (signs_[a * rays_ + b] == 0) return false;
    return a == ray || (signs_[a * rays_ + ray] > 0 && signs_[ray * rays_ + b] > 0);
  });
}

bool StarTurns::leaves_gap(const Cut& from) {
  for (std::size_t i = 0; i < rays_; ++i) {
    for (std::size_t j = i + 1; j < rays_; ++j) {
      const Turn& t = turns_[i * rays_ + j];
      const bool passed =
          t.before != t.after && compare(scene_, edge_, t.cut, from) != Sign::Positive;
      const Sign s = passed ? t.after : t.before;
      signs_[i * rays_ + j] = static_cast<std::int8_t>(s);
      signs_[j * rays_ + i] = static_cast<std::int8_t>(-s);
    }
  }
  for (std::size_t ray = 0; ray < rays_; ++ray) {
    if (!covered(ray)) return true;
  }
  return false;
}

}  // namespace sightline::internal
