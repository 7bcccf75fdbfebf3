// Saved skeletons: read back as they were, or refused: of another scene, changed, cut
// off, with options that only the building obeys.

#include <nlohmann/json.hpp>
#include <random>
#include <regex>

#include "linespace/checksum.h"
#include "linespace/mesh_io.h"
#include "skeleton/build.h"
#include "tests/support/shell.h"
#include "viewers/skeleton_file.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sightline::Checksum;
using sightline::InvalidInput;
using sightline::PolygonSoup;
using sightline::Scene;
using sightline::test::file_contents;
using sightline::viewers::check_fits;
using sightline::viewers::fingerprint;
using sightline::viewers::read_skeleton_json;
using sightline::viewers::StoredSkeleton;

TEST(Checksum, IsTheSameHoweverTheBytesAreCut) {
  std::mt19937 engine(1);
  std::string text(1000, ' ');
  for (char& c : text) c = static_cast<char>(engine());
  Checksum whole;
  whole.add(text);
  for (int i = 0; i < 100; ++i) {
    Checksum parts;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t n = std::min<std::size_t>(engine() % 30, text.size() - at);
      parts.add(std::string_view(text).substr(at, n));
      at += n;
    }
    ASSERT_EQ(parts.text(), whole.text());
  }
}

TEST(Checksum, EveryBitAndTheLengthCount) {
  std::string text(100, '\0');
  std::set<std::string> sums;
  std::size_t asked = 0;
  for (std::size_t n = 0; n <= text.size(); ++n, ++asked) {
    Checksum sum;
    sum.add(std::string_view(text).substr(0, n));
    sums.insert(sum.text());
  }
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit, ++asked) {
    text[bit / 8] = static_cast<char>(1 << (bit % 8));
    Checksum sum;
    sum.add(text);
    sums.insert(sum.text());
    text[bit / 8] = '\0';
  }
  EXPECT_EQ(sums.size(), asked);
}

TEST(Fingerprint, TellsCoordinatesPolygonsAndGroups) {
  const PolygonSoup soup = sightline::read_mesh(SIGHTLINE_EXAMPLES "/scenes/cornell.obj");
  const std::string before = fingerprint(Scene(soup));
  EXPECT_EQ(fingerprint(Scene(soup)), before);
  PolygonSoup renamed = soup;
  renamed.source = "another name";
  EXPECT_EQ(fingerprint(Scene(renamed)), before);
  std::set<std::string> sums{before};
  const auto add = [&](const auto& change) {
    PolygonSoup other = soup;
    change(other);
    sums.insert(fingerprint(Scene(other)));
  };
  add([](PolygonSoup& s) { s.vertices[5].x() = std::nextafter(s.vertices[5].x(), 1e9); });
  add([](PolygonSoup& s) { s.vertices.emplace_back(1, 2, 3); });
  add([](PolygonSoup& s) { std::ranges::reverse(s.polygons[3]); });
  add([](PolygonSoup& s) { std::swap(s.polygons[3], s.polygons[4]); });
  add([](PolygonSoup& s) { std::swap(s.groups[0], s.groups[1]); });
  add([](PolygonSoup& s) { s.groups[0].name += "x"; });
  add([](PolygonSoup& s) { std::swap(s.groups[0].name, s.groups[1].name); });
  EXPECT_EQ(sums.size(), 8U);
}

class SavedSkeleton : public sightline::test::Shell {
 protected:
  /// Writes these bytes and reads them as a saved skeleton of the scene.
  StoredSkeleton read(const std::string& bytes) {
    const fs::path path = io_ / "read.json";
    std::ofstream(path, std::ios::binary) << bytes;
    StoredSkeleton stored = read_skeleton_json(path.string());
    check_fits(stored, scene_);
    return stored;
  }

  /// With the checksum that this text has, whatever it says.
  static std::string resealed(std::string text) {
    const std::string key = ",\n \"checksum\": \"";
    text.erase(text.rfind(key));
    Checksum sum;
    sum.add(text);
    return text + key + sum.text() + "\"\n}\n";
  }

