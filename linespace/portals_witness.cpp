// A stabbing line for anybody to check, and whether there is room around it.

#include <CGAL/Gmpq.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "linespace/portals_internal.h"

namespace sightline {
namespace internal {
namespace {

using Kind = PortalGenerator::Kind;
using Shape = Portal::Shape;
using Ends = std::array<Eigen::Vector3d, 2>;

/// Passes through all interiors, in order.
bool stabs_inside(const PortalState& s, const ExactLine& line) {
  const auto crosses = [&](const Portal& p) { return crosses_interior(line, p); };
  if (!std::ranges::all_of(s.portals, crosses)) return false;
  HeldLine held{line};
  for (int i = 0; i < static_cast<int>(s.portals.size()); ++i) {
    if (!add_meeting(s, held, i)) return false;
  }
  return true;
}

std::string text(const Ring& x, const Ring& w) {
  std::ostringstream out;
  out << CGAL::Gmpq(x) / CGAL::Gmpq(w);
  std::string s = out.str();
  return s.ends_with("/1") ? s.substr(0, s.size() - 2) : s;
}

StabbingWitness witness_of(const std::array<HomogeneousPoint, 2>& ends, bool interior) {
  StabbingWitness w{{rounded(ends[0]), rounded(ends[1])}, true, {}, interior};
  for (int k = 0; k < 2; ++k) {
    const HomogeneousPoint back = homogeneous(w.points[k]);
    for (int i = 0; i < 3; ++i) {
      w.rational[k][i] = text(ends[k].x[i], ends[k].w);
      w.exact_in_doubles =
          w.exact_in_doubles && is_zero(Ring(ends[k].x[i] - back.x[i] * ends[k].w));
    }
  }
  return w;
}

/// Where an extremal line passes the first and the last portal, rounded.
Ends stations(const HeldLine& held) {
  return {rounded_place(held.line, held.meetings.front().first),
          rounded_place(held.line, held.meetings.back().last)};
}

/// The same, exact; of a rational line.
std::array<HomogeneousPoint, 2> exact_stations(const HeldLine& held) {
  return {exact_place(held.line, held.meetings.front().first),
          exact_place(held.line, held.meetings.back().last)};
}

HomogeneousPoint middle(const HomogeneousPoint& p, const HomogeneousPoint& q) {
  HomogeneousPoint out{{}, p.w * q.w * Ring(2)};
  for (int i = 0; i < 3; ++i) out.x[i] = p.x[i] * q.w + q.x[i] * p.w;
  return out;
}

/// Lines between extremal ones, in doubles: what is between is not always inside, since
/// the set is not convex, so several are tried: the mean of all, means of two and of
/// three, and lines that go from an extremal one a little towards the mean.
std::optional<StabbingWitness> witness_in_doubles(const PortalState& s) {
  std::vector<Ends> ends;
  Ends mean{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const HeldLine& held : s.held) ends.push_back(stations(held));
  const double share = 1.0 / static_cast<double>(ends.size());
  for (const Ends& e : ends) {
    for (int k = 0; k < 2; ++k) mean[k] += share * e[k];
  }
  const auto attempt = [&s](const Ends& e) -> std::optional<StabbingWitness> {
    if (e[0] == e[1]) return std::nullopt;
    for (const Eigen::Vector3d& p : e) {
      if (!std::ranges::all_of(p, is_admissible)) return std::nullopt;
    }
    if (!stabs_inside(s, ExactLine::through(e[0], e[1]))) return std::nullopt;
    return witness_of({homogeneous(e[0]), homogeneous(e[1])}, true);
  };
  const auto between = [](const Ends& a, const Ends& b, double t) -> Ends {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
  };
  if (auto w = attempt(mean)) return w;
  for (const Ends& e : ends) {
    // From half-way towards the extremal line; every attempt is checked exactly, so that
    // the number of steps decides how hard to look and nothing else.
    constexpr int kSteps = 7;
    double t = 0.5;
    for (int step = 0; step < kSteps; ++step, t /= 4) {
      if (auto w = attempt(between(e, mean, t))) return w;
    }
  }
  constexpr std::size_t kTried = 24;  // bounds the triples at two thousand
  const std::size_t n = std::min(ends.size(), kTried);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Ends two = between(ends[i], ends[j], 0.5);
      if (auto w = attempt(two)) return w;
      for (std::size_t k = j + 1; k < n; ++k) {
        if (auto w = attempt(between(two, ends[k], 1.0 / 3))) return w;
      }
    }
  }
  return std::nullopt;
}

/// Where no doubles do: means of two, and of two means, of rational lines.
std::optional<StabbingWitness> witness_in_rationals(const PortalState& s) {
  std::vector<std::array<HomogeneousPoint, 2>> ends;
  constexpr std::size_t kTried = 16;
  for (const HeldLine& held : s.held) {
    if (held.line.is_rational() && ends.size() < kTried) {
      ends.push_back(exact_stations(held));
    }
  }
  std::vector<std::array<HomogeneousPoint, 2>> means;
  const auto attempt = [&](const auto& a,
                           const auto& b) -> std::optional<StabbingWitness> {
    const std::array<HomogeneousPoint, 2> m{middle(a[0], b[0]), middle(a[1], b[1])};
    if (precedes(m[0], m[1]) == precedes(m[1], m[0])) return std::nullopt;
    if (!stabs_inside(s, line_through(m[0], m[1]))) return std::nullopt;
    return witness_of(m, true);
  };
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      if (auto w = attempt(ends[i], ends[j])) return w;
      means.push_back({middle(ends[i][0], ends[j][0]), middle(ends[i][1], ends[j][1])});
    }
  }
  for (std::size_t i = 0; i < means.size(); ++i) {
    for (std::size_t j = i + 1; j < means.size(); ++j) {
      if (auto w = attempt(means[i], means[j])) return w;
    }
  }
  return std::nullopt;
}

