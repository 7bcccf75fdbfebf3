// `sightline transversals`: all lines that meet four of a file's segments and lines.

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "linespace/segment_transversals.h"
#include "linespace/work/stage.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/questions.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

struct TransversalsOptions : CommonOptions {
  bool list = false;
};

using Question = TransversalsQuestion;

// {"segments": [...], "lines": [...]}: numbers in the file's two arrays.
template <class Elements>
Json elements_json(const Question& question, const Elements& elements) {
  Json segments = Json::array();
  Json lines = Json::array();
  const int n = static_cast<int>(question.segments.size());
  for (const int e : elements) {
    if (e < n) {
      segments.push_back(e);
    } else {
      lines.push_back(e - n);
    }
  }
  return {{"segments", std::move(segments)}, {"lines", std::move(lines)}};
}

// From the first contact to the last; of a line with fewer than two contacts in points, a
// piece from a point of it along its direction.
std::array<Point, 2> drawn_piece(const SegmentTransversals& found, std::size_t i,
                                 const ExactLine& line) {
  const Point direction = line.direction().point;
  std::optional<std::array<Point, 2>> piece;
  for (const int e : found.contacts_of(i)) {
    const LineThrough& element = found.elements[static_cast<std::size_t>(e)];
    if (line.is_parallel(element)) continue;
    const Point p = line.contact(element).point;
    if (!piece) piece = {p, p};
    if (p.dot(direction) < (*piece)[0].dot(direction)) (*piece)[0] = p;
    if (p.dot(direction) > (*piece)[1].dot(direction)) (*piece)[1] = p;
  }
  if (piece && (*piece)[0] != (*piece)[1]) return *piece;
  const Point p = line.nearest(found.elements.front().from).point;
  return {p, p + direction};
}

Json families_json(const SegmentTransversals& found) {
  using enum FamilyKind;
  Json counts{{"count", found.families.size()}};
  const auto names = [&counts](const char* dimension,
                               std::initializer_list<FamilyKind> kinds) {
    for (const FamilyKind kind : kinds) {
      counts[dimension][std::string(family_name(kind))] = 0;
    }
  };
  names("1", {Pencil, JoinedPencils, Regulus});
  names("2", {Star, Plane, StarPlane, Congruence});
  names("3", {Complex});
  for (const TransversalFamily& f : found.families) {
    Json& n = counts[std::to_string(f.dimension)][std::string(family_name(f.kind))];
    n = n.get<std::int64_t>() + 1;
  }
  return counts;
}

Json list_json(const Question& question, const SegmentTransversals& found) {
  Json lines = Json::array();
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    internal::hear_stop_now();
    const ExactLine line = found.exact(i);
    Json j = elements_json(question, found.contacts_of(i));
    j["line"] = points_json(drawn_piece(found, i, line));
    j["rational"] = line.is_rational();
    lines.push_back(std::move(j));
  }
  Json families = Json::array();
  for (const TransversalFamily& f : found.families) {
    internal::hear_stop_now();
    Json j{{"dimension", f.dimension}, {"kind", family_name(f.kind)}};
    j.update(elements_json(question, f.elements));
    const Point p = f.sample.nearest({0, 0, 0}).point;
    j["sample"] = points_json({p, p + f.sample.direction().point});
    families.push_back(std::move(j));
  }
  return {{"lines", std::move(lines)}, {"families", std::move(families)}};
}

void write_pictures(const std::string& folder, const Question& question,
                    const SegmentTransversals& found, const Request& request) {
  LineBlock segments{"segments", "segment", {}};
  for (std::size_t i = 0; i < question.segments.size(); ++i) {
    segments.pieces.push_back({question.segments[i].from, question.segments[i].to,
                               fmt::format("segments[{}]", i)});
  }
  LineBlock lines{"lines", "segment", {}};
  for (std::size_t i = 0; i < question.lines.size(); ++i) {
    lines.pieces.push_back(
        {question.lines[i].from, question.lines[i].to, fmt::format("lines[{}]", i)});
  }
  LineBlock transversals{"transversals", "EEEE", {}};
  const internal::Stage stage(request, "VTK files");
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    internal::hear_stop_now();
    const auto [from, to] = drawn_piece(found, i, found.exact(i));
    transversals.pieces.push_back(
        {from, to, fmt::format("{}", fmt::join(found.contacts_of(i), " "))});
  }
  LineBlock families{"family_samples", "degenerate", {}};
  for (const TransversalFamily& f : found.families) {
    const Point p = f.sample.nearest({0, 0, 0}).point;
    families.pieces.push_back(
        {p, p + f.sample.direction().point,
         fmt::format("{}: {}", family_name(f.kind), fmt::join(f.elements, " "))});
  }
  write_vtk_lines(folder, {segments, lines, transversals, families}, request);
}

void print_summary(const TransversalsOptions& options, const Question& question,
                   const SegmentTransversals& found, const Json& answer) {
  std::cout << fmt::format("{}: {} segments, {} lines{}\n  {} isolated transversals\n",
                           options.scene, question.segments.size(), question.lines.size(),
                           found.complete ? "" : ", INCOMPLETE", found.line_count);
  for (const char* dimension : {"1", "2", "3"}) {
    for (const auto& [kind, count] : answer["families"][dimension].items()) {
      if (count == 0) continue;
      std::cout << fmt::format("  families of dimension {}, {}: {}\n", dimension, kind,
                               count.get<std::int64_t>());
    }
  }
  std::cout << fmt::format("  {:.3f} s\n", answer["seconds"].get<double>());
}

ExitStatus run(Session& session, const TransversalsOptions& options) {
  Outputs outputs(options);
  const Meter meter;
  const Question question =
      session.read([&] { return transversals_question(JsonInput(options.scene)); });
  TransversalRequest request;
  request.precision = options.precision;
  request.threads = options.threads;
  session.limit(request);
  request.only_count = !options.list && options.vtk.empty();
  const SegmentTransversals found =
      transversals_of_segments(question.segments, question.lines, request);
  Json answer = answer_head(
      "transversals",
      Json{{"segments", question.segments.size()}, {"lines", question.lines.size()}},
      found.complete, {session.seconds(), found.predicates});
  answer["lines"] = found.line_count;
  answer["families"] = families_json(found);
  if (options.list) {
    session.write("the list", [&](const Request& writing) {
      const internal::Stage stage(writing, "the list");
      answer["list"] = list_json(question, found);
    });
  }
  if (!options.vtk.empty()) {
    session.write("VTK files", [&](const Request& writing) {
      write_pictures(options.vtk, question, found, writing);
    });
  }
  answer["complete"] = found.complete && session.unwritten().empty();
  outputs.write_answer(answer);
  if (options.may_print()) print_summary(options, question, found, answer);
  return session.end(found.complete);
}

}  // namespace

Command add_transversals_command(CLI::App& app) {
  auto options = std::make_shared<TransversalsOptions>();
  CLI::App* command = app.add_subcommand(
      "transversals",
      "all lines that meet four of the segments and lines of a JSON file");
  add_file_argument(
      *command, *options,
      R"(JSON: {"segments": [[[x,y,z],[x,y,z]], ...], "lines": [[[x,y,z],[x,y,z]], ...]}, )"
      "in scene units; a line by two of its points; either array may be missing");
  command->add_flag("--list", options->list,
                    "add every line, with what it meets, and every family to the JSON "
                    "answer");
  add_common_options(*command, *options);
  return command_of(options, run);
}

}  // namespace sightline::viewers
