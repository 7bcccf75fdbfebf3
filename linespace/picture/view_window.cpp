#include "linespace/picture/view_window.h"

#include <algorithm>
#include <utility>

namespace sightline::internal {

Window::Window(const EyeSpace& eye) : eye_(&eye) {
  const ViewLines lines = eye.scene().lines();
  for (std::size_t l = eye.scene().first_window_line(); l < lines.size(); ++l) {
    sides_.push_back(lines[l].ends);
  }
  if (sides_.empty()) return;
  // As the eye sees it all corners lie on one side of each side, and some not on it.
  bool left = true, right = true;
  for (const auto& [p, q] : sides_) {
    bool any = false;
    for (const auto& [r, next] : sides_) {
      const Sign s = eye.orient(p, q, r);
      left &= s != Sign::Negative;
      right &= s != Sign::Positive;
      any |= s != Sign::Zero;
    }
    if (!any) left = right = false;
  }
  if (left == right) {
    throw InvalidInput("the window: not a convex polygon that the eye sees an area of");
  }
  if (right) {
    for (auto& [p, q] : sides_) std::swap(p, q);
  }
}

void Window::add_cuts(int line, const LineCuts& cuts, std::vector<LineCut>& at) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  for (const auto& [p, q] : sides_) {
    const Sign at_a = eye_->orient(p, q, a);
    if (at_a != Sign::Zero && eye_->orient(p, q, b) == -at_a)
      at.push_back(cuts.at_side(p, q));
  }
}

std::array<bool, 2> Window::outside(int line, const LineCuts& cuts,
                                    const LineCut& from) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  std::array<bool, 2> out{};
  for (const auto& [p, q] : sides_) {
    const Sign at_a = eye_->orient(p, q, a), at_b = eye_->orient(p, q, b);
    if (at_a == Sign::Zero && at_b == Sign::Zero) {
      // Along the side: its inside is on the left, or, the other way round, on the right.
      for (const auto& [r, next] : sides_) {
        const Sign s = eye_->orient(a, b, r);
        if (s != Sign::Zero) out[s == Sign::Positive ? 1 : 0] = true;
      }
      continue;
    }
    Sign here = at_a == Sign::Zero ? at_b : at_a;
    if (at_a * at_b == Sign::Negative && cuts.compare(from, cuts.at_side(p, q)) >= 0)
      here = at_b;
    if (here == Sign::Negative) return {true, true};
  }
  return out;
}

bool Window::contains(const PicturePoint& p) const {
  return std::ranges::all_of(sides_, [&](const std::array<int, 2>& side) {
    return orient(PicturePoint(*eye_, side[0]), PicturePoint(*eye_, side[1]), p) !=
           Sign::Negative;
  });
}

}  // namespace sightline::internal
