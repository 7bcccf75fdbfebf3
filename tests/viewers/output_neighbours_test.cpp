// Every output of every command, given every name that a file should not have: that of an
// input in another spelling, a device, a pipe, a folder.

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "tests/support/shell.h"
#include "tests/viewers/sample_questions.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sightline::test::file_contents;

/// A command that reads one file, and an option of it that writes one.
struct Output {
  std::string command, input, option;
  std::string more;
};

const std::vector<Output> kFileOutputs{
    {"info", "s.obj", "--json", ""},
    {"skeleton", "s.obj", "--json", "--kinds EV"},
    {"skeleton", "s.obj", "-o", "--kinds EV"},
    {"skeleton", "s.obj", "--json", "--saved saved.json"},
    {"analyse", "s.obj", "--json", "-o report"},
    {"view", "s.obj", "--png", "--size 60,60"},
    {"view", "saved.json", "--png", "--size 60,60"},
    {"view", "vtk/scene.vtp", "--png", "--size 60,60"},
    {"look", "s.obj", "--svg", "--from 7,8,9"},
    {"look", "s.obj", "--csv", "--from 7,8,9"},
    {"look s.obj --at", "w.json", "--png", "--pixels 60"},
    {"transversals", "t.json", "--json", ""},
    {"stab", "p.json", "--json", ""},
    {"visible", "v.json", "--json", ""},
    {"visible", "s.obj", "--json", "a b"}};

const std::vector<Output> kFolderOutputs{
    {"info", "s.obj", "--vtk", ""},          {"skeleton", "s.obj", "--vtk", "--kinds EV"},
    {"analyse", "s.obj", "-o", ""},          {"analyse", "s.obj", "--vtk", "-o report"},
    {"transversals", "t.json", "--vtk", ""}, {"stab", "p.json", "--vtk", ""},
    {"visible", "s.obj", "--vtk", "a b"},    {"look", "s.obj", "--vtk", "--from 7,8,9"}};

class OutputNeighbours : public sightline::test::Shell {
 protected:
  OutputNeighbours() {
    fs::create_directories(folder_ / "d/e");
    sightline::test::write_questions(folder_);
    std::ofstream(folder_ / "v.json")
        << R"({"instances": [{"a": [[0,0,0],[1,0,0],[0,1,0]],)"
           R"("b": [[0,0,1],[1,0,1],[0,1,1]], "occluders": []}]})";
    std::ofstream(folder_ / "w.json") << R"({"views": [{"direction": [1, 2, 3]}]})";
    EXPECT_EQ(shell("$S skeleton s.obj --kinds EV -o saved.json >/dev/null && "
                    "$S info s.obj --vtk vtk >/dev/null")
                  .status,
              0);
  }

  static std::string line(const Output& o, const std::string& name) {
    return "$S " + o.command + " " + o.input + " " + o.more + " " + o.option + " " + name;
  }

  /// All files below the folder, with what they hold.
  [[nodiscard]] std::map<std::string, std::string> all_files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      const bool whole = entry.is_regular_file();
      files[entry.path().string()] = whole ? file_contents(entry.path()) : "";
    }
    return files;
  }

  /// Status 2 and a line; not a byte below the folder is another.
  void expect_untouched(const std::string& command, const std::string& words) {
    const auto before = all_files();
    expect_told(command, 2, words);
    EXPECT_EQ(all_files(), before) << command;
  }
};

/// Another spelling of a file's name; makes links where it needs them.
struct Spelling {
  const char* prepare;
  const char* name;  // '@' is the file, '#' its last part
};
const std::vector<Spelling> kSpellings{{"true", "@"},
                                       {"true", "./@"},
                                       {"true", "d/../@"},
                                       {"true", "d/e/../../@"},
                                       {"true", "\"$PWD\"/@"},
                                       {"true", ".//@"},
                                       {"ln -f @ hard", "hard"},
                                       {"ln -f @ d/hard", "d/hard"},
                                       {"ln -sf \"$PWD\"/@ soft", "soft"},
                                       {"ln -sf ../@ d/soft", "d/soft"},
                                       {"ln -sf @ one; ln -sf one two", "two"},
                                       {"ln -sfn . here", "here/@"},
                                       {"ln -sfn .. d/up", "d/up/@"}};

