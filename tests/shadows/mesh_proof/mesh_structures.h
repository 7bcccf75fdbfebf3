// A mesh beside what the naive oracle sees from points of its faces, on both sides of its
// edges, and along segments.

#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "shadows/shadow_mesh.h"
#include "tests/shadows/mesh_proof/mesh_plane.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {

/// How much to look at.  At most `faces` faces and `edges` edges of a facet, chosen at
/// random, `points` points of each.
struct MeshSamples {
  int faces = 1 << 30, edges = 1 << 30, points = 20;
  int segments = 0;  ///< of each facet, 100 points each
  /// Edges in line with the horizon do not count.
  bool no_edges_at_horizon = false;
};

struct MeshSampleCounts {
  int meshes = 0, faces = 0, face_points = 0, edges = 0, edge_points = 0;
  int narrow = 0;  ///< edge points that have another edge as near as the two sides
  int segments = 0, segment_points = 0, changes = 0;
  MeshSampleCounts& operator+=(const MeshSampleCounts& more);
};
std::ostream& operator<<(std::ostream& out, const MeshSampleCounts& counts);

/// Scenes in which edges that lie in the plane of a receiver begin or end to be in line
/// with its horizon where no edge of the mesh is: where one touches the receiver from
/// behind, or where they are seen along the fold of a bent light.
[[nodiscard]] bool edges_at_horizon_differ(const ShadowScene& lit);

/// The meshes of all objects of a scene.  Structures of the library have numbers, those
/// of the oracle are texts.  One number must go with one text all over the scene, and one
/// text with numbers that differ in nothing but edges in line with a side of the source:
/// where both are on one line in space the oracle has one name for them.
class MeshStructures {
 public:
  explicit MeshStructures(const ShadowScene& lit);

  /// What differs, as messages; at most ten.
  [[nodiscard]] std::vector<std::string> differences(const MeshSamples& samples,
                                                     std::uint64_t seed);
  [[nodiscard]] const MeshSampleCounts& counts() const { return counts_; }

 private:
  void look_at_faces(const MeshPlane& plane, const MeshSamples& samples);
  void look_at_face(const MeshPlane& plane, int face, const std::vector<int>& half_edges,
                    int points);
  void look_at_edges(const MeshPlane& plane, const MeshSamples& samples);
  void look_at_edge(const MeshPlane& plane, int edge, int points);
  void walk(const MeshPlane& plane);
  void find_change(const MeshPlane& plane, Flat a, Flat b, const std::string& seen,
                   const std::vector<Flat>& crossings);

  /// A structure of the library, as a text.
  enum class Told { All, NoEdgesAtHorizon, NoEdgesAtSource };
  [[nodiscard]] std::string told(int structure, Told what = Told::All) const;
  [[nodiscard]] std::string seen_at(const MeshPlane& plane, const Flat& p) const;
  /// The oracle's structure at p goes with the face's; returns it.
  std::string compare(const MeshPlane& plane, int face, const Flat& p, const char* where);
  void compare_class(const MeshPlane& plane, int face, const Flat& p);
  void report(const MeshPlane& plane, const Flat& p, const std::string& message);

  std::string name_;
  Scene scene_;
  std::vector<NaiveShadowFace> faces_;
  NaiveShadow naive_;
  Shadows shadows_;
  std::map<std::string, std::string> text_of_;
  std::map<std::string, int> number_of_;  ///< the first one with that text
  bool no_edges_at_horizon_ = false;
  std::mt19937_64 random_;
  std::vector<std::string> differences_;
  MeshSampleCounts counts_;
};

}  // namespace sightline::testing