  std::string saved() {
    EXPECT_EQ(shell("$S skeleton $CORNELL -o s.json >" + (io_ / "null").string()).status,
              0);
    return file_contents(folder_ / "s.json");
  }

  Scene scene_{sightline::read_mesh(SIGHTLINE_EXAMPLES "/scenes/cornell.obj")};
};

TEST_F(SavedSkeleton, IsReadAsItWas) {
  const StoredSkeleton stored = read(saved());
  sightline::SkeletonRequest request;
  request.eee = request.ff = true;
  const sightline::Skeleton built = sightline::build_skeleton(scene_, request);
  const sightline::Skeleton& kept = stored.skeleton;
  ASSERT_EQ(kept.nodes.size(), built.nodes.size());
  ASSERT_EQ(kept.arcs.size(), built.arcs.size());
  ASSERT_EQ(kept.eee().size(), built.eee().size());
  for (std::size_t i = 0; i < kept.arcs.size(); ++i) {
    EXPECT_EQ(kept.arcs[i].range, built.arcs[i].range);
    EXPECT_EQ(kept.arcs[i].nodes, built.arcs[i].nodes);
  }
  EXPECT_EQ(kept.vertices_done, built.vertices_done);
  EXPECT_EQ(kept.facets_asked, built.facets_asked);
  EXPECT_TRUE(kept.complete);
}

TEST_F(SavedSkeleton, AnyChangedByteAndAnyMissingEndIsRefused) {
  const std::string text = saved();
  std::mt19937 engine(15);
  for (int i = 0; i < 200; ++i) {
    std::string damaged = text;
    char& c = damaged[engine() % text.size()];
    c = static_cast<char>(c ^ (1 << (engine() % 8)));
    EXPECT_THROW((void)read(damaged), InvalidInput) << i;
    EXPECT_THROW((void)read(text.substr(0, engine() % text.size())), InvalidInput) << i;
  }
  EXPECT_THROW((void)read(text + "\n"), InvalidInput);
  EXPECT_THROW((void)read(""), InvalidInput);
}

TEST_F(SavedSkeleton, WhatNoSkeletonSaysIsRefusedWhateverTheChecksum) {
  const std::string text = saved();
  EXPECT_NO_THROW((void)read(resealed(text)));
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string forged = text;
    const std::size_t at = forged.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    forged.replace(at, from.size(), to);
    EXPECT_THROW((void)read(resealed(forged)), InvalidInput) << from << " -> " << to;
  };
  refused("\"range\":[", "\"range\":[5,9],\"was\":[");
  refused("\"range\":[", "\"range\":[0.5,0.25],\"was\":[");
  refused("\"range\":[", "\"range\":[null,null],\"was\":[");
  refused("\"nodes\":[", "\"nodes\":[0,4000000000],\"was\":[");
  refused("\"nodes\":[", "\"nodes\":[0,-1],\"was\":[");
  refused("\"line\":[", "\"line\":null,\"was\":[");
  refused("\"type\":\"vertex\",\"id\":",
          "\"type\":\"vertex\",\"id\":99999999999,\"was\":");
  refused("\"type\":\"vertex\",\"id\":", "\"type\":\"vertex\",\"id\":1e3,\"was\":");
  refused("\"type\":\"vertex\"", "\"type\":\"wertex\"");
  refused("\"kind\":\"VV\"", "\"kind\":\"WW\"");
  refused("\"complete\": true", "\"complete\": 7");
  refused("\"fingerprint\": \"", "\"fingerprint\": \"0");
  refused("\"fingerprint\"", "\"finger\"");
}

