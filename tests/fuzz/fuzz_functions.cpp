#include "fuzz_functions.h"

#include <array>

#include "linespace/files/mesh_io.h"
#include "tests/support/unhurried.h"
#ifdef SIGHTLINE_FUZZ_VIEWERS
#include "fuzz_viewers.h"
#endif

namespace sightline::fuzz {
namespace {

template <auto read>
void run_reader(const std::string& bytes) {
  try {
    (void)read("fuzz", bytes, test::Unhurried());
  } catch (const InvalidInput&) {
  }
}

// The look at a file before assimp gets it.
template <auto check>
void run_check(const std::string& bytes) {
  try {
    check("fuzz", bytes, test::Unhurried());
  } catch (const InvalidInput&) {
  }
}

constexpr std::array kFunctions{
#ifdef SIGHTLINE_FUZZ_VIEWERS
    Function{"aspects", run_aspects},
    Function{"look", run_look},
    Function{"path", run_path},
    Function{"points", run_points},
    Function{"portals", run_portals},
    Function{"skeleton", run_skeleton},
    Function{"transversals", run_transversals},
    Function{"visible", run_visible},
#endif
    Function{"gltf", run_reader<internal::read_gltf>},
    Function{"obj", run_reader<internal::read_obj>},
    Function{"off", run_reader<internal::read_off>},
    Function{"ply", run_reader<internal::read_ply>},
    Function{"stl", run_reader<internal::read_stl>},
    Function{"collada", run_check<internal::check_collada>},
    Function{"step", run_check<internal::check_step>}};

}  // namespace

std::span<const Function> functions() { return kFunctions; }

}  // namespace sightline::fuzz
