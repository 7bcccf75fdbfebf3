// What can line up on any path through a scene: its lines, and the points in space where
// lines end or touch.

#pragma once

#include <map>
#include <span>
#include <vector>

#include "linespace/path/sight_path.h"
#include "linespace/picture/view_scene.h"

namespace sightline::internal {

/// A point in space where lines end or touch.
struct ScenePoint {
  PathPoint at;
  int id;                  ///< of the scene; -1 for others
  std::vector<int> lines;  ///< that end here or pass here, ascending
};

/// Immutable.  Keeps a reference to the scene.
class PathScene {
 public:
  /// `size`: the largest magnitude of all coordinates, eyes included.  Cost: n log n for
  /// n lines, few of which touch each other.
  PathScene(const ViewScene& scene, double size);

  [[nodiscard]] const ViewScene& scene() const { return *scene_; }
  /// The largest magnitude of all coordinates, eyes included.
  [[nodiscard]] double size() const { return size_; }

  /// Lines as in scene().lines().
  [[nodiscard]] std::span<const PathLine> lines() const { return lines_; }
  /// The lines that have this name, ascending; all but sides of bent facets have one.
  [[nodiscard]] std::span<const int> lines_of(const MapLine& name) const;
  /// Where a whole line begins and ends, as ratios on the line whose number it has: 0 and
  /// 1 are that line's own ends.
  [[nodiscard]] std::array<double, 2> range(int whole_line) const {
    return ranges_[whole_line];
  }

  [[nodiscard]] std::span<const ScenePoint> points() const { return points_; }
  /// Positions in points() that lie on the line, ends included.
  [[nodiscard]] std::span<const int> points_on(int line) const {
    return points_on_[line];
  }
  /// The position in points() of a point of the scene; -1 where no line ends.
  [[nodiscard]] int point_of(int id) const { return point_of_[id]; }

 private:
  void add_lines();
  void add_touches();
  void touch(int line, int other, std::map<ExactPoint, int>& numbers);
  int add_point(const ExactPoint& p, int id, std::map<ExactPoint, int>& numbers);

  const ViewScene* scene_;
  double size_;
  std::vector<PathLine> lines_;
  std::map<MapLine, std::vector<int>> named_;
  std::vector<std::array<double, 2>> ranges_;
  std::vector<ScenePoint> points_;
  std::vector<std::vector<int>> points_on_;
  std::vector<int> point_of_;
};

}  // namespace sightline::internal
