// The lines that pass four edges of a scaffold: how many there are, and where they run.
// One task, top to bottom.

#include <cstdio>

#include "linespace/segment_transversals.h"
#include "linespace/transversals.h"

int main() {
  using sightline::LineThrough;
  // Three bars that rule the surface z = x y, and one that pierces it twice, where x^2
  // = 2.
  const LineThrough bars[] = {{{0, -2, 0}, {0, 2, 0}},
                              {{1, -2, -2}, {1, 2, 2}},
                              {{3, -2, -6}, {3, 2, 6}},
                              {{0, 0, 2}, {3, 3, 2}}};

  // As unbounded lines: two transversals, with sqrt(2) in their coordinates.
  const sightline::LineTransversals both =
      sightline::transversals(bars[0], bars[1], bars[2], bars[3]);
  for (const sightline::ExactLine& line : both.lines) {
    const Eigen::Vector3d p = line.contact(bars[3]).point;
    std::printf("meets the last line in (%.15g, %.15g, %g), %s\n", p.x(), p.y(), p.z(),
                line.meets(bars[3]) == sightline::SegmentContact::Interior
                    ? "within the bar"
                    : "beyond the bar");
  }

  // As bars: one of them is left.
  const sightline::SegmentTransversals found = sightline::transversals_of_segments(bars);
  std::printf("%zu line(s) through all four bars\n", found.lines.size());

  return both.lines.size() == 2 && found.lines.size() == 1 ? 0 : 1;
}
