// `sightline look` as scripts meet it: views in order, files, refusals.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kCube = std::string(SIGHTLINE_TEST_DATA) + "/formats/cube.obj";

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class CliLook : public testing::Test {
 protected:
  CliLook() {
    std::string pattern = (fs::temp_directory_path() / "sightline-test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    fs::create_directory(folder_ / "io");
  }
  ~CliLook() override { fs::remove_all(folder_); }

  /// The exit status of `sightline look` with these words of the shell as arguments.
  int look(const std::string& arguments) {
    const std::string command = std::string(SIGHTLINE_PROGRAM) + " look " + arguments +
                                " >" + (folder_ / "io/out").string() + " 2>" +
                                (folder_ / "io/err").string();
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string out() const { return contents(folder_ / "io/out"); }
  [[nodiscard]] std::string err() const { return contents(folder_ / "io/err"); }

  json answer(const std::string& arguments) {
    EXPECT_EQ(look(arguments + " --json -"), 0) << err();
    return json::parse(out());
  }

  /// Bad usage or bad input: status 2, one line that mentions this, nothing written.
  void expect_refused(const std::string& arguments, const std::string& mentioned) {
    EXPECT_EQ(look(arguments + " --svg " + file("x.svg") + " --csv " + file("x.csv") +
                   " --vtk " + file("x") + " --json " + file("x.json")),
              2)
        << arguments;
    EXPECT_EQ(out(), "") << arguments;
    const std::string told = err();
    EXPECT_EQ(std::ranges::count(told, '\n'), 1) << arguments << ": " << told;
    EXPECT_NE(told.find(mentioned), std::string::npos) << arguments << ": " << told;
    for (const auto& entry : fs::directory_iterator(folder_ / "io")) {
      const std::string left = entry.path().filename();
      EXPECT_TRUE(left == "out" || left == "err" || left.ends_with("views.json"))
          << arguments << " left " << left;
    }
  }

  std::string file(const std::string& name) const { return (folder_ / "io" / name); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

  fs::path folder_;
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
  ASSERT_EQ(look(kCube + " --from 9,8,7"), 0) << err();
  EXPECT_NE(out().find("from 9,8,7, eye free"), std::string::npos) << out();
  ASSERT_EQ(look(kCube + " --from 9,8,7 --svg -"), 0) << err();
  EXPECT_TRUE(out().starts_with("<?xml"));
}

TEST_F(CliLook, RefusesWhatItCannotAnswerInOneLine) {
  expect_refused(kCube, "from where?");
  expect_refused(kCube + " --from 1,2", "--from '1,2'");
  expect_refused(kCube + " --from 1,2,3,4", "--from '1,2,3,4'");
  expect_refused(kCube + " --from 1,two,3", "--from '1,two,3'");
  expect_refused(kCube + " --from 1,,3", "--from '1,,3'");
  expect_refused(kCube + " --from 1,2,nan", "--from '1,2,nan'");
  expect_refused(kCube + " --from 1,2,3/0", "--from '1,2,3/0'");
  expect_refused(kCube + " --direction 0,0,0", "--direction '0,0,0'");
  expect_refused(kCube + " --direction 0,0/5,0", "--direction '0,0/5,0'");
  expect_refused(kCube + " --form 1,2,3", "--from");
  expect_refused(kCube + " --at " + file("none.json"), "none.json");
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
  EXPECT_EQ(look(kCube + " --from 9,8,7 --from 9,8,6 --svg -"), 2);
  EXPECT_EQ(out(), "");
}

TEST_F(CliLook, NumbersTheFilesOfSeveralViews) {
  ASSERT_EQ(look(kCube + " --from 9,8,7 --direction 1,2,3 --pixels 64 --svg " +
                 file("two.svg") + " --png " + file("two.png")),
            0)
      << err();
  for (const char* name : {"two0.svg", "two1.svg", "two0.png", "two1.png"}) {
    EXPECT_TRUE(fs::exists(file(name))) << name;
  }
  EXPECT_FALSE(fs::exists(file("two.svg")));
  ASSERT_EQ(look(kCube + " --from 9,8,7 --svg " + file("one.svg")), 0) << err();
  EXPECT_TRUE(fs::exists(file("one.svg")));
}

}  // namespace
