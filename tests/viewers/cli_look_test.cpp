// `sightline look` as scripts meet it: views in order, files, refusals.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/viewers/program_test.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sightline::test::file_contents;

const std::string kRoom = std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj";
const std::string kCube = std::string(SIGHTLINE_TEST_DATA) + "/formats/cube.obj";

/// Every element that is opened is closed in order, and text has no bare < or &.
bool is_well_formed(std::string xml) {
  std::vector<std::string> open;
  const std::size_t begin = xml.find("<svg");
  if (!xml.starts_with("<?xml") || begin == std::string::npos) return false;
  for (std::size_t at = xml.find_first_of("<&", begin); at != std::string::npos;
       at = xml.find_first_of("<&", at + 1)) {
    if (xml[at] == '&') {
      const std::string entity = xml.substr(at, xml.find(';', at) - at);
      if (entity != "&lt" && entity != "&gt" && entity != "&amp" && entity != "&quot") {
        return false;
      }
      continue;
    }
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find(' '));
    if (name[0] == '/') {
      if (open.empty() || "/" + open.back() != name) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
    if (std::ranges::count(tag, '"') % 2 != 0) return false;
    at = end;
  }
  return open.empty();
}

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos;
       at = text.find(word, at + 1)) {
    ++n;
  }
  return n;
}

class CliLook : public sightline::test::ProgramTest {
 protected:
  CliLook() : ProgramTest("look") {}

  void expect_refused(const std::string& arguments, const std::string& mentioned) {
    ProgramTest::expect_refused(arguments + " --svg " + file("x.svg") + " --csv " +
                                    file("x.csv") + " --vtk " + file("x") + " --json " +
                                    file("x.json"),
                                mentioned);
  }
};

TEST_F(CliLook, AnswersInTheOrderOfTheCommandLine) {
  const std::string views = file("views.json", R"({"views": [{"direction": [0, 0.5, 1]},
      {"from": ["1/3", 5, "7"]}]})");
  const json j = answer(kCube + " --from 9,8,7 --at " + views +
                        " --direction 3,2,-1 --from -1/3,0,9");
  EXPECT_EQ(j.at("command"), "look");
  EXPECT_EQ(j.at("complete"), true);
  EXPECT_GT(j.at("scene").at("faces"), 0);
  const json& v = j.at("views");
  ASSERT_EQ(v.size(), 5U);
  EXPECT_EQ(v[0].at("from").dump(), "[9.0,8.0,7.0]");
  EXPECT_EQ(v[1].at("direction").dump(), "[0.0,0.5,1.0]");
  EXPECT_EQ(v[2].at("from").dump(), R"(["1/3",5.0,7.0])");
  EXPECT_EQ(v[3].at("direction").dump(), "[3.0,2.0,-1.0]");
  EXPECT_EQ(v[4].at("from").dump(), R"(["-1/3",0.0,9.0])");
}

TEST_F(CliLook, HasASummaryForPeople) {
  ASSERT_EQ(run(kCube + " --from 9,8,7"), 0) << err();
  EXPECT_NE(out().find("from 9,8,7, eye free"), std::string::npos) << out();
  ASSERT_EQ(run(kCube + " --from 9,8,7 --svg -"), 0) << err();
  EXPECT_TRUE(out().starts_with("<?xml"));
  EXPECT_TRUE(out().ends_with("</svg>\n")) << "and nothing else goes there";
}

