// The program as scripts meet it: exit statuses, JSON keys, files whole or not at all.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "viewers/picture.h"
#include "viewers/vtk_export.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kRoom = std::string(SIGHTLINE_EXAMPLES) + "/scenes/room.obj";
const std::string kCornell = std::string(SIGHTLINE_EXAMPLES) + "/scenes/cornell.obj";

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// An empty folder for one test, removed with it.
class Cli : public testing::Test {
 protected:
  Cli() {
    std::string pattern = (fs::temp_directory_path() / "sightline-test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Cli() override { fs::remove_all(folder_); }

  struct Run {
    int status;
    std::string out, err;
  };

  /// Starts the program with its output in files of the folder `io`.
  pid_t start(std::vector<std::string> arguments) {
    fs::create_directories(folder_ / "io");
    const std::string out = (folder_ / "io/out").string();
    const std::string err = (folder_ / "io/err").string();
    arguments.insert(arguments.begin(), SIGHTLINE_PROGRAM);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    const pid_t pid = fork();
    if (pid == 0) {
      dup2(open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDOUT_FILENO);
      dup2(open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
      unsetenv("DISPLAY");
      execv(SIGHTLINE_PROGRAM, argv.data());
      _exit(127);
    }
    return pid;
  }

  Run finish(pid_t pid) {
    int status = 0;
    waitpid(pid, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder_ / "io/out"),
            contents(folder_ / "io/err")};
  }

  Run run(const std::vector<std::string>& arguments) { return finish(start(arguments)); }

  /// Runs and expects success and a JSON answer alone on standard output.
  json answer(std::vector<std::string> arguments, int status = 0) {
    arguments.insert(arguments.end(), {"--json", "-"});
    const Run r = run(arguments);
    EXPECT_EQ(r.status, status) << r.err;
    // A budget in seconds that ended is told in one line.
    EXPECT_LE(std::count(r.err.begin(), r.err.end(), '\n'), status == 3 ? 1 : 0);
    return json::parse(r.out);
  }

  /// Bad usage or bad input: status 2, one line, nothing written.
  void expect_refused(const std::vector<std::string>& arguments,
                      const std::string& mentioned = "") {
    const Run r = run(arguments);
    std::string shown;
    for (const std::string& a : arguments) shown += a + " ";
    EXPECT_EQ(r.status, 2) << shown << r.err;
    EXPECT_EQ(r.out, "") << shown;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << shown << r.err;
    EXPECT_NE(r.err.find(mentioned), std::string::npos) << shown << r.err;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      EXPECT_EQ(entry.path().filename(), "io") << shown << "left " << entry.path();
    }
  }

  fs::path folder_;
};

void expect_common_keys(const json& j, const std::string& command) {
  EXPECT_EQ(j.at("command"), command);
  EXPECT_TRUE(j.at("version").is_string());
  EXPECT_GT(j.at("scene").at("faces"), 0);
  EXPECT_TRUE(j.at("complete").is_boolean());
  EXPECT_GE(j.at("seconds"), 0.0);
  EXPECT_GT(j.at("peak_memory_bytes"), 1000000);
  for (const char* stage : {"double", "interval", "exact"}) {
    EXPECT_TRUE(j.at("predicates").at(stage).is_number_unsigned());
  }
}

TEST_F(Cli, InfoOfTheRoom) {
  const json j = answer({"info", kRoom});
  expect_common_keys(j, "info");
  EXPECT_EQ(j.at("vertices"), 190);
  EXPECT_EQ(j.at("faces"), 146);
  EXPECT_EQ(j.at("solids"), 24);
  EXPECT_EQ(j.at("edges"), json::parse(R"({"convex":288,"reflex":0,"flat":0,)"
                                       R"("boundary":0,"nonmanifold":0})"));
  EXPECT_EQ(j.at("groups").size(), 24U);
  EXPECT_EQ(j.at("groups")[0], json::parse(R"({"name":"floor","faces":6})"));
  EXPECT_EQ(j.at("bounds"), json::parse("[[-0.25,-0.25,-0.25],[6.25,3.0,4.75]]"));
  EXPECT_TRUE(j.at("defects").empty());
}

TEST_F(Cli, InfoCountsAreThoseOfTheFile) {
  const std::string data = std::string(SIGHTLINE_TEST_DATA) + "/formats/";
  for (const char* file : {"cube.obj", "cube.off", "cube_ascii.ply"}) {
    const json j = answer({"info", data + file});
    EXPECT_EQ(j.at("vertices"), 8) << file;
    EXPECT_EQ(j.at("faces"), 6) << file;
    EXPECT_EQ(j.at("edges").at("convex"), 12) << file;
    EXPECT_EQ(j.at("solids"), 1) << file;
  }
  const json stl = answer({"info", data + "cube_binary.stl"});
  EXPECT_EQ(stl.at("vertices"), 8);
  EXPECT_EQ(stl.at("faces"), 12);
  EXPECT_EQ(stl.at("edges").at("flat"), 6);
}

TEST_F(Cli, InfoReportsDefectsWithIds) {
  for (const auto& file :
       fs::directory_iterator(std::string(SIGHTLINE_TEST_DATA) + "/defects")) {
    const json j = answer({"info", file.path().string()});
    for (const json& defect : j.at("defects")) {
      EXPECT_TRUE(defect.at("kind").is_string());
      EXPECT_TRUE(defect.contains("faces") || defect.contains("vertices")) << defect;
      EXPECT_TRUE(defect.at("message").is_string());
    }
  }
}

TEST_F(Cli, InfoListsSomeDefectsOfAKindAndCountsAll) {
  const std::string file = (folder_ / "copies.obj").string();
  {
    std::ofstream out(file);
    out << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 2500; ++i) out << "f 1 2 3\n";
  }
  const json j = answer({"info", file});
  EXPECT_EQ(j.at("defect_limit"), 1000);
  EXPECT_EQ(j.at("defect_counts"), json::parse(R"({"duplicate face": 2499})"));
  EXPECT_EQ(j.at("defects").size(), 1000U);
  EXPECT_TRUE(answer({"info", kRoom}).at("defect_counts").empty());
}

