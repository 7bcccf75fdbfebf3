// Running the program until its budget ends or a signal is sent, and what must be true
// then: it ends within a second, with the right status and one line, and every file with
// a final name is whole.

#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace sightline::test {

/// A fixture with an empty folder for what the program writes, removed with it.
class Stopping : public ::testing::Test {
 protected:
  using Command = std::vector<std::string>;
  using Clock = std::chrono::steady_clock;
  /// Seconds that a loaded machine may add to the second that is promised.
  static constexpr double kSlack = 1.5;

  Stopping() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "sightline-stop-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Stopping() override { std::filesystem::remove_all(folder_); }

  struct Run {
    int status;      // -1: ended by a signal
    double seconds;  // since the signal was sent, or since the start
    std::string err;
  };

  [[nodiscard]] pid_t start(Command command) const {
    const std::string err = folder_ / "err";
    command.insert(command.begin(), SIGHTLINE_PROGRAM);
    std::vector<char*> argv;
    for (std::string& word : command) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t pid = fork();
    if (pid == 0) {
      dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
      dup2(open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
      unsetenv("DISPLAY");
      execv(SIGHTLINE_PROGRAM, argv.data());
      _exit(127);
    }
    return pid;
  }

  /// Waits until the program is far enough to hear signals: it blocks them for a thread
  /// of its own.
  static void await_hearing(pid_t pid) {
    const std::string name = "/proc/" + std::to_string(pid) + "/status";
    for (int tries = 0; tries < 5000; ++tries) {
      std::ifstream status(name);
      for (std::string word; status >> word;) {
        if (word != "SigBlk:") continue;
        unsigned long long blocked = 0;
        status >> std::hex >> blocked;
        if ((blocked >> (SIGINT - 1) & 1) != 0) return;
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  /// Until the end; with a signal that long after the program hears it.
  [[nodiscard]] Run run(const Command& command, int signal = 0, double after = 0) const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      std::filesystem::remove_all(entry);
    }
    auto since = Clock::now();
    const pid_t pid = start(command);
    if (signal != 0) {
      await_hearing(pid);
      std::this_thread::sleep_for(std::chrono::duration<double>(after));
      since = Clock::now();
      kill(pid, signal);
    }
    int status = 0;
    waitpid(pid, &status, 0);
    const std::chrono::duration<double> used = Clock::now() - since;
    std::ifstream err(folder_ / "err");
    std::ostringstream text;
    text << err.rdbuf();
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, used.count(), text.str()};
  }

  /// The status, the line and the files of a run that `reason` may have ended.
  void expect_clean(const Run& r, const std::string& what, const char* reason) const {
    SCOPED_TRACE(what + "\n" + r.err);
    EXPECT_TRUE(r.status == 0 || r.status == 3) << r.status;
    if (r.status == 3) {
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1);
      EXPECT_NE(r.err.find(reason), std::string::npos);
      EXPECT_NE(r.err.find("written"), std::string::npos);
    } else {
      EXPECT_EQ(r.err, "");
    }
    expect_whole_files(r.status == 0);
  }

  /// There was no question yet, or its answer is written, incomplete or not.
  [[nodiscard]] bool is_answered(const Run& r) const {
    static const std::set<std::string> kBefore{"reading",
                                               "vertices",
                                               "faces",
                                               "objects",
                                               "sides",
                                               "shells",
                                               "edges",
                                               "straight edges",
                                               "solids",
                                               "looking for defects",
                                               "planes",
                                               "corners' faces",
                                               "corners in solids",
                                               "edges' faces"};
    const std::string mark = "in stage: ";
    const std::size_t at = r.err.find(mark);
    if (r.status == 3 && at == std::string::npos) return true;  // before the first stage
    if (r.status == 3) {
      const std::size_t from = at + mark.size();
      if (kBefore.contains(r.err.substr(from, r.err.find(',', from) - from))) return true;
    }
    return std::filesystem::exists(folder_ / "out.json");
  }

  /// A run that is_answered(): it did not have to be ended from outside.  Tried three
  /// times, as a loaded machine may not let the program hand back what it has.
  [[nodiscard]] Run run_answered(const Command& command, int signal = 0,
                                 double after = 0) const {
    Run r{};
    for (int tries = 0; tries < 3; ++tries) {
      r = run(command, signal, after);
      if (is_answered(r)) return r;
    }
    ADD_FAILURE() << "no answer: " << text_of(command) << '\n' << r.err;
    return r;
  }

  [[nodiscard]] static std::string text_of(const Command& command) {
    std::string text;
    for (const std::string& word : command) text += word + " ";
    return text;
  }

  std::filesystem::path folder_;

 private:
  void expect_whole_files(bool complete) const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().filename();
      EXPECT_NE(name[0], '.') << "left " << entry.path();
      if (entry.path().extension() != ".json") continue;
      std::ifstream file(entry.path());
      const auto j = nlohmann::json::parse(file, nullptr, false);
      EXPECT_FALSE(j.is_discarded()) << entry.path() << " is no JSON";
      if (!j.is_object() || !j.contains("complete")) continue;
      // A part that was finished may be whole in an answer that is not.
      if (entry.path().filename() == "out.json") {
        EXPECT_EQ(j.at("complete").get<bool>(), complete) << entry.path();
      }
    }
  }
};

}  // namespace sightline::test
