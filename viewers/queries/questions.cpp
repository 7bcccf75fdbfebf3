#include "viewers/questions.h"

#include <string_view>

#include "linespace/portals.h"

namespace sightline::viewers {
namespace {

std::vector<LineThrough> lines_of(const JsonInput& file, const char* key) {
  std::vector<LineThrough> out;
  if (!file.has(key)) return out;
  for (const JsonInput& item : file.at(key).items()) {
    const auto [from, to] = item.two_points();
    out.push_back({from, to});
  }
  return out;
}

/// The portal at `item`, refused there when it is no convex polygon.
std::vector<Point> portal_of(const JsonInput& item) {
  std::vector<Point> portal = item.points(1);
  try {
    SeparatingPlanesSequence().push(portal);
  } catch (const InvalidInput& refusal) {
    const std::string_view what = refusal.what();
    item.refuse(what.substr(what.find(": ") + 2));
  }
  return portal;
}

}  // namespace

TransversalsQuestion transversals_question(const JsonInput& file) {
  if (!file.has("segments") && !file.has("lines")) {
    file.refuse("has neither \"segments\" nor \"lines\"");
  }
  return {lines_of(file, "segments"), lines_of(file, "lines")};
}

PortalsQuestion portals_question(const JsonInput& file) {
  PortalsQuestion portals;
  for (const JsonInput& item : file.at("portals").items()) {
    portals.push_back(portal_of(item));
  }
  return portals;
}

std::vector<VisibilityQuestion> visibility_questions(const JsonInput& file) {
  std::vector<VisibilityQuestion> questions;
  for (const JsonInput& instance : file.at("instances").items()) {
    VisibilityQuestion& q = questions.emplace_back();
    q.a = instance.at("a").points(3);
    q.b = instance.at("b").points(3);
    if (!instance.has("occluders")) continue;
    for (const JsonInput& occluder : instance.at("occluders").items()) {
      q.occluders.push_back(occluder.points(1));
    }
  }
  return questions;
}

}  // namespace sightline::viewers