TEST_F(Cli, MalformedFilesAreRefusedInOneLine) {
  for (const auto& file :
       fs::directory_iterator(std::string(SIGHTLINE_TEST_DATA) + "/malformed")) {
    expect_refused(
        {"info", file.path().string(), "--json", (folder_ / "answer.json").string(),
         "--vtk", (folder_ / "vtk").string()},
        file.path().filename().string());
  }
  const std::string bad = std::string(SIGHTLINE_TEST_DATA) + "/malformed/nan.obj";
  expect_refused({"analyse", bad, "-o", (folder_ / "report").string()}, "nan.obj");
  expect_refused({"skeleton", bad, "-o", (folder_ / "skeleton.json").string()});
  expect_refused({"view", bad, "--png", (folder_ / "picture.png").string()});
}

TEST_F(Cli, BadUsageIsRefusedInOneLine) {
  expect_refused({});
  expect_refused({"guess"});
  expect_refused({"info"});
  expect_refused({"info", "no_such_file.obj"}, "no_such_file.obj");
  expect_refused({"info", kRoom, "--threads", "-3"}, "--threads");
  expect_refused({"info", kRoom, "--precision", "float"}, "--precision");
  expect_refused({"skeleton", kRoom, "--events", "planar"}, "planar");
  expect_refused({"skeleton", kRoom, "--kinds", "EV,VV"},
                 "'VV' is not available in this version; available: EV, EEE");
  expect_refused({"skeleton", kRoom, "--between", "crate", "nothing"}, "nothing");
  expect_refused({"skeleton", kRoom, "--through", "#100-200"}, "#100-200");
  expect_refused({"skeleton", kRoom, "--region", "0,0,0,1,1"}, "--region");
  expect_refused({"skeleton", kRoom, "--region", "1,0,0,0,1,1"}, "--region");
  expect_refused({"skeleton", kRoom, "--budget", "-1"}, "--budget");
  expect_refused({"skeleton", kRoom, "--crossed", "1,1,1", "2,2"}, "2,2");
  expect_refused({"skeleton", kRoom, "--crossed", "1,1,1", "2,2,2x"}, "2,2,2x");
  expect_refused({"skeleton", kRoom, "--seen-from", "nothing"}, "nothing");
  expect_refused({"skeleton", kRoom, "--saved", "none.json"}, "none.json");
  expect_refused({"skeleton", kRoom, "--budget-mb", "0"}, "--budget-mb");
  expect_refused({"skeleton", kRoom, "--near", "1,2,3"}, "--radius");
  expect_refused({"skeleton", kRoom, "--between-boxes", "0,0,0,1,1,1", "1,2"}, "1,2");
  expect_refused({"skeleton", kRoom, "--feature-size", "-1"}, "--feature-size");
  expect_refused({"skeleton", kRoom, "--perturb", "-1"}, "--perturb");
  expect_refused({"skeleton", kRoom, "--perturb", "1e-30"}, "perturb");
  expect_refused({"analyse", kRoom, "--only", "shadows"}, "shadows");
  expect_refused({"view", kRoom}, "--png");
  expect_refused({"info", kRoom, "--json", (folder_ / "none/answer.json").string()},
                 "none/answer.json");
}

TEST_F(Cli, HelpNamesEveryOption) {
  const Run r = run({"skeleton", "--help"});
  EXPECT_EQ(r.status, 0);
  for (const char* option :
       {"--events",       "--kinds",   "--between",       "--through",      "--region",
        "--near",         "--radius",  "--between-boxes", "--feature-size", "--budget",
        "--budget-mb",    "--list",    "--output",        "--saved",        "--seen-from",
        "--between-ends", "--crossed", "--json",          "--vtk",          "--threads",
        "--precision",    "--light"}) {
    EXPECT_NE(r.out.find(option), std::string::npos) << option;
  }
  EXPECT_EQ(run({"--version"}).status, 0);
}

TEST_F(Cli, EventsOfALight) {
  const json j = answer({"skeleton", kCornell, "--light", "light", "--list"});
  expect_common_keys(j, "skeleton");
  EXPECT_TRUE(j.at("complete"));
  const json& arcs = j.at("arc_list");
  ASSERT_GT(arcs.size(), 100U);
  std::set<std::string> kinds;
  std::size_t pieces = 0;
  for (const json& arc : arcs) {
    kinds.insert(arc.at("kind"));
    pieces += arc.at("pieces").size();
    if (arc.at("curved")) {
      EXPECT_EQ(arc.at("kind"), "EEE");
    }
    for (const json& piece : arc.at("pieces")) {
      EXPECT_LT(piece.at("ends")[0].at("at"), piece.at("ends")[1].at("at"));
    }
  }
  EXPECT_EQ(j.at("pieces"), pieces);
  EXPECT_EQ(kinds, (std::set<std::string>{"EE", "EEE", "EV", "face"}));
  EXPECT_EQ(j.at("outlines")[0].at("sides").size(), 4U);
  expect_refused({"skeleton", kCornell, "--light", "nothing"}, "nothing");
  expect_refused({"skeleton", kCornell, "--light", "light", "--kinds", "EV"}, "--light");
}

