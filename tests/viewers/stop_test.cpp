// Budgets and interrupts: whatever the program is doing, it ends within a second, says in
// one line what is written, and every file with a final name is whole.

#include "tests/support/generators.h"
#include "tests/viewers/stop_support.h"

namespace sightline {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Stop : public test::Stopping {
 protected:
  // One scene and one file of each kind of question for all tests: large enough that no
  // command is done in a tenth of a second.
  static void SetUpTestSuite() {
    std::string pattern = (fs::temp_directory_path() / "sightline-stop-XXXXXX").string();
    input_ = mkdtemp(pattern.data());
    testing::write_obj(input_ / "city.obj", testing::street_city(1, 30000));
    testing::Random random(1);
    const auto point = [&] {
      return json::array({random.uniform(), random.uniform(), random.uniform()});
    };
    json lines = json::array(), portals = json::array(), instances = json::array();
    for (int i = 0; i < 400; ++i) lines.push_back({point(), point()});
    for (int i = 0; i < 400; ++i) {
      portals.push_back({{0.01 * random.uniform(), 0, i},
                         {1, 0.01 * random.uniform(), i},
                         {random.uniform(0.9, 1), 1, i},
                         {0, random.uniform(0.9, 1), i}});
    }
    // Two triangles with a hundred between: many cells each.
    for (int i = 0; i < 40; ++i) {
      json occluders = json::array();
      for (int k = 0; k < 100; ++k) {
        json occluder = json::array();
        for (int c = 0; c < 3; ++c) {
          occluder.push_back({random.uniform(-0.3, 1.3), random.uniform(-0.3, 1.3),
                              random.uniform(0.2, 0.8)});
        }
        occluders.push_back(occluder);
      }
      instances.push_back({{"a", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                           {"b", {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}},
                           {"occluders", occluders}});
    }
    std::ofstream(input_ / "lines.json") << json{{"lines", lines}};
    std::ofstream(input_ / "portals.json") << json{{"portals", portals}};
    std::ofstream(input_ / "visible.json") << json{{"instances", instances}};
  }
  static void TearDownTestSuite() { fs::remove_all(input_); }

  // The commands that may take long, each with all kinds of files to write.
  [[nodiscard]] std::vector<Command> commands() const {
    const std::string city = input_ / "city.obj", out = folder_ / "out.json";
    const std::string vtk = folder_ / "vtk", saved = folder_ / "saved.json";
    return {
        {"info", city, "--json", out, "--vtk", vtk},
        {"skeleton", city, "--json", out, "--list", "-o", saved, "--vtk", vtk},
        {"skeleton", city, "--json", out, "--events", "polygon"},
        {"skeleton", city, "--json", out, "--seen-from", "building7"},
        {"look", city, "--from", "-100,-100,150", "--direction", "1,2,3", "--list",
         "--svg", folder_ / "out.svg", "--png", folder_ / "out.png", "--vtk", vtk,
         "--json", out},
        {"visible", city, "building0", "building9", "--all-pairs", "--json", out},
        {"visible", city, "building0", "building1", "--method", "sampled", "--rays",
         "1000000000", "--json", out},
        {"visible", input_ / "visible.json", "--check", "--json", out},
        {"visible", input_ / "visible.json", "--method", "sampled", "--rays",
         "1000000000", "--json", out},
        {"stab", input_ / "portals.json", "--list", "--vtk", vtk, "--json", out},
        {"stab", input_ / "portals.json", "--method", "conservative", "--json", out},
        {"analyse", city, "-o", folder_ / "report", "--json", out},
        {"analyse", city, "-o", folder_ / "report", "--from", "-100,-100,150", "--only",
         "look", "--json", out},
        {"view", city, "--png", folder_ / "out.png", "--size", "4000,4000"},
        {"transversals", input_ / "lines.json", "--list", "--vtk", vtk, "--json", out}};
  }

  static inline fs::path input_;
};

TEST_F(Stop, BudgetsHoldForEveryCommand) {
  testing::Random random(3);
  for (Command command : commands()) {
    const double budget = random.uniform(0.02, 0.5);
    command.insert(command.end(), {"--budget", std::to_string(budget)});
    const Run r = command[0] == "view" ? run(command) : run_answered(command);
    expect_clean(r, text_of(command), "budget");
    EXPECT_LT(r.seconds, budget + 1 + kSlack) << text_of(command);
  }
}

TEST_F(Stop, SignalsAreHeardAtAnyMoment) {
  testing::Random random(7);
  int sent = 0;
  for (const Command& command : commands()) {
    const double after = random.uniform(0.03, 0.5);
    const int signal = ++sent % 2 == 0 ? SIGINT : SIGTERM;
    const Run r = command[0] == "view" ? run(command, signal, after)
                                       : run_answered(command, signal, after);
    const std::string what = text_of(command) + "signal after " + std::to_string(after);
    expect_clean(r, what, "interrupted");
    EXPECT_LT(r.seconds, 1 + kSlack) << what;
  }
}

// Steps that take seconds each: a corner of the slab, thousands of whose neighbours have
// sides in its plane; four of 400 lines, a thousand million times.
TEST_F(Stop, LongStepsHearIt) {
  const std::string out = folder_ / "out.json";
  for (const Command& command :
       {Command{"skeleton", input_ / "city.obj", "--kinds", "EV", "--json", out,
                "--budget", "4"},
        Command{"transversals", input_ / "lines.json", "--json", out, "--budget", "2"}}) {
    const Run r = run_answered(command);
    expect_clean(r, text_of(command), "budget");
    EXPECT_EQ(r.status, 3) << text_of(command);
  }
}

TEST_F(Stop, ASecondSignalEndsAtOnce) {
  const pid_t pid = start({"skeleton", input_ / "city.obj"});
  await_hearing(pid);
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
