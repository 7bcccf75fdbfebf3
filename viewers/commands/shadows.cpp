// `sightline shadows`: what points see of an area light.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <iostream>
#include <optional>

#include "shadows/backprojection.h"
#include "shadows/lit_picture.h"
#include "shadows/shadow_mesh.h"
#include "viewers/commands/ask_points.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/commands/shadow_receivers.h"
#include "viewers/json_text.h"
#include "viewers/pictures/lit_image.h"
#include "viewers/queries/mesh_answer.h"
#include "viewers/queries/shadow_answer.h"
#include "viewers/queries/shadow_questions.h"
#include "viewers/queries/volume_answer.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

struct ShadowOptions : CommonOptions {
  std::vector<std::string> light, without, both_sides, receivers;
  std::string at, csv, png;
  bool structure = false, gradient = false, list = false;
  std::vector<double> eye, towards, up{0, 0, 1};
  double fov = 60;  ///< degrees
  std::string size = "640x480";
  int rays = 0;
  std::uint64_t seed = 1;
  bool volumes = false;
  std::string solid;
  double feature_size = 0;  ///< scene units

  [[nodiscard]] bool asks_receivers() const {
    return !receivers.empty() || (!vtk.empty() && !volumes) ||
           (at.empty() && png.empty() && !volumes);
  }
  [[nodiscard]] bool may_print() const {
    return CommonOptions::may_print() && csv != "-" && png != "-";
  }
};

