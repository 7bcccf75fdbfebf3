// The program run by a shell, in a folder of its own: with redirections, limits, pipes.

#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace sightline::test {

/// The bytes of a file; empty when there is none.
inline std::string file_contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A fixture with an empty folder, removed with it, in which commands run.
class Shell : public ::testing::Test {
 protected:
  Shell() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "sightline-test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    io_ = folder_.string() + "-io";
    std::filesystem::create_directories(io_);
  }
  ~Shell() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::remove_all(io_);
  }

  struct Run {
    int status;  ///< of the last command, 128 + number when a signal ended it
    std::string out, err;
  };

  /// Runs a command line of /bin/sh in the folder; $S is the program, $ROOM, $CORNELL the
  /// sample scenes, $DATA the test data.
  Run shell(const std::string& command) {
    const std::filesystem::path script = io_ / "script";
    std::ofstream(script) << "S='" SIGHTLINE_PROGRAM "'\nDATA='" SIGHTLINE_TEST_DATA
                             "'\nROOM='" SIGHTLINE_EXAMPLES
                             "/scenes/room.obj'\nCORNELL='" SIGHTLINE_EXAMPLES
                             "/scenes/cornell.obj'\nunset DISPLAY\ncd '"
                          << folder_.string() << "'\n"
                          << command << "\n";
    const std::string line = "/bin/sh '" + script.string() + "' >'" +
                             (io_ / "out").string() + "' 2>'" + (io_ / "err").string() +
                             "'";
    const int status = std::system(line.c_str());  // NOLINT(cert-env33-c)
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            file_contents(io_ / "out"), file_contents(io_ / "err")};
  }

  /// Expects this status, one line on standard error that has these words, and nothing on
  /// standard output.
  void expect_told(const std::string& command, int status, const std::string& words) {
    const Run r = shell(command);
    EXPECT_EQ(r.status, status) << command << "\n" << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << command << "\n"
                                                               << r.err;
    EXPECT_NE(r.err.find(words), std::string::npos) << command << "\n" << r.err;
    EXPECT_EQ(r.out, "") << command;
  }

  /// The names in the folder, hidden ones too.
  [[nodiscard]] std::set<std::string> names(const std::string& below = ".") const {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / below)) {
      found.insert(entry.path().filename().string());
    }
    return found;
  }

  std::filesystem::path folder_;
  std::filesystem::path io_;  ///< beside it: the program's own output
};

}  // namespace sightline::test
