// One line of the scene as an eye sees it: the pieces along which something is seen to
// begin or end.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/picture/eye_space.h"
#include "linespace/picture/line_cut.h"

namespace sightline::internal {

/// What is seen along one side of a piece.
struct SeenBeside {
  /// Faces that are seen there and contain the piece: one, or several that coincide.
  /// Empty: what is seen lies behind the piece.
  std::vector<int> faces;
  friend bool operator==(const SeenBeside&, const SeenBeside&) = default;
};

/// A piece of a line, seen whole, with something else on its left than on its right.
struct LinePiece {
  int line;
  LineCut from, to;
  SeenBeside left, right;  ///< going from `from` to `to`
};

/// Finds the pieces of lines.  Keeps scratch: one for a thread.
class LineViewer {
 public:
  /// Faces marked 0 in possibly_seen are certainly hidden and are not asked; the span
  /// must outlive this.
  LineViewer(const EyeSpace& eye, std::span<const std::uint8_t> possibly_seen);

  /// Appends the pieces of a line to `pieces`, from its first end to its second.
  void view(int line, std::vector<LinePiece>& pieces);

 private:
  // A face as it lies over, or at, the line between two positions.
  struct Cover {
    int face;
    LineCut from, to;
    bool left, right;  // sides of the line on which the face is
    bool hides;        // it is nearer than the line; else it contains the line
  };

  void find_faces(int line);
  void add_cover(int line, int face);
  [[nodiscard]] std::optional<Cover> own_side(int line, int face) const;
  [[nodiscard]] std::optional<Cover> overlap(int line, int face,
                                             const LineCuts& cuts) const;
  void scan(int line, const LineCuts& cuts, std::vector<LinePiece>& pieces);
  [[nodiscard]] SeenBeside nearest(std::span<const int> faces, int line, bool left) const;

  const EyeSpace* eye_;
  std::span<const std::uint8_t> possibly_seen_;
  std::vector<int> faces_;
  std::vector<Cover> covers_;
  bool hidden_;  // the whole line, by one face
};

}  // namespace sightline::internal