/// Of one polygon: across its middle.
std::optional<StabbingWitness> witness_of_one(const PortalState& s) {
  const Portal& p = s.portals.front();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : p.corners)
    mean += v / static_cast<double>(p.corner_count());
  const HomogeneousPoint middle = homogeneous(mean);
  HomogeneousPoint ahead = middle;
  for (int i = 0; i < 3; ++i) ahead.x[i] = ahead.x[i] + p.normal[i];
  if (!stabs_inside(s, line_through(middle, ahead))) return std::nullopt;
  return witness_of({middle, ahead}, true);
}

std::optional<StabbingWitness> interior_witness(const PortalState& s) {
  const auto polygon = [](const Portal& p) { return p.shape == Shape::Polygon; };
  if (!std::ranges::all_of(s.portals, polygon) || s.held.empty()) return std::nullopt;
  if (s.portals.size() == 1) return witness_of_one(s);
  if (auto w = witness_in_doubles(s)) return w;
  return witness_in_rationals(s);
}

/// An extremal line that is rational, if there is one; between two corners if possible.
std::optional<StabbingWitness> extremal_witness(const PortalState& s) {
  for (const HeldLine& held : s.held) {
    if (held.points.size() < 2) continue;
    const std::array<HomogeneousPoint, 2> ends{s.points[held.points[0]],
                                               s.points[held.points[1]]};
    StabbingWitness w = witness_of(ends, false);
    if (w.exact_in_doubles) return w;
  }
  for (const HeldLine& held : s.held) {
    if (!held.line.is_rational()) continue;
    // Contacts are distinct places, and an extremal line has two at least.
    return witness_of({exact_place(held.line, held.contacts.front().at),
                       exact_place(held.line, held.contacts.back().at)},
                      false);
  }
  return std::nullopt;
}

// ---- room -----------------------------------------------------------------------------