TEST_F(Cli, SkeletonCountsAndListAgree) {
  const json j =
      answer({"skeleton", kRoom, "--between", "lamp_shade", "tilted_box", "--list"});
  expect_common_keys(j, "skeleton");
  EXPECT_TRUE(j.at("complete"));
  const json& arcs = j.at("list").at("arcs");
  const json& nodes = j.at("list").at("nodes");
  ASSERT_GT(arcs.size(), 10U);
  int sum = 0;
  for (const auto& [kind, count] : j.at("arcs").items()) sum += count.get<int>();
  EXPECT_EQ(sum, static_cast<int>(arcs.size()));
  std::map<std::string, int> counted;
  for (const json& node : nodes) {
    if (!node.contains("end")) ++counted[node.at("kind")];
    EXPECT_EQ(node.at("line").size(), 2U);
    EXPECT_FALSE(node.at("generators").empty());
  }
  for (const auto& [kind, count] : counted) EXPECT_EQ(j.at("nodes").at(kind), count);
  int with_far_ends = 0;
  for (const json& arc : arcs) {
    const bool eee = arc.at("kind") == "EEE";
    const json& a = eee ? arc.at("edges")[0] : arc.at("vertex");
    const json& b = eee ? arc.at("edges")[2] : arc.at("edge");
    const std::string v = a.at("objects")[0], e = b.at("objects")[0];
    EXPECT_TRUE((v == "lamp_shade" && e == "tilted_box") ||
                (v == "tilted_box" && e == "lamp_shade"));
    EXPECT_LT(arc.at("range")[0], arc.at("range")[1]);
    for (const json& n : arc.at("nodes")) EXPECT_LT(n.get<std::size_t>(), nodes.size());
    if (arc.at("free_segment").is_null()) continue;
    ++with_far_ends;
    // Both outer generators are among the contacts, which are in order.
    double last = -1e300;
    std::set<double> at;
    for (const json& contact : arc.at("contacts")) {
      EXPECT_LE(last, contact.at("from"));
      last = contact.at("from");
      at.insert(last);
    }
    EXPECT_TRUE(at.contains(0) && at.contains(1));
    for (const json& end : arc.at("free_segment").at("ends")) {
      EXPECT_TRUE(end == "outside" || !end.at("faces").empty());
    }
  }
  EXPECT_EQ(with_far_ends, static_cast<int>(arcs.size()));
}

TEST_F(Cli, SkeletonKinds) {
  const json both = answer({"skeleton", kRoom});
  const json ev = answer({"skeleton", kRoom, "--kinds", "EV"});
  const json eee = answer({"skeleton", kRoom, "--kinds", "EEE"});
  EXPECT_EQ(both.at("options").at("kinds"), json::parse(R"(["EV","EEE","FF"])"));
  for (const json& j : {both, ev, eee}) {
    for (const char* kind : {"EV", "EEE", "EV_self", "EEE_self"}) {
      EXPECT_TRUE(j.at("arcs").at(kind).is_number_unsigned() ||
                  j.at("arcs").at(kind).is_number_integer());
    }
    EXPECT_EQ(j.at("arcs").size(), 4U);
    for (const char* kind : {"VV", "VEE", "EVE", "EEEE", "FvE", "FEE"}) {
      EXPECT_TRUE(j.at("nodes").at(kind).is_number_integer()) << kind;
      EXPECT_TRUE(j.at("nodes").at(std::string(kind) + "_self").is_number_integer());
      EXPECT_TRUE(j.at("nodes").at("end").at(kind).is_number_integer()) << kind;
    }
    EXPECT_TRUE(j.at("nodes").at("degenerate").is_number_integer());
  }
  for (const char* kind : {"EV", "EV_self"}) {
    EXPECT_EQ(both.at("arcs").at(kind), ev.at("arcs").at(kind));
    EXPECT_EQ(eee.at("arcs").at(kind), 0);
  }
  for (const char* kind : {"EEE", "EEE_self"}) {
    EXPECT_EQ(both.at("arcs").at(kind), eee.at("arcs").at(kind));
    EXPECT_EQ(ev.at("arcs").at(kind), 0);
  }
  EXPECT_GT(eee.at("arcs").at("EEE"), 100);
  EXPECT_GT(eee.at("nodes").at("EEEE"), 0);
  EXPECT_GT(eee.at("nodes").at("FEE"), 0);
  EXPECT_EQ(ev.at("nodes").at("EEEE"), 0);
  EXPECT_EQ(eee.at("nodes").at("VV"), 0);
  EXPECT_EQ(eee.at("vertices_asked"), 0);
  EXPECT_EQ(ev.at("edges_asked"), 0);
  EXPECT_EQ(eee.at("edges_done"), eee.at("edges_asked"));
}

TEST_F(Cli, ListOfSkeletonArcs) {
  const json j = answer({"skeleton", kCornell, "--kinds", "EEE", "--list"});
  const json& nodes = j.at("list").at("nodes");
  // A coordinate is a number, or "p/q" where no double is.
  const auto number = [](const json& x) {
    if (x.is_number()) return x.get<double>();
    const std::string text = x.get<std::string>();
    const std::size_t bar = text.find('/');
    EXPECT_NE(bar, std::string::npos) << text;
    return std::stod(text) / std::stod(text.substr(bar + 1));
  };
  const auto at = [&](const json& p) {
    return sightline::Point(number(p[0]), number(p[1]), number(p[2]));
  };
  int middle_touched = 0;
  ASSERT_EQ(j.at("list").at("arcs").size(), j.at("arcs").at("EEE"));
  for (const json& arc : j.at("list").at("arcs")) {
    EXPECT_EQ(arc.at("kind"), "EEE");
    ASSERT_EQ(arc.at("edges").size(), 3U);
    EXPECT_LT(arc.at("range")[0], arc.at("range")[1]);
    for (const json& n : arc.at("nodes")) EXPECT_LT(n.get<std::size_t>(), nodes.size());
    // The line's ends lie on the outer edges.
    for (const int k : {0, 1}) {
      const json& edge = arc.at("edges")[2 * k];
      const sightline::Point from = at(edge.at("from")), to = at(edge.at("to"));
      const sightline::Point x = at(arc.at("line")[k]);
      EXPECT_NEAR((x - from).norm() + (to - x).norm(), (to - from).norm(), 1e-9);
    }
    ASSERT_FALSE(arc.at("free_segment").is_null());
    ASSERT_FALSE(arc.at("pieces").empty());
    EXPECT_EQ(arc.at("pieces").front().at("range")[0], arc.at("range")[0]);
    EXPECT_EQ(arc.at("pieces").back().at("range")[1], arc.at("range")[1]);
    for (const json& contact : arc.at("contacts")) {
      const double from = contact.at("from");
      middle_touched += from > 0 && from < 1 ? 1 : 0;
    }
  }
  EXPECT_GE(middle_touched, static_cast<int>(j.at("list").at("arcs").size()) - 1);
  int eeee = 0;
  for (const json& node : nodes) {
    EXPECT_EQ(node.contains("second"), node.at("kind") == "EEEE");
    if (node.at("kind") == "EEEE") {
      ++eeee;
      EXPECT_EQ(node.at("generators").size(), 4U);
    }
    // Irrational lines too.
    EXPECT_TRUE(node.contains("contacts")) << node;
    // What has contacts has them where the first and last generator are.
    if (node.at("free_segment").is_null()) continue;
    for (const double position : {0.0, 1.0}) {
      EXPECT_TRUE(std::ranges::any_of(node.at("contacts"), [&](const json& contact) {
        return contact.at("from") <= position && contact.at("to") >= position;
      })) << node;
    }
    const json& first = node.at("generators")[0];
    // A degenerate line may go on beyond the arc that was found first.
    if (first.at("type") == "vertex" && node.at("kind") != "degenerate") {
      EXPECT_LT((at(first.at("at")) - at(node.at("line")[0])).norm(), 1e-9) << node;
    }
  }
  EXPECT_EQ(eeee, j.at("nodes").at("EEEE"));
}

