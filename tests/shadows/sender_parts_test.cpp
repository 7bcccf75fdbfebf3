// What is called hidden from a part of a side is seen from no point of it.

#include "shadows/hiding/sender_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "linespace/line_sampling.h"
#include "linespace/occlusion.h"
#include "tests/support/generators.h"

namespace sightline::internal {
namespace {

struct City {
  explicit City(int polygons)
      : scene(testing::street_city(4, polygons)), solids(scene), parts(solids) {}

  [[nodiscard]] PreparedSide side(int face) const {
    return PreparedSide({listed_polygon(scene, face, false), 0});
  }
  /// The faces of a solid: here every object is one.
  [[nodiscard]] const std::vector<int>& faces(int solid) const {
    return scene.objects()[solid].faces;
  }

  Scene scene;
  ConvexSolids solids;
  SenderParts parts;
};

/// Free segments from the part to solids that are called hidden, of so many tried.
int free_segments(const City& city, const OcclusionIndex& index, const SenderPart& part,
                  int tries) {
  const PolygonSampler from(std::vector<PointList>{part.side.polygon});
  int free = 0;
  for (std::size_t s = 0; s < city.solids.size(); ++s) {
    if (!part.hides(static_cast<int>(s))) continue;
    const PolygonSampler to(city.scene, city.faces(static_cast<int>(s)));
    for (int i = 0; i < tries; ++i) {
      SampleNumbers numbers(s, static_cast<std::uint64_t>(i));
      const Point x = from.point(numbers).point, y = to.point(numbers).point;
      if (part.side.plane(y) == Sign::Positive && index.is_free(x, y)) ++free;
    }
  }
  return free;
}

TEST(SenderParts, HiddenSolidsAreSeenFromNoPoint) {
  const City city(900);
  const OcclusionIndex index(city.scene);
  std::ptrdiff_t hidden = 0, solids = 0;
  for (int face = 6; face < static_cast<int>(city.scene.faces().size()); face += 61) {
    for (const SenderPart& part : city.parts.of(city.side(face))) {
      EXPECT_EQ(free_segments(city, index, part, 12), 0) << "face " << face;
      hidden += std::ranges::count(part.hidden, 1);
      solids += static_cast<std::ptrdiff_t>(part.hidden.size());
    }
  }
  EXPECT_GT(hidden, 0.4 * static_cast<double>(solids)) << "of " << solids;
}

TEST(SenderParts, ALargeSideIsCutIntoPartsThatSeeLess) {
  const City city(300);
  const OcclusionIndex index(city.scene);
  int top = -1;
  for (int f = 0; f < 6; ++f) {
    if (std::ranges::all_of(city.scene.face_points(f),
                            [&](int p) { return city.scene.point(p).z() == 0; })) {
      top = f;
    }
  }
  ASSERT_GE(top, 0);
  const PreparedSide ground = city.side(top);
  ASSERT_TRUE(city.parts.is_large(ground));
  const std::vector<SenderPart> parts = city.parts.of(ground);
  EXPECT_GT(parts.size(), 8U);
  double area = 0;
  for (const SenderPart& part : parts) {
    area += part.side.area;
    EXPECT_EQ(free_segments(city, index, part, 4), 0);
  }
  EXPECT_NEAR(area, ground.area, 1e-12 * ground.area);
  EXPECT_FALSE(city.parts.is_large(city.side(20)));
}

}  // namespace
}  // namespace sightline::internal
