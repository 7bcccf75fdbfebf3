// Small inputs for each command, for tests that try many command lines.

#pragma once

#include <filesystem>
#include <fstream>

namespace sightline::test {

/// Writes s.obj, two tetrahedra a and b; t.json, four segments; p.json, two portals.
inline void write_questions(const std::filesystem::path& folder) {
  std::ofstream(folder / "s.obj") << "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                     "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
                                     "o b\nv 3 0 0\nv 4 0 0\nv 3 1 0\nv 3 0 1\n"
                                     "f 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
  std::ofstream(folder / "t.json")
      << R"({"segments": [[[2,-3,1],[10,1,1]], [[1,5,11],[5,7,1]],)"
         R"([[-10,-23,-31],[71,-38,-1]], [[11,-40,35],[-7,52,-21]]]})";
  std::ofstream(folder / "p.json") << R"({"portals": [[[0,0,0],[1,0,0],[1,1,0]],)"
                                      R"([[0,0,2],[1,0,2],[1,1,2]]]})";
}

}  // namespace sightline::test