TEST_F(Cli, ThroughIsTheUnionOfItsPairs) {
  const auto count = [&](const std::vector<std::string>& selection) {
    std::vector<std::string> arguments{"skeleton", kCornell};
    arguments.insert(arguments.end(), selection.begin(), selection.end());
    const json arcs = answer(arguments).at("arcs");
    return arcs.at("EV").get<int>() + arcs.at("EV_self").get<int>();
  };
  const int whole = count({});
  const int through = count({"--through", "tall_block"});
  EXPECT_GT(through, count({"--between", "tall_block", "short_block"}));
  EXPECT_LT(through, whole);
  EXPECT_EQ(count({"--region", "-1,-1,-1,100,100,100"}), whole);
}

TEST_F(Cli, SavedSkeletonCanBeViewed) {
  const fs::path saved = folder_ / "skeleton.json", png = folder_ / "picture.png";
  ASSERT_EQ(run({"skeleton", kCornell, "-o", saved.string()}).status, 0);
  ASSERT_EQ(
      run({"view", saved.string(), "--png", png.string(), "--size", "400,300"}).status,
      0);
  EXPECT_EQ(contents(png).substr(1, 3), "PNG");
  const json kept = json::parse(contents(saved));
  EXPECT_FALSE(kept.at("list").at("arcs").empty());
  EXPECT_EQ(kept.at("list").at("arcs").back().at("kind"), "EEE");
}

/// Pictures of `sightline view`, small ones.
class Pictures : public Cli {
 protected:
  std::string picture(const std::string& what, std::vector<std::string> options) {
    const fs::path png = folder_ / "picture.png";
    options.insert(options.begin(),
                   {"view", what, "--png", png.string(), "--size", "200,150"});
    const Run r = run(options);
    EXPECT_EQ(r.status, 0) << r.err;
    std::string bytes = contents(png);
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    fs::remove(png);
    return bytes;
  }

  void expect_view_refused(const std::string& what, std::vector<std::string> options,
                           const std::string& mentioned) {
    options.insert(options.begin(),
                   {"view", what, "--png", (folder_ / "picture.png").string()});
    expect_refused(options, mentioned);
  }

  /// A scene of unit cubes with these least corners.
  std::string cubes(const std::vector<std::array<int, 3>>& corners) {
    const fs::path path = folder_ / "io" / "cubes.obj";
    fs::create_directories(path.parent_path());
    std::ofstream stream(path);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      stream << "o cube" << k << "\n";
      for (int i = 0; i < 8; ++i) {
        stream << "v " << corners[k][0] + (i & 1) << " " << corners[k][1] + (i >> 1 & 1)
               << " " << corners[k][2] + (i >> 2) << "\n";
      }
      for (const auto& face : {std::array{0, 2, 3, 1},
                               {4, 5, 7, 6},
                               {0, 1, 5, 4},
                               {2, 6, 7, 3},
                               {0, 4, 6, 2},
                               {1, 3, 7, 5}}) {
        stream << "f";
        for (const int i : face) stream << " " << 8 * k + i + 1;
        stream << "\n";
      }
    }
    return path.string();
  }
};

TEST_F(Pictures, WhatIsOutsideOfTheBoxMakesNoDifference) {
  const std::vector<std::string> box{"--box", "-0.5,-0.5,-0.5,1.5,0.5,1.5"};
  const std::string one = picture(cubes({{0, 0, 0}}), box);
  EXPECT_EQ(picture(cubes({{0, 0, 0}, {3, 0, 0}, {0, 2, -4}}), box), one);
  // The cube is cut at y = 0.5, which shows.
  EXPECT_NE(picture(cubes({{0, 0, 0}}), {"--box", "-0.5,-0.5,-0.5,1.5,1.5,1.5"}), one);
}

TEST_F(Pictures, ArcsAreCutAtTheBoxNotDropped) {
  const std::string scene = cubes({{0, 0, 0}, {3, 0, 0}});
  const fs::path saved = folder_ / "io" / "skeleton.json";
  ASSERT_EQ(run({"skeleton", scene, "-o", saved.string()}).status, 0);
  // Between the cubes, where only lines from one to the other are.
  const std::string box = "1.5,0,0,2.5,1,1";
  expect_view_refused(scene, {"--box", box}, "--box");
  const std::string all = picture(saved.string(), {"--box", box});
  const std::string ev = picture(saved.string(), {"--box", box, "--kinds", "EV"});
  EXPECT_NE(all, ev);
  EXPECT_NE(ev, picture(saved.string(), {"--box", box, "--kinds", "VV"}));
  // Two cubes have no line through four edges of four objects.
  expect_view_refused(saved.string(), {"--box", box, "--kinds", "EEEE"},
                      "--box: nothing");
  // The same from the VTK files, which hold triangles and strokes.
  const fs::path vtk = folder_ / "io" / "vtk";
  ASSERT_EQ(run({"skeleton", scene, "--vtk", vtk.string()}).status, 0);
  EXPECT_NE(picture(vtk.string(), {"--box", box}), all);
  expect_view_refused(vtk.string(), {"--box", "1.5,2,0,2.5,3,1"}, "--box: nothing");
}

