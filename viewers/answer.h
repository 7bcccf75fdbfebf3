// The JSON answers: the keys that all of them have, counts, and lists.

#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "linespace/exact_position.h"
#include "linespace/generator.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "skeleton/graph.h"

namespace sightline::viewers {

/// Keys in the order they were added.
using Json = nlohmann::ordered_json;

/// The program's version, "0.1.0".
[[nodiscard]] std::string version();

/// The largest resident memory of this process so far, bytes.
[[nodiscard]] std::size_t peak_memory_bytes();

/// What an answer cost.
struct Cost {
  double seconds = 0;
  StageCounts predicates;
};

/// "command", "version", "scene", "complete", "seconds", "peak_memory_bytes",
/// "predicates".
[[nodiscard]] Json answer_head(const std::string& command, const Scene& scene,
                               bool complete, const Cost& cost);
/// The same for a question that has no scene: "scene" holds these counts of its elements,
/// such as {"segments": 3, "lines": 1}.
[[nodiscard]] Json answer_head(const std::string& command, Json counts, bool complete,
                               const Cost& cost);

/// {"file", "vertices", "faces", "edges", "objects", "facets", "solids"}, all counts.
[[nodiscard]] Json scene_counts(const Scene& scene);
/// {"double", "interval", "exact"}.
[[nodiscard]] Json stage_counts(const StageCounts& counts);
[[nodiscard]] Json point_json(const Point& p);
[[nodiscard]] Json points_json(const std::array<Point, 2>& points);
/// Exactly: numbers, or "p/q" where no double is.
[[nodiscard]] Json position_json(const ExactPosition& position);

/// The numbers in the file of a facet's polygons, ascending.
[[nodiscard]] std::vector<int> polygons_of(const Scene& scene, int facet);
/// {"type", "id", ...}: a vertex with its coordinates, an edge with its ends, a facet
/// with its polygons; and the names of its objects.
[[nodiscard]] Json generator_json(const Scene& scene, const Generator& generator);

/// Defects of a kind that info_json lists; "defect_counts" counts all.
inline constexpr int kDefectsListed = 1000;
/// What `sightline info` says about a scene, common keys left out.
[[nodiscard]] Json info_json(const Scene& scene, const std::vector<Defect>& defects);
/// Of each kind in it, the message of the first defect.
[[nodiscard]] std::map<std::string, std::string> first_defects(const Json& info);

/// Nodes and arcs by kind; kinds that every scene may have are there with 0.
[[nodiscard]] Json node_counts(const Skeleton& skeleton);
[[nodiscard]] Json arc_counts(const Skeleton& skeleton);

/// "nodes", "arcs" and how far each kind has come: "vertices_done", "vertices_asked",
/// "edges_...", "facets_...", "skeleton_bytes"; where something ended it early also
/// "stopped_by" and "missing", in words.
[[nodiscard]] Json skeleton_json(const Skeleton& skeleton);
/// "seconds", "megabytes", "interruption" or "nothing", and back; InvalidInput for
/// others.
[[nodiscard]] std::string stopped_by_name(StoppedBy what);
[[nodiscard]] StoppedBy stopped_by_from(const std::string& name);

/// One node, one arc, with generators and coordinates; without contacts and free segment.
[[nodiscard]] Json node_json(const Scene& scene, const Skeleton& skeleton,
                             std::size_t node);
[[nodiscard]] Json arc_json(const Scene& scene, const Skeleton& skeleton,
                            std::size_t arc);

/// What a feature size left out: {"feature_size", "edges", "vertices", "objects",
/// "arcs"}, all counts; with ids also "edge_ids", "vertex_ids", "object_ids",
/// "object_names" and "arc_list".
[[nodiscard]] Json simplified_json(const Scene& scene, const Simplified& simplified,
                                   bool with_ids);

/// The whole answer of `sightline skeleton`, what is asked of the skeleton left out:
/// `options` says how it was built.
[[nodiscard]] Json skeleton_answer(const Scene& scene, const Skeleton& skeleton,
                                   const Json& options, Precision precision,
                                   bool complete, const Cost& cost, bool with_ids);

StageCounts operator+(const StageCounts& a, const StageCounts& b);
StageCounts operator-(const StageCounts& a, const StageCounts& b);

}  // namespace sightline::viewers
