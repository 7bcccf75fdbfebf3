#include "linespace/between/occluder_source.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "linespace/between/patch_growth.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Below this, looking at every box is cheaper than building a tree.
constexpr std::size_t kManyPolygons = 256;
// Up to this many, all are tried from the start.
constexpr std::size_t kFewPolygons = 1024;

double area_of(const Polygon& p) {
  Point normal = Point::Zero();
  for (std::size_t i = 2; i < p.size(); ++i) {
    normal += (p[i - 1] - p[0]).cross(p[i] - p[0]);
  }
  return normal.norm() / 2;
}

// The segment's ends as doubles, and how far these may be from the exact ones.
struct RoundedSegment {
  Point p, q;
  double slack;
};

Point rounded(const Triangle& t, const Weights& w) {
  return w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
}

// A weighted mean passes 5 roundings of numbers up to the largest coordinate.
RoundedSegment rounded(const SightSpace& space, const SightPoint& s) {
  double largest = 0;
  for (const Triangle* t : {&space.a(), &space.b()}) {
    for (const Point& x : *t) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  }
  return {rounded(space.a(), s.alpha), rounded(space.b(), s.beta), 8 * kUnit * largest};
}

// Slabs, widened by the slack and the roundings of the divisions: never wrong with "no".
bool may_meet(const RoundedSegment& s, const Box& box) {
  double low = 0, high = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = s.p[axis], step = s.q[axis] - from;
    const double wide =
        2 * s.slack + 8 * kUnit * (std::abs(box.min[axis]) + std::abs(box.max[axis]));
    const double near = box.min[axis] - wide - from, far = box.max[axis] + wide - from;
    if (std::abs(step) <= wide) {
      if (near > wide || far < -wide) return false;
      continue;
    }
    double enter = near / step, leave = far / step;
    if (step < 0) std::swap(enter, leave);
    low = std::max(low, enter - 8 * kUnit * std::abs(enter));
    high = std::min(high, leave + 8 * kUnit * std::abs(leave));
    if (low > high) return false;
  }
  return true;
}

// Both ends are certainly on one side of the polygon's plane, or the line certainly
// passes outside one of its sides.  Moving p and q by the slack changes a determinant of
// differences up to `size` by at most 12 * slack * size^2 and terms of higher order.
bool certainly_misses(const RoundedSegment& s, const Polygon& polygon) {
  double size = (s.q - s.p).cwiseAbs().maxCoeff() + s.slack;
  for (const Point& x : polygon) {
    size = std::max(
        {size, (x - s.p).cwiseAbs().maxCoeff(), (x - s.q).cwiseAbs().maxCoeff()});
  }
  const double moved = 16 * s.slack * size * size;
  const auto sign = [&](const BoundedValue& v) {
    return std::abs(v.value) > v.error + moved ? (v.value > 0 ? 1 : -1) : 0;
  };
  const int at_p = sign(orient3d_value(polygon[0], polygon[1], polygon[2], s.p));
  const int at_q = sign(orient3d_value(polygon[0], polygon[1], polygon[2], s.q));
  if (at_p != 0 && at_p == at_q) return true;
  if (at_p == 0 || at_q == 0) return false;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    // Inside is -at_p, as in SightSpace::add.
    if (sign(orient3d_value(s.p, s.q, polygon[i], polygon[(i + 1) % n])) == at_p) {
      return true;
    }
  }
  return false;
}

}  // namespace

OccluderSet::OccluderSet(std::vector<Polygon> polygons) : polygons_(std::move(polygons)) {
  boxes_.reserve(polygons_.size());
  for (const Polygon& p : polygons_) {
    hear_stop();
    boxes_.push_back(box_of(p));
  }
  if (polygons_.size() > kManyPolygons) tree_.emplace(boxes_);
}

std::vector<int> OccluderSet::near(const SightSpace& space, const SightPoint& s) const {
  const RoundedSegment segment = rounded(space, s);
  std::vector<int> found;
  const auto visit = [&](std::size_t i) {
    if (!certainly_misses(segment, polygons_[i])) found.push_back(static_cast<int>(i));
  };
  if (tree_) {
    tree_->traverse([&](const Box& box) { return may_meet(segment, box); }, visit);
  } else {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (may_meet(segment, boxes_[i])) visit(i);
    }
  }
  return found;
}

std::vector<int> OccluderSet::meeting(const Box& box) const {
  std::vector<int> found;
  const auto meets = [&](const Box& other) { return boxes_meet(box, other); };
  const auto visit = [&](std::size_t i) { found.push_back(static_cast<int>(i)); };
  if (tree_) {
    tree_->traverse(meets, visit);
  } else {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (meets(boxes_[i])) visit(i);
    }
  }
  return found;
}

std::array<Point, 2> OccluderSet::ends(const Side& side) const {
  const Polygon& p = polygons_[side.polygon];
  return {p[side.corner], p[(side.corner + 1) % p.size()]};
}

