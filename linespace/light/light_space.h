// What all events of all sources in a scene share: points, lines, planes and edges in
// homogeneous coordinates, and where edges and faces meet in space.

#pragma once

#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "linespace/light/homogeneous.h"
#include "linespace/request.h"
#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// A face with its sides, in its own order.
struct LightFace {
  LightPlane plane;
  struct Side {
    const LightLine* line;
    bool forward;  ///< the line's ends are in the face's order
    bool seam;     ///< no edge: the facet goes on beyond it
  };
  std::vector<Side> sides;
  Box box;
};

/// An edge that lines can graze.
struct LightEdge {
  const LightLine* line;
  int edge;  ///< scene edge id; the smallest where edges of several objects coincide
  std::array<int, 2> points;
  std::vector<int> objects;  ///< ascending
  std::vector<int> facets;   ///< of the faces at the edge, ascending
  /// Faces whose planes bound the wedge of the two at the edge: a line from strictly
  /// behind both, or strictly in front of both, crosses the surface there and does not
  /// graze it.  -1: no such test.
  std::array<int, 2> wedge{-1, -1};
  std::vector<int> pierced_by;  ///< faces that the open edge passes through
};

/// A point in space where two edges cross, each inside the other.
struct EdgeTouch {
  std::array<int, 2> edges;  ///< positions in edges()
  LightPoint point;
};

/// Where two faces cross each other.
struct FaceCut {
  std::array<int, 2> faces;
  const LightLine* line;
};

/// Immutable; keeps a reference to the scene.
class LightSpace {
 public:
  /// Cost: n log n for n faces; of the request budget and stop are heard.  Throws
  /// Stopped.
  explicit LightSpace(const Scene& scene, const Request& request = {});

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const LightPoint& point(int id) const { return points_[id]; }
  [[nodiscard]] std::span<const LightFace> faces() const { return faces_; }
  [[nodiscard]] std::span<const LightEdge> edges() const { return edges_; }
  [[nodiscard]] const std::deque<EdgeTouch>& touches() const { return touches_; }
  [[nodiscard]] std::span<const FaceCut> crossings() const { return crossings_; }
  [[nodiscard]] const Bvh& face_tree() const { return *face_tree_; }
  /// Over edges().
  [[nodiscard]] const Bvh& edge_tree() const { return *edge_tree_; }
  [[nodiscard]] bool convex_solid(int object) const { return convex_[object] != 0; }
  /// At least the length of the diagonal of the scene's box, and any coordinate.
  [[nodiscard]] double size() const { return size_; }

 private:
  const LightLine* line_between(int p, int q);
  void add_faces();
  void add_edges();
  void find_touches();
  void find_pierced();

  const Scene& scene_;
  std::vector<LightPoint> points_;
  std::deque<LightLine> lines_;
  std::unordered_map<std::uint64_t, const LightLine*> line_of_;
  std::vector<LightFace> faces_;
  std::vector<LightEdge> edges_;
  std::deque<EdgeTouch> touches_;
  std::vector<FaceCut> crossings_;
  std::deque<LightPoint> crossing_points_;
  std::unique_ptr<Bvh> face_tree_, edge_tree_;
  std::vector<std::uint8_t> convex_;
  double size_ = 0;
};

/// No line from a point on the segment p0 p1 grazes the edge, for the faces at it.
[[nodiscard]] bool never_grazes(const LightSpace& space, const LightEdge& edge,
                                const LightPoint& p0, const LightPoint& p1);

}  // namespace sightline::internal
