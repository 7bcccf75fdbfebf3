// Irradiance over a discontinuity mesh: in closed form, and interpolated by one
// polynomial of degree 1 or 2 on each of many triangles, with a bound of the error.
//
//   const Shadows shadows = find_shadows(scene, source, {ground});
//   const BackprojectionIndex light(scene, source);
//   const IrradianceMesh mesh(scene, light, ground, shadows,
//   shadows.receivers[0].meshes[0]); if (const auto here = mesh.at({1, 2, 0})) std::cout
//   << here->value << '\n';
//
// In a face of the mesh the part of the light that is seen has the same sides everywhere,
// so its form factor is one formula, which costs less than a microsecond: order 0 answers
// by it.  Orders 1 and 2 cut faces into triangles until bounds of the formula's
// derivatives prove that the polynomial through its values is near enough.  Where they do
// not, as at the foot of a blocker's corner, the formula answers.
//
// docs/irradiance.md proves the bound, and says what it leaves out.
//
// Heckbert, Discontinuity meshing for radiosity, 1992.
// Neighbours: shadow_mesh.h finds the mesh; backprojection.h asks single points.

#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "linespace/request.h"
#include "shadows/backprojection.h"
#include "shadows/shadow_mesh.h"

namespace sightline {

struct IrradianceOptions {
  int order = 2;  ///< degree of the polynomials, 1 or 2; 0: closed forms alone
  /// Of the form factor: triangles are cut until their bound is at most that.
  double accuracy = 1e-5;
  /// Triangles smaller than this share of the facet's area are not cut.
  double smallest = 1e-5;
};

/// Immutable; at() may be called from several threads.  Keeps no reference.
class IrradianceMesh {
 public:
  /// mesh: one of `shadows`, of this receiver.  Of the request threads, budget, stop and
  /// progress are heard; the answer does not depend on threads.  Throws Stopped, and
  /// InvalidInput for an order other than 0, 1 and 2 and for a mesh whose facet the
  /// receiver does not have.
  /// Cost: a few microseconds for each triangle, of which a curved face has more.
  IrradianceMesh(const Scene& scene, const BackprojectionIndex& light,
                 const Receiver& receiver, const Shadows& shadows, const ShadowMesh& mesh,
                 const IrradianceOptions& options = {}, const Request& request = {});
  ~IrradianceMesh();
  IrradianceMesh(IrradianceMesh&&) noexcept;

  struct Value {
    double value;  ///< form factor of the point to the source
    double bound;  ///< of its error but for roundings, which are some 1e-14
  };
  /// The point's foot in the plane of the facet; nullopt beside the facet.
  /// Cost: constant where triangles are of one size.
  [[nodiscard]] std::optional<Value> at(const Point& p) const;

  /// What the mesh is made of.  Shares are of the area of its triangles.
  struct Statistics {
    std::size_t triangles = 0;     ///< that answer
    double largest_bound = 0;      ///< of any triangle
    double closed_form_share = 0;  ///< where the closed form answers
    /// Where the bound is above the accuracy: along curves of the mesh beside which the
    /// light changes too fast, and where there is no closed form.
    double above_accuracy_share = 0;
  };
  [[nodiscard]] const Statistics& statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
