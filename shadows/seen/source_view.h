// What an eye sees of one plane of the source: the pieces of lines along which the part
// seen ends.

#pragma once

#include <optional>
#include <vector>

#include "linespace/picture/eye_star.h"
#include "linespace/view/line_view.h"
#include "shadows/seen/horizon.h"
#include "shadows/seen/shades.h"

namespace sightline::internal {

/// The eye must lie on the side to which the plane's faces emit.
class SourceView {
 public:
  struct Question {
    const SourceScene* source;
    const SourcePlane* plane;
    Viewpoint eye;
    /// nullptr where there is none.
    const Horizon* horizon = nullptr;
    /// Of the same eye; nullptr for an eye that is not on the scene.
    const EyeStar* star = nullptr;
    bool hide = true;        ///< false: as if nothing stood before the source
    bool all_lines = false;  ///< also those that are only seen in line with others
  };
  explicit SourceView(const Question& question);

  [[nodiscard]] const EyeSpace& eye() const { return *eye_; }
  [[nodiscard]] bool any_seen() const { return any_seen_; }
  [[nodiscard]] bool any_hidden() const { return any_hidden_; }
  /// The part seen lies on the side of a piece that is not `blocked`.  Pieces of several
  /// lines may coincide.
  [[nodiscard]] const std::vector<LinePiece>& pieces() const { return pieces_; }
  /// The piece is of a side of a facet that the eye is on, in line with what bounds the
  /// part seen: itself beyond the source, or a side of a sheet, it hides nothing.
  [[nodiscard]] bool only_carries(int piece) const { return only_carries_[piece]; }
  /// The first line of cuts of hiding faces with the plane, cut i being of face
  /// cut_face(i).
  [[nodiscard]] int first_cut_line() const { return first_cut_line_; }
  [[nodiscard]] int cut_face(int i) const { return cut_faces_[i]; }
  /// Faces that the eye sees edge-on, with parts of the source on both sides, that lie in
  /// the way or may do so.
  [[nodiscard]] const std::vector<int>& edge_on_faces() const { return edge_on_faces_; }
  /// nullptr where there is none.
  [[nodiscard]] const Horizon* horizon() const { return question_.horizon; }
  /// The horizon's line; -1 where it does not cross the plane's faces.
  [[nodiscard]] int horizon_line() const { return horizon_line_; }

 private:
  // A shade over a line, or beside it, between two positions.
  struct Cover {
    LineCut from, to;
    bool left, right;  // sides of the line on which the shade is
    bool is_source;
    bool own;  // the line is one of the shade's own
  };
  struct Line {
    int line;
    std::vector<int> shades;  // of which it is a side; ascending
  };
  // Between two neighbouring positions, on the left and on the right.
  struct Beside {
    std::array<int, 2> source{}, hidden{}, own{}, own_source{};
  };

  void add_horizon(std::vector<ExactPoint>& points,
                   std::vector<std::array<int, 2>>& lines);
  [[nodiscard]] bool horizon_hides_all() const;
  void ask_star();
  void find_edge_on(const std::vector<HidingFace>& hiding_faces);
  void find_shades(const std::vector<HidingFace>& hiding_faces, int first_cut_point);
  [[nodiscard]] bool apart(const Shade& shade, const Shade& of_source) const;
  [[nodiscard]] bool covers_all(const Shade& shade) const;
  [[nodiscard]] std::vector<Line> lines_to_ask() const;
  void view(const Line& line);
  [[nodiscard]] std::optional<Cover> cover(const LineCuts& cuts, const Shade& shade);
  [[nodiscard]] std::optional<Cover> below_horizon(int line, const LineCuts& cuts) const;
  [[nodiscard]] std::array<bool, 2> into_material(int line, const LineCuts& cuts,
                                                  const LineCut& from,
                                                  const LineCut& to) const;
  [[nodiscard]] bool bounds_star(int line) const;
  [[nodiscard]] bool before_plane(int line, const LineCuts& cuts, const LineCut& from,
                                  const LineCut& to) const;

  Question question_;
  ViewScene scene_;
  std::optional<EyeSpace> eye_;
  std::vector<Shade> shades_;  // of the source first
  std::size_t source_shades_ = 0;
  int first_cut_line_ = 0, horizon_line_ = -1;
  std::vector<int> cut_faces_, edge_on_faces_;
  bool ask_star_ = false;  // sight into material is free for a part of the source only
  bool any_seen_ = false, any_hidden_ = false;
  std::vector<LinePiece> pieces_;
  std::vector<bool> only_carries_;  // of pieces
  // Scratch.
  std::vector<Cover> covers_;
  std::vector<std::array<Sign, 2>> corner_signs_;  // by side: Positive on the right
};

}  // namespace sightline::internal
