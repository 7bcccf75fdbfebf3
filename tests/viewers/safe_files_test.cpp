// What the program does to files: whole or not at all, never over an input or a device,
// and said with the right status when it cannot be.

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <nlohmann/json.hpp>

#include "tests/support/shell.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sightline::test::file_contents;
using Names = std::set<std::string>;

class SafeFiles : public sightline::test::Shell {};

TEST_F(SafeFiles, AnInputIsNeverOverwrittenUnderAnyName) {
  shell("cp $ROOM same.obj; ln same.obj hard.obj; ln -s same.obj soft.obj; mkdir d");
  const std::string before = file_contents(folder_ / "same.obj");
  for (const char* name : {"same.obj", "./d/../same.obj", "hard.obj", "soft.obj"}) {
    expect_told("$S info same.obj --json " + std::string(name), 2, "is read");
    expect_told("$S skeleton same.obj --kinds EV -o " + std::string(name), 2, "is read");
    expect_told("$S view same.obj --png " + std::string(name), 2, "is read");
  }
  expect_told("$S info soft.obj --json same.obj", 2, "is read");
  EXPECT_EQ(file_contents(folder_ / "same.obj"), before);
  EXPECT_EQ(names(), (Names{"same.obj", "hard.obj", "soft.obj", "d"}));
  shell("echo '{\"segments\": []}' >q.json");
  expect_told("$S transversals q.json --json q.json", 2, "is read");
}

TEST_F(SafeFiles, FilesThatTheInputNamesAreInputsToo) {
  shell("cp \"$DATA\"/readable/escaped_uri.gltf \"$DATA/readable/my buffer.bin\" .");
  const std::string before = file_contents(folder_ / "my buffer.bin");
  expect_told("$S info escaped_uri.gltf --json 'my buffer.bin'", 2, "is read");
  expect_told("$S skeleton ./escaped_uri.gltf -o './my buffer.bin'", 2, "is read");
  EXPECT_EQ(file_contents(folder_ / "my buffer.bin"), before);
}

TEST_F(SafeFiles, WhatAKilledRunLeftTheNextRemoves) {
  shell("mkdir vtk; touch .sightline-1-1.json vtk/.sightline-2-3.vtp .sightline");
  shell("mkfifo .sightline-4-4; mkdir .sightline-5-5");
  // A lock is held by whoever still writes there.
  ASSERT_EQ(shell("exec 9>.sightline-3-1.json; flock 9; "
                  "$S info $ROOM --json a --vtk vtk >/dev/null")
                .status,
            0);
  EXPECT_EQ(names(), (Names{".sightline", ".sightline-3-1.json", ".sightline-4-4",
                            ".sightline-5-5", "a", "vtk"}));
  EXPECT_FALSE(names("vtk").contains(".sightline-2-3.vtp"));
}

TEST_F(SafeFiles, TwoOutputsNeverShareAName) {
  expect_told("$S skeleton $CORNELL -o a.json --json ./a.json", 2, "same file");
  EXPECT_EQ(names(), Names{});
}

TEST_F(SafeFiles, DevicesAreWrittenIntoNotReplaced) {
  ASSERT_EQ(mknod((folder_ / "null").c_str(), S_IFCHR | 0666, makedev(1, 3)), 0);
  for (const char* command :
       {"$S info $ROOM --json null", "$S skeleton $CORNELL --kinds EV -o null",
        "$S view $CORNELL --size 64,64 --png null", "$S analyse $CORNELL --json null"}) {
    EXPECT_EQ(shell(command).status, 0) << command;
    struct stat status {};
    ASSERT_EQ(lstat((folder_ / "null").c_str(), &status), 0);
    EXPECT_TRUE(S_ISCHR(status.st_mode)) << command;
  }
  ASSERT_EQ(mknod((folder_ / "full").c_str(), S_IFCHR | 0666, makedev(1, 7)), 0);
  expect_told("$S info $ROOM --json full", 1, "No space left");
}

TEST_F(SafeFiles, PipesAreWrittenInto) {
  const auto r = shell("mkfifo p; cat p >got & $S info $ROOM --json p; wait; test -p p");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(json::parse(file_contents(folder_ / "got")).at("command"), "info");
}

TEST_F(SafeFiles, LinksStayAndTheirTargetsAreReplaced) {
  shell("mkdir d; echo old >d/old; ln -s d/old link; ln -s d/new dangling");
  ASSERT_EQ(shell("$S info $ROOM --json link && $S info $ROOM --json dangling").status,
            0);
  for (const char* name : {"link", "dangling"}) {
    EXPECT_TRUE(fs::is_symlink(folder_ / name));
    EXPECT_EQ(json::parse(file_contents(folder_ / name)).at("command"), "info");
  }
  EXPECT_EQ(names("d"), (Names{"old", "new"}));
}

