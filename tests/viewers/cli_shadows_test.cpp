// `sightline shadows` as scripts meet it: points, receivers, files, refusals.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/viewers/program_test.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sightline::test::file_contents;

const std::string kScenes = std::string(SIGHTLINE_TEST_DATA) + "/shadows/";
// A lamp of half-side 1 at height 4, a plate of half-side 3/2 at 2 (polygon 2), a ground
// of half-side 8 (polygon 1): umbra |p| < 2, penumbra |p| < 4.
const std::string kPlate = kScenes + "mid_air.obj --light lamp";
const std::string kRoom = std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj";

class CliShadows : public sightline::test::ProgramTest {
 protected:
  CliShadows() : ProgramTest("shadows") {}

  void expect_refused(const std::string& arguments, const std::string& mentioned) {
    ProgramTest::expect_refused(
        arguments + " --csv " + file("x.csv") + " --json " + file("x.json"), mentioned);
  }
};

// ---- points ---------------------------------------------------------------------------

TEST_F(CliShadows, PointsInTheirOrder) {
  const std::string points = file("p.json", R"({"points": [[0,0,0], ["3","0/7",0],
      [6,0,0], ["1/3",9,"2/3"]], "normals": [[0,0,1], [0,0,"5"], null, null],
      "on": [null, null, null, 1]})");
  const json j = answer(kPlate + " --at " + points);
  EXPECT_EQ(j.at("command"), "shadows");
  EXPECT_EQ(j.at("complete"), true);
  for (const char* key : {"version", "scene", "seconds", "peak_memory_bytes"})
    EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_GT(j.at("predicates").at("double"), 0);
  EXPECT_FALSE(j.contains("receivers")) << "none asked for beside points";
  const json& p = j.at("points");
  ASSERT_EQ(p.size(), 4U);
  EXPECT_EQ(p[0].at("class"), "umbra");
  EXPECT_EQ(p[0].at("visible_fraction"), 0);
  EXPECT_EQ(p[0].at("form_factor"), 0);
  EXPECT_EQ(p[1].at("class"), "penumbra");
  EXPECT_NEAR(p[1].at("visible_fraction").get<double>(), 0.5, 1e-14);
  EXPECT_GT(p[1].at("form_factor"), 0);
  EXPECT_EQ(p[2].at("class"), "lit");
  EXPECT_EQ(p[2].at("visible_fraction"), 1);
  EXPECT_TRUE(p[2].at("form_factor").is_null()) << "no normal";
  // On the ground, beside it; the polygon's normal.
  EXPECT_EQ(p[3].at("class"), "lit");
  EXPECT_GT(p[3].at("form_factor"), 0);
  for (const json& point : p) {
    EXPECT_FALSE(point.contains("structure"));
    EXPECT_FALSE(point.contains("seen"));
    EXPECT_FALSE(point.contains("gradient"));
  }
}

// "on" moves along the polygon's normal, exactly: 1/3 + 1/3 + ... stays on it.
TEST_F(CliShadows, OnMovesAPointOntoItsPolygon) {
  const json p =
      answer(kPlate + " --at " + file("p.json", R"({"points": [[0, 0, "-1/3"], [0, 0, 9],
          [0, 0, -1]], "on": [2, 2, null]})"))
          .at("points");
  EXPECT_EQ(p[0].at("class"), "lit") << "on the plate";
  EXPECT_EQ(p[1].at("class"), "lit");
  EXPECT_EQ(p[0].at("form_factor"), p[1].at("form_factor"));
  EXPECT_EQ(p[2].at("class"), "umbra") << "below the ground, as written";
}

TEST_F(CliShadows, PointsAsText) {
  const std::string points = file(
      "p.txt", "# x y z, and a normal\n0,0,0\n\n  3 0 0  0 0 1  # beside\n6, 0, 0/5\n");
  const json p = answer(kPlate + " --at " + points).at("points");
  ASSERT_EQ(p.size(), 3U);
  EXPECT_EQ(p[0].at("class"), "umbra");
  EXPECT_TRUE(p[0].at("form_factor").is_null());
  EXPECT_EQ(p[1].at("class"), "penumbra");
  EXPECT_GT(p[1].at("form_factor"), 0);
  EXPECT_EQ(p[2].at("class"), "lit");
  ASSERT_EQ(run(kPlate + " --at " + points), 0);
  EXPECT_NE(out().find("3 points: 1 lit, 1 in penumbra, 1 in umbra"), std::string::npos)
      << out();
}

