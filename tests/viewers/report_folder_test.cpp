// The folder of a report: what a run leaves in it, and what the next one removes.

#include "viewers/report_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/shell.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sightline::test::file_contents;
using sightline::viewers::ReportFolder;

class ReportFolderTest : public sightline::test::Shell {
 protected:
  void write(const std::string& name, const std::string& text = "x") {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::set<std::string> files() const {
    std::set<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "r")) {
      if (!entry.is_directory()) {
        found.insert(fs::relative(entry.path(), folder_ / "r").string());
      }
    }
    return found;
  }
  void run(const std::vector<std::string>& names) {
    ReportFolder folder(folder_ / "r");
    folder.clear();
    for (const std::string& name : names) {
      write("r/" + name);
      folder.add({name});
    }
  }
};

TEST_F(ReportFolderTest, TheNextRunRemovesWhatThisOneWroteAndNothingElse) {
  run({"a.png", "vtk/scene.vtp", "b.png"});
  write("r/notes.txt");
  write("r/vtk/mine.vtp");
  run({"b.png", "c.png"});
  EXPECT_EQ(files(), (std::set<std::string>{"b.png", "c.png", "files.txt", "notes.txt",
                                            "vtk/mine.vtp"}));
  fs::remove(folder_ / "r/vtk/mine.vtp");
  run({"vtk/scene.vtp"});
  run({});
  EXPECT_EQ(files(), (std::set<std::string>{"files.txt", "notes.txt"}));
  EXPECT_FALSE(fs::exists(folder_ / "r/vtk"));
}

TEST_F(ReportFolderTest, WhatWasAnnouncedIsKnownThoughTheRunDied) {
  write("r/old.png");
  run({"old.png"});
  {
    ReportFolder folder(folder_ / "r");
    write("r/new.png");
    EXPECT_EQ(folder.announce("new.png"), folder_ / "r/new.png");
  }
  run({});
  EXPECT_EQ(files(), std::set<std::string>{"files.txt"});
}

TEST_F(ReportFolderTest, AListThatIsNotOursRemovesNothing) {
  write("mine.txt");
  write("r/mine.txt");
  write("r/files.txt", "mine.txt\n");
  run({});
  EXPECT_TRUE(fs::exists(folder_ / "r/mine.txt"));
  // Names that lead out of the folder are no names of ours.
  std::ofstream(folder_ / "r/files.txt", std::ios::app)
      << "../mine.txt\n"
      << (folder_ / "mine.txt").string() << "\nvtk/../../mine.txt\n";
  run({});
  EXPECT_TRUE(fs::exists(folder_ / "mine.txt"));
}

TEST_F(ReportFolderTest, AReportHasItsSkeletonAndLeavesNothingOfTheLastOne) {
  ASSERT_EQ(shell("$S analyse $ROOM -o r --json a.json").status, 0);
  const json skeleton = json::parse(file_contents(folder_ / "r/skeleton.json"));
  const json report = json::parse(file_contents(folder_ / "r/report.json"));
  EXPECT_EQ(skeleton.at("arcs"), report.at("skeleton").at("arcs"));
  std::set<std::string> listed{"files.txt"};
  for (const json& name : report.at("files")) listed.insert(name);
  EXPECT_EQ(files(), listed);
  EXPECT_TRUE(listed.contains("skeleton.json"));
  const auto again = shell("$S skeleton $ROOM --saved r/skeleton.json --json -");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(json::parse(again.out).at("nodes"), report.at("skeleton").at("nodes"));
  // A smaller scene has fewer pictures.
  write("r/mine.png");
  std::ofstream(folder_ / "one.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  ASSERT_EQ(shell("$S analyse one.obj -o r").status, 0);
  std::set<std::string> now{"files.txt", "mine.png"};
  const json smaller = json::parse(file_contents(folder_ / "r/report.json"));
  for (const json& name : smaller.at("files")) now.insert(name);
  EXPECT_EQ(files(), now);
  EXPECT_LT(now.size(), listed.size());
}

// ---- where a scene comes from

class SceneInput : public sightline::test::Shell {};

TEST_F(SceneInput, StandardInputIsReadWithItsFormat) {
  const auto named = shell("$S info $CORNELL --json -");
  const auto piped = shell("$S info - --format obj --json - < $CORNELL");
  ASSERT_EQ(piped.status, 0) << piped.err;
  const json a = json::parse(named.out), b = json::parse(piped.out);
  for (const char* key : {"vertices", "faces", "edges", "solids"}) {
    EXPECT_EQ(a.at(key), b.at(key)) << key;
  }
  EXPECT_EQ(b.at("scene").at("file"), "standard input");
  EXPECT_EQ(shell("$S info - --format .OBJ --json - < $CORNELL").status, 2);
  expect_told("$S info - < $CORNELL", 2, "--format");
  expect_told("$S info - --format objj < $CORNELL", 2, "obj");
  expect_told("$S info - --format ply < $CORNELL", 2, "standard input");
  expect_told("$S visible - A B --format stl < /dev/null", 2, "empty");
}

TEST_F(SceneInput, AFormatGoesBeforeTheName) {
  EXPECT_EQ(shell("cp $CORNELL c.txt && $S info c.txt --format obj").status, 0);
  expect_told("$S info c.txt", 2, "no mesh format is known by the extension 'txt'");
}

TEST_F(SceneInput, FoldersMissingFilesAndUnknownExtensionsAreToldApart) {
  fs::create_directory(folder_ / "f.obj");
  fs::create_directory(folder_ / "g");
  expect_told("$S info f.obj", 2, "f.obj: is a folder");
  expect_told("$S info g", 2, "g: is a folder");
  expect_told("$S info none.obj", 2, "none.obj: no such file");
  expect_told("$S info none", 2, "none: no such file");
  std::ofstream(folder_ / "a.xyz") << "v 0 0 0\n";
  expect_told("$S info a.xyz", 2, "read are .3ds");
}

}  // namespace