TEST_F(CliLook, ACubeFromACornerDirection) {
  const json v = answer(kCube + " --direction 1,2,3 --list").at("views").at(0);
  EXPECT_EQ(v.at("eye"), "free");
  EXPECT_EQ(v.at("ids"), json::array());
  EXPECT_EQ(v.at("corners"), 7);
  EXPECT_EQ(v.at("t_vertices"), 0);
  EXPECT_EQ(v.at("touches"), 0);
  EXPECT_EQ(v.at("accident_vertices"), 0);
  EXPECT_EQ(v.at("edges"), 9);
  EXPECT_EQ(v.at("regions"), 4);
  EXPECT_EQ(v.at("components"), 1);
  EXPECT_EQ(v.at("background_pieces"), 1);
  EXPECT_EQ(v.at("seams"), 0);
  EXPECT_EQ(v.at("general"), true);
  EXPECT_TRUE(v.at("accidents").empty());
  EXPECT_TRUE(v.at("structure").is_string());
  ASSERT_EQ(v.at("facets").size(), 3U);
  // By the file: polygon 1 is the top, 3 at x = 1, 4 at y = 1.
  const std::map<int, double> areas{{1, 3}, {3, 1}, {4, 2}};
  for (const json& f : v.at("facets")) {
    EXPECT_EQ(f.at("object"), "cube");
    EXPECT_EQ(f.at("front"), true);
    EXPECT_EQ(f.at("pieces"), 1);
    ASSERT_EQ(f.at("faces").size(), 1U);
    EXPECT_NEAR(f.at("area").get<double>(), areas.at(f.at("faces")[0]) / std::sqrt(14.0),
                1e-14);
    EXPECT_TRUE(f.at("gradient").is_null());
  }
  const json& map = v.at("map");
  std::map<std::string, int> kinds;
  for (const json& e : map.at("edges")) {
    ++kinds[e.at("kind")];
    EXPECT_TRUE(e.at("edge").is_number());
    for (const json& end : e.at("ends")) EXPECT_LT(end, 7);
    EXPECT_NE(e.at("left"), e.at("right"));
    EXPECT_EQ(e.at("segment").size(), 2U);
  }
  EXPECT_EQ(kinds["silhouette"], 6);
  EXPECT_EQ(kinds["crease"], 3);
  int backgrounds = 0;
  for (const json& r : map.at("regions")) {
    const bool background = r.at("patch").is_null();
    backgrounds += background ? 1 : 0;
    EXPECT_EQ(r.at("area").is_null(), background);
    ASSERT_EQ(r.at("boundary").size(), 1U);
    EXPECT_EQ(r.at("boundary")[0].size(), background ? 6U : 4U);
  }
  EXPECT_EQ(backgrounds, 1);
  for (const json& p : map.at("vertices")) {
    EXPECT_EQ(p.at("kind"), "corner");
    EXPECT_NEAR(p.at("at")[0].get<double>() + 2 * p.at("at")[1].get<double>() +
                    3 * p.at("at")[2].get<double>(),
                0, 1e-14);
  }
}

TEST_F(CliLook, AnEyeSeesSolidAnglesWithGradients) {
  const json v = answer(kCube + " --from 3,4,5").at("views").at(0);
  ASSERT_EQ(v.at("facets").size(), 3U);
  for (const json& f : v.at("facets")) {
    EXPECT_GT(f.at("solid_angle"), 0);
    EXPECT_FALSE(f.contains("area"));
    ASSERT_EQ(f.at("gradient").size(), 3U);
    // Towards the cube it grows.
    double towards = 0;
    const std::array<double, 3> way{-2.5, -3.5, -4.5};
    for (int i = 0; i < 3; ++i) towards += way[i] * f.at("gradient")[i].get<double>();
    EXPECT_GT(towards, 0);
  }
}