TEST_F(CliShadows, StructureAndGradient) {
  const json p = answer(kPlate + " --structure --gradient --at " +
                        file("p.txt", "3,0,0,0,0,1\n0,0,0,0,0,1\n4,0,0,0,0,1\n3,0,0\n"))
                     .at("points");
  ASSERT_EQ(p[0].at("structure").size(), 1U);
  const json& sides = p[0].at("structure")[0].at("sides");
  EXPECT_EQ(sides.size(), 4U);
  EXPECT_TRUE(std::ranges::any_of(sides, [](const json& side) {
    return side.at(0).get<std::string>().starts_with("edge ");
  }));
  ASSERT_EQ(p[0].at("seen").size(), 1U);
  for (const json& corner : p[0].at("seen")[0]) {
    EXPECT_GE(corner[0], -1e-15);
    EXPECT_EQ(corner[2], 4);
  }
  ASSERT_EQ(p[0].at("gradient").size(), 3U);
  EXPECT_GT(p[0].at("gradient")[0], 0) << "out of the shadow it grows";
  EXPECT_EQ(p[1].at("structure"), json::array());
  EXPECT_EQ(p[1].at("gradient").dump(), "[0.0,0.0,0.0]");
  EXPECT_TRUE(p[2].at("gradient").is_null()) << "on an edge of the mesh";
  EXPECT_TRUE(p[3].at("gradient").is_null()) << "no normal";
}

// CONTRACT: on an edge of the mesh "gradient" is null, and "one_sided" has both sides'.
TEST_F(CliShadows, OneSidedGradients) {
  const json p =
      answer(kPlate + " --gradient --at " + file("p.txt", "4,0,0,0,0,1\n")).at("points");
  EXPECT_EQ(p[0].at("one_sided").size(), 2U);
}

TEST_F(CliShadows, PointsAsATable) {
  ASSERT_EQ(run(kPlate + " --csv - --at " + file("p.txt", "3,0,0\n6,0,0,0,0,1\n")), 0);
  std::istringstream rows(out());
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "point,x,y,z,class,visible_fraction,form_factor");
  std::getline(rows, row);
  EXPECT_EQ(row, "0,3,0,0,penumbra,0.5,");
  std::getline(rows, row);
  EXPECT_TRUE(row.starts_with("1,6,0,0,lit,1,0.0")) << row;
  EXPECT_FALSE(std::getline(rows, row)) << "and nothing else goes there";
}

// ---- receivers ------------------------------------------------------------------------

TEST_F(CliShadows, ReceiversByDefaultAreAllButTheLight) {
  const json r = answer(kPlate).at("receivers");
  ASSERT_EQ(r.size(), 2U);
  EXPECT_EQ(r[0].at("group"), "ground");
  EXPECT_EQ(r[1].at("group"), "plate");
  ASSERT_EQ(run(kPlate), 0);
  EXPECT_NE(out().find("ground: area 256: lit 192, penumbra 48, umbra 16"),
            std::string::npos)
      << out();
}

TEST_F(CliShadows, ReceiversByName) {
  const json j = answer(kPlate + " --receivers ground");
  ASSERT_EQ(j.at("receivers").size(), 1U);
  const json& r = j.at("receivers")[0];
  EXPECT_NEAR(r.at("area").get<double>(), 256, 1e-12);
  EXPECT_NEAR(r.at("umbra_area").get<double>(), 16, 1e-12);
  EXPECT_NEAR(r.at("penumbra_area").get<double>(), 48, 1e-12);
  EXPECT_NEAR(r.at("lit_area").get<double>(), 192, 1e-12);
  EXPECT_EQ(r.at("away_area"), 0);
  EXPECT_LE(r.at("area_error_bound"), 1e-10 * 256);
  EXPECT_EQ(r.at("umbra_components"), 1);
  EXPECT_EQ(r.at("mesh"), json::parse(R"({"vertices": 20, "faces": 10, "structures": 10,
      "edges": {"EV": 0, "EE": 24, "EEE": 0, "face": 0, "contact": 0, "plane": 0,
                "boundary": 4}})"));
  EXPECT_EQ(j.at("mesh"), r.at("mesh"));
  EXPECT_FALSE(r.contains("facets"));
  EXPECT_FALSE(j.contains("structures"));
  // By numbers; and beside points.
  EXPECT_EQ(answer(kPlate + " --receivers '#1-1'").at("receivers")[0].at("mesh"),
            r.at("mesh"));
  const json both =
      answer(kPlate + " --receivers plate --at " + file("p.txt", "0,0,0\n"));
  EXPECT_EQ(both.at("points").size(), 1U);
  EXPECT_EQ(both.at("receivers").size(), 1U);
}

