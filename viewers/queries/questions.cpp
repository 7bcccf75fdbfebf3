#include "viewers/questions.h"

#include <fmt/format.h>

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

/// The texts between the commas, as many as `expected`, such as "x,y,z", names.
template <std::size_t N>
std::array<std::string, N> texts_of(const std::string& text, const char* expected) {
  std::array<std::string, N> texts;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = text.find(',', begin);
    if ((end == std::string::npos) != (i + 1 == N))
      throw InvalidInput(fmt::format("expected {}", expected));
    texts[i] = text.substr(begin, end - begin);
    begin = end + 1;
  }
  return texts;
}

/// viewpoint(), refused here where PointViewIndex would refuse it.
Viewpoint viewpoint_in_range(Viewpoint::Kind kind,
                             const std::array<std::string, 3>& asked) {
  Viewpoint eye = viewpoint(kind, asked);
  for (int i = 0; i < 3; ++i) {
    if (is_admissible(eye.at.nearest[i])) continue;
    throw InvalidInput(
        fmt::format("the eye: coordinate {} has a magnitude outside [2^-140, 2^140]", i));
  }
  return eye;
}

ViewQuestion question_at(Viewpoint::Kind kind, const JsonInput& where) {
  const std::array<std::string, 3> asked = where.coordinates();
  try {
    return {viewpoint_in_range(kind, asked), asked, where.told()};
  } catch (const InvalidInput& refusal) {
    where.refuse(refusal.what());
  }
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

std::vector<ViewQuestion> view_questions(const JsonInput& file) {
  std::vector<ViewQuestion> questions;
  for (const JsonInput& view : file.at("views").items()) {
    const bool from = view.has("from");
    if (from == view.has("direction")) {
      view.refuse(R"(expected either "from" or "direction")");
    }
    questions.push_back(
        question_at(from ? Viewpoint::Kind::Eye : Viewpoint::Kind::Direction,
                    view.at(from ? "from" : "direction")));
  }
  if (questions.empty()) file.at("views").refuse("expected at least one view");
  return questions;
}

std::vector<Viewpoint> path_question(const JsonInput& file) {
  const bool points = file.has("points");
  if (points == file.has("directions")) {
    file.refuse(R"(expected either "points" or "directions")");
  }
  const JsonInput list = file.at(points ? "points" : "directions");
  std::vector<Viewpoint> path;
  for (const JsonInput& item : list.items()) {
    path.push_back(
        question_at(points ? Viewpoint::Kind::Eye : Viewpoint::Kind::Direction, item)
            .eye);
  }
  if (path.size() < 2) list.refuse("expected at least two");
  return path;
}

ViewQuestion view_question(Viewpoint::Kind kind, const std::string& option,
                           const std::string& text) {
  try {
    const std::array<std::string, 3> asked = texts_of<3>(text, "x,y,z");
    return {viewpoint_in_range(kind, asked), asked, fmt::format("{} {}", option, text)};
  } catch (const InvalidInput& refusal) {
    throw InvalidInput(fmt::format("{} '{}': {}", option, text, refusal.what()));
  }
}

BoxQuestion box_question(const std::string& option, const std::string& text) {
  try {
    const std::array<std::string, 6> asked = texts_of<6>(text, "x0,y0,z0,x1,y1,z1");
    return {view_box(asked), asked};
  } catch (const InvalidInput& refusal) {
    throw InvalidInput(fmt::format("{} '{}': {}", option, text, refusal.what()));
  }
}

}  // namespace sightline::viewers