TEST_F(Pictures, FromTheChosenEye) {
  const std::string from_left = picture(kRoom, {"--eye", "-10,4,2"});
  EXPECT_EQ(picture(kRoom, {"--eye", "-10,4,2", "--look-at", "3,1.375,2.25"}), from_left);
  EXPECT_NE(picture(kRoom, {"--eye", "-10,4,2", "--look-at", "3,1,2.25"}), from_left);
  EXPECT_NE(picture(kRoom, {"--eye", "10,4,2"}), from_left);
  // Inside, straight from above, and on a wall.
  for (const char* eye : {"3,1.5,2", "3,20,2.25", "0,1,2"}) {
    EXPECT_NE(picture(kRoom, {"--eye", eye}), from_left);
  }
  EXPECT_NE(picture(kRoom, {"--eye", "3,1.5,2", "--box", "1,0,1,5,2,4"}), from_left);
}

TEST_F(Pictures, BadBoxesEyesAndKindsAreNamed) {
  expect_view_refused(kRoom, {"--box", "0,0,0,1,1"}, "--box");
  expect_view_refused(kRoom, {"--box", "1,0,0,0,1,1"}, "--box: the first corner");
  expect_view_refused(kRoom, {"--box", "0,0,0,1,1,inf"}, "is not a finite number");
  expect_view_refused(kRoom, {"--box", "0,0,0,1,nan,1"}, "is not a finite number");
  expect_view_refused(kRoom, {"--box", "0,0,0,1,0,1"}, "--box: has no extent");
  expect_view_refused(kRoom, {"--box", "50,50,50,60,60,60"},
                      "spans -0.25,-0.25,-0.25,6.25,3,4.75");
  expect_view_refused(kRoom, {"--eye", "1,2"}, "--eye");
  expect_view_refused(kRoom, {"--eye", "1,2,nan"}, "is not a finite number");
  expect_view_refused(kRoom, {"--eye", "1,2,3", "--look-at", "1,2,3"},
                      "--eye: is the same point as --look-at");
  expect_view_refused(kRoom, {"--eye", "1,2,3", "--look-at", "1,2,-inf"},
                      "is not a finite number");
  expect_view_refused(kRoom, {"--eye", "1e300,0,0"}, "--eye: is too far away");
  expect_view_refused(kRoom, {"--eye", "3,1.375,2.25"}, "say where to look with");
  expect_view_refused(kRoom, {"--look-at", "1,2,3"}, "--eye");
  expect_view_refused(kRoom, {"--kinds", "EV"}, "--kinds: only a saved skeleton");
  expect_refused({"view", kRoom, "--box", "0,0,0,1,1,1"}, "--png");
  expect_refused({"view", kRoom, "--eye", "0,0,9"}, "--png");
  const fs::path saved = folder_ / "io" / "skeleton.json";
  ASSERT_EQ(run({"skeleton", kCornell, "-o", saved.string()}).status, 0);
  expect_view_refused(saved.string(), {"--kinds", "EV,EVV"},
                      "--kinds: 'EVV' is none of EV, EEE");
}

TEST_F(Cli, QueriesOfASavedSkeletonAreThoseOfANewOne) {
  const fs::path saved = folder_ / "skeleton.json";
  ASSERT_EQ(run({"skeleton", kCornell, "-o", saved.string()}).status, 0);
  std::vector<std::string> question{
      "skeleton", kCornell,        "--seen-from",    "floor",      "--crossed",
      "5,20,5",   "50,25.25,40.5", "--between-ends", "tall_block", "outside"};
  const json fresh = answer(question);
  question.insert(question.end(), {"--saved", saved.string()});
  const json kept = answer(question);
  for (const char* key : {"seen_from", "between_ends", "crossed", "separating"}) {
    EXPECT_EQ(fresh.at(key), kept.at(key)) << key;
  }
  ASSERT_FALSE(fresh.at("crossed").empty());
  double last = 0;
  for (const json& event : fresh.at("crossed")) {
    EXPECT_GE(event.at("u"), last);
    last = event.at("u");
    EXPECT_EQ(event.contains("facet"), event.at("kind") == "F");
  }
  for (const json& arc : fresh.at("seen_from").at("list")) {
    EXPECT_TRUE(std::ranges::any_of(arc.at("pieces"), [](const json& piece) {
      return piece.at("ends")[0] == "floor" || piece.at("ends")[1] == "floor";
    })) << arc;
  }
}

TEST_F(Cli, BudgetGivesAPartialAnswer) {
  const json j = answer({"skeleton", kRoom, "--budget", "1e-6"}, 3);
  EXPECT_EQ(j.at("complete"), false);
  EXPECT_LT(j.at("vertices_done"), j.at("vertices_asked"));
  EXPECT_LT(j.at("edges_done"), j.at("edges_asked"));
}

TEST_F(Cli, SizeBudgetGivesTheSamePartialAnswer) {
  const json j = answer({"skeleton", kRoom, "--budget-mb", "0.05"}, 3);
  EXPECT_EQ(j.at("stopped_by"), "megabytes");
  EXPECT_EQ(j.at("missing").size(), 3U);
  EXPECT_GE(j.at("skeleton_bytes"), 52428);
  const json one =
      answer({"skeleton", kRoom, "--budget-mb", "0.05", "--threads", "1"}, 3);
  EXPECT_EQ(one.at("arcs"), j.at("arcs"));
  EXPECT_EQ(one.at("nodes"), j.at("nodes"));
}

