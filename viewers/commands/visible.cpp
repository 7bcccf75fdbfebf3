// `sightline visible`: do two polygons, or two groups of a scene, see each other?

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "linespace/face_visibility.h"
#include "linespace/mesh_io.h"
#include "linespace/polygon_visibility.h"
#include "linespace/seams.h"
#include "linespace/visibility_cover.h"
#include "linespace/visibility_estimate.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/questions.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

constexpr std::int64_t kEstimateRays = 10'000;

struct VisibleOptions : CommonOptions {
  std::string a, b;
  std::string method = "exact";
  std::int64_t rays = 0;  ///< 0: what the method takes unasked
  std::uint64_t seed = 1;
  bool check = false;
  bool all_pairs = false;
  double seam = 0;
};

Json witness_json(const VisibilityAnswer& answer) {
  if (!answer.witness) return nullptr;
  return Json::array(
      {position_json((*answer.witness)[0]), position_json((*answer.witness)[1])});
}

// Undecided: where the search was given up first.
void add_opening(Json& j, const VisibilityAnswer& answer) {
  if (answer.verdict != Verdict::Undecided) return;
  j["occluders"] = answer.occluders;
  j["width"] = std::isfinite(answer.width) ? Json(answer.width) : Json(nullptr);
}

// What growing closed: `occluders` by the numbers that the caller knows.
Json seam_json(const std::array<ExactPosition, 2>& segment,
               const std::vector<int>& occluders) {
  return {{"occluders", occluders},
          {"segment", {position_json(segment[0]), position_json(segment[1])}}};
}

Json verdict_json(Verdict verdict) {
  switch (verdict) {
    case Verdict::Visible:
      return true;
    case Verdict::Hidden:
      return false;
    default:
      return nullptr;
  }
}

Json cost_json(const VisibilityCost& cost) {
  return {{"samples", cost.samples},   {"cells", cost.cells},
          {"games", cost.games},       {"exact_games", cost.exact_games},
          {"halvings", cost.halvings}, {"exact_cells", cost.exact_cells}};
}

VisibilityRequest request_of(Session& session, const VisibleOptions& options) {
  VisibilityRequest request;
  session.limit(request);
  request.precision = options.precision;
  request.threads = options.threads;
  request.seed = options.seed;
  request.keep_cover = options.check;
  request.samples_only = options.method == "sampled";
  if (options.rays > 0) {
    request.samples = static_cast<int>(std::min<std::int64_t>(options.rays, 1 << 30));
  }
  return request;
}

// "checked" or what is wrong, for an answer with a cover.
Json checked_json(const VisibilityQuestion& question, const VisibilityAnswer& answer) {
  if (!answer.cover) return nullptr;
  const auto wrong = check_cover(question, *answer.cover);
  if (wrong) throw std::logic_error("a cover does not hold: " + *wrong);
  return {{"leaves", answer.cover->leaves()}, {"checked", true}};
}

// ---- questions from a file
// ---------------------------------------------------------------

