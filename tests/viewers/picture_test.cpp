// Pictures: what is in front hides, what is culled does not, and PNG bytes are a PNG.

#include "viewers/picture.h"

#include <gtest/gtest.h>

#include "viewers/page.h"

namespace sightline::viewers {
namespace {

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
