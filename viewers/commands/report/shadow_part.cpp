#include "viewers/commands/report/shadow_part.h"

#include <fmt/format.h>

#include <limits>

#include "shadows/backprojection.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/shadow_receivers.h"
#include "viewers/json_text.h"
#include "viewers/pictures/lit_camera.h"
#include "viewers/pictures/lit_image.h"
#include "viewers/queries/mesh_answer.h"

namespace sightline::viewers {
namespace {

constexpr int kWidth = 481, kHeight = 361;
/// Of the brightest pixel: less than one step of eight bits in the dark half.
constexpr double kTolerance = 0.01;
/// Of the surfaces' pixels, that are not as bright as they can be shown.
constexpr double kNotDazzling = 0.97;

/// The box around what is not umbra, the light included.
std::array<Point, 2> lit_box(const Scene& scene, const LightSource& light,
                             const Shadows& shadows) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<Point, 2> box{Point::Constant(kInfinity), Point::Constant(-kInfinity)};
  const auto add = [&](const Point& p) {
    box[0] = box[0].cwiseMin(p);
    box[1] = box[1].cwiseMax(p);
  };
  for (const int f : light.faces) {
    for (const int corner : scene.face_points(f)) add(scene.point(corner));
  }
  for (const ReceiverShadows& receiver : shadows.receivers) {
    for (const ShadowMesh& mesh : receiver.meshes) {
      const auto shines_on = [&](int face) {
        return face >= 0 && mesh.faces[face].shadow != ShadowClass::Umbra;
      };
      for (const ShadowMesh::Edge& e : mesh.edges) {
        if (!shines_on(e.left) && !shines_on(e.right)) continue;
        for (const Eigen::Vector2d& p : e.polyline) {
          add(mesh.frame.origin + p[0] * mesh.frame.x_axis + p[1] * mesh.frame.y_axis);
        }
      }
    }
  }
  return box;
}

std::string lit_png(const Scene& scene, const LightSource& light, const Shadows& shadows,
                    int up_axis, const std::function<Request()>& rest) {
  const OcclusionIndex occlusion(scene, rest());
  const BackprojectionIndex index(scene, light, rest());
  const PictureCamera camera =
      lit_camera(occlusion, index, light, lit_box(scene, light, shadows), up_axis, kWidth,
                 kHeight, rest());
  const std::vector<LitPixel> pixels =
      smooth_lit_picture(occlusion, index, light, camera, kTolerance, rest());
  return encode_png(lit_image(pixels, camera.width, camera.height, kNotDazzling));
}

}  // namespace

ShadowPart shadow_part(const Scene& scene, const LightSource& light, int up_axis,
                       const Request& request) {
  const Meter meter;
  const auto rest = [&] {
    Request left = request;
    left.budget_seconds -= meter.seconds();
    return left;
  };
  const std::vector<Receiver> receivers = receivers_of(scene, light, {});
  ShadowPart part;
  part.asked = receivers.size();
  part.shadows = shadows_in_time(scene, light, receivers, rest());
  try {
    part.png = lit_png(scene, light, part.shadows, up_axis, rest);
  } catch (const Stopped&) {
    // The part is told to lack its picture.
  }
  part.predicates = meter.predicates();
  return part;
}

Json shadow_part_json(const ShadowPart& part) {
  Json answer;
  add_shadows(answer, part.shadows, /*with_lists=*/false);
  answer["complete"] = part.complete();
  answer["predicates"] = stage_counts(part.predicates);
  return answer;
}

std::vector<PagePicture> write_shadow_part(Session& session, const ShadowPart& part,
                                           Json head, ReportFolder& folder) {
  std::vector<PagePicture> pictures;
  if (!part.png.empty()) {
    write_whole(folder.announce("shadows.png"), part.png);
    pictures.push_back(
        {"shadows.png", part.png, "Under the light",
         "What arrives directly, without what surfaces reflect. Exact at one pixel of "
         "eight and wherever these differ; between them, smooth. The brightest three "
         "hundredths are shown alike."});
  }
  std::string rows(kReceiverCsvHead);
  for (const ReceiverShadows& r : part.shadows.receivers) rows += receiver_csv(r);
  write_whole(folder.announce("shadows.csv"), rows);
  session.write("shadows.json", [&](const Request&) {
    add_shadows(head, part.shadows, /*with_lists=*/true);
    write_whole(folder.announce("shadows.json"), json_text(head) + "\n");
  });
  return pictures;
}

}  // namespace sightline::viewers
