// Positions on a segment of a path at which what is seen may change.

#pragma once

#include <map>
#include <set>
#include <vector>

#include "linespace/path/seen_elements.h"

namespace sightline::internal {

/// Something that lines up, from near to far.
struct Candidate {
  enum class Kind : std::uint8_t {
    LinePoint,  ///< whole line a, then point c
    PointLine,  ///< point a, then line c
    PairLine,   ///< whole lines a and b, then line c
    Plane,      ///< of facet a
    EyeOnLine   ///< the eye, moving in a plane of faces, comes to line a there
  };
  Kind kind;
  int a, b, c;
};

/// All candidates of the elements that were seen so far, by their exact positions.
/// Keeps references to the scene and the segment.
class PathCandidates {
 public:
  PathCandidates(const PathScene& scene, const SightPath& path);

  /// Adds what elements of a view can make that no view before it showed.
  void add(const SeenElements& seen);

  /// The candidate may change a view with these elements that goes on up to the root.
  [[nodiscard]] bool may_change(const Candidate& candidate, const PathRoot& root,
                                const SeenElements& seen) const;

  using ByRoot = std::map<PathRoot, std::vector<Candidate>>;
  [[nodiscard]] const ByRoot& by_root() const { return by_root_; }

 private:
  void add_planes();
  void add_plane(int face);
  void add_lines_in_plane(int face);
  void add_line(int whole_line);
  void add_point(int point);
  void add_pair(const LinePair& pair);
  [[nodiscard]] bool in_line(const RoundedEye& eye, int line, int point) const;
  [[nodiscard]] std::optional<Point> behind(const RoundedEye& eye, int line,
                                            const Point& x) const;
  [[nodiscard]] std::optional<Point> crossing(const RoundedEye& eye,
                                              const LinePair& pair) const;
  [[nodiscard]] bool in_line(const RoundedEye& eye, const LinePair& pair, int line) const;
  [[nodiscard]] bool before_eye(const RoundedEye& eye, const Point& from,
                                const Point& p) const;

  const PathScene* scene_;
  const SightPath* path_;
  std::set<int> lines_, points_;
  std::set<LinePair> pairs_;
  ByRoot by_root_;
};

}  // namespace sightline::internal
