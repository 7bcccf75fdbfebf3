// The part `shadows` of a report: what all surfaces receive of a light, a picture under
// it, and the files they are told in.

#pragma once

#include <string>
#include <vector>

#include "shadows/shadow_mesh.h"
#include "viewers/answer.h"
#include "viewers/commands/session.h"
#include "viewers/page.h"
#include "viewers/report_folder.h"

namespace sightline::viewers {

/// What has been found for a report.
struct ShadowPart {
  std::size_t asked = 0;  ///< receivers
  Shadows shadows;
  std::string png;  ///< empty where it was not drawn
  StageCounts predicates;

  [[nodiscard]] bool complete() const { return shadows.complete() && !png.empty(); }
};

/// All receivers, then the picture.  Where the request ends it the part is not complete.
/// up_axis: 0 to 2, which points up in the picture.
[[nodiscard]] ShadowPart shadow_part(const Scene& scene, const LightSource& light,
                                     int up_axis, const Request& request);

/// What `shadows` answers, without lists; and {"complete", "predicates"}.
[[nodiscard]] Json shadow_part_json(const ShadowPart& part);

/// Writes shadows.json, which is what `shadows --list` answers, shadows.csv and
/// shadows.png.  `head`: the keys that all answers have.  Returns the pictures for the
/// page.
std::vector<PagePicture> write_shadow_part(Session& session, const ShadowPart& part,
                                           Json head, ReportFolder& folder);

}  // namespace sightline::viewers
