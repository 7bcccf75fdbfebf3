// Every option that takes numbers, of every command, with what people and scripts write
// for a number: one line and status 2, or an answer.  Never a signal, never silence.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <regex>
#include <vector>

#include "tests/support/shell.h"
#include "tests/viewers/sample_questions.h"

namespace {

using nlohmann::json;

/// What is written, and the number that it means; nullopt when it is none.
struct Written {
  const char* text;
  std::optional<double> number;
};

const std::vector<Written> kWritten{{"nan", {}},
                                    {"-nan", {}},
                                    {"NaN(1)", {}},
                                    {"inf", {}},
                                    {"-inf", {}},
                                    {"Infinity", {}},
                                    {"1e999", {}},
                                    {"-1e999", {}},
                                    {"1e-400", {}},
                                    {"", {}},
                                    {" ", {}},
                                    {"words", {}},
                                    {"-", {}},
                                    {"+", {}},
                                    {".", {}},
                                    {"1e", {}},
                                    {"1,5", {}},
                                    {"1 2", {}},
                                    {" 1", {}},
                                    {"1 ", {}},
                                    {"0x10", {}},
                                    {"0x1p-3", {}},
                                    {"1_000", {}},
                                    {"+-1", {}},
                                    {"1.2.3", {}},
                                    {"-1", -1},
                                    {"-0.5", -0.5},
                                    {"-1e308", -1e308},
                                    {"0", 0},
                                    {"-0", -0.0},
                                    {"0.0", 0},
                                    {"4.9e-324", 4.9e-324},
                                    {"1e-300", 1e-300},
                                    {"0.25", 0.25},
                                    {"1", 1},
                                    {"+2", 2},
                                    {"3.", 3},
                                    {"1e308", 1e308},
                                    {"2147483648", 2147483648.0},
                                    {"99999999999999999999", 1e20}};

/// Which numbers an option takes.
struct Numbers {
  bool whole = false;
  double least = -std::numeric_limits<double>::max();
  bool least_too = true;
  double most = std::numeric_limits<double>::max();

