// Irradiance interpolated over a discontinuity mesh: one polynomial of degree 1 or 2 on
// each triangle of the mesh's faces.
//
//   const Shadows shadows = find_shadows(scene, source, {ground});
//   const BackprojectionIndex light(scene, source);
//   const IrradianceMesh mesh(scene, light, ground, shadows.receivers[0].meshes[0]);
//   if (const auto here = mesh.at({1, 2, 0})) std::cout << here->value << '\n';
//
// What is proved: in faces of umbra the value is 0, and nodes have the exact value of a
// point that lies 2^-26 of its distance from the middle of the triangle nearer to it: the
// limit from the triangle's own side, so that jumps at feet of blockers are kept.
// What is estimated: the error between the nodes.  It is twice (order 1) or four
// times (order 2) the largest departure from exact values at points between them.  A
// triangle is cut until that is small enough.
// Curved edges are replaced by the chords of their polylines: between chord and curve the
// neighbour's polynomial answers, and the estimate does not know of that.
//
// Heckbert, Discontinuity meshing for radiosity, 1992.
// Neighbours: shadow_mesh.h finds the mesh; backprojection.h has the exact values.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "linespace/request.h"
#include "shadows/backprojection.h"
#include "shadows/shadow_mesh.h"

namespace sightline {

struct IrradianceOptions {
  int order = 2;  ///< degree of the polynomials, 1 or 2
  /// Of the form factor: triangles are cut until their estimate is at most that.
  double accuracy = 1e-4;
  int depth = 5;  ///< at most so often is a triangle cut into four
};

/// Immutable; at() may be called from several threads.  Keeps no reference.
class IrradianceMesh {
 public:
  /// mesh: of this receiver.  Of the request threads, budget, stop and progress are
  /// heard.  Throws Stopped, and InvalidInput for an order other than 1 and 2 and for a
  /// mesh whose facet the receiver does not have.
  /// Cost: some points asked exactly for each triangle.
  IrradianceMesh(const Scene& scene, const BackprojectionIndex& light,
                 const Receiver& receiver, const ShadowMesh& mesh,
                 const IrradianceOptions& options = {}, const Request& request = {});
  ~IrradianceMesh();
  IrradianceMesh(IrradianceMesh&&) noexcept;

  struct Value {
    double value;     ///< form factor of the point to the source
    double estimate;  ///< of the error, as said above: not a bound
  };
  /// The point's foot in the plane of the facet; nullopt beside the facet.
  /// Cost: constant where triangles are of one size.
  [[nodiscard]] std::optional<Value> at(const Point& p) const;

  [[nodiscard]] std::size_t triangle_count() const;
  /// Points that were asked exactly.
  [[nodiscard]] std::size_t exact_points() const;
  /// The largest estimate of a triangle: above the accuracy where `depth` ended the cuts.
  [[nodiscard]] double largest_estimate() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
