// `sightline skeleton --events polygon` as scripts meet it: counts, lists, saved files.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kCornell = std::string(SIGHTLINE_EXAMPLES) + "/scenes/cornell.obj";

/// The answer of `sightline skeleton cornell.obj` with further arguments.
json skeleton(const std::string& arguments) {
  const std::string command = std::string(SIGHTLINE_PROGRAM) + " skeleton " + kCornell +
                              " --json - " + arguments + " 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  char part[4096];
  for (std::size_t n; (n = fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, n);
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command;
  return json::parse(text);
}

json without_end(json counts) {
  counts.erase("end");
  return counts;
}

/// A listed contact is an end contact; each contact says one or the other.
bool is_end(const json& generator) {
  const std::string contact = generator.at("contact");
  EXPECT_TRUE(contact == "graze" || contact == "end") << contact;
  return contact == "end";
}

TEST(CliPolygon, WhatGrazesIsCountedAsInSolidMode) {
  const json solid = skeleton("");
  const json polygon = skeleton("--events polygon");
  EXPECT_EQ(without_end(polygon.at("nodes")), without_end(solid.at("nodes")));
  EXPECT_EQ(without_end(polygon.at("arcs")), without_end(solid.at("arcs")));
  for (const char* kind : {"VV", "VEE", "EVE", "EEEE", "FvE", "FEE"}) {
    const auto of_solid = solid.at("nodes").at("end").value(kind, 0);
    EXPECT_GE(polygon.at("nodes").at("end").value(kind, 0), of_solid) << kind;
  }
  EXPECT_GT(polygon.at("arcs").at("end").at("EV"), 100);
  EXPECT_GT(polygon.at("arcs").at("end").at("EEE"), 100);
  EXPECT_FALSE(solid.at("arcs").contains("end"));
}

TEST(CliPolygon, EachContactOfAListSaysWhetherTheLineEndsThere) {
  const json j = skeleton("--events polygon --list");
  int ev = 0, eee = 0, nodes = 0;
  for (const json& arc : j.at("list").at("arcs")) {
    if (arc.contains("edges")) {
      const json& edges = arc.at("edges");
      eee += is_end(edges[0]) || is_end(edges[2]);
      EXPECT_FALSE(is_end(edges[1]));
    } else {
      const bool at_vertex = is_end(arc.at("vertex"));
      ev += is_end(arc.at("edge")) || at_vertex;
    }
  }
  int without = 0;
  for (const json& node : j.at("list").at("nodes")) {
    int ends = 0;
    for (const json& generator : node.at("generators")) ends += is_end(generator);
    if (node.value("end", false)) {
      (ends > 0 ? nodes : without) += 1;
    } else {
      EXPECT_EQ(ends, 0) << node;
    }
  }
  EXPECT_EQ(j.at("arcs").at("end").at("EV").get<int>() +
                j.at("arcs").at("end").at("EV_self").get<int>(),
            ev);
  EXPECT_EQ(j.at("arcs").at("end").at("EEE").get<int>() +
                j.at("arcs").at("end").at("EEE_self").get<int>(),
            eee);
  EXPECT_GT(nodes, 100);
  // Degenerate lines that graze everywhere, at which only arcs with an end contact end.
  EXPECT_LT(without, 20);
}

TEST(CliPolygon, ASavedSkeletonKeepsItsEndContacts) {
  const fs::path saved =
      fs::temp_directory_path() / ("sightline-polygon-" + std::to_string(getpid()));
  const json all = skeleton("--events polygon -o " + saved.string());
  const json again = skeleton("--saved " + saved.string());
  EXPECT_EQ(again.at("nodes"), all.at("nodes"));
  EXPECT_EQ(again.at("arcs"), all.at("arcs"));
  fs::remove(saved);
}

}  // namespace
