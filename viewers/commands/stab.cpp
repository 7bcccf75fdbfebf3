// `sightline stab`: lines through a sequence of convex portals.

#include <fmt/format.h>

#include <iostream>

#include "linespace/portals.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/questions.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

struct StabOptions : CommonOptions {
  std::string method = "exact";
  int rungs = 17;
  bool list = false;
};

std::string generator_text(const PortalGenerator& g) {
  const char letter = "VEP"[static_cast<int>(g.kind)];
  return fmt::format("{}{}.{}", letter, g.portal, g.index);
}

std::string contacts_text(const ExtremalStabbingLine& line) {
  std::string text;
  for (const StabbingContact& c : line.contacts) {
    if (!text.empty()) text += ' ';
    for (std::size_t i = 0; i < c.generators.size(); ++i) {
      text += (i == 0 ? "" : "+") + generator_text(c.generators[i]);
    }
  }
  return text;
}

Json counts_json(const PortalSequence& sequence) {
  Json counts;
  for (std::size_t i = 0; i < kStabbingKinds; ++i) {
    counts[std::string(name(static_cast<StabbingKind>(i)))] = 0;
  }
  for (const ExtremalStabbingLine& line : sequence.extremal_lines()) {
    Json& n = counts[std::string(name(line.kind))];
    n = n.get<std::int64_t>() + 1;
  }
  return counts;
}

Json list_json(const PortalSequence& sequence) {
  Json list = Json::array();
  for (const ExtremalStabbingLine& line : sequence.extremal_lines()) {
    Json contacts = Json::array();
    for (const StabbingContact& c : line.contacts) {
      Json generators = Json::array();
      for (const PortalGenerator& g : c.generators) {
        generators.push_back(
            {{"type", g.kind == PortalGenerator::Kind::Vertex ? "vertex" : "edge"},
             {"portal", g.portal},
             {"index", g.index}});
      }
      contacts.push_back({{"type", c.fixed ? "V" : "E"},
                          {"at", point_json(c.at)},
                          {"generators", std::move(generators)}});
    }
    list.push_back({{"kind", name(line.kind)},
                    {"line", points_json(line.segment)},
                    {"contacts", std::move(contacts)},
                    {"planes", line.planes}});
  }
  return list;
}

const char* room_name(StabbingRoom room) {
  static constexpr const char* kNames[] = {"none", "open", "thin", "undecided"};
  return kNames[static_cast<int>(room)];
}

/// "line" as two points: numbers, or strings "p/q" where no doubles are exact.
void add_line(Json& answer, const PortalSequence& sequence, const Request& request) {
  if (const auto w = sequence.witness(request)) {
    if (w->exact_in_doubles) {
      answer["line"] = points_json(w->points);
    } else {
      answer["line"] = {w->rational[0], w->rational[1]};
    }
    answer["line_exact"] = true;
    answer["line_inside"] = w->interior;
  } else if (!sequence.extremal_lines().empty()) {
    answer["line"] = points_json(sequence.extremal_lines().front().segment);
    answer["line_exact"] = false;
    answer["line_inside"] = false;
  }
}

std::vector<LineBlock::Polygon> drawn(const StabbingSwath& swath) {
  std::string note;
  for (const PortalGenerator& g : swath.generators) {
    note += (note.empty() ? "" : " ") + generator_text(g);
  }
  std::vector<LineBlock::Polygon> out;
  const auto add = [&](const Point& a, const Point& b, const Point& c) {
    if (a != b && b != c && c != a) out.push_back({{a, b, c}, note});
  };
  for (std::size_t i = 1; i < swath.rungs.size(); ++i) {
    const auto& [a0, a1] = swath.rungs[i - 1];
    const auto& [b0, b1] = swath.rungs[i];
    if (swath.has_vertex) {
      add(swath.vertex, a0, b0);
      add(swath.vertex, a1, b1);
    } else {
      add(a0, a1, b1);
      add(a0, b1, b0);
    }
  }
  return out;
}