Point point_of(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

PictureCamera camera_of(const ShadowOptions& options) {
  if (options.eye.empty() || options.towards.empty())
    throw UsageError("--png: from where? name --eye x,y,z and --towards x,y,z");
  PictureCamera camera{point_of(options.eye), point_of(options.towards),
                       point_of(options.up), options.fov * M_PI / 180};
  const Eigen::Vector3d way = camera.towards - camera.eye;
  if (!(way.norm() > 0)) throw UsageError("--towards: is the eye itself");
  if (!(way.cross(camera.up).norm() > 1e-12 * way.norm() * camera.up.norm()))
    throw UsageError("--up: points along the line of sight");
  const std::size_t x = options.size.find('x');
  const auto number = [](const std::string& text) {
    int n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    return error == std::errc() && end == text.data() + text.size() ? n : 0;
  };
  if (x != std::string::npos) {
    camera.width = number(options.size.substr(0, x));
    camera.height = number(options.size.substr(x + 1));
  }
  constexpr int kMost = 16384;
  if (camera.width < 1 || camera.height < 1 || camera.width > kMost ||
      camera.height > kMost) {
    throw UsageError(
        fmt::format("--size '{}': expected WxH, such as 640x480", options.size));
  }
  return camera;
}

/// What is kept of a point.
struct AnsweredPoint {
  Json json;
  std::string csv;
  ShadowClass shadow;
};

Request request_of(Session& session, const ShadowOptions& options) {
  Request request = session.with_grace();
  request.precision = options.precision;
  request.threads = options.threads;
  return request;
}

AnsweredPoints<AnsweredPoint> ask(Session& session, const ShadowOptions& options,
                                  const BackprojectionIndex& index,
                                  const std::vector<ShadowQuestion>& questions) {
  Request request = request_of(session, options);
  session.limit(request);
  return ask_points(
      session, questions, request, [&](std::size_t i, const ShadowQuestion& question) {
        const Backprojection seen =
            index.from(question.point,
                       {.gradient = options.gradient, .boundaries = options.structure});
        return AnsweredPoint{
            shadow_json(question, seen, {options.structure, options.gradient}),
            options.csv.empty() ? "" : shadow_csv(i, question, seen), seen.shadow};
      });
}

void write_picture(Session& session, const ShadowOptions& options, const Scene& scene,
                   const BackprojectionIndex& index, const LightSource& light,
                   const PictureCamera& camera, OutputFile& file) {
  const OcclusionIndex occlusion(scene, session.with_grace());
  Request request = request_of(session, options);
  session.limit(request);
  const std::vector<LitPixel> pixels =
      lit_picture(occlusion, index, light, camera, options.rays, options.seed, request);
  session.write(options.png, [&](const Request&) {
    file.stream() << encode_png(lit_image(pixels, camera.width, camera.height));
    file.commit();
  });
}

// ---- receivers ------------------------------------------------------------------------

/// The scene without small blockers, and which these are.  Never left out: the source,
/// and receivers that are named.
struct ReceivingScene {
  Scene scene;
  LightSource light;
  LeftOut left_out;
};

ReceivingScene without_small_blockers(Session& session, const ShadowOptions& options,
                                      const Scene& file, const Scene& scene,
                                      const LightSource& light) {
  std::vector<int> kept = light.faces;
  for (const std::string& name : options.receivers) {
    const auto faces = scene.faces_named(name);
    kept.insert(kept.end(), faces.begin(), faces.end());
  }
  LeftOut left_out{options.feature_size, small_parts(scene, options.feature_size, kept)};
  if (left_out.parts.empty()) return {scene, light, left_out};
  // What is left receives; the bound holds there.
  std::vector<std::uint8_t> is_out(scene.faces().size(), 0);
  for (const SmallPart& part : left_out.parts) {
    for (const int f : part.faces) is_out[f] = 1;
  }
  std::vector<Receiver> receivers =
      receivers_of(scene, light, options.receivers, options.both_sides);
  for (Receiver& receiver : receivers)
    std::erase_if(receiver.faces, [&](int f) { return is_out[f] != 0; });
  Request request = request_of(session, options);
  session.limit(request);
  left_out.bound = left_out_bound(scene, light, receivers, left_out.parts, request);
  std::vector<std::string> names = options.without;
  std::ranges::move(left_out.names(), std::back_inserter(names));
  Scene rest = scene_without(file, names, session.with_grace());
  LightSource its_light = light_source(rest, options.light, options.both_sides);
  return {std::move(rest), std::move(its_light), std::move(left_out)};
}

/// The one closed object that is no part of the source, or the group that --solid names.
std::string solid_of(const ShadowOptions& options, const Scene& scene,
                     const LightSource& light) {
  if (!options.solid.empty()) return options.solid;
  std::string found;
  for (const Object& object : scene.objects()) {
    const bool shines = std::ranges::any_of(
        object.faces, [&](int f) { return std::ranges::binary_search(light.faces, f); });
    if (!object.closed || shines || object.faces.empty()) continue;
    if (!found.empty()) {
      throw UsageError(
          fmt::format("--volumes: '{}' and '{}' are both closed; name one with --solid",
                      escaped_bytes(found), escaped_bytes(object.name)));
    }
    found = object.name;
  }
  if (found.empty())
    throw UsageError("--volumes: no closed object beside the source; name a --solid");
  return found;
}

std::optional<ShadowVolumes> ask_volumes(Session& session, const ShadowOptions& options,
                                         const Scene& scene, const LightSource& light) {
  if (!options.volumes) return std::nullopt;
  session.begin("volumes");
  return ShadowVolumes(scene, light, scene.faces_named(solid_of(options, scene, light)));
}

void print_receivers(const Shadows& shadows) {
  for (const ReceiverShadows& r : shadows.receivers) {
    std::size_t edges = 0, faces = 0;
    for (const ShadowMesh& mesh : r.meshes) {
      edges += mesh.edges.size();
      faces += mesh.faces.size();
    }
    std::cout << fmt::format(
        "  {}: area {:.6g}: lit {:.6g}, penumbra {:.6g}, umbra {:.6g} in {} (away "
        "{:.6g}); mesh of {} faces, {} edges\n",
        escaped_bytes(r.name), r.area, r.lit_area, r.penumbra_area, r.umbra_area,
        r.umbra_components, r.away_area, faces, edges);
  }
}

void print_points(const AnsweredPoints<AnsweredPoint>& all) {
  std::array<std::size_t, 3> counts{};
  for (const AnsweredPoint& point : all.points) ++counts[static_cast<int>(point.shadow)];
  std::cout << fmt::format("  {} {}: {} lit, {} in penumbra, {} in umbra\n",
                           all.points.size(), all.points.size() == 1 ? "point" : "points",
                           counts[static_cast<int>(ShadowClass::Lit)],
                           counts[static_cast<int>(ShadowClass::Penumbra)],
                           counts[static_cast<int>(ShadowClass::Umbra)]);
}

ExitStatus run(Session& session, const ShadowOptions& options) {
  // 1. The outputs, the scene, the light and the points.
  std::optional<PictureCamera> camera;
  if (!options.png.empty()) camera = camera_of(options);
  Outputs outputs(options);
  OutputFile* csv = options.csv.empty() ? nullptr : &outputs.add("--csv", options.csv);
  OutputFile* png = options.png.empty() ? nullptr : &outputs.add("--png", options.png);
  if (!options.at.empty()) outputs.protect(options.at);
  const Meter meter;
  const PrecisionScope precision(options.precision);
  const Scene file = read_scene(session, options.scene, options.format);
  if (!options.without.empty()) session.begin("scene without faces");
  const Scene scene = options.without.empty()
                          ? file
                          : scene_without(file, options.without, session.with_grace());
  const LightSource light = light_source(scene, options.light, options.both_sides);
  std::vector<ShadowQuestion> questions;
  if (!options.at.empty())
    questions = session.read([&] { return shadow_questions(scene, options.at); });

  const std::optional<ShadowVolumes> volumes =
      ask_volumes(session, options, scene, light);

  // 2. What they see, and what a camera sees.
  const BackprojectionIndex index(scene, light, request_of(session, options));
  AnsweredPoints<AnsweredPoint> all = ask(session, options, index, questions);
  const bool asks_receivers = options.asks_receivers();
  Shadows shadows;
  std::optional<ReceivingScene> receiving;
  if (options.feature_size > 0)
    receiving = without_small_blockers(session, options, file, scene, light);
  const Scene& meshed = receiving ? receiving->scene : scene;
  if (asks_receivers) {
    const LightSource& shining = receiving ? receiving->light : light;
    Request request = request_of(session, options);
    session.limit(request);
    shadows = shadows_in_time(
        meshed, shining,
        receivers_of(meshed, shining, options.receivers, options.both_sides), request);
  }
  const bool complete = all.points.size() == questions.size() && shadows.complete();
  if (png != nullptr) write_picture(session, options, scene, index, light, *camera, *png);

  // 3. The files; the answer comes last.
  if (!options.vtk.empty()) {
    session.write("VTK files", [&](const Request& request) {
      write_vtk(options.vtk, meshed,
                {.shadows = &shadows, .volumes = volumes ? &*volumes : nullptr}, request);
    });
  }
  if (csv != nullptr) {
    csv->stream() << (options.at.empty() ? kReceiverCsvHead : kShadowCsvHead);
    if (options.at.empty()) {
      for (const ReceiverShadows& r : shadows.receivers) csv->stream() << receiver_csv(r);
    }
    for (const AnsweredPoint& point : all.points) csv->stream() << point.csv;
    csv->commit();
  }
  Json answer = answer_head("shadows", scene, complete && session.unwritten().empty(),
                            {session.seconds(), meter.predicates() + all.predicates});
  if (!options.at.empty()) {
    Json& points = answer["points"] = Json::array();
    for (AnsweredPoint& point : all.points) points.push_back(std::move(point.json));
    while (points.size() < questions.size()) points.push_back(nullptr);
  }
  if (asks_receivers) add_shadows(answer, shadows, options.list);
  if (receiving) add_left_out(answer, scene, receiving->left_out);
  if (volumes) answer["volumes"] = volumes_json(*volumes);
  outputs.write_answer(answer);
  if (options.may_print()) {
    std::cout << fmt::format("{}{}\n", options.scene, complete ? "" : ": INCOMPLETE");
    if (!options.at.empty()) print_points(all);
    if (asks_receivers) print_receivers(shadows);
    if (receiving) std::cout << told(receiving->left_out);
    if (volumes) std::cout << told(*volumes);
    std::cout << fmt::format("  {:.3f} s\n", session.seconds());
  }
  return session.end(complete);
}

void add_vector(CLI::App& command, const std::string& name, std::vector<double>& numbers,
                const char* help) {
  command.add_option(name, numbers, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3)
      ->check(finite_number())
      ->type_name("x,y,z");
}

void add_volume_options(CLI::App& command, ShadowOptions& options) {
  CLI::Option* volumes = command.add_flag(
      "--volumes", options.volumes,
      "add \"volumes\", of one convex source and one convex solid as if they were alone: "
      "umbra and penumbra in space, cut off at the scene's box, as polyhedra with their "
      "volumes; --vtk writes their surfaces (receivers then only with --receivers)");
  command
      .add_option("--solid", options.solid,
                  "the solid of --volumes: a closed convex group, or a flat one "
                  "(default: the only closed one beside the source)")
      ->type_name("GROUP")
      ->needs(volumes);
}

/// The size below which blockers are left out of the receivers' scene.
void add_feature_size(CLI::App& command, ShadowOptions& options) {
  command
      .add_option(
          "--feature-size", options.feature_size,
          "leave blockers out of the receivers' meshes: parts of groups whose box "
          "has a shorter diagonal than this many scene units; \"left_out\" lists "
          "them, \"form_factor_error_bound\" says how much more light a point of "
          "the receivers gets at most; points and pictures stay exact (default 0: "
          "none)")
      ->type_name("L")
      ->check(number_from_zero());
}

void add_picture_options(CLI::App& command, ShadowOptions& options) {
  CLI::Option* png =
      command
          .add_option("--png", options.png,
                      "a picture of the scene under its light, no display needed: every "
                      "pixel's centre exact; what surfaces reflect is left out")
          ->type_name("FILE");
  add_vector(command, "--eye", options.eye, "where the picture is taken, scene units");
  add_vector(command, "--towards", options.towards, "the point in the picture's middle");
  add_vector(command, "--up", options.up, "what points up in it (default 0,0,1)");
  command
      .add_option("--fov", options.fov,
                  "its angle from left to right, degrees (default 60)")
      ->type_name("DEGREES")
      ->check(number_above_zero(179));
  command.add_option("--size", options.size, "its size in pixels (default 640x480)")
      ->type_name("WxH");
  command
      .add_option("--rays", options.rays,
                  "instead of exactly: that many random rays from each pixel's point to "
                  "the source")
      ->type_name("N")
      ->check(whole_number(1, 1000000));
  command.add_option("--seed", options.seed, "of these rays (default 1)")
      ->type_name("N")
      ->check(whole_number(0));
  for (const char* name : {"--eye", "--towards", "--up", "--fov", "--size", "--rays"})
    command.get_option(name)->needs(png);
}

}  // namespace

