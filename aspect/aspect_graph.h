// Aspect graphs: all views of a scene that differ, and how one comes from the other.
//
// View space is all directions (orthographic) or all points outside closed objects
// (perspective).  An *aspect* is a maximal connected open region of it from which the
// same is seen: the set of patches, or the labelled structure of the view (point_view.h).
//
//   const AspectGraph graph = find_aspects(Scene(read_mesh("solid.obj")), {});
//   std::cout << graph.aspects << ' ' << graph.adjacencies << '\n';
//
// Aspects: Koenderink and van Doorn 1979; of polyhedra: Gigus, Canny and Seidel 1991,
// Plantinga and Dyer 1990.  What is not seen yet: Good 1953; how many labels there are:
// Chao 1984.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "linespace/path_events.h"
#include "linespace/request.h"
#include "linespace/scene.h"
#include "linespace/visibility_map.h"

namespace sightline {

enum class Projection : std::uint8_t { Orthographic, Perspective };
enum class AspectMethod : std::uint8_t { Sampled, Refined, Exact };
enum class AspectLabel : std::uint8_t {
  Faces,     ///< the set of patches that are seen
  Structure  ///< the labelled structure
};
enum class Sampling : std::uint8_t {
  Regular,  ///< a geodesic sphere of 10 4^k + 2 directions, or a grid of points
  Random    ///< independent, uniform
};

struct AspectRequest : Request {
  Projection projection = Projection::Orthographic;
  AspectMethod method = AspectMethod::Exact;
  AspectLabel label = AspectLabel::Structure;
  Sampling sampling = Sampling::Regular;
  /// At least so many views where the method samples.
  int samples = 2562;
  std::uint64_t seed = 1;
  /// Perspective: view space is what of this box is free; nullopt: the whole space, and
  /// for samples the scene's box made three times as large about its middle.
  std::optional<std::array<Point, 2>> bounds;
  /// Faces of which what is seen counts in labels; empty: all.
  std::vector<int> of;
  /// AspectGraph::list is wanted.
  bool list = false;
  /// So many further random views are compared with the graph.
  int check = 0;
};

/// What independent random samples say of what they did not see.  Intervals of 95 %.
struct AspectEstimate {
  double unseen_weight;  ///< share of view space whose label no sample has
  std::array<double, 2> unseen_interval;
  double distinct_total;  ///< labels in all: a lower bound
  std::array<double, 2> distinct_interval;
  int seen_once, seen_twice;  ///< labels
};

/// How many further random views have a label that the graph knows.
struct AspectCheck {
  int views = 0, not_in_graph = 0;
  std::array<double, 2> interval{};  ///< of the share not in the graph, 95 %
};

/// What makes a wall between two aspects; of kind F facets that are seen edge-on.
using AspectWall = PathEvent;

struct AspectNeighbour {
  int aspect;
  std::vector<AspectWall> walls;  ///< each kind and its generators once
};

struct Aspect {
  /// A viewpoint of the aspect, on no wall.
  Viewpoint at;
  /// Steradians, or volume; nullopt where it is not known.
  std::optional<double> weight;
  /// The angle (radians) or distance (scene units) from `at` to the nearest wall; nullopt
  /// where it is not known.
  std::optional<double> clearance;
  std::vector<int> facets;  ///< that are seen, ascending
  std::string structure;    ///< PointView::structure at `at`
  /// Aspects with a common wall, ascending.
  std::vector<AspectNeighbour> neighbours;
};

struct AspectGraph {
  AspectMethod method = AspectMethod::Exact;  ///< what was done
  std::string why;  ///< why the method is not the one asked for; else empty
  std::size_t aspects = 0, adjacencies = 0;
  std::size_t distinct = 0;  ///< labels
  std::size_t by_visible_faces = 0, by_shape = 0;
  /// How many aspects reach to infinity, and how many do not; of exact perspective graphs
  /// without bounds, else nullopt.
  std::optional<std::size_t> unbounded, bounded;
  bool certified = false, complete = true;
  std::size_t views = 0;  ///< that were taken
  /// Refined: views and aspects after each round; the first is of the samples.
  struct Round {
    std::size_t views, aspects;
  };
  std::vector<Round> rounds = {};
  std::optional<AspectEstimate> estimate;
  std::optional<AspectCheck> check;
  std::vector<Aspect> list;  ///< where it is wanted
};

/// Throws InvalidInput for bounds without a volume, and for samples below 1; Stopped.
/// Cost: exact, of one convex solid of n facets, n^2 log n for directions and n^3 log n
/// for points; exact, of another scene, the same for n planes of corners with edges, and
/// a view for each cell; sampled, a view (point_view.h) for each sample; refined, also a
/// path (view_path.h) for each pair of neighbouring viewpoints with different labels.
[[nodiscard]] AspectGraph find_aspects(const Scene& scene, const AspectRequest& request);

}  // namespace sightline