TEST_F(Cli, FeatureSizeListsWhatItLeavesOut) {
  const json all = answer({"skeleton", kRoom, "--kinds", "EV"});
  EXPECT_EQ(all.at("simplified").at("edges"), 0);
  const json j =
      answer({"skeleton", kRoom, "--kinds", "EV", "--feature-size", "0.3", "--list"});
  EXPECT_LT(j.at("arcs").at("EV"), all.at("arcs").at("EV"));
  const json& s = j.at("simplified");
  EXPECT_GT(s.at("edges"), 0);
  EXPECT_EQ(s.at("edge_ids").size(), s.at("edges"));
  EXPECT_EQ(s.at("arc_list").size(), s.at("arcs"));
}

TEST_F(Cli, PartsNearAPointAndBetweenBoxes) {
  const json all = answer({"skeleton", kRoom});
  for (const std::vector<std::string>& part :
       {std::vector<std::string>{"--near", "3,3,1", "--radius", "2"},
        {"--between-boxes", "0,0,0,3,3,3", "3,0,0,6,6,3"}}) {
    std::vector<std::string> arguments{"skeleton", kRoom};
    arguments.insert(arguments.end(), part.begin(), part.end());
    const json j = answer(arguments);
    EXPECT_GT(j.at("arcs").at("EV"), 0) << part[0];
    EXPECT_LT(j.at("arcs").at("EV"), all.at("arcs").at("EV")) << part[0];
  }
}

/// True once the process blocks SIGINT, which it does when it is ready for one.
bool awaits_interrupt(pid_t pid) {
  std::istringstream status(contents("/proc/" + std::to_string(pid) + "/status"));
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("SigBlk:")) {
      return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1) != 0;
    }
  }
  return false;
}

TEST_F(Cli, InterruptGivesAPartialAnswer) {
  const pid_t pid = start({"skeleton", kRoom, "--threads", "1", "--json", "-"});
  for (int i = 0; i < 2000 && !awaits_interrupt(pid); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill(pid, SIGINT);
  const Run r = finish(pid);
  EXPECT_EQ(r.status, 3) << r.err;
  EXPECT_EQ(json::parse(r.out).at("complete"), false);
}

TEST_F(Cli, AnalyseFillsAFolder) {
  const fs::path folder = folder_ / "report";
  const json j = answer({"analyse", kRoom, "-o", folder.string()});
  expect_common_keys(j, "analyse");
  EXPECT_EQ(json::parse(contents(folder / "report.json")), j);
  EXPECT_EQ(j.at("skeleton").at("arcs"), answer({"skeleton", kRoom}).at("arcs"));
  EXPECT_TRUE(j.at("missing").empty());
  for (const char* picture : {"eee.png", "eeee.png"}) {
    EXPECT_TRUE(fs::exists(folder / picture)) << picture;
  }
  for (const json& file : j.at("files")) {
    EXPECT_GT(fs::file_size(folder / file.get<std::string>()), 0U) << file;
  }
  // More than a blank picture of the same size.
  const std::string blank =
      encode_png(sightline::viewers::render({}, {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}}));
  EXPECT_GT(contents(folder / "nodes.png").size(), 3 * blank.size());

  // The page needs no other file: every source is inlined, every link is a file beside
  // it.
  const std::string page = contents(folder / "index.html");
  EXPECT_NE(page.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
  for (const char* outside : {"http:", "https:", "<script", "<link", "@import"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  for (std::size_t at = page.find("src=\""); at != std::string::npos;
       at = page.find("src=\"", at + 1)) {
    EXPECT_EQ(page.substr(at + 5, 5), "data:");
  }
  // No temporary files are left.
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    EXPECT_NE(entry.path().filename().string()[0], '.') << entry.path();
  }
  ASSERT_EQ(run({"view", folder.string(), "--png", (folder_ / "view.png").string(),
                 "--size", "400,300"})
                .status,
            0);
  EXPECT_EQ(contents(folder_ / "view.png").substr(1, 3), "PNG");
}

TEST_F(Cli, AnalyseSaysWhatIsMissing) {
  const fs::path folder = folder_ / "report";
  // On a loaded machine the second may end before the report is written.
  Run r = run({"analyse", "-o", folder.string(), "--budget", "1e-6", "--json", "-"});
  for (int tries = 0; tries < 9 && r.out.empty(); ++tries) {
    r = run({"analyse", "-o", folder.string(), "--budget", "1e-6", "--json", "-"});
  }
  EXPECT_EQ(r.status, 3) << r.err;
  const json j = json::parse(r.out);
  EXPECT_GE(j.at("missing").size(), 3U);  // EV, EEE and FF, pictures if they take long
  EXPECT_NE(contents(folder / "index.html").find("not complete"), std::string::npos);
  // The built-in scene is the sample file.
  EXPECT_EQ(contents(folder / "room.obj"), contents(kRoom));
}

// ---- questions in JSON files
// ------------------------------------------------------------

class Questions : public Cli {
 protected:
  std::string file(const std::string& text) {
    const fs::path path = folder_ / "io" / "question.json";
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  void expect_picture(const std::string& what) {
    const fs::path png = folder_ / "picture.png";
    const Run r = run({"view", what, "--png", png.string(), "--size", "400,300"});
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(contents(png).substr(1, 3), "PNG");
    fs::remove(png);
  }
};

TEST_F(Questions, TransversalsOfPublishedSegments) {
  const std::string two = R"({"segments": [[[2,-3,1],[10,1,1]], [[1,5,11],[5,7,1]],
      [[-10,-23,-31],[71,-38,-1]], [[11,-40,35],[-7,52,-21]]]})";
  const json j = answer({"transversals", file(two), "--list"});
  EXPECT_EQ(j.at("command"), "transversals");
  EXPECT_EQ(j.at("scene"), json::parse(R"({"segments":4,"lines":0})"));
  EXPECT_EQ(j.at("complete"), true);
  EXPECT_EQ(j.at("lines"), 2);
  EXPECT_EQ(j.at("families").at("count"), 0);
  ASSERT_EQ(j.at("list").at("lines").size(), 2U);
  for (const json& line : j.at("list").at("lines")) {
    EXPECT_EQ(line.at("segments"), json::parse("[0,1,2,3]"));
    EXPECT_EQ(line.at("line").size(), 2U);
  }
  for (const char* stage : {"double", "interval", "exact"}) {
    EXPECT_TRUE(j.at("predicates").at(stage).is_number_unsigned());
  }
}

