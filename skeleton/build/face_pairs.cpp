#include "skeleton/build/face_pairs.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "linespace/blockers/occluder_shadow.h"
#include "linespace/numbers/rational.h"
#include "linespace/sight/line_probe.h"
#include "linespace/space/shaft.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/work/parallel.h"
#include "skeleton/request.h"

namespace sightline::internal {
namespace {

Box box_of_facet(const Silhouettes& g, const Facet& facet) {
  Box box = g.face_box(facet.faces[0]);
  for (const int f : facet.faces) {
    const Box& other = g.face_box(f);
    for (int i = 0; i < 3; ++i) {
      box.min[i] = std::min(box.min[i], other.min[i]);
      box.max[i] = std::max(box.max[i], other.max[i]);
    }
  }
  return box;
}

// The plane of a facet as its first face gives it; the facet is exactly planar.
const PlaneSide& plane_of(const Silhouettes& g, int facet) {
  return g.face_plane(g.scene().facets()[facet].faces[0]);
}

std::array<ExactPoint, 3> exact_plane(const Scene& scene, int facet) {
  const auto [a, b, c] = plane_points(scene, scene.facets()[facet].faces[0]);
  return {exact_point(scene.point(a)), exact_point(scene.point(b)),
          exact_point(scene.point(c))};
}

Sign sign_of_rational(const Rational& x) {
  return x > 0 ? Sign::Positive : x < 0 ? Sign::Negative : Sign::Zero;
}

}  // namespace

FacePairs::FacePairs(const Silhouettes& silhouettes, const Bvh& facets,
                     const FacetPart& part)
    : g_(silhouettes),
      scene_(silhouettes.scene()),
      facets_(facets),
      part_(part),
      facet_stamp_(scene_.facets().size(), 0) {}

// A line in the plane that crosses the inside of the facet has points of it on both
// sides.
bool FacePairs::crosses(int facet, const PlaneSide& plane) const {
  bool front = false;
  bool back = false;
  for (const int f : scene_.facets()[facet].faces) {
    for (const int p : scene_.face_points(f)) {
      const Sign s = plane(scene_.point(p));
      front |= s == Sign::Positive;
      back |= s == Sign::Negative;
      if (front && back) return true;
    }
  }
  return false;
}

void FacePairs::visit(int f, std::vector<FoundFacePair>& out) {
  if (!scene_.facets()[f].planar) return;
  const auto [a, b, c] = plane_points(scene_, scene_.facets()[f].faces[0]);
  const Point& origin = scene_.point(a);
  const BoundedPlane bounded = plane_from(origin, scene_.point(b), scene_.point(c));
  const PlaneSide& plane = plane_of(g_, f);
  facets_.traverse(
      [&](const Box& box) {
        hear_stop();
        const CentredBox at = centred(box);
        const std::array<double, 3> from_origin{
            at.centre[0] - origin[0], at.centre[1] - origin[1], at.centre[2] - origin[2]};
        return !bounded.negative_on(from_origin, at.half) &&
               !bounded.positive_on(from_origin, at.half);
      },
      [&](std::uint32_t item) {
        const int g = static_cast<int>(item);
        if (g <= f || !part_.has(f, g) || !scene_.facets()[g].planar) return;
        if (crosses(g, plane) && crosses(f, plane_of(g_, g))) visit_pair(f, g, out);
      });
}

// The stretches of the line of the plane of `across` in the facet's faces: of a face that
// it crosses from side to side, and along flat sides.
void FacePairs::add_intervals(int facet, int across, bool of_first) {
  const PlaneSide& plane = plane_of(g_, across);
  const auto exact = exact_plane(scene_, across);
  const auto value = [&](const ExactPoint& p) {
    return exact_orient(exact[0], exact[1], exact[2], p);
  };
  std::vector<Sign> signs;
  std::vector<ExactPoint> ends;
  for (const int f : scene_.facets()[facet].faces) {
    const auto corners = scene_.face_points(f);
    const std::size_t n = corners.size();
    signs.clear();
    ends.clear();
    for (const int p : corners) signs.push_back(plane(scene_.point(p)));
    const bool crossed = std::ranges::find(signs, Sign::Positive) != signs.end() &&
                         std::ranges::find(signs, Sign::Negative) != signs.end();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t next = (k + 1) % n;
      if (!crossed) {
        const bool along = signs[k] == Sign::Zero && signs[next] == Sign::Zero;
        if (!along || scene_.edge_of_side(f, static_cast<int>(k)) >= 0) continue;
        intervals_.push_back({exact_point(scene_.point(corners[k])),
                              exact_point(scene_.point(corners[next])), of_first});
        continue;
      }
      const ExactPoint p = exact_point(scene_.point(corners[k]));
      if (signs[k] == Sign::Zero) {
        ends.push_back(p);
      } else if (signs[k] == -signs[next]) {
        const ExactPoint q = exact_point(scene_.point(corners[next]));
        const Rational x = value(p);
        ends.push_back(along(p, q, quotient(x, x - value(q))));
      }
    }
    if (ends.size() == 2) intervals_.push_back({ends[0], ends[1], of_first});
  }
}

