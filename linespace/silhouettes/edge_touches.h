// Which faces meet an edge: found once for all edges between the same two points, however
// many copies of an object there are.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

/// How a face of another object, or of the same one elsewhere, meets the open edge.
/// Pierced: in one point inside the face's facet, which it lies across.
enum class EdgeMeeting : std::uint8_t { None, Pierced, Touches, ContainsInside };

/// What the faces that are not an edge's own do to it.
struct ForeignTouch {
  EdgeMeeting touched = EdgeMeeting::None;  ///< the strongest
  /// Coplanar faces that are not bounded along the edge cover all of it.
  bool covered = false;
  std::vector<std::int32_t> pierced_by = {};  ///< only where `touched` is Pierced
  /// Faces that contain a part of the edge; of equal ones a single one.
  std::vector<std::int32_t> grounds = {};
};

/// The faces that meet the open segment between two points of the scene.
/// Cost: the faces whose boxes meet its box, each once.
class EdgeTouches {
 public:
  /// Faces of the facets in `skipped` (ascending) are left out.
  EdgeTouches(const Silhouettes& silhouettes, std::array<std::int32_t, 2> points,
              std::span<const std::int32_t> skipped);

  /// What all faces but those of the facets in `own` (ascending) do.
  /// Cost: about that of `own`, unless one of its faces contains a part of the edge.
  [[nodiscard]] ForeignTouch without(std::span<const std::int32_t> own) const;

 private:
  struct Item {
    std::int32_t face, facet;
    EdgeMeeting touch;
    bool ground = false;                                  // contains a part of the edge
    std::optional<std::array<Rational, 2>> stretch = {};  // that part, if not all
  };
  void add(std::int32_t face);
  [[nodiscard]] bool covered_without(std::span<const std::int32_t> own) const;
  [[nodiscard]] std::vector<std::int32_t> grounds_without(
      std::span<const std::int32_t> own) const;

  const Silhouettes& g_;
  std::array<std::int32_t, 2> points_;
  std::vector<Item> items_;             // in the order of the faces' tree
  std::vector<std::int32_t> by_facet_;  // positions there, by facet
  std::array<int, 4> counts_{};         // by EdgeMeeting
  bool covered_ = false;                // of all faces
  std::vector<std::int32_t> grounds_;   // of all faces
};

}  // namespace sightline::internal
