#include "viewers/commands/views.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "linespace/work/parallel.h"
#include "viewers/json_text.h"
#include "viewers/queries/view_answer.h"

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

PointView view_of(const PointViewIndex& index, const ViewQuestion& question,
                  const Request& request) {
  try {
    return index.view(question.eye, request);
  } catch (const InvalidInput& refusal) {
    throw InvalidInput(fmt::format("{}: {}", question.where, refusal.what()));
  }
}

void print_facets(const Json& view) {
  constexpr std::size_t kShown = 12;
  std::vector<const Json*> facets;
  const char* measure = view.contains("from") ? "solid_angle" : "area";
  for (const Json& facet : view["facets"]) facets.push_back(&facet);
  std::ranges::stable_sort(facets, [&](const Json* a, const Json* b) {
    return (*a)[measure].get<double>() > (*b)[measure].get<double>();
  });
  for (std::size_t i = 0; i < std::min(kShown, facets.size()); ++i) {
    const Json& f = *facets[i];
    std::cout << fmt::format("    facet {} of {}, its {}: {:.6g}{} in {}\n",
                             f["facet"].get<int>(),
                             escaped_bytes(f["object"].get<std::string>()),
                             f["front"].get<bool>() ? "front" : "back",
                             f[measure].get<double>(), view.contains("from") ? " sr" : "",
                             counted(f["pieces"].get<int>(), "piece", "pieces"));
  }
  if (facets.size() > kShown) {
    std::cout << fmt::format("    and {} more that are seen (--json lists them)\n",
                             facets.size() - kShown);
  }
}

void print_view(const ViewQuestion& question, const Json& view) {
  if (view.is_null()) {
    std::cout << fmt::format("  {}: not done\n", question.where);
    return;
  }
  const auto n = [&](const char* key) { return view[key].get<std::size_t>(); };
  const bool from = view.contains("from");
  std::cout << fmt::format(
      "  {} {}{}: {}{}\n    {} seen; map: {} ({} T, {} touch, {} accident), {}, {} ({} "
      "background), {}, {}\n",
      from ? "from" : "direction", fmt::join(question.asked, ","),
      from ? fmt::format(", eye {}", view["eye"].get<std::string>()) : "",
      view["general"].get<bool>() ? "general" : "not general",
      view["accidents"].empty() ? ""
                                : fmt::format(" ({})", counted(view["accidents"].size(),
                                                               "accident", "accidents")),
      counted(view["facets"].size(), "facet", "facets"),
      counted(n("corners") + n("t_vertices") + n("touches") + n("accident_vertices"),
              "vertex", "vertices"),
      n("t_vertices"), n("touches"), n("accident_vertices"),
      counted(n("edges"), "edge", "edges"), counted(n("regions"), "region", "regions"),
      n("background_pieces"), counted(n("components"), "component", "components"),
      counted(n("seams"), "seam", "seams"));
  print_facets(view);
}

CLI::Option* add_repeated(CLI::App& command, const std::string& name,
                          std::vector<std::string>& values, const char* help) {
  return command.add_option(name, values, help)->allow_extra_args(false);
}

}  // namespace

void add_viewpoint_options(CLI::App& command, ViewpointOptions& options) {
  options.command = &command;
  add_repeated(command, "--from", options.from,
               "an eye, x,y,z in scene units; numbers or fractions p/q, as in 1/3,0,2; "
               "repeatable, as --direction is, in any mixture; answered in the order "
               "given")
      ->type_name("x,y,z");
  add_repeated(command, "--direction", options.direction,
               "an eye infinitely far away in this direction, so that sight runs against "
               "it: an orthographic view; 0,0,1 is a plan; its length says nothing")
      ->type_name("x,y,z");
}

std::vector<ViewQuestion> questions_of(Session& session, const ViewpointOptions& options,
                                       Outputs& outputs) {
  std::vector<ViewQuestion> questions;
  std::size_t from = 0, direction = 0, at = 0;
  for (const CLI::Option* option : options.command->parse_order()) {
    const std::string option_name = option->get_name();
    if (option_name == "--from") {
      questions.push_back(
          view_question(Viewpoint::Kind::Eye, option_name, options.from.at(from++)));
    } else if (option_name == "--direction") {
      questions.push_back(view_question(Viewpoint::Kind::Direction, option_name,
                                        options.direction.at(direction++)));
    } else if (option_name == "--at") {
      const std::string& file = options.at.at(at++);
      outputs.protect(file);
      for (ViewQuestion& question :
           session.read([&] { return view_questions(JsonInput(file)); })) {
        questions.push_back(std::move(question));
      }
    }
  }
  return questions;
}

std::string name_of_view(const std::string& file, std::size_t view, std::size_t views) {
  if (views == 1) return file;
  const fs::path path(file);
  const std::string numbered =
      fmt::format("{}{}{}", path.stem().string(), view, path.extension().string());
  return (path.parent_path() / numbered).string();
}

StageCounts see(const Scene& scene, const PointViewIndex& index,
                const std::vector<ViewQuestion>& questions, const ViewWish& wish,
                const Request& request, const std::function<void(SeenView)>& use) {
  // Several views share the threads, and progress counts them; a single one tells its
  // own.
  Request of_one = request;
  if (questions.size() > 1) {
    of_one.progress = nullptr;
    of_one.threads = 1;
  }
  const auto step = [&](int&, std::size_t i) {
    SeenView seen;
    seen.number = i;
    seen.view = view_of(index, questions[i], of_one);
    seen.json = view_json(scene, questions[i], seen.view, wish.map);
    if (wish.seams || wish.hidden) {
      seen.further =
          index.further_lines(questions[i].eye, wish.seams, wish.hidden, of_one);
    }
    if (wish.rows) seen.rows = view_csv(scene, i, seen.view);
    return seen;
  };
  const auto consume = [&](std::size_t, SeenView seen) {
    use(std::move(seen));
    return true;
  };
  // More would wait, each with its view, where drawing is slower than seeing.
  const auto in_flight = static_cast<std::size_t>(4 * internal::threads_of(request));
  StageCounts predicates;
  // The workers need nothing of their own.
  internal::for_each_parallel(
      questions.size(), request, internal::Deadline(request), "views", predicates,
      [] { return std::optional<int>(0); }, step, consume, in_flight);
  return predicates;
}

ViewDrawing drawing_of(const Scene& scene, const ViewQuestion& question,
                       const SeenView& seen, const PictureWish& wish) {
  try {
    return view_drawing(scene, seen.view, wish, seen.further);
  } catch (const InvalidInput& refusal) {
    throw UsageError(fmt::format("{}: {}", question.where, refusal.what()));
  }
}

void print_views(const std::vector<ViewQuestion>& questions, const Json& views) {
  constexpr std::size_t kShown = 20;
  for (std::size_t i = 0; i < std::min(kShown, views.size()); ++i) {
    print_view(questions[i], views[i]);
  }
  if (views.size() > kShown) {
    std::cout << fmt::format("  and {} more views (--json lists them)\n",
                             views.size() - kShown);
  }
}

}  // namespace sightline::viewers
