// Many segments at once between points of faces, for visibility_estimate.cpp: the same
// Embree scene and the same certified arithmetic as OcclusionIndex::is_free, in packets,
// with the two faces that a segment ends on left out.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/occlusion.h"

namespace sightline::internal {

/// A segment from a point of face_a to a point of face_b, both rounded to doubles.  These
/// two faces do not block it.
struct FaceSegment {
  Point a, b;
  int face_a, face_b;
};

enum class Certainty : std::uint8_t { Blocked, Free, Doubtful };

/// Rays of one Embree call.
inline constexpr int kPacket = 8;

struct OcclusionAccess {
  /// For each of at most kPacket segments: what double arithmetic can certify.  Of a
  /// Doubtful one, doubtful[i] holds the faces it perhaps meets, one entry per item; the
  /// others are counted as decided by doubles.
  /// Requires a != b, ends within the scene's box (an ulp outside is no harm).
  static void ask_packet(const OcclusionIndex& index,
                         std::span<const FaceSegment> segments,
                         std::span<Certainty> answers,
                         std::span<std::vector<int>> doubtful);

  /// Exactly, and counted so: no contact of the open segment with these faces blocks.
  static bool is_free_of(const Scene& scene, std::vector<int> faces, const Point& a,
                         const Point& b);

  /// OcclusionIndex::maximal_free_segment() by exact numbers alone, for tests.
  static std::optional<FreeSegment> maximal_exactly(const OcclusionIndex& index,
                                                    const Point& a, const Point& b);
};

}  // namespace sightline::internal