TEST_F(SafeFiles, OutputsAreOpenedBeforeAnythingIsComputed) {
  // The scene is never read: it does not exist.
  expect_told("$S info none.obj --json no/such/folder", 2, "no/such/folder");
  expect_told("$S skeleton none.obj -o no/such/folder", 2, "no/such/folder");
  expect_told("$S analyse none.obj -o /dev/null/x", 2, "/dev/null/x");
  expect_told("$S info none.obj --vtk /dev/null", 2, "/dev/null");
  expect_told("$S view none.obj --png .", 2, "folder");
  expect_told("$S info none.obj --json new/", 2, "folder");
  // And what was opened in vain leaves nothing.
  expect_told("$S analyse none.obj -o a/b/c --vtk d/e --json f", 2, "none.obj");
  EXPECT_EQ(names(), Names{});
}

TEST_F(SafeFiles, StandardOutputIsWrittenToItsEndOrTheStatusSaysSo) {
  for (const char* command :
       {"$S info $ROOM --json -", "$S info $ROOM", "$S --help", "$S info --help",
        "$S --version", "$S skeleton $CORNELL --kinds EV --list --json -"}) {
    expect_told(std::string(command) + " >/dev/full", 1, "standard output");
    expect_told(std::string(command) + " >&-", 1, "standard output");
  }
  // A reader that goes away.
  expect_told("mkfifo p; (exec <p; exit) & exec 9>p; wait; $S info $ROOM --json - >&9", 1,
              "Broken pipe");
  // The answer's own file is whole all the same.
  expect_told("$S info $ROOM --json answer >/dev/full", 1, "standard output");
  EXPECT_EQ(json::parse(file_contents(folder_ / "answer")).at("command"), "info");
}

TEST_F(SafeFiles, AClosedStreamsNumberGoesToNoFile) {
  EXPECT_EQ(shell("$S info $ROOM --json a <&- >&- 2>&-").status, 1);
  EXPECT_EQ(json::parse(file_contents(folder_ / "a")).at("command"), "info");
  EXPECT_EQ(shell("$S info none.obj --json b <&- >&- 2>&-").status, 2);
  EXPECT_EQ(names(), Names{"a"});
}

TEST_F(SafeFiles, StandardOutputsOwnFileIsNotReplaced) {
  const auto r = shell("$S info $ROOM --json out >out");
  EXPECT_EQ(r.status, 2);
  EXPECT_NE(r.err.find("standard output goes there too"), std::string::npos) << r.err;
  EXPECT_EQ(shell("$S info $ROOM --json /dev/stdout | grep -q peak_memory").status, 0);
}

TEST_F(SafeFiles, AFileThatBecomesTooLargeIsOneLineAndLeavesNothing) {
  // 2 KiB a file.
  for (const char* command :
       {"$S info $ROOM --vtk out", "$S skeleton $CORNELL -o s.json --json j",
        "$S view $ROOM --png p.png", "$S analyse $CORNELL -o out",
        "$S skeleton $CORNELL --list --json j"}) {
    expect_told("ulimit -f 4; " + std::string(command), 1,
                "could not be written to its end");
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      // Small ones that came first are whole.
      if (entry.is_regular_file()) {
        EXPECT_LE(entry.file_size(), 2048U) << entry.path();
        EXPECT_NE(entry.path().filename().string()[0], '.') << entry.path();
        EXPECT_NE(entry.path().extension(), ".vtm");
        EXPECT_NE(entry.path().extension(), ".html");
      }
    }
    shell("rm -rf out s.json j p.png");
  }
}

TEST_F(SafeFiles, AReplacedFileKeepsItsPermissions) {
  shell("echo old >a; chmod 640 a; $S info $ROOM --json a");
  struct stat status {};
  ASSERT_EQ(stat((folder_ / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640U);
  EXPECT_GT(status.st_size, 100);
}

TEST_F(SafeFiles, NumbersThatAreNoneAreToldInWords) {
  const std::string skeleton = "$S skeleton $CORNELL --kinds EV ";
  for (const char* value : {"nan", "inf", "-inf", "-1", "1e999", "", "1x", "0x"}) {
    const std::string v = " '" + std::string(value) + "'";
    expect_told(skeleton + "--near 1,1,1 --radius" + v, 2, "is not a number above 0");
    expect_told(skeleton + "--budget" + v, 2, "is not a number above 0");
    expect_told(skeleton + "--budget-mb" + v, 2, "is not a number above 0");
    expect_told(skeleton + "--feature-size" + v, 2, "is not 0 or a number above 0");
    expect_told(skeleton + "--perturb" + v, 2, "is not 0 or a number above 0");
    expect_told(skeleton + "--threads" + v, 2, "is not a whole number from 0 to 4096");
    expect_told(skeleton + "--seed" + v, 2, "is not a whole number from 0");
    expect_told("$S visible $ROOM floor ceiling --rays" + v, 2, "is not a whole number");
    expect_told("$S view $ROOM --png p --size 100," + std::string(value), 2, "--size");
  }
  for (const char* value : {"nan", "inf", "1e999", "x"}) {
    const std::string v(value);
    expect_told(skeleton + "--radius 1 --near 1,1," + v, 2, "is not a finite number");
    expect_told(skeleton + "--region 0,0,0,1,1," + v, 2, "is not a finite number");
    expect_told("$S view $ROOM --png p --eye 1,1," + v, 2, "is not a finite number");
  }
  expect_told(skeleton + "--perturb 1e300", 2, "at most 1.3938e+42");
}

}  // namespace