TEST_F(CliShadows, ListTellsTheMesh) {
  const json j = answer(kPlate + " --receivers ground --list");
  const json& facets = j.at("receivers")[0].at("facets");
  ASSERT_EQ(facets.size(), 1U);
  const json& mesh = facets[0];
  EXPECT_EQ(mesh.at("vertices").size(), 20U);
  ASSERT_EQ(mesh.at("edges").size(), 28U);
  ASSERT_EQ(mesh.at("faces").size(), 10U);
  for (const char* key : {"origin", "x", "y"})
    EXPECT_EQ(mesh.at("frame").at(key).size(), 3U);
  for (const json& e : mesh.at("edges")) {
    const bool boundary = e.at("kind") == "boundary";
    EXPECT_EQ(e.at("order").is_null(), boundary);
    if (!boundary) {
      EXPECT_EQ(e.at("order"), 1);
    }
    EXPECT_EQ(e.at("conic").size(), 6U);
    for (const json& end : e.at("ends")) EXPECT_LT(end, 20);
    EXPECT_EQ(e.at("points").front(), mesh.at("vertices")[e.at("ends")[0].get<int>()]);
    EXPECT_EQ(e.at("points").back(), mesh.at("vertices")[e.at("ends")[1].get<int>()]);
    EXPECT_NE(e.at("left"), e.at("right"));
  }
  double sum = 0;
  for (const json& f : mesh.at("faces")) {
    sum += f.at("area").get<double>();
    const json& structure = j.at("structures").at(f.at("structure").get<int>());
    EXPECT_EQ(f.at("class") == "umbra", structure.empty());
    EXPECT_EQ(f.at("inside").size(), 3U);
    EXPECT_EQ(f.at("away"), false);
  }
  EXPECT_NEAR(sum, 256, 1e-10);
}

TEST_F(CliShadows, ReceiversAsATable) {
  ASSERT_EQ(run(kPlate + " --csv - --receivers ground,plate"), 0);
  const std::string text = out();
  EXPECT_EQ(std::ranges::count(text, '\n'), 3);
  EXPECT_TRUE(
      text.starts_with("receiver,area,umbra_area,penumbra_area,lit_area,away_area,"
                       "area_error_bound,umbra_components,"))
      << text;
  EXPECT_NE(text.find("\n\"ground\",256,16,48,192,0,"), std::string::npos) << text;
}

TEST_F(CliShadows, BothSidesReceiveAndShine) {
  const std::string scene = kScenes + "two_sided.obj --light lamp";
  const auto lit = [](const json& r) { return r.at("lit_area").get<double>(); };
  // The plate's back sees nothing of a lamp above it.
  const json r =
      answer(kPlate + " --both-sides plate --receivers ground,plate").at("receivers");
  ASSERT_EQ(r.size(), 3U);
  EXPECT_EQ(r[1].at("group"), "plate");
  EXPECT_NEAR(lit(r[1]), 9, 1e-12);
  EXPECT_EQ(r[2].at("group"), "plate/back");
  EXPECT_EQ(lit(r[2]), 0);
  EXPECT_NEAR(r[2].at("away_area").get<double>(), 9, 1e-12);
  // The ceiling above a lamp that shines down, and both ways.
  const json one = answer(scene + " --receivers ceiling").at("receivers");
  const json two =
      answer(scene + " --both-sides lamp --receivers ceiling").at("receivers");
  EXPECT_EQ(lit(one[0]), 0);
  EXPECT_NEAR(lit(two[0]), 256, 1e-10);
}

TEST_F(CliShadows, WithoutAPlate) {
  const json r = answer(kPlate + " --without plate").at("receivers");
  const json lit = answer(kPlate + " --without plate --at " + file("p.txt", "0,0,0\n"));
  EXPECT_EQ(lit.at("points")[0].at("class"), "lit");
  EXPECT_NEAR(r[0].at("lit_area").get<double>(), 256, 1e-10);
}

