// Pictures without a display: a z-buffer for triangles and strokes, and PNG bytes.
//
// Knows nothing of scenes or skeletons: drawing.h turns those into a Drawing.  Nothing
// here decides anything geometric; it only shows.

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline::viewers {

/// Red, green, blue in [0, 1], as stored in a PNG (sRGB).
struct Colour {
  float red, green, blue;
};

/// An opaque triangle, lit from both sides unless `cull_back`.
struct PaintedTriangle {
  std::array<Point, 3> points;
  Colour colour;
  bool cull_back = false;  ///< not drawn where its clockwise side faces the camera
  int id = 0;              ///< what visible_ids() reports
  /// Of a surface that encloses a solid, counter-clockwise seen from outside.
  bool solid = false;
};

/// A translucent triangle, unlit; overlapping ones blend whatever their order.
struct VeilTriangle {
  std::array<Point, 3> points;
  Colour colour;
  float opacity;
};

/// A straight stroke of constant width on the picture.
struct Stroke {
  std::array<Point, 2> points;
  Colour colour;
  float width;    ///< pixels
  float opacity;  ///< where nothing hides it
  /// Opacity where a triangle hides it.
  float hidden_opacity = 0;
};

/// Solids cut open by a box.  Who looks from outside of the box sees the cut, where the
/// ray enters the box inside a solid, as an unlit face of the box.
struct CutSolids {
  std::array<Point, 2> box;  ///< smallest, largest coordinates
  /// Whole, of closed surfaces, counter-clockwise seen from outside of the solid.
  std::vector<std::array<Point, 3>> triangles;
  Colour colour;
};

/// What is to be drawn, in scene units.
struct Drawing {
  std::vector<PaintedTriangle> triangles;
  std::vector<VeilTriangle> veils;
  std::vector<Stroke> strokes;
  std::optional<CutSolids> cut;
};

/// A perspective camera.
struct Camera {
  Point eye, target, up;
  double field_of_view = 0.6;  ///< full vertical angle, radians
};

struct PictureOptions {
  int width = 1400, height = 980;  ///< pixels
  int samples = 2;                 ///< per pixel side, 1 for none
  Colour background_top{0.965F, 0.972F, 0.984F}, background_bottom{0.845F, 0.868F, 0.9F};
  bool ambient_occlusion = true;  ///< darken crevices, from the depth buffer
  /// Stop, budget (counted by each call) and progress; drawing throws Stopped.
  Request request = {};
};

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< rows from the top, three bytes a pixel
};

/// Triangles drawn once, for several pictures with different marks on them.  Draws with
/// one thread; the same input gives the same bytes.  What reaches behind the eye is
/// clipped.  Cost: the samples covered.
class Canvas {
 public:
  Canvas(const Drawing& drawing, const Camera& camera,
         const PictureOptions& options = {});
  ~Canvas();
  /// The triangles with these veils and strokes, strokes last and in their order.
  [[nodiscard]] Image picture(const Drawing& marks) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One picture of everything in the drawing.
[[nodiscard]] Image render(const Drawing& drawing, const Camera& camera,
                           const PictureOptions& options = {});

/// The ids of the triangles seen by each of width x height rays, -1 for the background
/// and for solids cut open.
[[nodiscard]] std::vector<int> visible_ids(const Drawing& drawing, const Camera& camera,
                                           int width, int height);

/// The image as the bytes of a PNG file.
[[nodiscard]] std::string encode_png(const Image& image);

}  // namespace sightline::viewers
