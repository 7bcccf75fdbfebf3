// Boxes in rows, at any power of two, along any axis: whether the first sees the last is
// known by construction.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "linespace/face_visibility.h"
#include "linespace/polygon_visibility.h"
#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

struct Row {
  PolygonSoup soup;  ///< groups box0, ..., box<n-1>
  int last = 0;
  bool visible = false;
  int exponent = 0;
};

/// 3 to 9 boxes along x, standing on z = 0.  Either one between the ends covers all that
/// they are across x, or all between are lower than both, or stand beside both.
Row row_of_boxes(std::uint64_t seed) {
  Random random(seed);
  Row row;
  const int count = random.integer(3, 9);
  row.last = count - 1;
  row.visible = random.one_in(2);
  const int cover = random.integer(1, count - 2);
  // Faces back to back see through to both sides, so that the one box between two others
  // hides nothing if it touches both.
  const bool touching = count > 3 && random.one_in(3);
  std::vector<AlignedBox> boxes;
  double x = 0;
  for (int i = 0; i < count; ++i) {
    const double length = random.integer(1, 3);
    AlignedBox box{{x, 0, 0}, {x + length, 4, 8}};
    const bool end = i == 0 || i == count - 1;
    if (end) {
      box.min[1] = random.integer(0, 1);
      box.max[1] = random.integer(2, 4);
      box.max[2] = random.integer(5, 8);
    } else if (row.visible && random.one_in(2)) {
      box.max[2] = random.integer(1, 4);  // lower than both
    } else if (row.visible || i != cover) {
      box.min[1] = random.integer(4, 6);  // beside both, perhaps flush with one
      box.max[1] = box.min[1] + random.integer(1, 3);
    }
    boxes.push_back(box);
    x += length + (touching ? 0 : random.integer(i == 0 ? 1 : 0, 2));
  }
  row.soup = boxes_soup(boxes);
  row.exponent = random.integer(-130, 130);
  const int turn = random.integer(0, 2);
  const bool mirrored = random.one_in(2);
  for (Point& p : row.soup.vertices) {
    p = std::ldexp(1.0, row.exponent) *
        Point(p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]);
    if (mirrored) p[turn] = -p[turn];
  }
  if (mirrored) {
    for (auto& polygon : row.soup.polygons) std::ranges::reverse(polygon);
  }
  return row;
}

TEST(VisibilityRows, OfBoxesAreDecidedAtAnyScale) {
  int visible = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const Row row = row_of_boxes(seed);
    const Scene scene(row.soup);
    const FaceVisibility faces(scene);
    const auto first = scene.faces_named("box0");
    const auto last = scene.faces_named("box" + std::to_string(row.last));
    const GroupAnswer answer = faces.between(first, last, false);
    EXPECT_EQ(answer.verdict, row.visible ? Verdict::Visible : Verdict::Hidden);
    EXPECT_LT(answer.cost.cells, 2'000) << "2^" << row.exponent;
    EXPECT_EQ(faces.between(last, first, false).verdict, answer.verdict);
    visible += row.visible ? 1 : 0;
  }
  EXPECT_GT(visible, 60);
  EXPECT_LT(visible, 140);
}

// The same row, at every tenth power of two: the same verdict for the same effort.
TEST(VisibilityRows, CostTheSameAtAnyScale) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Row row = row_of_boxes(seed);
    std::int64_t cells = -1;
    for (int exponent = -130; exponent <= 130; exponent += 65) {
      PolygonSoup soup = row.soup;
      for (Point& p : soup.vertices) p *= std::ldexp(1.0, exponent - row.exponent);
      const Scene scene(soup);
      const GroupAnswer answer = FaceVisibility(scene).between(
          scene.faces_named("box0"), scene.faces_named("box" + std::to_string(row.last)),
          false);
      EXPECT_EQ(answer.verdict, row.visible ? Verdict::Visible : Verdict::Hidden);
      if (cells < 0) cells = answer.cost.cells;
      EXPECT_EQ(answer.cost.cells, cells) << exponent;
    }
  }
}

// Beyond the range of coordinates a scene is refused, and a question too.
TEST(VisibilityRows, BeyondTheRangeAreRefused) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Row row = row_of_boxes(seed);
    const int exponent = (seed % 2 == 0 ? 141 : -150) * (seed % 3 == 0 ? 3 : 1);
    for (Point& p : row.soup.vertices) p *= std::ldexp(1.0, exponent - row.exponent);
    EXPECT_THROW((void)Scene(row.soup), InvalidInput);
    const auto corners = [&](std::size_t f) {
      Polygon polygon;
      for (const int v : row.soup.polygons[f]) polygon.push_back(row.soup.vertices[v]);
      return polygon;
    };
    EXPECT_THROW((void)polygon_visibility({corners(0), corners(7), {corners(13)}}),
                 InvalidInput);
  }
}

}  // namespace
}  // namespace sightline::testing
