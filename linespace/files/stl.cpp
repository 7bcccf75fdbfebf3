// Stereolithography: triangles without shared vertices, ASCII or binary.
//
// Blanks and line ends may stand anywhere between the words of the ASCII form; the name
// of a solid ends with its line.

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>

#include "linespace/files/mesh_io.h"

namespace sightline::internal {
namespace {

constexpr std::size_t kHeaderBytes = 84;    // 80 of comment, 4 of count
constexpr std::size_t kTriangleBytes = 50;  // normal, 3 corners, 2 spare bytes

std::uint32_t little_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) {
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

void append_triangle(PolygonSoup& soup) {
  const int n = static_cast<int>(soup.vertices.size());
  soup.polygons.push_back({n - 3, n - 2, n - 1});
}

PolygonSoup read_binary(const std::string& path, std::string_view bytes,
                        std::uint32_t count, Stage& stage) {
  if (count > std::numeric_limits<int>::max() / 3) refuse(path, "too many triangles");
  PolygonSoup soup;
  soup.vertices.reserve(std::size_t{3} * count);
  soup.polygons.reserve(count);
  for (std::size_t f = 0; f < count; ++f) {
    stage.at(f, count);
    const char* at = bytes.data() + kHeaderBytes + kTriangleBytes * f + 12;
    for (int corner = 0; corner < 3; ++corner) {
      Point p;
      for (double& x : p) {
        x = static_cast<double>(std::bit_cast<float>(little_endian(at)));
        at += 4;
        if (!std::isfinite(x)) {
          refuse(path, "triangle " + std::to_string(f) +
                           " has a coordinate that is not finite");
        }
      }
      soup.vertices.push_back(p);
    }
    append_triangle(soup);
  }
  return soup;
}

bool same_word(std::string_view token, std::string_view lower_case) {
  return std::equal(
      token.begin(), token.end(), lower_case.begin(), lower_case.end(),
      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

class AsciiReader {
 public:
  AsciiReader(const std::string& path, std::string_view text, Stage& stage)
      : path_(path), lines_(path, text, stage) {}

  PolygonSoup read() {
    if (!lines_.next_filled()) refuse(path_, "no solid");
    do {
      read_solid();
    } while (lines_.next_filled());
    // One solid's name says no more than the file's; several tell parts apart.
    if (soup_.groups.size() < 2) soup_.groups.clear();
    return std::move(soup_);
  }

 private:
  void read_solid() {
    require(lines_.token(), "solid");
    const std::string name(lines_.rest());
    auto& groups = soup_.groups;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& g) { return g.name == name; });
    if (group == groups.end() && !name.empty()) {
      groups.push_back({name, {}});
      group = groups.end() - 1;
    }
    next_line();
    for (;;) {
      const std::string_view found = word();
      if (same_word(found, "endsolid")) return;
      if (!same_word(found, "facet")) lines_.refuse("no facet: " + quoted(found));
      read_facet();
      if (group != groups.end()) {
        group->faces.push_back(static_cast<int>(soup_.polygons.size()) - 1);
      }
    }
  }

  // Normals are not used: the corners' order tells the front.
  void read_facet() {
    std::string_view found = word();
    if (same_word(found, "normal")) found = word();
    while (is_number(found)) found = word();
    require(found, "outer");
    require(word(), "loop");
    for (int corner = 0; corner < 3; ++corner) {
      require(word(), "vertex");
      Point p;
      for (double& x : p) {
        if (lines_.rest().empty()) next_line();
        x = lines_.number("a coordinate");
      }
      soup_.vertices.push_back(p);
    }
    require(word(), "endloop");
    require(word(), "endfacet");
    append_triangle(soup_);
  }

  // The next word, on whatever line.
  std::string_view word() {
    if (lines_.rest().empty()) next_line();
    return lines_.token();
  }

  void next_line() {
    if (!lines_.next_filled()) {
      refuse(path_, "ends inside triangle " + std::to_string(soup_.polygons.size()) +
                        " or before 'endsolid'");
    }
  }

  void require(std::string_view found, std::string_view expected) {
    if (!same_word(found, expected)) {
      lines_.refuse(quoted(expected) + " expected, found " + quoted(found));
    }
  }

  const std::string& path_;
  LineReader lines_;
  PolygonSoup soup_;
};

// Whether a file is text although its size would do for a binary one: its first word is
// "solid", and the next line that is not empty begins with the word "facet" or
// "endsolid".
bool begins_as_text(std::string_view text, Stage& stage) {
  const std::string no_path;
  LineReader lines(no_path, text, stage);
  if (!lines.next_filled() || !same_word(lines.token(), "solid")) return false;
  if (!lines.next_filled()) return false;
  const std::string_view word = lines.token();
  return same_word(word, "facet") || same_word(word, "endsolid");
}

// Whether a damaged file was a text: hardly any byte is one that only binary files have
// (bytes above 127 may be of a name).  In a binary file at least 2 of 50 bytes are: the
// two spare ones of each triangle, which are 0.
bool is_mostly_text(std::string_view bytes) {
  const auto strange = std::count_if(bytes.begin(), bytes.end(), [](unsigned char c) {
    return c < ' ' && (c < '\t' || c > '\r');
  });
  return static_cast<std::size_t>(strange) < (bytes.size() + 63) / 64;
}

void report_spare_bytes(PolygonSoup& soup, std::size_t needed, std::size_t there) {
  if (there == needed) return;
  soup.defects.push_back({"spare bytes",
                          std::to_string(there - needed) +
                              " bytes follow the last of the triangles that the file "
                              "announces: not read",
                          {},
                          {}});
}

}  // namespace

// A binary file has 80 bytes of comment, which may begin with "solid" too, a count, and
// so many triangles; what follows is spare.  In a text, the bytes of the count are
// characters and announce more triangles than any file holds.
PolygonSoup read_stl(const std::string& path, std::string_view bytes, Stage& stage) {
  const std::string_view text = without_byte_order_mark(bytes);
  if (bytes.size() < kHeaderBytes) return AsciiReader(path, text, stage).read();
  const std::uint32_t count = little_endian(bytes.data() + 80);
  const std::size_t needed = kHeaderBytes + kTriangleBytes * std::size_t{count};
  const bool holds_all = count > 0 && bytes.size() >= needed;
  if (bytes.size() == needed ||
      (holds_all && !(begins_as_text(text, stage) && is_mostly_text(bytes)))) {
    PolygonSoup soup = read_binary(path, bytes, count, stage);
    report_spare_bytes(soup, needed, bytes.size());
    return soup;
  }
  if (!begins_as_text(text, stage) && !is_mostly_text(bytes)) {
    refuse(path, "announces " + std::to_string(count) + " triangles, that is " +
                     std::to_string(needed) + " bytes, but has " +
                     std::to_string(bytes.size()) + " bytes");
  }
  return AsciiReader(path, text, stage).read();
}

}  // namespace sightline::internal
