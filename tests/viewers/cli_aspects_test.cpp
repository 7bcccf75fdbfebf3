// `sightline aspects` as a program: CONTRACT's keys, refusals, budget.

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "tests/viewers/program_test.h"

namespace sightline::test {
namespace {

using nlohmann::json;

class CliAspects : public ProgramTest {
 protected:
  CliAspects() : ProgramTest("aspects") {
    std::ofstream(file("cube.obj"))
        << "o cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\n"
           "v 0 1 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  }
  [[nodiscard]] std::string cube() const { return file("cube.obj"); }
};

const std::string kRoom = std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj";

TEST_F(CliAspects, Cube) {
  const json far = answer(cube() + " --projection orthographic --list");
  EXPECT_EQ(far.at("method"), "exact");
  EXPECT_EQ(far.at("certified"), true);
  EXPECT_EQ(far.at("aspects"), 8);
  EXPECT_EQ(far.at("adjacencies"), 12);
  EXPECT_EQ(far.at("distinct"), 8);
  EXPECT_EQ(far.at("by_visible_faces"), 8);
  EXPECT_EQ(far.at("by_shape"), 1);
  EXPECT_TRUE(far.at("estimate").is_null());
  EXPECT_FALSE(far.contains("unbounded"));
  ASSERT_EQ(far.at("list").size(), 8U);
  double weight = 0;
  for (const json& a : far.at("list")) {
    weight += a.at("weight").get<double>();
    EXPECT_EQ(a.at("faces").size(), 3U);
    EXPECT_EQ(a.at("neighbours").size(), 3U);
    EXPECT_EQ(a.at("events").size(), 3U);
    EXPECT_EQ(a.at("structure").get<std::string>().size(), 32U);
    EXPECT_NEAR(a.at("clearance").get<double>(), std::asin(1 / std::sqrt(3.0)), 1e-12);
    for (const json& x : a.at("at")) EXPECT_TRUE(x.is_number());
  }
  EXPECT_NEAR(weight, 4 * std::numbers::pi, 1e-12);
  const json near = answer(cube() + " --projection perspective");
  EXPECT_EQ(near.at("aspects"), 26);
  EXPECT_EQ(near.at("adjacencies"), 48);
  EXPECT_EQ(near.at("by_shape"), 3);
  EXPECT_EQ(near.at("unbounded"), 26);
  EXPECT_EQ(near.at("bounded"), 0);
  EXPECT_FALSE(near.contains("list"));
}

TEST_F(CliAspects, Sampled) {
  const json j = answer(cube() +
                        " --projection perspective --method sampled --sampling random "
                        "--samples 600 --seed 3 --check 100 --aspect faces --list");
  EXPECT_EQ(j.at("method"), "sampled");
  EXPECT_EQ(j.at("certified"), false);
  EXPECT_EQ(j.at("aspects"), 26);
  EXPECT_EQ(j.at("by_shape"), 3);
  const json& e = j.at("estimate");
  EXPECT_LE(e.at("unseen_interval95")[0], e.at("unseen_weight"));
  EXPECT_GE(e.at("distinct_total"), 26);
  EXPECT_EQ(j.at("check").at("not_in_graph"), 0);
  EXPECT_GT(j.at("check").at("views"), 80);
  // Regular samples get no estimate.
  EXPECT_TRUE(answer(cube() + " --projection orthographic --method sampled --samples 12")
                  .at("estimate")
                  .is_null());
}

TEST_F(CliAspects, WhatIsNotExactSaysWhy) {
  std::ofstream(file("two.obj"))
      << "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv .2 .2 "
         "-1\nv .2 .2 1\nv .3 1 .5\nf 4 5 6\n";
  const json j =
      answer(file("two.obj") + " --projection orthographic --samples 12 --list");
  EXPECT_EQ(j.at("method"), "refined");
  EXPECT_GE(j.at("rounds").size(), 1U);
  EXPECT_EQ(j.at("list").size(), j.at("aspects"));
  EXPECT_EQ(j.at("certified"), false);
  EXPECT_FALSE(j.at("why").get<std::string>().empty());
}

TEST_F(CliAspects, Refusals) {
  EXPECT_EQ(run(cube()), 2);
  EXPECT_NE(err().find("--projection"), std::string::npos);
  EXPECT_EQ(run(cube() + " --projection ortographic"), 2);
  EXPECT_NE(err().find("orthographic"), std::string::npos);
  EXPECT_EQ(run(cube() + " --projection orthographic --bounds 0,0,0,1,1,1"), 2);
  EXPECT_EQ(run(cube() + " --projection perspective --bounds 0,0,0,1,1,0"), 2);
  EXPECT_EQ(run(cube() + " --projection perspective --of cub"), 2);
  EXPECT_NE(err().find("cube"), std::string::npos);
  EXPECT_EQ(run(cube() + " --projection perspective --samples 0"), 2);
}

TEST_F(CliAspects, BudgetLeavesAPartialGraph) {
  EXPECT_EQ(run(kRoom + " --projection orthographic --method sampled --samples 100000" +
                " --budget 3 --json " + file("b.json")),
            3);
  EXPECT_EQ(json::parse(file_contents(file("b.json"))).at("complete"), false);
  EXPECT_EQ(std::ranges::count(err(), '\n'), 1) << err();
}

}  // namespace
}  // namespace sightline::test
