#include "linespace/space/opposite_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "linespace/space/bvh.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {
namespace {

using FlatChord = std::array<Point, 2>;

// The directions from the viewpoint to the edge's ends.  A coordinate is rounded in the
// difference, thrice in the norm and in the quotient.
FlatChord chord_of(const Point& at, const std::array<Point, 2>& edge) {
  return {(edge[0] - at).normalized(), (edge[1] - at).normalized()};
}
constexpr double kChordError = 16 * kUnit;

// Around all directions to points of the edge: the chord's points made longer, by 1 / |m|
// at most, with m its middle.  Each coordinate of m is off by kChordError and a rounding,
// so |m| by sqrt(3) times that and its own roundings: less than 3 kChordError in all.
Box box_of_directions(const FlatChord& chord) {
  Box box = box_of(chord);
  const double shortest = 0.5 * (chord[0] + chord[1]).norm() - 3 * kChordError;
  const double longer = shortest > 0 ? (1 + kChordError) / shortest
                                     : std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    box.min[i] -= kChordError;
    box.max[i] += kChordError;
    if (box.min[i] < 0) box.min[i] = std::max(box.min[i] * longer, -1 - kChordError);
    if (box.max[i] > 0) box.max[i] = std::min(box.max[i] * longer, 1 + kChordError);
  }
  return box;
}

// One and the mirror image of the other have a point in common.
bool mirrored_boxes_meet(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.min[i] > -b.min[i] || a.max[i] < -b.max[i]) return false;
  }
  return true;
}

// The cone opposite that of a viewpoint and an edge.
class OppositeCone {
 public:
  OppositeCone(const Point& at, const std::array<Point, 2>& edge)
      : own_(plane_from(at, edge[0], edge[1])) {
    const Point above = at + (edge[0] - at).cross(edge[1] - at);
    // Rounding may have lost which side it is on.
    const Point up = above - at;
    const std::array<double, 3> c{up[0], up[1], up[2]};
    sides_ = own_.positive_on(c, {0, 0, 0});
    if (!sides_) return;
    first_ = plane_from(at, edge[0], above);
    second_ = plane_from(at, edge[1], above);
  }

  /// False proves that no point of a chord is in it.  With the edge's ends u and w seen
  /// from the viewpoint, the first plane is negative at w and the second positive at u:
  /// at -a u - b w, with a and b positive, it is the other way round.
  [[nodiscard]] bool may_meet(const FlatChord& chord) const {
    const std::array<double, 3> p{chord[0][0], chord[0][1], chord[0][2]};
    const std::array<double, 3> q{chord[1][0], chord[1][1], chord[1][2]};
    constexpr std::array<double, 3> off{kChordError, kChordError, kChordError};
    if (own_.negative_on(p, off) && own_.negative_on(q, off)) return false;
    if (own_.positive_on(p, off) && own_.positive_on(q, off)) return false;
    return !sides_ || !((first_.negative_on(p, off) && first_.negative_on(q, off)) ||
                        (second_.positive_on(p, off) && second_.positive_on(q, off)));
  }

 private:
  BoundedPlane own_, first_, second_;
  bool sides_;
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> opposite_edges(
    const Point& viewpoint, std::span<const std::array<Point, 2>> edges) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::vector<FlatChord> chords;
  std::vector<Box> boxes;
  std::vector<OppositeCone> cones;
  chords.reserve(edges.size());
  boxes.reserve(edges.size());
  cones.reserve(edges.size());
  for (const auto& e : edges) {
    chords.push_back(chord_of(viewpoint, e));
    boxes.push_back(box_of_directions(chords.back()));
    cones.emplace_back(viewpoint, e);
  }
  const Bvh tree(boxes);
  if (tree.empty()) return pairs;
  const auto add_items = [&](const Bvh::Node& a, const Bvh::Node& b) {
    for (std::uint32_t k = 0; k < a.count; ++k) {
      const std::uint32_t i = tree.items()[a.first + k];
      for (std::uint32_t l = &a == &b ? k + 1 : 0; l < b.count; ++l) {
        const std::uint32_t j = tree.items()[b.first + l];
        if (!mirrored_boxes_meet(boxes[i], boxes[j])) continue;
        if (!cones[i].may_meet(chords[j]) || !cones[j].may_meet(chords[i])) continue;
        pairs.emplace_back(std::min(i, j), std::max(i, j));
      }
    }
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [m, n] = stack.back();
    stack.pop_back();
    const Bvh::Node& a = tree.node(m);
    const Bvh::Node& b = tree.node(n);
    if (!mirrored_boxes_meet(a.box, b.box)) continue;
    if (a.count > 0 && b.count > 0) {
      add_items(a, b);
    } else if (m == n) {
      stack.insert(
          stack.end(),
          {{a.first, a.first}, {a.first, a.first + 1}, {a.first + 1, a.first + 1}});
    } else if (b.count > 0 || (a.count == 0 && m < n)) {  // nearer to the root: larger
      stack.insert(stack.end(), {{a.first, n}, {a.first + 1, n}});
    } else {
      stack.insert(stack.end(), {{m, b.first}, {m, b.first + 1}});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace sightline::internal