std::string filled(std::string pattern, const std::string& file) {
  for (std::size_t at = pattern.find('@'); at != std::string::npos;
       at = pattern.find('@', at + file.size())) {
    pattern.replace(at, 1, file);
  }
  return pattern;
}

TEST_F(OutputNeighbours, NoInputIsOverwrittenByAnySpellingOfItsName) {
  std::mt19937 random(1);
  const auto clean = [this] { shell("rm -f hard d/hard soft d/soft one two here d/up"); };
  for (int i = 0; i < 100; ++i) {
    const Output& output = kFileOutputs[random() % kFileOutputs.size()];
    // The input itself, or a file that the options read.
    std::string file = output.input;
    if (output.more.find("--saved") != std::string::npos && random() % 2 == 0) {
      file = "saved.json";
    }
    if (file == "saved.json" && output.command == "view" && random() % 2 == 0) {
      file = "s.obj";  // the scene that it was built from
    }
    const Spelling& spelling = kSpellings[random() % kSpellings.size()];
    // The input too may be named by a link.
    Output named = output;
    if (random() % 3 == 0 && output.input.ends_with(".obj")) {
      shell("ln -sf s.obj input.obj");
      named.input = "input.obj";
    }
    ASSERT_EQ(shell(filled(spelling.prepare, file)).status, 0);
    expect_untouched(line(named, filled(spelling.name, file)), "is read");
    clean();
  }
}

// The scene lies under a name that a folder of VTK files, or a report, would take.
TEST_F(OutputNeighbours, NoInputIsOverwrittenByAFileOfAFolder) {
  const std::vector<std::array<std::string, 3>> taken{
      {"info", "scene.vtp", "--vtk out"},
      {"info", "edges.vtp", "--vtk ./out"},
      {"info", "sightline.vtm", "--vtk out/"},
      {"skeleton", "arcs_EV.vtp", "--vtk out --kinds EV"},
      {"visible", "scene.vtp", "a b --vtk out"},
      {"analyse", "scene.vtp", "--vtk out -o report"},
      {"analyse", "report.json", "-o out"},
      {"analyse", "files.txt", "-o out"},
      {"analyse", "nodes.png", "-o d/../out"}};
  for (const auto& [command, name, options] : taken) {
    for (const std::string link : {"mv", "ln", "ln -s"}) {
      shell("rm -rf out; mkdir out; cp s.obj in; " + link + " " +
            (link == "ln -s" ? "../in" : "in") + " out/" + name);
      const std::string input = link == "mv" ? "out/" + name : "in";
      expect_untouched("$S " + command + " " + input + " --format obj " + options,
                       "is read");
    }
  }
  // A file beside a folder's names is not in its way.
  shell("rm -rf out; mkdir out; cp s.obj out/scene.obj; cp s.obj out/list.txt");
  EXPECT_EQ(shell("$S info out/scene.obj --vtk out >/dev/null").status, 0);
  EXPECT_EQ(shell("$S info out/list.txt --format obj --vtk out >/dev/null").status, 0);
}

// What an earlier report wrote is removed by the next, but not when that reads it: the
// built-in scene was, and the report was of a file that is no more.
TEST_F(OutputNeighbours, AReportRemovesNotWhatItReads) {
  shell("$S analyse -o report --budget 1e-6 >/dev/null");
  ASSERT_NE(file_contents(folder_ / "report/files.txt").find("room.obj"),
            std::string::npos);
  expect_untouched("$S analyse report/room.obj -o report", "is read");
  expect_untouched("cd report; $S analyse room.obj -o .", "is read");
  ASSERT_EQ(shell("ln -s report/room.obj link").status, 0);
  expect_untouched("$S analyse link -o report", "is read");
}

