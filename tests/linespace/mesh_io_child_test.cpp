// Formats of a library that may crash, hang, or make faces up.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <stdexcept>

#include "linespace/files/child.h"
#include "linespace/mesh_io.h"
#include "tests/support/unhurried.h"

namespace sightline {
namespace {

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

bool is_readable(const std::string& extension) {
  const auto known = readable_extensions();
  return std::binary_search(known.begin(), known.end(), extension);
}

std::string complaint(const std::function<void()>& read) {
  try {
    read();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

bool has_no_child() { return waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD; }

TEST(ReadInChild, HandsOverAllOfTheSoup) {
  PolygonSoup soup;
  soup.vertices = {{0.1, -0.0, 1e300}, {2, 3, 4}, {5, 6, 7}};
  soup.polygons = {{0, 1, 2}, {}, {2, 1, 0, 1}};
  soup.groups = {{"T\xFCr", {0, 2}}, {"", {}}};
  soup.defects = {{"kind", "message", {}, {}}};
  const PolygonSoup copy = internal::read_in_child(
      "x", 0, [] {}, [&] { return soup; });
  EXPECT_EQ(copy.vertices, soup.vertices);
  EXPECT_EQ(copy.polygons, soup.polygons);
  ASSERT_EQ(copy.groups.size(), 2u);
  EXPECT_EQ(copy.groups[0].name, soup.groups[0].name);
  EXPECT_EQ(copy.groups[0].faces, soup.groups[0].faces);
  ASSERT_EQ(copy.defects.size(), 1u);
  EXPECT_EQ(copy.defects[0].message, "message");
  EXPECT_TRUE(has_no_child());
}

TEST(ReadInChild, TellsRefusalsCrashesAndWantOfMemory) {
  const auto told = [](const std::function<PolygonSoup()>& read) {
    return complaint([&] {
      (void)internal::read_in_child(
          "x", 0, [] {}, read);
    });
  };
  EXPECT_EQ(told([]() -> PolygonSoup { throw InvalidInput("x: 7"); }), "x: 7");
  EXPECT_EQ(told([]() -> PolygonSoup {
              raise(SIGSEGV);
              return {};
            }),
            "x: cannot be read: the reader library crashed on it (signal 11)");
  EXPECT_NE(told([]() -> PolygonSoup { throw std::logic_error("?"); }), "");
  EXPECT_NE(told([]() -> PolygonSoup { std::_Exit(0); }), "");
  EXPECT_NE(told([] {
              PolygonSoup soup;
              for (;;) soup.vertices.resize(2 * soup.vertices.size() + 1);
              return soup;
            }).find("needs more than 1024 MiB"),
            std::string::npos);
  EXPECT_TRUE(has_no_child());
}

TEST(ReadInChild, EndsWithItsCheckAndWhenItDoesNotEnd) {
  const auto start = std::chrono::steady_clock::now();
  int calls = 0;
  EXPECT_THROW((void)internal::read_in_child(
                   "x", 0,
                   [&] {
                     if (++calls == 3) throw std::runtime_error("stop");
                   },
                   []() -> PolygonSoup {
                     for (;;) pause();
                   }),
               std::runtime_error);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
  EXPECT_TRUE(has_no_child());
  // Ten seconds of processor time.
  const std::string message = complaint([] {
    (void)internal::read_in_child(
        "x", 0, [] {},
        []() -> PolygonSoup {
          for (volatile int i = 0;; i = i + 1) {
          }
        });
  });
  EXPECT_NE(message.find("did not end within 10 s of processor time"), std::string::npos)
      << message;
  EXPECT_TRUE(has_no_child());
}

TEST(ReadInChild, FilesWithoutFacesGetNone) {
  if (!is_readable("dae")) GTEST_SKIP() << "built without assimp";
  EXPECT_TRUE(complaint([] {
                (void)read_mesh(data("malformed/no_geometry.dae"));
              }).ends_with(": no faces"));
}

TEST(ReadMesh, OnlyFormatsThatAreReadWell) {
  for (const char* const name : {"two_triangles.raw", "bones_only.smd", "walk.bvh"}) {
    const std::string message =
        complaint([&] { (void)read_mesh(data("malformed/") + name); });
    EXPECT_NE(message.find("no mesh format is known by the extension"),
              std::string::npos);
    EXPECT_NE(message.find(" .obj .off .ply .stl"), std::string::npos) << message;
  }
}

// A letter of an entity's name changed: assimp would crash, or leave the record out.
TEST(ReadMesh, MisspeltEntitiesOfIfcAreNamed) {
  if (!is_readable("ifc")) GTEST_SKIP() << "built without assimp";
  EXPECT_NE(complaint([] {
              (void)read_mesh(data("malformed/one_byte_a.ifc"));
            }).find("no entity of IFC 2x3: 'IFCCARTESIANPO?NT'"),
            std::string::npos);
  const std::string whole = bytes_of(data("formats/block.ifc"));
  std::vector<std::size_t> letters;
  for (std::size_t at = whole.find("=IFC"); at != std::string::npos;
       at = whole.find("=IFC", at + 1)) {
    for (std::size_t i = at + 1; whole[i] != '('; ++i) letters.push_back(i);
  }
  std::mt19937 random(1);
  for (int i = 0; i < kNeighbours; ++i) {
    std::string damaged = whole;
    const std::size_t at = letters[random() % letters.size()];
    const char letter = static_cast<char>('A' + random() % 26);
    if (letter == whole[at]) continue;
    damaged[at] = letter;
    const std::string message =
        complaint([&] { internal::check_step("x", damaged, test::Unhurried()); });
    EXPECT_NE(message.find("no entity of IFC 2x3"), std::string::npos) << damaged;
  }
}

// assimp would take y for x in a file that has no x.
TEST(ReadMesh, ColladaPositionsNeedAllOfTheirColumns) {
  const auto told = [](const std::string& params, const std::string& semantic) {
    const std::string text =
        "<!-- <source id='p'> --><source\n id = 'q'/><source id='p'>" + params +
        "</source><input source=\"#p\" semantic='" + semantic + "'/>";
    return complaint([&] { internal::check_collada("x", text, test::Unhurried()); });
  };
  EXPECT_EQ(told("<param name='X'/><param name='Y'/><param name='Z'/>", "POSITION"), "");
  EXPECT_EQ(told("<param name='Z'/><param name='X'/><param name='Y'/>", "POSITION"), "");
  EXPECT_EQ(told("<param name='X'/><param name='Y'/>", "POSITION"),
            "x: the positions 'p' have no param Z");
  EXPECT_EQ(told("<param name='Z'/>", "POSITION"),
            "x: the positions 'p' have no param X");
  EXPECT_EQ(told("<param name='X'/>", "OUTPUT"), "");  // of an animation
  EXPECT_EQ(told("<param/><param/><param/>", "POSITION"), "");
}

// Damaged copies are read or refused in one line.
TEST(ReadMesh, SurvivesDamagedSceneFiles) {
  std::mt19937 random(2);
  for (const char* const name : {"block.ifc", "cube.ac"}) {
    const std::string whole = bytes_of(data("formats/") + name);
    const std::string extension = std::string(name).substr(std::string(name).find('.'));
    if (!is_readable(extension.substr(1))) continue;
    const std::string file =
        testing::TempDir() + "sightline_damaged_" + std::to_string(getpid()) + extension;
    for (int i = 0; i < kNeighbours; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 1 + i % 2; ++k) {
        const char digits[] = "0123456789#,()$";
        damaged[random() % damaged.size()] =
            i % 2 == 0 ? static_cast<char>(random()) : digits[random() % 15];
      }
      std::ofstream(file, std::ios::binary) << damaged;
      const std::string message = complaint([&] { const Scene scene(read_mesh(file)); });
      EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
      EXPECT_TRUE(message.empty() || message.starts_with(file)) << message;
    }
    std::remove(file.c_str());
  }
  EXPECT_TRUE(has_no_child());
}

}  // namespace
}  // namespace sightline