TEST_F(CliShadows, Volumes) {
  const json j = answer(kPlate + " --volumes --solid plate --vtk " + file("vtk"));
  const json& v = j.at("volumes");
  EXPECT_NEAR(v.at("umbra").at("volume").get<double>(), 37 / 1.5, 1e-12);
  EXPECT_NEAR(v.at("penumbra").at("volume").get<double>(), 40, 1e-12);
  EXPECT_EQ(v.at("away_volume"), 0);
  EXPECT_EQ(v.at("solid_volume"), 0);
  EXPECT_FALSE(j.contains("receivers")) << "none asked for beside volumes";
  const json& umbra = v.at("umbra");
  EXPECT_EQ(umbra.at("vertices").size(), 8U);
  ASSERT_EQ(umbra.at("sides").size(), 6U);
  for (const json& side : umbra.at("sides")) {
    EXPECT_EQ(side.at("corners").size(), 4U);
    EXPECT_FALSE(side.at("generators").empty());
  }
  for (const char* name : {"shadow_umbra.vtp", "shadow_penumbra.vtp", "sightline.vtm"})
    EXPECT_TRUE(fs::exists(file("vtk") + "/" + name)) << name;
  ASSERT_EQ(run(kScenes + "corner.obj --light lamp --volumes"), 0);
  EXPECT_NE(out().find("volumes: umbra 11.3333 (the solid 4)"), std::string::npos)
      << out();
  // Coordinates that no double holds.
  const json exact = answer(kScenes + "volumes.obj --light lamp --volumes");
  EXPECT_NE(exact.dump().find('/'), std::string::npos);
}

TEST_F(CliShadows, VolumesThatAreRefused) {
  expect_refused(kPlate + " --volumes", "no closed object");
  expect_refused(kPlate + " --volumes --solid plat", "did you mean 'plate'?");
  expect_refused(kPlate + " --solid plate", "--solid");
  expect_refused(kScenes + "l_shaped.obj --light lamp --volumes", "no convex polygon");
  expect_refused(kScenes + "cuts_the_source.obj --light lamp --volumes",
                 "cuts the source");
  expect_refused(kPlate + " --volumes --solid plate --both-sides lamp", "both sides");
}

TEST_F(CliShadows, FeatureSize) {
  const std::string scene = kScenes + "corner.obj --light lamp";
  const json all = answer(scene);
  const json zero = answer(scene + " --feature-size 0");
  EXPECT_EQ(zero.at("mesh"), all.at("mesh"));
  EXPECT_FALSE(zero.contains("left_out"));
  // The box's diagonal is 3.
  const json none = answer(scene + " --feature-size 3");
  EXPECT_EQ(none.at("mesh"), all.at("mesh"));
  EXPECT_EQ(none.at("left_out"), json::array());
  EXPECT_EQ(none.at("form_factor_error_bound"), 0);
  const std::string points = file("p.txt", "0,0,0,0,0,1\n");
  const json out =
      answer(scene + " --feature-size 3.01 --receivers ground --at " + points);
  ASSERT_EQ(out.at("left_out").size(), 1U);
  EXPECT_EQ(out.at("left_out")[0].at("group"), "box");
  EXPECT_EQ(out.at("left_out")[0].at("polygons").size(), 6U);
  EXPECT_EQ(out.at("left_out")[0].at("diagonal"), 3);
  EXPECT_GT(out.at("form_factor_error_bound"), 0.05);
  EXPECT_LE(out.at("form_factor_error_bound"), 1);
  EXPECT_EQ(out.at("receivers")[0].at("lit_area"), 256);
  EXPECT_LT(out.at("points")[0].at("visible_fraction"), 1) << "points are exact";
  // A receiver that is named stays.
  EXPECT_EQ(answer(scene + " --feature-size 4 --receivers box").at("left_out"),
            json::array());
  expect_refused(scene + " --feature-size -1", "--feature-size");
}

TEST_F(CliShadows, SeveralLightsByNamesAndNumbers) {
  const std::string scene = kScenes + "several_at_once.obj";
  const std::string at = " --at " + file("p.txt", "0,0,0,0,0,1\n");
  const auto factor = [&](const std::string& light) {
    return answer(scene + light + at).at("points")[0].at("form_factor").get<double>();
  };
  const double both = factor(" --light high,low");
  EXPECT_NEAR(both, factor(" --light high") + factor(" --light low"), 1e-15);
  EXPECT_EQ(both, factor(" --light '#0-1'"));
  EXPECT_EQ(both, factor(" --light high --light '#1-1'"));
}

