// The rays from a point to the faces of a scene, and which of them reach a source: what
// naive_shadow.h adds up.  For its .cpp files only.

#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "tests/support/naive_cones.h"
#include "tests/support/naive_material.h"
#include "tests/support/naive_shadow.h"

namespace sightline::testing {

using Integers = std::array<Integer, 3>;

class SideNames;

/// What all points share: coordinates as integers, `scale` times those of the scene.
struct NaiveShadow::Setup {
  explicit Setup(std::vector<NaiveShadowFace> all);
  /// Found when they are first asked for.
  [[nodiscard]] const SideNames& names() const;

  std::vector<NaiveShadowFace> faces;
  Integer scale;
  std::vector<std::vector<Integers>> corners;  ///< of faces
  std::vector<Ray> normals;                    ///< of faces, towards their fronts
  std::vector<Body> bodies;
  std::vector<char> in_body;  ///< of faces

 private:
  mutable std::once_flag names_once_;
  mutable std::shared_ptr<const SideNames> names_;
};

/// The scene as it is seen from a point.
class NaiveRays {
 public:
  NaiveRays(const NaiveShadow::Setup& setup, const Vec3& p);

  [[nodiscard]] const NaiveShadow::Setup& setup() const { return setup_; }

  /// Of the face's plane: n . x = height for the vectors x from the point to the plane,
  /// in units that are the same for all faces.
  [[nodiscard]] const Integer& height(int f) const { return heights_[f]; }
  [[nodiscard]] Integers to_corner(int f, std::size_t corner) const;
  /// The rays to the face.  Requires a height other than 0.
  [[nodiscard]] const Cone& cone(int f) const;
  /// The point is on the face.
  [[nodiscard]] bool on_face(int f) const;
  /// Rays that meet face f before face g, where they meet both planes: a half-space.
  /// nullopt for one plane.  Requires heights other than 0.
  [[nodiscard]] std::optional<Ray> before(int f, int g) const;
  /// Whether such rays begin in the material of some body; nullopt where the ray passes a
  /// side of a face, or lies in the plane of one that the point is on.
  [[nodiscard]] std::optional<bool> begins_in_material(const Ray& ray) const;

 private:
  const NaiveShadow::Setup& setup_;
  Integer unit_;  // denominators of the point
  Integers at_;   // the point, setup.scale unit_ times
  std::vector<Integer> heights_;
  mutable std::map<int, Cone> cones_;
};

/// Rays to one source face.
struct SourcePart {
  int face;
  Cone cone;
};

struct SourceParts {
  std::vector<int> shown;         ///< source faces that show the point their fronts
  std::vector<SourcePart> whole;  ///< they without what lies on another one
  std::vector<SourcePart> seen;   ///< of these what is seen
  bool hides = false;             ///< some part, of whatever size, is not seen
};

[[nodiscard]] SourceParts parts_seen(const NaiveRays& rays,
                                     const std::optional<Vec3>& normal);

}  // namespace sightline::testing
