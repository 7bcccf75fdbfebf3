#include "tests/support/naive_grid.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace sightline::testing {
namespace {

using Cell = std::array<int, 3>;

int axis_after(int k, int by) { return (k + by) % 3; }

}  // namespace

// Cells lie between neighbouring coordinates of corners; cell i of an axis begins at
// coordinate i - 1.  Everything outside is empty.
struct GridScene::Impl {
  std::array<std::vector<double>, 3> at;
  struct Rectangle {
    int normal;
    std::array<double, 3> low, high;
  };
  std::vector<std::vector<Rectangle>> groups;
  std::vector<bool> sheet;

  // Between which two coordinates, or at which one.
  struct Place {
    bool on;
    int index;  // of the coordinate, of the cell
  };
  [[nodiscard]] Place place(int axis, const Rational& x) const {
    const auto& c = at[axis];
    const auto i =
        std::lower_bound(c.begin(), c.end(), x,
                         [](double a, const Rational& b) { return Rational(a) < b; });
    const int index = static_cast<int>(i - c.begin());
    return {i != c.end() && Rational(*i) == x, index};
  }
  [[nodiscard]] double middle(int axis, int cell) const {
    const auto& c = at[axis];
    if (cell == 0) return c.front() - 1;
    if (cell == static_cast<int>(c.size())) return c.back() + 1;
    return 0.5 * (c[cell - 1] + c[cell]);
  }
  [[nodiscard]] bool covers(const Rectangle& r, int plane, const Cell& cell) const {
    if (r.low[r.normal] != at[r.normal][plane]) return false;
    for (int by = 1; by < 3; ++by) {
      const int k = axis_after(r.normal, by);
      const double x = middle(k, cell[k]);
      if (x < r.low[k] || x > r.high[k]) return false;
    }
    return true;
  }
  /// A face fills the side between the cell and the one before it on that axis.
  [[nodiscard]] bool opaque(int axis, const Cell& cell) const {
    if (cell[axis] == 0) return false;
    for (const auto& group : groups) {
      for (const Rectangle& r : group) {
        if (r.normal == axis && covers(r, cell[axis] - 1, cell)) return true;
      }
    }
    return false;
  }
  /// An odd number of a closed group's faces lies before the cell.
  [[nodiscard]] bool solid(const Cell& cell) const {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (sheet[g]) continue;
      bool inside = false;
      for (const Rectangle& r : groups[g]) {
        if (r.normal != 0) continue;
        for (int plane = 0; plane < cell[0]; ++plane) inside ^= covers(r, plane, cell);
      }
      if (inside) return true;
    }
    return false;
  }

  // The cell next to x towards those signs, x being at a coordinate on some axes.
  [[nodiscard]] Cell cell_towards(const Vec3& x, const std::array<int, 3>& sign) const {
    Cell cell;
    for (int k = 0; k < 3; ++k) {
      const Place p = place(k, x[k]);
      cell[k] = p.on ? p.index + (sign[k] > 0 ? 1 : 0) : p.index;
    }
    return cell;
  }
  // A face between the two cells next to x that differ in that axis's sign.
  [[nodiscard]] bool wall(const Vec3& x, std::array<int, 3> sign, int axis) const {
    sign[axis] = 1;
    return opaque(axis, cell_towards(x, sign));
  }
  // In the plane across an axis, among the quadrants that `sign` leaves open.
  [[nodiscard]] Met around(const Vec3& x, std::array<int, 3> sign, int axis,
                           const std::vector<Point>* own = nullptr) const {
    if (solid(cell_towards(x, sign))) return Met::None;
    const int b = axis_after(axis, 1);
    const int c = axis_after(axis, 2);
    // Steps from quadrant to quadrant, one way and the other, until a face is met.
    std::array<int, 2> steps{};
    bool own_seen = own == nullptr;
    for (int way = 0; way < 2; ++way) {
      std::array<int, 3> at_sign = sign;
      bool cross_b = (sign[b] == sign[c]) == (way == 0);
      while (steps[way] < 4) {
        const int k = cross_b ? b : c;
        if (wall(x, at_sign, k)) {
          // The wall runs along the other axis, towards its sign.
          const int along = k == b ? c : b;
          for (std::size_t i = 0; own && i < own->size(); ++i) {
            own_seen =
                own_seen ||
                (Rational((*own)[i][k]) == x[k] &&
                 sgn(Rational(Rational((*own)[i][along]) - x[along])) == at_sign[along]);
          }
          break;
        }
        at_sign[k] = -at_sign[k];
        ++steps[way];
        cross_b = !cross_b;
      }
    }
    if (steps[0] == 4) return Met::None;  // no face at all
    const int quarters = std::min(4, steps[0] + steps[1] + 1);
    if (quarters == 2 || !own_seen) return Met::None;  // flat
    const bool goes_on = steps[0] >= 2 || steps[1] >= 2;
    return goes_on ? Met::Graze : Met::End;
  }
};

