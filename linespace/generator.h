// Features of a scene that a line touches, and which touches make events.

#pragma once

#include <compare>
#include <cstdint>

namespace sightline {

/// Which contacts make events.  Solid: those at which the line grazes.  Polygon: the two
/// outermost ones may also be *end* contacts, a visible crease (convex or reflex edge) or
/// corner at which the line enters its solid, so that the free segment ends there.
enum class EventMode : std::uint8_t { Solid, Polygon };

enum class GeneratorKind : std::uint8_t { Vertex, Edge, Face };

/// A feature of the scene that a line touches: a point id, an edge id or a facet id.
struct Generator {
  GeneratorKind kind;
  std::int32_t id;
  friend auto operator<=>(const Generator&, const Generator&) = default;
};

/// Bound on the error of a rounded position on an edge, a parameter from 0 to 1, where
/// the precision is Exact.
inline constexpr double kRangeError = 0x1p-40;

}  // namespace sightline
