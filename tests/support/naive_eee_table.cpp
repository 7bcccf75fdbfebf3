// Prints what naive_eee() finds in seeded scenes, and the seconds it takes:
//   sightline_naive_eee_table [FIRST [LAST]]

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "tests/support/eee_scenes.h"
#include "tests/support/naive_eee.h"
#include "tests/support/naive_ev.h"

int main(int argc, char** argv) {
  using namespace sightline;
  const int first = argc > 1 ? std::atoi(argv[1]) : 1;
  const int last = argc > 2 ? std::atoi(argv[2]) : 40;
  std::printf("seed solids edges   VEE   EVE  EEEE   FEE   EEE  seconds\n");
  for (int seed = first; seed <= last; ++seed) {
    const PolygonSoup soup = testing::eee_scene(seed);
    std::size_t sides = 0;
    for (const auto& polygon : soup.polygons) sides += polygon.size();
    std::printf("%4d %6zu %5zu ", seed, soup.groups.size(), sides / 2);
    const auto start = std::chrono::steady_clock::now();
    try {
      auto n = testing::naive_eee(soup).counts();
      const std::chrono::duration<double> seconds =
          std::chrono::steady_clock::now() - start;
      std::printf("%5d %5d %5d %5d %5d %8.2f\n", n["VEE"], n["EVE"], n["EEEE"], n["FEE"],
                  n["EEE"], seconds.count());
    } catch (const testing::NotGeneral& e) {
      std::printf("not general: %s\n", e.what());
    }
    std::fflush(stdout);
  }
}