GridScene::GridScene(const PolygonSoup& soup) : impl_(std::make_unique<Impl>()) {
  for (const PolygonSoup::Group& group : soup.groups) {
    impl_->sheet.push_back(group.name.starts_with("sheet"));
    impl_->groups.emplace_back();
    for (const int f : group.faces) {
      Impl::Rectangle r{-1, {}, {}};
      for (int k = 0; k < 3; ++k) {
        r.low[k] = r.high[k] = soup.vertices[soup.polygons[f][0]][k];
        for (const int v : soup.polygons[f]) {
          r.low[k] = std::min(r.low[k], soup.vertices[v][k]);
          r.high[k] = std::max(r.high[k], soup.vertices[v][k]);
        }
        if (r.low[k] == r.high[k]) r.normal = k;
        impl_->at[k].push_back(r.low[k]);
        impl_->at[k].push_back(r.high[k]);
      }
      if (r.normal < 0 || soup.polygons[f].size() != 4) {
        throw std::invalid_argument("not a rectangle");
      }
      impl_->groups.back().push_back(r);
    }
  }
  for (auto& c : impl_->at) {
    std::ranges::sort(c);
    const auto repeated = std::ranges::unique(c);
    c.erase(repeated.begin(), repeated.end());
  }
}
GridScene::~GridScene() = default;
GridScene::GridScene(GridScene&&) noexcept = default;

GridScene::Met GridScene::at_edge(const Vec3& x, int axis, const Vec3& d,
                                  const std::vector<Point>& own) const {
  return impl_->around(x, {sgn(d[0]), sgn(d[1]), sgn(d[2])}, axis, &own);
}

GridScene::Met GridScene::at_corner(const Vec3& x, const Vec3& d) const {
  const std::array<int, 3> from{sgn(d[0]), sgn(d[1]), sgn(d[2])};
  if (impl_->solid(impl_->cell_towards(x, from))) return Met::None;
  // A line a little aside crosses the three planes in one of six orders.
  std::array<int, 3> order{0, 1, 2};
  do {
    std::array<int, 3> sign = from;
    bool passes = true;
    for (const int k : order) {
      passes = passes && !impl_->wall(x, sign, k);
      sign[k] = -sign[k];
    }
    if (passes) return Met::Graze;
  } while (std::ranges::next_permutation(order).found);
  // Lines drawn at x: along the six directions, where nothing is in front.
  int drawn = 0;
  bool straight = false;
  for (int k = 0; k < 3; ++k) {
    int on_axis = 0;
    for (const int side : {-1, 1}) {
      std::array<int, 3> sign = from;
      if (side != from[k] && impl_->wall(x, from, k)) continue;
      sign[k] = side;
      on_axis += impl_->around(x, sign, k) != Met::None;
    }
    drawn += on_axis;
    straight = straight || on_axis == 2;
  }
  return drawn == 0 || (drawn == 2 && straight) ? Met::None : Met::End;
}

std::optional<bool> GridScene::is_free(const Vec3& a, const Vec3& b,
                                       const Vec3* passing) const {
  const Vec3 d = b - a;
  bool free = true;
  for (int k = 0; k < 3; ++k) {
    if (sgn(d[k]) == 0) return std::nullopt;
    for (std::size_t i = 0; i < impl_->at[k].size(); ++i) {
      const Rational t = (Rational(impl_->at[k][i]) - a[k]) / d[k];
      if (t <= 0 || t >= 1) continue;
      const Vec3 x = a + t * d;
      if (passing && x == *passing) continue;
      Cell cell;
      cell[k] = static_cast<int>(i) + 1;
      for (int by = 1; by < 3; ++by) {
        const int j = axis_after(k, by);
        const Impl::Place p = impl_->place(j, x[j]);
        if (p.on) return std::nullopt;
        cell[j] = p.index;
      }
      free = free && !impl_->opaque(k, cell);
    }
  }
  return free;
}

}  // namespace sightline::testing