TEST_F(CliLook, FilesHoldWhatIsSeen) {
  ASSERT_EQ(run(kRoom + " --from 5,1.6,4 --up 0,1,0 --svg " + file("v.svg") + " --png " +
                file("v.png") + " --pixels 200 --csv " + file("v.csv") + " --vtk " +
                file("vtk") + " --list --json " + file("v.json")),
            0)
      << err();
  const json v = json::parse(file_contents(file("v.json"))).at("views").at(0);
  const std::string svg = file_contents(file("v.svg"));
  EXPECT_TRUE(is_well_formed(svg));
  const std::size_t lines = occurrences(svg, "<line ");
  EXPECT_GT(lines, 20U);
  EXPECT_LT(lines, v.at("map").at("edges").size());
  for (std::size_t e = 0; e < v.at("map").at("edges").size(); ++e) {
    EXPECT_LE(occurrences(svg, " data-edge=\"" + std::to_string(e) + "\""), 1U);
  }
  EXPECT_GT(occurrences(svg, "data-object=\"table_top\""), 0U);
  EXPECT_EQ(occurrences(file_contents(file("v.csv")), "\n"), 1 + v.at("facets").size());
  EXPECT_EQ(file_contents(file("v.png")).substr(1, 3), "PNG");
  for (const char* name : {"scene.vtp", "view0_regions.vtp", "view0_edges.vtp",
                           "view0_picture_regions.vtp", "sightline.vtm"}) {
    EXPECT_TRUE(fs::exists(file("vtk") + "/" + name)) << name;
  }
}

// From outside the window holds all: each edge of the map is drawn, once.
TEST_F(CliLook, DrawsWhatIsHiddenOnRequest) {
  const std::string drawing = (folder_ / "cube.svg").string();
  ASSERT_EQ(run(kCube + " --direction 1,2,3 --svg " + drawing), 0) << err();
  EXPECT_EQ(occurrences(file_contents(drawing), "<line class=\"hidden\""), 0U);
  ASSERT_EQ(run(kCube + " --direction 1,2,3 --hidden --seams --svg " + drawing), 0)
      << err();
  EXPECT_TRUE(is_well_formed(file_contents(drawing)));
  EXPECT_EQ(occurrences(file_contents(drawing), "<line class=\"hidden\""), 3U);
}

TEST_F(CliLook, TheWindowHoldsAllThatIsSeenFromOutside) {
  for (const std::string view : {"--from 9,8,7", "--direction 1,2,3", "--from 3,-5,9"}) {
    ASSERT_EQ(run(kRoom + " " + view + " --svg " + file("v.svg") + " --list --json " +
                  file("v.json")),
              0)
        << err();
    const json v = json::parse(file_contents(file("v.json"))).at("views").at(0);
    const std::string svg = file_contents(file("v.svg"));
    for (std::size_t e = 0; e < v.at("map").at("edges").size(); ++e) {
      EXPECT_EQ(occurrences(svg, " data-edge=\"" + std::to_string(e) + "\""), 1U) << view;
    }
    EXPECT_EQ(
        occurrences(svg, "<path "),
        v.at("map").at("regions").size() - v.at("background_pieces").get<std::size_t>())
        << view;
  }
}

TEST_F(CliLook, TheAnswerDoesNotDependOnThreads) {
  std::string views;
  for (int i = 0; i < 12; ++i) {
    views +=
        " --from " + std::to_string(i % 5 + 1) + ",1.3," + std::to_string(i % 4) + ".6";
  }
  const json one = answer(kRoom + views + " --list --threads 1");
  const json three = answer(kRoom + views + " --list --threads 3");
  EXPECT_EQ(one.at("views"), three.at("views"));
  EXPECT_GT(one.at("predicates").at("double"), 0);
}

TEST_F(CliLook, WhatTheBudgetLeavesIsNull) {
  json views = json::array();
  for (int i = 0; i < 4000; ++i) {
    views.push_back({{"from", {3 + 0.0003 * i, 1.5, 2 + 0.0001 * i}}});
  }
  const std::string name = file("many.json", json{{"views", views}}.dump());
  EXPECT_EQ(run(kRoom + " --at " + name + " --budget 1 --csv " + file("v.csv") +
                " --json " + file("v.json")),
            3);
  EXPECT_EQ(occurrences(err(), "\n"), 1U);
  const json j = json::parse(file_contents(file("v.json")));
  EXPECT_EQ(j.at("complete"), false);
  const json& v = j.at("views");
  ASSERT_EQ(v.size(), 4000U);
  EXPECT_TRUE(v[0].is_object());
  EXPECT_TRUE(v[3999].is_null());
  std::size_t rows = 1;
  for (const json& view : v) rows += view.is_null() ? 0 : view.at("facets").size();
  EXPECT_EQ(occurrences(file_contents(file("v.csv")), "\n"), rows);
}

