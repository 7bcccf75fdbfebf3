#include "aspect/cells/sphere_cells.h"

#include <set>

#include "linespace/numbers/vectors.h"

namespace sightline::internal {
namespace {

class Circles {
 public:
  explicit Circles(std::span<const CircleNormal> normals)
      : normals_(normals), out_{SignTable(static_cast<int>(normals.size())), {}, 0} {}

  SphereCells find() {
    for (int i = 0; i < count(); ++i) walk(i);
    out_.vertices = vertices_.size();
    return std::move(out_);
  }

 private:
  // Where another circle crosses this one: at the direction normal x other normal, or
  // opposite to it, within half a turn from the first crossing.
  struct Crossing {
    int circle;
    bool opposite;
  };

  [[nodiscard]] int count() const { return static_cast<int>(normals_.size()); }

  // Positive: from the crossing with j to that with k it is less than half a turn,
  // counter-clockwise around normal i.
  [[nodiscard]] Sign turn(int i, int j, int k) const {
    const auto &a = normals_[i], &b = normals_[j], &c = normals_[k];
    return decide(dot(a.near, cross(b.near, c.near)),
                  [&] { return dot(a.exact, cross(b.exact, c.exact)); });
  }
  // Of normal i x normal j and normal k x normal l, which are parallel: the same way?
  [[nodiscard]] bool same_way(int i, int j, int k, int l) const {
    const auto product = [&](const auto& n) {
      return dot(n(i), n(k)) * dot(n(j), n(l)) - dot(n(i), n(l)) * dot(n(j), n(k));
    };
    return decide(product([&](int m) -> const auto& { return normals_[m].near; }), [&] {
             return product([&](int m) -> const auto& { return normals_[m].exact; });
           }) == Sign::Positive;
  }

  // All crossings within half a turn, in order; those in one point side by side.
  [[nodiscard]] std::vector<Crossing> crossings(int i) const {
    const int first = i == 0 ? 1 : 0;
    std::vector<Crossing> out;
    for (int j = 0; j < count(); ++j) {
      if (j == i) continue;
      const Sign s = j == first ? Sign::Positive : turn(i, first, j);
      const bool opposite =
          s == Sign::Zero ? !same_way(i, first, i, j) : s == Sign::Negative;
      out.push_back({j, opposite});
    }
    std::ranges::sort(out, [&](const Crossing& x, const Crossing& y) {
      const Sign s = turn(i, x.circle, y.circle);
      return (x.opposite == y.opposite ? s : -s) == Sign::Positive;
    });
    return out;
  }

  // The vertex by the first two circles through it.
  [[nodiscard]] SphereCells::Vertex vertex(int i, std::span<const Crossing> group,
                                           bool beyond) {
    std::vector<int> through{i};
    for (const Crossing& c : group) through.push_back(c.circle);
    std::ranges::sort(through);
    const int a = through[0], b = through[1], j = group.front().circle;
    const bool turned = !same_way(i, j, a, b);
    const bool opposite = (group.front().opposite != beyond) != turned;
    vertices_.insert({a, b, opposite ? 1 : 0});
    return {a, b, opposite};
  }

  void walk(int i) {
    const std::vector<Crossing> all = crossings(i);
    std::vector<std::span<const Crossing>> groups;
    for (std::size_t k = 0, next = 0; k < all.size(); k = next) {
      while (next < all.size() &&
             (next == k || turn(i, all[k].circle, all[next].circle) == Sign::Zero)) {
        ++next;
      }
      groups.emplace_back(all.data() + k, next - k);
    }
    // Beyond the first half-turn begins what lies opposite.  Counter-clockwise past
    // normal x other normal, the other circle's side changes from positive to negative.
    std::vector<SignTable::Word> signs(out_.cells.words(), 0);
    const auto set = [&](int j, bool positive) { SignTable::set(signs, j, positive); };
    for (const Crossing& c : all) set(c.circle, !c.opposite);
    std::vector<SphereCells::Vertex> at;
    for (const bool beyond : {false, true}) {
      for (const auto& group : groups) at.push_back(vertex(i, group, beyond));
    }
    const std::size_t half = groups.size();
    for (std::size_t k = 0; k < 2 * half; ++k) {
      for (const Crossing& c : groups[k % half]) set(c.circle, c.opposite != (k >= half));
      const int negative = out_.cells.number_with(signs, i, false);
      const int positive = out_.cells.number_with(signs, i, true);
      out_.walls.push_back({i, negative, positive, at[k], at[(k + 1) % (2 * half)]});
    }
  }

  std::span<const CircleNormal> normals_;
  SphereCells out_;
  std::set<std::array<int, 3>> vertices_;
};

}  // namespace

CircleNormal normal_of(const LightPlane& plane) {
  CircleNormal out;
  for (int i = 0; i < 3; ++i) {
    out.near[i] = plane.near[i];
    out.exact[i] = plane.exact[i];
  }
  return out;
}

SphereCells sphere_cells(std::span<const CircleNormal> normals) {
  return Circles(normals).find();
}

}  // namespace sightline::internal