void write_pictures(const StabOptions& options, const PortalsQuestion& portals,
                    const PortalSequence& sequence, const Request& computing,
                    const Request& writing) {
  std::vector<LineBlock> blocks;
  LineBlock areas{"portals", "portal", {}};
  LineBlock slits{"slits", "portal", {}};
  for (std::size_t i = 0; i < portals.size(); ++i) {
    const std::vector<Point>& p = portals[i];
    const std::string note = fmt::format("portals[{}]", i);
    if (p.size() > 2) areas.polygons.push_back({p, note});
    if (p.size() == 2) slits.pieces.push_back({p[0], p[1], note});
  }
  blocks.push_back(std::move(areas));
  blocks.push_back(std::move(slits));
  for (std::size_t kind = 0; kind < kStabbingKinds; ++kind) {
    const std::string text(name(static_cast<StabbingKind>(kind)));
    LineBlock block{"extremal_" + text, text, {}};
    for (const ExtremalStabbingLine& line : sequence.extremal_lines()) {
      if (static_cast<std::size_t>(line.kind) != kind) continue;
      block.pieces.push_back({line.segment[0], line.segment[1], contacts_text(line)});
    }
    blocks.push_back(std::move(block));
  }
  LineBlock ev{"swaths_EV", "EV", {}};
  LineBlock eee{"swaths_EEE", "EEE", {}};
  for (const StabbingSwath& swath : sequence.swaths(options.rungs, computing)) {
    std::vector<LineBlock::Polygon>& to = swath.has_vertex ? ev.polygons : eee.polygons;
    for (LineBlock::Polygon& polygon : drawn(swath)) to.push_back(std::move(polygon));
  }
  blocks.push_back(std::move(ev));
  blocks.push_back(std::move(eee));
  write_vtk_lines(options.vtk, blocks, writing);
}

void print_summary(const StabOptions& options, const Json& answer) {
  const Json& stabbable = answer["stabbable"];
  std::cout << fmt::format("{}: {} portals, {}\n", options.scene,
                           answer["scene"]["portals"].get<std::size_t>(),
                           stabbable.is_null()     ? "not decided whether stabbable"
                           : stabbable.get<bool>() ? "stabbable"
                                                   : "not stabbable");
  if (!answer["complete"].get<bool>()) {
    std::cout << fmt::format("  stopped early: what follows is of the first {} portals\n",
                             answer["portals_done"].get<std::size_t>());
  }
  if (answer.contains("room")) {
    std::cout << fmt::format("  room: {}\n", answer["room"].get<std::string>());
    for (const auto& [kind, count] : answer["extremal"].items()) {
      if (count != 0) std::cout << fmt::format("  {}: {}\n", kind, count.get<int>());
    }
  }
  std::cout << fmt::format("  {:.3f} s\n", answer["seconds"].get<double>());
}

/// So many portals are pushed.
void tell_portals(Session& session, std::size_t done, const PortalsQuestion& portals) {
  session.tell("portals",
               static_cast<double>(done) / static_cast<double>(portals.size()));
}

Json head(Session& session, const PortalsQuestion& portals, const Meter& meter,
          bool complete) {
  std::size_t corners = 0;
  for (const auto& p : portals) corners += p.size();
  return answer_head("stab", Json{{"portals", portals.size()}, {"corners", corners}},
                     complete, {session.seconds(), meter.predicates()});
}

ExitStatus finish(Session& session, const StabOptions& options, Outputs& outputs,
                  const Json& answer) {
  outputs.write_answer(answer);
  if (options.may_print()) print_summary(options, answer);
  return session.end(answer["complete"].get<bool>());
}