void OccluderSet::index_sides() const {
  // The same for both directions.
  const auto hash = [](const std::array<Point, 2>& ends) {
    std::uint64_t sum = 0;
    for (const Point& x : ends) {
      std::uint64_t h = 0;
      for (const double c : x) {
        h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9e3779b97f4a7c15;
        h ^= h >> 32;
      }
      sum += h;
    }
    return sum;
  };
  for (std::size_t i = 0; i < polygons_.size(); ++i) {
    for (std::size_t k = 0; k < polygons_[i].size(); ++k) {
      const Side side{static_cast<int>(i), static_cast<int>(k)};
      sides_.push_back({hash(ends(side)), side});
    }
  }
  std::ranges::stable_sort(sides_, {}, &HashedSide::hash);
  first_side_.assign(polygons_.size(), {});
  std::size_t total = 0;
  for (std::size_t i = 0; i < polygons_.size(); ++i) {
    first_side_[i] = total;
    total += polygons_[i].size();
  }
  place_.resize(total);
  for (std::size_t n = 0; n < sides_.size(); ++n) {
    place_[first_side_[sides_[n].side.polygon] + sides_[n].side.corner] = n;
  }
}

std::optional<OccluderSet::Side> OccluderSet::neighbour(const Side& side) const {
  std::call_once(sides_indexed_, [this] { index_sides(); });
  const std::size_t place = place_[first_side_[side.polygon] + side.corner];
  std::size_t first = place, last = place;
  while (first > 0 && sides_[first - 1].hash == sides_[place].hash) --first;
  while (last + 1 < sides_.size() && sides_[last + 1].hash == sides_[place].hash) ++last;
  if (last - first != 1) return std::nullopt;
  const Side other = sides_[first == place ? last : first].side;
  const auto [u, v] = ends(side);
  const auto [x, y] = ends(other);
  if (other.polygon == side.polygon || !((u == x && v == y) || (u == y && v == x))) {
    return std::nullopt;
  }
  return other;
}

OccluderSource::OccluderSource(const OccluderSet& set, Numbers numbers,
                               std::function<bool(int)> skip)
    : set_(set), numbers_(numbers), skip_(std::move(skip)) {}

std::vector<int> OccluderSource::start(std::span<const int> known) {
  const std::size_t count = set_.polygons().size();
  in_space_.assign(count, false);
  in_patch_.assign(count, false);
  std::vector<int> first;
  if (count <= kFewPolygons) {
    for (std::size_t i = 0; i < count; ++i) first.push_back(static_cast<int>(i));
  } else {
    std::vector<bool> listed(count, false);
    for (const std::span<const int> list : {known, std::span<const int>(found_)}) {
      for (const int i : list) {
        if (!listed[i]) first.push_back(i);
        listed[i] = true;
      }
    }
  }
  if (skip_) std::erase_if(first, skip_);
  return first;
}

void OccluderSource::add(SightSpace& space, int i) {
  if (in_space_[i]) return;
  in_space_[i] = true;
  space.add(number(i), {number(i), set_[i]});
}

int OccluderSource::number(int i) {
  if (numbers_ == Numbers::AsInSet) return i;
  const auto [entry, is_new] = number_.try_emplace(i, static_cast<int>(found_.size()));
  if (is_new) found_.push_back(i);
  return entry->second;
}

void OccluderSource::add_patch(SightSpace& space, int i, const SightPoint& s) {
  constexpr std::size_t kMostPatches = 64;
  if (space.patches().size() >= kMostPatches) return;
  const std::vector<PatchGrowth::Member> members =
      PatchGrowth(set_, space, s, skip_).around(i);
  if (members.size() < 2) return;
  std::vector<Piece> pieces;
  for (const auto& [polygon, front] : members) {
    pieces.push_back({number(polygon), set_[polygon]});
  }
  std::vector<SightSpace::PatchPiece> patch;
  for (std::size_t k = 0; k < members.size(); ++k) {
    patch.push_back({{pieces[k].occluder, members[k].front}, &pieces[k]});
  }
  if (!space.add_patch(patch)) return;
  for (const auto& member : members) in_patch_[member.polygon] = true;
}

int OccluderSource::find_blocker(SightSpace& space, const SightPoint& s) {
  std::vector<std::pair<double, int>> candidates;
  for (const int i : set_.near(space, s)) {
    if (!in_space_[i] && !(skip_ && skip_(i))) {
      candidates.emplace_back(-area_of(set_[i]), i);
    }
  }
  // Large ones first: they hide most.
  std::ranges::sort(candidates);
  for (const auto& [area, i] : candidates) {
    const std::size_t before = space.blockers().size();
    add(space, i);
    for (std::size_t b = before; b < space.blockers().size(); ++b) {
      if (!space.blocks(space.blockers()[b], s)) continue;
      add_patch(space, i, s);
      return i;
    }
  }
  return -1;
}

}  // namespace sightline::internal
