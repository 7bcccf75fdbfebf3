// What of a view can make its next event: its edges, vertices and regions by the lines
// and points of the scene.

#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "linespace/path/path_scene.h"
#include "linespace/path/rounded_sight.h"
#include "linespace/visibility_map.h"

namespace sightline::internal {

/// Two lines, by the numbers of their whole lines: the nearer first.
using LinePair = std::pair<int, int>;

/// Keeps references to the scene and the view.
class SeenElements {
 public:
  SeenElements(const PathScene& scene, const PointView& view);

  /// Whole lines beside which something is seen to lie behind.
  [[nodiscard]] const auto& lines() const { return edges_of_line_; }
  /// Positions in PathScene::points() of seen corners and touches, and of what may be one
  /// of them.
  [[nodiscard]] const auto& points() const { return vertices_of_point_; }
  /// Lines that are seen to cross, one behind the other.
  [[nodiscard]] const auto& pairs() const { return vertices_of_pair_; }

  // Whether, as long as the structure stays and from an eye up to its end, the view shows
  // something just there.  True in doubt.

  /// A scene point that is in line with a nearer whole line: may it be seen there?
  [[nodiscard]] bool may_show_point(const RoundedEye& eye, int line, int point) const;
  /// Something at y that is in line with a nearer scene point: may it be seen there?
  [[nodiscard]] bool may_show_behind_point(int point, const Point& y) const;
  /// Something at y behind two lines that are seen to cross: may it be seen there?
  [[nodiscard]] bool may_show_behind_pair(const LinePair& pair, const Point& y) const;
  /// The facet is seen, or an edge of it is.
  [[nodiscard]] bool shows_facet(int facet) const;

 private:
  // The plane of the facet that is seen in a region.
  struct Plane {
    Eigen::Vector3d normal;  // towards the eye, of length 1
    Point at;
  };
  void add_vertices();
  void add_edges();
  [[nodiscard]] bool lies_behind(const MapEdge& edge, int line) const;
  [[nodiscard]] std::optional<Plane> plane(const MapRegion& region) const;
  [[nodiscard]] bool hides(int region, const Point& y) const;
  [[nodiscard]] std::optional<double> end(const RoundedEye& eye, int line,
                                          int vertex) const;
  [[nodiscard]] bool any_shows(const std::vector<int>& vertices, const Point& y) const;

  const PathScene* scene_;
  const PointView* view_;
  /// The eye is on the scene: what is in a plane of a face there is seen on its horizon,
  /// behind what hides all beside it.
  bool has_horizon_;
  std::vector<std::optional<Plane>> planes_;  // of regions
  std::vector<std::set<int>> regions_at_;     // by vertex
  std::vector<std::vector<int>> lines_at_;    // by vertex
  std::map<int, std::vector<int>> edges_of_line_, vertices_of_point_;
  std::map<LinePair, std::vector<int>> vertices_of_pair_;
  std::set<int> shown_lines_, shown_facets_;
};

}  // namespace sightline::internal
