#include "viewers/commands/report/look_part.h"

#include <fmt/format.h>

#include "viewers/files/view_svg.h"
#include "viewers/json_text.h"
#include "viewers/pictures/view_image.h"
#include "viewers/queries/view_answer.h"

namespace sightline::viewers {
namespace {

constexpr int kPixels = 1400;

std::string caption_of(const Json& view, const std::string& svg) {
  const bool from = view.contains("from");
  std::string text =
      fmt::format("What is seen {}, exactly: {} in {}, {}. ",
                  from ? "from this point" : "against this direction",
                  counted(view["facets"].size(), "facet", "facets"),
                  counted(view["regions"].get<std::size_t>(), "region", "regions"),
                  counted(view["edges"].get<std::size_t>(), "edge", "edges"));
  text += view["general"].get<bool>()
              ? "No eye near by sees another structure. "
              : "Not general: eyes near by see another structure. ";
  return text + fmt::format(
                    "<a href=\"{0}\"><code>{0}</code></a> has a name on every "
                    "line and patch.",
                    html_escaped(svg));
}

/// `up` is the scene's: where sight runs along it, the drawing has another.
ViewDrawing drawing_with_up(const Scene& scene, const PointView& view, const Point& up) {
  PictureWish wish;
  wish.up = up;
  try {
    return view_drawing(scene, view, wish);
  } catch (const InvalidInput&) {
    return view_drawing(scene, view);
  }
}

}  // namespace

LookPart look_part(Session& session, const Scene& scene,
                   const std::vector<ViewQuestion>& questions, const Point& up,
                   Request request) {
  LookPart part;
  part.asked = questions.size();
  const Meter meter;
  std::optional<PointViewIndex> index;
  try {
    index.emplace(scene, request);
  } catch (const Stopped&) {
    return part;
  }
  part.predicates = meter.predicates();
  request.budget_seconds -= meter.seconds();
  const auto draw = [&](SeenView seen) {
    part.views.push_back(std::move(seen.json));
    std::string& svg = part.svg.emplace_back();
    std::string& png = part.png.emplace_back();
    const ViewDrawing drawn = drawing_with_up(scene, seen.view, up);
    session.write("pictures of views", [&](const Request& writing) {
      svg = view_svg(scene, seen.view, drawn);
      png = encode_png(view_image(drawn, seen.view, kPixels, writing));
    });
  };
  const StageCounts seen = see(scene, *index, questions, {.map = true}, request, draw);
  part.predicates = part.predicates + seen;
  return part;
}

Json look_json(const LookPart& part) {
  Json views = part.views;
  for (Json& view : views) view.erase("map");
  while (views.size() < part.asked) views.push_back(nullptr);
  return {{"views", std::move(views)},
          {"complete", part.complete()},
          {"predicates", stage_counts(part.predicates)}};
}

std::vector<PagePicture> write_look(Session& session, const LookPart& part, Json head,
                                    ReportFolder& folder) {
  head["views"] = part.views;
  while (head["views"].size() < part.asked) head["views"].push_back(nullptr);
  session.write("look.json", [&](const Request&) {
    write_whole(folder.announce("look.json"), json_text(head) + "\n");
  });
  std::vector<PagePicture> pictures;
  for (std::size_t i = 0; i < part.png.size(); ++i) {
    if (part.png[i].empty()) continue;
    const std::string svg = name_of_view("look.svg", i, part.asked);
    const std::string png = name_of_view("look.png", i, part.asked);
    write_whole(folder.announce(svg), part.svg[i]);
    write_whole(folder.announce(png), part.png[i]);
    pictures.push_back({png, part.png[i], viewpoint_text(part.views[i]),
                        caption_of(part.views[i], svg)});
  }
  return pictures;
}

}  // namespace sightline::viewers
