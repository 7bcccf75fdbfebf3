#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "linespace/work/parallel.h"
#include "shadows/irradiance.h"
#include "shadows/irradiance/element_tree.h"
#include "shadows/irradiance/mesh_triangles.h"
#include "shadows/irradiance/triangle_grid.h"

namespace sightline {

using namespace internal;

namespace {

// Of the accuracy, what a chord in place of a curve may add to the error.
constexpr double kChordShare = 1.0 / 16;

// A face of the receiver in whose plane the mesh lies: of a facet that rounding has bent
// the nearest one.
int face_of(const Scene& scene, const Receiver& receiver, const ShadowMesh& mesh) {
  int best = -1;
  double nearest = Majorant::kUnknown;
  for (const int f : receiver.faces) {
    if (scene.faces()[f].facet != mesh.facet) continue;
    const auto t = plane_points(scene, f);
    const Point a = scene.point(t[0]);
    const Eigen::Vector3d normal =
        (scene.point(t[1]) - a).cross(scene.point(t[2]) - a).normalized();
    double off = 0;
    for (const Eigen::Vector2d& p : mesh.vertices) {
      const Point at =
          mesh.frame.origin + p.x() * mesh.frame.x_axis + p.y() * mesh.frame.y_axis;
      off = std::max(off, std::abs(normal.dot(at - a)));
    }
    if (off >= nearest) continue;
    nearest = off;
    best = f;
  }
  if (best < 0) throw InvalidInput("the mesh is not of this receiver");
  return best;
}

Eigen::Vector3d unit_normal(const Scene& scene, int face, bool front) {
  const auto t = plane_points(scene, face);
  const Point a = scene.point(t[0]);
  const Eigen::Vector3d n =
      (scene.point(t[1]) - a).cross(scene.point(t[2]) - a).normalized();
  return scene.turned(face) == front ? Eigen::Vector3d(-n) : n;
}

}  // namespace

struct IrradianceMesh::Impl {
  Impl(const Scene& scene, const BackprojectionIndex& light, const Receiver& receiver,
       const Shadows& shadows, const ShadowMesh& mesh, const IrradianceOptions& options,
       const Request& request)
      : options_(options), frame_(mesh.frame) {
    if (options.order < 0 || options.order > 2)
      throw InvalidInput("irradiance is interpolated with order 0, 1 or 2");
    const int face = face_of(scene, receiver, mesh);
    normal_ = unit_normal(scene, face, receiver.front);
    Eigen::Matrix<double, 3, 2> axes;
    axes << frame_.x_axis, frame_.y_axis;
    to_frame_ = (axes.transpose() * axes).inverse() * axes.transpose();
    make_formulas(light.source_scene(), face, shadows, mesh);
    find_triangles(mesh);
    make_trees(request);
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      if (!trees_[t].pieces.empty()) continue;
      trees_[t] = sampled(corners_[t], [&](const Eigen::Vector2d& p) {
        return light.from(shadow_point_on_face(scene, face, lift(p), receiver.front))
            .form_factor.value_or(0);
      });
    }
    count();
    grid_ = TriangleGrid(corners_);
  }

  [[nodiscard]] Point lift(const Eigen::Vector2d& p) const {
    return frame_.origin + p.x() * frame_.x_axis + p.y() * frame_.y_axis;
  }

  [[nodiscard]] double area(const Corners& t) const {
    const Point a = lift(t[0]);
    return 0.5 * (lift(t[1]) - a).cross(lift(t[2]) - a).norm();
  }

  // One for each structure of the mesh's faces.
  void make_formulas(const SourceScene& source, int face, const Shadows& shadows,
                     const ShadowMesh& mesh) {
    FormulaMaker maker(source, face);
    std::map<int, int> numbers;
    for (const ShadowMesh::Face& f : mesh.faces) {
      const auto [it, is_new] =
          numbers.try_emplace(f.structure, static_cast<int>(formulas_.size()));
      if (is_new) formulas_.push_back(maker.formula(shadows.structures[f.structure]));
      formula_of_face_.push_back(it->second);
    }
  }

  // Between a chord and its curve the formula of the one side answers where that of the
  // other should.  On the curve the two agree, with all derivatives below the order: they
  // differ by at most that derivative's bounds times that power of the distance.
  [[nodiscard]] double chord_error(const MeshChord& chord) const {
    if (chord.height == 0 || chord.left < 0 || chord.right < 0 || chord.order == 0)
      return 0;
    const Point from = lift(chord.from), to = lift(chord.to);
    // No length of the plane is longer than so many times that in the frame.
    const double height =
        chord.height * std::hypot(frame_.x_axis.norm(), frame_.y_axis.norm());
    // A circle around both.
    const double radius = 0.5 * (to - from).norm() + height;
    Eigen::Matrix<double, 3, 2> axes;
    axes.col(0) = radius * (to - from).normalized();
    axes.col(1) = normal_.cross(to - from).normalized() * radius;
    double sum = 0;
    for (const int face : {chord.left, chord.right}) {
      const auto& formula = formulas_[formula_of_face_[face]];
      if (!formula) return 1;
      const Majorant bound = formula->bound(0.5 * (from + to), axes, normal_);
      sum += bound.a[chord.order] * std::pow(height / radius, chord.order);
    }
    return std::min(sum, 1.0);
  }