// In order along the line; those of one facet that meet are one.
void FacePairs::merge_intervals(int axis) {
  for (Interval& i : intervals_) {
    if (i.to[axis] < i.from[axis]) std::swap(i.from, i.to);
  }
  std::sort(intervals_.begin(), intervals_.end(),
            [&](const Interval& x, const Interval& y) {
              if (x.of_first != y.of_first) return x.of_first;
              return x.from[axis] < y.from[axis];
            });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < intervals_.size(); ++i) {
    Interval& last = intervals_[kept];
    Interval& next = intervals_[i];
    if (next.of_first == last.of_first && next.from[axis] <= last.to[axis]) {
      if (last.to[axis] < next.to[axis]) last.to = std::move(next.to);
    } else {
      if (++kept != i) intervals_[kept] = std::move(next);
    }
  }
  if (!intervals_.empty()) intervals_.resize(kept + 1);
  std::sort(
      intervals_.begin(), intervals_.end(),
      [&](const Interval& x, const Interval& y) { return x.from[axis] < y.from[axis]; });
}

// Some face is certainly crossed from one side to the other inside the open segment.
bool FacePairs::surely_blocked(const ExactPoint& a, const ExactPoint& b) {
  const int face = propose_occluder(g_, rounded(a), rounded(b), facet_stamp_, 1);
  if (face < 0) return false;
  const auto corners = scene_.face_points(face);
  const auto at = [&](std::size_t k) {
    return exact_point(scene_.point(corners[k % corners.size()]));
  };
  const ExactPoint p = at(0);
  const ExactPoint q = at(1);
  const ExactPoint r = at(2);
  const Sign here = sign_of_rational(exact_orient(p, q, r, a));
  if (here == Sign::Zero || sign_of_rational(exact_orient(p, q, r, b)) != -here) {
    return false;
  }
  std::optional<Sign> side;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Sign s = sign_of_rational(exact_orient(at(k), at(k + 1), a, b));
    if (s == Sign::Zero || (side && s != *side)) return false;
    side = s;
  }
  return true;
}

void FacePairs::visit_pair(int f, int g, std::vector<FoundFacePair>& out) {
  intervals_.clear();
  add_intervals(f, g, true);
  const std::size_t of_first = intervals_.size();
  if (of_first == 0) return;
  add_intervals(g, f, false);
  if (intervals_.size() == of_first) return;
  int axis = 0;
  while (intervals_[0].from[axis] == intervals_[0].to[axis]) ++axis;
  merge_intervals(axis);
  facet_stamp_[f] = facet_stamp_[g] = 1;
  std::size_t first = 0;
  for (std::size_t i = 0; i < intervals_.size(); ++i) {
    hear_stop_now();
    const bool goes_on = [&] {
      if (i + 1 == intervals_.size()) return false;
      // Up to the farther end, should one of them contain the other.
      const ExactPoint& from = intervals_[i].from;
      const ExactPoint& to = intervals_[i].to[axis] < intervals_[i + 1].to[axis]
                                 ? intervals_[i + 1].to
                                 : intervals_[i].to;
      if (surely_blocked(from, to)) return false;
      return is_free(g_, LineScan(scene_, faces_near_line(g_, rounded(from), rounded(to)),
                                  from, to));
    }();
    if (goes_on) continue;
    const auto end = intervals_.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto begin = intervals_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto is_first = [](const Interval& x) { return x.of_first; };
    if (std::any_of(begin, end, is_first) && !std::all_of(begin, end, is_first)) {
      add_node(f, g, first, i, out);
    }
    first = i + 1;
  }
  facet_stamp_[f] = facet_stamp_[g] = 0;
}

