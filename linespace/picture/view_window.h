// The window through which a view looks: a convex polygon; beyond its sides nothing is
// seen.

#pragma once

#include <array>
#include <vector>

#include "linespace/picture/line_cut.h"
#include "linespace/picture/picture_point.h"

namespace sightline::internal {

/// Where the scene of the eye has no window, all is within.
class Window {
 public:
  /// Throws InvalidInput for a window that has no area from the eye, or is not convex.
  explicit Window(const EyeSpace& eye);

  [[nodiscard]] bool empty() const { return sides_.empty(); }
  [[nodiscard]] bool has(int line) const {
    return line >= eye_->scene().first_window_line();
  }
  /// Appends the positions at which the line is seen to cross the window's sides.
  void add_cuts(int line, const LineCuts& cuts, std::vector<LineCut>& at) const;
  /// The left and the right of a line, between two neighbouring of these positions, lie
  /// outside.
  [[nodiscard]] std::array<bool, 2> outside(int line, const LineCuts& cuts,
                                            const LineCut& from) const;
  [[nodiscard]] bool contains(const PicturePoint& p) const;

 private:
  const EyeSpace* eye_;
  std::vector<std::array<int, 2>> sides_;  // points, with the inside on the left
};

}  // namespace sightline::internal
