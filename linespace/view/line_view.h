// One line of the scene as an eye sees it: the pieces along which something is seen to
// begin or end.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/picture/eye_space.h"
#include "linespace/picture/eye_star.h"
#include "linespace/picture/line_cut.h"
#include "linespace/picture/view_window.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// What is seen along one side of a piece.
struct SeenBeside {
  /// Faces that are seen there and contain the piece: one, or several that coincide.
  /// Empty: what is seen lies behind the piece.
  std::vector<int> faces;
  /// Nothing is seen on this side: from an eye on the scene sight runs into material, or
  /// it is beyond the window.
  bool blocked = false;
  friend bool operator==(const SeenBeside&, const SeenBeside&) = default;
};

/// A piece of a line, seen whole, with something else on its left than on its right.
struct LinePiece {
  int line;
  LineCut from, to;
  SeenBeside left, right;  ///< going from `from` to `to`
};

/// Where, in the picture, something on a line may coincide with something nearer: a point
/// of the scene, or a position on the line, or a stretch of it.
struct Suspect {
  int point;  ///< -1: a position or a stretch
  int line;
  LineCut at;
  std::optional<LineCut> to;  ///< the end of a stretch
};

/// Finds the pieces of lines.  Keeps scratch: one for a thread.
class LineViewer {
 public:
  /// Faces marked 0 in possibly_seen are certainly hidden and are not asked.
  LineViewer(const EyeSpace& eye, const EyeStar& star, const Window& window,
             std::span<const std::uint8_t> possibly_seen);

  /// Appends the pieces of a line to `pieces`, from its first end to its second.
  void view(int line, std::vector<LinePiece>& pieces);

  /// Parts of the line that nothing nearer hides, at least on one side; they may still
  /// bound nothing that is seen.
  [[nodiscard]] std::vector<std::array<LineCut, 2>> parts_in_sight(int line);

  /// Parts of the line that nearer faces hide on both sides.
  [[nodiscard]] std::vector<std::array<LineCut, 2>> hidden_parts(int line);

  /// All accidents of corners and lines that views of the lines asked so far came across,
  /// and perhaps others: every point where a corner is seen on a nearer or farther line,
  /// or where two nearer lines cross on a farther one.
  [[nodiscard]] std::span<const Suspect> suspects() const { return suspects_; }

 private:
  // A face as it lies over, or at, the line between two positions.
  struct Cover {
    int face;
    LineCut from, to;
    bool left, right;  // sides of the line on which the face is
    bool hides;        // it is nearer than the line; else it contains the line
  };

  // The positions on a line at which anything begins or ends, in order, each once; and
  // between two of them how many faces hide its left and its right.
  struct Scan {
    std::vector<LineCut> at;
    std::vector<std::array<int, 2>> hidden;
    std::vector<std::vector<const Cover*>> containing;
    std::vector<std::array<bool, 2>> blocked;  // empty where nothing is
  };

  [[nodiscard]] bool cover(int line, const LineCuts& cuts);
  [[nodiscard]] Scan scan_covers(int line, const LineCuts& cuts);
  void find_blocked(int line, const LineCuts& cuts, Scan& scan) const;
  [[nodiscard]] std::optional<LinePiece> piece(int line, const Scan& scan,
                                               std::size_t i) const;
  void suspect_corner(int line, int corner);
  void suspect_ends(int line, int face, std::size_t k, const std::array<Sign, 2>& nearer);
  void find_faces(int line);
  void add_cover(int line, int face);
  [[nodiscard]] std::optional<Cover> own_side(int line, int face) const;
  [[nodiscard]] std::optional<Cover> overlap(int line, int face, const LineCuts& cuts);
  [[nodiscard]] bool narrow_to_face(Cover& cover, int face, const LineCuts& cuts,
                                    const std::array<Sign, 2>& before);
  [[nodiscard]] SeenBeside nearest(std::span<const int> faces, int line, bool left) const;

  const EyeSpace* eye_;
  const EyeStar* star_;
  const Window* window_;
  std::vector<int> askable_;  // faces that may be seen, and not edge-on
  Bvh tree_;                  // over their boxes
  std::vector<int> faces_;
  std::vector<Cover> covers_;
  std::vector<Sign> corner_signs_;  // of a face: Positive on the right of the line
  std::vector<Suspect> suspects_;
  bool along_ = false;  // some nearer side is seen along the line
};

}  // namespace sightline::internal
