// One command of the program, run in a folder of its own.

#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>

namespace sightline::test {

/// The bytes of a file.
inline std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class ProgramTest : public testing::Test {
 protected:
  explicit ProgramTest(std::string command) : command_(std::move(command)) {
    namespace fs = std::filesystem;
    std::string pattern = (fs::temp_directory_path() / "sightline-test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    fs::create_directory(folder_ / "io");
  }
  ~ProgramTest() override { std::filesystem::remove_all(folder_); }

  /// The exit status of the command with these words of the shell as arguments; -1 where
  /// a signal ended it.
  int run(const std::string& arguments) {
    const std::string line = std::string(SIGHTLINE_PROGRAM) + " " + command_ + " " +
                             arguments + " >" + file("out") + " 2>" + file("err");
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// What the last run wrote on standard output, and on standard error.
  [[nodiscard]] std::string out() const { return contents(file("out")); }
  [[nodiscard]] std::string err() const { return contents(file("err")); }

  /// The JSON answer of a run that must succeed.
  nlohmann::json answer(const std::string& arguments) {
    EXPECT_EQ(run(arguments + " --json -"), 0) << err();
    return nlohmann::json::parse(out());
  }

  /// Bad usage or bad input: status 2, one line that mentions this, nothing written.
  void expect_refused(const std::string& arguments, const std::string& mentioned) {
    const std::set<std::string> before = names();
    EXPECT_EQ(run(arguments), 2) << arguments;
    EXPECT_EQ(out(), "") << arguments;
    const std::string told = err();
    EXPECT_EQ(std::ranges::count(told, '\n'), 1) << arguments << ": " << told;
    EXPECT_NE(told.find(mentioned), std::string::npos) << arguments << ": " << told;
    EXPECT_EQ(names(), before) << arguments;
  }

  /// The path of a file in the folder; the second writes the text into it.
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / "io" / name).string();
  }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

  std::filesystem::path folder_;

 private:
  /// What lies in the folder of files, but for what run() itself writes.
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "io"))
      found.insert(entry.path().filename());
    found.erase("out");
    found.erase("err");
    return found;
  }

  std::string command_;
};

}  // namespace sightline::test
