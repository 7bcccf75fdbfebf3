// What one vertex sees: the EV arcs of a viewpoint that is a corner of the scene, with
// the extremal stabbing lines at their ends.

#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "linespace/blockers/occluders.h"
#include "linespace/blockers/surroundings.h"
#include "linespace/lines/line_name.h"
#include "linespace/sight/line_probe.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/swaths/outline_stretch.h"
#include "skeleton/build/part.h"
#include "skeleton/graph.h"
#include "skeleton/skeleton_lines.h"

namespace sightline::internal {

class KnownLines;
struct PlaneValues;

/// Arcs of one vertex; node numbers and generator positions are local to the view.
struct VertexView {
  std::vector<SkeletonArc> arcs;
  std::vector<SkeletonNode> nodes;
  std::vector<Generator> pool;
  std::vector<CutInterval> intervals;       ///< exact ranges of `arcs`, while it is built
  std::deque<Rational> positions;           ///< of cuts that keep a pointer
  std::vector<Simplified::Arc> short_arcs;  ///< left out
  /// For each node: 1 if it was found where a sign is zero, so that its contacts must be
  /// listed; kUnnamed if it has no name until they are; else 0.
  std::vector<std::uint8_t> special;
  static constexpr std::uint8_t kUnnamed = 2;
  /// Of the arcs, while it is built: found among zero signs.
  std::vector<std::uint8_t> special_arcs;
  /// For each node: NodeContacts::line, the name that tells its line from others.
  std::vector<LineName> lines;
  /// For each node: whether an arc of solid mode ends there; for an EVE node, whether two
  /// such arcs line up.
  std::vector<std::uint8_t> grazes;
  /// EVE nodes, by positions on the edges of two arcs.
  struct LineUp {
    std::uint32_t node, arc;
    Cut cut;
    std::uint32_t other_arc;
    Cut other_cut;
  };
  std::vector<LineUp> line_ups;

  std::uint32_t add_node(NodeKind kind, bool self, bool end,
                         std::span<const Generator> generators,
                         const std::array<Point, 2>& segment,
                         const std::array<bool, 2>& ends = {});
  void sort_arcs();
  /// Fills `grazes`.
  void find_grazes();
  /// Leaves out the other arcs, and the nodes that only they end at.
  void keep_arcs(const std::vector<std::uint8_t>& kept);
};

/// How a line through a star's point meets the star.
enum class StarContact : std::uint8_t { Grazes, Blocked, Degenerate };

/// The contact at the star's point of the line through it and x; Degenerate when the line
/// lies in the plane of a face there or along an edge.
[[nodiscard]] StarContact star_contact(const Scene& scene, const Star& star,
                                       const Point& x);

/// Computes views, one at a time; keeps scratch, so one per thread.
class VertexViewer {
 public:
  /// Keeps references; `lines` may be null unless part.by_lines.  Arcs on a stretch of
  /// their edge shorter than `feature_size` are left out, and listed.  `around` is kept
  /// by whoever asks for views: of corners that include the viewpoint, and at the group;
  /// so is `known`.
  VertexViewer(const Silhouettes& silhouettes, const EvPart& part,
               const SkeletonLines* lines, double feature_size, Surroundings& around,
               KnownLines& known);

  ~VertexViewer();

  /// Looks from stars()[star] from now on.
  void begin(int star);
  /// False proves that no ridge below this node of the ridge tree has an arc.  Nodes are
  /// asked from outer to inner ones.
  [[nodiscard]] bool may_view(std::uint32_t node);
  /// Finds the arcs with the ridges below a node, which are a group.
  void view_group(std::uint32_t node);
  /// Every arc of the star's point with a ridge of the part, after all groups of the tree
  /// that may be viewed.
  [[nodiscard]] VertexView finish();

 private:
  struct Pair;  // one vertex and one ridge
  struct PairLists;

