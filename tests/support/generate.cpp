// sightline_generate: writes one of the test scenes as an OBJ file.
//
//   sightline_generate city --polygons 10000 --seed 1 -o city.obj

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/support/generators.h"

namespace {

using namespace sightline::testing;

constexpr const char* kUsage =
    "usage: sightline_generate KIND [--polygons N | --count K] [--seed S] -o FILE.obj\n"
    "  city, grid-city, touching-city   N polygons (default 1000)\n"
    "  polytopes [--vertices V] [--density D], parallelepipeds,\n"
    "  boxes, grid-boxes, rotated-boxes K solids (default 10)\n"
    "  touching:NAME                    boxes that touch, NAME one of:\n";

sightline::PolygonSoup generate(const std::string& kind, std::uint64_t seed, int polygons,
                                int count, int vertices, double density) {
  if (kind == "city") return city(seed, polygons);
  if (kind == "grid-city") return grid_city(seed, polygons);
  if (kind == "touching-city") return grid_city(seed, polygons, {.may_touch = true});
  if (kind == "polytopes") {
    return random_polytopes(
        seed, count,
        {.min_vertices = vertices, .max_vertices = vertices, .density = density});
  }
  if (kind == "parallelepipeds") return random_parallelepipeds(seed, count);
  if (kind == "boxes") return random_boxes(seed, count);
  if (kind == "grid-boxes") {
    return random_boxes(
        seed, count,
        {.grid = 8 + count / 4, .may_touch = true, .min_size = 1, .max_size = 3});
  }
  if (kind == "rotated-boxes") return rotated_boxes(seed, count);
  for (const Touching touching : all_touching()) {
    if (kind == "touching:" + name(touching)) return touching_boxes(touching);
  }
  throw std::invalid_argument("no such kind: " + kind);
}

}  // namespace

int main(int argc, char** argv) {
  std::string kind, output;
  std::map<std::string, std::string> options = {{"--polygons", "1000"},
                                                {"--count", "10"},
                                                {"--seed", "1"},
                                                {"--vertices", "8"},
                                                {"--density", "0.1"}};
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "-o" && i + 1 < argc) {
      output = argv[++i];
    } else if (options.contains(argument) && i + 1 < argc) {
      options[argument] = argv[++i];
    } else if (kind.empty() && argument[0] != '-') {
      kind = argument;
    } else {
      kind.clear();
      break;
    }
  }
  if (kind.empty() || output.empty()) {
    std::fprintf(stderr, "%s", kUsage);
    for (const Touching t : all_touching()) std::fprintf(stderr, "  %s", name(t).c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  try {
    write_obj(
        output,
        generate(kind, std::stoull(options["--seed"]), std::stoi(options["--polygons"]),
                 std::stoi(options["--count"]), std::stoi(options["--vertices"]),
                 std::stod(options["--density"])));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sightline_generate: %s\n", error.what());
    return 2;
  }
}
