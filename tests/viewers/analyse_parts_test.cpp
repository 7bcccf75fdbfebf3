// The parts of `sightline analyse`: which are done, what is told of each, and what budget
// each has.

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/generators.h"
#include "tests/support/shell.h"

namespace sightline {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::file_contents;

class AnalyseParts : public test::Shell {
 protected:
  json answer(const std::string& command) {
    const Run r = shell(command + " --json -");
    EXPECT_EQ(r.status, 0) << command << "\n" << r.err;
    return json::parse(r.out);
  }
  json in(const std::string& file) const {
    return json::parse(file_contents(folder_ / file));
  }
  static std::string parts_left_out(const json& report) {
    std::string parts;
    for (const json& left : report.at("left_out")) {
      parts += (parts.empty() ? "" : " ") + left.at("part").get<std::string>();
    }
    return parts;
  }
  std::string page() const { return file_contents(folder_ / "r/index.html"); }
};

constexpr const char* kViews = " --from 5,1.6,4 --direction 1/3,2,1 --from 3,1,-9";

TEST_F(AnalyseParts, LookAnswersWhatTheCommandDoes) {
  const json report = answer(std::string("$S analyse $ROOM -o r --only look") + kViews);
  EXPECT_EQ(report, in("r/report.json"));
  EXPECT_EQ(report.at("complete"), true);
  EXPECT_EQ(report.at("look").at("complete"), true);
  EXPECT_EQ(report.at("options").at("only"), json::parse(R"(["info", "look"])"));
  const json look = answer(std::string("$S look $ROOM --list") + kViews);
  ASSERT_EQ(look.at("views").size(), 3U);
  // With the map in a file of its own, and without in the report.
  EXPECT_EQ(in("r/look.json").at("command"), "look");
  EXPECT_EQ(in("r/look.json").at("views"), look.at("views"));
  json views = look.at("views");
  for (json& view : views) view.erase("map");
  EXPECT_EQ(report.at("look").at("views"), views);
}

TEST_F(AnalyseParts, EachViewIsDrawnAndOnThePage) {
  const json report = answer(std::string("$S analyse $ROOM -o r --only look") + kViews);
  for (const char* name :
       {"look.json", "look0.svg", "look2.svg", "look0.png", "look2.png"}) {
    EXPECT_EQ(std::ranges::count(report.at("files"), name), 1) << name;
    EXPECT_GT(file_contents(folder_ / "r" / name).size(), 1000U) << name;
    EXPECT_NE(page().find("href=\"" + std::string(name) + "\""), std::string::npos)
        << name;
  }
  EXPECT_NE(page().find("from 3,1,-9"), std::string::npos);
  EXPECT_EQ(page().find("arcs"), std::string::npos);  // nothing of a skeleton
  // One view has no number, and the next run removes what this one drew.
  answer("$S analyse $ROOM -o r --only look --from 5,1.6,4");
  EXPECT_FALSE(fs::exists(folder_ / "r/look0.svg"));
  EXPECT_TRUE(fs::exists(folder_ / "r/look.svg"));
  // y is up in this scene, and so it is in the drawing.
  shell("$S look $ROOM --from 5,1.6,4 --up 0,1,0 --svg up.svg");
  EXPECT_EQ(file_contents(folder_ / "r/look.svg"), file_contents(folder_ / "up.svg"));
}

TEST_F(AnalyseParts, WhatIsLeftOutIsToldWithACommandThatDoesIt) {
  const json whole = answer("$S analyse $CORNELL -o r");
  EXPECT_EQ(parts_left_out(whole), "look shadows formfactors");
  EXPECT_TRUE(whole.contains("skeleton"));
  EXPECT_FALSE(whole.contains("look"));
  EXPECT_NE(page().find("--from x,y,z"), std::string::npos);
  EXPECT_NE(page().find("--light GROUP"), std::string::npos);
  EXPECT_EQ(page().find("/scenes/cornell.obj"), std::string::npos);

  shell("cp $CORNELL \"it's.obj\"");
  const json views = answer("$S analyse \"it's.obj\" -o r --only look --from 1/3,2,7");
  EXPECT_EQ(parts_left_out(views), "skeleton shadows formfactors");
  const json both =
      answer("$S analyse \"it's.obj\" -o r --only skeleton --from 1/3,2,7 --light light");
  EXPECT_FALSE(both.contains("look"));
  EXPECT_EQ(parts_left_out(both), "look shadows formfactors");
  for (const json& left : both.at("left_out")) {
    EXPECT_EQ(left.at("why"), "not among --only");
    const std::string command = left.at("command").get<std::string>();
    ASSERT_TRUE(command.starts_with("sightline ")) << command;
    EXPECT_EQ(answer("$S" + command.substr(9)).at("command"), left.at("part"));
  }
}

TEST_F(AnalyseParts, ViewsThatCannotBeAreRefusedBeforeTheWork) {
  expect_told("$S analyse $ROOM -o r --only look", 2, "from where");
  expect_told("$S analyse $ROOM -o r --from 1,2", 2, "--from");
  expect_told("$S analyse $ROOM -o r --from 1e-60,2,3", 2, "outside [2^-140, 2^140]");
  expect_told("$S analyse $ROOM -o r --direction 0,0,0", 2, "--direction '0,0,0'");
  expect_told("$S analyse $ROOM -o r --only looks", 2,
              "available: info, skeleton, look, shadows, formfactors");
  EXPECT_FALSE(fs::exists(folder_ / "r"));
  // A plan along the axis that points up is drawn with another one up.
  answer("$S analyse $ROOM -o r --only look --direction 0,1,0 --up y");
  EXPECT_TRUE(fs::exists(folder_ / "r/look.svg"));
}

// A lamp of half-side 1 at height 4, a plate of half-side 3/2 at 2, a ground of half-side
// 8: umbra 4 x 4, penumbra 8 x 8 without it.
constexpr const char* kLit = "$DATA/shadows/mid_air.obj --light lamp";

TEST_F(AnalyseParts, ShadowsAnswersWhatTheCommandDoes) {
  const json report = answer(std::string("$S analyse -o r --only shadows ") + kLit);
  EXPECT_EQ(report, in("r/report.json"));
  EXPECT_EQ(report.at("options").at("light"), json::parse(R"(["lamp"])"));
  EXPECT_EQ(report.at("shadows").at("complete"), true);
  EXPECT_EQ(report.at("shadows").at("light"), json::parse(R"(["lamp"])"));
  const json shadows = answer(std::string("$S shadows --list ") + kLit);
  for (const char* key : {"receivers", "mesh", "structures"}) {
    EXPECT_EQ(in("r/shadows.json").at(key), shadows.at(key)) << key;
  }
  EXPECT_EQ(in("r/shadows.json").at("command"), "shadows");
  json receivers = shadows.at("receivers");
  ASSERT_EQ(receivers.size(), 2U);
  for (json& r : receivers) r.erase("facets");
  EXPECT_EQ(report.at("shadows").at("receivers"), receivers);
  EXPECT_EQ(report.at("shadows").at("mesh"), shadows.at("mesh"));
  EXPECT_NEAR(receivers[0].at("umbra_area").get<double>(), 16, 1e-9);
  shell(std::string("$S shadows --csv s.csv ") + kLit);
  EXPECT_EQ(file_contents(folder_ / "r/shadows.csv"), file_contents(folder_ / "s.csv"));
}

TEST_F(AnalyseParts, ShadowsAreDrawnAndOnThePage) {
  const json report = answer(std::string("$S analyse -o r --only shadows ") + kLit);
  for (const char* name : {"shadows.json", "shadows.csv", "shadows.png",
                           "vtk/shadow_faces.vtp", "vtk/sightline.vtm"}) {
    EXPECT_EQ(std::ranges::count(report.at("files"), name), 1) << name;
    EXPECT_GT(file_contents(folder_ / "r" / name).size(), 150U) << name;
    EXPECT_NE(page().find("href=\"" + std::string(name) + "\""), std::string::npos)
        << name;
  }
  EXPECT_NE(file_contents(folder_ / "r/vtk/sightline.vtm").find("shadow_faces"),
            std::string::npos);
  EXPECT_NE(page().find("<h2>Shadows</h2>"), std::string::npos);
  EXPECT_NE(page().find("<tr><td>ground</td><td class=n>256</td>"), std::string::npos);
  EXPECT_EQ(page().find("<h2>Form factors</h2>"), std::string::npos);
  // The next run removes what this one wrote.
  answer("$S analyse $DATA/shadows/mid_air.obj -o r --only formfactors");
  EXPECT_FALSE(fs::exists(folder_ / "r/shadows.png"));
  EXPECT_FALSE(fs::exists(folder_ / "r/shadows.json"));
}

TEST_F(AnalyseParts, FormFactorsAnswersWhatTheCommandDoes) {
  const json report = answer(std::string("$S analyse -o r --only formfactors ") + kLit);
  const json& part = report.at("formfactors");
  EXPECT_EQ(part.at("complete"), true);
  const json factors =
      answer(std::string("$S formfactors $DATA/shadows/mid_air.obj --accuracy 1e-6 "
                         "--csv f.csv"));
  for (const char* key : {"groups", "areas", "matrix", "error_bound", "others", "outside",
                          "backs", "row_sums", "accuracy", "pairs"}) {
    EXPECT_EQ(part.at(key), factors.at(key)) << key;
    EXPECT_EQ(in("r/formfactors.json").at(key), factors.at(key)) << key;
  }
  EXPECT_EQ(file_contents(folder_ / "r/formfactors.csv"),
            file_contents(folder_ / "f.csv"));
  EXPECT_NE(page().find("<h2>Form factors</h2>"), std::string::npos);
  EXPECT_NE(page().find("<th>1&nbsp;ground</th>"), std::string::npos);
  EXPECT_EQ(page().find("<h2>Shadows</h2>"), std::string::npos);
}

// With a light both are done; form factors between more than 100 groups only where they
// are named.
TEST_F(AnalyseParts, ALightAsksForShadowsAndFormFactors) {
  const json lit = answer(std::string("$S analyse -o r ") + kLit);
  EXPECT_EQ(parts_left_out(lit), "look");
  EXPECT_TRUE(lit.contains("shadows"));
  EXPECT_TRUE(lit.contains("formfactors"));
  shell(
      "cp $DATA/shadows/mid_air.obj many.obj\nfor i in $(seq 98); do printf 'o g%s\\nv "
      "0 0 9\\nv 1 0 9\\nv 0 1 9\\nf -3 -2 -1\\n' $i; done >> many.obj");
  const json many = answer("$S analyse many.obj -o r --light lamp");
  EXPECT_EQ(parts_left_out(many), "look formfactors");
  EXPECT_EQ(many.at("left_out")[1].at("why"), "more than 100 groups");
  expect_told("$S analyse many.obj -o q --only shadows", 2, "--light GROUP");
  expect_told("$S analyse many.obj -o q --light lump", 2, "lamp");
  EXPECT_FALSE(fs::exists(folder_ / "q"));
}

TEST_F(AnalyseParts, EmissiveMaterialsOfGltfAreTheLight) {
  // Both cubes are one mesh; the light is what its material says.
  shell(
      "sed 's/\"indices\": 1/\"indices\": 1, \"material\": 1/; s/ \"meshes\":/"
      "\"materials\": [{}, {\"emissiveFactor\": [0, 0.5, 0]}], \"meshes\":/' "
      "$DATA/formats/two_cubes.gltf > lit.gltf");
  const json lit = answer("$S analyse lit.gltf -o r --only formfactors");
  EXPECT_EQ(lit.at("options").at("light"), json::parse(R"(["left", "right"])"));
  const json named = answer("$S analyse lit.gltf -o r --only shadows --light left");
  EXPECT_EQ(named.at("options").at("light"), json::parse(R"(["left"])"));
  ASSERT_EQ(named.at("shadows").at("receivers").size(), 1U);
  EXPECT_EQ(named.at("shadows").at("receivers")[0].at("group"), "right");
  // A part of a group is told by its polygons.
  shell(
      "sed 's/0, 0.5, 0/0, 0, 0/; s/\"primitives\": \\[/\"primitives\": [{\"attributes\":"
      "{\"POSITION\":0},\"material\":2,\"mode\":5},/; s/\\[{}, /[{}, {},"
      "{\"emissiveFactor\":[1,0,0]},/' lit.gltf > part.gltf");
  const json part = answer("$S analyse part.gltf -o r --only info");
  EXPECT_EQ(part.at("options").at("light"), json::parse(R"(["#0-5", "#18-23"])"));
  const json dark = answer("$S analyse $DATA/formats/two_cubes.gltf -o r --only info");
  EXPECT_EQ(dark.at("options").at("light"), json::array());
}

// The meshes of this city take minutes, and so do its form factors.
TEST_F(AnalyseParts, ShadowsAndFormFactorsHaveSharesOfTheBudget) {
  PolygonSoup city = testing::street_city(1, 1500);
  testing::write_obj(folder_ / "city.obj", city);
  const Run r = shell(
      "$S analyse city.obj -o r --only shadows,formfactors --light '#20-24' --budget 4 "
      "--json -");
  EXPECT_EQ(r.status, 3) << r.err;
  const json report = json::parse(r.out);
  EXPECT_EQ(report.at("shadows").at("complete"), false);
  EXPECT_EQ(report.at("formfactors").at("complete"), false);
  const std::string missing = report.at("missing").dump();
  EXPECT_NE(missing.find("share of shadows in the budget ended first: the shadows on"),
            std::string::npos)
      << missing;
  EXPECT_NE(missing.find("the picture under the light was not drawn"), std::string::npos)
      << missing;
  EXPECT_NE(missing.find("the form factors from"), std::string::npos) << missing;
  EXPECT_LT(report.at("seconds").get<double>(), 5);
  EXPECT_NE(page().find("not complete"), std::string::npos);
  EXPECT_EQ(std::ranges::count(r.err, '\n'), 1) << r.err;
}

// The skeleton of this city takes some 10 s, and the view a tenth of a second.
TEST_F(AnalyseParts, EachPartHasAShareOfTheBudget) {
  testing::write_obj(folder_ / "city.obj", testing::street_city(1, 1500));
  const Run r =
      shell("$S analyse city.obj -o r --from -100,-100,150 --budget 3 --json -");
  EXPECT_EQ(r.status, 3) << r.err;
  const json report = json::parse(r.out);
  EXPECT_EQ(report.at("complete"), false);
  EXPECT_EQ(report.at("skeleton").at("complete"), false);
  EXPECT_EQ(report.at("look").at("complete"), true);
  EXPECT_NE(report.at("missing").at(0).get<std::string>().find("share of skeleton"),
            std::string::npos);
  EXPECT_NE(r.err.find("budget of 3 s"), std::string::npos) << r.err;
  EXPECT_EQ(std::ranges::count(r.err, '\n'), 1) << r.err;
}

}  // namespace
}  // namespace sightline