  [[nodiscard]] bool take(const Written& w) const {
    if (!w.number) return false;
    // A whole number is digits alone.
    const std::string digits = w.text[0] == '+' ? w.text + 1 : w.text;
    if (whole && digits.find_first_not_of("0123456789") != std::string::npos) {
      return false;
    }
    return (*w.number > least || (least_too && *w.number == least)) && *w.number <= most;
  }
};

const Numbers kAboveZero{.least = 0, .least_too = false};
const Numbers kFromZero{.least = 0};
const Numbers kFinite{};
const Numbers kThreads{.whole = true, .least = 0, .most = 4096};
const Numbers kSeed{.whole = true, .least = 0, .most = 18446744073709551615.0};

struct NumberOption {
  std::string command, name;
  Numbers numbers;
  /// The option's value, with a '#' for the number that is tried.
  std::string value = "#";
  /// What it cannot do without.
  std::string with = "";
};

std::vector<NumberOption> number_options() {
  std::vector<NumberOption> all{
      {"skeleton", "--perturb", kFromZero},
      {"skeleton", "--seed", kSeed, "#", "--perturb 0.001"},
      {"skeleton", "--radius", kAboveZero, "#", "--near 1,1,1"},
      {"skeleton", "--feature-size", kFromZero},
      {"skeleton", "--budget-mb", kAboveZero},
      {"visible", "--rays", {.whole = true, .least = 1, .most = 1e6}},
      {"visible", "--seed", kSeed},
      {"visible", "--seam", kFromZero},
      {"stab", "--rungs", {.whole = true, .least = 2, .most = 1e6}},
      {"look", "--pixels", {.whole = true, .least = 16, .most = 16384}},
      {"look", "--fov", {.least = 0, .least_too = false, .most = 179}},
      {"formfactors", "--accuracy", {.least = 0, .least_too = false, .most = 0.1}}};
  for (const char* command : {"info", "look", "skeleton", "shadows", "formfactors",
                              "analyse", "transversals", "stab", "visible"}) {
    all.push_back({command, "--threads", kThreads});
    all.push_back({command, "--budget", kAboveZero});
  }
  all.push_back({"view", "--budget", kAboveZero});
  const std::string few = "--samples 8 ";
  all.push_back({"aspects", "--threads", kThreads, "#", few});
  all.push_back({"aspects", "--budget", kAboveZero, "#", few});
  all.push_back({"aspects", "--seed", kSeed, "#", few + "--sampling random"});
  const Numbers samples{.whole = true, .least = 1, .most = 1e8};
  all.push_back({"aspects", "--samples", samples, "#", "--budget 1"});
  const Numbers checks{.whole = true, .least = 0, .most = 1e8};
  all.push_back({"aspects", "--check", checks, "#", few + "--budget 1"});
  const std::string best = few + "--best 1 ";
  all.push_back({"viewpoints", "--threads", kThreads, "#", best});
  all.push_back({"viewpoints", "--budget", kAboveZero, "#", best});
  all.push_back({"viewpoints", "--seed", kSeed, "#", best});
  all.push_back({"viewpoints", "--samples", samples, "#", "--best 1 --budget 1"});
  const Numbers counts{.whole = true, .least = 1, .most = 1e5};
  all.push_back({"viewpoints", "--best", counts, "#", few});
  const Numbers shares{.least = 0, .least_too = false, .most = 1};
  all.push_back(
      {"viewpoints", "--fraction", shares, "#", few + "--cover parts --budget 1"});
  const Numbers lines{.whole = true, .least = 2, .most = 0x1p62};
  all.push_back({"formfactors", "--lines", lines, "#", "--budget 1"});
  all.push_back({"formfactors", "--seed", kSeed, "#", "--lines 1000"});
  all.push_back({"shadows", "--feature-size", kFromZero});
  const auto add = [&all](const std::string& command, const std::string& name,
                          const std::vector<std::string>& values,
                          const std::string& with = "", const Numbers& numbers = {}) {
    for (const std::string& v : values) {
      all.push_back({command, name, numbers, v, with});
    }
  };
  const std::vector<std::string> points{"#,1,1", "1,#,1", "1,1,#"};
  const std::vector<std::string> boxes{"#,-9,-9,9,9,9", "-9,-9,#,9,9,9", "-9,-9,-9,#,9,9",
                                       "-9,-9,-9,9,9,#"};
  add("skeleton", "--near", points, "--radius 3");
  add("skeleton", "--region", boxes);
  add("skeleton", "--between-boxes",
      {"'#,0,0,9,9,9' 0,0,0,9,9,9", "0,0,0,9,9,9 '0,0,0,9,#,9'"});
  add("skeleton", "--crossed", {"'#,1,1' 5,5,5", "5,5,5 '1,#,1'", "5,5,5 '1,1,#'"});
  add("analyse", "--region", boxes);
  for (const char* name : {"--from", "--direction", "--up", "--towards"}) {
    add("look", name, points);
  }
  for (const char* name : {"--from", "--direction"}) add("analyse", name, points);
  add("formfactors", "--up", points);
  const std::string eye = "--png out.png --eye 7,8,9 ", towards = "--towards 5,6,7 ";
  const std::string small = "--size 8x6 ";
  add("shadows", "--eye", points, "--png out.png " + towards + small);
  add("shadows", "--towards", points, eye + small);
  add("shadows", "--up", points, eye + towards + small);
  add("shadows", "--fov", {"#"}, eye + towards + small,
      {.least = 0, .least_too = false, .most = 179});
  add("shadows", "--size", {"#x6", "8x#"}, eye + towards,
      {.whole = true, .least = 1, .most = 16384});
  add("shadows", "--rays", {"#"}, eye + towards + "--size 2x1 ",
      {.whole = true, .least = 1, .most = 1e6});
  add("shadows", "--seed", {"#"}, eye + towards + small, kSeed);
  add("look", "--window", {"#,-2,2,2", "-2,#,2,2", "-2,-2,#,2", "-2,-2,2,#"});
  add("look", "--box", boxes);
  add("aspects", "--bounds", boxes, few);
  add("viewpoints", "--bounds", boxes, best);
  add("view", "--box", boxes);
  add("view", "--eye", points);
  add("view", "--look-at", points, "--eye 7,8,9");
  add("view", "--size", {"#,60", "60,#"}, "", {.whole = true, .least = 1, .most = 16384});
  return all;
}

class NumberOptions : public sightline::test::Shell {
 protected:
  NumberOptions() {
    sightline::test::write_questions(folder_);
    before_ = names();
  }

  [[nodiscard]] static std::string command_line(const NumberOption& option,
                                                const std::string& number) {
    static const std::map<std::string, std::string> kCommands{
        {"info", "info s.obj --json -"},
        {"look", "look s.obj --from 7,8,9 --svg out.svg --json -"},
        {"skeleton", "skeleton s.obj --kinds EV --json -"},
        {"shadows", "shadows s.obj --light b --receivers a --json -"},
        {"formfactors", "formfactors s.obj --json -"},
        {"analyse", "analyse s.obj --json - -o out"},
        {"aspects", "aspects s.obj --projection perspective --method sampled --json -"},
        {"viewpoints", "viewpoints s.obj --projection perspective --json -"},
        {"view", "view s.obj --png out.png"},
        {"transversals", "transversals t.json --json -"},
        {"stab", "stab p.json --json -"},
        {"visible", "visible s.obj a b --json -"}};
    std::string value = option.value;
    value.replace(value.find('#'), 1, number);
    // Two values are quoted in the table, one is here.
    if (option.value.find(' ') == std::string::npos) {
      value.insert(0, "'");
      value += "'";
    }
    std::string line = "$S " + kCommands.at(option.command) + " " + option.with + " ";
    if (option.command == "view" && option.name != "--size") line += "--size 60,60 ";
    return line + option.name + " " + value;
  }

  void expect_refused(const std::string& line, const Run& r) {
    EXPECT_EQ(r.status, 2) << line << "\n" << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << line << "\n" << r.err;
    EXPECT_EQ(r.out, "") << line;
    EXPECT_EQ(names(), before_) << line;
  }