TEST_F(CliLook, RefusesWhatItCannotAnswerInOneLine) {
  expect_refused(kCube, "from where?");
  expect_refused(kCube + " --from 1,2", "--from '1,2': expected x,y,z");
  expect_refused(kCube + " --from 1,2,3,4", "--from '1,2,3,4': expected x,y,z");
  expect_refused(kCube + " --from 1,two,3", "--from '1,two,3'");
  expect_refused(kCube + " --from 1,,3", "--from '1,,3'");
  expect_refused(kCube + " --from 1,2,nan", "--from '1,2,nan'");
  expect_refused(kCube + " --from 1,2,3/0", "--from '1,2,3/0'");
  expect_refused(kCube + " --direction 0,0,0", "--direction '0,0,0'");
  expect_refused(kCube + " --direction 0,0/5,0", "--direction '0,0/5,0'");
  expect_refused(kCube + " --form 1,2,3", "--from");
  expect_refused(kCube + " --at " + file("none.json"), "none.json");
  expect_refused(kCube + " --from 1,2,1e300", "--from '1,2,1e300': the eye");
  expect_refused(kCube + " --from 1,2,1/" + std::string(99, '9'), "--from '1,2,1/9");
  expect_refused("missing.obj --from 1,2,3", "missing.obj");
}

TEST_F(CliLook, RefusesFilesOfViewsByTheElement) {
  const auto refused = [&](const std::string& text, const std::string& mentioned) {
    expect_refused(kCube + " --at " + file("bad_views.json", text),
                   "bad_views.json: " + mentioned);
  };
  refused("[]", "expected an object");
  refused("{", "not JSON");
  refused("{}", "has no \"views\"");
  refused(R"({"views": []})", "views: ");
  refused(R"({"views": [{"from": [1, 2, 3]}, {}]})", "views[1]: ");
  refused(R"({"views": [{"from": [1, 2, 3], "direction": [1, 2, 3]}]})", "views[0]: ");
  refused(R"({"views": [{"from": [1, 2]}]})", "views[0].from: expected three");
  refused(R"({"views": [{"from": [1, 2, null]}]})", "views[0].from: expected three");
  refused(R"({"views": [{"direction": [0, "0", 0]}]})", "views[0].direction: ");
  refused(R"({"views": [{"from": [1, "x", 3]}]})", "views[0].from: ");
}

TEST_F(CliLook, RefusesPicturesThatCannotBe) {
  expect_refused(kCube + " --from 9,8,7 --window 1,0,1,5", "--window");
  expect_refused(kCube + " --from 9,8,7 --window 0,0,1,1 --fov 60", "--fov");
  expect_refused(kCube + " --direction 1,2,3 --fov 60", "--fov");
  expect_refused(kCube + " --direction 1,2,3 --towards 0,0,0", "--towards");
  expect_refused(kCube + " --direction 1,2,3 --up 2,4,6",
                 "up is along the line of sight");
  expect_refused(kCube + " --from 9,8,7 --towards 9,8,7", "the eye is the point");
  expect_refused(kCube + " --from 9,8,7 --fov 0", "--fov");
  expect_refused(kCube + " --from 9,8,7 --fov 200", "--fov");
  std::string many;
  for (int i = 0; i < 101; ++i) many += " --from 9,8," + std::to_string(i);
  expect_refused(kCube + many, "101 views");
  EXPECT_EQ(run(kCube + " --from 9,8,7 --from 9,8,6 --svg -"), 2);
  EXPECT_EQ(out(), "");
}