Command add_shadows_command(CLI::App& app) {
  auto options = std::make_shared<ShadowOptions>();
  CLI::App* command = app.add_subcommand(
      "shadows",
      "area lights: what points see of them, exactly, and how much light arrives");
  add_scene_argument(*command, *options);
  add_names_option(
      *command, "--light", options->light,
      "the source: all faces of these groups, or polygons #i-j, which emit from "
      "their fronts");
  command->get_option("--light")->required();
  add_names_option(*command, "--both-sides", options->both_sides,
                   "groups whose faces emit from both sides");
  add_names_option(
      *command, "--without", options->without,
      "groups that are taken out of the scene first, such as panes of glass");
  command
      ->add_option(
          "--at", options->at,
          R"(JSON: {"points": [[x,y,z], ...], "normals": [[x,y,z] | null, ...], )"
          R"("on": [polygon number | null, ...]}, the last two left out at will; )"
          "or text, a row x,y,z or x,y,z,nx,ny,nz a point; scene units, numbers "
          "or fractions p/q; \"on\" moves its point onto that polygon's plane "
          "and gives it that normal")
      ->type_name("FILE");
  command->add_flag("--structure", options->structure,
                    "add \"structure\", what the sides of the part seen lie on, and "
                    "\"seen\", its corners");
  command->add_flag("--gradient", options->gradient,
                    "add \"gradient\", of the form factor with the point; where it "
                    "differs on the two sides of an edge of the mesh it is null, and "
                    "\"one_sided\" has both");
  add_names_option(
      *command, "--receivers", options->receivers,
      "faces on which lit region, penumbra and umbra are found, with the mesh of "
      "curves along which the view of the source changes (default, without --at "
      "and --png: all groups but the source's)");
  command->add_flag("--list", options->list,
                    "add \"facets\" to each receiver: the mesh's vertices, edges and "
                    "faces; and \"structures\"");
  command
      ->add_option(
          "--csv", options->csv,
          "a table with a line a point: point (from 0), x, y, z, class, visible "
          "fraction, form factor; without --at with a line a receiver: areas and "
          "counts")
      ->type_name("FILE");
  add_feature_size(*command, *options);
  add_volume_options(*command, *options);
  add_picture_options(*command, *options);
  add_common_options(*command, *options);
  command->footer(
      "What hides, and what does not: docs/shadows.md.  Irradiance is the form factor "
      "times\nthe source's radiosity.\n"
      "Examples:\n"
      "  sightline shadows room.obj --light lamp_shade --receivers floor,table_top\n"
      "  sightline shadows room.obj --light lamp_shade --at points.txt --json -\n"
      "  sightline shadows room.obj --light lamp_shade --png room.png --eye 5,2,4 "
      "--towards 3,1,2 --up 0,1,0\n"
      "  sightline shadows hall.obj --light '#12-19' --without panes --at grid.json "
      "--csv grid.csv");
  return command_of(options, run);
}

}  // namespace sightline::viewers