  /// An answer, which may be a part; or a word on why this number does not fit the rest.
  void expect_answered_or_refused(const std::string& line, const Run& r) {
    if (r.status == 2) return expect_refused(line, r);
    EXPECT_TRUE(r.status == 0 || r.status == 3) << line << "\n" << r.status << r.err;
    EXPECT_LE(std::count(r.err.begin(), r.err.end(), '\n'), r.status == 3 ? 1 : 0)
        << line << "\n"
        << r.err;
    if (line.find("--json") == std::string::npos || r.out.empty()) return;
    const json answer = json::parse(r.out, nullptr, false);
    EXPECT_FALSE(answer.is_discarded()) << line;
    EXPECT_EQ(r.out.find("null,null"), std::string::npos) << line;
    if (answer.contains("complete")) {
      EXPECT_EQ(answer["complete"], r.status == 0) << line;
    }
  }

  std::set<std::string> before_;
};

// No option that takes numbers is left out of the table above.
TEST_F(NumberOptions, AreAllOfThem) {
  std::set<std::string> known;
  for (const NumberOption& option : number_options()) {
    known.insert(option.command + " " + option.name);
  }
  std::set<std::string> told;
  for (const char* command :
       {"info", "look", "skeleton", "shadows", "formfactors", "aspects", "analyse",
        "viewpoints", "view", "transversals", "stab", "visible"}) {
    const std::string help = shell("$S " + std::string(command) + " --help").out;
    const std::regex option(
        "\n +(?:-., ?)?(--[a-z-]+) (?:N|S|R|L|M|W|E|SIZE|WxH|INT\\S*|W,H|"
        "BOX|POINT|DEGREES|x,y,z|x0,y0,x1,y1|x0,y0,z0,x1,y1,z1|X,Y,Z)[ \n]");
    for (auto at = std::sregex_iterator(help.begin(), help.end(), option);
         at != std::sregex_iterator(); ++at) {
      told.insert(std::string(command) + " " + (*at)[1].str());
    }
  }
  EXPECT_EQ(told, known);
}

TEST_F(NumberOptions, TakeWhatIsANumberAndRefuseTheRestInOneLine) {
  const std::vector<NumberOption> options = number_options();
  std::mt19937 random(1);
  int refused = 0;
  // Each option in turn, with one of each kind of thing that is written.
  for (std::size_t i = 0; i < 2 * options.size(); ++i) {
    const NumberOption& option = options[i % options.size()];
    const Written& written = kWritten[random() % kWritten.size()];
    const bool takes = option.numbers.take(written);
    // A report with its pictures takes a second; it refuses as fast as all others.
    if (takes && option.command == "analyse" && i > options.size()) continue;
    const std::string line = command_line(option, written.text);
    const Run r = shell(line);
    if (takes) {
      expect_answered_or_refused(line, r);
    } else {
      expect_refused(line, r);
      ++refused;
    }
    shell("rm -rf out out.* out0.* out1.*");
  }
  EXPECT_GT(refused, 60);
}

// `--region 0,0,0,9,9,9 scene.obj --list` took the scene for a seventh number.
TEST_F(NumberOptions, LeaveTheFileBehindThemAlone) {
  std::vector<std::array<std::string, 2>> options;  // with what begins the command line
  for (const NumberOption& option : number_options()) {
    std::string value = option.value;
    value.replace(
        value.find('#'), 1,
        option.name == "--size" || option.name == "--pixels"         ? "60"
        : option.name == "--accuracy" || option.name == "--fraction" ? "0.1"
        : option.name == "--box" || option.name == "--window" || option.name == "--bounds"
            ? "0"
            : "2");
    options.push_back({option.command, option.with + " " + option.name + " " + value});
  }
  options.push_back({"skeleton", "--kinds EV"});
  options.push_back({"skeleton", "--kinds EV,FF"});
  options.push_back({"skeleton", "--between a b"});
  options.push_back({"skeleton", "--between-ends a outside"});
  options.push_back({"analyse", "--only skeleton"});
  options.push_back({"shadows", "--receivers a"});
  options.push_back({"shadows", "--both-sides b"});
  options.push_back({"formfactors", "--groups a"});
  const std::map<std::string, std::string> rest{
      {"info", "s.obj --json -"},
      {"skeleton", "s.obj --json -"},
      {"look", "s.obj --from 7,8,9"},
      {"analyse", "s.obj -o out"},
      {"aspects", "s.obj --projection perspective --method sampled"},
      {"viewpoints", "s.obj --projection perspective"},
      {"shadows", "s.obj --light b"},
      {"formfactors", "s.obj"},
      {"view", "s.obj --png out.png"},
      {"transversals", "t.json --list"},
      {"stab", "p.json --list"},
      {"visible", "s.obj a b --json -"}};
  for (const auto& [command, option] : options) {
    // A report takes a second.
    if (command == "analyse" && option != "--only skeleton") continue;
    const std::string line = "$S " + command + " " + option + " " + rest.at(command);
    const Run r = shell(line);
    EXPECT_TRUE(r.status == 0 || r.status == 3) << line << "\n" << r.err;
    shell("rm -rf out out.* out0.* out1.*");
  }
}

}  // namespace
