// `sightline skeleton --light`: the events of a source.

#pragma once

#include <string>
#include <vector>

#include "viewers/commands/outputs.h"
#include "viewers/commands/session.h"

namespace sightline::viewers {

/// Finds the events of the source that these groups are, and writes the answer; with
/// `list` each arc with its pieces.
[[nodiscard]] ExitStatus run_light(Session& session, const CommonOptions& options,
                                   const std::vector<std::string>& groups, bool list,
                                   const Scene& scene, const StageCounts& loading,
                                   Outputs& outputs);

}  // namespace sightline::viewers
