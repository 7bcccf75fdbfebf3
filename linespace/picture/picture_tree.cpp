#include "linespace/picture/picture_tree.h"

#include <algorithm>
#include <cmath>

namespace sightline::internal {
namespace {

std::vector<Box> boxes_of(std::span<const PictureTree::Piece> pieces, bool is_direction) {
  std::vector<Box> boxes;
  boxes.reserve(pieces.size());
  for (const auto& [from, to] : pieces) {
    const LongVector &u = from->vector(), &v = to->vector();
    long double chord = 0;  // half of it, squared
    for (int i = 0; i < 3; ++i) chord += (u[i] - v[i]) * (u[i] - v[i]) / 4;
    // How far an arc of the unit sphere rises over its chord.
    const long double rise = is_direction ? 0 : 1 - std::sqrt(std::max(0.0L, 1 - chord));
    const auto slack = static_cast<double>(rise + from->error() + to->error());
    Box box;
    for (int i = 0; i < 3; ++i) {
      box.min[i] = static_cast<double>(std::min(u[i], v[i])) - slack;
      box.max[i] = static_cast<double>(std::max(u[i], v[i])) + slack;
    }
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace

PictureTree::PictureTree(std::span<const Piece> pieces, bool is_direction)
    : boxes_(boxes_of(pieces, is_direction)), tree_(boxes_) {}

}  // namespace sightline::internal
