// The one-parameter families between extremal lines.

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "linespace/portals_internal.h"

namespace sightline {
namespace internal {
namespace {

/// Lines through a point and an edge {point, edge}, or through three edges; -1 for none.
struct Family {
  int point;
  std::array<int, 3> edges;
  friend auto operator<=>(const Family&, const Family&) = default;
};

bool on_line(const HomogeneousPoint& p, const LineThrough& e) {
  const HomogeneousPoint from = homogeneous(e.from);
  RingVector to_p;
  for (int i = 0; i < 3; ++i) to_p[i] = p.x[i] - from.x[i] * p.w;
  return std::ranges::all_of(cross(to_p, ring_difference(e.to, e.from)),
                             [](const Ring& x) { return is_zero(x); });
}

std::vector<Family> families_at(const PortalState& s, const HeldLine& held) {
  std::vector<Family> out;
  const std::vector<int>& e = held.edges;
  for (const int p : held.points) {
    for (const int a : e) {
      if (!on_line(s.points[p], s.edges[a])) out.push_back({p, {a, -1, -1}});
    }
  }
  const auto same = [&](int a, int b) { return s.edge_portals[a] == s.edge_portals[b]; };
  for (std::size_t i = 0; i < e.size(); ++i) {
    for (std::size_t j = i + 1; j < e.size(); ++j) {
      for (std::size_t k = j + 1; k < e.size(); ++k) {
        if (same(e[i], e[j]) || same(e[i], e[k]) || same(e[j], e[k])) continue;
        out.push_back({-1, {e[i], e[j], e[k]}});
      }
    }
  }
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
  for (const int a : f.edges) {
    if (a >= 0 && line->meets(s.edges[a]) == SegmentContact::None) return std::nullopt;
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
  Swaths(const PortalState& s, int rungs) : s_(s), rungs_(std::max(rungs, 2)) {}

  std::vector<StabbingSwath> run() {
    std::map<Family, std::vector<int>> members;
    for (int i = 0; i < static_cast<int>(s_.held.size()); ++i) {
      if (!s_.held[i].planes.empty()) continue;
      for (const Family& f : families_at(s_, s_.held[i])) members[f].push_back(i);
    }
    for (auto& [family, lines] : members) join(family, std::move(lines));
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
    std::ranges::rotate(f.edges, longest);
  }

  [[nodiscard]] double parameter(const LineThrough& e, int line) const {
    const Eigen::Vector3d along = e.to - e.from;
    const Eigen::Vector3d at = s_.held[line].line.contact(e).point;
    return (at - e.from).dot(along) / along.squaredNorm();
  }

  void add(const Family& f, int a, int b) {
    const LineThrough& e = s_.edges[f.edges[0]];
    const double from = parameter(e, a), to = parameter(e, b);
    if (!line_at(s_, f, from + 0.5 * (to - from))) return;
    StabbingSwath swath{{}, f.point >= 0, {0, 0, 0}, {a, b}, {}};
    if (f.point >= 0) {
      swath.vertex = rounded(s_.points[f.point]);
      for (const Contact& c : s_.held[a].contacts) {
        for (const PortalGenerator& g : c.generators) {
          if (at_point(g, f.point)) add_generator(swath, g);
        }
      }
    }
    for (const int k : f.edges) {
      if (k >= 0) swath.generators.push_back(edge_generator(s_, k));
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
      return on_line(p, s_.portals[g.portal].edges[g.index]);
    }
    const HomogeneousPoint v = homogeneous(s_.portals[g.portal].corners[g.index]);
    return !precedes(p, v) && !precedes(v, p);
  }
  void add_generator(StabbingSwath& swath, PortalGenerator g) const {
    g.index = s_.portals[g.portal].names[g.index];
    swath.generators.push_back(g);
  }

  const PortalState& s_;
  int rungs_;
  std::vector<StabbingSwath> out_;
};

}  // namespace
}  // namespace internal

std::vector<StabbingSwath> PortalSequence::swaths(int rungs) const {
  return internal::Swaths(*state_, rungs).run();
}

}  // namespace sightline
