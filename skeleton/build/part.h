// Which generators, and which pairs of them, a request asks for: told as bits, so that
// whole subtrees of edges are left out at once.

#pragma once

#include <cstdint>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "skeleton/graph.h"
#include "skeleton/request.h"
#include "skeleton/skeleton_lines.h"

namespace sightline::internal {

/// The generators that a request leaves in, whatever they are paired with.
struct KeptGenerators {
  std::vector<std::uint8_t> ridges, stars;  ///< empty: all
};

/// Those in the region, near the viewpoint, and not below the feature size.
[[nodiscard]] KeptGenerators kept_generators(const Silhouettes& silhouettes,
                                             const SkeletonRequest& request);

/// The edges, corners and objects that the feature size leaves out, in order of id.
[[nodiscard]] Simplified simplified_by(const Scene& scene, double feature_size);

/// Some piece of an arc ends on one of the faces, told as bits.
[[nodiscard]] bool any_ends_on(const std::vector<SkeletonLines::EndPiece>& pieces,
                               const std::vector<std::uint8_t>& faces);

/// Pairs of a vertex and an edge: those whose bits meet.
struct EvPart {
  std::vector<std::uint8_t> stars, ridges;  ///< bits; both empty: every pair
  std::vector<std::uint8_t> below;          ///< by node of the ridge tree: all bits below
  /// Of arcs with no generator on a source, only those with lines that end there.
  bool by_lines = false;
  std::vector<std::uint8_t> source_stars, source_ridges, source_faces;
  Box source_box{};

  [[nodiscard]] bool on_source(int star, int ridge) const {
    return source_stars[star] != 0 || source_ridges[ridge] != 0;
  }
  [[nodiscard]] std::uint8_t wanted(int star) const {
    return stars.empty() ? 1 : stars[star];
  }
  [[nodiscard]] bool has(int ridge, std::uint8_t wanted) const {
    return ridges.empty() || (ridges[ridge] & wanted) != 0;
  }
  [[nodiscard]] bool has_below(std::uint32_t node, std::uint8_t wanted) const {
    return below.empty() || (below[node] & wanted) != 0;
  }
};
[[nodiscard]] EvPart ev_part(const Silhouettes& silhouettes,
                             const SkeletonRequest& request);

/// False proves that no line through v and the edge e0 e1 meets the box, ahead or behind.
[[nodiscard]] bool wedge_may_meet(const Point& v, const Point& e0, const Point& e1,
                                  const Box& box);

/// Stars that take part in some pair, ascending.
[[nodiscard]] std::vector<int> asked_stars(const Silhouettes& silhouettes,
                                           const EvPart& part);

/// Pairs of outer edges, and the edges of which an arc must have one.
struct EeePart {
  /// For each ridge, a set of bits.  A pair of outer edges is asked for iff one offers a
  /// bit that the other wants; it does not matter which of the two is asked.  A ridge
  /// that takes no part offers and wants nothing.  Both lists empty: every pair is asked
  /// for.
  std::vector<std::uint8_t> offers, wants;
  std::vector<std::uint8_t> below;  ///< by node of the ridge tree: all offers below
  std::vector<std::uint8_t> kept;   ///< may be one of the three; empty: all
  /// Is or meets a source, as one of the three; empty: all.
  std::vector<std::uint8_t> through, through_below;
  Box through_box{};  ///< of the ridges to go through, or of the source
  /// Of arcs with no edge on the source, only those with lines that end there.
  bool by_lines = false;
  std::vector<std::uint8_t> source_faces;

  [[nodiscard]] bool has(int ridge) const { return kept.empty() || kept[ridge]; }
  [[nodiscard]] bool has_outer(int i, int j) const {
    return offers.empty() || (wants[i] & offers[j]) != 0;
  }
  [[nodiscard]] bool goes_through(int ridge) const {
    return through.empty() || through[ridge];
  }
  /// False proves that no line through one box and the other goes on to the source, or
  /// that this does not matter.
  [[nodiscard]] bool may_reach(const Box& a, const Box& b) const;
  /// False proves that no pair of ridge i, whose box is given, with one below the node is
  /// asked for.
  [[nodiscard]] bool may_pair(int i, const Box& box, std::uint32_t node,
                              const Box& node_box) const;
};
[[nodiscard]] EeePart eee_part(const Silhouettes& silhouettes,
                               const SkeletonRequest& request);

/// Ridges that may be an outer edge of something, ascending.
[[nodiscard]] std::vector<int> asked_ridges(const Silhouettes& silhouettes,
                                            const EeePart& part);

/// Pairs of facets, asked for like pairs of outer edges.
struct FacetPart {
  std::vector<std::uint8_t> offers, wants;  ///< by facet; 0 takes no part
  [[nodiscard]] bool has(int f, int g) const { return (wants[f] & offers[g]) != 0; }
};
/// A facet is inside a box with all its corners, near a point with some side, and below
/// the feature size with all sides.
[[nodiscard]] FacetPart facet_part(const Silhouettes& silhouettes,
                                   const SkeletonRequest& request);

}  // namespace sightline::internal
