#include "linespace/nearest_name.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace {

using sightline::did_you_mean;
using sightline::edit_distance;
using sightline::nearest_name;
using Names = std::vector<std::string>;

// The definition, by recursion on the last characters.
std::size_t naive_distance(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const std::string_view a1 = a.substr(0, a.size() - 1), b1 = b.substr(0, b.size() - 1);
  std::size_t least = std::min({naive_distance(a1, b) + 1, naive_distance(a, b1) + 1,
                                naive_distance(a1, b1) + (a.back() == b.back() ? 0 : 1)});
  if (a1.size() > 0 && b1.size() > 0 && a.back() == b1.back() && a1.back() == b.back()) {
    least = std::min(
        least,
        naive_distance(a1.substr(0, a1.size() - 1), b1.substr(0, b1.size() - 1)) + 1);
  }
  return least;
}

TEST(EditDistance, IsTheRecursiveDefinition) {
  std::mt19937 engine(1);
  const auto word = [&] {
    std::string text(engine() % 6, ' ');
    for (char& c : text) c = static_cast<char>('a' + engine() % 3);
    return text;
  };
  for (int i = 0; i < 2000; ++i) {
    const std::string a = word(), b = word();
    EXPECT_EQ(edit_distance(a, b), naive_distance(a, b)) << a << " " << b;
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << " " << b;
  }
}

TEST(NearestName, IsWhatTheFingersMissed) {
  const Names commands{"analyse", "info", "skeleton", "stab", "view", "visible"};
  EXPECT_EQ(nearest_name("skelton", commands), "skeleton");
  EXPECT_EQ(nearest_name("analyze", commands), "analyse");
  EXPECT_EQ(nearest_name("ifno", commands), "info");
  EXPECT_EQ(nearest_name("VIEW", commands), "view");
  EXPECT_EQ(nearest_name("frobnicate", commands), std::nullopt);
  EXPECT_EQ(nearest_name("", commands), std::nullopt);
  EXPECT_EQ(nearest_name("x", {}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), commands), std::nullopt);
  EXPECT_EQ(did_you_mean("vew", commands), "; did you mean 'view'?");
  EXPECT_EQ(did_you_mean("frobnicate", commands), "");
}

}  // namespace
