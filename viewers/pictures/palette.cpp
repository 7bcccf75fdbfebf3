#include "viewers/palette.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "viewers/envelope.h"

namespace sightline::viewers {

Colour colour_of_kind(std::string_view kind) {
  static constexpr std::pair<std::string_view, Colour> kColours[] = {
      {"EV_self", {0.42F, 0.56F, 0.66F}},    {"EV", {0.16F, 0.47F, 0.85F}},
      {"VV", {0.84F, 0.15F, 0.24F}},         {"VEE", {0.95F, 0.55F, 0.05F}},
      {"EVE", {0.10F, 0.60F, 0.36F}},        {"FvE", {0.52F, 0.28F, 0.74F}},
      {"saddle", {0.35F, 0.66F, 0.25F}},     {"pierce", {0.62F, 0.40F, 0.24F}},
      {"degenerate", {0.35F, 0.35F, 0.38F}}, {"EEEE", {0.90F, 0.10F, 0.55F}},
      {"EEE", {0.10F, 0.62F, 0.66F}},        {"FEE", {0.74F, 0.45F, 0.90F}},
      {"in_plane", {0.52F, 0.28F, 0.74F}},   {"portal", {0.55F, 0.57F, 0.62F}},
  };
  for (const auto& [name, colour] : kColours) {
    if (kind == name) return colour;
  }
  // "VV_self" is a washed-out "VV".
  if (kind.ends_with("_self")) {
    const Colour c = colour_of_kind(kind.substr(0, kind.size() - 5));
    return {0.5F * c.red + 0.3F, 0.5F * c.green + 0.3F, 0.5F * c.blue + 0.3F};
  }
  return {0.5F, 0.5F, 0.5F};
}

std::string hex(const Colour& c) {
  const auto byte = [](float v) { return static_cast<int>(std::lround(255 * v)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.red), byte(c.green), byte(c.blue));
}

std::vector<Colour> object_colours(const Scene& scene) {
  static constexpr std::array<Colour, 9> kTones{{{0.80F, 0.62F, 0.42F},
                                                 {0.46F, 0.62F, 0.74F},
                                                 {0.85F, 0.56F, 0.46F},
                                                 {0.55F, 0.68F, 0.52F},
                                                 {0.66F, 0.58F, 0.76F},
                                                 {0.88F, 0.76F, 0.46F},
                                                 {0.48F, 0.68F, 0.68F},
                                                 {0.82F, 0.60F, 0.68F},
                                                 {0.68F, 0.68F, 0.62F}}};
  constexpr Colour kNeutral{0.93F, 0.915F, 0.885F};
  const std::vector<char> envelope = envelope_objects(scene);
  std::map<std::string, std::size_t> words;
  std::vector<Colour> colours;
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    const Object& object = scene.objects()[o];
    if (envelope[o] && scene.objects().size() > 1) {
      colours.push_back(kNeutral);
      continue;
    }
    const std::string word = object.name.substr(0, object.name.find('_'));
    const std::size_t tone = words.try_emplace(word, words.size()).first->second;
    colours.push_back(kTones[tone % kTones.size()]);
  }
  return colours;
}

}  // namespace sightline::viewers
