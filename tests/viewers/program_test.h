// One command of the program, and the files that it is given and writes.

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tests/support/shell.h"

namespace sightline::test {

class ProgramTest : public Shell {
 protected:
  explicit ProgramTest(std::string command) : command_(std::move(command)) {}

  /// The exit status of the command with these words of the shell as arguments.
  int run(const std::string& arguments) {
    last_ = shell("$S " + command_ + " " + arguments);
    return last_.status;
  }
  /// What the last run wrote on standard output, and on standard error.
  [[nodiscard]] const std::string& out() const { return last_.out; }
  [[nodiscard]] const std::string& err() const { return last_.err; }

  /// The JSON answer of a run that must succeed.
  nlohmann::json answer(const std::string& arguments) {
    EXPECT_EQ(run(arguments + " --json -"), 0) << err();
    return nlohmann::json::parse(out());
  }

  /// Bad usage or bad input: status 2, one line that mentions this, nothing written.
  void expect_refused(const std::string& arguments, const std::string& mentioned) {
    const std::set<std::string> before = names();
    expect_told("$S " + command_ + " " + arguments, 2, mentioned);
    EXPECT_EQ(names(), before) << arguments;
  }

  /// The path of a file in the folder; the second writes the text into it.
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / name).string();
  }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

 private:
  std::string command_;
  Run last_{};
};

}  // namespace sightline::test
