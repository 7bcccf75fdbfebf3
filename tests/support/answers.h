// What the library says of a scene, told in coordinates of another one, so that variants
// of a scene can be compared: skeletons in both modes, visibility between groups, free
// segments, events along paths.

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "linespace/face_visibility.h"
#include "linespace/occlusion.h"
#include "skeleton/build.h"
#include "skeleton/view_events.h"
#include "tests/support/generators.h"
#include "tests/support/invariant_scenes.h"
#include "tests/support/library_skeleton.h"

namespace sightline::testing {

/// One line of text for each answer, by the question.
struct Answers {
  CanonicalSkeleton solid, polygon;
  std::vector<std::string> segments, events, visible;
};

struct Questions {
  std::vector<std::array<Point, 2>> segments, paths;
  /// Names of groups that are asked whether they see each other.
  std::vector<std::array<std::string, 2>> pairs;
};

/// Segments and paths between points of the grid of halves in and around the scene.
inline Questions questions_for(const PolygonSoup& soup, std::uint64_t seed) {
  Random random(seed);
  Questions q;
  const auto half = [&](int low, int high, double unit) {
    const int x = random.integer(low, high);
    const int y = random.integer(low, high);
    return Point(unit * x, unit * y, unit * random.integer(low, high));
  };
  while (q.segments.size() < 100) {
    const Point a = half(-4, 18, 0.5);
    const Point b = half(-4, 18, 0.5);
    if (a != b) q.segments.push_back({a, b});
  }
  // Off the grid, so that a path meets no generator.
  for (int k = 0; k < 2; ++k) {
    const Point offset(0x1p-7, 0x1.8p-6, 0x1.4p-5);
    const Point from = half(-3, 9, 1) + offset;
    const Point to = half(-3, 9, 1) + 2 * offset;
    q.paths.push_back({from, to});
  }
  for (int k = 0; k < 2; ++k) {
    const int n = static_cast<int>(soup.groups.size());
    const int a = random.integer(0, n - 1);
    const int b = random.integer(0, n - 1);
    if (a != b) q.pairs.push_back({soup.groups[a].name, soup.groups[b].name});
  }
  return q;
}

inline std::string text(double x) {
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.9f", x + 0.0);
  return std::string(buffer) == "-0.000000000" ? "0.000000000" : buffer;
}

inline std::string free_segment_text(const OcclusionIndex& index, const Point& a,
                                     const Point& b) {
  std::ostringstream out;
  out << (index.is_free(a, b) ? "free" : "blocked");
  for (const Contact& c : index.contacts(a, b)) {
    out << ' ' << text(c.from) << '-' << text(c.to) << (c.blocked ? "!" : "");
  }
  if (const auto free = index.maximal_free_segment(a, b)) {
    out << " from " << text(free->from) << " to " << text(free->to);
  }
  return out.str();
}

/// What a skeleton of the scene says of a path.
inline std::vector<std::string> event_texts(const Scene& scene, const Skeleton& skeleton,
                                            const Questions& q, const Variant& v) {
  const CanonicalKeys keys(scene, v.undo);
  const EndIndex ends(scene, skeleton);
  const ViewEvents events(scene, skeleton, ends);
  std::vector<std::string> result;
  for (const auto& [a, b] : q.paths) {
    for (const ViewEvent& e : events.crossed(v.map(a), v.map(b))) {
      std::ostringstream out;
      out.precision(17);
      out << text(a[0]) << ' ' << text(b[0]) << ' ';
      std::vector<GeneratorKey> generators;
      switch (e.kind) {
        case EventKind::EV:
          generators = keys.along(skeleton.arcs[e.id]);
          break;
        case EventKind::EEE:
          generators = keys.along(skeleton.arcs[e.id]);
          break;
        case EventKind::F:
          generators = {keys.of({GeneratorKind::Face, static_cast<std::int32_t>(e.id)})};
          break;
      }
      if (e.side == 1) std::ranges::reverse(generators);
      for (const GeneratorKey& g : generators) {
        out << ' ' << g.kind;
        for (const Coordinates& p : g.points) {
          out << '(' << p[0] << ' ' << p[1] << ' ' << p[2] << ')';
        }
      }
      result.push_back(out.str());
    }
  }
  std::ranges::sort(result);
  return result;
}

/// Of a variant of the scene that the questions are about.
inline Answers answers_of(const Variant& v, const Questions& q, bool with_visible) {
  const Scene scene(v.soup);
  Answers answers;
  for (const EventMode events : {EventMode::Solid, EventMode::Polygon}) {
    SkeletonRequest request;
    request.events = events;
    request.ff = true;
    request.threads = 1;
    const Skeleton skeleton = build_skeleton(scene, request);
    const bool solid = events == EventMode::Solid;
    (solid ? answers.solid : answers.polygon) = canonical(scene, skeleton, v.undo);
    if (solid) answers.events = event_texts(scene, skeleton, q, v);
  }
  const OcclusionIndex index(scene);
  for (const auto& [a, b] : q.segments) {
    std::ostringstream out;
    out << a.transpose() << " to " << b.transpose() << ": "
        << free_segment_text(index, v.map(a), v.map(b));
    answers.segments.push_back(out.str());
  }
  if (!with_visible) return answers;
  const FaceVisibility visibility(scene);
  for (const auto& [a, b] : q.pairs) {
    VisibilityRequest request;
    request.threads = 1;
    const GroupAnswer found =
        visibility.between(scene.faces_named(a), scene.faces_named(b), false, request);
    answers.visible.push_back(a + " " + b + ": " +
                              (found.verdict == Verdict::Visible  ? "visible"
                               : found.verdict == Verdict::Hidden ? "hidden"
                                                                  : "undecided"));
  }
  return answers;
}

/// In words, at most `limit` items of each sort; empty when all is the same.
inline std::string difference(const Answers& a, const Answers& b, int limit = 2) {
  std::ostringstream out;
  const auto skeletons = [&](const std::string& mode, const CanonicalSkeleton& x,
                             const CanonicalSkeleton& y) {
    if (x == y) return;
    out << mode << ":\n" << difference(x, "the scene", y, "its variant", limit);
  };
  skeletons("solid mode", a.solid, b.solid);
  skeletons("polygon mode", a.polygon, b.polygon);
  const auto texts = [&](const std::string& what, const std::vector<std::string>& x,
                         const std::vector<std::string>& y) {
    int told = 0;
    for (const auto& [from, to, heading] : {std::tuple(&x, &y, " only in the scene: "),
                                            {&y, &x, " only in the variant: "}}) {
      std::vector<std::string> missing;
      auto sorted_from = *from;
      auto sorted_to = *to;
      std::ranges::sort(sorted_from);
      std::ranges::sort(sorted_to);
      std::ranges::set_difference(sorted_from, sorted_to, std::back_inserter(missing));
      for (const std::string& m : missing) {
        if (told++ < 2 * limit) out << what << heading << m << '\n';
      }
    }
  };
  texts("segment", a.segments, b.segments);
  texts("event", a.events, b.events);
  texts("visible", a.visible, b.visible);
  return out.str();
}

/// The number of the scene's variants (of those with this name, unless it is empty) with
/// the same answers; what differs goes to standard error.
inline int count_alike(Crowd crowd, std::uint64_t seed, const std::string& variant = {}) {
  const PolygonSoup soup = crowded_scene(crowd, seed);
  const Questions q = questions_for(soup, seed);
  const auto identity = [](const Point& p) -> Point { return p; };
  const Answers base = answers_of({"itself", soup, identity, identity}, q, true);
  int alike = 0;
  for (const Variant& v : variants_of(soup, seed)) {
    if (!variant.empty() && v.name != variant) continue;
    const std::string found = difference(base, answers_of(v, q, true));
    if (found.empty()) {
      ++alike;
      continue;
    }
    std::fprintf(stderr, "%s %d, %s:\n%s", name(crowd).c_str(), static_cast<int>(seed),
                 v.name.c_str(), found.c_str());
  }
  return alike;
}

}  // namespace sightline::testing