TEST_F(Questions, TransversalsOfLinesAndConcurrentSegments) {
  const json star = answer({"transversals", file(R"({"segments":
      [[[-1,-2,0],[3,6,0]], [[0,0,-1],[0,0,5]], [[1,1,1],[-2,-2,-2]], [[0,0,0],[1,0,7]]]})")});
  EXPECT_EQ(star.at("lines"), 0);
  EXPECT_EQ(star.at("families").at("count"), 1);
  EXPECT_EQ(star.at("families").at("2").at("star"), 1);
  EXPECT_FALSE(star.contains("list"));
  const json one = answer({"transversals", file(R"({"lines": [[[0,0,0],[1,0,0]],
      [[0,0,1],[0,1,1]], [[1,1,2],[2,2,2]], [[1,2,3],[2,0,3]]]})")});
  EXPECT_EQ(one.at("scene"), json::parse(R"({"segments":0,"lines":4})"));
  EXPECT_EQ(one.at("lines"), 1);
}

TEST_F(Questions, TransversalsAsVtkFiles) {
  const std::string vtk = (folder_ / "vtk").string();
  const Run r = run({"transversals", file(R"({"segments": [[[2,-3,1],[10,1,1]],
      [[1,5,11],[5,7,1]], [[-10,-23,-31],[71,-38,-1]], [[11,-40,35],[-7,52,-21]]]})"),
                     "--vtk", vtk});
  EXPECT_EQ(r.status, 0) << r.err;
  for (const char* name : {"segments.vtp", "transversals.vtp", "sightline.vtm"}) {
    EXPECT_TRUE(fs::exists(fs::path(vtk) / name)) << name;
  }
  EXPECT_FALSE(fs::exists(fs::path(vtk) / "family_samples.vtp"));
  expect_picture(vtk);
}

TEST_F(Questions, BadFilesAreRefusedByElement) {
  const auto refused = [this](const std::string& text, const std::string& mentioned) {
    expect_refused({"transversals", file(text)}, mentioned);
  };
  refused(R"({"segments": [[[0,0,0],[1,0,0]], [["a",0,0],[1,0,0]]]})",
          "segments[1][0]: expected three finite numbers");
  refused(R"({"segments": [[[0,0,0],[1,0]]]})", "segments[0][1]: expected three finite");
  refused(R"({"segments": [[[0,0,0]]]})", "segments[0]: expected two points");
  refused(R"({"segments": [[[0,0,0],[0,0,0]]]})",
          "segments[0]: its two points are the same");
  refused(R"({"lines": [[[0,0,0],[0,0,1e300]]]})",
          "lines[0][1]: a coordinate is neither");
  refused(R"({"lines": [[[0,0,0],[0,0,null]]]})", "lines[0][1]: expected three finite");
  refused(R"({"lines": {"0": 1}})", "lines: expected an array");
  refused(R"({"segments": [[[0,0,0],[1,0,1e999]]]})", "not JSON");
  refused(R"({"segments": [[[0,0,0],[1,0,NaN]]]})", "not JSON");
  refused(R"({"segments": [[[0,0,0],)", "not JSON");
  refused("", "not JSON");
  refused("[]", "expected an object");
  refused("{}", "has neither");
  expect_refused({"transversals", (folder_ / "io").string()}, "is a folder");
  expect_refused({"transversals", (folder_ / "none.json").string()}, "none.json");
  expect_refused({"transversals"}, "FILE");
}

constexpr const char* kThreeWindows = R"({"portals": [
    [[0,0,0],[1,0,0],[1,1,0],[0,1,0]],
    [[0.25,0.25,1],[0.75,0.25,1],[0.75,0.75,1],[0.25,0.75,1]],
    [[0,0,2],[1,0,2],[1,1,2],[0,1,2]]]})";

TEST_F(Questions, StabThreeWindows) {
  const json j = answer({"stab", file(kThreeWindows), "--list"});
  EXPECT_EQ(j.at("command"), "stab");
  EXPECT_EQ(j.at("scene"), json::parse(R"({"portals":3,"corners":12})"));
  EXPECT_EQ(j.at("complete"), true);
  EXPECT_EQ(j.at("stabbable"), true);
  EXPECT_EQ(j.at("room"), "open");
  EXPECT_EQ(j.at("extremal"), json::parse(R"({"VV":12,"VEE":16,"EVE":8,"EEEE":0,
                                              "in_plane":0,"degenerate":0})"));
  EXPECT_EQ(j.at("line").size(), 2U);
  EXPECT_EQ(j.at("line_exact"), true);
  EXPECT_EQ(j.at("line_inside"), true);
  EXPECT_EQ(j.at("pushes").size(), 3U);
  EXPECT_EQ(j.at("list").size(), 36U);
  EXPECT_EQ(j.at("list")[0].at("kind"), "VV");
}

TEST_F(Questions, StabWhatCannotBe) {
  const json j = answer({"stab", file(R"({"portals": [
      [[0,0,0],[1,0,0],[1,1,0],[0,1,0]], [[2,0,1],[3,0,1],[3,1,1],[2,1,1]],
      [[0,0,2],[1,0,2],[1,1,2],[0,1,2]]]})")});
  EXPECT_EQ(j.at("stabbable"), false);
  EXPECT_EQ(j.at("room"), "none");
  EXPECT_TRUE(j.at("line").is_null());
  const json conservative =
      answer({"stab", file(kThreeWindows), "--method", "conservative"});
  EXPECT_EQ(conservative.at("stabbable"), true);
  EXPECT_EQ(answer({"stab", file(R"({"portals": []})")}).at("stabbable"), true);
}

