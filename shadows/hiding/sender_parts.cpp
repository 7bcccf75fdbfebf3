#include "shadows/hiding/sender_parts.h"

#include <algorithm>
#include <array>
#include <utility>

#include "linespace/space/shaft.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

double diagonal(const Box& box) {
  Eigen::Vector3d d;
  for (int i = 0; i < 3; ++i) d[i] = box.max[i] - box.min[i];
  return d.norm();
}

std::array<Point, 8> corners_of(const Box& box) {
  std::array<Point, 8> corners;
  for (int c = 0; c < 8; ++c) {
    for (int i = 0; i < 3; ++i)
      corners[c][i] = (c >> i & 1) != 0 ? box.max[i] : box.min[i];
  }
  return corners;
}

std::array<Box, 2> halves_of(const Box& box) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (box.max[i] - box.min[i] > box.max[axis] - box.min[axis]) axis = i;
  }
  std::array<Box, 2> parts{box, box};
  parts[0].max[axis] = parts[1].min[axis] = 0.5 * (box.min[axis] + box.max[axis]);
  return parts;
}

}  // namespace

SenderParts::SenderParts(const ConvexSolids& solids) : solids_(solids) {
  const int n = static_cast<int>(solids.size());
  for (int i = 0; i < n; ++i) mean_size_ += diagonal(solids.box(i)) / n;
}

bool SenderParts::is_large(const PreparedSide& side) const {
  return solids_.size() > static_cast<std::size_t>(kCrowd) &&
         diagonal(side.box) > 2 * mean_size_;
}

std::vector<SenderPart> SenderParts::of(const PreparedSide& side) const {
  constexpr std::size_t kMostParts = 1 << 14;
  std::vector<SenderPart> done, waiting;
  waiting.push_back({side, std::vector<char>(solids_.size(), 0)});
  while (!waiting.empty()) {
    SenderPart part = std::move(waiting.back());
    waiting.pop_back();
    find_hidden(part);
    const auto seen = std::ranges::count(part.hidden, 0);
    if (seen <= kCrowd || !is_large(part.side) ||
        done.size() + waiting.size() >= kMostParts) {
      done.push_back(std::move(part));
      continue;
    }
    for (const PointList& half : halves(part.side.polygon)) {
      if (half.size() >= 3 && area_of(half) > 0)
        waiting.push_back({part_of(part.side, half), part.hidden});
    }
  }
  return done;
}

// What lies behind the part's plane is not seen either.
void SenderParts::find_hidden(SenderPart& part) const {
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    hear_stop();
    if (part.hidden[i] != 0) continue;
    part.hidden[i] = is_hidden(part.side, static_cast<int>(i)) ? 1 : 0;
  }
}

bool SenderParts::is_hidden(const PreparedSide& from, int solid) const {
  constexpr int kCuts = 7;
  const Box& box = solids_.box(solid);
  const std::array<Point, 8> corners = corners_of(box);
  if (std::ranges::none_of(
          corners, [&](const Point& p) { return from.plane(p) == Sign::Positive; })) {
    return true;
  }
  std::vector<int> among;
  const Shaft shaft(from.box, box);
  solids_.tree().traverse([&](const Box& b) { return shaft.may_meet(b); },
                          [&](std::uint32_t i) {
                            if (static_cast<int>(i) != solid)
                              among.push_back(static_cast<int>(i));
                          });
  return hidden_by_parts(from.polygon, box, std::move(among), kCuts);
}

bool SenderParts::hidden_by_parts(const PointList& from, const Box& box,
                                  std::vector<int> among, int cuts) const {
  const std::array<Point, 8> corners = corners_of(box);
  if (std::ranges::any_of(among, [&](int i) { return solids_.hides(i, from, corners); }))
    return true;
  if (cuts == 0 || among.empty()) return false;
  const Box from_box = box_of(from);
  const auto next = [&](const PointList& part, const Box& part_box) {
    const Shaft shaft(box_of(part), part_box);
    std::vector<int> fewer;
    std::ranges::copy_if(among, std::back_inserter(fewer),
                         [&](int i) { return shaft.may_meet(solids_.box(i)); });
    return hidden_by_parts(part, part_box, std::move(fewer), cuts - 1);
  };
  if (diagonal(from_box) > diagonal(box)) {
    return std::ranges::all_of(halves(from),
                               [&](const PointList& p) { return next(p, box); });
  }
  return std::ranges::all_of(halves_of(box), [&](const Box& b) { return next(from, b); });
}

}  // namespace sightline::internal
