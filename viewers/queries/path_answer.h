// What is seen along a path, as JSON.

#pragma once

#include <string_view>

#include "linespace/view_path.h"
#include "viewers/answer.h"

namespace sightline::viewers {

// The words of CONTRACT.md, section look.
[[nodiscard]] std::string_view name(PathEventKind kind);  ///< "EV", "through", ...

/// {"kind", "generators"}.
[[nodiscard]] Json path_event_json(const Scene& scene, const PathEvent& event);

/// "events" in the answer of `sightline look --path`: where several happen at one
/// position, each tells what all of them change.
[[nodiscard]] Json path_events_json(const Scene& scene, const ViewPath& path);

/// "views": what holds between events, seen from some eye there; with "map" if asked for.
/// Requires that the views were kept.
[[nodiscard]] Json path_views_json(const Scene& scene, const ViewPath& path,
                                   bool with_map);

}  // namespace sightline::viewers
