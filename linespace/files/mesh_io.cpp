// Choosing the reader, loading the file, and scanning text.

#include "linespace/mesh_io.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "linespace/files/gltf.h"
#include "linespace/files/input_file.h"
#include "linespace/files/mesh_io.h"

namespace sightline {
namespace internal {

void refuse(const std::string& path, const std::string& message) {
  throw InvalidInput(path + ": " + message);
}

void refuse_line(const std::string& path, std::size_t line, const std::string& message) {
  throw InvalidInput(path + ":" + std::to_string(line) + ": " + message);
}

std::string load_file(const std::string& path, Stage& stage) {
  stage.check(0);
  std::string bytes = read_whole(path);
  if (bytes.empty()) refuse(told_name(path), "the file is empty");
  return bytes;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kShown = 24;
  std::string shown = "'";
  for (const char c : text.substr(0, kShown)) {
    shown += c >= ' ' && c <= '~' ? c : '?';
  }
  return shown + (text.size() > kShown ? "...'" : "'");
}

std::string one_line(std::string text) {
  constexpr std::size_t kShown = 200;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text.size() > kShown ? text.substr(0, kShown) + "..." : text;
}

std::optional<double> parse_double(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  double value = 0;
  const char* const end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<long long> parse_integer(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  long long value = 0;
  const char* const end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

bool is_number(std::string_view token) {
  if (token.starts_with('+') || token.starts_with('-')) token.remove_prefix(1);
  if (token.empty() || token.front() == '+' || token.front() == '-') return false;
  double value = 0;
  const char* const end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (result.ec == std::errc::invalid_argument) return false;
  // "1.#QNAN": from_chars stops at the '#', which digits or letters follow.
  const std::string_view rest(result.ptr, static_cast<std::size_t>(end - result.ptr));
  return rest.empty() || (rest.size() > 1 && rest.front() == '#' &&
                          std::all_of(rest.begin() + 1, rest.end(), [](unsigned char c) {
                            return std::isalnum(c) != 0;
                          }));
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

bool LineReader::next() {
  if (rest_.empty()) return false;
  stage_.at(size_ - rest_.size(), size_);
  const std::size_t end = rest_.find_first_of("\r\n");
  line_ = rest_.substr(0, end);
  if (end == std::string_view::npos) {
    rest_ = {};
  } else {
    const bool two =
        rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
    rest_.remove_prefix(end + (two ? 2 : 1));
  }
  number_ = next_number_++;
  return true;
}

bool LineReader::next_filled(char comment) {
  while (next()) {
    cut_at(comment);
    if (!rest().empty()) return true;
  }
  return false;
}

namespace {
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
}  // namespace

std::string_view LineReader::rest() const {
  std::string_view text = line_;
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

void LineReader::pass(std::size_t characters) {
  line_ = rest();
  line_.remove_prefix(std::min(characters, line_.size()));
}

std::string_view LineReader::token() {
  while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
  std::size_t n = 0;
  while (n < line_.size() && !is_blank(line_[n])) ++n;
  const std::string_view found = line_.substr(0, n);
  line_.remove_prefix(n);
  return found;
}

double LineReader::number(const char* what) {
  const std::string_view text = token();
  if (text.empty()) refuse(std::string(what) + " is missing");
  const auto value = parse_double(text);
  if (!value) refuse(std::string(what) + " is not a finite number: " + quoted(text));
  return *value;
}

void LineReader::skip_number(const char* what) {
  const std::string_view text = token();
  if (text.empty()) refuse(std::string(what) + " is missing");
  if (!is_number(text)) refuse(std::string(what) + " is no number: " + quoted(text));
}

long long LineReader::integer(const char* what) {
  const std::string_view text = token();
  if (text.empty()) refuse(std::string(what) + " is missing");
  const auto value = parse_integer(text);
  if (!value) refuse(std::string(what) + " is not a whole number: " + quoted(text));
  return *value;
}

void LineReader::end_of_line() {
  const std::string_view text = token();
  if (!text.empty()) refuse("unexpected " + quoted(text));
}

void append_strip_triangle(std::vector<std::vector<int>>& polygons,
                           std::span<const int> strip) {
  const std::size_t n = strip.size();
  if (n < 3) return;
  int a = strip[n - 3], b = strip[n - 2];
  const int c = strip[n - 1];
  if (a == b || b == c || a == c) return;
  if (n % 2 == 0) std::swap(a, b);
  polygons.push_back({a, b, c});
}

namespace {

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return extension;
}

using SoupReader = PolygonSoup (*)(const std::string& path, std::string_view bytes,
                                   Stage& stage);

// Of a format that says nothing of light.
template <SoupReader Read>
MeshFile unlit(const std::string& path, std::string_view bytes, Stage& stage) {
  return {Read(path, bytes, stage), {}};
}

struct Format {
  const char* extension;
  MeshFile (*read)(const std::string& path, std::string_view bytes, Stage& stage);
};
constexpr Format kFormats[] = {
#ifdef SIGHTLINE_HAS_TINYGLTF
    {"glb", read_gltf},       {"gltf", read_gltf},
#endif
    {"obj", unlit<read_obj>}, {"off", unlit<read_off>},
    {"ply", unlit<read_ply>}, {"stl", unlit<read_stl>}};

void check_format(const std::string& path, const std::string& format) {
  const auto known = readable_extensions();
  if (std::find(known.begin(), known.end(), format) != known.end()) return;
  std::string list;
  for (const std::string& name : known) list += " ." + name;
  refuse(told_name(path), (format.empty() ? std::string("no extension tells its format")
                                          : "no mesh format is known by the extension " +
                                                internal::quoted(format)) +
                              "; read are" + list);
}

// Refuses what is not there, and folders, whatever their names end in.
void check_there(const std::string& path) {
  if (path == kStandardInput) return;
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse(path, "no such file");
  if (std::filesystem::is_directory(status)) refuse(path, "is a folder");
}

}  // namespace
}  // namespace internal

MeshFile read_mesh(const std::string& path, const Request& request,
                   const std::string& given_format) {
  using namespace internal;
  Stage stage(request, "reading");
  const std::string own = extension_of(path);
  const std::string format =
      given_format.empty() ? own : extension_of("x." + given_format);
  check_there(path);
  check_format(path, format);
  const std::string bytes = load_file(path, stage);
  const std::string name = told_name(path);
  const auto* const reader =
      std::find_if(std::begin(kFormats), std::end(kFormats),
                   [&](const auto& f) { return format == f.extension; });
  MeshFile soup;
  if (reader != std::end(kFormats)) {
    soup = reader->read(name, bytes, stage);
  } else {
    // By its name, so that what stands beside it is found; else from memory.
    const bool by_name = format == own && path != kStandardInput;
    soup = {read_with_assimp({name, bytes, format, by_name}, stage), {}};
  }
  soup.source = name;
  if (soup.polygons.empty()) refuse(name, "no faces");
  return soup;
}

std::vector<std::string> files_beside(const std::string& path) {
  std::vector<std::string> files;
#ifdef SIGHTLINE_HAS_TINYGLTF
  const std::string extension = internal::extension_of(path);
  const bool may_have_some = extension == "gltf" || extension == "glb";
  std::error_code error;  // a pipe can be read once only
  if (!may_have_some || !std::filesystem::is_regular_file(path, error)) return files;
  try {
    const std::string bytes = internal::read_whole(path);
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    for (const std::string& file :
         internal::buffer_files(internal::check_gltf(path, bytes))) {
      files.push_back((folder / file).string());
    }
  } catch (const InvalidInput&) {
    // read_mesh says why.
  }
#endif
  return files;
}

std::vector<std::string> readable_extensions() {
  auto all = internal::assimp_extensions();
  for (const auto& format : internal::kFormats) all.emplace_back(format.extension);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace sightline
