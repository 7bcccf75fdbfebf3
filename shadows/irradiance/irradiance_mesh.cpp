#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "linespace/work/parallel.h"
#include "shadows/irradiance.h"
#include "shadows/irradiance/mesh_triangles.h"

namespace sightline {

using namespace internal;

namespace {

using Barycentric = Eigen::Vector3d;

// Nodes of a triangle: its corners, then the middles of the sides 01, 12 and 20.
using Nodes = std::array<double, 6>;

double interpolate(const Nodes& v, const Barycentric& b, int order) {
  if (order == 1) return b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    sum += b[i] * (2 * b[i] - 1) * v[i];
    sum += 4 * b[i] * b[(i + 1) % 3] * v[3 + i];
  }
  return sum;
}

Barycentric barycentric(const std::array<Eigen::Vector2d, 3>& t,
                        const Eigen::Vector2d& p) {
  const Eigen::Vector2d u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const double d = u.x() * v.y() - u.y() * v.x();
  const double b = (w.x() * v.y() - w.y() * v.x()) / d;
  const double c = (u.x() * w.y() - u.y() * w.x()) / d;
  return {1 - b - c, b, c};
}

// A triangle, or one that is cut into four: child i lies at corner i, child 3 between.
struct Leaf {
  Nodes values;
  double estimate;
  int children = -1;  // the first of four
};

// One triangle of the mesh with all that it is cut into; the first leaf is the whole.
struct Tree {
  std::array<Eigen::Vector2d, 3> corners;
  std::vector<Leaf> leaves;
};

// The child in which a point lies; its place becomes that in the child.
int descend(Barycentric& b) {
  for (int i = 0; i < 3; ++i) {
    if (b[i] < 0.5) continue;
    b *= 2;
    b[i] -= 1;
    return i;
  }
  // The child between has its corners at the middles of 01, 12 and 20.
  b = Barycentric(1 - 2 * b[2], 1 - 2 * b[0], 1 - 2 * b[1]);
  return 3;
}

// Places of the three corners of a child, in its parent's coordinates.
std::array<Barycentric, 3> child_corners(const std::array<Barycentric, 3>& c, int child) {
  const std::array<Barycentric, 3> m{(c[0] + c[1]) / 2, (c[1] + c[2]) / 2,
                                     (c[2] + c[0]) / 2};
  if (child == 3) return m;
  std::array<Barycentric, 3> corners;
  corners[child] = c[child];
  corners[(child + 1) % 3] = m[child];
  corners[(child + 2) % 3] = m[(child + 2) % 3];
  return corners;
}

}  // namespace

struct IrradianceMesh::Impl {
  Impl(const Scene& scene, const BackprojectionIndex& light, const Receiver& receiver,
       const ShadowMesh& mesh, const IrradianceOptions& options, const Request& request)
      : scene_(&scene),
        light_(&light),
        options_(options),
        front_(receiver.front),
        frame_(mesh.frame) {
    if (options.order != 1 && options.order != 2)
      throw InvalidInput("irradiance is interpolated with order 1 or 2");
    for (const int f : receiver.faces) {
      if (scene.faces()[f].facet == mesh.facet) face_ = f;
    }
    if (face_ < 0) throw InvalidInput("the mesh is not of this receiver");
    Eigen::Matrix<double, 3, 2> axes;
    axes << frame_.x_axis, frame_.y_axis;
    to_frame_ = (axes.transpose() * axes).inverse() * axes.transpose();
    const MeshTriangles cut = mesh_triangles(mesh);
    const std::vector<double> values = node_values(mesh, cut, request);
    trees_.resize(cut.triangles.size());
    Stage stage(request, "triangles of the mesh");
    for_each_of(0, trees_.size(), trees_.size(), request, stage,
                [&](std::size_t t) { grow(mesh, cut.triangles[t], values, trees_[t]); });
    scene_ = nullptr;
    light_ = nullptr;
    for (const Tree& tree : trees_) {
      for (const Leaf& leaf : tree.leaves) {
        if (leaf.children < 0) largest_ = std::max(largest_, leaf.estimate);
        triangles_ += leaf.children < 0 ? 1 : 0;
      }
    }
    fill_cells();
  }

