// Budgets and interrupts: whatever the program is doing, it ends within a second, says in
// one line what is written, and every file with a final name is whole.

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
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/generators.h"

namespace sightline {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

// What a loaded machine may add to the second that is promised.
constexpr double kSlack = 1.5;

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_obj(const fs::path& file, const PolygonSoup& soup) {
  std::ofstream out(file);
  out.precision(17);
  for (const Point& p : soup.vertices) {
    out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  for (const PolygonSoup::Group& group : soup.groups) {
    out << "o " << group.name << '\n';
    for (const int f : group.faces) {
      out << 'f';
      for (const int v : soup.polygons[f]) out << ' ' << v + 1;
      out << '\n';
    }
  }
}

class Stop : public ::testing::Test {
 protected:
  // One scene and one set of lines for all tests: large enough that no command is done in
  // a tenth of a second.
  static void SetUpTestSuite() {
    std::string pattern = (fs::temp_directory_path() / "sightline-stop-XXXXXX").string();
    input_ = mkdtemp(pattern.data());
    write_obj(input_ / "city.obj", testing::street_city(1, 30000));
    testing::Random random(1);
    json lines = json::array();
    json portals = json::array();
    const auto point = [&] {
      return json::array({random.uniform(), random.uniform(), random.uniform()});
    };
    for (int i = 0; i < 400; ++i) lines.push_back({point(), point()});
    for (int i = 0; i < 400; ++i) {
      const double z = i;
      portals.push_back({{0.01 * random.uniform(), 0, z},
                         {1, 0.01 * random.uniform(), z},
                         {random.uniform(0.9, 1), 1, z},
                         {0, random.uniform(0.9, 1), z}});
    }
    std::ofstream(input_ / "lines.json") << json{{"lines", lines}};
    std::ofstream(input_ / "portals.json") << json{{"portals", portals}};
  }
  static void TearDownTestSuite() { fs::remove_all(input_); }

  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "sightline-stop-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }

  struct Run {
    int status;  // -1: ended by a signal
    double seconds;
    std::string err;
  };

  // The commands that may take long, each with all kinds of files to write.
  [[nodiscard]] std::vector<std::vector<std::string>> commands() const {
    const std::string city = input_ / "city.obj", out = folder_ / "out.json";
    const std::string vtk = folder_ / "vtk", saved = folder_ / "saved.json";
    return {{"info", city, "--json", out, "--vtk", vtk},
            {"skeleton", city, "--json", out, "--list", "-o", saved, "--vtk", vtk},
            {"skeleton", city, "--json", out, "--events", "polygon"},
            {"visible", city, "box0", "box1", "--all-pairs", "--json", out},
            {"visible", city, "box0", "box1", "--method", "sampled", "--rays",
             "1000000000", "--json", out},
            {"analyse", city, "-o", folder_ / "report", "--json", out},
            {"view", city, "--png", folder_ / "out.png", "--size", "4000,4000"},
            {"transversals", input_ / "lines.json", "--json", out}};
  }

  pid_t start(std::vector<std::string> arguments) {
    const std::string err = folder_ / "err";
    arguments.insert(arguments.begin(), SIGHTLINE_PROGRAM);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
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

  // Runs until the end, or until a signal is sent after so many seconds.
  Run run(const std::vector<std::string>& arguments, int signal = 0, double after = 0) {
    for (const auto& entry : fs::directory_iterator(folder_)) fs::remove_all(entry);
    const auto begun = Clock::now();
    const pid_t pid = start(arguments);
    auto since = begun;
    if (signal != 0) {
      std::this_thread::sleep_for(std::chrono::duration<double>(after));
      since = Clock::now();
      kill(pid, signal);
    }
    int status = 0;
    waitpid(pid, &status, 0);
    const std::chrono::duration<double> used = Clock::now() - since;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, used.count(),
            contents(folder_ / "err")};
  }

  // One line, the right status, whole files, nothing left under other names.
  void expect_clean(const Run& r, const std::string& what, const char* reason) {
    SCOPED_TRACE(what + "\n" + r.err);
    EXPECT_TRUE(r.status == 0 || r.status == 3) << r.status;
    if (r.status == 3) {
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1);
      EXPECT_NE(r.err.find(reason), std::string::npos);
      EXPECT_NE(r.err.find("written"), std::string::npos);
    } else {
      EXPECT_EQ(r.err, "");
    }
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().filename();
      EXPECT_NE(name[0], '.') << "left " << entry.path();
      if (entry.path().extension() != ".json") continue;
      const json j = json::parse(contents(entry.path()), nullptr, false);
      EXPECT_FALSE(j.is_discarded()) << entry.path() << " is no JSON";
      if (!j.is_object() || !j.contains("complete")) continue;
      EXPECT_EQ(j.at("complete").get<bool>(), r.status == 0) << entry.path();
    }
  }

  static std::string text_of(const std::vector<std::string>& arguments) {
    std::string text;
    for (const std::string& a : arguments) text += a + " ";
    return text;
  }

  static inline fs::path input_;
  fs::path folder_;
};

TEST_F(Stop, BudgetsHoldForEveryCommand) {
  for (const auto& command : commands()) {
    for (const char* budget : {"0.1", "1"}) {
      auto arguments = command;
      arguments.insert(arguments.end(), {"--budget", budget});
      const Run r = run(arguments);
      expect_clean(r, text_of(arguments), "budget");
      EXPECT_LT(r.seconds, std::stod(budget) + 1 + kSlack) << text_of(arguments);
    }
  }
}

TEST_F(Stop, SignalsAreHeardAtAnyMoment) {
  testing::Random random(7);
  for (const auto& command : commands()) {
    for (const int signal : {SIGINT, SIGTERM}) {
      const double after = random.uniform(0.03, 1.2);
      const Run r = run(command, signal, after);
      const std::string what = text_of(command) + "signal after " + std::to_string(after);
      expect_clean(r, what, "interrupted");
      EXPECT_LT(r.seconds, 1 + kSlack) << what;
    }
  }
}

TEST_F(Stop, ASecondSignalEndsAtOnce) {
  const pid_t pid = start({"skeleton", input_ / "city.obj"});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(pid, SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  kill(pid, SIGINT);
  int status = 0;
  waitpid(pid, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

// Without a scene there is nothing to answer: one line, and no file.
TEST_F(Stop, NothingIsWrittenWhenReadingIsStopped) {
  {
    std::string lines;
    for (int i = 0; i < 100000; ++i) lines += "v 0.125 0.25 0.5\n";
    std::ofstream out(input_ / "long.obj");
    for (int i = 0; i < 80; ++i) out << lines;
  }
  const Run r = run({"skeleton", input_ / "long.obj", "--json", folder_ / "out.json",
                     "--budget", "0.05"});
  EXPECT_EQ(r.status, 3);
  EXPECT_NE(r.err.find("nothing is written"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("reading"), std::string::npos) << r.err;
  EXPECT_FALSE(fs::exists(folder_ / "out.json"));
  EXPECT_LT(r.seconds, 1 + kSlack);
}

}  // namespace
}  // namespace sightline