TEST_F(CliLook, InABoxItTellsTheBoxAndWhereItCuts) {
  const std::string box = std::string(SIGHTLINE_TEST_DATA) + "/views/box.obj";
  const json j = answer(box + " --direction 1,-2,2 --list --box=-1,-1,-1,3,7/2,1 --svg " +
                        file("cut.svg"));
  EXPECT_EQ(j.at("box"), json({-1.0, -1.0, -1.0, 3.0, "7/2", 1.0}));
  int cuts = 0;
  for (const json& e : j.at("views")[0].at("map").at("edges")) {
    if (e.at("kind") != "cut") continue;
    ++cuts;
    EXPECT_EQ(e.at("edge").at("side"), "z1");
    EXPECT_TRUE(e.at("edge").at("facet").is_number());
  }
  EXPECT_EQ(cuts, 6);
  EXPECT_EQ(occurrences(file_contents(file("cut.svg")), "<line class=\"cut\""), 6U);
  const json whole = answer(box + " --direction 1,-2,2 --svg " + file("whole.svg"));
  EXPECT_FALSE(whole.contains("box"));
  EXPECT_EQ(file_contents(file("whole.svg")).find(".cut"), std::string::npos);
}

TEST_F(CliLook, RefusesBoxesInOneLine) {
  const auto refused = [&](const std::string& words, const std::string& mentioned) {
    EXPECT_EQ(run(kCube + words + " --json " + file("answer.json")), 2) << words;
    EXPECT_EQ(occurrences(err(), "\n"), 1U) << err();
    EXPECT_NE(err().find(mentioned), std::string::npos) << err();
    EXPECT_FALSE(fs::exists(file("answer.json")));
  };
  refused(" --from 9,8,7 --box 0,0,0,1,1", "expected x0,y0,z0,x1,y1,z1");
  refused(" --from 9,8,7 --box 0,0,0,1,1,1,2", "expected x0,y0,z0,x1,y1,z1");
  refused(" --from 9,8,7 --box 0,0,0,1,1,z", "'z' is no coordinate");
  refused(" --from 9,8,7 --box 0,0,1,1,1,1", "its low corner must be below");
  refused(" --from 9,8,7 --box 0,0,0,1,1,1e300", "outside [2^-140, 2^140]");
  refused(" --box 0,0,0,1,1,1 --path " +
              file("walk.json", R"({"points": [[3, 3, 3], [4, 4, 5]]})"),
          "without --box");
}

// Each view is written as it comes, but nothing has its name before all are done.
TEST_F(CliLook, ARefusalOfALaterViewLeavesNoVtkFiles) {
  EXPECT_EQ(
      run(kCube + " --direction 1,0,0 --direction 0,0,1 --up 0,0,1 --vtk " + file("vtk")),
      2);
  EXPECT_FALSE(fs::exists(file("vtk"))) << err();
  ASSERT_EQ(
      run(kCube + " --direction 1,0,0 --direction 0,1,0 --up 0,0,1 --vtk " + file("vtk")),
      0);
  EXPECT_TRUE(fs::exists(file("vtk") + "/view1_regions.vtp"));
  EXPECT_TRUE(fs::exists(file("vtk") + "/sightline.vtm"));
}