  void find_triangles(const ShadowMesh& mesh) {
    const auto chords =
        mesh_chords(mesh, kChordShare * options_.accuracy,
                    [&](const MeshChord& chord) { return chord_error(chord); });
    for (const MeshTriangle& t : mesh_triangles(chords)) {
      corners_.push_back(t.corners);
      area_ += area(t.corners);
      chord_errors_.push_back(t.chord_error);
      formula_.push_back(t.face < 0 ? -1 : formula_of_face_[t.face]);
    }
  }

  void make_trees(const Request& request) {
    trees_.resize(corners_.size());
    const ElementCutter cutter(frame_, normal_,
                               {options_.order, (1 - kChordShare) * options_.accuracy,
                                options_.smallest * area_});
    Stage stage(request, "triangles of the mesh");
    for_each_of(0, trees_.size(), trees_.size(), request, stage, [&](std::size_t t) {
      if (formula_[t] >= 0 && formulas_[formula_[t]])
        trees_[t] = cutter.cut(*formulas_[formula_[t]], corners_[t]);
    });
  }

  // Exact values at the corners, from the triangle's own side.
  template <class Value>
  [[nodiscard]] static ElementTree sampled(const Corners& corners, Value&& value) {
    const Eigen::Vector2d middle = (corners[0] + corners[1] + corners[2]) / 3;
    ElementTree tree;
    ElementTree::Nodes nodes{};
    for (int i = 0; i < 3; ++i)
      nodes[i] = value(corners[i] + 0x1p-26 * (middle - corners[i]));
    tree.pieces.push_back({PieceKind::Sampled, 0, 0, 1});
    tree.values.push_back(nodes);
    return tree;
  }

  void count() {
    for (std::size_t t = 0; t < trees_.size(); ++t) count_piece(t, 0, area(corners_[t]));
    if (area_ == 0) return;
    statistics_.closed_form_share /= area_;
    statistics_.above_accuracy_share /= area_;
  }

  void count_piece(std::size_t t, int at, double area) {
    const ElementPiece& piece = trees_[t].pieces[at];
    if (piece.kind == PieceKind::Halved) {
      for (const int half : {0, 1}) count_piece(t, piece.next + half, area / 2);
      return;
    }
    const double bound = piece.bound + chord_errors_[t];
    ++statistics_.triangles;
    statistics_.largest_bound = std::max(statistics_.largest_bound, bound);
    if (piece.kind == PieceKind::ClosedForm) statistics_.closed_form_share += area;
    if (bound > options_.accuracy) statistics_.above_accuracy_share += area;
  }

  [[nodiscard]] std::optional<Value> at(const Point& point) const {
    const Eigen::Vector2d p = to_frame_ * (point - frame_.origin);
    auto found = grid_.find(p);
    if (!found) return std::nullopt;
    const ElementTree& tree = trees_[found->triangle];
    const ElementPiece& piece = tree.find(found->place);
    const double bound = piece.bound + chord_errors_[found->triangle];
    if (piece.kind == PieceKind::ClosedForm) {
      const SeenFormula& formula = *formulas_[formula_[found->triangle]];
      return Value{formula.value(lift(p), normal_), bound};
    }
    const int order = piece.kind == PieceKind::Sampled ? 1 : options_.order;
    return Value{polynomial(tree.values[piece.next], found->place, order), bound};
  }

  IrradianceOptions options_;
  ShadowMesh::Frame frame_;
  Eigen::Vector3d normal_;                // of the side that receives
  Eigen::Matrix<double, 2, 3> to_frame_;  // from space
  std::vector<std::optional<SeenFormula>> formulas_;
  std::vector<int> formula_of_face_;
  // By triangle:
  std::vector<Corners> corners_;
  std::vector<double> chord_errors_;
  std::vector<int> formula_;  // -1 where chords cross
  std::vector<ElementTree> trees_;
  double area_ = 0;  // of all
  Statistics statistics_;
  TriangleGrid grid_;
};

IrradianceMesh::IrradianceMesh(const Scene& scene, const BackprojectionIndex& light,
                               const Receiver& receiver, const Shadows& shadows,
                               const ShadowMesh& mesh, const IrradianceOptions& options,
                               const Request& request)
    : impl_(std::make_unique<Impl>(scene, light, receiver, shadows, mesh, options,
                                   request)) {}
IrradianceMesh::~IrradianceMesh() = default;
IrradianceMesh::IrradianceMesh(IrradianceMesh&&) noexcept = default;

std::optional<IrradianceMesh::Value> IrradianceMesh::at(const Point& p) const {
  return impl_->at(p);
}
const IrradianceMesh::Statistics& IrradianceMesh::statistics() const {
  return impl_->statistics_;
}

}  // namespace sightline
