#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "skeleton/line_probe_internal.h"

namespace sightline::internal {
namespace {

double norm1(const Point& p) { return p.cwiseAbs().sum(); }

enum class Met : std::uint8_t { Missed, Crossed, Unsure };

// The line passes all sides of a convex face on one hand iff it crosses the face.  A side
// g0 g1 has A . (B x E) with A = a - g0, B = b - g0, E = g1 - g0.  What a and b are off
// by changes it by at most |E| error (|A| + |B|), to first order; differences, products
// and sums round by at most 12 units in the last place of |A| |B| |E|.  Norms are sums of
// magnitudes, which are at least the lengths.  Doubled for what is left out.
Met met(const Scene& scene, int face, const Point& a, const Point& b, double error) {
  const auto corners = scene.face_points(face);
  const std::size_t n = corners.size();
  bool left = false;
  bool right = false;
  bool unsure = false;
  for (std::size_t k = 0; k < n; ++k) {
    const Point& g0 = scene.point(corners[k]);
    const Point from_a = a - g0;
    const Point from_b = b - g0;
    const Point along = scene.point(corners[(k + 1) % n]) - g0;
    const double value = from_a.dot(from_b.cross(along));
    const double size_a = norm1(from_a);
    const double size_b = norm1(from_b);
    const double bound =
        2 * norm1(along) * (error * (size_a + size_b) + 12 * kUnit * size_a * size_b);
    left |= value > bound;
    right |= value < -bound;
    unsure |= !(std::abs(value) > bound);
    if (left && right) return Met::Missed;
  }
  return unsure ? Met::Unsure : Met::Crossed;
}

}  // namespace

void LineProbe::name(std::span<const Generator> known) {
  const Scene& scene = g_.scene();
  objects_.clear();
  facets_.clear();
  for (const Generator& x : known) {
    if (x.kind == GeneratorKind::Vertex) {
      for (const int o : g_.objects_at(x.id)) objects_.push_back(o);
      const int star = g_.star_of_point(x.id);
      if (star >= 0) {
        const auto& own = g_.stars()[star].facets;
        facets_.insert(facets_.end(), own.begin(), own.end());
      }
    } else if (x.kind == GeneratorKind::Face) {
      objects_.push_back(scene.facets()[x.id].object);
      facets_.push_back(x.id);
    } else if (x.id >= 0) {
      const int ridge = g_.ridge_of_edge(x.id);
      objects_.push_back(scene.edges()[x.id].object);
      if (ridge >= 0) {
        for (const int o : g_.ridges()[ridge].objects) objects_.push_back(o);
      }
      for (const Edge::Side& s : scene.edges()[x.id].sides) {
        facets_.push_back(scene.faces()[s.face].facet);
      }
    }
  }
  std::erase_if(objects_, [&](int o) { return !g_.convex_solid(o); });
}

bool LineProbe::named(int face) const {
  const Face& f = g_.scene().faces()[face];
  return std::find(objects_.begin(), objects_.end(), f.object) != objects_.end() ||
         std::find(facets_.begin(), facets_.end(), f.facet) != facets_.end();
}

bool LineProbe::may_touch_more(const Point& a, const Point& b, double error,
                               std::span<const Generator> known) {
  name(known);
  unsure_.clear();
  const Point d = b - a;
  const double length = d.norm();
  if (!(length > 4 * error)) return true;
  const auto& bounds = g_.scene().bounds();
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    size = std::max({size, std::abs(bounds[0][i]), std::abs(bounds[1][i])});
  }
  // What the line is off by anywhere in the scene's box, and what the bounds below round
  // by (a few units in the last place of size, magnified likewise): generous.
  const double grow = (4 * error + 64 * kUnit * size) * (1 + 4 * size / length);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Point inverse = d.cwiseInverse();
  const auto range_in = [&](const Box& box) {
    Range range{-kInfinity, kInfinity};
    for (int i = 0; i < 3; ++i) {
      const double low = box.min[i] - grow - a[i];
      const double high = box.max[i] + grow - a[i];
      // Nearly parallel to the slab: it excludes the line only where a is far outside,
      // and says nothing of positions.
      if (std::abs(d[i]) * (4 * size) <= grow * length) {
        const double sway = 4 * size / length * std::abs(d[i]);
        if (low > sway || high < -sway) return Range{kInfinity, -kInfinity};
        continue;
      }
      const double p = low * inverse[i];
      const double q = high * inverse[i];
      range.from = std::max(range.from, std::min(p, q));
      range.to = std::min(range.to, std::max(p, q));
    }
    return range;
  };
  // The free segment ends at the latest where the nearest wall on either side does.
  Range free{-kInfinity, kInfinity};
  const auto matters = [&](const Range& r) {
    return r.from <= r.to && r.from <= free.to && r.to >= free.from;
  };
  const auto away = [](const Range& r) { return std::max({0.0, r.from - 1, -r.to}); };
  const Bvh& tree = g_.face_tree();
  struct Entry {
    std::uint32_t node;
    Range range;
  };
  std::array<Entry, 128> stack;
  int top = 0;
  if (!tree.empty()) stack[top++] = {0, range_in(tree.node(0).box)};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (!matters(entry.range)) continue;
    const Bvh::Node& node = tree.node(entry.node);
    if (node.count == 0) {
      // From the segment outwards, so that walls are met early.
      Entry near{node.first, range_in(tree.node(node.first).box)};
      Entry far{node.first + 1, range_in(tree.node(node.first + 1).box)};
      if (away(far.range) < away(near.range)) std::swap(near, far);
      if (matters(far.range)) stack[top++] = far;
      if (matters(near.range)) stack[top++] = near;
      continue;
    }
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const int face = static_cast<int>(tree.items()[node.first + k]);
      if (named(face)) continue;
      const Range range = range_in(g_.face_box(face));
      if (!matters(range)) continue;
      const Met how = met(g_.scene(), face, a, b, error);
      if (how == Met::Unsure) unsure_.push_back(range);
      if (how != Met::Crossed) continue;
      if (range.from > 1) free.to = std::min(free.to, range.to);
      if (range.to < 0) free.from = std::max(free.from, range.from);
    }
  }
  return std::any_of(unsure_.begin(), unsure_.end(), matters);
}

}  // namespace sightline::internal
