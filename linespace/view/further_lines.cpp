#include "linespace/view/further_lines.h"

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// A piece of a line between two points of its picture.
FurtherLine piece(const EyeSpace& eye, FurtherLine::Kind kind, int line,
                  const std::array<const PicturePoint*, 2>& ends) {
  FurtherLine further{kind, eye.scene().lines()[line].name, {}, {}};
  const auto [a, b] = eye.scene().lines()[line].ends;
  for (int i = 0; i < 2; ++i) {
    further.at[i] = eye.drawn_at(ends[i]->vector());
    const auto [s, t] = LineCuts(eye, line).shares(ends[i]->exact());
    further.segment[i] = rounded(
        along(eye.scene().exact(a), eye.scene().exact(b), quotient(t, Rational(s + t))));
  }
  return further;
}

}  // namespace

std::vector<FurtherLine> seam_lines(const EyeSpace& eye, const ViewGraph& graph,
                                    const ViewMap& map) {
  std::vector<FurtherLine> lines;
  for (const ViewMap::Seam& seam : map.seam_pieces) {
    lines.push_back(piece(eye, FurtherLine::Kind::Seam, seam.line,
                          {&graph.points[seam.ends[0]], &graph.points[seam.ends[1]]}));
  }
  return lines;
}

std::vector<FurtherLine> hidden_lines(const EyeSpace& eye, const EyeStar& star) {
  std::vector<std::uint8_t> all;
  for (int f = 0; f < static_cast<int>(eye.scene().scene().faces().size()); ++f)
    all.push_back(eye.scene().corners(f).empty() ? 0 : 1);
  const Window window(eye);
  LineViewer viewer(eye, star, window, all);
  std::vector<FurtherLine> lines;
  for (int l = 0; l < eye.scene().first_window_line(); ++l) {
    hear_stop();
    const ViewLine& line = eye.scene().lines()[l];
    if (line.name.edge < 0 || line.ends[0] < 0) continue;
    for (const auto& [from, to] : viewer.hidden_parts(l)) {
      const PicturePoint p(eye, l, from), q(eye, l, to);
      lines.push_back(piece(eye, FurtherLine::Kind::Hidden, l, {&p, &q}));
    }
  }
  return lines;
}

}  // namespace sightline::internal