TEST_F(OutputNeighbours, DevicesPipesAndFoldersStayWhatTheyAre) {
  ASSERT_EQ(mknod((folder_ / "null").c_str(), S_IFCHR | 0666, makedev(1, 3)), 0);
  ASSERT_EQ(mknod((folder_ / "full").c_str(), S_IFCHR | 0666, makedev(1, 7)), 0);
  shell("mkfifo pipe; ln -s null null-link; ln -s full full-link; ln -s pipe pipe-link");
  std::mt19937 random(2);
  for (int i = 0; i < 36; ++i) {
    const Output& output =
        kFileOutputs[static_cast<std::size_t>(i) % kFileOutputs.size()];
    const std::string link = random() % 2 == 0 ? "-link" : "";
    switch (random() % 4) {
      case 0:
        EXPECT_EQ(shell(line(output, "null" + link)).status, 0) << line(output, "null");
        break;
      case 1:
        expect_told(line(output, "full" + link), 1, "No space left");
        break;
      case 2: {
        const Run r = shell("cat pipe >got & " + line(output, "pipe" + link) +
                            "; s=$?; wait; exit $s");
        EXPECT_EQ(r.status, 0) << line(output, "pipe") << r.err;
        const std::string got = file_contents(folder_ / "got");
        if (output.option == "--png") {
          EXPECT_EQ(got.substr(1, 3), "PNG");
        } else if (output.option == "--svg" || output.option == "--csv") {
          EXPECT_TRUE(got.starts_with("<?xml") || got.starts_with("view,facet")) << got;
        } else {
          EXPECT_FALSE(json::parse(got, nullptr, false).is_discarded());
        }
        break;
      }
      default:
        expect_untouched(line(output, random() % 2 == 0 ? "d" : "d/new/"), "folder");
    }
    struct stat status {};
    for (const auto& [name, type] : {std::pair{"null", S_IFCHR},
                                     {"full", S_IFCHR},
                                     {"pipe", S_IFIFO},
                                     {"null-link", S_IFLNK},
                                     {"full-link", S_IFLNK},
                                     {"pipe-link", S_IFLNK}}) {
      ASSERT_EQ(lstat((folder_ / name).c_str(), &status), 0);
      ASSERT_EQ(status.st_mode & S_IFMT, static_cast<unsigned>(type)) << name;
    }
    shell("rm -rf got report");
  }
}

TEST_F(OutputNeighbours, AFolderIsNoFileOrDevice) {
  ASSERT_EQ(mknod((folder_ / "full").c_str(), S_IFCHR | 0666, makedev(1, 7)), 0);
  shell("mkfifo pipe; ln -s full link; ln -s nowhere dangling; touch file");
  for (const Output& output : kFolderOutputs) {
    for (const char* name : {"full", "pipe", "link", "file", "file/below", "full/below",
                             "s.obj", "dangling/"}) {
      const auto before = all_files();
      const Run r = shell(line(output, name));
      EXPECT_EQ(r.status, 2) << line(output, name) << r.err;
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
      EXPECT_EQ(all_files(), before) << line(output, name);
    }
  }
}

// Files of a folder that become too large: none has its final name, and the status says
// so; small ones are whole.
TEST_F(OutputNeighbours, FilesOfAFolderThatCannotBeWrittenAreToldAndLeaveNothing) {
  int told = 0;
  for (const Output& output : kFolderOutputs) {
    for (const int blocks : {1, 3}) {
      const Run r = shell("ulimit -f " + std::to_string(blocks) + "; " +
                          line(output, "out") + " >" + (io_ / "null").string());
      if (r.status != 0) {
        EXPECT_EQ(r.status, 1) << blocks << line(output, "out") << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
        EXPECT_FALSE(fs::exists(folder_ / "out/sightline.vtm"));
        EXPECT_FALSE(fs::exists(folder_ / "out/index.html"));
        ++told;
      }
      if (!fs::exists(folder_ / "out")) continue;
      for (const std::string& name : names("out")) {
        EXPECT_NE(name[0], '.') << name;
        EXPECT_GT(fs::file_size(folder_ / "out" / name), 0U) << name;
      }
      shell("rm -rf out report");
    }
  }
  EXPECT_GT(told, 6);
}

}  // namespace
