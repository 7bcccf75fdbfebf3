// The part `look` of a report: exact views, their drawings, and the file they are told
// in.

#pragma once

#include <string>
#include <vector>

#include "viewers/commands/views.h"
#include "viewers/page.h"
#include "viewers/report_folder.h"

namespace sightline::viewers {

/// What has been seen for a report.
struct LookPart {
  std::size_t asked = 0;
  Json views = Json::array();    ///< with "map"; as many of the first as were done
  std::vector<std::string> svg;  ///< the drawing of each; empty where it was stopped
  std::vector<std::string> png;  ///< the same
  StageCounts predicates;

  [[nodiscard]] bool complete() const { return views.size() == asked; }
};

/// Sees and draws.  Where the request ends it, or the session does, the part is not
/// complete.  `up`: the direction that points up in the scene, and so in the drawings
/// where sight does not run along it.  Throws InvalidInput that names the question.
[[nodiscard]] LookPart look_part(Session& session, const Scene& scene,
                                 const std::vector<ViewQuestion>& questions,
                                 const Point& up, Request request);

/// {"views", "complete", "predicates"}: what `look` answers, without "map"; a view that
/// was not done is null.
[[nodiscard]] Json look_json(const LookPart& part);

/// Writes look.json, which is what `look --list` answers, and look.svg and look.png, with
/// a number in the name where there are several views.  `head`: the keys that all answers
/// have.  Returns the pictures for the page.
std::vector<PagePicture> write_look(Session& session, const LookPart& part, Json head,
                                    ReportFolder& folder);

}  // namespace sightline::viewers
