// `sightline formfactors` as scripts meet it: matrices, points, files, refusals.

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

const std::string kRoom = std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj";

class CliFormFactors : public sightline::test::ProgramTest {
 protected:
  CliFormFactors() : ProgramTest("formfactors") {}

  void expect_refused(const std::string& arguments, const std::string& mentioned) {
    ProgramTest::expect_refused(arguments + " --json " + file("x.json"), mentioned);
  }

  /// Two unit squares that face each other at distance 1, and one between them.
  std::string squares() const {
    return file("squares.obj",
                "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                "v .25 .25 .5\nv .75 .25 .5\nv .75 .75 .5\nv .25 .75 .5\n"
                "g floor\nf 1 2 3 4\ng ceiling\nf 8 7 6 5\ng pane\nf 9 10 11 12\n");
  }
};

TEST_F(CliFormFactors, MatrixInTheOrderAsked) {
  const json j = answer(squares() + " --groups ceiling,floor --up 0,0,1");
  EXPECT_EQ(j.at("command"), "formfactors");
  EXPECT_EQ(j.at("complete"), true);
  EXPECT_EQ(j.at("groups").dump(), R"(["ceiling","floor"])");
  EXPECT_NEAR(j.at("matrix")[0][1], 0.099506294598985, 1e-10);
  EXPECT_NEAR(j.at("matrix")[1][0], 0.099506294598985, 1e-10);
  EXPECT_EQ(j.at("matrix")[0][0], 0);
  EXPECT_EQ(j.at("areas")[0], 1);
  EXPECT_LE(j.at("error_bound").get<double>(), 1e-10);
  const double seen = 1 - 0.099506294598985;
  EXPECT_NEAR(j.at("others")[0].get<double>() + j.at("outside")[0].get<double>(), seen,
              1e-9);
  EXPECT_NEAR(j.at("backs")[1].get<double>() + j.at("outside")[1].get<double>(), seen,
              1e-9);
  EXPECT_NEAR(j.at("sky")[1].get<double>(), j.at("outside")[1].get<double>(), 1e-9);
  EXPECT_NEAR(j.at("sky")[0].get<double>(), 0, 1e-9);
}

TEST_F(CliFormFactors, WithoutThePane) {
  const json j = answer(squares() + " --groups floor,ceiling --without pane");
  EXPECT_NEAR(j.at("matrix")[0][1], 0.199824895698387, 1e-10);
}

TEST_F(CliFormFactors, EachFaceHasItsNumberInTheFile) {
  const json j = answer(squares() + " --groups pane,floor --each face --both-sides pane");
  EXPECT_EQ(j.at("groups").dump(), R"(["pane/2","pane/2/back","floor/0"])");
  EXPECT_GT(j.at("matrix")[1][2], 0.3);
  EXPECT_EQ(j.at("matrix")[0][2], 0);
}

TEST_F(CliFormFactors, TableAndSparseMatrix) {
  ASSERT_EQ(run(squares() + " --csv " + file("f.csv") + " --npz " + file("f.npz")), 0)
      << err();
  const std::string csv = file_contents(file("f.csv"));
  EXPECT_TRUE(csv.starts_with("from,to,factor\nfloor,ceiling,0.0995062945989")) << csv;
  const std::string npz = file_contents(file("f.npz"));
  EXPECT_TRUE(npz.starts_with("PK\x03\x04"));
  for (const char* name :
       {"data.npy", "indices.npy", "indptr.npy", "shape.npy", "format.npy", "areas.npy",
        "names.npy", "others.npy", "outside.npy", "backs.npy"}) {
    EXPECT_NE(npz.find(name), std::string::npos) << name;
  }
  EXPECT_NE(out().find("3 surfaces"), std::string::npos) << out();
}

