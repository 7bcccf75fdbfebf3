// Feature size for shadows: what is left out, and the bound of what that changes.  From
// the environment: SIGHTLINE_LEFT_OUT_POINTS, points a scene.

#include "shadows/small_blockers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "shadows/backprojection.h"
#include "tests/support/add_box.h"
#include "tests/support/add_polygons.h"
#include "tests/support/random_geometry.h"

namespace sightline::testing {
namespace {

const std::vector<std::string> kLamp{"lamp"};

int points_a_scene() {
  const char* text = std::getenv("SIGHTLINE_LEFT_OUT_POINTS");
  return text == nullptr ? 300 : std::atoi(text);
}

std::vector<std::string> names_of(const std::vector<SmallPart>& parts) {
  std::vector<std::string> names;
  for (const SmallPart& part : parts) {
    for (const int p : part.polygons)
      names.push_back("#" + std::to_string(p) + "-" + std::to_string(p));
  }
  return names;
}

// All objects but the lamp, without what is left out.
std::vector<Receiver> receivers_of(const Scene& scene,
                                   const std::vector<SmallPart>& parts) {
  std::vector<std::uint8_t> out(scene.faces().size(), 0);
  for (const SmallPart& part : parts) {
    for (const int f : part.faces) out[f] = 1;
  }
  std::vector<Receiver> receivers;
  for (const Object& object : scene.objects()) {
    if (object.name == "lamp") continue;
    Receiver receiver{object.name, {}, true};
    std::ranges::copy_if(object.faces, std::back_inserter(receiver.faces),
                         [&](int f) { return out[f] == 0; });
    if (!receiver.faces.empty()) receivers.push_back(receiver);
  }
  return receivers;
}

// A lamp over houses on a ground, and small boxes: standing, flying, alone or many in a
// group, some touching houses.
PolygonSoup small_city(std::uint64_t seed) {
  RandomGeometry random(seed);
  PolygonSoup soup = lamp_and_ground();
  for (int i = 0; i < 4; ++i) {
    const Point low(random.uniform(-7, 5), random.uniform(-7, 5), 0);
    add_box(
        soup, ("house" + std::to_string(i)).c_str(), low,
        low + Point(random.uniform(1, 2), random.uniform(1, 2), random.uniform(1, 3)));
  }
  PolygonSoup::Group many{"many", {}};
  for (int i = 0; i < 12; ++i) {
    const double size = random.uniform(0.05, 0.3);
    Point low(random.uniform(-6, 6), random.uniform(-6, 6),
              random.one_in(2) ? 0 : random.uniform(0, 3));
    if (random.one_in(4)) low = soup.vertices[random.integer(8, 39)];
    add_box(soup, "", low, low + size * Point(1, random.uniform(0.5, 1), 1));
    const auto& faces = soup.groups.back().faces;
    many.faces.insert(many.faces.end(), faces.begin(), faces.end());
    soup.groups.pop_back();
  }
  soup.groups.push_back(many);
  return soup;
}

// Points of the receivers, and a largest difference that is seen; checks the bound.
double largest_difference(const Scene& scene, const std::vector<SmallPart>& parts,
                          double bound, std::uint64_t seed, int count) {
  const LightSource light = light_source(scene, kLamp);
  const Scene rest = scene_without(scene, names_of(parts));
  const BackprojectionIndex whole(scene, light);
  const BackprojectionIndex less(rest, light_source(rest, kLamp));
  RandomGeometry random(seed);
  const std::vector<Receiver> receivers = receivers_of(scene, parts);
  double most = 0;
  for (int i = 0; i < count; ++i) {
    const int last = static_cast<int>(receivers.size()) - 1;
    const Receiver& receiver = receivers[random.one_in(2) ? 0 : random.integer(0, last)];
    const int f =
        receiver.faces[random.integer(0, static_cast<int>(receiver.faces.size()) - 1)];
    const auto corners = scene.face_points(f);
    Point p = Point::Zero();
    double weights = 0;
    for (const int c : corners) {
      const double w = -std::log(random.uniform(1e-9, 1));
      p += w * scene.point(c);
      weights += w;
    }
    p /= weights;
    if (random.one_in(3)) {  // near a small part
      const SmallPart& part =
          parts[random.integer(0, static_cast<int>(parts.size()) - 1)];
      const Point& at = scene.point(scene.face_points(part.faces[0])[0]);
      p = Point(at.x() + random.uniform(-0.4, 0.4), at.y() + random.uniform(-0.4, 0.4),
                0);
      if (std::abs(p.x()) > 8 || std::abs(p.y()) > 8) continue;
    }
    const ShadowPoint asked = shadow_point_on_face(
        scene, p.z() == 0 ? scene.faces_named("ground")[0] : f, p, true);
    const double difference =
        *less.from(asked).form_factor - *whole.from(asked).form_factor;
    EXPECT_GE(difference, -1e-12) << seed << " at " << p.transpose();
    EXPECT_LE(difference, bound + 1e-12) << seed << " at " << p.transpose();
    most = std::max(most, difference);
  }
  return most;
}

TEST(SmallBlockers, TheBoundHolds) {
  int above = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Scene scene(small_city(seed));
    const LightSource light = light_source(scene, kLamp);
    for (const double size : {0.3, 0.6}) {
      const auto parts = small_parts(scene, size, light.faces);
      if (parts.empty()) continue;
      const double bound =
          left_out_bound(scene, light, receivers_of(scene, parts), parts);
      EXPECT_GT(bound, 0);
      EXPECT_LT(bound, 0.1) << "no point of the ground gets more from this lamp";
      if (largest_difference(scene, parts, bound, seed, points_a_scene()) > 1e-4) ++above;
    }
  }
  EXPECT_GE(above, 8) << "the points are where something changes";
}

// Cubes that fly apart from each other and from the ground, before a lamp that is larger
// than they are: the bound is at most four times what is seen.
TEST(SmallBlockers, TheBoundIsNearWhereBlockersAreFarApart) {
  PolygonSoup soup = lamp_and_ground();
  for (int i = 0; i < 9; ++i) {
    const Point low(-6 + i % 3 * 5.5, -6 + i / 3 * 5.5, 1);
    add_box(soup, ("cube" + std::to_string(i)).c_str(), low,
            low + Point(0.25, 0.25, 0.25));
  }
  const Scene scene(soup);
  const LightSource light = light_source(scene, kLamp);
  const auto parts = small_parts(scene, 0.5, light.faces);
  ASSERT_EQ(parts.size(), 9U);
  const double bound = left_out_bound(scene, light, receivers_of(scene, parts), parts);
  const double seen = largest_difference(scene, parts, bound, 1, 4000);
  EXPECT_GT(seen, 0);
  EXPECT_LT(bound, 4 * seen);

  std::cout << "bound " << bound << ", seen " << seen << '\n';
}

TEST(SmallBlockers, TheMeshShrinks) {
  const Scene scene(small_city(3));
  const LightSource light = light_source(scene, kLamp);
  EXPECT_TRUE(small_parts(scene, 0, light.faces).empty());
  std::size_t last = 0;
  for (const double size : {0.6, 0.35, 0.0}) {
    const auto parts = small_parts(scene, size, light.faces);
    const Scene rest = scene_without(scene, names_of(parts));
    const Shadows shadows = find_shadows(rest, light_source(rest, kLamp),
                                         {{"ground", rest.faces_named("ground"), true}});
    const std::size_t edges = shadows.receivers[0].meshes[0].edges.size();
    EXPECT_GT(edges, last) << size;
    last = edges;
  }
}

// ---- what is left out -----------------------------------------------------------------

TEST(SmallBlockers, SourcesReceiversAndHollowsAreKept) {
  PolygonSoup soup;
  add_polygons(soup, "lamp", {{{-.1, -.1, 4}, {-.1, .1, 4}, {.1, .1, 4}, {.1, -.1, 4}}});
  add_box(soup, "wall", {-2, -2, 0}, {2, 2, 1});
  add_box(soup, "hollow", {-0.1, -0.1, 0.4}, {0.1, 0.1, 0.6});
  for (const int f : soup.groups.back().faces) std::ranges::reverse(soup.polygons[f]);
  add_box(soup, "named", {3, 3, 0}, {3.1, 3.1, 0.1});
  add_box(soup, "small", {4, 4, 0}, {4.1, 4.1, 0.1});
  const Scene scene(soup);
  std::vector<int> kept = scene.faces_named("lamp");
  const auto named = scene.faces_named("named");
  kept.insert(kept.end(), named.begin(), named.end());
  const auto parts = small_parts(scene, 1, kept);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(scene.objects()[parts[0].object].name, "small");
  EXPECT_EQ(parts[0].polygons.size(), 6U);
  EXPECT_NEAR(parts[0].diagonal, std::sqrt(0.03), 1e-12);
  EXPECT_THROW((void)small_parts(scene, -1, kept), InvalidInput);
  EXPECT_THROW((void)small_parts(scene, std::nan(""), kept), InvalidInput);
}

TEST(SmallBlockers, TheDiagonalIsComparedExactly) {
  PolygonSoup soup = lamp_and_ground();
  add_box(soup, "box", {0, 0, 1}, {1, 2, 3});
  const Scene scene(soup);
  EXPECT_TRUE(small_parts(scene, 3, scene.faces_named("lamp")).empty()) << "not shorter";
  EXPECT_EQ(small_parts(scene, std::nextafter(3, 4), scene.faces_named("lamp")).size(),
            1U);
}

// A closed box and a sheet in one group, which is not closed: the box is a solid only
// without the sheet, so they go together or not at all.
TEST(SmallBlockers, PartsOfAnOpenGroupStayTogether) {
  PolygonSoup soup = lamp_and_ground();
  add_box(soup, "mixed", {0, 0, 1}, {2, 2, 2});
  const int f = static_cast<int>(soup.polygons.size());
  add_polygons(soup, "", {{{3, 3, 1}, {3.1, 3, 1}, {3.1, 3.1, 1}}});
  soup.groups.pop_back();
  soup.groups.back().faces.push_back(f);
  const Scene scene(soup);
  EXPECT_TRUE(small_parts(scene, 1, scene.faces_named("lamp")).empty());
  EXPECT_EQ(small_parts(scene, 9, scene.faces_named("lamp")).size(), 1U);
}

TEST(SmallBlockers, WhatCannotBeInTheWayChangesNothing) {
  PolygonSoup soup = lamp_and_ground();
  add_box(soup, "above", {0, 0, 5}, {0.1, 0.1, 5.1});
  add_box(soup, "below", {0, 0, -2}, {0.1, 0.1, -1.9});
  add_box(soup, "aside", {30, 30, 1}, {30.1, 30.1, 1.1});
  const Scene scene(soup);
  const LightSource light = light_source(scene, kLamp);
  const auto parts = small_parts(scene, 1, light.faces);
  EXPECT_EQ(parts.size(), 3U);
  EXPECT_EQ(left_out_bound(scene, light, {{"ground", scene.faces_named("ground"), true}},
                           parts),
            0);
}

// At the foot of a small box next to which the lamp stands straight above: no bound but
// that of the lamp itself, which is what the middle of the ground gets.
TEST(SmallBlockers, WhatTouchesAReceiverIsBoundedByTheSource) {
  PolygonSoup soup = lamp_and_ground();
  add_box(soup, "box", {0, 0, 0}, {0.1, 0.1, 0.1});
  const Scene scene(soup);
  const LightSource light = light_source(scene, kLamp);
  const auto parts = small_parts(scene, 1, light.faces);
  const double bound = left_out_bound(
      scene, light, {{"ground", scene.faces_named("ground"), true}}, parts);
  const double open = *BackprojectionIndex(scene, light)
                           .from(shadow_point({-1e-9, -1e-9, 0}, {0, 0, 1}))
                           .form_factor;
  EXPECT_GE(bound, open / 2);
  EXPECT_NEAR(bound, 0.0744, 0.006) << "some 2 * 2 / (pi * 4 * 4) and a little less";
}

}  // namespace
}  // namespace sightline::testing
