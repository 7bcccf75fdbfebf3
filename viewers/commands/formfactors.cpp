// `sightline formfactors`: which share of what a surface sends out arrives where.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "shadows/form_factors.h"
#include "viewers/commands/ask_points.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/json_text.h"
#include "viewers/queries/factor_answer.h"
#include "viewers/queries/shadow_questions.h"

namespace sightline::viewers {
namespace {

struct FactorOptions : CommonOptions {
  SurfaceWish wish;
  std::string each = "group";
  std::vector<std::string> without;
  std::optional<double> asked_accuracy;
  std::optional<std::int64_t> lines;
  std::optional<std::uint64_t> seed;
  std::string at, csv, npz;
  std::vector<double> up;
  bool enforce = false;

  [[nodiscard]] bool may_print() const {
    return CommonOptions::may_print() && csv != "-";
  }
  [[nodiscard]] double accuracy() const { return asked_accuracy.value_or(1e-10); }
  [[nodiscard]] std::optional<Eigen::Vector3d> up_vector() const {
    if (up.empty()) return std::nullopt;
    return Eigen::Vector3d(up[0], up[1], up[2]);
  }
};

/// The files of one run, and what is asked of which scene.
struct Run {
  Outputs outputs;
  OutputFile* csv = nullptr;
  OutputFile* npz = nullptr;
};

void check(const FactorOptions& options) {
  if (!options.up.empty() && options.up_vector()->norm() == 0)
    throw UsageError("--up: is the null vector");
  if (!options.at.empty() && (!options.npz.empty() || options.enforce)) {
    throw UsageError(fmt::format("{}: is for a matrix, and --at asks points",
                                 options.npz.empty() ? "--enforce" : "--npz"));
  }
  if (options.seed && !options.lines) throw UsageError("--seed: is for --lines");
  if (options.lines &&
      (!options.at.empty() || options.asked_accuracy || options.enforce)) {
    throw UsageError(fmt::format("--lines: estimates a matrix, and {}",
                                 !options.at.empty() ? "--at asks points"
                                 : options.asked_accuracy
                                     ? "--accuracy is for what is bounded"
                                     : "--enforce is for what is bounded"));
  }
  if (options.npz == "-") throw UsageError("--npz: needs the name of a file");
}

/// What every request of this command has.
template <class AnyRequest>
AnyRequest common_request(Session& session, const FactorOptions& options) {
  AnyRequest request;
  static_cast<Request&>(request) = session.with_grace();
  session.limit(request);
  request.precision = options.precision;
  request.threads = options.threads;
  request.up = options.up_vector();
  return request;
}

FormFactorRequest request_of(Session& session, const FactorOptions& options) {
  auto request = common_request<FormFactorRequest>(session, options);
  request.accuracy = options.accuracy();
  return request;
}

std::string share(double value) { return fmt::format("{:.10g}", value); }

// ---- the matrix -----------------------------------------------------------------------

/// bound: what is known of errors, in words.
void print_rows(const FactorOptions& options, const FormFactors& f,
                const std::string& bound, double seconds) {
  constexpr std::size_t kShown = 12;
  std::size_t entries = 0;
  for (const FormFactorRow& row : f.rows) entries += row.to.size();
  std::cout << fmt::format("{}: {} surfaces, {} factors above 0, {}{}\n", options.scene,
                           f.names.size(), entries, bound,
                           f.complete ? "" : ", INCOMPLETE");
  for (std::size_t i = 0; i < std::min(kShown, f.rows.size()); ++i) {
    const FormFactorRow& row = f.rows[i];
    std::cout << fmt::format(
        "  from {} (area {:.6g}): surfaces {}, others {}, outside {}, "
        "backs {}{}\n",
        escaped_bytes(f.names[i]), f.areas[i], share(f.row_sum(static_cast<int>(i))),
        share(row.others), share(row.outside), share(row.backs),
        options.up.empty() ? "" : fmt::format(", sky {}", share(row.sky)));
    for (std::size_t k = 0; k < std::min(kShown, row.to.size()); ++k) {
      std::cout << fmt::format("    to {}: {}\n", escaped_bytes(f.names[row.to[k]]),
                               share(row.factor[k]));
    }
    if (row.to.size() > kShown) {
      std::cout << fmt::format("    and {} more\n", row.to.size() - kShown);
    }
  }
  if (f.rows.size() > kShown) {
    std::cout << fmt::format("  and {} more rows (--json, --csv and --npz have them)\n",
                             f.rows.size() - kShown);
  }
  std::cout << fmt::format("  {:.3f} s\n", seconds);
}

/// The files with one line or number an entry.
void write_entries(Session& session, Run& run, const FormFactors& factors,
                   const std::vector<FormFactorErrors>* errors) {
  const auto write = [&](const std::string& name, auto&& writer) {
    session.write(name, [&](const Request&) { writer(); });
  };
  if (run.csv != nullptr) {
    write("--csv", [&] {
      write_factor_csv(factors, run.csv->stream(), errors);
      run.csv->commit();
    });
  }
  if (run.npz != nullptr && (factors.complete || errors != nullptr)) {
    write("--npz", [&] {
      write_factor_npz(factors, run.npz->temporary_path(), errors);
      run.npz->commit();
    });
  }
}

ExitStatus answer_lines(Session& session, const FactorOptions& options,
                        const Scene& scene,
                        const std::vector<FormFactorSurface>& surfaces, Run& run) {
  const Meter meter;
  auto request = common_request<FormFactorLinesRequest>(session, options);
  request.lines = *options.lines;
  request.seed = options.seed.value_or(1);
  const FormFactorLines estimate = form_factors_by_lines(scene, surfaces, request);
  const FormFactors& factors = estimate.factors;
  write_entries(session, run, factors, &estimate.errors);
  Json answer =
      answer_head("formfactors", scene, factors.complete && session.unwritten().empty(),
                  {session.seconds(), meter.predicates() + factors.predicates});
  answer["method"] = "lines";
  answer["seed"] = request.seed;
  answer.update(factor_lines_json(estimate, !options.up.empty()));
  run.outputs.write_answer(answer);
  if (options.may_print()) {
    print_rows(options, factors, fmt::format("estimated by {} lines", estimate.lines),
               session.seconds());
  }
  return session.end(factors.complete);
}

ExitStatus answer_matrix(Session& session, const FactorOptions& options,
                         const Scene& scene,
                         const std::vector<FormFactorSurface>& surfaces, Run& run) {
  if (options.lines) return answer_lines(session, options, scene, surfaces, run);
  const Meter meter;
  const FormFactors factors = form_factors(scene, surfaces, request_of(session, options));
  write_entries(session, run, factors, nullptr);
  Json answer =
      answer_head("formfactors", scene, factors.complete && session.unwritten().empty(),
                  {session.seconds(), meter.predicates() + factors.predicates});
  answer.update(matrix_answer(factors, options.accuracy(), !options.up.empty()));
  if (options.enforce && factors.complete) {
    const EnforcedFactors e = enforced(factors);
    answer["enforced"] = factors_json(e.factors, !options.up.empty());
    answer["enforced"].erase("error_bound");
    answer["enforced"]["moved"] = e.moved;
    answer["enforced"]["left_over"] = e.left_over;
  }
  run.outputs.write_answer(answer);
  if (options.may_print()) {
    print_rows(options, factors, fmt::format("each within {:.1e}", factors.error_bound),
               session.seconds());
  }
  return session.end(factors.complete);
}

// ---- points ---------------------------------------------------------------------------

AnsweredPoints<PointFactors> ask(Session& session, const FactorOptions& options,
                                 const Scene& scene,
                                 const std::vector<FormFactorSurface>& surfaces,
                                 const std::vector<ShadowQuestion>& questions) {
  const FormFactorRequest request = request_of(session, options);
  const PointFactorIndex index(scene, surfaces, request);
  return ask_points(session, questions, request,
                    [&](std::size_t, const ShadowQuestion& question) {
                      const ShadowPoint& point = question.point;
                      return index.at({Viewpoint::Kind::Eye, point.at},
                                      point.normal->nearest, request.up);
                    });
}

void print_points(const FactorOptions& options,
                  const std::vector<FormFactorSurface>& surfaces,
                  const AnsweredPoints<PointFactors>& all, std::size_t asked,
                  double seconds) {
  constexpr std::size_t kShown = 12;
  std::cout << fmt::format("{}: {} points{}\n", options.scene, all.points.size(),
                           all.points.size() < asked ? ", INCOMPLETE" : "");
  for (std::size_t i = 0; i < std::min(kShown, all.points.size()); ++i) {
    const PointFactors& p = all.points[i];
    std::cout << fmt::format(
        "  point {}: others {}, outside {}, backs {}{}\n", i, share(p.others),
        share(p.outside), share(p.backs),
        options.up.empty() ? "" : fmt::format(", sky {}", share(p.sky)));
    for (std::size_t k = 0; k < p.factors.size(); ++k) {
      if (p.factors[k] == 0 || k >= kShown) continue;
      std::cout << fmt::format("    to {}: {}\n", escaped_bytes(surfaces[k].name),
                               share(p.factors[k]));
    }
  }
  std::cout << fmt::format("  {:.3f} s\n", seconds);
}

ExitStatus answer_points(Session& session, const FactorOptions& options,
                         const Scene& scene,
                         const std::vector<FormFactorSurface>& surfaces, Run& run) {
  const Meter meter;
  const std::vector<ShadowQuestion> questions =
      session.read([&] { return shadow_questions(scene, options.at); });
  for (const ShadowQuestion& q : questions) {
    if (!q.point.normal)
      throw InvalidInput(fmt::format("{}: a normal is needed", q.where));
  }
  const AnsweredPoints<PointFactors> all =
      ask(session, options, scene, surfaces, questions);
  const bool complete = all.points.size() == questions.size();
  const bool sky = !options.up.empty();
  if (run.csv != nullptr) {
    run.csv->stream() << point_factor_csv_head(surfaces, sky);
    for (std::size_t i = 0; i < all.points.size(); ++i) {
      run.csv->stream() << point_factor_csv(i, all.points[i], sky);
    }
    run.csv->commit();
  }
  Json answer = answer_head("formfactors", scene, complete,
                            {session.seconds(), meter.predicates() + all.predicates});
  Json& groups = answer["groups"] = Json::array();
  for (const FormFactorSurface& s : surfaces) groups.push_back(s.name);
  Json& points = answer["points"] = Json::array();
  for (const PointFactors& p : all.points) points.push_back(point_factors_json(p, sky));
  while (points.size() < questions.size()) points.push_back(nullptr);
  run.outputs.write_answer(answer);
  if (options.may_print())
    print_points(options, surfaces, all, questions.size(), session.seconds());
  return session.end(complete);
}

ExitStatus run(Session& session, const FactorOptions& options) {
  check(options);
  Run files{Outputs(options)};
  if (!options.csv.empty()) files.csv = &files.outputs.add("--csv", options.csv);
  if (!options.npz.empty()) files.npz = &files.outputs.add("--npz", options.npz);
  if (!options.at.empty()) files.outputs.protect(options.at);
  const PrecisionScope precision(options.precision);
  Scene scene = read_scene(session, options.scene, options.format);
  if (!options.without.empty()) {
    session.begin("scene without faces");
    scene = scene_without(scene, options.without, session.with_grace());
  }
  SurfaceWish wish = options.wish;
  wish.each_face = options.each == "face";
  const std::vector<FormFactorSurface> surfaces = surfaces_of(scene, wish);
  return options.at.empty() ? answer_matrix(session, options, scene, surfaces, files)
                            : answer_points(session, options, scene, surfaces, files);
}

void add_surface_options(CLI::App& command, FactorOptions& options) {
  add_names_option(command, "--groups", options.wish.groups,
                   "the surfaces, in this order, or polygons #i-j (default: all groups)");
  command
      .add_option("--each", options.each,
                  "what a surface is: a group as a whole, or every polygon of these "
                  "groups, named GROUP/number in the file (default group)")
      ->type_name("group|face")
      ->check(one_of({"group", "face"}));
  add_names_option(
      command, "--both-sides", options.wish.both_sides,
      "groups that send out and receive by both sides: their backs are surfaces of "
      "their own, GROUP/back");
  add_names_option(
      command, "--without", options.without,
      "groups that are taken out of the scene first, such as panes of glass");
  command
      .add_option("--accuracy", options.asked_accuracy,
                  "largest error of an entry, 1e-13 to 0.1 (default 1e-10)")
      ->type_name("E")
      ->check(number_above_zero(0.1));
  command
      .add_option("--lines", options.lines,
                  "estimate the matrix by so many random lines instead, at least 2: "
                  "\"standard_errors\" in place of a bound")
      ->type_name("N")
      ->check(whole_number(2, std::uint64_t{1} << 62));
  command.add_option("--seed", options.seed, "of these lines (default 1)")
      ->type_name("N")
      ->check(whole_number(0));
}

void add_answer_options(CLI::App& command, FactorOptions& options) {
  command
      .add_option("--at", options.at,
                  "instead of a matrix: from these points with normals, JSON or text as "
                  "`sightline shadows --at` takes them")
      ->type_name("FILE");
  command
      .add_option("--up", options.up,
                  "add \"sky\": the part of \"outside\" that leaves within 90 degrees of "
                  "this direction (the sky view factor)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->expected(3)
      ->check(finite_number())
      ->type_name("x,y,z");
  command.add_flag(
      "--enforce", options.enforce,
      "add \"enforced\": the matrix scaled so that rows add up to 1 and "
      "A_i F_ij = A_j F_ji to the last digit, and by how much that moved it");
  command
      .add_option("--csv", options.csv,
                  "a table: from, to, factor for every entry that is not 0; of points a "
                  "line each")
      ->type_name("FILE");
  command
      .add_option("--npz", options.npz,
                  "the matrix for Python: scipy.sparse.load_npz opens it; areas, names, "
                  "others, outside and backs are in it too")
      ->type_name("FILE");
}

}  // namespace

Command add_formfactors_command(CLI::App& app) {
  auto options = std::make_shared<FactorOptions>();
  CLI::App* command = app.add_subcommand(
      "formfactors",
      "which share of what a surface sends out arrives where, with error bounds");
  add_scene_argument(*command, *options);
  add_surface_options(*command, *options);
  add_answer_options(*command, *options);
  add_common_options(*command, *options, false);
  command->footer(
      "Surfaces send out and receive by their fronts; all faces of the scene block.  Row "
      "i "
      "of the\nmatrix is where goes what surface i sends out; others, outside and backs "
      "take the rest, so\nthat a row and these add up to 1 but for errors.  Nothing is "
      "normalised.  Definitions and\nwhat is proved of the bound: docs/form_factors.md.\n"
      "Examples:\n"
      "  sightline formfactors room.obj --json -\n"
      "  sightline formfactors room.obj --each face --accuracy 1e-7 --npz room.npz\n"
      "  sightline formfactors city.obj --each face --lines 10000000 --npz city.npz\n"
      "  sightline formfactors hall.obj --groups floor,window --without pane\n"
      "  sightline formfactors roof.obj --at sensors.txt --up 0,0,1 --csv sensors.csv");
  return command_of(options, run);
}

}  // namespace sightline::viewers
