// All lines that meet four of 4 to 30 segments, against the naive enumeration.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "linespace/segment_transversals.h"
#include "tests/support/naive_transversals.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using Eigen::Vector3d;
using testing::RandomGeometry;
using testing::Terrain;

testing::Vec3 exact_vector(const Vector3d& p) {
  return {testing::Rational(p.x()), testing::Rational(p.y()), testing::Rational(p.z())};
}

// Side 0: uniform in a cube; otherwise integers from 0 to side - 1.
std::vector<LineThrough> random_segments(RandomGeometry& random, int n, int side) {
  std::vector<LineThrough> out;
  while (static_cast<int>(out.size()) < n) {
    LineThrough l{random.point(Terrain::Uniform), random.point(Terrain::Uniform)};
    if (side > 0) {
      for (Vector3d* p : {&l.from, &l.to}) {
        for (double& x : *p) x = random.integer(0, side - 1);
      }
    }
    if (l.from != l.to) out.push_back(l);
  }
  return out;
}

// "dimension kind" in the naive enumeration's coarser names.
std::set<std::string> naive_names(const testing::NaiveTransversals& t) {
  static const char* const kNames[] = {"pencil", "regulus",    "star",
                                       "plane",  "congruence", "complex"};
  std::set<std::string> out;
  for (const auto& f : t.families) {
    out.insert(kNames[static_cast<int>(f.kind)]);
  }
  return out;
}

void expect_agreement(const std::vector<LineThrough>& s) {
  std::vector<testing::ExactSegment> exact;
  for (const LineThrough& l : s)
    exact.push_back({exact_vector(l.from), exact_vector(l.to)});
  const testing::NaiveTransversals naive = testing::naive_transversals(exact);
  const SegmentTransversals t = transversals_of_segments(s);
  std::multiset<std::vector<int>> expected, found;
  for (const auto& line : naive.lines) expected.insert(line.segments);
  for (std::size_t i = 0; i < t.lines.size(); ++i) {
    const auto met = t.contacts_of(i);
    found.emplace(met.begin(), met.end());
  }
  ASSERT_EQ(found, expected);
  // Kinds that both name alike; joined pencils are pencils, a star with a plane is both.
  std::set<std::string> names;
  for (const auto& f : t.families) {
    const std::string name(family_name(f.kind));
    if (name == "joined_pencils") {
      names.insert("pencil");
    } else if (name == "star_plane") {
      names.insert({"star", "plane"});
    } else {
      names.insert(name);
    }
  }
  const std::set<std::string> naive_kinds = naive_names(naive);
  for (const char* kind : {"regulus", "star", "complex"}) {
    ASSERT_EQ(names.contains(kind), naive_kinds.contains(kind)) << kind;
  }
  ASSERT_EQ(names.empty(), naive_kinds.empty());
}

TEST(SegmentTransversalsOracle, AgreesInGeneralPosition) {
  RandomGeometry random(31);
  for (int round = 0; round < 12; ++round) {
    expect_agreement(random_segments(random, 4 + round % 9, 0));
  }
}

TEST(SegmentTransversalsOracle, AgreesOnGrids) {
  RandomGeometry random(32);
  for (int round = 0; round < 200; ++round) {
    ASSERT_NO_FATAL_FAILURE(
        expect_agreement(random_segments(random, 4 + round % 7, 3 + round % 8)))
        << round;
  }
}

TEST(SegmentTransversalsOracle, AgreesOnManySegmentsOfGrids) {
  RandomGeometry random(33);
  for (int round = 0; round < 4; ++round) {
    ASSERT_NO_FATAL_FAILURE(
        expect_agreement(random_segments(random, round % 4 == 3 ? 30 : 16, 3 + round)))
        << round;
  }
}

}  // namespace
}  // namespace sightline
