#include "linespace/sight/line_probe.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "linespace/sight/free_segment.h"

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

struct Range {
  double from, to;  // positions on a line: 0 at a, 1 at b; empty if from > to
};

// A line through a and b, each off by at most `error`: where it passes boxes, and how far
// the free segment around both reaches at most.
class Outlook {
 public:
  Outlook(const Silhouettes& g, const Point& a, const Point& b, double error)
      : g_(g), a_(a), b_(b), error_(error), d_(b - a), length_(d_.norm()) {
    const auto& bounds = g.scene().bounds();
    for (int i = 0; i < 3; ++i) {
      size_ = std::max({size_, std::abs(bounds[0][i]), std::abs(bounds[1][i])});
    }
    // What the line is off by anywhere in the scene's box, and what the bounds below
    // round by (a few units in the last place of size, magnified likewise): generous.
    grow_ = (4 * error + 64 * kUnit * size_) * (1 + 4 * size_ / length_);
    inverse_ = d_.cwiseInverse();
  }

  [[nodiscard]] bool usable() const { return length_ > 4 * error_; }
  /// What lies there may be on the free segment, as far as looked.
  [[nodiscard]] bool matters(const Range& r) const {
    return r.from <= r.to && r.from <= free_.to && r.to >= free_.from;
  }

  // Calls take(face, range, met) for faces near the line, from the segment outwards, up
  // to where certain walls end it; faces for which skip(face) are no walls.
  template <class Skip, class Take>
  void look(Skip&& skip, Take&& take) {
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
        Entry near{node.first, range_in(tree.node(node.first).box)};
        Entry far{node.first + 1, range_in(tree.node(node.first + 1).box)};
        if (away(far.range) < away(near.range)) std::swap(near, far);
        if (matters(far.range)) stack[top++] = far;
        if (matters(near.range)) stack[top++] = near;
        continue;
      }
      for (std::uint32_t k = 0; k < node.count; ++k) {
        const int face = static_cast<int>(tree.items()[node.first + k]);
        if (skip(face)) continue;
        const Range range = range_in(g_.face_box(face));
        if (!matters(range)) continue;
        const Met how = met(g_.scene(), face, a_, b_, error_);
        take(face, range, how);
        if (how != Met::Crossed) continue;
        // The free segment ends at the latest where this wall does.
        if (range.from > 1) free_.to = std::min(free_.to, range.to);
        if (range.to < 0) free_.from = std::max(free_.from, range.from);
      }
    }
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  [[nodiscard]] Range range_in(const Box& box) const {
    Range range{-kInfinity, kInfinity};
    for (int i = 0; i < 3; ++i) {
      const double low = box.min[i] - grow_ - a_[i];
      const double high = box.max[i] + grow_ - a_[i];
      // Nearly parallel to the slab: it excludes the line only where a is far outside,
      // and says nothing of positions.
      if (std::abs(d_[i]) * (4 * size_) <= grow_ * length_) {
        const double sway = 4 * size_ / length_ * std::abs(d_[i]);
        if (low > sway || high < -sway) return Range{kInfinity, -kInfinity};
        continue;
      }
      const double p = low * inverse_[i];
      const double q = high * inverse_[i];
      range.from = std::max(range.from, std::min(p, q));
      range.to = std::min(range.to, std::max(p, q));
    }
    return range;
  }
  [[nodiscard]] static double away(const Range& r) {
    return std::max({0.0, r.from - 1, -r.to});
  }

  const Silhouettes& g_;
  const Point a_, b_;
  const double error_;
  const Point d_;
  const double length_;
  double size_ = 0, grow_ = 0;
  Point inverse_;
  Range free_{-kInfinity, kInfinity};
};

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
  Outlook outlook(g_, a, b, error);
  if (!outlook.usable()) return true;
  name(known);
  std::vector<Range> unsure;
  outlook.look([&](int face) { return named(face); },
               [&](int, const Range& range, Met how) {
                 if (how == Met::Unsure) unsure.push_back(range);
               });
  return std::ranges::any_of(unsure, [&](const Range& r) { return outlook.matters(r); });
}

std::vector<int> faces_near_free_segment(const Silhouettes& g, const Point& a,
                                         const Point& b) {
  // Each coordinate is rounded by half a unit in its last place.
  Outlook outlook(g, a, b, 2 * kUnit * (norm1(a) + norm1(b)));
  if (!outlook.usable()) return faces_near_line(g, a, b);
  std::vector<std::pair<int, Range>> near;
  outlook.look([](int) { return false; },
               [&](int face, const Range& range, Met how) {
                 if (how != Met::Missed) near.emplace_back(face, range);
               });
  std::vector<int> faces;
  for (const auto& [face, range] : near) {
    if (outlook.matters(range)) faces.push_back(face);
  }
  std::ranges::sort(faces);
  return faces;
}

std::vector<int> faces_near_line(const Silhouettes& g, const Point& a, const Point& b) {
  std::vector<int> found;
  const auto& bounds = g.scene().bounds();
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    size = std::max({size, std::abs(bounds[0][i]), std::abs(bounds[1][i])});
  }
  const Point d = b - a;
  const double grow =
      1024 * std::numeric_limits<double>::epsilon() * size * (1 + size / d.norm());
  // Each bound is rounded twice, relatively: generous, since a false hit costs little.
  constexpr double slack = 1024 * std::numeric_limits<double>::epsilon();
  g.face_tree().traverse(
      [&](const Box& box) {
        double t0 = -std::numeric_limits<double>::infinity();
        double t1 = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) {
          const double low = box.min[i] - grow - a[i];
          const double high = box.max[i] + grow - a[i];
          if (std::abs(d[i]) * size <= grow * d.norm()) {
            if (std::abs(d[i]) == 0 && (low > 0 || high < 0)) return false;
            continue;  // nearly parallel to the slab: no decision
          }
          const double p = low / d[i];
          const double q = high / d[i];
          t0 = std::max(t0, std::min(p, q));
          t1 = std::min(t1, std::max(p, q));
        }
        return t0 <= t1 + slack * (std::abs(t0) + std::abs(t1));
      },
      [&](std::uint32_t f) { found.push_back(static_cast<int>(f)); });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace sightline::internal
