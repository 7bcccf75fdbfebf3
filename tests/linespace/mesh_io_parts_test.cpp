// Files of the formats that assimp reads, whole, and with parts taken away: nothing is
// invented, nothing crashes, and what cannot be read is refused in one line.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

#include "linespace/mesh_io.h"
#include "tests/support/format_parts.h"

namespace sightline {
namespace {

using test::PartedFile;
using Corner = std::array<double, 3>;
using Corners = std::set<Corner>;

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::vector<PartedFile> readable_files() {
  std::vector<PartedFile> files =
      test::parted_files(bytes_of(SIGHTLINE_TEST_DATA "/formats/block.ifc"));
  const std::vector<std::string> known = readable_extensions();
  std::erase_if(files, [&](const PartedFile& file) {
    return !std::binary_search(known.begin(), known.end(), file.extension);
  });
  return files;
}

struct Read {
  std::string complaint;
  PolygonSoup soup;
};

Read read(const PartedFile& file) {
  const std::string name = testing::TempDir() + "sightline_parts_" +
                           std::to_string(getpid()) + "." + file.extension;
  std::ofstream(name, std::ios::binary) << file.bytes();
  Read result;
  try {
    result.soup = read_mesh(name);
  } catch (const InvalidInput& error) {
    result.complaint = error.what();
    EXPECT_TRUE(result.complaint.starts_with(name)) << result.complaint;
    EXPECT_EQ(result.complaint.find_first_of("\r\n"), std::string::npos);
  }
  std::remove(name.c_str());
  return result;
}

/// The faces by their corners' coordinates.
std::multiset<Corners> faces_of(const PolygonSoup& soup) {
  std::multiset<Corners> faces;
  for (const auto& polygon : soup.polygons) {
    Corners corners;
    for (const int v : polygon) {
      const Point& p = soup.vertices[static_cast<std::size_t>(v)];
      corners.insert({p.x(), p.y(), p.z()});
    }
    faces.insert(corners);
  }
  return faces;
}

/// Whether all corners are of one face of the whole file, and three at least.
bool is_of(const Corners& face, const std::multiset<Corners>& all) {
  return face.size() > 2 && std::ranges::any_of(all, [&face](const Corners& whole) {
           return std::includes(whole.begin(), whole.end(), face.begin(), face.end());
         });
}

TEST(ReadMeshParts, WholeFilesAreCubes) {
  for (const PartedFile& file : readable_files()) {
    SCOPED_TRACE(file.extension);
    const Read whole = read(file);
    ASSERT_EQ(whole.complaint, "");
    const Scene scene(whole.soup);
    EXPECT_EQ(scene.points().size(), 8U);
    EXPECT_EQ(scene.facets().size(), 6U);
    EXPECT_EQ(scene.solids(), 1);
    // The library may wish for more than a mesh needs.
    for (const Defect& defect : scene.defects()) {
      EXPECT_EQ(defect.kind, "reader's warning") << defect.message;
    }
  }
}

TEST(ReadMeshParts, WithPartsTakenAwayNothingIsInvented) {
  constexpr int kNeighbours = 60;
  for (const PartedFile& file : readable_files()) {
    const Read whole = read(file);
    const std::multiset<Corners> all = faces_of(whole.soup);
    std::mt19937 random(1);
    int refused = 0, same = 0, fewer = 0;
    for (int i = 0; i < kNeighbours; ++i) {
      PartedFile damaged = file;
      // Each part once, and then several.
      std::string removed;
      for (int k = 0; k < (i < file.count() ? 1 : 2 + i % 3) && damaged.count() > 0;
           ++k) {
        const int part =
            i < file.count()
                ? i
                : static_cast<int>(random() % static_cast<unsigned>(damaged.count()));
        removed += " " + std::to_string(part);
        damaged.remove(part);
      }
      SCOPED_TRACE(file.extension + " without" + removed + "\n" +
                   (file.style == test::PartStyle::Text ? damaged.bytes() : ""));
      const Read left = read(damaged);
      if (!left.complaint.empty()) {
        ++refused;
        continue;
      }
      EXPECT_FALSE(left.soup.polygons.empty());
      const std::multiset<Corners> faces = faces_of(left.soup);
      // AC3D without one of its counted lines is read one line off, with a defect.
      const bool told =
          file.extension == "ac" && left.soup.defects.size() > whole.soup.defects.size();
      for (const Corners& face : faces) EXPECT_TRUE(told || is_of(face, all));
      (faces.size() == all.size() ? same : fewer)++;
    }
    std::printf("%s: %d parts; %d refused, %d as before, %d with fewer faces\n",
                file.extension.c_str(), file.count(), refused, same, fewer);
    EXPECT_GT(refused, 0);
  }
}

}  // namespace
}  // namespace sightline