TEST_F(SavedSkeleton, OfAnotherSceneIsRefused) {
  saved();
  shell(R"(awk '/^v /{print "v",$2+27,$3,$4;next}1' $CORNELL >moved.obj
           sed 's/tall_block/tall_clock/' $CORNELL >renamed.obj
           cp $CORNELL copy.obj)");
  expect_told("$S skeleton moved.obj --saved s.json", 2, "another scene than moved.obj");
  expect_told("$S skeleton renamed.obj --saved s.json", 2, "build it again");
  expect_told("$S skeleton $ROOM --saved s.json", 2, "another scene");
  EXPECT_EQ(shell("$S skeleton copy.obj --saved s.json").status, 0);
}

TEST_F(SavedSkeleton, OptionsThatOnlyTheBuildingObeysAreRefused) {
  saved();
  for (const char* option :
       {"--near 0,0,0 --radius 0.5", "--kinds EEE", "--events polygon", "--events solid",
        "--feature-size 1", "--between-boxes 0,0,0,1,1,1 2,2,2,3,3,3",
        "--between tall_block short_block", "--through floor", "--region 0,0,0,9,9,9",
        "--budget-mb 10", "--light floor"}) {
    expect_told("$S skeleton $CORNELL --saved s.json " + std::string(option), 2,
                "excludes");
  }
  expect_told("$S skeleton $CORNELL --saved s.json --perturb 10", 2, "another scene");
  expect_told("$S skeleton $CORNELL --saved s.json -o s.json", 2, "is read");
}

// Every option of the command is refused beside --saved (as above), or obeyed (as below).
TEST_F(SavedSkeleton, EveryOptionIsRefusedOrObeyed) {
  const std::set<std::string> refused{"--events",    "--kinds",         "--between",
                                      "--through",   "--region",        "--near",
                                      "--radius",    "--between-boxes", "--feature-size",
                                      "--budget-mb", "--light"};
  const std::set<std::string> obeyed{
      "--list",      "--seen-from", "--between-ends", "--crossed", "--threads",
      "--precision", "--budget",    "--format",       "--perturb", "--seed"};
  const std::set<std::string> outputs{"--help",   "--json",   "--vtk",
                                      "--extend", "--output", "--saved"};
  std::set<std::string> known;
  for (const auto* some : {&refused, &obeyed, &outputs}) {
    known.insert(some->begin(), some->end());
  }
  const std::string help = shell("$S skeleton --help").out;
  std::set<std::string> told;
  const std::regex option("\n +(?:-.,)?(--[a-z-]+)[ \n]");
  for (auto at = std::sregex_iterator(help.begin(), help.end(), option);
       at != std::sregex_iterator(); ++at) {
    told.insert((*at)[1].str());
  }
  EXPECT_EQ(told, known);
}

// Beside options that are obeyed the answer is that of a new skeleton.
TEST_F(SavedSkeleton, AnswersAsANewSkeletonDoes) {
  const std::vector<std::string> values{"--list",
                                        "--seen-from floor",
                                        "--seen-from outside",
                                        "--between-ends floor outside",
                                        "--between-ends tall_block short_block",
                                        "--crossed 5,20,5 50,25.25,40.5",
                                        "--crossed 1,2,3 30,20,10",
                                        "--threads 1",
                                        "--precision double",
                                        "--budget 60",
                                        "--format obj"};
  std::mt19937 engine(7);
  for (int i = 0; i < 12; ++i) {
    // A part, or a perturbed scene, saved with what it was built with.
    const std::array builds{"--kinds EV", "--kinds EV --events polygon",
                            "--kinds EV --between tall_block short_block"};
    const std::array scenes{"", " --perturb 0.01", " --perturb 0.01 --seed 9"};
    const std::string scene = scenes[engine() % 3];
    const std::string build = std::string(builds[engine() % 3]);
    std::set<std::string> names;
    std::string asked;
    for (int k = 0; k < 1 + i % 4; ++k) {
      const std::string& value = values[engine() % values.size()];
      if (names.insert(value.substr(0, value.find(' '))).second) asked += " " + value;
    }
    const std::string line = "$S skeleton $CORNELL --json - " + scene + asked;
    const Run fresh = shell(line + " -o s.json " + build);
    const Run kept = shell(line + " --saved s.json");
    SCOPED_TRACE(line + " / " + build);
    ASSERT_EQ(fresh.status, 0) << fresh.err;
    ASSERT_EQ(kept.status, 0) << kept.err;
    json a = json::parse(fresh.out), b = json::parse(kept.out);
    EXPECT_EQ(b.at("options").at("saved"), "s.json");
    b["options"].erase("saved");
    for (json* answer : {&a, &b}) {
      for (const char* key : {"seconds", "peak_memory_bytes", "predicates", "checksum"}) {
        answer->erase(key);
      }
    }
    EXPECT_EQ(a, b) << json::diff(a, b).dump().substr(0, 2000);
  }
}

