// Files that depart from the letter of their format, as other programs write them, and
// say plainly what is meant: each kind with 100 seeded neighbours.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "linespace/files/mesh_io.h"
#include "linespace/mesh_io.h"
#include "tests/support/unhurried.h"

namespace sightline {
namespace {

using Random = std::mt19937;
constexpr int kNeighbours = 100;

std::string data(const std::string& name) {
  return std::string(SIGHTLINE_TEST_DATA) + "/" + name;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

// One of the strings, by chance.
template <std::size_t N>
std::string any_of(const std::array<const char*, N>& choices, Random& random) {
  return choices[random() % N];
}

void expect_unit_cube(PolygonSoup soup, std::size_t defects = 0) {
  const Scene scene(std::move(soup));
  EXPECT_EQ(scene.points().size(), 8u);
  EXPECT_EQ(scene.facets().size(), 6u);
  EXPECT_EQ(scene.mesh_edges().convex, 12);
  EXPECT_EQ(scene.solids(), 1);
  EXPECT_EQ(scene.bounds()[0], Point(0, 0, 0));
  EXPECT_EQ(scene.bounds()[1], Point(1, 1, 1));
  EXPECT_EQ(scene.defects().size(), defects);
}

std::string complaint(const std::function<void()>& read) {
  try {
    read();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(ReadableMesh, CubesAsTheyAreFound) {
  for (const char* const name :
       {"mark.obj", "mark.off", "mark.ply", "glued.off", "no_header.off",
        "nan_normals_ascii.ply", "nan_normals_binary.ply", "infinite_quality.ply",
        "leading_blank.stl", "rows_over_lines.ply", "strips.ply"}) {
    SCOPED_TRACE(name);
    expect_unit_cube(read_mesh(data("readable/") + name));
  }
}

TEST(ReadableMesh, ByteOrderMarkBeforeAnyText) {
  const std::array<const char*, 4> files{"cube.obj", "cube.off", "cube_ascii.ply",
                                         "cube_ascii.stl"};
  using Reader = PolygonSoup (*)(const std::string&, std::string_view, internal::Stage&);
  const std::array<Reader, 4> readers{internal::read_obj, internal::read_off,
                                      internal::read_ply, internal::read_stl};
  Random random(1);
  for (int i = 0; i < kNeighbours; ++i) {
    const std::size_t k = random() % 4;
    SCOPED_TRACE(files[k]);
    std::string text = bytes_of(data("formats/") + files[k]);
    const std::string end = any_of(std::array{"\n", "\r\n", "\r"}, random);
    std::string written = "\xEF\xBB\xBF";
    for (const char c : text) {
      if (c == '\n') written += end;
      if (c == ' ' && random() % 4 == 0) written += ' ';
      if (c != '\n') written += c;
    }
    expect_unit_cube(readers[k]("marked", written, test::Unhurried()));
  }
}

// Names of `o` and `g` with a '#' in them; a comment begins a line or follows numbers.
TEST(ReadableMesh, HashInsideAnObjName) {
  const PolygonSoup parts = read_mesh(data("readable/hash_in_names.obj"));
  ASSERT_EQ(parts.groups.size(), 2u);
  EXPECT_EQ(parts.groups[0].name, "Part #1");
  EXPECT_EQ(parts.groups[1].name, "Part #2");
  EXPECT_EQ(parts.groups[0].faces, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(parts.groups[1].faces, (std::vector<int>{3, 4, 5}));

  Random random(2);
  const std::array beginnings{"Part", "a b", "#", "C#", "wall", "1"};
  const std::array ends{"#", " #", "# ", " # ", "##", " ##x"};
  for (int i = 0; i < kNeighbours; ++i) {
    const std::string word = i % 2 == 0 ? "o " : "g ";
    std::string begin = any_of(beginnings, random);
    if (word == "g " && begin == "a b") begin = "ab";
    std::string end = any_of(ends, random);
    if (word == "g " && end == "# ") end = " # ";  // a blank ends a name of `g`
    std::string text = "# v 9 9 9\n  # indented\nv 0 0 0 # f 1 1 1\nv 1 0 0#x\nv 0 1 0\n";
    for (const char* const number : {"1", "2"}) {
      text += word + begin + end + number + "\nf 1 2 3 # o no\n#o no\n";
    }
    SCOPED_TRACE(text);
    const PolygonSoup soup = internal::read_obj("names", text, test::Unhurried());
    ASSERT_EQ(soup.groups.size(), 2u);
    EXPECT_EQ(soup.groups[0].name, begin + end + "1");
    EXPECT_EQ(soup.groups[1].name, begin + end + "2");
    EXPECT_EQ(soup.groups[1].faces, std::vector<int>{1});
    EXPECT_EQ(soup.vertices.size(), 3u);
  }
}

TEST(ReadableMesh, NamesKeepTheBytesOfTheFile) {
  const Scene scene(read_mesh(data("readable/latin1.obj")));
  ASSERT_EQ(scene.objects().size(), 2u);
  EXPECT_EQ(scene.faces_named("T\xFCr").size(), 3u);
  EXPECT_EQ(scene.faces_named("W\xE4nde").size(), 3u);
}

TEST(ReadableMesh, ObjRefusesSurfacesThatItDoesNotRead) {
  for (const char* const line : {"surf 0 1 0 1 1 2 3", "call other.obj", "bzp 1 2 3 4"}) {
    const std::string text = std::string("v 0 0 0\n") + line + "\n";
    const std::string message = complaint(
        [&] { (void)internal::read_obj("surfaces.obj", text, test::Unhurried()); });
    EXPECT_TRUE(message.starts_with("surfaces.obj:2: ")) << message;
    EXPECT_NE(message.find("not read here"), std::string::npos) << message;
  }
}

TEST(ReadableMesh, OffWithAnyHeader) {
  Random random(3);
  const std::string cube = bytes_of(data("readable/no_header.off"));
  const std::size_t counts = cube.find('\n') + 1;
  for (int i = 0; i < kNeighbours; ++i) {
    const std::string header = any_of(
        std::array{"", "OFF", "COFF", "NOFF", "CNOFF", "NCOFF", "STOFF", "STCNOFF"},
        random);
    std::string text =
        any_of(std::array{"", "# made by hand\n", "\n\n"}, random) + header;
    if (!header.empty()) {
      text += any_of(std::array{"", " ", "\n", " # a cube\n", "\r\n", "\n#\n\n"}, random);
    }
    text += any_of(std::array{"8 6 12", "8 6 0", "8 6"}, random) + "\n";
    // What follows the coordinates is not used, and need not be finite.
    const std::string more =
        header.empty() || header == "OFF"
            ? ""
            : " " + any_of(std::array{"0 0 1", "nan nan nan", "255 0 0 1"}, random);
    std::istringstream lines(cube.substr(counts));
    std::string line;
    for (int n = 0; std::getline(lines, line); ++n)
      text += line + (n < 8 ? more : "") + "\n";
    SCOPED_TRACE(text);
    expect_unit_cube(internal::read_off("headers", text, test::Unhurried()));
  }
  for (const char* const header : {"OFFSET", "OFFx8 6 12", "XOFF", "4OFF", "OF"}) {
    EXPECT_THROW((void)internal::read_off("h", std::string(header) + "\n8 6 12\n",
                                          test::Unhurried()),
                 InvalidInput);
  }
}

// x, y, z among other columns, whose values are written in every spelling that is met.
TEST(ReadableMesh, PlyColumnsThatAreNotUsedMayHoldAnything) {
  const std::array spellings{"nan", "-nan",  "NaN",       "-nan(ind)", "-1.#IND",
                             "inf", "-inf",  "1.#QNAN",   "-1.#IND00", "1.#INF",
                             "0",   "1e999", "-1.5e-999", "1.#SNAN"};
  const std::array columns{"nx", "quality", "red", "u"};
  const std::string cube = bytes_of(data("readable/no_header.off"));
  Random random(4);
  for (int i = 0; i < kNeighbours; ++i) {
    // Which of five columns come before, between and after x, y and z.
    std::array<std::size_t, 4> extra;
    for (auto& n : extra) n = random() % 3;
    std::string header = "ply\nformat ascii 1.0\nelement vertex 8\n";
    for (std::size_t axis = 0; axis < 4; ++axis) {
      for (std::size_t n = 0; n < extra[axis]; ++n) {
        header += "property float " + std::string(columns[random() % 4]) + "\n";
      }
      if (axis < 3) header += std::string("property double ") + "xyz"[axis] + "\n";
    }
    header += "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
    const bool spoilt = i % 4 == 0;
    const int spoilt_row = static_cast<int>(random() % 8);
    std::istringstream lines(cube.substr(cube.find('\n') + 1));
    std::string line, body;
    for (int row = 0; row < 14 && std::getline(lines, line); ++row) {
      std::istringstream values(line);
      for (std::size_t axis = 0; axis < 4 && row < 8; ++axis) {
        for (std::size_t n = 0; n < extra[axis]; ++n)
          body += any_of(spellings, random) + " ";
        std::string value;
        values >> value;
        if (axis == 1 && spoilt && row == spoilt_row) value = "nan";
        body += value + " ";
      }
      body += (row < 8 ? "" : line) + "\n";
    }
    SCOPED_TRACE(header + body);
    if (spoilt) {
      EXPECT_THROW((void)internal::read_ply("columns", header + body, test::Unhurried()),
                   InvalidInput);
    } else {
      expect_unit_cube(internal::read_ply("columns", header + body, test::Unhurried()));
    }
  }
  for (const char* const no_number :
       {"nano", "1.#", "#IND", "1..2", "+-1", "", "1e", "x"}) {
    EXPECT_FALSE(internal::is_number(no_number)) << no_number;
  }
}

TEST(ReadableMesh, PlyRowsOverSeveralLines) {
  const std::string cube = bytes_of(data("formats/cube_ascii.ply"));
  const std::size_t body = cube.find("end_header\n") + 11;
  Random random(5);
  for (int i = 0; i < kNeighbours; ++i) {
    std::string text = cube.substr(0, body);
    for (const char c : cube.substr(body)) {
      text += c == ' ' && random() % 3 == 0
                  ? any_of(std::array{"\n", "\n\n", " \n ", "\r\n"}, random)
                  : std::string(1, c);
    }
    expect_unit_cube(internal::read_ply("rows", text, test::Unhurried()));
    // A value too many or too few is still noticed.
    const std::size_t blank = text.find(' ', body);
    if (blank == std::string::npos) continue;
    std::string more = text, fewer = text;
    more.insert(blank, " 0");
    fewer.erase(body, blank - body);
    EXPECT_THROW((void)internal::read_ply("more", more, test::Unhurried()), InvalidInput)
        << more;
    EXPECT_THROW((void)internal::read_ply("fewer", fewer, test::Unhurried()),
                 InvalidInput)
        << fewer;
  }
}

// Strips of random corners against the definition, triangle by triangle.
TEST(ReadableMesh, PlyTriangleStrips) {
  Random random(6);
  for (int i = 0; i < kNeighbours; ++i) {
    std::string list;
    std::vector<std::vector<int>> expected;
    int length = 0;
    for (int strip = 0; strip < 1 + i % 4; ++strip) {
      if (strip > 0) list += " -1";
      length += strip > 0 ? 1 : 0;
      std::vector<int> corners(random() % 9);
      for (int& corner : corners) {
        corner = static_cast<int>(random() % 5);
        list += " " + std::to_string(corner);
      }
      length += static_cast<int>(corners.size());
      for (std::size_t k = 0; k + 2 < corners.size(); ++k) {
        const int a = corners[k], b = corners[k + 1], c = corners[k + 2];
        if (a == b || b == c || a == c) continue;
        expected.push_back(k % 2 == 0 ? std::vector{a, b, c} : std::vector{b, a, c});
      }
    }
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
        "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n" +
        std::to_string(length) + list + "\n";
    EXPECT_EQ(internal::read_ply("strips", text, test::Unhurried()).polygons, expected)
        << text;
  }
  const std::string beyond =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
      "end_header\n0 0 0\n3 0 0 7\n";
  EXPECT_TRUE(internal::read_ply("beyond", beyond, test::Unhurried())
                  .polygons.empty());  // no triangle
  std::string out_of_range = beyond;
  out_of_range.replace(out_of_range.find("3 0 0 7"), 7, "3 0 1 7");
  EXPECT_THROW((void)internal::read_ply("beyond", out_of_range, test::Unhurried()),
               InvalidInput);
}

TEST(ReadableMesh, SpareBytesAfterBinaryStlAreTold) {
  for (const char* const name :
       {"spare_byte.stl", "spare_text.stl", "spare_byte_after_solid.stl"}) {
    SCOPED_TRACE(name);
    const PolygonSoup soup = read_mesh(data("readable/") + name);
    ASSERT_EQ(soup.defects.size(), 1u);
    EXPECT_EQ(soup.defects[0].kind, "spare bytes");
    expect_unit_cube(soup, 1);
  }
  const std::string cube = bytes_of(data("formats/cube_binary.stl"));
  Random random(7);
  for (int i = 0; i < kNeighbours; ++i) {
    std::string bytes = cube;
    const std::string comment =
        any_of(std::array{"solid x", "binary", "solid\nfacets of a cube", " solid",
                          "\xEF\xBB\xBFsolid"},
               random);
    std::fill(bytes.begin(), bytes.begin() + 80, i % 2 == 0 ? '\0' : ' ');
    std::copy(comment.begin(), comment.end(), bytes.begin());
    for (std::size_t n = random() % 5 * (random() % 60); n > 0; --n) {
      bytes += i % 3 == 0 ? static_cast<char>(random() % 256) : "solid facet\n"[n % 12];
    }
    expect_unit_cube(internal::read_stl("spare", bytes, test::Unhurried()),
                     bytes.size() > cube.size() ? 1 : 0);
    // Shorter than its count: told with both sizes.
    const std::string message = complaint([&] {
      (void)internal::read_stl("short", bytes.substr(0, 84 + random() % 600),
                               test::Unhurried());
    });
    EXPECT_NE(message.find("announces 12 triangles, that is 684 bytes"),
              std::string::npos)
        << message;
  }
}

TEST(ReadableMesh, BlanksAnywhereInAsciiStl) {
  const std::string cube = bytes_of(data("formats/cube_ascii.stl"));
  Random random(8);
  for (int i = 0; i < kNeighbours; ++i) {
    std::istringstream lines(cube);
    std::string text, line;
    for (bool first = true; std::getline(lines, line); first = false) {
      std::istringstream words(line);
      std::string word;
      while (words >> word) {
        // A name ends with its line.
        const bool named = first || line.starts_with("endsolid");
        text += named ? any_of(std::array{" ", "\t", "  "}, random)
                      : any_of(std::array{" ", "\n", "\t \n ", "\r\n"}, random);
        text += word;
      }
      if (first) text += "\n";
    }
    if (i % 2 == 0) text.insert(0, any_of(std::array{"\n", "\n \n", "\r\n"}, random));
    SCOPED_TRACE(text);
    expect_unit_cube(internal::read_stl("blanks", text, test::Unhurried()));
    // A broken text is told as text, with its line.
    std::string broken = text;
    std::size_t at = random() % broken.size();
    while (std::isalpha(static_cast<unsigned char>(broken[at])) == 0 ||
           (at > text.find("solid") + 4 && at < text.find('\n', text.find("solid")))) {
      at = random() % broken.size();
    }
    broken[at] = i % 2 == 0 ? '_' : '\x01';
    const std::string message =
        complaint([&] { (void)internal::read_stl("broken", broken, test::Unhurried()); });
    if (at < text.rfind("endsolid") + 8) {
      EXPECT_TRUE(message.starts_with("broken:")) << message;
      EXPECT_EQ(message.find("triangles, that is"), std::string::npos) << message;
      EXPECT_NE(message, "") << broken;
    }
  }
}

// Faces of any number of corners, none of which any vertex answers to.
TEST(ReadableMesh, FacesWithoutVerticesAreRefused) {
  Random random(9);
  for (int i = 0; i < kNeighbours; ++i) {
    std::string rows;
    const int faces = 1 + static_cast<int>(random() % 5);
    for (int f = 0; f < faces; ++f) rows += "0\n";
    const std::string count = std::to_string(faces);
    const std::string off = "OFF\n0 " + count + " 0\n" + rows;
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
        "property float z\nelement face " +
        count + "\nproperty list uchar int vertex_indices\nend_header\n" + rows;
    const std::string message = complaint([&] {
      const Scene scene(i % 2 == 0 ? internal::read_off("none", off, test::Unhurried())
                                   : internal::read_ply("none", ply, test::Unhurried()));
    });
    EXPECT_EQ(message, "no vertices");
  }
}

}  // namespace
}  // namespace sightline
