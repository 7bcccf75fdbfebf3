// Everything that a straight line meets in a scene, in order: layers of faces that lie on
// one another there, and between them air or the material of closed objects.

#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "linespace/line_sampling.h"
#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// A face met by a line.
struct LineHit {
  double at;  ///< position along the line
  int face;
  bool from_front;  ///< the line goes from the face's front, as the scene has it, behind
};

/// Faces met at one point: all in one plane.
struct LineLayer {
  std::span<const LineHit> hits;
  /// Beyond it, as the line runs, is the material of some closed object.
  bool material_beyond;
};

/// What the faces of a scene are for lines.  Keeps a reference to the scene.  Immutable;
/// may be shared between threads.
class LineFaces {
 public:
  explicit LineFaces(const Scene& scene);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Of the whole line through both points, not of the chord; in order, those of one face
  /// once.  Decided in doubles.
  void hits(const Chord& line, std::vector<LineHit>& found) const;
  /// All points of one face lie in the plane of the other, exactly.
  [[nodiscard]] bool coplanar(int a, int b) const;

 private:
  const Scene& scene_;
  std::vector<Eigen::Vector4d> planes_;  // unit normals of fronts
  Bvh tree_;
};

/// Follows lines, one after the other; scratch, one a thread.
class LineWalker {
 public:
  explicit LineWalker(const LineFaces& faces);

  /// The layers of the line, in order; valid until the next call.
  [[nodiscard]] std::span<const LineLayer> layers(const Chord& line);

 private:
  [[nodiscard]] bool together(const LineHit& a, const LineHit& b) const;
  void pass(const LineHit& hit);

  const LineFaces& faces_;
  double nearness_;  // scene units
  std::vector<LineHit> hits_;
  std::vector<LineLayer> layers_;
  // How often each closed object winds around where the line is; how many do.
  std::vector<int> windings_;
  int around_ = 0;
};

}  // namespace sightline::internal
