// Do two squares see each other past a screen of four tiles?  No: the tiles leave no gap.
// With one corner moved by a billionth: yes, and here is a segment that proves it.

#include <linespace/polygon_visibility.h>
#include <linespace/visibility_cover.h>

#include <cstdio>

using sightline::Point;
using sightline::Polygon;
using sightline::Verdict;

namespace {

Polygon square(double z, double x0, double y0, double x1, double y1) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

}  // namespace

int main() {
  sightline::VisibilityQuestion question{
      square(0, 0, 0, 1, 1),
      square(2, 0, 0, 1, 1),
      {square(1, -1, -1, 0.5, 0.5), square(1, 0.5, -1, 2, 0.5), square(1, 0.5, 0.5, 2, 2),
       square(1, -1, 0.5, 0.5, 2)}};
  sightline::VisibilityRequest request;
  request.keep_cover = true;

  // 1. Hidden, with a proof that a checker of its own verifies.
  const auto hidden = sightline::polygon_visibility(question, request);
  if (hidden.verdict != Verdict::Hidden) return 1;
  if (const auto wrong = check_cover(question, *hidden.cover)) {
    std::printf("the proof does not hold: %s\n", wrong->c_str());
    return 1;
  }
  std::printf("four tiles: hidden; the proof has %zu leaves and holds\n",
              hidden.cover->leaves());

  // 2. A slit of 1e-9 between two tiles.
  question.occluders[1] = square(1, 0.5 + 1e-9, -1, 2, 0.5);
  const auto visible = sightline::polygon_visibility(question, request);
  if (visible.verdict != Verdict::Visible) return 1;
  const auto& [from, to] = *visible.witness;
  std::printf("with a slit: visible, from (%s, %s, %s) to (%s, %s, %s)\n",
              from.exact[0].c_str(), from.exact[1].c_str(), from.exact[2].c_str(),
              to.exact[0].c_str(), to.exact[1].c_str(), to.exact[2].c_str());
  return 0;
}
