// Skeletons as JSON: streamed out with or without what lies along each line, read back.

#pragma once

#include <ostream>
#include <string>

#include "skeleton/skeleton.h"
#include "skeleton/skeleton_lines.h"
#include "viewers/answer.h"

namespace sightline::viewers {

/// Writes `head` with one more key, "list": {"nodes": [...], "arcs": [...]}, one element
/// at a time, so that no copy of it is held: EV arcs, then EEE arcs.  With lines, each
/// element also has its "contacts" in order and its "free_segment" (null where
/// SkeletonLines gives none, and then without contacts), an arc also the "line" at the
/// middle of its range and its "pieces".
///
/// Of the request, stop, budget and progress count.  False where these ended the list
/// before its end: what is written is JSON all the same, with "complete": false.
bool write_skeleton_json(std::ostream& stream, const Json& head, const Scene& scene,
                         const Skeleton& skeleton, const SkeletonLines* lines,
                         const Request& request = {});

/// A skeleton read back, with the name of the scene it was made from.
struct StoredSkeleton {
  std::string scene_file;
  Skeleton skeleton;
};

/// Reads what write_skeleton_json wrote.  Throws InvalidInput.
[[nodiscard]] StoredSkeleton read_skeleton_json(const std::string& path);

/// Throws InvalidInput when an id of the skeleton is not one of the scene.
void check_fits(const StoredSkeleton& stored, const Scene& scene);

}  // namespace sightline::viewers