TEST_F(SavedSkeleton, TheAnswerTellsTheOptionsItWasBuiltWith) {
  const auto fresh =
      shell("$S skeleton $CORNELL --kinds EEE --events polygon -o s.json --json -");
  ASSERT_EQ(fresh.status, 0) << fresh.err;
  const auto again = shell("$S skeleton $CORNELL --saved s.json --json -");
  ASSERT_EQ(again.status, 0) << again.err;
  json built = json::parse(fresh.out), kept = json::parse(again.out);
  EXPECT_EQ(kept.at("options").at("saved"), "s.json");
  kept["options"].erase("saved");
  for (const char* key : {"options", "nodes", "arcs", "edges_done", "edges_asked",
                          "skeleton_bytes", "simplified", "complete"}) {
    EXPECT_EQ(kept.at(key), built.at(key)) << key;
  }
}

TEST_F(SavedSkeleton, APartIsStillAPart) {
  EXPECT_EQ(shell("$S skeleton $ROOM --budget-mb 0.05 -o s.json").status, 3);
  const auto r = shell("$S skeleton $ROOM --saved s.json --json -");
  EXPECT_EQ(r.status, 3) << r.err;
  const json j = json::parse(r.out);
  EXPECT_EQ(j.at("complete"), false);
  EXPECT_EQ(j.at("stopped_by"), "megabytes");
  EXPECT_FALSE(j.at("missing").empty());
}

TEST_F(SavedSkeleton, OfAPerturbedSceneIsThatOfTheSameSizeAndSeed) {
  const std::string size = " --perturb 10 --seed 3";
  ASSERT_EQ(shell("$S skeleton $CORNELL --kinds EV -o s.json" + size).status, 0);
  EXPECT_EQ(shell("$S skeleton $CORNELL --saved s.json" + size).status, 0);
  expect_told("$S skeleton $CORNELL --saved s.json", 2, "another scene");
  expect_told("$S skeleton $CORNELL --saved s.json --perturb 10", 2, "another scene");
  EXPECT_EQ(shell("$S view s.json --png p.png --size 64,64").status, 0);
}

TEST_F(SavedSkeleton, FromAnEarlierVersionIsRefusedWithWhatToDo) {
  saved();
  shell("sed 's/^ \"checksum.*/ \"x\": 1/' s.json >old.json; echo '{}' >none.json");
  expect_told("$S skeleton $CORNELL --saved old.json", 2, "build it again");
  expect_told("$S view old.json --png p.png", 2, "build it again");
  expect_told("$S skeleton $CORNELL --saved none.json", 2, "not a saved skeleton");
  expect_told("$S skeleton $CORNELL --saved absent.json", 2, "no such file");
}

TEST_F(SavedSkeleton, IsViewedWithTheSceneBesideIt) {
  shell("mkdir a; cp $CORNELL a/c.obj; cd a; $S skeleton c.obj --kinds EV -o s.json");
  const std::string view = "$S view a/s.json --png p.png --size 64,64";
  EXPECT_EQ(shell(view).status, 0);
  shell("mv a/c.obj elsewhere.obj");
  expect_told(view, 2, "c.obj");
  EXPECT_EQ(shell(view + " --scene elsewhere.obj").status, 0);
  expect_told(view + " --scene $ROOM", 2, "another scene");
}

}  // namespace
