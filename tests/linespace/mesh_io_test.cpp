#include "linespace/mesh_io.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "linespace/files/mesh_io.h"
#include "tests/support/unhurried.h"

namespace sightline {
namespace {

namespace fs = std::filesystem;

std::string data(const std::string& name) {
  return std::string(SIGHTLINE_TEST_DATA) + "/" + name;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::string extension_of(const std::string& path) {
  return fs::path(path).extension().string().substr(1);
}

bool is_readable(const std::string& path) {
  const auto known = readable_extensions();
  return std::binary_search(known.begin(), known.end(), extension_of(path));
}

// What the reader or the scene says against a file; empty when both take it.
std::string complaint(const std::string& path) {
  try {
    const Scene scene(read_mesh(path));
    return "";
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

TEST(ReadMesh, ReadsTheUnitCubeFromEveryFormat) {
  for (const char* const name :
       {"cube.obj", "cube.off", "cube_ascii.ply", "cube_little.ply", "cube_big.ply",
        "cube_ascii.stl", "cube_binary.stl", "cube.ac", "block.ifc"}) {
    SCOPED_TRACE(name);
    const std::string path = data("formats/") + name;
    if (!is_readable(path)) continue;  // a build without assimp
    const Scene scene(read_mesh(path));
    EXPECT_EQ(scene.soup().source, path);
    EXPECT_EQ(scene.points().size(), 8u);
    EXPECT_EQ(scene.facets().size(), 6u);
    EXPECT_EQ(scene.mesh_edges().convex, 12);
    EXPECT_EQ(scene.bounds()[0], Point(0, 0, 0));
    EXPECT_EQ(scene.bounds()[1], Point(1, 1, 1));
    ASSERT_EQ(scene.objects().size(), 1u);
    EXPECT_TRUE(scene.objects()[0].convex);
    EXPECT_TRUE(validate(scene).empty());
  }
}

TEST(ReadMesh, KeepsDoublesAsWritten) {
  for (const char* const name : {"tenth.obj", "tenth.ply", "tenth.off"}) {
    SCOPED_TRACE(name);
    const PolygonSoup soup = read_mesh(data("formats/") + name);
    ASSERT_EQ(soup.vertices.size(), 3u);
    EXPECT_EQ(soup.vertices[1], Point(0.1, 0, 0));
    EXPECT_EQ(soup.vertices[2][1], 0.1);
    EXPECT_EQ(soup.vertices[2][2], 0.30000000000000004);
    EXPECT_EQ(soup.polygons, (std::vector<std::vector<int>>{{0, 1, 2}}));
  }
}

TEST(MeshIo, ObjNamesOfTheSameFacesMakeOneGroup) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "f 1 2 3\n";
  const PolygonSoup soup = internal::read_obj(
      "x.obj", corners + "g a b c\n" + face + "g b a a\n" + face + "g d\n" + face,
      test::Unhurried());
  ASSERT_EQ(soup.groups.size(), 3u);
  EXPECT_EQ(soup.groups[0].name, "a");
  EXPECT_EQ(soup.groups[0].aliases, std::vector<std::string>{"b"});
  EXPECT_EQ(soup.groups[0].faces, (std::vector<int>{0, 1}));
  EXPECT_EQ(soup.groups[1].name, "c");
  EXPECT_EQ(soup.groups[1].faces, std::vector<int>{0});
  const Scene scene(soup);
  ASSERT_EQ(scene.objects().size(), 2u);
  EXPECT_EQ(scene.objects()[0].name, "a");
  EXPECT_EQ(scene.faces_named("b"), std::vector<int>{0});
  EXPECT_EQ(scene.faces_named("c"), std::vector<int>{0});
}

// A name and a face a line, as the file has them, and no product of the two.
TEST(MeshIo, ObjManyNamesOfManyFacesTakeLittle) {
  constexpr int kMany = 9000;
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\ng";
  for (int i = 0; i < kMany; ++i) text += " n" + std::to_string(i);
  for (int i = 0; i < kMany; ++i) text += "\nf 1 2 3";
  const PolygonSoup soup = internal::read_obj("x.obj", text, test::Unhurried());
  ASSERT_EQ(soup.groups.size(), 1u);
  EXPECT_EQ(soup.groups[0].faces.size(), std::size_t{kMany});
  EXPECT_EQ(soup.groups[0].aliases.size(), std::size_t{kMany} - 1);
  // Each name with a face of its own as well: the lists differ, and would be long.
  for (int i = 0; i < kMany; ++i) text += "\ng n" + std::to_string(i) + "\nf 1 2 3";
  EXPECT_THROW((void)internal::read_obj("x.obj", text, test::Unhurried()), InvalidInput);
}

TEST(ReadMesh, ObjGroupsAndIndices) {
  const PolygonSoup soup = read_mesh(data("formats/groups.obj"));
  EXPECT_EQ(soup.polygons,
            (std::vector<std::vector<int>>{{0, 1, 2}, {0, 2, 1}, {0, 1, 3}, {1, 2, 3}}));
  // Names of `g` lines first: a face under both kinds belongs to the finer one.
  ASSERT_EQ(soup.groups.size(), 4u);
  EXPECT_EQ(soup.groups[0].name, "floor");
  EXPECT_EQ(soup.groups[0].faces, (std::vector<int>{0, 3}));
  EXPECT_EQ(soup.groups[1].name, "wall");
  EXPECT_EQ(soup.groups[1].faces, (std::vector<int>{0}));
  EXPECT_EQ(soup.groups[2].name, "house");
  EXPECT_EQ(soup.groups[2].faces, (std::vector<int>{0, 1}));
  EXPECT_EQ(soup.groups[3].name, "roof");
  EXPECT_EQ(soup.groups[3].faces, (std::vector<int>{2, 3}));
}

TEST(ReadMesh, StlSolidsAreGroupsWhenThereAreSeveral) {
  EXPECT_TRUE(read_mesh(data("formats/cube_ascii.stl")).groups.empty());
  const PolygonSoup soup = read_mesh(data("formats/two_solids.stl"));
  ASSERT_EQ(soup.groups.size(), 2u);
  EXPECT_EQ(soup.groups[1].name, "upper");
  EXPECT_EQ(soup.groups[1].faces, (std::vector<int>{6, 7, 8, 9, 10, 11}));
}

// "right" is mirrored and moved to [3, 4], "left" moved to [0.5, 1.5].
TEST(ReadMesh, GltfNodesAreGroupsAndMirroredOnesKeepTheirOutside) {
  for (const char* const name : {"two_cubes.gltf", "two_cubes.glb"}) {
    SCOPED_TRACE(name);
    if (!is_readable(name)) GTEST_SKIP() << "built without assimp";
    const Scene scene(read_mesh(data("formats/") + name));
    ASSERT_EQ(scene.objects().size(), 2u);
    const int right = scene.object_named("right");
    EXPECT_TRUE(scene.objects()[right].convex);
    EXPECT_TRUE(scene.objects()[scene.object_named("left")].convex);
    EXPECT_EQ(scene.solids(), 2);
    EXPECT_EQ(scene.faces_named("world").size(), 24u);
    double least = 10;
    for (const int f : scene.objects()[right].faces) {
      for (const int p : scene.face_points(f)) least = std::min(least, scene.point(p)[0]);
    }
    EXPECT_EQ(least, 3);
    EXPECT_EQ(scene.bounds()[0][0], 0.5);
  }
}

TEST(ReadMesh, IfcLeavesRoomsOut) {
  const std::string path = data("formats/block.ifc");
  if (!is_readable(path)) GTEST_SKIP() << "built without assimp";
  EXPECT_EQ(Scene(read_mesh(path)).bounds()[1].z(), 1);  // the room is 3 high
}

TEST(ReadMesh, RefusesEveryMalformedFileInOneLineThatNamesIt) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(data("malformed"))) {
    const std::string path = entry.path().string();
    SCOPED_TRACE(path);
    const std::string message = complaint(path);
    EXPECT_TRUE(message.starts_with(path + ":")) << message;
    EXPECT_EQ(message.find_first_of("\n\r"), std::string::npos) << message;
    EXPECT_LT(message.size(), path.size() * 2 + 160) << message;
    ++count;
  }
  EXPECT_GE(count, 50);
}

TEST(ReadMesh, NamesLineOrElement) {
  const auto expect = [](const std::string& name, const std::string& part) {
    EXPECT_NE(complaint(data("malformed/") + name).find(part), std::string::npos)
        << complaint(data("malformed/") + name);
  };
  expect("truncated.obj", ":4: a coordinate is missing");
  expect("nan.obj", ":4: a coordinate is not a finite number: 'nan'");
  expect("overflow.obj", ":4: a coordinate is not a finite number: '1e999'");
  expect("index_out_of_range.obj", ":4: names vertex 4 of 3");
  expect("index_zero.obj", ":4: names vertex 0 of 3");
  expect("words.obj", ":1: no OBJ statement: 'Once'");
  expect("empty.obj", "the file is empty");
  expect("no_faces.obj", "no faces");
  expect("too_small.obj", "vertex 3 has a coordinate outside");
  expect("gigantic.off", ":2: announces 2000000000 vertices");
  expect("index_out_of_range.off", ":6: face 0 names vertex 3 of 3");
  expect("gigantic_list.ply", "face 0 announces a list of 4294967295 values");
  expect("nan_binary.ply", "vertex 1 has a coordinate that is not finite");
  expect("nan_binary.stl", "triangle 0 has a coordinate that is not finite");
  if (is_readable("any.glb")) {
    expect("gigantic_chunk.glb", "announces a chunk of 4261413476 bytes, but has 28");
    expect("truncated.glb", " bytes, but has 200");
  }
  expect("gigantic.stl", "announces 4294967295 triangles");
  expect("unknown.extension", "no mesh format is known by the extension 'extension'");
  EXPECT_NE(complaint(data("no_such_file.obj")).find("no such file"), std::string::npos);
  EXPECT_NE(complaint(std::string(SIGHTLINE_TEST_DATA) + "/formats").size(), 0u);
}

// Damaged copies of our own formats' files are read or refused, never more than that.
TEST(ReadMesh, SurvivesDamagedFiles) {
  using Reader = PolygonSoup (*)(const std::string&, std::string_view, internal::Stage&);
  const std::vector<std::pair<std::string, Reader>> files{
      {"groups.obj", internal::read_obj},     {"tenth.off", internal::read_off},
      {"cube.off", internal::read_off},       {"cube_ascii.ply", internal::read_ply},
      {"tenth.ply", internal::read_ply},      {"cube_little.ply", internal::read_ply},
      {"cube_big.ply", internal::read_ply},   {"cube_ascii.stl", internal::read_stl},
      {"cube_binary.stl", internal::read_stl}};
  int refused = 0, taken = 0;
  const auto attempt = [&](Reader read, const std::string& bytes) {
    try {
      const Scene scene(read("damaged", bytes, test::Unhurried()));
      EXPECT_LE(scene.soup().vertices.size(), bytes.size());
      ++taken;
    } catch (const InvalidInput&) {
      ++refused;
    }
  };
  std::mt19937 rng(7);
  for (const auto& [name, read] : files) {
    SCOPED_TRACE(name);
    const std::string whole = bytes_of(data("formats/") + name);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      attempt(read, whole.substr(0, size));
    }
    for (int i = 0; i < 1000; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 1 + i % 4; ++k) {
        const char digits[] = "0123456789 -.\n\xff";
        damaged[rng() % damaged.size()] =
            i % 2 == 0 ? static_cast<char>(rng() % 256) : digits[rng() % 15];
      }
      attempt(read, damaged);
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(taken, 100);
}

TEST(ReadMesh, TruncationOfCountedFormatsIsAlwaysNoticed) {
  for (const char* const name : {"cube_little.ply", "cube_big.ply", "cube_ascii.ply"}) {
    SCOPED_TRACE(name);
    const std::string whole = bytes_of(data("formats/") + name);
    // The last two bytes of the ASCII file are a digit and a line end.
    for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
      EXPECT_THROW(
          (void)internal::read_ply("cut", whole.substr(0, size), test::Unhurried()),
          InvalidInput)
          << size;
    }
  }
  const std::string stl = bytes_of(data("formats/cube_binary.stl"));
  for (std::size_t size = 0; size < stl.size(); ++size) {
    EXPECT_THROW((void)internal::read_stl("cut", stl.substr(0, size), test::Unhurried()),
                 InvalidInput);
  }
}

TEST(ReadMesh, ReadsWindowsAndOldMacintoshLineEnds) {
  for (const char* const end : {"\r\n", "\r"}) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;
         at += std::string(end).size()) {
      text.replace(at, 1, end);
    }
    EXPECT_EQ(internal::read_obj("ends", text, test::Unhurried()).polygons.size(), 1u);
  }
}

}  // namespace
}  // namespace sightline
