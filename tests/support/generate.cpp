// sightline_generate: writes one of the test scenes as an OBJ file, or instances for
// `sightline visible` as a JSON file.
//
//   sightline_generate city --polygons 10000 --seed 1 -o city.obj
//   sightline_generate visible:slab --count 100 --occluders 100 --size 0.4 -o slab.json

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/support/generators.h"
#include "tests/support/visibility_cases.h"

namespace {

using namespace sightline::testing;

constexpr const char* kUsage =
    "usage: sightline_generate KIND [--polygons N | --count K] [--seed S] -o FILE\n"
    "  city, grid-city, touching-city   N polygons (default 1000)\n"
    "  street-city, square-city [--bottom Z] [--triangles yes]\n"
    "                                   the same; bottoms at Z (default 0, on the "
    "slab),\n"
    "                                   every quad cut into two triangles\n"
    "  enclosure [--squares N]          a room of N x N squares a wall (default 10) "
    "with K boxes\n"
    "  polytopes [--vertices V] [--density D], parallelepipeds,\n"
    "  boxes, grid-boxes, rotated-boxes K solids (default 10)\n"
    "  visible:slab [--size S],\n"
    "  visible:grid                     K instances with --occluders N (default 10), "
    "JSON\n"
    "  visible:known                    instances with their answers, JSON\n"
    "  touching:NAME                    boxes that touch, NAME one of:\n";

sightline::PolygonSoup generate(const std::string& kind, std::uint64_t seed, int polygons,
                                int count, int vertices, double density, double bottom,
                                int squares) {
  if (kind == "enclosure") return enclosure(seed, squares, count);
  if (kind == "city") return city(seed, polygons);
  if (kind == "grid-city") return grid_city(seed, polygons);
  if (kind == "touching-city") return grid_city(seed, polygons, {.may_touch = true});
  if (kind == "street-city") return street_city(seed, polygons, {.bottom = bottom});
  if (kind == "square-city") {
    return street_city(seed, polygons, {.square = true, .bottom = bottom});
  }
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

/// Instance i has seed + i.
std::vector<VisibilityCase> visibility_cases(const std::string& kind, std::uint64_t seed,
                                             int count, int occluders, double size) {
  if (kind == "visible:known") return known_visibility_cases();
  std::vector<VisibilityCase> cases;
  for (int i = 0; i < count; ++i) {
    const std::string name = kind + " " + std::to_string(seed + i);
    if (kind == "visible:slab") {
      cases.push_back({name, slab_instance(seed + i, occluders, size), std::nullopt});
    } else if (kind == "visible:grid") {
      cases.push_back({name, grid_instance(seed + i, occluders, 3), std::nullopt});
    } else {
      throw std::invalid_argument("no such kind: " + kind);
    }
  }
  return cases;
}

}  // namespace

int main(int argc, char** argv) {
  std::string kind, output;
  std::map<std::string, std::string> options = {
      {"--polygons", "1000"}, {"--count", "10"},    {"--seed", "1"},
      {"--vertices", "8"},    {"--density", "0.1"}, {"--occluders", "10"},
      {"--size", "0.25"},     {"--bottom", "0"},    {"--triangles", "no"},
      {"--squares", "10"}};
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
    const std::uint64_t seed = std::stoull(options["--seed"]);
    const int count = std::stoi(options["--count"]);
    if (kind.starts_with("visible:")) {
      write_visibility_json(
          output, visibility_cases(kind, seed, count, std::stoi(options["--occluders"]),
                                   std::stod(options["--size"])));
    } else {
      const sightline::PolygonSoup soup =
          generate(kind, seed, std::stoi(options["--polygons"]), count,
                   std::stoi(options["--vertices"]), std::stod(options["--density"]),
                   std::stod(options["--bottom"]), std::stoi(options["--squares"]));
      write_obj(output,
                options["--triangles"] == "yes" ? cut_into_triangles(soup) : soup);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sightline_generate: %s\n", error.what());
    return 2;
  }
}