void FacePairs::add_node(int f, int g, std::size_t first, std::size_t last,
                         std::vector<FoundFacePair>& out) {
  const ExactPoint& from = intervals_[first].from;
  const ExactPoint& to = intervals_[last].to;
  FoundFacePair found;
  found.segment = {rounded(from), rounded(to)};
  const LineScan scan(scene_, faces_near_line(g_, found.segment[0], found.segment[1]),
                      from, to);
  found.contacts = contacts_along(g_, scan, {from, to}, false, true);
  NodeContacts& contacts = found.contacts;
  const Generator both[] = {{GeneratorKind::Face, f}, {GeneratorKind::Face, g}};
  const bool only_these = std::ranges::all_of(contacts.generators, [&](const auto& x) {
    return std::ranges::find(both, x) != std::end(both);
  });
  if (only_these) {
    // One generator each, however often the line crosses a facet.
    contacts.kind = NodeKind::FF;
    contacts.end = false;
    contacts.self = scene_.facets()[f].object == scene_.facets()[g].object;
    contacts.turned = !intervals_[first].of_first;
    contacts.generators.assign(std::begin(both), std::end(both));
  }
  if (contacts.turned) std::swap(found.segment[0], found.segment[1]);
  out.push_back(std::move(found));
}

namespace {

void add_pair(const FoundFacePair& found, NodeJoiner& nodes) {
  const NodeContacts& contacts = found.contacts;
  SkeletonNode node;
  node.kind = contacts.kind;
  node.self = contacts.self;
  node.end = contacts.end;
  node.segment = found.segment;
  if (node.kind == NodeKind::Degenerate) {
    nodes.add_if_new(node, contacts.generators, contacts.line);
  } else {
    nodes.add(node, contacts.generators, true);
  }
}

}  // namespace

void add_face_pairs(const Silhouettes& silhouettes, const SkeletonRequest& request,
                    const Deadline& deadline, Skeleton& skeleton, NodeJoiner& nodes) {
  const Scene& scene = silhouettes.scene();
  const FacetPart part = facet_part(silhouettes, request);
  std::vector<int> firsts;
  for (std::size_t f = 0; f < scene.facets().size(); ++f) {
    if (part.wants[f] != 0) firsts.push_back(static_cast<int>(f));
  }
  skeleton.facets_asked = firsts.size();
  if (firsts.empty() || skeleton.stopped_by != StoppedBy::Nothing) {
    skeleton.complete = skeleton.complete && firsts.empty();
    return;
  }
  const Stage stage(request, "FF nodes", deadline);
  std::vector<Box> boxes;
  for (const Facet& facet : scene.facets()) {
    boxes.push_back(box_of_facet(silhouettes, facet));
  }
  const Bvh tree(boxes);
  skeleton.stopped_by = for_each_parallel(
      firsts.size(), request, deadline, "FF nodes", skeleton.predicates,
      [&] { return std::make_unique<FacePairs>(silhouettes, tree, part); },
      [&](FacePairs& pairs, std::size_t i) {
        std::vector<FoundFacePair> found;
        pairs.visit(firsts[i], found);
        std::ranges::sort(found, {}, [](const FoundFacePair& x) {
          return std::pair(x.contacts.generators, x.segment[0][0]);
        });
        return found;
      },
      [&](std::size_t, std::vector<FoundFacePair>&& found) {
        for (const FoundFacePair& one : found) add_pair(one, nodes);
        ++skeleton.facets_done;
        return skeleton.bytes() < request.budget_bytes;
      });
  skeleton.complete = skeleton.complete && skeleton.facets_done == skeleton.facets_asked;
}

}  // namespace sightline::internal