// Took hours when all triples of touched edges were tried (case portals-enfilade).
TEST_F(Questions, StabFortyDoorsInARow) {
  const json j =
      answer({"stab", std::string(SIGHTLINE_TEST_DATA) + "/portals/doors40.json"});
  EXPECT_EQ(j.at("complete"), true);
  EXPECT_EQ(j.at("stabbable"), true);
  EXPECT_EQ(j.at("room"), "open");
  EXPECT_EQ(j.at("extremal"), json::parse(R"({"VV":4,"VEE":0,"EVE":0,"EEEE":0,
                                              "in_plane":0,"degenerate":12})"));
  EXPECT_EQ(j.at("portals_done"), 40);
}

TEST_F(Questions, StabSaysHowFarItCameWithinItsBudget) {
  const std::string doors = std::string(SIGHTLINE_TEST_DATA) + "/portals/doors40.json";
  for (const char* method : {"exact", "conservative"}) {
    const json j = answer({"stab", doors, "--budget", "1e-9", "--method", method}, 3);
    EXPECT_EQ(j.at("complete"), false);
    EXPECT_EQ(j.at("portals_done"), 0);
    EXPECT_TRUE(j.at("stabbable").is_null());
  }
  // What is no polygon is refused whatever the budget is.
  expect_refused({"stab", file(R"({"portals": [[[0,0,0]],
                                   [[0,0,0],[2,0,0],[0.5,0.5,0],[0,2,0]]]})"),
                  "--budget", "1e-9"},
                 "portals[1]: not convex");
}

TEST_F(Questions, StabAsVtkFiles) {
  const std::string vtk = (folder_ / "vtk").string();
  const Run r = run({"stab", file(kThreeWindows), "--vtk", vtk});
  EXPECT_EQ(r.status, 0) << r.err;
  for (const char* name : {"portals.vtp", "extremal_VV.vtp", "extremal_VEE.vtp",
                           "extremal_EVE.vtp", "swaths_EV.vtp", "sightline.vtm"}) {
    EXPECT_TRUE(fs::exists(fs::path(vtk) / name)) << name;
  }
  EXPECT_FALSE(fs::exists(fs::path(vtk) / "extremal_EEEE.vtp"));
  expect_picture(vtk);
  expect_picture(vtk + "/extremal_VV.vtp");
}

TEST_F(Questions, BadPortalsAreRefusedByElement) {
  const auto refused = [this](const std::string& text, const std::string& mentioned) {
    expect_refused({"stab", file(text)}, mentioned);
  };
  refused("{}", "portals");
  refused(R"({"portals": [[]]})", "portals[0]");
  refused(R"({"portals": [[[0,0,0],[1,0]]]})", "portals[0][1]: expected three finite");
  refused(R"({"portals": [[[0,0,0]], [[0,0,0],[2,0,0],[0.5,0.5,0],[0,2,0]]]})",
          "portals[1]: not convex");
}

constexpr const char* kHalfScreens = R"({"instances": [
    {"a": [[0,0,0],[1,0,0],[0,1,0]], "b": [[0,0,1],[1,0,1],[0,1,1]],
     "occluders": [[[-9,-9,0.5],[0.25,-9,0.5],[0.25,9,0.5],[-9,9,0.5]],
                   [[RIGHT,-9,0.5],[9,-9,0.5],[9,9,0.5],[RIGHT,9,0.5]]]}]})";

std::string half_screens(const std::string& right) {
  std::string text = kHalfScreens;
  for (auto at = text.find("RIGHT"); at != std::string::npos; at = text.find("RIGHT")) {
    text.replace(at, 5, right);
  }
  return text;
}

TEST_F(Questions, VisibleThroughASlitButNotThroughASeam) {
  const json seam = answer({"visible", file(half_screens("0.25")), "--check"}, 0);
  EXPECT_EQ(seam.at("answers").at(0).at("visible"), false);
  EXPECT_EQ(seam.at("answers").at(0).at("cover").at("checked"), true);
  EXPECT_TRUE(seam.at("answers").at(0).at("witness").is_null());
  const json slit = answer({"visible", file(half_screens("0.2500000001"))}, 0);
  EXPECT_EQ(slit.at("answers").at(0).at("visible"), true);
  EXPECT_EQ(slit.at("answers").at(0).at("witness").size(), 2U);
  EXPECT_TRUE(slit.at("answers").at(0).contains("milliseconds"));
  EXPECT_EQ(slit.at("scene").at("instances"), 1);
}

TEST_F(Questions, VisibleBetweenGroups) {
  const json j = answer({"visible", kRoom, "floor", "table_top"}, 0);
  EXPECT_EQ(j.at("visible"), true);
  EXPECT_EQ(j.at("faces").size(), 2U);
  const json all =
      answer({"visible", kRoom, "table_top", "wall_right", "--all-pairs", "--check"}, 0);
  EXPECT_EQ(all.at("pairs").size(), 36U);
  EXPECT_EQ(all.at("complete"), true);
  const json sampled = answer(
      {"visible", kRoom, "floor", "ceiling", "--method", "sampled", "--rays", "1000"}, 0);
  EXPECT_EQ(sampled.at("rays"), 1000);
  expect_refused({"visible", kRoom, "floor", "nowhere"}, "no group named 'nowhere'");
  expect_refused({"visible", kRoom, "floor"}, "name two groups");
}

TEST_F(Questions, BadInstancesAreRefusedByElement) {
  const auto refused = [this](const std::string& instance, const std::string& mentioned) {
    expect_refused({"visible", file(R"({"instances": [)" + instance + "]}")}, mentioned);
  };
  refused(R"({"a": [[0,0,0],[1,0,0]], "b": []})", "instances[0].a: expected at least 3");
  refused(R"({"a": [[0,0,0],[1,0,0],[2,0,0]], "b": [[0,0,1],[1,0,1],[0,1,1]]})",
          "instances[0].a: has no area");
  refused(R"({"a": [[0,0,0],[1,0,0],[0,1,0]], "b": [[0,0,1],[1,0,1],[0,1,1]],
              "occluders": [[[0,0,0],[4,0,0],[1,1,0],[0,4,0]]]})",
          "instances[0].occluders[0]: not convex");
  refused(R"({"a": [[0,0,0],[1,0,0],[0,1,0]]})", "instances[0]");
}

}  // namespace