TEST_F(CliShadows, TheAnswerDoesNotDependOnThreads) {
  const std::string scene = kScenes + "edge_eee.obj --light lamp --list";
  const json one = answer(scene + " --threads 1"), two = answer(scene + " --threads 2");
  EXPECT_EQ(one.at("receivers"), two.at("receivers"));
  EXPECT_EQ(one.at("structures"), two.at("structures"));
}

// ---- pictures -------------------------------------------------------------------------

TEST_F(CliShadows, PicturesNeedNoDisplay) {
  const std::string camera = " --eye 9,-12,6 --towards 0,0,1 --size 64x48";
  ASSERT_EQ(run(kPlate + camera + " --png " + file("a.png")), 0) << err();
  ASSERT_EQ(run(kPlate + camera + " --fov 30 --png " + file("b.png")), 0) << err();
  ASSERT_EQ(run(kPlate + camera + " --rays 4 --png " + file("c.png")), 0) << err();
  ASSERT_EQ(run(kPlate + camera + " --rays 4 --seed 2 --png " + file("d.png")), 0);
  ASSERT_EQ(run(kPlate + camera + " --rays 4 --seed 2 --png " + file("e.png")), 0);
  const std::string exact = file_contents(file("a.png"));
  EXPECT_EQ(exact.substr(1, 3), "PNG");
  EXPECT_EQ(exact.substr(16, 8), std::string("\0\0\0\x40\0\0\0\x30", 8)) << "its size";
  EXPECT_NE(exact, file_contents(file("b.png")));
  EXPECT_NE(exact, file_contents(file("c.png")));
  EXPECT_NE(file_contents(file("c.png")), file_contents(file("d.png")));
  EXPECT_EQ(file_contents(file("d.png")), file_contents(file("e.png")));
  ASSERT_EQ(run(kPlate + camera + " --png -"), 0);
  EXPECT_EQ(out(), exact) << "and nothing else goes there";
}

// ---- budgets and refusals -------------------------------------------------------------

/// Budgets that grow, however fast the machine is: the first in which a point is done,
/// and not all that was asked.
class CliShadowBudgets : public CliShadows {
 protected:
  json with_a_point_done(const std::string& question, double budget) {
    for (; budget < 200; budget *= 1.3) {
      const int status = run(question + " --budget " + std::to_string(budget) +
                             " --json " + file("v.json"));
      EXPECT_EQ(status, 3) << "with " << budget
                           << " s all is done, and with less nothing";
      EXPECT_EQ(std::ranges::count(err(), '\n'), 1) << err();
      const json j = json::parse(file_contents(file("v.json")), nullptr, false);
      if (status == 3 && j.is_discarded()) continue;
      EXPECT_EQ(j.at("complete"), false);
      if (status != 3 || j.at("points").at(0).is_object()) return j;
    }
    ADD_FAILURE() << "no budget was enough for a point";
    return {};
  }
};

TEST_F(CliShadowBudgets, WhatIsLeftOfPointsIsNull) {
  std::ostringstream points;
  for (int i = 0; i < 400000; ++i)
    points << 3 + 0.000005 * i << ',' << 0.3 << ',' << 2 + 0.000002 * i << ",0,1,0\n";
  const json j =
      with_a_point_done(kRoom + " --light lamp_shade --at " +
                            file("many.txt", points.str()) + " --csv " + file("v.csv"),
                        1);
  const json& p = j.at("points");
  ASSERT_EQ(p.size(), 400000U);
  EXPECT_TRUE(p[399999].is_null());
  const auto done =
      std::ranges::count_if(p, [](const json& one) { return !one.is_null(); });
  EXPECT_EQ(std::ranges::count(file_contents(file("v.csv")), '\n'), 1 + done);
}

// A point is done at once; receivers take some ten times as long.
TEST_F(CliShadowBudgets, ReceiversThatAreLeftAreMissing) {
  const json j =
      with_a_point_done(kRoom + " --light lamp_shade --at " + file("p.txt", "5 1 3\n") +
                            " --receivers floor,ceiling,wall_right,wall_front,"
                            "wall_door_front,table_top",
                        0.02);
  EXPECT_EQ(j.at("receivers").size() + j.at("missing").size(), 6U);
  EXPECT_EQ(j.at("missing").back(), "table_top");
}

