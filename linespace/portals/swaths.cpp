// The one-parameter families between extremal lines.

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "linespace/portals/families.h"

namespace sightline {
namespace internal {
namespace {

/// Lines through a point and an edge, or through three edges; -1 for none.  Of edges on
/// one line, the first.
struct Family {
  int point;
  std::array<int, 3> edges;
  friend auto operator<=>(const Family&, const Family&) = default;
};

/// An edge of the line that the held line touches.
std::optional<int> touched_on(const PortalState& s, const HeldLine& held, int carrier) {
  for (const int e : held.edges) {
    if (s.carriers[e] == carrier) return e;
  }
  return std::nullopt;
}

std::vector<Family> families_of(PortalState& s, const HeldLine& held) {
  const LineFamilies families = families_at(s, held);
  std::vector<Family> out;
  for (const Pencil& pencil : families.pencils) {
    const HomogeneousPoint& p = s.points[pencil.point];
    const LineThrough& in_plane = s.edges[pencil.edge];
    for (const int e : held.edges) {
      if (!lies_on(p, s.edges[e]) &&
          in_plane_of(homogeneous(s.edges[e].from), p, in_plane) &&
          in_plane_of(homogeneous(s.edges[e].to), p, in_plane)) {
        out.push_back({pencil.point, {s.carriers[e], -1, -1}});
      }
    }
  }
  for (std::array<int, 3> triple : families.triples) {
    std::ranges::sort(triple);
    out.push_back({-1, triple});
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// The family's line through a point of its first edge, if that stabs.
std::optional<HeldLine> line_at(const PortalState& s, const Family& f, double t) {
  const LineThrough& e = s.edges[f.edges[0]];
  HomogeneousPoint x = homogeneous(e.from);
  const RingVector along = ring_difference(e.to, e.from);
  for (int i = 0; i < 3; ++i) x.x[i] = x.x[i] + along[i] * Ring(t);
  std::optional<ExactLine> line;
  if (f.point >= 0) {
    line = line_through(s.points[f.point], x);
  } else {
    line = line_through(x, s.edges[f.edges[1]], s.edges[f.edges[2]]);
  }
  if (!line) return std::nullopt;
  for (const int carrier : f.edges) {
    if (carrier < 0) continue;
    const auto touched = [&](std::size_t e) {
      return s.carriers[e] == carrier && line->meets(s.edges[e]) != SegmentContact::None;
    };
    std::size_t e = 0;
    while (e < s.edges.size() && !touched(e)) ++e;
    if (e == s.edges.size()) return std::nullopt;
  }
  HeldLine held{*line};
  for (int i = 0; i < static_cast<int>(s.portals.size()); ++i) {
    if (!meets(*line, s.portals[i]) || !add_meeting(s, held, i)) return std::nullopt;
  }
  return held;
}

std::array<Eigen::Vector3d, 2> segment(const HeldLine& held) {
  std::array<Eigen::Vector3d, 2> ends{
      rounded_place(held.line, held.meetings.front().first),
      rounded_place(held.line, held.meetings.back().last)};
  return ends;
}

PortalGenerator edge_generator(const PortalState& s, int e) {
  const int p = s.edge_portals[e];
  return {PortalGenerator::Kind::Edge, p, s.portals[p].names[e - s.first_edges[p]]};
}

class Swaths {
 public:
  Swaths(PortalState& s, int rungs, const Deadline& deadline)
      : s_(s), rungs_(std::max(rungs, 2)), deadline_(deadline) {}

  std::vector<StabbingSwath> run() {
    std::map<Family, std::vector<int>> members;
    try {
      for (int i = 0; i < static_cast<int>(s_.held.size()); ++i) {
        if (!s_.held[i].planes.empty()) continue;
        deadline_.check("stabbing lines");
        for (const Family& f : families_of(s_, s_.held[i])) members[f].push_back(i);
      }
      for (auto& [family, lines] : members) {
        if (lines.size() > 1) join(family, std::move(lines));
      }
    } catch (const Stopped&) {
      // What was found so far is told.
    }
    return std::move(out_);
  }

 private:
  /// Neighbours along the first edge, where the lines between them stab.
  void join(Family f, std::vector<int> lines) {
    lead_with_longest(f, lines);
    const LineThrough& e = s_.edges[f.edges[0]];
    std::erase_if(
        lines, [&](int i) { return s_.held[i].line.meets(e) == SegmentContact::Along; });
    std::ranges::sort(lines, [&](int i, int j) {
      return compare_along(e, s_.held[i].line, s_.held[j].line) == Sign::Negative;
    });
    for (std::size_t i = 1; i < lines.size(); ++i) add(f, lines[i - 1], lines[i]);
  }

  /// Lines of three edges may all pass one of them in nearly the same point: they are
  /// told apart along the edge on which they spread most.
  void lead_with_longest(Family& f, const std::vector<int>& lines) const {
    if (f.point >= 0) return;
    const auto spread = [&](int edge) {
      double low = 1, high = 0;
      for (const int i : lines) {
        const LineThrough& e = s_.edges[edge];
        if (s_.held[i].line.meets(e) == SegmentContact::Along) continue;
        low = std::min(low, parameter(e, i));
        high = std::max(high, parameter(e, i));
      }
      return high - low;
    };
    const auto longest = std::ranges::max_element(f.edges, {}, spread);
    std::rotate(f.edges.begin(), longest, f.edges.end());
  }

  [[nodiscard]] double parameter(const LineThrough& e, int line) const {
    const Eigen::Vector3d along = e.to - e.from;
    const Eigen::Vector3d at = s_.held[line].line.contact(e).point;
    return (at - e.from).dot(along) / along.squaredNorm();
  }

  void add(const Family& f, int a, int b) {
    deadline_.check("stabbing lines");
    // Two lines through one point span the pencil, whichever edge of it is named.
    if (f.point >= 0 &&
        !pencils_.insert({f.point, std::min(a, b), std::max(a, b)}).second) {
      return;
    }
    const LineThrough& e = s_.edges[f.edges[0]];
    const double from = parameter(e, a), to = parameter(e, b);
    if (!line_at(s_, f, from + 0.5 * (to - from))) return;
    StabbingSwath swath{{}, f.point >= 0, {0, 0, 0}, {a, b}, {}};
    if (f.point >= 0) {
      swath.vertex = rounded(s_.points[f.point]);
      for (const PortalContact& c : s_.held[a].contacts) {
        for (const PortalGenerator& g : c.generators) {
          if (at_point(g, f.point)) add_generator(swath, g);
        }
      }
    }
    for (const int carrier : f.edges) {
      if (carrier < 0) continue;
      const int touched = touched_on(s_, s_.held[a], carrier).value_or(carrier);
      swath.generators.push_back(edge_generator(s_, touched));
    }
    swath.rungs.push_back(segment(s_.held[a]));
    for (int i = 1; i + 1 < rungs_; ++i) {
      const auto held = line_at(s_, f, from + (to - from) * i / (rungs_ - 1));
      if (held) swath.rungs.push_back(segment(*held));
    }
    swath.rungs.push_back(segment(s_.held[b]));
    out_.push_back(std::move(swath));
  }

  [[nodiscard]] bool at_point(const PortalGenerator& g, int point) const {
    const HomogeneousPoint& p = s_.points[point];
    if (g.kind == PortalGenerator::Kind::Edge) {
      return lies_on(p, s_.portals[g.portal].edges[g.index]);
    }
    const HomogeneousPoint v = homogeneous(s_.portals[g.portal].corners[g.index]);
    return !precedes(p, v) && !precedes(v, p);
  }
  void add_generator(StabbingSwath& swath, PortalGenerator g) const {
    g.index = s_.portals[g.portal].names[g.index];
    swath.generators.push_back(g);
  }

  PortalState& s_;
  int rungs_;
  const Deadline& deadline_;
  std::set<std::array<int, 3>> pencils_;  // point and both lines of those looked at
  std::vector<StabbingSwath> out_;
};

}  // namespace
}  // namespace internal

std::vector<StabbingSwath> PortalSequence::swaths(int rungs,
                                                  const Request& request) const {
  const internal::Deadline deadline(request);
  internal::PortalState scratch = *state_;  // points are added to it
  return internal::Swaths(scratch, rungs, deadline).run();
}

}  // namespace sightline
