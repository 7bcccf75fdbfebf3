// `sightline viewpoints` as a program: CONTRACT's keys, refusals, budget.

#include <gtest/gtest.h>

#include <fstream>

#include "tests/viewers/program_test.h"

namespace sightline::test {
namespace {

using nlohmann::json;

class CliViewpoints : public ProgramTest {
 protected:
  CliViewpoints() : ProgramTest("viewpoints") {
    std::ofstream(file("cube.obj"))
        << "o cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\n"
           "v 0 1 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  }
  [[nodiscard]] std::string cube() const { return file("cube.obj"); }
  [[nodiscard]] std::string far() const { return cube() + " --projection orthographic"; }
};

const std::string kRoom = std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj";

TEST_F(CliViewpoints, Best) {
  const json j = answer(far() + " --best 3");
  EXPECT_EQ(j.at("command"), "viewpoints");
  EXPECT_EQ(j.at("certified"), true);
  ASSERT_EQ(j.at("viewpoints").size(), 3U);
  for (const json& view : j.at("viewpoints")) {
    EXPECT_EQ(view.at("value"), 3);
    EXPECT_EQ(view.at("bound"), 3);
    EXPECT_EQ(view.at("faces").size(), 3U);
    EXPECT_EQ(view.at("at").size(), 3U);
  }
  for (const char* by : {"faces", "area", "solid-angle", "entropy", "structure"}) {
    const json near = answer(cube() + " --projection perspective --best 1 --by " + by);
    const json& view = near.at("viewpoints").at(0);
    EXPECT_LE(view.at("value"), view.at("bound")) << by;
  }
}

TEST_F(CliViewpoints, Cover) {
  for (const char* goal : {"parts", "whole", "parts --fraction 0.5"}) {
    const json j = answer(far() + " --cover " + goal);
    EXPECT_EQ(j.at("viewpoints").size(), 2U);
    EXPECT_EQ(j.at("lower_bound"), 2);
    EXPECT_EQ(j.at("optimal"), true);
    EXPECT_TRUE(j.at("never_seen").empty());
    EXPECT_TRUE(j.at("certificate").contains("apart"));
  }
}

TEST_F(CliViewpoints, NextAfterThese) {
  std::ofstream(file("seen.json")) << R"({"views": [{"direction": [3, 4, 5]}]})";
  const json j = answer(far() + " --next " + file("seen.json"));
  ASSERT_EQ(j.at("viewpoints").size(), 1U);
  EXPECT_EQ(j.at("viewpoints")[0].at("value"), 3);
  EXPECT_EQ(j.at("bound"), 3);
}

TEST_F(CliViewpoints, FromAGraphOfTheSameSceneOnly) {
  ASSERT_EQ(shell("$S aspects " + far() + " --list --json " + file("graph.json")).status,
            0);
  const std::string from = " --best 1 --from-graph " + file("graph.json");
  EXPECT_EQ(answer(far() + from).at("viewpoints")[0].at("value"), 3);
  EXPECT_EQ(run(kRoom + " --projection orthographic" + from), 2);
  EXPECT_NE(err().find("list[0]"), std::string::npos) << err();
  EXPECT_EQ(run(cube() + " --projection perspective" + from), 2);
  std::ofstream(file("graph.json")) << R"({"list": [{"at": [1, 0, 0]}]})";
  EXPECT_EQ(run(far() + from), 2);
  EXPECT_NE(err().find("structure"), std::string::npos) << err();
}

TEST_F(CliViewpoints, Refusals) {
  EXPECT_EQ(run(far()), 2);
  EXPECT_NE(err().find("--best"), std::string::npos);
  EXPECT_EQ(run(far() + " --best 1 --cover parts"), 2);
  EXPECT_EQ(run(far() + " --best 0"), 2);
  EXPECT_EQ(run(far() + " --best 1 --by entropy"), 2);
  EXPECT_EQ(run(far() + " --best 1 --by entropi"), 2);
  EXPECT_NE(err().find("entropy"), std::string::npos);
  EXPECT_EQ(run(far() + " --best 1 --bounds 0,0,0,1,1,1"), 2);
  EXPECT_EQ(run(far() + " --cover whole --fraction 0.5"), 2);
  EXPECT_EQ(run(far() + " --best 1 --of cub"), 2);
  EXPECT_NE(err().find("cube"), std::string::npos);
  std::ofstream(file("bad.json")) << R"({"views": [{"at": [3, 4, 5]}]})";
  EXPECT_EQ(run(far() + " --next " + file("bad.json")), 2);
  EXPECT_NE(err().find("views[0]"), std::string::npos);
}

TEST_F(CliViewpoints, BudgetLeavesAPartialAnswer) {
  EXPECT_EQ(run(kRoom + " --projection orthographic --best 2 --samples 100000" +
                " --budget 2 --json " + file("b.json")),
            3);
  EXPECT_EQ(json::parse(file_contents(file("b.json"))).at("complete"), false);
  EXPECT_EQ(std::ranges::count(err(), '\n'), 1) << err();
}

}  // namespace
}  // namespace sightline::test
