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
  ASSERT_EQ(whole.at("left_out").size(), 1U);
  EXPECT_EQ(whole.at("left_out")[0].at("part"), "look");
  EXPECT_TRUE(whole.contains("skeleton"));
  EXPECT_FALSE(whole.contains("look"));
  EXPECT_NE(page().find("--from x,y,z"), std::string::npos);
  EXPECT_EQ(page().find("/scenes/cornell.obj"), std::string::npos);

  shell("cp $CORNELL \"it's.obj\"");
  const json views = answer("$S analyse \"it's.obj\" -o r --only look --from 1/3,2,7");
  ASSERT_EQ(views.at("left_out").size(), 1U);
  EXPECT_EQ(views.at("left_out")[0].at("part"), "skeleton");
  const json both = answer("$S analyse \"it's.obj\" -o r --only skeleton --from 1/3,2,7");
  EXPECT_FALSE(both.contains("look"));
  for (const json& left : {views.at("left_out")[0], both.at("left_out")[0]}) {
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
  expect_told("$S analyse $ROOM -o r --only looks", 2, "available: info, skeleton, look");
  EXPECT_FALSE(fs::exists(folder_ / "r"));
  // A plan along the axis that points up is drawn with another one up.
  answer("$S analyse $ROOM -o r --only look --direction 0,1,0 --up y");
  EXPECT_TRUE(fs::exists(folder_ / "r/look.svg"));
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
