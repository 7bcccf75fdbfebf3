// What a box leaves of a scene's faces and lines.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linespace/picture/box_cut.h"
#include "linespace/picture/point_numbers.h"
#include "linespace/picture/view_line.h"

namespace sightline::internal {

/// Immutable.  Keeps a reference to the scene.
class CutFaces {
 public:
  /// Cuts the faces and the lines that are edges or sides; `side_lines` has the line of
  /// each corner's side, -1 for none.  Appends a line for each side of the box that cuts
  /// a face.  Cost: rationals for the faces that the box's sides cut.
  CutFaces(const Scene& scene, const BoxCut& box, std::span<const int> side_lines,
           PointNumbers& numbers, std::vector<ViewLine>& lines);

  [[nodiscard]] const BoxCut& box() const { return box_; }
  /// Of what is left of a face; none where that has no area.
  [[nodiscard]] std::span<const int> corners(int face) const {
    return std::span(corners_).subspan(starts_[face], starts_[face + 1] - starts_[face]);
  }
  /// On which the side from corner k of what is left lies; -1: none.
  [[nodiscard]] int line_of_side(int face, int k) const {
    return lines_[starts_[face] + k];
  }
  /// Nothing of the face is cut off.
  [[nodiscard]] bool is_whole(int face) const { return whole_[face] != 0; }
  /// Something of the object is cut off.
  [[nodiscard]] bool is_open(int object) const { return open_[object] != 0; }
  /// The edge has more facets in the scene, and one in the box.
  [[nodiscard]] bool leaves_one_facet(int edge) const;

 private:
  enum class Left : std::uint8_t { Whole, Part, Nothing };
  [[nodiscard]] Left left_of(int face) const;
  [[nodiscard]] std::vector<CutCorner> cut(int face,
                                           std::span<const int> side_lines) const;
  void add_whole(int face, std::span<const int> side_lines);
  void add_part(int face, std::span<const CutCorner> polygon,
                std::span<const int> side_lines, PointNumbers& numbers,
                std::vector<ViewLine>& lines);
  void add_side(int face, int line);
  void cut_lines(std::size_t count, PointNumbers& numbers,
                 std::vector<ViewLine>& lines) const;

  const Scene* scene_;
  BoxCut box_;
  std::vector<int> starts_, corners_, lines_;  // by face
  std::vector<std::uint8_t> whole_, open_;
  // By line of the scene: the one facet beside it that is left, or one of these.
  static constexpr int kNone = -1, kSeveral = -2;
  std::vector<int> facet_;
};

}  // namespace sightline::internal
