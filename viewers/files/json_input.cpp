#include "viewers/json_input.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "linespace/files/input_file.h"
#include "linespace/predicates.h"
#include "viewers/files/json_parse.h"

namespace sightline::viewers {
namespace {

[[noreturn]] void refuse_file(const std::string& file, std::string_view message) {
  throw InvalidInput(fmt::format("{}: {}", file, message));
}

// nlohmann's "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
std::string_view without_number(std::string_view what) {
  const std::size_t end = what.find("] ");
  return end == std::string_view::npos ? what : what.substr(end + 2);
}

nlohmann::json parse(const std::string& file, std::string_view bytes) {
  try {
    return parse_json<nlohmann::json>(bytes);
  } catch (const nlohmann::json::exception& reason) {
    refuse_file(file, fmt::format("not JSON: {}", without_number(reason.what())));
  }
}

}  // namespace

JsonInput::JsonInput(const std::string& file)
    : JsonInput(internal::told_name(file), internal::read_whole(file, kLargestFile)) {}

JsonInput::JsonInput(std::string file, std::string_view bytes) {
  nlohmann::json root = parse(file, bytes);
  document_ =
      std::make_shared<const Document>(Document{std::move(file), std::move(root)});
  value_ = &document_->root;
}

JsonInput::JsonInput(std::shared_ptr<const Document> document,
                     const nlohmann::json& value, std::string where)
    : document_(std::move(document)), value_(&value), where_(std::move(where)) {}

void JsonInput::refuse(std::string_view message) const { refuse_file(told(), message); }

std::string JsonInput::told() const {
  return where_.empty() ? document_->file
                        : fmt::format("{}: {}", document_->file, where_);
}

bool JsonInput::has(std::string_view key) const {
  if (!value_->is_object()) refuse("expected an object");
  return value_->contains(key);
}

JsonInput JsonInput::at(std::string_view key) const {
  if (!has(key)) refuse(fmt::format("has no \"{}\"", key));
  return {document_, *value_->find(key),
          where_.empty() ? std::string(key) : fmt::format("{}.{}", where_, key)};
}

std::vector<JsonInput> JsonInput::items() const {
  if (!value_->is_array()) refuse("expected an array");
  std::vector<JsonInput> out;
  out.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    out.push_back({document_, (*value_)[i], fmt::format("{}[{}]", where_, i)});
  }
  return out;
}

Point JsonInput::point() const {
  if (!value_->is_array() || value_->size() != 3) refuse("expected three finite numbers");
  Point p;
  for (int axis = 0; axis < 3; ++axis) {
    const nlohmann::json& x = (*value_)[static_cast<std::size_t>(axis)];
    if (!x.is_number()) refuse("expected three finite numbers");
    p[axis] = x.get<double>();
    if (!std::isfinite(p[axis])) refuse("expected three finite numbers");
    if (!is_admissible(p[axis])) {
      refuse("a coordinate is neither 0 nor of magnitude from 2^-140 to 2^140");
    }
  }
  return p;
}

bool JsonInput::is_null() const { return value_->is_null(); }

std::string JsonInput::text() const {
  if (!value_->is_string()) refuse("expected a string");
  return value_->get<std::string>();
}

int JsonInput::whole_number() const {
  if (!value_->is_number_unsigned() ||
      value_->get<std::uint64_t>() > std::numeric_limits<int>::max()) {
    refuse("expected a whole number from 0 on");
  }
  return value_->get<int>();
}

std::array<std::string, 3> JsonInput::coordinates() const {
  constexpr const char* kExpected = "expected three numbers or strings \"p/q\"";
  if (!value_->is_array() || value_->size() != 3) refuse(kExpected);
  std::array<std::string, 3> texts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const nlohmann::json& x = (*value_)[axis];
    if (!x.is_number() && !x.is_string()) refuse(kExpected);
    texts[axis] =
        x.is_string() ? x.get<std::string>() : fmt::format("{}", x.get<double>());
  }
  return texts;
}

std::vector<Point> JsonInput::points(std::size_t least) const {
  const std::vector<JsonInput> all = items();
  if (all.size() < least) refuse(fmt::format("expected at least {} points", least));
  std::vector<Point> out;
  out.reserve(all.size());
  for (const JsonInput& item : all) out.push_back(item.point());
  return out;
}

std::array<Point, 2> JsonInput::two_points() const {
  if (!value_->is_array() || value_->size() != 2) refuse("expected two points");
  const std::vector<JsonInput> both = items();
  const std::array<Point, 2> p{both[0].point(), both[1].point()};
  if (p[0] == p[1]) refuse("its two points are the same");
  return p;
}

}  // namespace sightline::viewers
