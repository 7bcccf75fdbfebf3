// Views of a scene: what a box leaves, and what is seen from within.

#include "viewers/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "linespace/mesh_io.h"
#include "viewers/kinds.h"

namespace sightline::viewers {
namespace {

const std::string kRoom = std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj";

bool is_inside(std::span<const Point> points, const std::array<Point, 2>& box) {
  return std::ranges::all_of(points, [&](const Point& p) {
    return (p.array() >= box[0].array()).all() && (p.array() <= box[1].array()).all();
  });
}

TEST(SceneView, NothingIsDrawnOutsideOfTheBox) {
  const Scene scene(read_mesh(kRoom));
  ViewOptions options;
  options.box = {Point(0.5, -0.1, 0.5), Point(4, 1.5, 3)};
  const Drawing drawing = view_scene(scene, options).drawing;
  EXPECT_FALSE(drawing.triangles.empty());
  EXPECT_FALSE(drawing.strokes.empty());
  for (const PaintedTriangle& t : drawing.triangles) {
    EXPECT_TRUE(is_inside(t.points, *options.box));
  }
  for (const Stroke& s : drawing.strokes) EXPECT_TRUE(is_inside(s.points, *options.box));
}

TEST(SceneView, ABoxAroundEverythingLeavesEverything) {
  const Scene scene(read_mesh(kRoom));
  ViewOptions options;
  options.box = {Point::Constant(-9), Point::Constant(9)};
  std::size_t triangles = 0;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    triangles += scene.face_points(static_cast<int>(f)).size() - 2;
  }
  EXPECT_EQ(view_scene(scene, options).drawing.triangles.size(), triangles);
}

TEST(SceneView, FromWithinARoomWallsShutTheViewIn) {
  const Scene scene(read_mesh(kRoom));
  ViewOptions options;
  const Point eye(3, 1.5, 2.2);
  for (const Point& at : {Point(6, 2, 4), Point(3, 0, 2.2)}) {
    options.look = {eye, at};
    const SceneView view = view_scene(scene, options);
    EXPECT_EQ(view.camera.eye, eye);
    const std::vector<int> ids = visible_ids(view.drawing, view.camera, 64, 48);
    EXPECT_EQ(std::ranges::count(ids, -1), 0) << at.transpose();
    EXPECT_GT(std::ranges::count_if(ids, [&](int id) { return id != ids[64 * 24 + 32]; }),
              0);
  }
}

TEST(SceneView, EveryKindHasItsName) {
  const std::vector<std::string> names = kind_names();
  for (const char* name : {"EV", "EV_self", "EEE", "VV", "EEEE_self", "FF", "saddle"}) {
    EXPECT_EQ(std::ranges::count(names, name), 1) << name;
  }
  EXPECT_EQ(std::ranges::count(names, "degenerate"), 1);
}

}  // namespace
}  // namespace sightline::viewers
