#include "viewers/queries/shadow_questions.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "linespace/files/input_file.h"
#include "linespace/visibility_map.h"

namespace sightline::viewers {
namespace {

/// A list beside "points", with as many items; empty where the file has none.
std::vector<JsonInput> list_beside(const JsonInput& file, const char* key,
                                   std::size_t points) {
  if (!file.has(key)) return {};
  std::vector<JsonInput> items = file.at(key).items();
  if (items.size() != points) {
    file.at(key).refuse(fmt::format("{} items for {} points", items.size(), points));
  }
  return items;
}

ExactPosition position(const std::array<std::string, 3>& texts) {
  return viewpoint(Viewpoint::Kind::Eye, texts).at;
}

ExactPosition normal(const std::array<std::string, 3>& texts) {
  try {
    return viewpoint(Viewpoint::Kind::Direction, texts).at;
  } catch (const InvalidInput& refusal) {
    throw InvalidInput(fmt::format("the normal: {}", refusal.what()));
  }
}

ShadowQuestion question_of(const Scene& scene, const JsonInput& point,
                           const JsonInput* with_normal, const JsonInput* on) {
  ShadowQuestion question{{}, point.coordinates(), point.told()};
  const JsonInput* at = &point;
  try {
    question.point.at = position(question.asked);
    if (with_normal != nullptr && !with_normal->is_null()) {
      at = with_normal;
      question.point.normal = normal(with_normal->coordinates());
    }
    if (on != nullptr && !on->is_null()) {
      at = on;
      question.point = shadow_point_on(scene, on->whole_number(), question.point.at);
    }
  } catch (const InvalidInput& refusal) {
    const std::string_view what = refusal.what();
    if (what.starts_with(at->told())) throw;
    at->refuse(what);
  }
  return question;
}

std::vector<ShadowQuestion> from_json(const Scene& scene, const JsonInput& file) {
  const std::vector<JsonInput> points = file.at("points").items();
  const std::vector<JsonInput> normals = list_beside(file, "normals", points.size());
  const std::vector<JsonInput> on = list_beside(file, "on", points.size());
  std::vector<ShadowQuestion> questions;
  for (std::size_t i = 0; i < points.size(); ++i) {
    questions.push_back(question_of(scene, points[i],
                                    normals.empty() ? nullptr : &normals[i],
                                    on.empty() ? nullptr : &on[i]));
  }
  return questions;
}

std::vector<ShadowQuestion> from_text(const std::string& file, const std::string& text) {
  std::vector<ShadowQuestion> questions;
  std::istringstream rows(text);
  std::string row;
  for (int line = 1; std::getline(rows, row); ++line) {
    row = row.substr(0, row.find('#'));
    std::ranges::replace(row, ',', ' ');
    std::istringstream words(row);
    std::vector<std::string> numbers;
    for (std::string word; words >> word;) numbers.push_back(word);
    if (numbers.empty()) continue;
    const std::string where = fmt::format("{}:{}", file, line);
    if (numbers.size() != 3 && numbers.size() != 6) {
      throw InvalidInput(fmt::format("{}: expected x,y,z or x,y,z,nx,ny,nz, found {} {}",
                                     where, numbers.size(),
                                     numbers.size() == 1 ? "number" : "numbers"));
    }
    try {
      ShadowQuestion question{{}, {numbers[0], numbers[1], numbers[2]}, where};
      question.point.at = position(question.asked);
      if (numbers.size() == 6)
        question.point.normal = normal({numbers[3], numbers[4], numbers[5]});
      questions.push_back(std::move(question));
    } catch (const InvalidInput& refusal) {
      throw InvalidInput(fmt::format("{}: {}", where, refusal.what()));
    }
  }
  return questions;
}

}  // namespace

std::vector<ShadowQuestion> shadow_questions(const Scene& scene, const std::string& name,
                                             const std::string& bytes) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  std::vector<ShadowQuestion> questions = extension == ".json"
                                              ? from_json(scene, JsonInput(name, bytes))
                                              : from_text(name, bytes);
  if (questions.empty()) throw InvalidInput(name + ": no points");
  return questions;
}

std::vector<ShadowQuestion> shadow_questions(const Scene& scene,
                                             const std::string& file) {
  return shadow_questions(scene, internal::told_name(file),
                          internal::read_whole(file, JsonInput::kLargestFile));
}

}  // namespace sightline::viewers