TEST_F(CliShadows, RefusesWhatItCannotAnswerInOneLine) {
  expect_refused(kScenes + "mid_air.obj", "--light is required");
  expect_refused(kScenes + "mid_air.obj --light lamb", "'lamb'; did you mean 'lamp'?");
  expect_refused(kScenes + "mid_air.obj --light '#2-3'",
                 "#2-3: the file has faces 0 to 2");
  expect_refused(kScenes + "mid_air.obj --light '#2-1'", "no faces #2-1");
  expect_refused(kPlate + " --receivers grund", "'grund'; did you mean 'ground'?");
  expect_refused(kPlate + " --without plat", "'plat'; did you mean 'plate'?");
  expect_refused(kPlate + " --both-sides plat", "'plat'; did you mean 'plate'?");
  expect_refused(kPlate + " --without lamp", "lamp has no face with an area");
  expect_refused("missing.obj --light lamp", "missing.obj");
  expect_refused(kPlate + " --at " + file("none.json"), "none.json: no such file");
  expect_refused(kPlate + " --reciever ground", "--receivers");
  expect_refused(kPlate + " --threads x", "--threads");
}

TEST_F(CliShadows, RefusesPointsByTheElement) {
  const auto json_refused = [&](const std::string& text, const std::string& mentioned) {
    expect_refused(kPlate + " --at " + file("bad.json", text), "bad.json: " + mentioned);
  };
  json_refused("[]", "expected an object");
  json_refused("{", "not JSON");
  json_refused("{}", "has no \"points\"");
  json_refused(R"({"points": []})", "no points");
  json_refused(R"({"points": [[0, 0]]})", "points[0]: expected three");
  json_refused(R"({"points": [[0, 0, 0], [0, null, 0]]})", "points[1]: expected three");
  json_refused(R"({"points": [[0, 0, "1/0"]]})", "points[0]: '1/0'");
  json_refused(R"({"points": [[0, 0, 1e300]]})", "points[0]: ");
  json_refused(R"({"points": [[0, 0, 0]], "normals": []})", "normals: 0 items for 1");
  json_refused(R"({"points": [[0, 0, 0]], "normals": [[0, 0, 0]]})", "normals[0]: ");
  json_refused(R"({"points": [[0, 0, 0]], "normals": [[1, 0]]})", "normals[0]: expected");
  json_refused(R"({"points": [[0, 0, 0]], "on": [3]})", "on[0]: no polygon 3");
  json_refused(R"({"points": [[0, 0, 0]], "on": [-1]})", "on[0]: ");
  json_refused(R"({"points": [[0, 0, 0]], "on": ["x"]})", "on[0]: ");
  json_refused(R"({"points": [[0, 0, 0]], "on": [0, 1]})", "on: 2 items for 1");
  const auto text_refused = [&](const std::string& text, const std::string& mentioned) {
    expect_refused(kPlate + " --at " + file("bad.txt", text), "bad.txt:" + mentioned);
  };
  text_refused("", " no points");
  text_refused("0 0\n", "1: expected x,y,z");
  text_refused("0 0 0\n\n0 0 0 1\n", "3: expected x,y,z");
  text_refused("0 0 x\n", "1: 'x'");
  text_refused("0 0 nan\n", "1: 'nan'");
  text_refused("0 0 0\n1 2 3 0 0 0\n", "2: the normal");
}

TEST_F(CliShadows, RefusesPicturesThatCannotBe) {
  const std::string png = " --png " + file("x.png");
  expect_refused(kPlate + png, "--png: from where?");
  expect_refused(kPlate + png + " --eye 1,2 --towards 0,0,0", "--eye");
  expect_refused(kPlate + png + " --eye 1,2,nan --towards 0,0,0", "--eye");
  expect_refused(kPlate + png + " --eye 1,2,3 --towards 1,2,3", "--towards");
  expect_refused(kPlate + png + " --eye 0,0,3 --towards 0,0,0", "--up");
  expect_refused(kPlate + png + " --eye 1,2,3 --towards 0,0,0 --size 0x7",
                 "--size '0x7'");
  expect_refused(kPlate + png + " --eye 1,2,3 --towards 0,0,0 --fov 0", "--fov");
  expect_refused(kPlate + png + " --eye 1,2,3 --towards 0,0,0 --rays 0", "--rays");
  expect_refused(kPlate + " --eye 1,2,3", "--eye requires --png");
  expect_refused(kPlate + " --rays 3", "--rays requires --png");
}

}  // namespace
