// Areas of umbra, penumbra, lit region and what faces away against naive integration
// along scan lines and polygons in rationals.  mesh_proof_soak looks at all small scenes.

#include "tests/shadows/mesh_proof/mesh_areas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shadows/shadow_mesh.h"
#include "tests/shadows/mesh_proof/small_lit_scenes.h"
#include "tests/support/add_polygons.h"
#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

Shadows shadows_of(const Scene& scene, const ShadowScene& lit) {
  std::vector<Receiver> receivers;
  for (const Object& o : scene.objects()) receivers.push_back({o.name, o.faces, true});
  return find_shadows(scene, light_source(scene, lit.lights, lit.two_sided), receivers);
}

TEST(MeshAreas, AlongScanLines) {
  const auto scenes = small_lit_scenes();
  for (const std::size_t i : {0, 1, 2}) {
    const GroundAreas areas = ground_areas(scenes[i]);
    EXPECT_LT(areas.off, 1e-9) << scenes[i].name;
    EXPECT_GT(areas.right.asked, 100);
  }
}

// The area of all of a receiver's faces; nullopt where some face is not told.
std::optional<double> exact_lit(std::span<const NaiveShadowFace> faces,
                                const std::vector<int>& receiver) {
  double sum = 0;
  for (const int f : receiver) {
    const auto part = naive_lit_area(faces, f);
    if (!part) return std::nullopt;
    sum += static_cast<double>(part->plane) * part->factor;
  }
  return sum;
}

TEST(MeshAreas, LitAndAwayInRationals) {
  int lit_receivers = 0, all = 0;
  std::vector<ShadowScene> scenes = small_lit_scenes();
  for (ShadowScene& s : shadow_scenes()) scenes.push_back(std::move(s));
  for (const ShadowScene& lit : scenes) {
    const Scene scene(lit.soup);
    const auto faces = naive_shadow_faces(scene, faces_of_groups(scene, lit.lights),
                                          faces_of_groups(scene, lit.two_sided));
    const Shadows shadows = shadows_of(scene, lit);
    for (std::size_t i = 0; i < shadows.receivers.size(); ++i) {
      const ReceiverShadows& r = shadows.receivers[i];
      const std::vector<int>& own = scene.objects()[i].faces;
      SCOPED_TRACE(lit.name + ", " + r.name);
      EXPECT_NEAR(r.umbra_area + r.penumbra_area + r.lit_area, r.area, 1e-12 * r.area);
      double away = 0, area = 0;
      for (const int f : own) {
        const NaiveRationalArea part = naive_away_area(faces, f);
        away += static_cast<double>(part.plane) * part.factor;
        const auto whole = [&] {
          std::vector<NaiveShadowFace> alone{faces[f]};
          alone[0].source = false;
          return naive_away_area(alone, 0);
        }();
        area += static_cast<double>(whole.plane) * whole.factor;
      }
      // Of one object, faces may lie on one another.
      if (std::abs(area - r.area) > 1e-12 * area) continue;
      ++all;
      EXPECT_NEAR(r.away_area, away, 1e-13 * r.area);
      if (const auto right = exact_lit(faces, own)) {
        ++lit_receivers;
        EXPECT_NEAR(r.lit_area, *right, 1e-13 * r.area);
      }
    }
  }
  EXPECT_GT(all, 200);
  EXPECT_GT(lit_receivers, 60);
}

// A rectangle over a parallel one.  Through a side of the light at height H and one of
// the blocker at h a plane meets the ground at (H b - h a) / (H - h): the umbra lies
// between the planes of like sides, the penumbra's outline is where those of unlike ones
// pass.
TEST(MeshAreas, RectangleUnderARectangle) {
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const double top = random.uniform(3, 5), h = random.uniform(0.5, 2.5);
    const double a = random.uniform(0.2, 1), b = random.uniform(0.2, 1);  // light
    const double c = random.uniform(0.5, 1.5), d = random.uniform(0.5, 1.5);
    ShadowScene lit{"", {}, {"lamp"}, {}};
    add_polygons(lit.soup, "ground",
                 {{{-16, -16, 0}, {16, -16, 0}, {16, 16, 0}, {-16, 16, 0}}});
    add_polygons(lit.soup, "lamp",
                 {{{-a, -b, top}, {-a, b, top}, {a, b, top}, {a, -b, top}}});
    add_polygons(lit.soup, "plate", {{{-c, -d, h}, {c, -d, h}, {c, d, h}, {-c, d, h}}});
    const Shadows shadows = shadows_of(Scene(lit.soup), lit);
    const ReceiverShadows& ground = shadows.receivers.at(0);
    const auto through = [&](double light, double blocker) {
      return (top * blocker - h * light) / (top - h);
    };
    const double umbra = 4 * std::max(0.0, through(a, c)) * std::max(0.0, through(b, d));
    const double outline = 4 * through(-a, c) * through(-b, d);
    EXPECT_NEAR(ground.umbra_area, umbra, 1e-12 * ground.area);
    EXPECT_NEAR(ground.penumbra_area, outline - umbra, 1e-12 * ground.area);
    EXPECT_NEAR(ground.lit_area, 1024 - outline, 1e-12 * ground.area);
    EXPECT_EQ(ground.umbra_components, umbra > 0 ? 1 : 0);
  }
}

}  // namespace
}  // namespace sightline::testing
