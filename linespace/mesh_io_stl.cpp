// Stereolithography: triangles without shared vertices, ASCII or binary.

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>

#include "linespace/mesh_io_internal.h"

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
    expect("solid");
    const std::string name(lines_.rest());
    auto& groups = soup_.groups;
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& g) { return g.name == name; });
    if (group == groups.end() && !name.empty()) {
      groups.push_back({name, {}});
      group = groups.end() - 1;
    }
    for (;;) {
      next_line();
      const std::string_view word = lines_.token();
      if (same_word(word, "endsolid")) return;
      if (!same_word(word, "facet")) lines_.refuse("no facet: " + quoted(word));
      read_facet();
      if (group != groups.end()) {
        group->faces.push_back(static_cast<int>(soup_.polygons.size()) - 1);
      }
    }
  }

  // Normals are not used: the corners' order tells the front.
  void read_facet() {
    next_line();
    expect("outer");
    expect("loop");
    for (int corner = 0; corner < 3; ++corner) {
      next_line();
      expect("vertex");
      Point p;
      for (double& x : p) x = lines_.number("a coordinate");
      lines_.end_of_line();
      soup_.vertices.push_back(p);
    }
    next_line();
    expect("endloop");
    next_line();
    expect("endfacet");
    append_triangle(soup_);
  }

  void next_line() {
    if (!lines_.next_filled()) {
      refuse(path_, "ends inside triangle " + std::to_string(soup_.polygons.size()) +
                        " or before 'endsolid'");
    }
  }

  void expect(std::string_view word) {
    const std::string_view token = lines_.token();
    if (!same_word(token, word)) {
      lines_.refuse(quoted(word) + " expected, found " + quoted(token));
    }
  }

  const std::string& path_;
  LineReader lines_;
  PolygonSoup soup_;
};

}  // namespace

PolygonSoup read_stl(const std::string& path, std::string_view bytes, Stage& stage) {
  // Binary files may begin with "solid" too: the size decides, then the word.
  if (bytes.size() >= kHeaderBytes) {
    const std::uint32_t count = little_endian(bytes.data() + 80);
    const std::size_t needed = kHeaderBytes + kTriangleBytes * std::size_t{count};
    if (bytes.size() == needed) return read_binary(path, bytes, count, stage);
    if (!same_word(bytes.substr(0, 5), "solid")) {
      refuse(path, "announces " + std::to_string(count) + " triangles, that is " +
                       std::to_string(needed) + " bytes, but has " +
                       std::to_string(bytes.size()) + " bytes");
    }
  }
  return AsciiReader(path, bytes, stage).read();
}

}  // namespace sightline::internal
