// A stabbing line for anybody to check, and whether there is room around it.

#include <CGAL/Gmpq.h>

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>

#include "linespace/numbers/matrix_game.h"
#include "linespace/portals/families.h"

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
std::optional<StabbingWitness> witness_in_doubles(const PortalState& s,
                                                  const Deadline& deadline) {
  std::vector<Ends> ends;
  Ends mean{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const HeldLine& held : s.held) ends.push_back(stations(held));
  const double share = 1.0 / static_cast<double>(ends.size());
  for (const Ends& e : ends) {
    for (int k = 0; k < 2; ++k) mean[k] += share * e[k];
  }
  const auto attempt = [&](const Ends& e) -> std::optional<StabbingWitness> {
    deadline.check("stabbing lines");
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
std::optional<StabbingWitness> witness_in_rationals(const PortalState& s,
                                                    const Deadline& deadline) {
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
    deadline.check("stabbing lines");
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
  for (const PortalContact& c : held.contacts) {
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

/// The planes of portals that a line lies in.
struct PlanesAt {
  std::vector<int> portals = {};  // one a plane
  struct Member {
    std::size_t plane;
    bool aligned;  // its normal points as that of the plane's first portal
  };
  std::map<int, Member> members = {};  // all portals that lie in these planes
};

PlanesAt planes_at(const PortalState& s, const HeldLine& held) {
  PlanesAt out;
  for (const int p : held.planes) {
    const Portal& polygon = s.portals[p];
    if (!polygon.planar) continue;
    const auto same = std::ranges::find_if(out.portals, [&](int q) {
      const PlaneSide plane(s.portals[q].plane());
      return std::ranges::all_of(polygon.corners, [&](const Eigen::Vector3d& v) {
        return plane(v) == Sign::Zero;
      });
    });
    const auto plane = static_cast<std::size_t>(same - out.portals.begin());
    if (same == out.portals.end()) out.portals.push_back(p);
    const Ring along = dot(polygon.normal, s.portals[out.portals[plane]].normal);
    out.members[p] = {plane, sign_of(along) == Sign::Positive};
  }
  return out;
}

/// How lines near an extremal one can cross the planes that it lies in, one sign a plane
/// (along its normal or against it).  Seen along the line these planes are lines through
/// a point, and a line nearby is another: as that turns, one sign changes at a time.
std::vector<std::vector<Sign>> ways_across(const PortalState& s, const HeldLine& held,
                                           const std::vector<int>& planes) {
  const ExactLine::Coordinates& c = held.line.coordinates();
  const auto turn = [&](int i, int j) {
    const RingVector n = cross(s.portals[i].normal, s.portals[j].normal);
    return sign_of(c.d[0] * n[0] + c.d[1] * n[1] + c.d[2] * n[2], c.radicand);
  };
  std::vector<std::vector<Sign>> out;
  if (planes.empty()) out.emplace_back();
  for (const int i : planes) {
    // Headed along d x normal of plane i, then against it, then turned a little.
    for (const Sign way : {Sign::Positive, Sign::Negative}) {
      std::vector<Sign> signs;
      for (const int j : planes) signs.push_back(i == j ? -way : way * turn(i, j));
      out.push_back(std::move(signs));
    }
  }
  return out;
}

/// Whether some vector has a positive product with all rows.
bool all_positive_somewhere(const std::vector<PlueckerRow>& rows) {
  // The columns of the unit vectors and of their negated sum: together, with weights >=
  // 0, they reach every vector.
  ExactMatrixGame<7> game;
  for (const PlueckerRow& row : rows) {
    std::array<Rational, 7> values;
    values[6] = 0;
    for (int k = 0; k < 6; ++k) {
      std::ostringstream text;
      text << row[k];
      values[k] = Rational(text.str());
      values[6] -= values[k];
    }
    game.add(values);
  }
  if (rows.empty()) return true;
  game.solve();
  return game.positive();
}

/// The side of a line on which lines through the portal's interior near it pass the
/// portal's edges; Zero when that is not known.
Sign inner_side(const PortalState& s, const HeldLine& held, int portal,
                const PlanesAt& planes, const std::vector<Sign>& way) {
  if (held.meetings[portal].in_plane) {
    const auto member = planes.members.find(portal);
    if (member == planes.members.end()) return Sign::Zero;  // not quite planar
    const Sign across = way[member->second.plane];
    return member->second.aligned ? across : -across;
  }
  for (const LineThrough& e : s.portals[portal].edges) {
    const Sign side = held.line.side(e);
    if (side != Sign::Zero) return side;
  }
  return Sign::Zero;
}

/// Proves that no line near an extremal one passes through all interiors: each such line
/// L would have side(L, e) > 0 for all touched edges e, turned as their portals are
/// crossed, but no vector has that product with all their Pluecker coordinates.
bool proved_thin(const PortalState& s, const HeldLine& held, const Deadline& deadline) {
  const PlanesAt planes = planes_at(s, held);
  const std::vector<std::vector<Sign>> ways = ways_across(s, held, planes.portals);
  return std::ranges::none_of(ways, [&](const std::vector<Sign>& way) {
    deadline.check("stabbing lines");
    std::vector<PlueckerRow> rows;
    for (const int e : held.edges) {
      const Sign side = inner_side(s, held, s.edge_portals[e], planes, way);
      if (side == Sign::Zero) continue;
      rows.push_back(pluecker(s.edges[e]));
      if (side == Sign::Positive) continue;
      for (CGAL::Gmpq& x : rows.back()) x = -x;
    }
    return all_positive_somewhere(rows);
  });
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

/// None without stabbing lines; Open and Thin by proofs that need no witness; otherwise
/// Undecided.
StabbingRoom proved_room(const PortalState& s, const Deadline& deadline) {
  if (!s.only_a_point && s.held.empty() && !s.portals.empty()) return StabbingRoom::None;
  const auto polygon = [](const Portal& p) { return p.shape == Shape::Polygon; };
  if (!std::ranges::all_of(s.portals, polygon) || some_apart_in_one_plane(s)) {
    return StabbingRoom::Thin;
  }
  const auto open = [&](const HeldLine& held) {
    deadline.check("stabbing lines");
    return has_room(s, held);
  };
  if (s.portals.empty() || std::ranges::any_of(s.held, open)) return StabbingRoom::Open;
  const auto thin = [&](const HeldLine& held) { return proved_thin(s, held, deadline); };
  return std::ranges::all_of(s.held, thin) ? StabbingRoom::Thin : StabbingRoom::Undecided;
}

/// Where all portals lie nearly in one plane: across it, through a common point.
std::optional<StabbingWitness> witness_across(const PortalState& s) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const HeldLine& held : s.held) {
    for (const Eigen::Vector3d& p : stations(held)) {
      mean += p / static_cast<double>(2 * s.held.size());
    }
  }
  if (!std::ranges::all_of(mean, is_admissible)) return std::nullopt;
  const HomogeneousPoint middle = homogeneous(mean);
  HomogeneousPoint ahead = middle;
  for (int i = 0; i < 3; ++i) ahead.x[i] = ahead.x[i] + s.portals.front().normal[i];
  if (!stabs_inside(s, line_through(middle, ahead))) return std::nullopt;
  return witness_of({middle, ahead}, true);
}

/// A line through all interiors, if one is found.
std::optional<StabbingWitness> interior_witness(const PortalState& s,
                                                const Deadline& deadline) {
  if (auto w = witness_across(s)) return w;
  if (auto w = witness_in_doubles(s, deadline)) return w;
  return witness_in_rationals(s, deadline);
}

}  // namespace
}  // namespace internal

std::optional<StabbingWitness> PortalSequence::witness(const Request& request) const {
  const internal::PortalState& s = *state_;
  const internal::Deadline deadline(request);
  if (s.portals.empty()) return std::nullopt;
  if (s.only_a_point) {
    const internal::HomogeneousPoint p = internal::homogeneous(s.portals[0].corners[0]);
    internal::HomogeneousPoint q = p;
    q.x[0] = q.x[0] + 1;
    return internal::witness_of({p, q}, false);
  }
  try {
    const StabbingRoom room = internal::proved_room(s, deadline);
    if (room == StabbingRoom::Open || room == StabbingRoom::Undecided) {
      if (auto w = internal::interior_witness(s, deadline)) return w;
    }
  } catch (const Stopped&) {
    // An extremal line costs nothing more.
  }
  return internal::extremal_witness(s);
}

StabbingRoom PortalSequence::room(const Request& request) const {
  const internal::Deadline deadline(request);
  try {
    const StabbingRoom proved = internal::proved_room(*state_, deadline);
    if (proved != StabbingRoom::Undecided) return proved;
    if (internal::interior_witness(*state_, deadline)) return StabbingRoom::Open;
  } catch (const Stopped&) {
    // Neither proof was found.
  }
  return StabbingRoom::Undecided;
}

}  // namespace sightline