/// Whether the line has room by its kind alone: it is held by four independent conditions
/// of single portals, so it can be moved to the inner side of all, and every portal stays
/// strictly before the next.
bool has_room(const PortalState& s, const HeldLine& held) {
  const StabbingKind kind = kind_of(held);
  if (kind == StabbingKind::InPlane || kind == StabbingKind::Degenerate) return false;
  for (const Contact& c : held.contacts) {
    if (c.generators.size() != 1) return false;
  }
  if (kind == StabbingKind::EEEE) {
    std::array<LineThrough, 4> l;
    for (int i = 0; i < 4; ++i) {
      const PortalGenerator& g = held.contacts[i].generators[0];
      l[i] = s.portals[g.portal].edges[g.index];
    }
    const TransversalClass c = transversal_class(l[0], l[1], l[2], l[3]);
    if (c != TransversalClass::Two && c != TransversalClass::OneOtherAtInfinity) {
      return false;
    }
  }
  const Ring& radicand = held.line.coordinates().radicand;
  for (std::size_t i = 1; i < held.meetings.size(); ++i) {
    const Meeting& a = held.meetings[held.forward ? i - 1 : i];
    const Meeting& b = held.meetings[held.forward ? i : i - 1];
    if (compare(a.last, b.first, radicand) != Sign::Negative) return false;
  }
  return true;
}

using Row = std::array<CGAL::Gmpq, 6>;

Row pluecker(const LineThrough& l, bool negated) {
  const RingVector d = ring_difference(l.to, l.from);
  const RingVector m = cross(ring_point(l.from), ring_point(l.to));
  Row row;
  for (int i = 0; i < 3; ++i) {
    row[i] = CGAL::Gmpq(negated ? Ring(-d[i]) : d[i]);
    row[3 + i] = CGAL::Gmpq(negated ? Ring(-m[i]) : m[i]);
  }
  return row;
}

/// Whether the rows, any fewer being independent, have positive multiples that add up to
/// zero.
bool balance(std::vector<Row> rows) {
  // Columns are the rows' multipliers; eliminate all but the last.
  const std::size_t n = rows.size();
  std::size_t rank = 0;
  std::vector<int> component;
  for (std::size_t column = 0; column + 1 < n; ++column) {
    int c = 0;
    while (c < 6 && (std::ranges::count(component, c) > 0 || rows[column][c] == 0)) ++c;
    if (c == 6) return false;
    component.push_back(c);
    ++rank;
    for (int e = 0; e < 6; ++e) {
      if (e == c || rows[column][e] == 0) continue;
      const CGAL::Gmpq factor = rows[column][e] / rows[column][c];
      for (std::size_t k = column; k < n; ++k) {
        rows[k][e] = rows[k][e] - factor * rows[k][c];
      }
    }
  }
  for (int e = 0; e < 6; ++e) {
    const auto pivot = std::ranges::find(component, e);
    const CGAL::Gmpq& last = rows[n - 1][e];
    if (pivot == component.end()) {
      if (last != 0) return false;
    } else {
      const CGAL::Gmpq& own =
          rows[static_cast<std::size_t>(pivot - component.begin())][e];
      if (!(last * own < 0)) return false;
    }
  }
  return true;
}

bool some_balance(const std::vector<Row>& rows, std::vector<Row>& chosen,
                  std::size_t next) {
  constexpr std::size_t kLargest = 5;
  if (chosen.size() >= 2 && balance(chosen)) return true;
  if (chosen.size() == kLargest) return false;
  for (std::size_t i = next; i < rows.size(); ++i) {
    chosen.push_back(rows[i]);
    if (some_balance(rows, chosen, i + 1)) return true;
    chosen.pop_back();
  }
  return false;
}