ExitStatus run_questions(Session& session, const VisibleOptions& options) {
  Outputs outputs(options);
  const Meter meter;
  const std::vector<VisibilityQuestion> questions =
      session.read([&] { return visibility_questions(JsonInput(options.scene)); });
  Json answers = Json::array();
  VisibilityCost cost;
  std::size_t counts[3] = {};
  bool seams_known = true;
  std::size_t occluders = 0;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    occluders += questions[i].occluders.size();
    const Meter one;
    SeamAnswer seams;  // undecided: stays so where no time is left
    try {
      if (!session.stopped()) {
        seams =
            polygon_visibility(questions[i], options.seam, request_of(session, options));
      }
    } catch (const InvalidInput& error) {
      throw InvalidInput(
          fmt::format("{}: instances[{}].{}", options.scene, i, error.what()));
    }
    const VisibilityAnswer& answer = seams.answer;
    const double milliseconds = 1000 * one.seconds();
    Json j{{"visible", verdict_json(answer.verdict)},
           {"witness", witness_json(answer)},
           {"milliseconds", milliseconds}};
    add_opening(j, answer);
    if (options.seam > 0) {
      j["seams"] = Json::array();
      if (seams.closed) {
        j["seams"].push_back(seam_json(seams.closed->segment, seams.closed->occluders));
      }
      seams_known &= !seams.closed_unknown;
    }
    if (options.check && answer.cover) j["cover"] = checked_json(seams.grown, answer);
    j["cost"] = cost_json(answer.cost);
    answers.push_back(std::move(j));
    cost += answer.cost;
    ++counts[static_cast<int>(answer.verdict)];
    session.tell("questions",
                 static_cast<double>(i + 1) / static_cast<double>(questions.size()));
  }
  const bool complete = counts[static_cast<int>(Verdict::Undecided)] == 0 && seams_known;
  Json answer = answer_head(
      "visible", Json{{"instances", questions.size()}, {"occluders", occluders}},
      complete, {session.seconds(), meter.predicates()});
  answer["answers"] = std::move(answers);
  answer["cost"] = cost_json(cost);
  outputs.write_answer(answer);
  if (options.may_print()) {
    std::cout << fmt::format("{}: {} visible, {} hidden, {} undecided\n  {:.3f} s\n",
                             options.scene, counts[0], counts[1], counts[2],
                             answer["seconds"].get<double>());
  }
  return session.end(complete);
}

// ---- two groups of a scene
// ---------------------------------------------------------------

// Occluders by the numbers of their polygons in the file.
void add_opening(Json& j, const Scene& scene, const FacePairAnswer& pair) {
  VisibilityAnswer answer = pair.answer;
  for (int& face : answer.occluders) face = scene.faces()[face].source;
  add_opening(j, answer);
}

Json pair_json(const Scene& scene, const FaceVisibility& visibility,
               const FacePairAnswer& pair, bool check) {
  Json j{{"faces", {scene.faces()[pair.a].source, scene.faces()[pair.b].source}},
         {"visible", verdict_json(pair.answer.verdict)},
         {"witness", witness_json(pair.answer)},
         {"occluders_used", pair.occluders.size()}};
  add_opening(j, scene, pair);
  if (check && pair.answer.cover) {
    j["cover"] = checked_json(visibility.question_of(pair), pair.answer);
  }
  return j;
}

ExitStatus run_sampled(Session& session, const VisibleOptions& options) {
  Outputs outputs(options);
  const Meter meter;
  const Scene scene = read_scene(session, options.scene, options.format);
  const std::vector<int> as = scene.faces_named(options.a);
  const std::vector<int> bs = scene.faces_named(options.b);
  const OcclusionIndex index(scene, session.with_grace());
  const VisibilityEstimate estimate = estimate_visibility(
      index, as, bs, {options.rays > 0 ? options.rays : kEstimateRays, options.seed},
      request_of(session, options));
  Json answer = answer_head("visible", scene, estimate.complete,
                            {session.seconds(), meter.predicates()});
  answer["method"] = "sampled";
  answer["groups"] = {options.a, options.b};
  answer["rays"] = estimate.samples;
  answer["free"] = estimate.free;
  answer["fraction"] = estimate.fraction.value;
  answer["standard_error"] = estimate.fraction.standard_error;
  answer["interval"] = estimate.interval;
  outputs.write_answer(answer);
  if (options.may_print()) {
    std::cout << fmt::format(
        "{}: {} of {} random segments from {} to {} are free: {:.4g}, 95 % between "
        "{:.4g} and {:.4g}\n  an estimate, no proof; {:.3f} s\n",
        options.scene, estimate.free, estimate.samples, options.a, options.b,
        estimate.fraction.value, estimate.interval[0], estimate.interval[1],
        answer["seconds"].get<double>());
  }
  return session.end(estimate.complete);
}

