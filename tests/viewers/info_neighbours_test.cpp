// `info` of files in which much stands in one place: n copies of a face, n names of one
// group, n faces around an edge or a corner, n objects alike, n shells inside out.  The
// counts are exact, and time and memory near those of the file.

#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/support/shell.h"

namespace {

using nlohmann::json;
using Random = std::mt19937;

/// A file, and what `info` says of it.
struct Described {
  std::string text;
  json defects;
  int faces = 0, groups = 1, faces_of_a_group = 0, boundary = 0, nonmanifold = 0,
      reflex = 0, solids = 0;
};

std::string vertex(int x, int y, int z) {
  return "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) +
         "\n";
}

Described copies(int n, Random& random) {
  Described d{vertex(0, 0, 0) + vertex(4, 0, 0) + vertex(0, 3, 1), json::object(), n};
  for (int i = 0; i < n; ++i) {
    // From any corner.
    const int a = 1 + static_cast<int>(random() % 3), b = a % 3 + 1;
    d.text += "f " + std::to_string(a) + " " + std::to_string(b) + " " +
              std::to_string(b % 3 + 1) + "\n";
  }
  d.defects["duplicate face"] = n - 1;
  d.faces_of_a_group = 1;  // a face counts once in its object
  d.boundary = 3;
  return d;
}

Described names_of_one_group(int n, Random& random) {
  Described d{"g", json::object()};
  for (int i = 0; i < n; ++i) d.text += " n" + std::to_string(i);
  d.text += "\n";
  d.faces = 1 + static_cast<int>(random() % 20);
  for (int i = 0; i < d.faces; ++i) {
    d.text += vertex(2 * i, 0, 0) + vertex(2 * i, 1, 0) + vertex(2 * i + 1, 0, 1) +
              "f -3 -2 -1\n";
  }
  d.groups = n;
  d.faces_of_a_group = d.faces;
  d.boundary = 3 * d.faces;
  return d;
}

Described around_an_edge(int n, Random& random) {
  Described d{vertex(0, 0, 0) + vertex(0, 0, 8), json::object(), n};
  int k = static_cast<int>(random() % 100) - 50;
  for (int i = 0; i < n; ++i) {
    d.text += vertex(k, 1000, 4) + (random() % 2 == 0 ? "f 1 2 -1\n" : "f 2 1 -1\n");
    k += 1 + static_cast<int>(random() % 3);
  }
  d.defects["non-manifold edge"] = 1;
  d.faces_of_a_group = n;
  d.boundary = 2 * n;
  d.nonmanifold = 1;
  return d;
}

Described around_a_corner(int n, Random& random) {
  Described d{vertex(0, 0, 0), json::object(), n};
  int k = 0;
  for (int i = 0; i < n; ++i) {
    const int next = k + 1 + static_cast<int>(random() % 3);
    d.text += vertex(k, 1000, 1) + vertex(next, 1000, 1) + "f 1 -2 -1\n";
    k = next + 1;
  }
  d.faces_of_a_group = n;
  d.boundary = 3 * n;
  return d;
}

Described objects_alike(int n, Random& random) {
  Described d{vertex(0, 0, 0) + vertex(4, 0, 0) + vertex(0, 3, 1), json::object(), n};
  const std::string word = random() % 2 == 0 ? "o n" : "g n";
  for (int i = 0; i < n; ++i) d.text += word + std::to_string(i) + "\nf 1 2 3\n";
  d.defects["duplicate face"] = n - 1;
  d.groups = n;
  d.faces_of_a_group = 1;
  d.boundary = 3 * n;
  return d;
}

Described inside_out(int n, Random& random) {
  Described d{"", json::object(), 4 * n};
  for (int i = 0; i < n; ++i) {
    const int x = 3 * i, y = static_cast<int>(random() % 3);
    d.text += vertex(x, y, 0) + vertex(x + 1, y, 0) + vertex(x, y + 1, 0) +
              vertex(x, y, 1) + "f -4 -3 -2\nf -4 -1 -3\nf -4 -2 -1\nf -3 -1 -2\n";
  }
  d.groups = n;  // a shell each
  d.faces_of_a_group = 4;
  d.defects["inside-out"] = n;
  d.reflex = 6 * n;
  d.solids = n;
  return d;
}

const std::vector<std::function<Described(int, Random&)>> kKinds{
    copies,          names_of_one_group, around_an_edge,
    around_a_corner, objects_alike,      inside_out};

class InfoNeighbours : public sightline::test::Shell {
 protected:
  /// Within this processor time, in seconds.
  json info(const Described& d, int seconds) {
    std::ofstream(folder_ / "x.obj") << d.text;
    const Run r =
        shell("ulimit -t " + std::to_string(seconds) + "; $S info x.obj --json -");
    EXPECT_EQ(r.status, 0) << r.err;
    return json::parse(r.out, nullptr, false);
  }

  static void expect_described(const json& j, const Described& d) {
    ASSERT_FALSE(j.is_discarded());
    EXPECT_EQ(j.at("defect_counts"), d.defects);
    EXPECT_EQ(j.at("faces"), d.faces);
    EXPECT_EQ(j.at("groups").size(), static_cast<std::size_t>(d.groups));
    EXPECT_EQ(j.at("edges").at("boundary"), d.boundary);
    EXPECT_EQ(j.at("edges").at("nonmanifold"), d.nonmanifold);
    EXPECT_EQ(j.at("edges").at("reflex"), d.reflex);
    EXPECT_EQ(j.at("solids"), d.solids);
    for (const json& group : j.at("groups")) {
      EXPECT_EQ(group.at("faces"), d.faces_of_a_group);
    }
  }
};

TEST_F(InfoNeighbours, CountsAreExact) {
  for (unsigned seed = 0; seed < 102; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const int n = 30 + static_cast<int>(random() % 300);
    const Described d = kKinds[seed % kKinds.size()](n, random);
    expect_described(info(d, 10), d);
  }
}

// 20,000 and 40,000 of them: in the seconds and megabytes of a file of that size.
TEST_F(InfoNeighbours, CostsAreNearThoseOfTheFile) {
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    SCOPED_TRACE(kind);
    std::array<double, 2> bytes{};
    for (const int size : {0, 1}) {
      Random random(1);
      const Described d = kKinds[kind](20'000 << size, random);
      const json j = info(d, 20);
      expect_described(j, d);
      bytes[static_cast<std::size_t>(size)] = j.at("peak_memory_bytes");
    }
    EXPECT_LT(bytes[1], 400e6);
    EXPECT_LT(bytes[1], 2.5 * bytes[0]);
  }
}

}  // namespace