TEST_F(CliFormFactors, FromPoints) {
  const std::string points = file("p.txt", "0.5,0.5,0,0,0,1\n0.5 0.5 1 0 0 -2\n");
  const json j =
      answer(squares() + " --without pane --at " + points + " --csv " + file("p.csv"));
  ASSERT_EQ(j.at("points").size(), 2U);
  const json& p = j.at("points")[0];
  EXPECT_EQ(p.at("factors").size(), 2U);
  EXPECT_NEAR(p.at("factors")[1], 0.239456470461, 1e-12);
  EXPECT_NEAR(p.at("outside"), 1 - 0.239456470461, 1e-12);
  EXPECT_EQ(p.at("others"), 0);
  EXPECT_TRUE(file_contents(file("p.csv"))
                  .starts_with("point,floor,ceiling,others,outside,backs\n0,"));
}

TEST_F(CliFormFactors, Enforced) {
  const json j = answer(squares() + " --enforce");
  EXPECT_LE(j.at("enforced").at("moved").get<double>(), 1e-9);
  EXPECT_NEAR(j.at("enforced").at("matrix")[0][1], 0.099506294598985, 1e-9);
}

TEST_F(CliFormFactors, ABudgetThatEnds) {
  EXPECT_EQ(run(kRoom + " --each face --budget 0.05 --json " + file("a.json")), 3);
  if (fs::exists(file("a.json"))) {
    const json j = json::parse(file_contents(file("a.json")));
    EXPECT_EQ(j.at("complete"), false);
    EXPECT_TRUE(j.at("matrix").back().is_null());
  }
}

TEST_F(CliFormFactors, ByLines) {
  const json j = answer(squares() + " --lines 200000 --seed 3 --up 0,0,1 --csv " +
                        file("l.csv") + " --npz " + file("l.npz"));
  EXPECT_EQ(j.at("method"), "lines");
  EXPECT_EQ(j.at("lines"), 200000);
  EXPECT_EQ(j.at("seed"), 3);
  EXPECT_FALSE(j.contains("error_bound"));
  const double error = j.at("standard_errors").at("matrix")[0][1];
  EXPECT_GT(error, 1e-4);
  EXPECT_LT(error, 3e-3);
  EXPECT_NEAR(j.at("matrix")[0][1], 0.099506294598985, 5 * error);
  EXPECT_EQ(j.at("sky")[0], j.at("outside")[0]);
  EXPECT_EQ(j.at("sky")[1], 0);
  EXPECT_GT(j.at("standard_errors").at("sky")[0], 0);
  EXPECT_TRUE(
      file_contents(file("l.csv")).starts_with("from,to,factor,standard_error\nfloor,"));
  EXPECT_NE(file_contents(file("l.npz")).find("standard_errors.npy"), std::string::npos);
  ASSERT_EQ(run(squares() + " --lines 1000"), 0) << err();
  EXPECT_NE(out().find("estimated by 1000 lines"), std::string::npos) << out();
}

TEST_F(CliFormFactors, RefusesLinesWithWhatIsBounded) {
  const std::string points = file("p.txt", "0.5,0.5,0,0,0,1\n");
  for (const std::string& with :
       {std::string("--accuracy 1e-6"), std::string("--enforce"), "--at " + points}) {
    expect_refused(squares() + " --lines 100 " + with, "--lines");
  }
  expect_refused(squares() + " --lines 1", "--lines");
  expect_refused(squares() + " --seed 1", "--seed");
}

TEST_F(CliFormFactors, RefusesWhatCannotBe) {
  expect_refused(squares() + " --groups flor", "flor");
  expect_refused(squares() + " --accuracy 0", "--accuracy");
  expect_refused(squares() + " --each polygon", "--each");
  expect_refused(squares() + " --up 0,0,0", "--up");
  expect_refused(squares() + " --npz -", "--npz");
  expect_refused(squares() + " --both-sides nobody", "nobody");
  const std::string points = file("p.txt", "0.5,0.5,0\n");
  expect_refused(squares() + " --at " + points, "normal");
  expect_refused(squares() + " --at " + points + " --enforce", "--enforce");
}

TEST_F(CliFormFactors, HelpTeaches) {
  ASSERT_EQ(run("--help"), 0);
  for (const char* word :
       {"--groups", "--accuracy", "--both-sides", "--enforce", "--npz", "--lines",
        "sky view factor", "docs/form_factors.md", "Examples:"}) {
    EXPECT_NE(out().find(word), std::string::npos) << word;
  }
}

}  // namespace
