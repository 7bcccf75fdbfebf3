#include "aspect/convex/convex_aspects.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <unordered_set>

#include "aspect/cells/inner_point.h"
#include "aspect/cells/space_bounds.h"
#include "aspect/cells/space_cells.h"
#include "aspect/cells/sphere_cells.h"
#include "aspect/sampled/sampled_aspects.h"
#include "aspect/views/sample_space.h"
#include "linespace/numbers/exact_position.h"
#include "linespace/point_view.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {
namespace {

/// Which facets a cell sees, whatever the projection.
class ConvexCells {
 public:
  ConvexCells(const ConvexSolid& solid, const AspectRequest& request) : solid_(&solid) {
    if (request.projection == Projection::Orthographic) {
      find_circles();
      sphere_.emplace(sphere_cells(normals_));
    } else {
      planes_ = solid.planes;
      if (request.bounds) bounds_ = add_bounds(planes_, *request.bounds);
      space_.emplace(space_cells(planes_, request));
    }
  }

  [[nodiscard]] const SignTable& table() const {
    return sphere_ ? sphere_->cells : space_->cells;
  }
  [[nodiscard]] const std::vector<LightPlane>& planes() const { return planes_; }
  /// The cell lies within the bounds, if there are any, and is not the solid itself.
  [[nodiscard]] bool counts(int cell) const {
    if (sphere_) return true;
    if (!within(space_->cells, cell, bounds_)) return false;
    for (std::size_t f = 0; f < solid_->planes.size(); ++f) {
      if (space_->cells.positive(cell, static_cast<int>(f))) return true;
    }
    return false;
  }
  [[nodiscard]] bool shows(int cell, int facet) const {
    if (space_) return space_->cells.positive(cell, facet);
    const auto& [circle, opposite] = circles_[facet];
    return sphere_->cells.positive(cell, circle) != opposite;
  }
  [[nodiscard]] const std::vector<CircleNormal>& normals() const { return normals_; }
  [[nodiscard]] const std::optional<SphereCells>& sphere() const { return sphere_; }
  [[nodiscard]] const std::optional<SpaceCells>& space() const { return space_; }
  /// Facets whose planes are one circle.
  [[nodiscard]] std::vector<int> facets_of(int surface) const {
    if (space_) return {surface};
    std::vector<int> out;
    for (std::size_t f = 0; f < circles_.size(); ++f) {
      if (circles_[f].circle == surface) out.push_back(static_cast<int>(f));
    }
    return out;
  }

 private:
  struct Circle {
    int circle;
    bool opposite;  // to the normal of the circle's first facet
  };

  void find_circles() {
    for (const LightPlane& plane : solid_->planes) {
      CircleNormal n = normal_of(plane);
      int same = -1;
      for (std::size_t c = 0; c < normals_.size() && same < 0; ++c) {
        if (parallel(normals_[c], n)) same = static_cast<int>(c);
      }
      if (same < 0) {
        circles_.push_back({static_cast<int>(normals_.size()), false});
        normals_.push_back(std::move(n));
        continue;
      }
      // Of a convex solid no two facets have one normal.
      circles_.push_back({same, true});
    }
  }
  static bool parallel(const CircleNormal& a, const CircleNormal& b) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const auto minor = [&](const auto& x, const auto& y) {
        return x[i] * y[j] - x[j] * y[i];
      };
      if (decide(minor(a.near, b.near), [&] { return minor(a.exact, b.exact); }) !=
          Sign::Zero) {
        return false;
      }
    }
    return true;
  }

  const ConvexSolid* solid_;
  std::vector<CircleNormal> normals_;
  std::vector<Circle> circles_;     // by facet
  std::vector<LightPlane> planes_;  // of facets, then of bounds
  std::vector<BoundSide> bounds_;
  std::optional<SphereCells> sphere_;
  std::optional<SpaceCells> space_;
};

struct Pair {
  int a, b;
};

class ConvexGraph {
 public:
  ConvexGraph(const Scene& scene, const ConvexSolid& solid, const AspectRequest& request)
      : scene_(&scene), solid_(&solid), request_(&request), cells_(solid, request) {
    const int n = cells_.table().size();
    number_.assign(n, -1);
    for (int c = 0; c < n; ++c) {
      if (cells_.counts(c)) number_[c] = aspects_++;
    }
  }

  AspectGraph graph() {
    AspectGraph out;
    out.method = AspectMethod::Exact;
    out.certified = true;
    out.aspects = out.distinct = out.by_visible_faces =
        static_cast<std::size_t>(aspects_);
    for (const Pair& p : walls()) out.adjacencies += p.a >= 0 && p.b >= 0 ? 1 : 0;
    if (const auto& space = cells_.space(); space && !request_->bounds) {
      std::size_t unbounded = 0;
      for (std::size_t c = 0; c < number_.size(); ++c)
        unbounded += space->unbounded[c] ? 1 : 0;
      out.unbounded = unbounded;
      out.bounded = out.aspects - unbounded;
    }
    out.by_shape = shapes();
    if (request_->list || request_->check > 0) list(out);
    if (request_->check > 0) {
      std::set<std::string> labels;
      for (const Aspect& a : out.list) labels.insert(a.structure);
      AspectRequest by_structure = *request_;
      by_structure.label = AspectLabel::Structure;
      out.check = check_labels(PointViewIndex(*scene_, *request_), by_structure, labels);
    }
    if (!request_->list) out.list.clear();
    return out;
  }