Json seams_json(const Scene& scene, const ClosedPairs& closed) {
  Json list = Json::array();
  for (const auto& [a, b, seam] : closed.pairs) {
    std::vector<int> occluders;
    for (const int face : seam.occluders) {
      occluders.push_back(scene.faces()[face].source);
    }
    occluders.erase(std::unique(occluders.begin(), occluders.end()), occluders.end());
    Json j = seam_json(seam.segment, occluders);
    j["faces"] = {scene.faces()[a].source, scene.faces()[b].source};
    list.push_back(std::move(j));
  }
  return list;
}

void write_witnesses(const VisibleOptions& options, const Scene& scene,
                     const GroupAnswer& group, const Request& request) {
  LineBlock block{"witnesses", "VV", {}};
  const auto add = [&](const FacePairAnswer& pair) {
    if (!pair.answer.witness) return;
    const auto& [from, to] = *pair.answer.witness;
    block.pieces.push_back({from.nearest, to.nearest,
                            fmt::format("{} {}", scene.faces()[pair.a].source,
                                        scene.faces()[pair.b].source)});
  };
  for (const FacePairAnswer& pair : group.pairs) add(pair);
  if (group.pairs.empty() && group.visible) add(*group.visible);
  write_vtk(options.vtk, scene, {}, request);
  write_vtk_lines(options.vtk, {block}, request);
}

ExitStatus run_groups(Session& session, const VisibleOptions& options) {
  if (options.method == "sampled") return run_sampled(session, options);
  // 1. Outputs first: one that cannot be written fails before the work.  Then the faces
  // of the two groups: all polygons that a name, or #i-j, tells.
  Outputs outputs(options);
  const Meter meter;
  const Scene scene = read_scene(session, options.scene, options.format);
  const std::vector<int> as = scene.faces_named(options.a);
  const std::vector<int> bs = scene.faces_named(options.b);
  // 2. The verdict on the two groups.  With --seam, the pairs of faces too that see each
  // other only through a gap that was closed: no cover of theirs is needed for that.
  const FaceVisibility visibility(scene, session.with_grace(), options.seam);
  const GroupAnswer group =
      visibility.between(as, bs, options.all_pairs, request_of(session, options));
  ClosedPairs closed;
  if (options.seam > 0) {
    VisibilityRequest request = request_of(session, options);
    request.keep_cover = false;
    closed = closed_pairs(scene, visibility, as, bs, group, options.all_pairs, request);
  }
  // Complete with every pair asked for decided; without --pairs one that sees suffices.
  const bool complete =
      closed.complete && (options.all_pairs ? group.pairs_undecided == 0
                                            : group.verdict != Verdict::Undecided);
  // 3. The answer: the verdict with its proof.  A witness proves "visible"; where the
  // budget ended first, a pair of faces that is still open says where.
  Json answer = answer_head("visible", scene, complete,
                            {session.seconds(), meter.predicates() + group.predicates});
  answer["method"] = "exact";
  answer["groups"] = {options.a, options.b};
  answer["visible"] = verdict_json(group.verdict);
  answer["witness"] = group.visible ? witness_json(group.visible->answer) : Json(nullptr);
  // Faces are named by their numbers in the file.
  if (group.visible) {
    answer["faces"] = {scene.faces()[group.visible->a].source,
                       scene.faces()[group.visible->b].source};
  }
  if (group.undecided) add_opening(answer, scene, *group.undecided);
  if (options.seam > 0) answer["seams"] = seams_json(scene, closed);
  answer["face_pairs"] = as.size() * bs.size();
  answer["cost"] = cost_json(group.cost);
  // Every pair of faces has its own verdict and proof, which --check proves again.
  if (options.all_pairs) {
    answer["pairs"] = Json::array();
    for (const FacePairAnswer& pair : group.pairs) {
      answer["pairs"].push_back(pair_json(scene, visibility, pair, options.check));
    }
  }
  // 4. Files, then the answer itself: it says whether all of them were written in time.
  if (!options.vtk.empty()) {
    session.write("VTK files", [&](const Request& request) {
      write_witnesses(options, scene, group, request);
    });
  }
  // A partial answer is written, too: what it proves holds.
  answer["complete"] = complete && session.unwritten().empty();
  outputs.write_answer(answer);
  // 5. The same in a few lines for people, unless the JSON goes to the terminal.
  if (options.may_print()) {
    const char* verdict = group.verdict == Verdict::Visible  ? "visible"
                          : group.verdict == Verdict::Hidden ? "hidden"
                                                             : "undecided";
    std::cout << fmt::format("{}: {} and {}: {}\n", options.scene, options.a, options.b,
                             verdict);
    if (group.visible) {
      const auto& [from, to] = *group.visible->answer.witness;
      std::cout << fmt::format(
          "  for example from face {} at ({:g}, {:g}, {:g}) to face {} at ({:g}, {:g}, "
          "{:g})\n",
          answer["faces"][0].get<int>(), from.nearest.x(), from.nearest.y(),
          from.nearest.z(), answer["faces"][1].get<int>(), to.nearest.x(), to.nearest.y(),
          to.nearest.z());
    }
    // Pairs that only the seam option hides from each other.
    for (const auto& [from, to, seam] : closed.pairs) {
      std::cout << fmt::format("  open without --seam: face {} to face {}\n",
                               scene.faces()[from].source, scene.faces()[to].source);
    }
    std::cout << fmt::format("  {} pairs of faces, {:.3f} s\n", as.size() * bs.size(),
                             answer["seconds"].get<double>());
  }
  return session.end(complete);
}

