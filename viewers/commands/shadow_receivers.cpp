#include "viewers/commands/shadow_receivers.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewers/commands/command_line.h"
#include "viewers/json_text.h"

namespace sightline::viewers {

std::vector<Receiver> receivers_of(const Scene& scene, const LightSource& light,
                                   const std::vector<std::string>& given,
                                   const std::vector<std::string>& both_sides) {
  std::vector<std::string> names = given;
  if (names.empty()) {
    for (const Object& object : scene.objects()) {
      const bool shines = std::ranges::all_of(object.faces, [&](int f) {
        return std::ranges::binary_search(light.faces, f);
      });
      if (!shines) names.push_back(object.name);
    }
  }
  std::vector<std::uint8_t> two_sided(scene.faces().size(), 0);
  for (const std::string& name : both_sides) {
    for (const int f : scene.faces_named(name)) two_sided[f] = 1;
  }
  std::vector<Receiver> receivers;
  for (const std::string& name : names) {
    Receiver front{name, scene.faces_named(name), true};
    if (front.faces.empty()) {
      throw UsageError(fmt::format("--receivers {}: no face of it with an area is left",
                                   escaped_bytes(name)));
    }
    Receiver back{name + "/back", {}, false};
    for (const int f : front.faces) {
      if (two_sided[f] != 0) back.faces.push_back(f);
    }
    receivers.push_back(std::move(front));
    if (!back.faces.empty()) receivers.push_back(std::move(back));
  }
  return receivers;
}

Shadows shadows_in_time(const Scene& scene, const LightSource& light,
                        const std::vector<Receiver>& receivers, const Request& request) {
  try {
    return find_shadows(scene, light, receivers, request);
  } catch (const Stopped&) {
    Shadows none;
    for (const Receiver& receiver : receivers) none.missing.push_back(receiver.name);
    return none;
  }
}

}  // namespace sightline::viewers
