#include "viewers/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "viewers/files/page_light.h"
#include "viewers/files/page_words.h"
#include "viewers/json_text.h"
#include "viewers/palette.h"
#include "viewers/queries/view_answer.h"

namespace sightline::viewers {
namespace {

constexpr const char* kStyle = R"css(
:root { --ink:#20242c; --soft:#626b7a; --line:#dfe3ea; --card:#fff; --back:#f3f5f8; }
* { box-sizing:border-box; }
body { margin:0; background:var(--back); color:var(--ink);
  font:15px/1.5 system-ui,"Segoe UI","DejaVu Sans",sans-serif; }
main { max-width:1120px; margin:0 auto; padding:28px 20px 60px; }
h1 { font-size:26px; margin:0; } h2 { font-size:18px; margin:34px 0 10px; }
p { margin:6px 0; } .soft { color:var(--soft); }
.cards { display:grid; grid-template-columns:repeat(auto-fit,minmax(150px,1fr)); gap:12px;
  margin:20px 0 6px; }
.card { background:var(--card); border:1px solid var(--line); border-radius:10px;
  padding:12px 16px; }
.card b { display:block; font-size:24px; font-variant-numeric:tabular-nums; }
figure { margin:14px 0; background:var(--card); border:1px solid var(--line);
  border-radius:10px; overflow:hidden; }
figure img { display:block; width:100%; height:auto; }
figcaption { padding:10px 16px 12px; border-top:1px solid var(--line); }
h1, figcaption { overflow-wrap:anywhere; }
td, th { overflow-wrap:break-word; }
.pair { display:grid; grid-template-columns:repeat(auto-fit,minmax(320px,1fr)); gap:14px; }
.pair figure { margin:0; }
table { border-collapse:collapse; width:100%; background:var(--card);
  border:1px solid var(--line); border-radius:10px; overflow:hidden; }
th,td { text-align:left; padding:6px 14px; border-top:1px solid var(--line);
  vertical-align:top; }
tr:first-child th { border-top:0; } th { font-weight:600; background:#f9fafc; }
td.n, th.n { text-align:right; font-variant-numeric:tabular-nums; white-space:nowrap; }
.matrix { overflow-x:auto; } .matrix table { width:auto; }
.matrix td, .matrix th { padding:2px 5px; font-size:12px; }
.matrix td.f { text-align:right; font-variant-numeric:tabular-nums; border-left:1px solid
  var(--line); }
td.share { width:34%; white-space:nowrap; }
.share i { display:inline-block; height:12px; margin-top:5px; }
td.bar { width:42%; } .bar i { display:block; height:12px; border-radius:3px;
  min-width:2px; margin-top:5px; }
.chip { display:inline-block; width:11px; height:11px; border-radius:3px; margin:0 7px 0 0; }
.legend span { margin-right:16px; white-space:nowrap; }
.note { background:#fff6e3; border:1px solid #ecd8a5; border-radius:10px;
  padding:10px 16px; margin:14px 0; }
.fine { background:#ecf7ef; border-color:#bfe0c9; }
code { font-size:13px; background:#e9edf3; padding:1px 5px; border-radius:4px; }
.two { display:grid; grid-template-columns:repeat(auto-fit,minmax(420px,1fr)); gap:18px; }
)css";

std::string seconds_text(double s) {
  if (s < 0.0995) return fmt::format("{:.1f} ms", 1e3 * s);
  return s < 9.95 ? fmt::format("{:.2f} s", s) : fmt::format("{:.1f} s", s);
}

std::string memory_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6)
                     : fmt::format("{:.2f} GB", bytes / 1e9);
}

const char* meaning(const std::string& kind) {
  static const std::map<std::string, const char*> kMeanings{
      {"EV", "lines through a vertex of one object and an edge of another"},
      {"EV_self", "vertex and edge of one object that is not convex"},
      {"EEE", "lines through an edge each of three objects"},
      {"EEE_self", "three edges, two of them of one object"},
      {"VV", "two vertices"},
      {"VEE", "a vertex, then two edges"},
      {"EVE", "an edge, a vertex, an edge"},
      {"FvE", "along a face through its vertex to an edge: support begins or ends"},
      {"EEEE", "four edges"},
      {"FEE", "across a face in its plane, to two edges: support begins or ends"},
      {"FF", "across two faces, in the planes of both"},
      {"saddle", "a corner that is not convex, along two of its edges"},
      {"pierce", "where an edge enters a face of an overlapping solid"},
      {"degenerate", "more contacts than four degrees of freedom need"}};
  const auto found = kMeanings.find(kind);
  if (found != kMeanings.end()) return found->second;
  return kind.ends_with("_self") ? "the same with two contacts on one object" : "";
}

std::string kind_rows(const Json& counts, const std::string& prefix, bool skip_empty) {
  std::int64_t most = 1;
  for (const auto& [kind, count] : counts.items()) {
    if (count.is_number()) most = std::max(most, count.get<std::int64_t>());
  }
  std::string rows;
  for (const auto& [kind, count] : counts.items()) {
    if (!count.is_number()) continue;
    const auto n = count.get<std::int64_t>();
    if (skip_empty && n == 0) continue;
    const std::string colour = hex(colour_of_kind(kind));
    rows += fmt::format(
        "<tr><td><i class=chip style=\"background:{}\"></i>{}{}</td><td "
        "class=soft>{}</td>"
        "<td class=n>{}</td>{}</tr>\n",
        colour, prefix, html_escaped(kind), meaning(kind), grouped(n),
        bar(static_cast<double>(n) / static_cast<double>(most), colour));
  }
  return rows;
}

std::string counts_section(const Json& skeleton) {
  std::string html =
      "<h2>Events by kind</h2>\n<table><tr><th>kind</th><th>what holds the line</th>"
      "<th class=n>count</th><th></th></tr>\n";
  html += kind_rows(skeleton["arcs"], "arc ", false);
  const Json& nodes = skeleton["nodes"];
  html += kind_rows(nodes, "node ", true);
  if (nodes.contains("end")) html += kind_rows(nodes["end"], "end of line, ", true);
  return html + "</table>\n";
}

std::string stages_section(const Json& report) {
  std::string html =
      "<h2>Where the time went</h2>\n<table><tr><th>stage</th><th class=n>seconds</th>"
      "<th class=n>peak memory so far</th><th></th></tr>\n";
  double most = 1e-9;
  for (const Json& stage : report["stages"]) {
    most = std::max(most, stage["seconds"].get<double>());
  }
  for (const Json& stage : report["stages"]) {
    const double s = stage["seconds"].get<double>();
    html += fmt::format("<tr><td>{}</td><td class=n>{}</td><td class=n>{}</td>{}</tr>\n",
                        html_escaped(stage["name"].get<std::string>()), seconds_text(s),
                        memory_text(stage["peak_memory_bytes"].get<double>()),
                        bar(s / most, "#7d8aa0"));
  }
  return html + "</table>\n";
}

std::string predicates_section(const Json& report) {
  const Json& counts = report["predicates"];
  double total = 0;
  for (const auto& [stage, count] : counts.items()) total += count.get<double>();
  static const std::map<std::string, std::string> kWhat{
      {"double", "floating point with a proved bound"},
      {"interval", "interval arithmetic"},
      {"exact", "exact numbers"}};
  std::string html =
      "<h2>How signs were decided</h2>\n<table><tr><th>stage</th><th></th><th class=n>"
      "decisions</th><th class=n>share</th></tr>\n";
  for (const auto& [stage, count] : counts.items()) {
    html += fmt::format(
        "<tr><td>{}</td><td class=soft>{}</td><td class=n>{}</td><td class=n>{:.4g} "
        "%</td>"
        "</tr>\n",
        stage, kWhat.at(stage), grouped(count.get<std::int64_t>()),
        total > 0 ? 100 * count.get<double>() / total : 0);
  }
  return html + "</table>\n";
}

// The scene's file without its folders, which say nothing to whom the page is sent.
std::string file_name(const Json& report) {
  const std::string file = report["scene"]["file"].get<std::string>();
  return html_escaped(file.substr(file.find_last_of('/') + 1));
}

std::string scene_section(const Json& report) {
  const Json& info = report["info"];
  const Json& edges = info["edges"];
  const auto row = [](const std::string& name, const std::string& value) {
    return fmt::format("<tr><td>{}</td><td class=n>{}</td></tr>\n", name, value);
  };
  const auto number = [](const Json& j) { return grouped(j.get<std::int64_t>()); };
  std::string html = "<h2>The scene</h2>\n<div class=two><table>\n";
  html += "<tr><th>" + file_name(report) + "</th><th></th></tr>\n";
  html += row("vertices", number(info["vertices"]));
  html += row("faces", number(info["faces"]));
  html += row("coplanar facets", number(info["facets"]));
  html += row("objects", number(info["objects"]));
  html += row("closed solids", number(info["solids"]));
  for (const auto& [kind, count] : edges.items()) {
    html += row(kind + " edges", number(count));
  }
  const Json& b = info["bounds"];
  for (const int axis : {0, 1, 2}) {
    html += row(fmt::format("{} from, to", "xyz"[axis]),
                fmt::format("{:.6g} &hellip; {:.6g}", b[0][axis].get<double>(),
                            b[1][axis].get<double>()));
  }
  html += "</table>\n<table><tr><th>group</th><th class=n>faces</th></tr>\n";
  constexpr std::size_t kShown = 16;
  const Json& groups = info["groups"];
  for (std::size_t i = 0; i < std::min(groups.size(), kShown); ++i) {
    html += row(html_escaped(groups[i]["name"].get<std::string>()),
                number(groups[i]["faces"]));
  }
  if (groups.size() > kShown) {
    html += row(fmt::format("and {} more", groups.size() - kShown), "");
  }
  return html + "</table></div>\n";
}

std::string defects_section(const Json& report) {
  const Json& info = report["info"];
  if (info["defects"].empty()) {
    return "<h2>Defects</h2>\n<p class=\"note fine\">None found.</p>\n";
  }
  std::string html = fmt::format(
      "<h2>Defects</h2>\n<p class=soft>The scene is used as it is; report.json lists up "
      "to {} of a kind with their ids.</p>\n<table><tr><th>kind</th><th "
      "class=n>count</th><th>first</th></tr>\n",
      grouped(kDefectsListed));
  for (const auto& [kind, first] : first_defects(info)) {
    html += fmt::format(
        "<tr><td>{}</td><td class=n>{}</td><td>{}</td></tr>\n", html_escaped(kind),
        grouped(info["defect_counts"][kind].get<int>()), html_escaped(first));
  }
  return html + "</table>\n";
}

std::string missing_section(const Json& report) {
  if (report["missing"].empty()) return "";
  std::string html = "<div class=note><b>This answer is not complete.</b>\n";
  for (const Json& line : report["missing"]) {
    html += "<p>" + html_escaped(line.get<std::string>()) + "</p>\n";
  }
  return html + "</div>\n";
}

std::string skeleton_cards(const Json& skeleton) {
  std::int64_t ev = 0, eee = 0, nodes = 0;
  for (const auto& [kind, n] : skeleton["arcs"].items()) {
    (kind.starts_with("EEE") ? eee : ev) += n.get<std::int64_t>();
  }
  const Json& by_kind = skeleton["nodes"];
  for (const Json& counts : {by_kind, by_kind.value("end", Json::object())}) {
    for (const auto& [kind, n] : counts.items()) {
      if (n.is_number()) nodes += n.get<std::int64_t>();
    }
  }
  return card(grouped(ev), "EV line sets (arcs)") +
         card(grouped(eee), "EEE line sets (arcs)") +
         card(grouped(nodes), "extremal lines (nodes)");
}

/// What the page tells, in a line.
std::string subject(const Json& report) {
  std::vector<std::string> parts;
  if (report.contains("skeleton")) {
    parts.emplace_back("the exact visibility skeleton, solid mode");
  }
  if (report.contains("look")) parts.emplace_back("exact views");
  if (report.contains("shadows")) parts.emplace_back("shadows of an area light");
  if (report.contains("formfactors")) parts.emplace_back("form factors");
  if (parts.empty()) parts.emplace_back("the scene");
  std::string text = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i) {
    text += (i + 1 < parts.size() ? ", "
             : parts.size() > 2   ? ", and "
                                  : " and ") +
            parts[i];
  }
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string pictures_section(const std::vector<PagePicture>& pictures) {
  std::string html;
  if (!pictures.empty()) html += figure(pictures[0]);
  if (pictures.size() > 1) {
    html += "<div class=pair>";
    for (std::size_t i = 1; i < pictures.size(); ++i) html += figure(pictures[i]);
    html += "</div>\n";
  }
  return html;
}

/// Of each view the facets of which most is seen.
std::string seen_rows(const Json& view) {
  constexpr std::size_t kShown = 8;
  const char* measure = view.contains("from") ? "solid_angle" : "area";
  std::vector<const Json*> facets;
  for (const Json& facet : view["facets"]) facets.push_back(&facet);
  std::ranges::stable_sort(facets, [&](const Json* a, const Json* b) {
    return (*a)[measure].get<double>() > (*b)[measure].get<double>();
  });
  const double most = facets.empty() ? 1 : (*facets[0])[measure].get<double>();
  std::string html;
  for (std::size_t i = 0; i < std::min(kShown, facets.size()); ++i) {
    const Json& f = *facets[i];
    const double seen = f[measure].get<double>();
    html += fmt::format(
        "<tr><td>{} of {}</td><td class=n>{}</td><td class=n>{:.6g}{}</td>{}</tr>\n",
        f["facet"].get<int>(), html_escaped(f["object"].get<std::string>()),
        f["pieces"].get<int>(), seen, view.contains("from") ? " sr" : "",
        bar(seen / most, "#7d8aa0"));
  }
  if (facets.size() > kShown) {
    html += fmt::format("<tr><td>and {} more</td><td></td><td></td><td></td></tr>\n",
                        facets.size() - kShown);
  }
  return html;
}

std::string views_section(const Json& report, const std::vector<PagePicture>& pictures) {
  if (!report.contains("look")) return "";
  std::string html = "<h2>What is seen</h2>\n";
  for (const PagePicture& picture : pictures) html += figure(picture);
  for (const Json& view : report["look"]["views"]) {
    if (view.is_null()) continue;
    html += fmt::format(
        "<table><tr><th>facets seen, {}</th><th class=n>pieces</th><th class=n>{}</th>"
        "<th></th></tr>\n",
        html_escaped(viewpoint_text(view)),
        view.contains("from") ? "solid angle" : "area");
    html += seen_rows(view) + "</table>\n";
  }
  return html;
}

std::string left_out_section(const Json& report) {
  if (report["left_out"].empty()) return "";
  // The command's scene without its folders, as in the title.
  const std::string file = report["scene"]["file"].get<std::string>();
  std::string html =
      "<h2>Not in this report</h2>\n<table><tr><th>part</th><th>why</th><th>how to get "
      "it</th></tr>\n";
  for (const Json& left : report["left_out"]) {
    std::string command = left["command"].get<std::string>();
    if (const std::size_t at = command.find(file); at != std::string::npos) {
      command.replace(at, file.size(), file.substr(file.find_last_of('/') + 1));
    }
    html +=
        fmt::format("<tr><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
                    html_escaped(left["part"].get<std::string>()),
                    html_escaped(left["why"].get<std::string>()), html_escaped(command));
  }
  return html + "</table>\n";
}

std::string files_section(const Json& report) {
  std::string html = "<h2>Files beside this page</h2>\n<p>";
  for (const Json& file : report["files"]) {
    const std::string name = html_escaped(file.get<std::string>());
    html += fmt::format("<a href=\"{}\"><code>{}</code></a> ", name, name);
  }
  return html +
         "</p>\n<p class=soft>Open <code>vtk/sightline.vtm</code> in ParaView, or "
         "<code>sightline view</code> this folder.</p>\n";
}

}  // namespace

std::string html_escaped(const std::string& text) {
  std::string out;
  for (const char c : escaped_bytes(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t byte =
          k < left ? static_cast<std::uint8_t>(bytes[i + k]) : std::uint8_t{0};
      group = group << 8 | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= left ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

std::string report_page(const Json& report, const std::vector<PagePicture>& pictures,
                        const std::vector<PagePicture>& views,
                        const std::vector<PagePicture>& light) {
  const std::string scene = file_name(report);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8>\n"
      "<meta name=viewport content=\"width=device-width,initial-scale=1\">\n"
      "<title>Sightline: {}</title>\n<style>{}</style></head>\n<body><main>\n"
      "<h1>Sightline: {}</h1>\n<p class=soft>{}. Version {}, {} arithmetic.</p>\n",
      scene, kStyle, scene, subject(report), report["version"].get<std::string>(),
      report["options"]["precision"].get<std::string>());
  html += missing_section(report);
  html += "<div class=cards>\n";
  if (report.contains("skeleton")) html += skeleton_cards(report["skeleton"]);
  if (report.contains("look")) {
    html += card(grouped(report["look"]["views"].size()), "exact views");
  }
  html += card(grouped(report["scene"]["faces"].get<std::int64_t>()), "faces");
  html += card(seconds_text(report["seconds"].get<double>()), "in all");
  html += card(memory_text(report["peak_memory_bytes"].get<double>()), "peak memory");
  html += "</div>\n";
  html += pictures_section(pictures);
  if (report.contains("skeleton")) html += counts_section(report["skeleton"]);
  html += views_section(report, views);
  html += shadows_section(report, light);
  html += factors_section(report);
  html += "<div class=two><div>" + stages_section(report) + "</div><div>" +
          predicates_section(report) + "</div></div>\n";
  html += scene_section(report);
  html += defects_section(report);
  html += left_out_section(report);
  html += files_section(report);
  return html + "</main></body></html>\n";
}

}  // namespace sightline::viewers
