// VTK files can be read back and hold what the skeleton holds.

#include "viewers/vtk_export.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>

#include "linespace/mesh_io.h"
#include "skeleton/build.h"
#include "viewers/answer.h"
#include "viewers/drawing.h"
#include "viewers/kinds.h"
#include "viewers/output_file.h"
#include "viewers/palette.h"
#include "viewers/skeleton_file.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

class VtkExport : public testing::Test {
 protected:
  VtkExport()
      : scene_(read_mesh(std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj")),
        skeleton_(build_skeleton(scene_)) {
    std::string pattern = (fs::temp_directory_path() / "sightline-vtk-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~VtkExport() override { fs::remove_all(folder_); }

  Scene scene_;
  Skeleton skeleton_;
  fs::path folder_;
};

TEST_F(VtkExport, SceneSurvivesTheRoundTrip) {
  write_vtk(folder_, scene_, {});
  const VtkPicture picture = read_vtk(folder_ / "sightline.vtm");
  EXPECT_EQ(picture.soup.vertices, scene_.soup().vertices);
  EXPECT_EQ(picture.soup.polygons, scene_.soup().polygons);
  ASSERT_EQ(picture.soup.groups.size(), scene_.objects().size());
  for (std::size_t i = 0; i < scene_.objects().size(); ++i) {
    EXPECT_EQ(picture.soup.groups[i].name, scene_.objects()[i].name);
  }
  EXPECT_TRUE(picture.veils.empty());
  EXPECT_TRUE(picture.strokes.empty());
}

TEST_F(VtkExport, EveryArcAndNodeIsThereInItsColour) {
  const std::vector<std::string> files =
      write_vtk(folder_, scene_, {&skeleton_, nullptr});
  for (const std::string& file : files) EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  const VtkPicture picture = read_vtk(folder_ / "sightline.vtm");
  std::size_t triangles = skeleton_.ev().size();
  for (const SkeletonArc& arc : skeleton_.eee()) {
    triangles += 2 * (rungs_of(scene_, arc).size() - 1);
  }
  EXPECT_GT(triangles, skeleton_.ev().size() + 2 * skeleton_.eee().size());
  EXPECT_EQ(picture.veils.size(), triangles);
  EXPECT_EQ(picture.strokes.size(), skeleton_.nodes.size());
  const VtkPicture vv = read_vtk(folder_ / "nodes_VV.vtp");
  ASSERT_FALSE(vv.strokes.empty());
  EXPECT_EQ(hex(vv.strokes[0].colour), hex(colour_of_kind("VV")));
  std::size_t expected = 0;
  for (const SkeletonNode& node : skeleton_.nodes) {
    expected += kind_name(node) == "VV" ? 1 : 0;
  }
  EXPECT_EQ(vv.strokes.size(), expected);
}

TEST_F(VtkExport, EeeBlocksHaveTheirArrays) {
  write_vtk(folder_, scene_, {&skeleton_, nullptr});
  const auto read = [&](const char* name) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName((folder_ / name).c_str());
    reader->Update();
    return vtkSmartPointer<vtkPolyData>(reader->GetOutput());
  };
  const auto arcs = read("arcs_EEE.vtp");
  ASSERT_EQ(arcs->GetNumberOfCells(), static_cast<int>(skeleton_.eee().size()));
  EXPECT_EQ(arcs->GetNumberOfStrips(), arcs->GetNumberOfCells());
  vtkCellData* data = arcs->GetCellData();
  for (const auto& [name, components] : {std::pair("arc", 1),
                                         {"edges", 3},
                                         {"objects", 3},
                                         {"range", 2},
                                         {"nodes", 2},
                                         {"kind", 1},
                                         {"colour", 3}}) {
    ASSERT_NE(data->GetAbstractArray(name), nullptr) << name;
    EXPECT_EQ(data->GetAbstractArray(name)->GetNumberOfComponents(), components) << name;
  }
  ASSERT_NE(arcs->GetFieldData()->GetArray("deviation"), nullptr);
  for (const vtkIdType cell : {vtkIdType{0}, arcs->GetNumberOfCells() - 1}) {
    const SkeletonArc& arc = skeleton_.eee()[cell];
    EXPECT_EQ(data->GetArray("arc")->GetTuple1(cell),
              static_cast<double>(skeleton_.ev().size() + cell));
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(data->GetArray("edges")->GetComponent(cell, k), arc.edges()[k]);
    }
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(data->GetArray("range")->GetComponent(cell, k), arc.range[k]);
      EXPECT_EQ(data->GetArray("nodes")->GetComponent(cell, k), arc.nodes[k]);
    }
  }
  const auto eeee = read("nodes_EEEE.vtp");
  EXPECT_EQ(eeee->GetNumberOfLines(),
            std::ranges::count_if(skeleton_.nodes, [](const SkeletonNode& n) {
              return kind_name(n) == "EEEE";
            }));
  ASSERT_GT(eeee->GetNumberOfLines(), 0);
  for (const char* name : {"node", "generators", "second", "kind", "colour"}) {
    EXPECT_NE(eeee->GetCellData()->GetAbstractArray(name), nullptr) << name;
  }
  EXPECT_GT(read("nodes_FEE.vtp")->GetNumberOfLines(), 0);
}

TEST_F(VtkExport, SavedSkeletonIsReadBackWhole) {
  {
    OutputFile file(folder_ / "skeleton.json");
    Json head = answer_head("skeleton", scene_, true, {});
    head["options"] = {{"events", "solid"}};
    head.update(skeleton_json(skeleton_));
    head["simplified"] = simplified_json(scene_, skeleton_.simplified, true);
    write_skeleton_json(file.stream(), head, scene_, skeleton_, nullptr);
    file.commit();
  }
  const StoredSkeleton stored = read_skeleton_json((folder_ / "skeleton.json").string());
  check_fits(stored, scene_);
  EXPECT_EQ(stored.scene_file, scene_.soup().source);
  const Skeleton& back = stored.skeleton;
  ASSERT_EQ(back.nodes.size(), skeleton_.nodes.size());
  for (std::size_t i = 0; i < back.nodes.size(); ++i) {
    const SkeletonNode &a = back.nodes[i], &b = skeleton_.nodes[i];
    EXPECT_EQ(std::tuple(a.kind, a.self, a.end, a.second),
              std::tuple(b.kind, b.self, b.end, b.second));
    EXPECT_TRUE(std::ranges::equal(back.generators(a), skeleton_.generators(b)));
    EXPECT_EQ(a.segment, b.segment);
  }
  ASSERT_EQ(back.arcs.size(), skeleton_.arcs.size());
  for (std::size_t i = 0; i < back.arcs.size(); ++i) {
    const SkeletonArc &a = back.arcs[i], &b = skeleton_.arcs[i];
    EXPECT_EQ(std::tuple(a.kind, a.generators, a.self, a.range, a.nodes),
              std::tuple(b.kind, b.generators, b.self, b.range, b.nodes));
  }
}

TEST_F(VtkExport, StripsReachTheFacesThatEndThem) {
  const SkeletonLines index(scene_);
  int ended = 0;
  for (const int arc : evenly_spread(skeleton_.ev().size(), 40)) {
    const RuledStrip strip = ruled_strip(scene_, index, skeleton_, arc, 5);
    for (const FarEnds& rung : strip.rungs) {
      for (const int side : {0, 1}) {
        for (const int polygon : rung.faces[side]) {
          // The point lies in the plane of the polygon that ends the line there.
          const std::vector<int>& ids = scene_.soup().polygons[polygon];
          const Point& a = scene_.soup().vertices[ids[0]];
          const Point normal = (scene_.soup().vertices[ids[1]] - a)
                                   .cross(scene_.soup().vertices[ids[2]] - a)
                                   .normalized();
          EXPECT_NEAR(normal.dot(rung.points[side] - a), 0, 1e-6);
          ++ended;
        }
      }
    }
  }
  EXPECT_GT(ended, 50);
}

TEST_F(VtkExport, LinesWithoutASceneCanBeShown) {
  LineBlock portals{"portals", "portal", {}};
  portals.polygons.push_back({{{7, 0, 0}, {9, 0, 0}, {9, 0, 2}, {7, 0, 2}}, ""});
  LineBlock lines{"lines", "VV", {}};
  lines.pieces.push_back({{5, -2, 0}, {9, 3, 2}, ""});
  write_vtk_lines(folder_, {portals, lines});
  const VtkPicture picture = read_vtk(folder_ / "sightline.vtm");
  EXPECT_TRUE(picture.soup.polygons.empty());
  EXPECT_EQ(picture.strokes.size(), 1U);
  EXPECT_EQ(picture.veils.size(), 2U);
  EXPECT_EQ(read_vtk(folder_ / "lines.vtp").strokes.size(), 1U);

  // All of them in the picture, which they fill.
  constexpr int kSide = 100;
  const SceneView view = view_marks(picture.veils, picture.strokes,
                                    {.width = kSide, .height = kSide, .focus = {}});
  PictureOptions options;
  options.width = options.height = kSide;
  const Image bare = render({}, view.camera, options);
  const Image drawn = render({{}, picture.veils, picture.strokes}, view.camera, options);
  int left = kSide, right = -1, top = kSide, bottom = -1;
  for (int i = 0; i < kSide * kSide; ++i) {
    if (std::equal(&bare.rgb[3 * i], &bare.rgb[3 * i] + 3, &drawn.rgb[3 * i])) continue;
    left = std::min(left, i % kSide);
    right = std::max(right, i % kSide);
    top = std::min(top, i / kSide);
    bottom = std::max(bottom, i / kSide);
  }
  EXPECT_GT(left, 0);
  EXPECT_GT(top, 0);
  EXPECT_LT(right, kSide - 1);
  EXPECT_LT(bottom, kSide - 1);
  EXPECT_GT(std::max(right - left, bottom - top), kSide / 2);
}

TEST_F(VtkExport, UnreadableFilesAreRefused) {
  std::ofstream(folder_ / "bad.vtp") << "not VTK";
  EXPECT_THROW((void)read_vtk(folder_ / "bad.vtp"), InvalidInput);
  EXPECT_THROW((void)read_vtk(folder_ / "none.vtm"), InvalidInput);
  write_vtk_lines(folder_, {});
  EXPECT_THROW((void)read_vtk(folder_ / "sightline.vtm"), InvalidInput);
}

TEST_F(VtkExport, FilesAreWholeOrNotThere) {
  {
    OutputFile file(folder_ / "half.txt");
    file.stream() << "half";
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  write_whole(folder_ / "whole.txt", "whole");
  EXPECT_EQ(fs::file_size(folder_ / "whole.txt"), 5U);
  EXPECT_THROW(write_whole(folder_ / "none/file.txt", ""), OutputError);
}

}  // namespace
}  // namespace sightline::viewers