ExitStatus run_conservative(Session& session, const StabOptions& options,
                            Outputs& outputs, const PortalsQuestion& portals,
                            const Meter& meter) {
  SeparatingPlanesSequence sequence;
  for (const std::vector<Point>& portal : portals) {
    if (session.stopped()) break;
    sequence.push(portal);
    tell_portals(session, sequence.size(), portals);
  }
  const bool complete = sequence.size() == portals.size();
  Json answer = head(session, portals, meter, complete || !sequence.maybe_stabbable());
  answer["method"] = "conservative";
  answer["portals_done"] = sequence.size();
  // A longer sequence is not easier to stab.
  answer["stabbable"] = nullptr;
  if (complete || !sequence.maybe_stabbable()) {
    answer["stabbable"] = sequence.maybe_stabbable();
  }
  return finish(session, options, outputs, answer);
}

/// Pushes portals until the time is over; what each push did.
Json push_all(Session& session, PortalSequence& sequence,
              const PortalsQuestion& portals) {
  Json pushes = Json::array();
  for (std::size_t i = 0; i < portals.size(); ++i) {
    tell_portals(session, i, portals);
    const Meter push_meter;
    if (!sequence.push(portals[i], session.limited())) break;
    pushes.push_back({{"portal", i},
                      {"stabbable", sequence.stabbable()},
                      {"extremal", sequence.extremal_lines().size()},
                      {"candidates", sequence.last_push().candidates},
                      {"milliseconds", 1e3 * push_meter.seconds()}});
  }
  return pushes;
}

ExitStatus run(Session& session, const StabOptions& options) {
  Outputs outputs(options);
  const Meter meter;
  const PortalsQuestion portals =
      session.read([&] { return portals_question(JsonInput(options.scene)); });
  if (options.method == "conservative") {
    return run_conservative(session, options, outputs, portals, meter);
  }
  PortalSequence sequence;
  Json pushes = push_all(session, sequence, portals);
  const bool all = sequence.size() == portals.size();
  Json found;
  found["method"] = "exact";
  found["portals_done"] = sequence.size();
  found["stabbable"] = nullptr;
  if (all || !sequence.stabbable()) found["stabbable"] = sequence.stabbable();
  session.begin("a stabbing line");
  found["room"] =
      room_name(all ? sequence.room(session.limited()) : StabbingRoom::Undecided);
  found["extremal"] = counts_json(sequence);
  for (const char* key : {"line", "line_exact", "line_inside"}) found[key] = nullptr;
  if (all) add_line(found, sequence, session.limited());
  found["out_of_plane"] = sequence.out_of_plane();
  found["pushes"] = std::move(pushes);
  if (options.list) found["list"] = list_json(sequence);
  const bool complete = all && !session.stopped();
  if (!options.vtk.empty()) {
    session.write("VTK files", [&](const Request& request) {
      write_pictures(options, portals, sequence, session.limited(), request);
    });
  }
  Json answer = head(session, portals, meter, complete && session.unwritten().empty());
  answer.update(found);
  return finish(session, options, outputs, answer);
}

}  // namespace

Command add_stab_command(CLI::App& app) {
  auto options = std::make_shared<StabOptions>();
  CLI::App* command = app.add_subcommand(
      "stab",
      "lines through the convex portals of a JSON file, in order (always exact; its "
      "cheap end is --method conservative)");
  add_file_argument(
      *command, *options,
      R"(JSON: {"portals": [[[x,y,z], ...], ...]}, in scene units; convex )"
      "polygons in the order in which a line is to meet them, two points for "
      "a slit, one for a point");
  command
      ->add_option("--method", options->method,
                   "exact, or conservative: by separating planes, which may call "
                   "stabbable what is not, and finds no lines")
      ->check(one_of({"exact", "conservative"}))
      ->capture_default_str();
  command->add_flag("--list", options->list,
                    "add every extremal stabbing line, with its contacts, to the answer");
  command
      ->add_option("--rungs", options->rungs,
                   "lines drawn of each EV and EEE family in --vtk files")
      ->check(whole_number(2, 10000))
      ->capture_default_str();
  add_common_options(*command, *options);
  return command_of(options, run);
}

}  // namespace sightline::viewers
