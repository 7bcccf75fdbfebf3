// What one edge sees: from where no line can touch it, what hides others from it or from
// pieces of it, and which faces are on the way to a group of them.  In bounded doubles:
// what is left out is proved to be.

#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "linespace/blockers/blocker_list.h"
#include "linespace/blockers/edge_pieces.h"
#include "linespace/blockers/facing_faces.h"
#include "linespace/blockers/occluders.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {

/// Keeps scratch, so one per thread.
class EdgeView {
 public:
  explicit EdgeView(const Silhouettes& silhouettes);

  /// Looks from this ridge on.
  void begin(int ridge);

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] const Point& end(int k) const { return ends_[k]; }

  /// No point of the box is on a line that touches the edge.
  [[nodiscard]] bool never_touched_from(const Box& box) const;
  /// Some occluder, of those that hid something lately, hides the box from the whole
  /// edge: it stands in the way of every segment from the edge to the box. The second
  /// form asks the same for the segment q0 q1 in place of a box.
  [[nodiscard]] bool hides(const Box& box) { return whole().occluders.hider(box) >= 0; }
  [[nodiscard]] bool hides(const Point& q0, const Point& q1) {
    return whole().occluders.hider(q0, q1) >= 0;
  }

  /// Sets of pieces of the edge, by bit; an edge that is left whole has none.
  using Pieces = std::uint64_t;
  [[nodiscard]] Pieces pieces() const { return pieces_; }
  /// Those of them from which nothing known hides the box.  Boxes are asked from outer to
  /// inner ones, with what was left of the outer one: what hid a piece last is kept.
  [[nodiscard]] Pieces open(Pieces pieces, const Box& box);

  /// Looks at a group of edges from all of the edge and from these pieces: until
  /// look_away() all that is asked is inside the box.
  void look_at(const Box& group, Pieces open);
  void look_away();

  /// A part of the edge as it looks at an edge of the group.
  struct Part {
    double from, to;
    int hidden_by;  ///< a face of an occluder that hides the other edge from it, or -1
  };
  /// Lists the parts of the edge in order, each with what hides q0 q1 from it.  There is
  /// one part, the whole edge, where few occluders are between it and the group; else the
  /// edge's pieces.  Pieces whose bit is not in `open` are known to be hidden.
  /// Also lists faces whose boxes lines from the parts that are not hidden may meet:
  /// those by which lines enter an occluder.  Of an occluder that hides a part, all faces
  /// are listed.  Returns false when every part is hidden.
  [[nodiscard]] bool look(Pieces open, const Point& q0, const Point& q1,
                          std::vector<Part>& parts, std::vector<std::int32_t>& faces);
  /// All that was between the edge, but for hidden parts of it, and the other one
  /// (Silhouettes::blockers); some more than once.
  [[nodiscard]] std::span<const std::int32_t> blockers() const { return blockers_; }
  /// All faces, by boxes, of what was between the edge and the other one, ascending.
  [[nodiscard]] std::vector<int> all_faces() const;
  /// The occluder of this face hid an edge of the group from a part.
  void remember(std::size_t part, int face) { part_view(part).occluders.remember(face); }

 private:
  struct PieceView {
    explicit PieceView(const Silhouettes& g) : occluders(g), between(g) {}
    EdgePiece piece;
    Occluders occluders;
    int hidden_by = -1;
    BlockerList between;  // it and the group
  };

  [[nodiscard]] PieceView& whole() { return views_.front(); }
  [[nodiscard]] PieceView& part_view(std::size_t part) {
    return views_[cut_ ? part + 1 : 0];
  }
  void begin_piece(std::size_t view, double from, double to);
  void list_blockers(PieceView& view) const;
  void find_between(PieceView& view, const Shaft& hull);
  void add_between(std::int32_t blocker, const Shaft& hull);

  const Silhouettes& g_;
  EdgeCutter cutter_;
  const Ridge* ridge_ = nullptr;
  std::array<Point, 2> ends_;
  Box box_;
  std::array<BoundedPlane, 2> wedge_;
  std::array<bool, 2> touched_on_{};

  std::deque<PieceView> views_;  // of the whole edge, then of its pieces
  int piece_count_ = 0;
  Pieces pieces_ = 0;

  Box group_;
  bool cut_ = false, decided_ = false;  // the group is looked at by pieces
  FacingFaces facing_;
  // Of the part at hand; of all parts of the edge.
  std::vector<std::int32_t> between_;
  std::vector<std::int32_t> blockers_, hider_faces_;
  std::optional<Shaft> hull_;
};

}  // namespace sightline::internal
