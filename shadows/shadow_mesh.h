// Discontinuity meshes: the curves on a receiver along which the view of an area light
// changes, the faces between them, and of each face what of the light is seen there.
//
// All combinatorics are exact: which curves cross and in which order, which faces they
// bound, what is seen from each.  Points and areas are rounded, with stated bounds.
// What counts as an edge, of which kind, is defined in docs/shadows.md.
//
// Drettakis and Fiume, A fast shadow algorithm for area light sources using
// backprojection, 1994; Stewart and Ghali, Fast computation of shadow boundaries using
// spatial coherence and backprojections, 1994.
// Neighbours: backprojection.h answers for one point; light_source.h names the light.

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "linespace/request.h"
#include "shadows/light_seen.h"
#include "shadows/light_source.h"

namespace sightline {

/// What lines up as seen from the points of an edge; where several apply the first.
enum class ShadowEdgeKind : std::uint8_t {
  Boundary,  ///< the receiver's own outline
  Contact,   ///< a blocker or a source touches or cuts the receiver
  Plane,     ///< the plane of a source face cuts the receiver
  Face,      ///< two edges of one facet, which is seen edge-on
  EE,        ///< two other edges of one plane, seen along each other
  EV,
  EEE
};
inline constexpr int kShadowEdgeKinds = 7;

/// One facet of a receiver, with the curves on it.
struct ShadowMesh {
  int facet;
  /// A point (x, y) of the mesh is origin + x x_axis + y y_axis.
  struct Frame {
    Point origin;
    Eigen::Vector3d x_axis, y_axis;
  };
  struct Edge {
    ShadowEdgeKind kind;
    /// What lines up, in words: "edge 12", "vertex 3", "facet 7",
    /// "side 0 of source face 1".
    std::vector<std::string> generators;
    std::array<int, 2> ends;  ///< vertices; the same of a closed curve
    int left, right;          ///< faces; -1 outside of the receiver
    /// Irradiance's derivatives of lower order are continuous across it; nullopt for the
    /// boundary, and where the light is seen alike on both sides.
    std::optional<int> order;
    /// Coefficients of x^2, x y, y^2, x, y and 1, zero on the edge.
    std::array<double, 6> conic;
    std::vector<Eigen::Vector2d> polyline;  ///< from the first end to the second
  };
  struct Face {
    ShadowClass shadow;
    int structure;  ///< number in Shadows::structures
    double area;    ///< scene units squared
    /// Umbra that would be umbra if nothing blocked.
    bool away;
    Point inside;  ///< a point of it, rounded
  };
  Frame frame;
  std::vector<Eigen::Vector2d> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

/// What there is on all facets of one receiver.
struct ReceiverShadows {
  std::string name;
  double area = 0;  ///< of its facets, by itself
  /// Sums over faces of the meshes; each within area_error_bound.
  double umbra_area = 0, penumbra_area = 0, lit_area = 0;
  double away_area = 0;  ///< a part of umbra_area
  double area_error_bound = 0;
  /// Connected components of the umbra's interior, facet by facet.
  int umbra_components = 0;
  std::vector<ShadowMesh> meshes;
};

struct Shadows {
  std::vector<ReceiverShadows> receivers;
  /// What is seen of the light; boundaries as in Backprojection, without their corners.
  std::vector<std::vector<SeenBoundary>> structures;
  /// Receivers that were not done when the budget ended.
  std::vector<std::string> missing;
  [[nodiscard]] bool complete() const { return missing.empty(); }
};

/// Faces that receive light on one side: where the file lists them counter-clockwise, or
/// on the other.
struct Receiver {
  std::string name;
  std::vector<int> faces;  ///< scene faces, ascending
  bool front = true;
};

/// Receivers, in their order.  The request's threads, budget, stop and progress are
/// heard; when time is over, the receivers that are done are answered.  Throws Stopped
/// when nothing is.
[[nodiscard]] Shadows find_shadows(const Scene& scene, const LightSource& source,
                                   const std::vector<Receiver>& receivers,
                                   const Request& request = {});

}  // namespace sightline