  [[nodiscard]] static bool is_dark(const ShadowMesh& mesh, const MeshTriangle& t) {
    return t.face >= 0 && mesh.faces[t.face].shadow == ShadowClass::Umbra;
  }

  // The exact value at a place of a triangle, from that triangle's side.
  [[nodiscard]] double exact(const std::array<Eigen::Vector2d, 3>& corners,
                             const Barycentric& place) {
    const Barycentric b =
        place + 0x1p-26 * (Barycentric::Constant(1.0 / 3) - place).eval();
    const Eigen::Vector2d p = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
    const Point at = frame_.origin + p.x() * frame_.x_axis + p.y() * frame_.y_axis;
    ++asked_;
    return light_->from(shadow_point_on_face(*scene_, face_, at, front_))
        .form_factor.value_or(0);
  }

  // Each node once, from the first triangle that has it.
  std::vector<double> node_values(const ShadowMesh& mesh, const MeshTriangles& cut,
                                  const Request& request) {
    std::vector<double> values(cut.node_count, 0);
    std::vector<std::array<int, 2>> first(cut.node_count, {-1, -1});
    for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
      if (is_dark(mesh, cut.triangles[t])) continue;
      for (int i = 0; i < 6; ++i)
        first[cut.triangles[t].nodes[i]] = {static_cast<int>(t), i};
    }
    Stage stage(request, "nodes of the mesh");
    for_each_of(0, values.size(), values.size(), request, stage, [&](std::size_t n) {
      const auto [t, i] = first[n];
      if (t < 0) return;
      Barycentric place = Barycentric::Unit(i % 3);
      if (i >= 3) place = (place + Barycentric::Unit((i + 1) % 3)) / 2;
      values[n] = exact(cut.triangles[t].corners, place);
    });
    return values;
  }

  void grow(const ShadowMesh& mesh, const MeshTriangle& triangle,
            const std::vector<double>& values, Tree& tree) {
    tree.corners = triangle.corners;
    Leaf whole{{}, 0};
    for (int i = 0; i < 6; ++i) whole.values[i] = values[triangle.nodes[i]];
    tree.leaves.push_back(whole);
    if (is_dark(mesh, triangle)) return;
    refine(tree, 0, {Barycentric::Unit(0), Barycentric::Unit(1), Barycentric::Unit(2)},
           0);
  }

  // A multiple of the largest departure at points between the nodes.  Quadratics that
  // vanish at the corners are largest near the middles of sides.  The cubic x y (x - y)
  // is 3.1 times as large on its side as at the points asked.
  [[nodiscard]] double estimate(const Tree& tree, const Nodes& v,
                                const std::array<Barycentric, 3>& c) {
    double most = 0;
    const auto check = [&](const Barycentric& b) {
      const double value = exact(tree.corners, b[0] * c[0] + b[1] * c[1] + b[2] * c[2]);
      most = std::max(most, std::abs(value - interpolate(v, b, options_.order)));
    };
    if (options_.order == 1) {
      for (int i = 0; i < 3; ++i)
        most = std::max(most, std::abs(v[3 + i] - (v[i] + v[(i + 1) % 3]) / 2));
    } else {
      // Of the four cubics that vanish at all nodes these points tell each.
      check({0.5, 0.25, 0.25});
      check({0.25, 0.5, 0.25});
      check({0.25, 0.25, 0.5});
    }
    check({4.0 / 7, 2.0 / 7, 1.0 / 7});
    return (options_.order == 1 ? 2 : 4) * most;
  }

  void refine(Tree& tree, int leaf, const std::array<Barycentric, 3>& c, int depth) {
    const Nodes v = tree.leaves[leaf].values;
    tree.leaves[leaf].estimate = estimate(tree, v, c);
    if (tree.leaves[leaf].estimate <= options_.accuracy || depth >= options_.depth)
      return;
    const int children = static_cast<int>(tree.leaves.size());
    tree.leaves[leaf].children = children;
    tree.leaves.resize(tree.leaves.size() + 4);
    for (int k = 0; k < 4; ++k) {
      const auto at = child_corners(c, k);
      Nodes& values = tree.leaves[children + k].values;
      for (int i = 0; i < 3; ++i) {
        // Corners are nodes of the parent; middles are new.
        values[i] = k == 3             ? v[3 + i]
                    : i == k           ? v[k]
                    : i == (k + 1) % 3 ? v[3 + k]
                                       : v[3 + (k + 2) % 3];
        values[3 + i] = exact(tree.corners, (at[i] + at[(i + 1) % 3]) / 2);
      }
    }
    for (int k = 0; k < 4; ++k)
      refine(tree, children + k, child_corners(c, k), depth + 1);
  }

  // A grid with about as many cells as triangles; each lists those whose box meets it.
  void fill_cells() {
    if (trees_.empty()) return;
    low_ = trees_[0].corners[0];
    Eigen::Vector2d high = low_;
    for (const Tree& t : trees_) {
      for (const auto& p : t.corners) {
        low_ = low_.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    side_ = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(trees_.size()))));
    step_ = (high - low_) / side_;
    cells_.resize(static_cast<std::size_t>(side_) * side_);
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      const auto& c = trees_[t].corners;
      const auto from = cell(c[0].cwiseMin(c[1]).cwiseMin(c[2]));
      const auto to = cell(c[0].cwiseMax(c[1]).cwiseMax(c[2]));
      for (int y = from[1]; y <= to[1]; ++y) {
        for (int x = from[0]; x <= to[0]; ++x)
          cells_[y * side_ + x].push_back(static_cast<int>(t));
      }
    }
  }

  [[nodiscard]] std::array<int, 2> cell(const Eigen::Vector2d& p) const {
    std::array<int, 2> c;
    for (int i = 0; i < 2; ++i) {
      c[i] = std::clamp(static_cast<int>((p[i] - low_[i]) / step_[i]), 0, side_ - 1);
    }
    return c;
  }

  [[nodiscard]] std::optional<Value> at(const Point& point) const {
    if (trees_.empty()) return std::nullopt;
    const Eigen::Vector2d p = to_frame_ * (point - frame_.origin);
    const auto [x, y] = cell(p);
    // Between triangles that rounding parts the nearer one answers.
    double best = -1e-9;
    const Tree* found = nullptr;
    Barycentric place;
    for (const int t : cells_[y * side_ + x]) {
      const Barycentric b = barycentric(trees_[t].corners, p);
      if (!(b.minCoeff() > best)) continue;
      best = b.minCoeff();
      found = &trees_[t];
      place = b;
    }
    if (found == nullptr) return std::nullopt;
    int leaf = 0;
    while (found->leaves[leaf].children >= 0) {
      const int children = found->leaves[leaf].children;
      leaf = children + descend(place);
    }
    const Leaf& here = found->leaves[leaf];
    return Value{interpolate(here.values, place, options_.order), here.estimate};
  }

  const Scene* scene_;                // while this is made
  const BackprojectionIndex* light_;  // while this is made
  IrradianceOptions options_;
  bool front_;
  int face_ = -1;
  ShadowMesh::Frame frame_;
  Eigen::Matrix<double, 2, 3> to_frame_;  // from space
  std::vector<Tree> trees_;
  std::atomic<std::size_t> asked_ = 0;
  std::size_t triangles_ = 0;
  double largest_ = 0;
  Eigen::Vector2d low_, step_;
  int side_ = 0;
  std::vector<std::vector<int>> cells_;
};

IrradianceMesh::IrradianceMesh(const Scene& scene, const BackprojectionIndex& light,
                               const Receiver& receiver, const ShadowMesh& mesh,
                               const IrradianceOptions& options, const Request& request)
    : impl_(std::make_unique<Impl>(scene, light, receiver, mesh, options, request)) {}
IrradianceMesh::~IrradianceMesh() = default;
IrradianceMesh::IrradianceMesh(IrradianceMesh&&) noexcept = default;

std::optional<IrradianceMesh::Value> IrradianceMesh::at(const Point& p) const {
  return impl_->at(p);
}
std::size_t IrradianceMesh::triangle_count() const { return impl_->triangles_; }
std::size_t IrradianceMesh::exact_points() const { return impl_->asked_; }
double IrradianceMesh::largest_estimate() const { return impl_->largest_; }

}  // namespace sightline
