// Object File Format: ASCII, with or without colours and normals, a line per element.
//
// The word OFF may be left out, or the counts may follow it without a blank ("OFF8 6
// 12"), as in the files of a well-known collection of shapes.

#include <limits>

#include "linespace/files/mesh_io.h"

namespace sightline::internal {
namespace {

// Length of the word at the beginning of `text`: OFF, optionally after ST, C and N, each
// of which says that more numbers follow the coordinates.  0 if there is no such word.
std::size_t header_length(std::string_view text) {
  constexpr std::string_view kWord = "OFF";
  std::string_view rest = text;
  for (bool found = true; found;) {
    found = false;
    for (const std::string_view prefix : {"ST", "C", "N"}) {
      if (!rest.starts_with(prefix)) continue;
      rest.remove_prefix(prefix.size());
      found = true;
    }
  }
  return rest.starts_with(kWord) ? text.size() - rest.size() + kWord.size() : 0;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Moves on to the line with the counts, past the header's word if there is one.
void pass_header(const std::string& path, LineReader& lines) {
  if (!lines.next_filled('#')) refuse(path, "no OFF header");
  const std::string_view line = lines.rest();
  if (is_digit(line.front())) return;
  LineReader words = lines;
  const std::string_view word = words.token();
  const std::size_t length = header_length(word);
  const std::string_view glued = word.substr(length);
  if (length == 0 || (!glued.empty() && !is_digit(glued.front()))) {
    lines.refuse("no OFF header that is read here: " + quoted(word));
  }
  if (words.rest() == "BINARY") lines.refuse("binary OFF is not read here");
  lines.pass(length);
  if (lines.rest().empty() && !lines.next_filled('#')) refuse(path, "no counts");
}

// An element takes at least `bytes` bytes with its line end (the last may lack it).
void check_count(const LineReader& lines, long long count, std::size_t bytes,
                 const char* what) {
  const auto most = static_cast<long long>((lines.bytes_left() + 1) / bytes);
  if (count < 0 || count > most) {
    lines.refuse("announces " + std::to_string(count) + " " + what +
                 ", more than the file can hold");
  }
}

}  // namespace

PolygonSoup read_off(const std::string& path, std::string_view text, Stage& stage) {
  LineReader lines(path, without_byte_order_mark(text), stage);
  pass_header(path, lines);
  const long long vertex_count = lines.integer("the number of vertices");
  const long long face_count = lines.integer("the number of faces");
  if (!lines.rest().empty()) (void)lines.integer("the number of edges");
  lines.end_of_line();
  check_count(lines, vertex_count, 6, "vertices");
  check_count(lines, face_count, 2, "faces");

  PolygonSoup soup;
  soup.vertices.reserve(static_cast<std::size_t>(vertex_count));
  soup.polygons.reserve(static_cast<std::size_t>(face_count));
  for (long long v = 0; v < vertex_count; ++v) {
    if (!lines.next_filled('#')) {
      refuse(path, "ends before vertex " + std::to_string(v) + " of " +
                       std::to_string(vertex_count));
    }
    Point p;
    for (double& x : p) x = lines.number("a coordinate");
    soup.vertices.push_back(p);
  }
  for (long long f = 0; f < face_count; ++f) {
    if (!lines.next_filled('#')) {
      refuse(path, "ends before face " + std::to_string(f) + " of " +
                       std::to_string(face_count));
    }
    const long long size = lines.integer("the number of corners");
    // Each corner takes a blank and a digit.
    if (size < 0 || size > static_cast<long long>(lines.rest().size() / 2 + 1)) {
      lines.refuse("face " + std::to_string(f) + " announces " + std::to_string(size) +
                   " corners, more than its line holds");
    }
    std::vector<int> polygon(static_cast<std::size_t>(size));
    for (int& corner : polygon) {
      const long long index = lines.integer("a corner");
      if (index < 0 || index >= vertex_count) {
        lines.refuse("face " + std::to_string(f) + " names vertex " +
                     std::to_string(index) + " of " + std::to_string(vertex_count));
      }
      corner = static_cast<int>(index);
    }
    soup.polygons.push_back(std::move(polygon));  // a colour may follow
  }
  if (lines.next_filled('#')) lines.refuse("more lines than the header announces");
  return soup;
}

}  // namespace sightline::internal