  [[nodiscard]] bool hidden(const Box& box);
  [[nodiscard]] bool at_viewpoint(int facet) const;
  void drop_short_arcs(VertexView& out);
  void drop_arcs_off_source(VertexView& out);
  void view_ridge(int ridge, VertexView& out);
  [[nodiscard]] bool may_see(const Ridge& r);
  [[nodiscard]] std::vector<CutInterval> open_parts(Pair& pair);
  void add_arcs(Pair& pair, std::span<const CutInterval> open, VertexView& out);
  [[nodiscard]] std::uint32_t node_at(Pair& pair, const Cut& cut,
                                      const std::array<bool, 2>& ends, bool mild,
                                      VertexView& out) const;
  [[nodiscard]] Sign side_of(const Pair& pair, int corner);
  [[nodiscard]] bool on_one_side(const Pair& pair, int face);
  bool add_blockers(Pair& pair);
  void add_blocker(Pair& pair, int face);
  [[nodiscard]] bool may_hide(const Pair& pair, const Face& face, bool own) const;
  [[nodiscard]] bool crosses_plane(Pair& pair, int face, std::span<Sign> signs);
  [[nodiscard]] SideAgainstEdge<Cut> side_against(Pair& pair, int face, std::size_t k,
                                                  bool to_right, bool apart) const;
  void list_faces(Pair& pair) const;
  [[nodiscard]] bool continues_across(int face, std::span<const Sign> signs) const;
  [[nodiscard]] bool touching_across(const Pair& pair) const;
  [[nodiscard]] bool stands_on_ground(const Pair& pair, int face,
                                      std::span<const Sign> signs) const;
  void add_unsupported_convex(Pair& pair);
  void add_unsupported_general(Pair& pair);
  [[nodiscard]] bool corner_drawn_between(const Cut& from, const Cut& to,
                                          const LineThrough& edge) const;
  [[nodiscard]] bool changes_at_turn(const Pair& pair,
                                     std::span<const CutInterval> open) const;
  void split_at_ends(Pair& pair, std::vector<CutInterval>& open) const;
  [[nodiscard]] bool ends_are_simple(const Pair& pair,
                                     std::span<const CutInterval> open) const;
  [[nodiscard]] bool pierced_inside(Pair& pair, std::span<const CutInterval> open) const;
  [[nodiscard]] bool is_pierced_at(const Pair& pair, const Cut& cut) const;
  /// nullopt where an end of the edge lies in the plane of a face at a corner: then the
  /// contacts have to be listed.
  [[nodiscard]] std::optional<std::uint32_t> end_node(const Pair& pair, const Cut& cut,
                                                      const std::array<bool, 2>& ends,
                                                      VertexView& out) const;
  void add_line_ups(VertexView& out);  // EVE
  [[nodiscard]] Cut line_up_cut(const LineThrough& edge, const PlaneSide& plane,
                                const std::array<std::int32_t, 2>& q) const;
  [[nodiscard]] bool inside_arc(const LineThrough& edge, const CutInterval& arc,
                                const Cut& cut) const;

  const Silhouettes& g_;
  const Scene& scene_;
  const EvPart& part_;
  const SkeletonLines* lines_;
  double feature_size_;
  // The viewpoint at hand.
  int star_id_ = -1;
  std::uint8_t wanted_ = 0;  // bits of the part
  const Star* star_ = nullptr;
  int point_ = -1;
  Point at_;
  std::vector<std::int32_t> own_objects_, own_facets_;  // ascending
  Occluders occluders_;
  std::vector<BoundedPlane> star_planes_;
  LineProbe probe_;
  Surroundings& around_;
  KnownLines& known_;
  std::unique_ptr<PairLists> lists_;
  // By point, while the pair's number is that of the pair at hand: its side of the plane.
  struct PointSide {
    std::uint32_t pair = 0;
    Sign side{};
  };
  std::vector<PointSide> point_sides_;
  std::uint32_t pair_ = 0;
  VertexView out_;
};

}  // namespace sightline::internal