/// Proves that no line near an extremal one passes through all interiors: each such line
/// L would have side(L, e) > 0 for touched edges e (turned as the portal is crossed),
/// while positive multiples of these add up to zero identically.  A portal in whose plane
/// the line lies may be crossed either way.
bool proved_thin(const PortalState& s, const HeldLine& held) {
  std::vector<int> both;
  std::vector<std::pair<int, bool>> edges;  // number, negated
  for (const int e : held.edges) {
    const int p = s.edge_portals[e];
    if (held.meetings[p].in_plane) {
      if (std::ranges::count(both, p) == 0) both.push_back(p);
      edges.emplace_back(e, false);
      continue;
    }
    const auto crossed = std::ranges::find_if(
        s.portals[p].edges,
        [&](const LineThrough& l) { return held.line.side(l) != Sign::Zero; });
    edges.emplace_back(e, held.line.side(*crossed) == Sign::Negative);
  }
  for (unsigned choice = 0; choice < 1U << both.size(); ++choice) {
    std::vector<Row> rows, chosen;
    for (const auto& [e, negated] : edges) {
      const auto at = std::ranges::find(both, s.edge_portals[e]) - both.begin();
      rows.push_back(pluecker(s.edges[e], negated != ((choice >> at & 1U) != 0)));
    }
    if (!some_balance(rows, chosen, 0)) return false;
  }
  return true;
}

/// Some edge of `a` has `a` on one side and `b` on the other, both in one plane.
bool edge_separates(const Portal& a, const Portal& b) {
  return std::ranges::any_of(a.edges, [&](const LineThrough& e) {
    const RingVector inward = cross(a.normal, ring_difference(e.to, e.from));
    return std::ranges::none_of(b.corners, [&](const Eigen::Vector3d& v) {
      return sign_of(dot(inward, ring_difference(v, e.from))) == Sign::Positive;
    });
  });
}

/// Polygons of one plane without a common interior point: a line that passes the plane in
/// one point cannot pass both interiors.
bool apart_in_one_plane(const Portal& a, const Portal& b) {
  const PlaneSide plane(a.plane());
  const auto on_plane = [&](const Eigen::Vector3d& v) { return plane(v) == Sign::Zero; };
  return a.planar && std::ranges::all_of(b.corners, on_plane) &&
         (edge_separates(a, b) || edge_separates(b, a));
}

bool some_apart_in_one_plane(const PortalState& s) {
  for (std::size_t i = 0; i < s.portals.size(); ++i) {
    for (std::size_t j = i + 1; j < s.portals.size(); ++j) {
      if (apart_in_one_plane(s.portals[i], s.portals[j])) return true;
    }
  }
  return false;
}

}  // namespace
}  // namespace internal

std::optional<StabbingWitness> PortalSequence::witness() const {
  const internal::PortalState& s = *state_;
  if (s.portals.empty()) return std::nullopt;
  if (s.only_a_point) {
    const internal::HomogeneousPoint p = internal::homogeneous(s.portals[0].corners[0]);
    internal::HomogeneousPoint q = p;
    q.x[0] = q.x[0] + 1;
    return internal::witness_of({p, q}, false);
  }
  if (auto w = internal::interior_witness(s)) return w;
  return internal::extremal_witness(s);
}

StabbingRoom PortalSequence::room() const {
  const internal::PortalState& s = *state_;
  if (!stabbable()) return StabbingRoom::None;
  const auto polygon = [](const internal::Portal& p) {
    return p.shape == internal::Portal::Shape::Polygon;
  };
  if (!std::ranges::all_of(s.portals, polygon) || internal::some_apart_in_one_plane(s)) {
    return StabbingRoom::Thin;
  }
  if (s.portals.empty() ||
      std::ranges::any_of(s.held,
                          [&](const auto& h) { return internal::has_room(s, h); }) ||
      internal::interior_witness(s)) {
    return StabbingRoom::Open;
  }
  const bool thin = std::ranges::all_of(
      s.held, [&](const auto& h) { return internal::proved_thin(s, h); });
  return thin ? StabbingRoom::Thin : StabbingRoom::Undecided;
}

}  // namespace sightline
