#include "skeleton/build.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "linespace/work/large_arrays.h"
#include "linespace/work/parallel.h"
#include "skeleton/build/between_faces.h"
#include "skeleton/build/corner_views.h"
#include "skeleton/build/eee_skeleton.h"
#include "skeleton/build/face_pairs.h"
#include "skeleton/nodes/node_joiner.h"

namespace sightline {
namespace {

using internal::CornerViews;
using internal::EvPart;
using internal::NodeJoiner;
using internal::Silhouettes;
using internal::VertexView;

// Appends a view's arcs and nodes.  VV nodes are found from both ends, FvE and degenerate
// ones by several arcs, VEE and EVE ones by EEE arcs too.
void add_view(const VertexView& view, bool eee_follows, NodeJoiner& nodes,
              Skeleton& out) {
  std::vector<std::uint32_t> number(view.nodes.size());
  const auto generators_of = [&](const SkeletonNode& node) {
    return std::span(view.pool).subspan(node.first_generator, node.generator_count);
  };
  nodes.join_each(
      view.nodes.size(),
      [&](std::size_t i) {
        return std::pair(view.nodes[i].kind, generators_of(view.nodes[i]));
      },
      [&](std::size_t i) {
        const SkeletonNode& node = view.nodes[i];
        const bool by_arcs = node.kind == NodeKind::VEE || node.kind == NodeKind::EVE;
        const bool once = internal::ends_one_arc(node.kind) || (!eee_follows && by_arcs);
        const bool grazes = view.grazes[i] != 0;
        number[i] = once ? nodes.add(node, generators_of(node), grazes)
                         : nodes.join(node, generators_of(node), grazes, view.lines[i]);
      });
  internal::make_room(out.arcs, view.arcs.size());
  for (SkeletonArc arc : view.arcs) {
    for (auto& node : arc.nodes) node = number[node];
    out.arcs.push_back(arc);
  }
  auto& short_arcs = out.simplified.arcs;
  short_arcs.insert(short_arcs.end(), view.short_arcs.begin(), view.short_arcs.end());
}

void build_ev(const Silhouettes& silhouettes, const SkeletonRequest& request,
              const internal::Deadline& deadline, Skeleton& skeleton, NodeJoiner& nodes) {
  const internal::Stage stage(request, "EV arcs", deadline);
  const EvPart part = internal::ev_part(silhouettes, request);
  const std::vector<int> stars = internal::asked_stars(silhouettes, part);
  const auto runs = internal::near_each_other(silhouettes, stars);
  skeleton.vertices_asked = stars.size();
  std::optional<SkeletonLines> lines;
  if (part.by_lines) {
    lines.emplace(silhouettes.scene(), deadline.what_is_left(request));
  }
  const SkeletonLines* pieces = lines ? &*lines : nullptr;
  skeleton.stopped_by = internal::for_each_parallel(
      runs.size(), request, deadline, "EV arcs", skeleton.predicates,
      [&] {
        return std::make_unique<CornerViews>(silhouettes, part, pieces,
                                             request.part.feature_size);
      },
      [&](CornerViews& viewer, std::size_t i) {
        return viewer.views(runs[i], [&] { return deadline.passed(); });
      },
      [&](std::size_t, std::vector<VertexView>&& views) {
        for (const VertexView& view : views) {
          add_view(view, request.eee, nodes, skeleton);
        }
        skeleton.vertices_done += views.size();
        return skeleton.bytes() < request.budget_bytes;
      });
  skeleton.complete = skeleton.vertices_done == skeleton.vertices_asked;
}

// What exact numbers cannot be made of is refused at the door.
void check(const SkeletonRequest& request) {
  if (request.part.near &&
      !(request.part.near->centre.allFinite() &&
        std::isfinite(request.part.near->radius) && request.part.near->radius >= 0)) {
    throw InvalidInput("a ball needs a finite centre and a finite radius, not below 0");
  }
  if (!(std::isfinite(request.part.feature_size) && request.part.feature_size >= 0)) {
    throw InvalidInput("a feature size must be finite and not below 0");
  }
}

// Of the parts whose set-up had no time: nothing is done, and of the whole scene it is
// not known what will not be asked.
void ask_for_all(const Scene& scene, const SkeletonRequest& request, Skeleton& skeleton) {
  const auto ask = [](bool wanted, std::size_t count, std::size_t& asked) {
    if (wanted && asked == 0) asked = count;
  };
  ask(request.ev, scene.corners().size(), skeleton.vertices_asked);
  ask(request.eee, scene.edges().size(), skeleton.edges_asked);
  ask(request.ff, scene.facets().size(), skeleton.facets_asked);
}

}  // namespace

Skeleton build_skeleton(const Scene& scene, const SkeletonRequest& request) {
  check(request);
  if (const auto wider = internal::between_objects(scene, request.part)) {
    SkeletonRequest wide = request;
    wide.part = *wider;
    return internal::between_faces(scene, build_skeleton(scene, wide), request);
  }
  const internal::Deadline deadline(request);
  Skeleton skeleton;
  skeleton.events = request.events;
  skeleton.simplified = internal::simplified_by(scene, request.part.feature_size);
  const StageCounts before = thread_stage_counts();
  std::optional<Silhouettes> silhouettes;
  NodeJoiner nodes(skeleton);
  // A part that is stopped before its first step, in its set-up, throws: then the parts
  // before it are the answer.
  const auto until_stopped = [&](auto&& work) {
    try {
      work();
    } catch (const Stopped&) {
      skeleton.complete = false;
      skeleton.stopped_by =
          request.stop.stop_requested() ? StoppedBy::Request : StoppedBy::Seconds;
      ask_for_all(scene, request, skeleton);
    }
  };
  until_stopped([&] {
    silhouettes.emplace(scene, request.events, request, deadline);
    skeleton.predicates = internal::difference(thread_stage_counts(), before);
    if (request.ev) build_ev(*silhouettes, request, deadline, skeleton, nodes);
    if (request.eee) internal::add_eee(*silhouettes, request, deadline, skeleton, nodes);
  });
  nodes.finish_ends();
  if (silhouettes && request.ff) {
    until_stopped([&] {
      internal::add_face_pairs(*silhouettes, request, deadline, skeleton, nodes);
    });
  }
  return skeleton;
}

}  // namespace sightline
