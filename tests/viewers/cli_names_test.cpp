// Names of groups and of files that are no UTF-8: every command answers, and its JSON is.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kDoors = std::string(SIGHTLINE_TEST_DATA) + "/readable/latin1.obj";

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A word of the shell, whatever its bytes but 0.
std::string word(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

class CliNames : public testing::Test {
 protected:
  CliNames() {
    std::string pattern = (fs::temp_directory_path() / "sightline-test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~CliNames() override { fs::remove_all(folder_); }

  /// The exit status of the program with these words of the shell as arguments.
  int run(const std::string& arguments) {
    const std::string command = std::string(SIGHTLINE_PROGRAM) + " " + arguments + " >" +
                                (folder_ / "out").string() + " 2>" +
                                (folder_ / "err").string();
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / name).string();
  }
  /// The answer on standard output; its parser refuses what is no UTF-8.
  [[nodiscard]] json answer() const { return json::parse(contents(folder_ / "out")); }

  fs::path folder_;
};

TEST_F(CliNames, EveryCommandAnswers) {
  ASSERT_EQ(run("info " + kDoors + " --json -"), 0) << contents(file("err"));
  EXPECT_EQ(answer()["groups"][0]["name"], "T\\xFCr");
  EXPECT_EQ(answer()["groups"][1]["name"], "W\\xE4nde");

  ASSERT_EQ(run("visible " + kDoors + " 'T\xFCr' 'W\xE4nde' --json -"), 0)
      << contents(file("err"));
  EXPECT_FALSE(answer().empty());

  ASSERT_EQ(run("skeleton " + kDoors + " --list --json -"), 0) << contents(file("err"));
  EXPECT_FALSE(answer().empty());

  const std::string saved = file("saved.json");
  ASSERT_EQ(run("skeleton " + kDoors + " -o " + saved), 0) << contents(file("err"));
  EXPECT_FALSE(json::parse(contents(saved)).empty());

  ASSERT_EQ(run("analyse " + kDoors + " -o " + file("all")), 0) << contents(file("err"));
  EXPECT_FALSE(json::parse(contents(file("all/report.json"))).empty());
  EXPECT_NE(contents(file("all/index.html")).find("T\\xFCr"), std::string::npos);
}

TEST_F(CliNames, FileNamesToo) {
  const std::string scene = file("T\xFCr.obj"), saved = file("saved.json");
  fs::copy_file(kDoors, scene);
  ASSERT_EQ(run("info " + word(scene) + " --json -"), 0) << contents(file("err"));
  EXPECT_EQ(answer()["scene"]["file"], file("T\\xFCr.obj"));
  // A saved skeleton finds its scene again.
  ASSERT_EQ(run("skeleton " + word(scene) + " -o " + saved), 0) << contents(file("err"));
  ASSERT_EQ(run("view " + saved + " --size 64 48 --png " + file("a.png")), 0)
      << contents(file("err"));
}

// Objects of random names: as many different names in the answer as in the file, and each
// can be asked for with the bytes of the file.
TEST_F(CliNames, DifferentNamesStayDifferent) {
  std::mt19937 random(1);
  std::set<std::string> names;
  while (names.size() < 100) {
    std::string name;
    for (std::size_t n = 1 + random() % 3; n > 0; --n) {
      const std::array pieces{"\xFC",   "\xFD",     "\\xFC", "\\",
                              "x5CxFC", "\xC3\xBC", "#",     "a"};
      name += pieces[random() % pieces.size()];
    }
    if (!name.ends_with("\\")) names.insert(name);  // it would go on over the next line
  }
  std::ofstream scene(file("names.obj"), std::ios::binary);
  int vertex = 0;
  for (const std::string& name : names) {
    scene << "o " << name << "\nv 0 0 " << vertex << "\nv 1 0 " << vertex << "\nv 0 1 "
          << vertex << "\nf -1 -2 -3\n";
    vertex += 3;
  }
  scene.close();
  ASSERT_EQ(run("info " + file("names.obj") + " --json -"), 0) << contents(file("err"));
  std::set<std::string> told;
  const json found = answer();
  for (const json& group : found["groups"]) told.insert(group["name"].get<std::string>());
  EXPECT_EQ(told.size(), names.size());
  int n = 0;
  for (const std::string& name : names) {
    if (++n % 20 != 0) continue;
    EXPECT_EQ(run("visible " + file("names.obj") + " " + word(name) + " " +
                  word(*names.begin()) + " --json -"),
              0)
        << contents(file("err"));
  }
}

}  // namespace
