// Skeletons as JSON: streamed out with or without what lies along each line, read back.

#pragma once

#include <ostream>
#include <string>
#include <string_view>

#include "skeleton/graph.h"
#include "skeleton/skeleton_lines.h"
#include "viewers/answer.h"
#include "viewers/output_file.h"

namespace sightline::viewers {

/// A Checksum of the scene's coordinates, polygons and groups (names and faces), in
/// order.
[[nodiscard]] std::string fingerprint(const Scene& scene);

/// Writes `head`, with the scene's "fingerprint" under "scene", and three more keys:
/// "list": {"nodes": [...], "arcs": [...]}, one element at a time, so that no copy of it
/// is held (EV arcs, then EEE arcs), then "complete", and "checksum", of all that is
/// before it.  With lines, each element also has its "contacts" in order and its
/// "free_segment" (null where SkeletonLines gives none, and then without contacts), an
/// arc also the "line" at the middle of its range and its "pieces".
///
/// Of the request, stop, budget and progress count.  False where these ended the list
/// before its end: what is written is JSON all the same, with "complete": false.
bool write_skeleton_json(std::ostream& stream, const Json& head, const Scene& scene,
                         const Skeleton& skeleton, const SkeletonLines* lines,
                         const Request& request = {});

/// Saves the skeleton, without lines, and commits the file.  Throws Stopped, and then
/// leaves the file uncommitted, and WriteError.
void save_skeleton_json(OutputFile& file, const Json& head, const Scene& scene,
                        const Skeleton& skeleton, const Request& request = {});

/// A skeleton read back.
struct StoredSkeleton {
  std::string file;         ///< it was read from
  std::string scene_file;   ///< the scene it was made from, as that was named
  std::string fingerprint;  ///< of that scene
  Json options;             ///< what was asked of it, as the file says
  /// The size and the seed by which the scene was perturbed first; 0: not at all.
  double perturb = 0;
  std::uint64_t seed = 1;
  Skeleton skeleton;
};

/// Reads what write_skeleton_json wrote, of a head that has "options" and the keys of
/// skeleton_json and, with ids, simplified_json.  Throws InvalidInput when the file is
/// none, has no checksum or a wrong one, or says what no skeleton does.
[[nodiscard]] StoredSkeleton read_skeleton_json(const std::string& path);

/// The same of the file's text, whatever its checksum: for tests.
[[nodiscard]] StoredSkeleton parse_skeleton_json(const std::string& path,
                                                 std::string_view text);

/// Throws InvalidInput when the skeleton is of another scene, by its fingerprint, or an
/// id of it is not one of the scene.
void check_fits(const StoredSkeleton& stored, const Scene& scene);

}  // namespace sightline::viewers
