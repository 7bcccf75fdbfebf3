// Reading a file and making a scene hear a budget and a stop, and say how far they are.

#include "linespace/work/stage.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>

#include "linespace/face_visibility.h"
#include "linespace/mesh_io.h"
#include "linespace/occlusion.h"
#include "linespace/scene.h"
#include "tests/support/generators.h"

namespace sightline {
namespace {

// Boxes side by side, enough that every stage looks at the clock.
PolygonSoup many_boxes() {
  std::vector<testing::AlignedBox> boxes;
  for (int i = 0; i < 400; ++i) {
    const double x = i % 20, y = i / 20;
    boxes.push_back({{x, y, 0}, {x + 0.5, y + 0.5, 1}});
  }
  return testing::boxes_soup(boxes);
}

// The same as a file with that extension, OBJ or OFF.
std::string file_of(const PolygonSoup& soup, const std::string& extension) {
  const std::string name =
      ::testing::TempDir() + "stage_test_" + std::to_string(getpid()) + "." + extension;
  std::ofstream out(name);
  const bool off = extension == "off";
  if (off) out << "OFF\n" << soup.vertices.size() << ' ' << soup.polygons.size() << '\n';
  for (const Point& p : soup.vertices) {
    out << (off ? "" : "v ") << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  for (const auto& polygon : soup.polygons) {
    out << (off ? std::to_string(polygon.size()) : "f");
    for (const int v : polygon) out << ' ' << v + (off ? 0 : 1);
    out << '\n';
  }
  return name;
}

TEST(Stage, ThrowsWhenTheBudgetIsUsedUp) {
  Request request;
  request.budget_seconds = 0;
  EXPECT_THROW(internal::Stage(request, "waiting"), Stopped);
  request.budget_seconds = 1e-9;
  EXPECT_THROW(read_mesh(file_of(many_boxes(), "obj"), request), Stopped);
  EXPECT_THROW(Scene(many_boxes(), {}, request), Stopped);
}

TEST(Stage, ChangesNothingWhereTimeIsLeft) {
  Request request;
  request.budget_seconds = 1000;
  const Scene scene(read_mesh(file_of(many_boxes(), "obj"), request), {}, request);
  EXPECT_EQ(scene.solids(), 400);
  EXPECT_EQ(scene.edges().size(), 4800u);
}

// A stop requested at some report of progress is heard there, whichever it is, and the
// message names the stage.
TEST(Stage, HearsAStopInEveryStage) {
  std::set<std::string> stages;
  for (const char* extension : {"obj", "off"}) {
    const std::string file = file_of(many_boxes(), extension);
    for (int wanted = 1;; wanted += 1 + wanted / 16) {
      std::stop_source stop;
      Request request;
      request.stop = stop.get_token();
      int told = 0;
      double last = 0;
      std::string stage;
      request.progress = [&](std::string_view name, double share) {
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 1);
        if (name == stage) {
          EXPECT_GE(share, last);
        }
        stage = name;
        last = share;
        if (++told == wanted) stop.request_stop();
      };
      try {
        const Scene scene(read_mesh(file, request), {}, request);
        EXPECT_LT(told, wanted);
        break;  // stopped at no report: there are fewer
      } catch (const Stopped& stopped) {
        EXPECT_GE(told, wanted);
        EXPECT_LE(told, wanted + 1);
        EXPECT_NE(std::string(stopped.what()).find(stopped.stage()), std::string::npos);
        stages.insert(stopped.stage());
      }
    }
  }
  EXPECT_TRUE(stages.contains("reading"));
  EXPECT_TRUE(stages.contains("faces"));
  EXPECT_TRUE(stages.contains("edges"));
}

TEST(Stage, EndsIndexesAndTheLookForDefects) {
  const Scene scene(many_boxes());
  Request request;
  request.budget_seconds = 0;
  EXPECT_THROW((void)validate(scene, request), Stopped);
  EXPECT_THROW(OcclusionIndex(scene, request), Stopped);
  EXPECT_THROW(FaceVisibility(scene, request), Stopped);
}

// What calls hear_stop() often enough to be heard.
void long_loop() {
  for (int i = 0; i < 64; ++i) internal::hear_stop();
}

TEST(StopScope, IsHeardInAnyDepthWhileItLives) {
  bool stop = false;
  const std::function<bool()> outer_stop = [&] { return stop; };
  const std::function<bool()> never;
  long_loop();
  {
    const internal::StopScope outer(outer_stop);
    long_loop();
    stop = true;
    EXPECT_THROW(long_loop(), Stopped);
    const internal::StopScope inner(never);
    EXPECT_THROW(internal::hear_stop_now(), Stopped);
  }
  EXPECT_NO_THROW(long_loop());
}

TEST(StopScope, IsItsThreadsOwn) {
  const std::function<bool()> stop = [] { return true; };
  const internal::StopScope scope(stop);
  bool heard = false;
  std::thread([&] {
    try {
      long_loop();
    } catch (const Stopped&) {
      heard = true;
    }
  }).join();
  EXPECT_FALSE(heard);
  EXPECT_THROW(long_loop(), Stopped);
}

TEST(StopScope, TellsTheNameOfTheStageAround) {
  std::stop_source source;
  Request request;
  request.stop = source.get_token();
  internal::Stage stage(request, "first");
  stage.begin("second");
  source.request_stop();
  try {
    internal::hear_stop_now();
    FAIL();
  } catch (const Stopped& stopped) {
    EXPECT_EQ(stopped.stage(), "second");
  }
}

}  // namespace
}  // namespace sightline