ExitStatus run(Session& session, const VisibleOptions& options) {
  if (options.seam > 0 && options.method == "sampled") {
    throw UsageError("visible: --seam goes with --method exact");
  }
  if (options.a.empty() != options.b.empty()) {
    throw UsageError("visible: name two groups of the scene, A and B, or none");
  }
  if (!options.a.empty()) return run_groups(session, options);
  if (options.all_pairs || !options.vtk.empty() || !options.format.empty()) {
    throw UsageError("visible: --all-pairs, --vtk and --format go with a scene and A B");
  }
  return run_questions(session, options);
}

}  // namespace

Command add_visible_command(CLI::App& app) {
  auto options = std::make_shared<VisibleOptions>();
  CLI::App* command = app.add_subcommand(
      "visible",
      "do two polygons, or two groups of a scene, see each other; with a witness");
  command
      ->add_option(
          "FILE", options->scene,
          "without A and B: JSON, {\"instances\": [{\"a\": [[x,y,z],...], \"b\": "
          "[...], \"occluders\": [[[x,y,z],...], ...]}, ...]}, convex polygons; "
          "with A and B: a scene, as for the other commands")
      ->required();
  command->add_option("A", options->a,
                      "group that looks: its name, or #i-j, faces i to j from 0");
  command->add_option("B", options->b, "group that is looked at");
  command
      ->add_option("--method", options->method,
                   "exact: decided, with a witness; sampled: random segments only, which "
                   "prove nothing hidden: of a scene's groups, the share that is free "
                   "(default exact)")
      ->type_name("exact|sampled")
      ->check(one_of({"exact", "sampled"}));
  command
      ->add_option(
          "--rays", options->rays,
          "number of random segments: of --method sampled (default 10000 between "
          "groups, 4096 between polygons), or tried first by exact (4096)")
      ->type_name("N")
      ->check(whole_number(1, std::numeric_limits<std::int64_t>::max()));
  command
      ->add_option("--seed", options->seed,
                   "of the random segments that are tried (default 1)")
      ->type_name("N")
      ->check(whole_number(0));
  command
      ->add_option(
          "--seam", options->seam,
          "every occluder counts as grown by half of this in its own plane, so "
          "that gaps up to W between wall pieces are closed; what that closed is "
          "listed (scene units, default 0)")
      ->type_name("W")
      ->check(number_from_zero(0x1p100));
  command->add_flag("--all-pairs", options->all_pairs,
                    "decide every pair of faces of A and B, and list them");
  command->add_flag("--check", options->check,
                    "verify the proof of each \"hidden\" by the independent checker");
  add_format_option(*command, *options);
  add_common_options(*command, *options);
  return command_of(options, run);
}

}  // namespace sightline::viewers
