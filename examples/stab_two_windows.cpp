// Which lines pass through two windows and a door: grow the sequence one opening at a
// time, and look at the extremal stabbing lines that bound the view.  One task, top to
// bottom.

#include <cstdio>
#include <vector>

#include "linespace/portals.h"

int main() {
  using Polygon = std::vector<Eigen::Vector3d>;
  const Polygon window{{0, 0, 1}, {2, 0, 1}, {2, 0, 2}, {0, 0, 2}};
  const Polygon door{{1, 3, 0}, {2, 3, 0}, {2, 3, 2}, {1, 3, 2}};
  const Polygon far_window{{2.5, 6, 1}, {5, 6, 1}, {5, 6, 2}, {2.5, 6, 2}};

  sightline::PortalSequence sequence;
  sequence.push(window);
  sequence.push(door);
  // Corner to corner: every pair is an extremal line.
  std::printf("window and door: %zu extremal lines\n", sequence.extremal_lines().size());
  const bool sixteen = sequence.extremal_lines().size() == 16;

  // What is seen of the far window is bounded by lines that also graze the door.
  sequence.push(far_window);
  for (const auto& line : sequence.extremal_lines()) {
    std::printf("  %-10s", sightline::name(line.kind).data());
    for (const auto& contact : line.contacts) {
      std::printf(" (%g, %g, %g)", contact.at.x(), contact.at.y(), contact.at.z());
    }
    std::printf("\n");
  }
  // A line for anybody to check: it passes through all three interiors.
  const auto witness = sequence.witness();
  if (!witness || !witness->interior) return 1;
  const auto& [from, to] = witness->points;
  std::printf("through all three: (%.17g, %.17g, %.17g) to (%.17g, %.17g, %.17g)\n",
              from.x(), from.y(), from.z(), to.x(), to.y(), to.z());
  if (!witness->exact_in_doubles)
    std::printf("  (rounded; witness->rational is exact)\n");

  // One more window, to the side: no line bends around the corner.
  sequence.push(Polygon{{0, 9, 1}, {2, 9, 1}, {2, 9, 2}, {0, 9, 2}});
  std::printf("and back to the left: %s\n",
              sequence.stabbable() ? "stabbable" : "not stabbable");
  return sixteen && !sequence.stabbable() ? 0 : 1;
}