 private:
  [[nodiscard]] std::vector<Pair> walls() const {
    std::vector<Pair> out;
    const auto add = [&](const auto& all) {
      for (const auto& w : all) out.push_back({number_[w.negative], number_[w.positive]});
    };
    if (cells_.sphere()) add(cells_.sphere()->walls);
    if (cells_.space()) add(cells_.space()->walls);
    return out;
  }

  [[nodiscard]] std::size_t shapes() const {
    Stage stage(*request_, "shapes of aspects");
    std::vector<std::string> found(number_.size());
    for_each_of(0, number_.size(), number_.size(), *request_, stage, [&](std::size_t c) {
      if (number_[c] < 0) return;
      const auto cell = static_cast<int>(c);
      found[c] = shape_of(solid_->map_of([&](int f) { return cells_.shows(cell, f); }));
    });
    std::unordered_set<std::string> distinct;
    for (std::string& shape : found) {
      if (!shape.empty()) distinct.insert(std::move(shape));
    }
    return distinct.size();
  }

  void list(AspectGraph& out) {
    out.list.resize(out.aspects);
    for (std::size_t c = 0; c < number_.size(); ++c) {
      if (number_[c] < 0) continue;
      Aspect& aspect = out.list[number_[c]];
      for (std::size_t f = 0; f < solid_->planes.size(); ++f) {
        if (cells_.shows(static_cast<int>(c), static_cast<int>(f)))
          aspect.facets.push_back(static_cast<int>(f));
      }
    }
    add_neighbours(out);
    if (cells_.sphere()) place_on_sphere(out);
    if (cells_.space()) place_in_space(out);
    const PointViewIndex index(*scene_, *request_);
    Stage stage(*request_, "views of aspects");
    for_each_of(0, out.list.size(), out.list.size(), *request_, stage,
                [&](std::size_t i) {
                  out.list[i].structure = index.view(out.list[i].at).structure;
                });
    out.views = out.list.size();
  }

  void add_neighbours(AspectGraph& out) const {
    const auto add = [&](const auto& all, auto&& surface) {
      for (const auto& w : all) {
        const int a = number_[w.negative], b = number_[w.positive];
        if (a < 0 || b < 0) continue;
        AspectWall wall{PathEventKind::F, {}};
        for (const int f : cells_.facets_of(surface(w)))
          wall.generators.push_back({GeneratorKind::Face, f});
        out.list[a].neighbours.push_back({b, {wall}});
        out.list[b].neighbours.push_back({a, {wall}});
      }
    };
    if (cells_.sphere()) {
      add(cells_.sphere()->walls, [](const auto& w) { return w.circle; });
    } else {
      add(cells_.space()->walls, [](const auto& w) { return w.plane; });
    }
    for (Aspect& aspect : out.list)
      std::ranges::sort(aspect.neighbours, {}, &AspectNeighbour::aspect);
  }

  void place_on_sphere(AspectGraph& out) const {
    std::vector<std::vector<SphereArc>> arcs(out.aspects);
    for (const SphereCells::Wall& w : cells_.sphere()->walls) {
      const auto add = [&](int cell, bool positive) {
        arcs[number_[cell]].push_back({positive, &w});
      };
      add(w.negative, false);
      add(w.positive, true);
    }
    Stage stage(*request_, "viewpoints of aspects");
    for_each_of(0, arcs.size(), arcs.size(), *request_, stage, [&](std::size_t i) {
      const InnerDirection inner = inner_direction(cells_.normals(), arcs[i]);
      Aspect& aspect = out.list[i];
      aspect.at = {Viewpoint::Kind::Direction, exact_position(inner.at)};
      aspect.weight = inner.solid_angle;
      aspect.clearance = inner.clearance;
    });
  }

  void place_in_space(AspectGraph& out) const {
    std::vector<std::vector<SignedPlane>> sides(out.aspects);
    for (const SpaceCells::Wall& w : cells_.space()->walls) {
      const auto add = [&](int cell, bool positive) {
        if (number_[cell] >= 0)
          sides[number_[cell]].push_back({&cells_.planes()[w.plane], positive});
      };
      add(w.negative, false);
      add(w.positive, true);
    }
    const std::array<Point, 2> box = view_box(*scene_, *request_);
    Stage stage(*request_, "viewpoints of aspects");
    for_each_of(0, sides.size(), sides.size(), *request_, stage, [&](std::size_t i) {
      const InnerPoint inner = inner_point(sides[i], scene_->bounds());
      Aspect& aspect = out.list[i];
      aspect.at = {Viewpoint::Kind::Eye, exact_position(inner.at)};
      aspect.clearance = inner.clearance;
      aspect.weight = volume_in(box, sides[i]);
    });
  }

  const Scene* scene_;
  const ConvexSolid* solid_;
  const AspectRequest* request_;
  ConvexCells cells_;
  std::vector<int> number_;  // of aspects, by cell; -1: the solid
  int aspects_ = 0;
};

}  // namespace

AspectGraph convex_aspects(const Scene& scene, const ConvexSolid& solid,
                           const AspectRequest& request) {
  return ConvexGraph(scene, solid, request).graph();
}

}  // namespace sightline::internal