TEST_F(CliLook, EventsAlongAPathOfPoints) {
  const std::string path =
      file("walk.json", R"({"points": [[3, 3, 0.5], ["-2", 3, "1/2"], [-2, -2, 0.5]]})");
  const json j = answer(kCube + " --path " + path);
  EXPECT_EQ(j.at("complete"), true);
  const json& events = j.at("events");
  ASSERT_EQ(events.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const json& e = events[i];
    EXPECT_EQ(e.at("segment"), i / 2);
    EXPECT_EQ(e.at("kind"), "F");
    ASSERT_EQ(e.at("generators").size(), 1U);
    EXPECT_EQ(e.at("generators")[0].at("type"), "face");
    EXPECT_EQ(e.at("appears").size(), i % 2 == 0 ? 0U : 1U);
    EXPECT_EQ(e.at("vanishes").size(), i % 2 == 0 ? 1U : 0U);
    EXPECT_EQ(e.at("changes").at("regions"), i % 2 == 0 ? -1 : 1);
    EXPECT_EQ(e.at("changes").at("edges"), i % 2 == 0 ? -3 : 3);
  }
  const json& views = j.at("views");
  ASSERT_EQ(views.size(), 6U);
  EXPECT_EQ(views[0].at("u_from"), 0);
  EXPECT_EQ(views[0].at("u_to"), events[0].at("u"));
  EXPECT_EQ(views[1].at("u_from"), events[0].at("u"));
  EXPECT_EQ(views[2].at("u_to"), 1);
  EXPECT_EQ(views[3].at("segment"), 1);
  EXPECT_EQ(views[2].at("structure"), views[3].at("structure"));
  EXPECT_FALSE(views[0].contains("map"));
  EXPECT_TRUE(answer(kCube + " --list --path " + path).at("views")[0].contains("map"));
}

TEST_F(CliLook, EventsAlongGreatCirclesForPeople) {
  const std::string path =
      file("turn.json", R"({"directions": [[3, 2, 1], [-6, 4, 2]]})");
  ASSERT_EQ(run(kCube + " --path " + path), 0);
  EXPECT_NE(out().find("2 views, 2 events at 1 position"), std::string::npos) << out();
  EXPECT_NE(out().find("segment 0 at 0.333333333: F (facet "), std::string::npos)
      << out();
}

TEST_F(CliLook, RefusesPathsByTheElement) {
  const auto refused_with = [&](const std::string& words, const std::string& mentioned) {
    EXPECT_EQ(run(kCube + words + " --json " + file("answer.json")), 2) << words;
    EXPECT_EQ(occurrences(err(), "\n"), 1U) << err();
    EXPECT_NE(err().find(mentioned), std::string::npos) << err();
    EXPECT_FALSE(fs::exists(file("answer.json")));
  };
  const auto refused = [&](const std::string& text, const std::string& mentioned) {
    refused_with(" --path " + file("bad_path.json", text), "bad_path.json: " + mentioned);
  };
  refused("[]", "expected an object");
  refused("{}", "expected either");
  refused(R"({"points": [[3, 3, 3]]})", "points: expected at least two");
  refused(R"({"points": [[3, 3, 3], [1, 2]]})", "points[1]: expected three");
  refused(R"({"directions": [[3, 3, 3], [0, 0, 0]]})", "directions[1]: ");
  refused(R"({"directions": [[1, 2, 3], [-2, -4, -6]]})", "viewpoints 0 and 1");
  refused(R"({"points": [[3, 3, 3], [1, 2, 1e300]]})", "points[1]: the eye: ");
  const std::string good = file("good.json", R"({"points": [[3, 3, 3], [4, 4, 5]]})");
  refused_with(" --from 1,2,3 --path " + good, "--path: takes no --from");
  refused_with(" --csv " + file("p.csv") + " --path " + good, "--path: answers");
  refused_with(" --precision double --path " + good, "--path: is answered exactly");
}

TEST_F(CliLook, NumbersTheFilesOfSeveralViews) {
  ASSERT_EQ(run(kCube + " --from 9,8,7 --direction 1,2,3 --pixels 64 --svg " +
                file("two.svg") + " --png " + file("two.png")),
            0)
      << err();
  for (const char* name : {"two0.svg", "two1.svg", "two0.png", "two1.png"}) {
    EXPECT_TRUE(fs::exists(file(name))) << name;
  }
  EXPECT_FALSE(fs::exists(file("two.svg")));
  ASSERT_EQ(run(kCube + " --from 9,8,7 --svg " + file("one.svg")), 0) << err();
  EXPECT_TRUE(fs::exists(file("one.svg")));
}

}  // namespace
