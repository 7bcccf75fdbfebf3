// Pictures: what is in front hides, what is culled does not, and PNG bytes are a PNG.

#include "viewers/picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "viewers/clip.h"
#include "viewers/page.h"

namespace sightline::viewers {
namespace {

using Box = std::array<Point, 2>;

constexpr Colour kRed{1, 0, 0}, kGreen{0, 1, 0}, kBlue{0, 0, 1};

/// Looks down the z axis from z = 10 at the square [-4, 4]^2.
Camera from_above() { return {{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.7}; }

PictureOptions plain() {
  PictureOptions options;
  options.width = options.height = 64;
  options.samples = 1;
  options.ambient_occlusion = false;
  return options;
}

/// A triangle around the z axis at height z, counter-clockwise seen from above.
PaintedTriangle triangle_at(double z, const Colour& colour, int id) {
  return {{Point(-2, -2, z), Point(2, -2, z), Point(0, 3, z)}, colour, false, id};
}

std::array<int, 3> centre(const Image& image) {
  const std::size_t i =
      3 * (static_cast<std::size_t>(image.height / 2) * image.width + image.width / 2);
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

TEST(Picture, NearerTrianglesHideWhateverTheOrder) {
  Drawing drawing;
  drawing.triangles = {triangle_at(1, kRed, 1), triangle_at(0, kGreen, 2)};
  const auto first = centre(render(drawing, from_above(), plain()));
  std::swap(drawing.triangles[0], drawing.triangles[1]);
  const auto second = centre(render(drawing, from_above(), plain()));
  EXPECT_EQ(first, second);
  EXPECT_GT(first[0], 100);
  EXPECT_EQ(first[1], 0);
}

TEST(Picture, BackFacesAreCulledWhenAsked) {
  Drawing drawing;
  PaintedTriangle away = triangle_at(1, kRed, 1);
  std::swap(away.points[0], away.points[1]);
  away.cull_back = true;
  drawing.triangles = {away, triangle_at(0, kGreen, 2)};
  EXPECT_EQ(centre(render(drawing, from_above(), plain()))[0], 0);
}

TEST(Picture, WhatLiesBehindTheEyeIsClipped) {
  Drawing drawing;
  // Reaches from far before the eye to far behind it, and below the eye everywhere.
  drawing.triangles = {
      {{Point(-50, -1, 5), Point(50, -1, 5), Point(0, -1, 40)}, kRed, false, 1}};
  const Camera ahead{{0, 0, 10}, {0, 0, 9}, {0, 1, 0}, 1.2};
  const std::vector<int> ids = visible_ids(drawing, ahead, 64, 64);
  EXPECT_EQ(ids[64 * 5 + 32], -1);  // the sky
  EXPECT_EQ(ids[64 * 60 + 32], 1);  // the ground
}

TEST(Picture, VisibleIdsAreThoseInFront) {
  Drawing drawing;
  drawing.triangles = {triangle_at(0, kGreen, 7), triangle_at(1, kRed, 9)};
  const std::vector<int> ids = visible_ids(drawing, from_above(), 64, 64);
  EXPECT_EQ(ids[64 * 32 + 32], 9);
  EXPECT_EQ(ids[0], -1);
}

TEST(Picture, VeilsBlendWhateverTheOrderAndHideBehindFaces) {
  Drawing drawing;
  const auto veil = [](double z, const Colour& c) {
    const PaintedTriangle t = triangle_at(z, c, 0);
    return VeilTriangle{t.points, c, 0.5F};
  };
  drawing.triangles = {triangle_at(0, {1, 1, 1}, 1)};
  drawing.veils = {veil(1, kRed), veil(2, kBlue), veil(-1, kGreen)};
  const auto first = centre(render(drawing, from_above(), plain()));
  std::swap(drawing.veils[0], drawing.veils[1]);
  EXPECT_EQ(first, centre(render(drawing, from_above(), plain())));
  EXPECT_LT(first[1], first[0]);
  EXPECT_LT(first[1], first[2]);
}

TEST(Picture, StrokesShowFaintlyBehindFacesWhenAsked) {
  Drawing drawing;
  drawing.triangles = {triangle_at(0, {1, 1, 1}, 1)};
  drawing.strokes = {{{Point(-3, 0, -1), Point(3, 0, -1)}, kBlue, 4, 1, 0}};
  const auto hidden = centre(render(drawing, from_above(), plain()));
  drawing.strokes[0].hidden_opacity = 0.5F;
  const auto faint = centre(render(drawing, from_above(), plain()));
  EXPECT_EQ(hidden[0], hidden[2]);
  EXPECT_LT(faint[0], faint[2]);
}

/// The faces of the cube [-1, 1]^3, blue, closed.
Drawing cube() {
  Drawing drawing;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      std::array<Point, 4> p;
      for (int i = 0; i < 4; ++i) {
        p[i][axis] = side;
        p[i][(axis + 1) % 3] = side * (i == 1 || i == 2 ? 1 : -1);
        p[i][(axis + 2) % 3] = i >= 2 ? 1 : -1;
      }
      drawing.triangles.push_back({{p[0], p[1], p[2]}, kBlue, true, axis, true});
      drawing.triangles.push_back({{p[0], p[2], p[3]}, kBlue, true, axis, true});
    }
  }
  return drawing;
}

const Box kLowerHalf{Point(-3, -3, -3), Point(3, 3, 0.25)};

TEST(Cut, ASolidCutOpenShowsTheCut) {
  const Drawing half = clipped(cube(), kLowerHalf);
  ASSERT_TRUE(half.cut);
  const Colour& c = half.cut->colour;
  const auto seen = centre(render(half, from_above(), plain()));
  EXPECT_NEAR(seen[0], 255 * c.red, 1);
  EXPECT_NEAR(seen[2], 255 * c.blue, 1);
  EXPECT_EQ(visible_ids(half, from_above(), 64, 64)[64 * 32 + 32], -1);
  // As far as the cube reaches and no farther: 2 of the 7.3 units that the picture shows.
  Drawing filled = half;
  filled.cut->colour = kGreen;
  const Image image = render(filled, from_above(), plain());
  int green = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    green += image.rgb[i] == 0 && image.rgb[i + 1] == 255;
  }
  const double side = 64 * 2 / (2 * std::tan(0.35) * 9.75);
  EXPECT_NEAR(green, side * side, 2 * side);
}

TEST(Cut, HidesWhatIsInsideOfTheSolid) {
  // A sheet within the cube, below the cut.
  Drawing both = cube();
  both.triangles.push_back(triangle_at(-0.5, kRed, 9));
  Drawing half = clipped(both, kLowerHalf);
  half.cut->colour = kGreen;
  EXPECT_EQ(centre(render(half, from_above(), plain()))[1], 255);
  EXPECT_EQ(visible_ids(half, from_above(), 64, 64)[64 * 32 + 32], -1);
}

TEST(Cut, SheetsAndWholeSolidsHaveNone) {
  Drawing sheets = cube();
  for (PaintedTriangle& t : sheets.triangles) t.solid = false;
  Drawing half = clipped(sheets, kLowerHalf);
  half.cut->colour = kGreen;
  EXPECT_NE(centre(render(half, from_above(), plain()))[1], 255);
  Drawing whole = clipped(cube(), {Point(-3, -3, -3), Point(3, 3, 3)});
  whole.cut->colour = kGreen;
  EXPECT_GT(centre(render(whole, from_above(), plain()))[2], 100);
}

TEST(Cut, ASolidThatEndsInTheBoxIsNotCutThere) {
  // Its top is the box's top; then, as a ceiling, its bottom is.
  Drawing below = clipped(cube(), {Point(-3, -3, -3), Point(3, 3, 1)});
  below.cut->colour = kGreen;
  const auto top = centre(render(below, from_above(), plain()));
  EXPECT_EQ(top[1], 0);
  EXPECT_GT(top[2], 100);
  Drawing above = clipped(cube(), {Point(-3, -3, -3), Point(3, 3, -1)});
  above.cut->colour = kGreen;
  EXPECT_GT(centre(render(above, from_above(), plain()))[0], 200);  // the sky
}

TEST(Cut, FromWithinTheBoxThereIsNone) {
  Drawing around = clipped(cube(), {Point(-3, -3, -0.5), Point(3, 3, 20)});
  around.cut->colour = kGreen;
  EXPECT_GT(centre(render(around, from_above(), plain()))[2], 100);
}

TEST(Picture, PngHasItsSignatureAndSize) {
  const std::string png = encode_png(render({}, from_above(), plain()));
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png[19], 64);  // the low byte of the width
  EXPECT_EQ(png[23], 64);
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
}

TEST(Page, Base64OfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Page, NamesCannotBreakOut) {
  EXPECT_EQ(html_escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

}  // namespace
}  // namespace sightline::viewers
