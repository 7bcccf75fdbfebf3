#include "viewers/files/page_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewers/files/page_words.h"

namespace sightline::viewers {
namespace {

std::string escaped(const Json& name) { return html_escaped(name.get<std::string>()); }

/// The shares of a receiver that are lit, in penumbra and in umbra, side by side.
std::string shares_cell(const Json& receiver) {
  const double area = receiver["area"].get<double>();
  std::string html = "<td class=share>";
  for (const auto& [key, colour] : {std::pair{"lit_area", "#f2dfa0"},
                                    {"penumbra_area", "#9c9892"},
                                    {"umbra_area", "#2b3044"}}) {
    const double share = area > 0 ? receiver[key].get<double>() / area : 0;
    html += fmt::format("<i style=\"width:{:.2f}%;background:{}\"></i>",
                        100 * std::clamp(share, 0.0, 1.0), colour);
  }
  return html + "</td>";
}

std::int64_t edges_of(const Json& mesh) {
  std::int64_t sum = 0;
  for (const auto& [kind, count] : mesh["edges"].items()) {
    sum += count.get<std::int64_t>();
  }
  return sum;
}

std::string receiver_row(const Json& r) {
  std::string html = "<tr><td>" + escaped(r["group"]) + "</td>";
  for (const char* key :
       {"area", "lit_area", "penumbra_area", "umbra_area", "away_area"}) {
    html += fmt::format("<td class=n>{:.5g}</td>", r[key].get<double>());
  }
  return html + fmt::format(
                    "<td class=n>{}</td><td class=n>{}</td><td class=n>{}</td>{}"
                    "</tr>\n",
                    grouped(r["umbra_components"].get<int>()),
                    grouped(r["mesh"]["faces"].get<std::int64_t>()),
                    grouped(edges_of(r["mesh"])), shares_cell(r));
}

std::string mesh_line(const Json& mesh) {
  std::string kinds;
  for (const auto& [kind, count] : mesh["edges"].items()) {
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ",
                         grouped(count.get<std::int64_t>()), html_escaped(kind));
  }
  return fmt::format(
      "<p class=soft>All meshes together: {} vertices, {} faces, {} views of the light "
      "that differ in structure; edges: {}.</p>\n",
      grouped(mesh["vertices"].get<std::int64_t>()),
      grouped(mesh["faces"].get<std::int64_t>()),
      grouped(mesh["structures"].get<std::int64_t>()), kinds);
}

/// White for 0, the darker the larger; by the root, so that small factors show.
std::string heat(double factor) {
  const double share = std::sqrt(std::clamp(factor, 0.0, 1.0));
  const auto mix = [&](int from, int to) {
    return static_cast<int>(std::lround(from + share * (to - from)));
  };
  return fmt::format("background:#{:02x}{:02x}{:02x}{}", mix(255, 122), mix(253, 28),
                     mix(246, 40), share > 0.62 ? ";color:#fff" : "");
}

/// Short: ".25", "2e-5", nothing for 0.
std::string short_number(double factor) {
  if (factor == 0) return "";
  if (factor >= 0.9995) return fmt::format("{:.2f}", factor);
  if (factor >= 0.0005) return fmt::format("{:.3f}", factor).substr(1);
  return fmt::format("{:.0e}", factor);
}

std::string factor_cell(double factor, bool with_number) {
  return fmt::format("<td class=f title=\"{:.10g}\" style=\"{}\">{}</td>", factor,
                     heat(factor), with_number ? short_number(factor) : "");
}

/// The heads of columns are numbers of groups.
std::string matrix_table(const Json& factors) {
  constexpr std::size_t kWithNumbers = 30;
  constexpr const char* kRest[] = {"others", "outside", "backs"};
  const Json& names = factors["groups"];
  const bool with_numbers = names.size() <= kWithNumbers;
  std::string html = "<div class=matrix><table><tr><th>from</th>";
  for (std::size_t j = 0; j < names.size(); ++j) {
    html += fmt::format("<th class=n title=\"{}\">{}</th>", escaped(names[j]), j);
  }
  for (const char* rest : kRest) html += fmt::format("<th class=n>{}</th>", rest);
  html += "</tr>\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    html += fmt::format("<tr><th>{}&nbsp;{}</th>", i, escaped(names[i]));
    const Json& row = factors["matrix"][i];
    if (row.is_null()) {
      html += fmt::format("<td colspan={} class=soft>not computed</td></tr>\n",
                          names.size() + std::size(kRest));
      continue;
    }
    for (const Json& factor : row)
      html += factor_cell(factor.get<double>(), with_numbers);
    for (const char* rest : kRest) {
      html += factor_cell(factors[rest][i].get<double>(), /*with_number=*/true);
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

}  // namespace

std::string shadows_section(const Json& report,
                            const std::vector<PagePicture>& pictures) {
  if (!report.contains("shadows")) return "";
  const Json& shadows = report["shadows"];
  std::string names;
  for (const Json& name : shadows["light"]) {
    names += (names.empty() ? "" : ", ") + escaped(name);
  }
  std::string html = fmt::format(
      "<h2>Shadows</h2>\n<p>The light is {}, by its fronts. What receives are fronts "
      "too: "
      "lit where the whole light is seen, penumbra where a part of it is, umbra where "
      "nothing is. Of the umbra, <i>away</i> would be dark without blockers: it shows "
      "the "
      "light its back.</p>\n",
      names);
  for (const PagePicture& picture : pictures) html += figure(picture);
  html +=
      "<table><tr><th>group</th><th class=n>area</th><th class=n>lit</th><th "
      "class=n>penumbra</th><th class=n>umbra</th><th class=n>away</th><th "
      "class=n>umbrae</th><th class=n>mesh faces</th><th class=n>mesh edges</th><th>lit, "
      "penumbra, umbra</th></tr>\n";
  constexpr std::size_t kShown = 100;
  const Json& receivers = shadows["receivers"];
  for (std::size_t i = 0; i < std::min(kShown, receivers.size()); ++i) {
    html += receiver_row(receivers[i]);
  }
  if (receivers.size() > kShown) {
    html += fmt::format("<tr><td colspan=10>and {} more</td></tr>\n",
                        receivers.size() - kShown);
  }
  return html + "</table>\n" + mesh_line(shadows["mesh"]);
}

std::string factors_section(const Json& report) {
  if (!report.contains("formfactors")) return "";
  const Json& factors = report["formfactors"];
  std::string html = fmt::format(
      "<h2>Form factors</h2>\n<p>Which share of what a group sends out arrives at which "
      "other; of the rest, <i>others</i> are fronts that were not asked for, "
      "<i>outside</i> leaves the scene, <i>backs</i> meets backs of faces. Nothing is "
      "normalised; no number is further off than {:.1e}. A row is a sender, a column a "
      "receiver.</p>\n",
      factors["error_bound"].get<double>());
  if (!factors.contains("matrix") || factors["matrix"].is_null()) {
    return html + fmt::format(
                      "<p class=soft>{} groups: the matrix is in "
                      "<a href=\"formfactors.csv\"><code>formfactors.csv</code></a>"
                      ".</p>\n",
                      factors["groups"].size());
  }
  return html + matrix_table(factors);
}

}  // namespace sightline::viewers
