#include "linespace/portals/families.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "linespace/portals/nearby.h"

namespace sightline::internal {
namespace {

using Kind = PortalGenerator::Kind;
using Shape = Portal::Shape;

RingVector direction(const LineThrough& e) { return ring_difference(e.to, e.from); }

/// The sign of det(direction of the line, u, v): Zero when e and f, both of which meet
/// the line, lie in one plane with it (or are parallel).
Sign turn(const ExactLine& line, const LineThrough& e, const LineThrough& f) {
  const ExactLine::Coordinates& c = line.coordinates();
  const Eigen::Vector3d u = e.to - e.from, v = f.to - f.from;
  // In doubles first.  With e = 2^-53: components of d are off by 16 e, of u and v by e;
  // a difference of two products adds 2 e, the product with d and two sums 3 e.  That is
  // under 32 e of the sum of all magnitudes, second order and its own rounding included.
  // Underflow: as for rounded_side() in exact_line.cpp.
  double value = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double x = u[j] * v[k], y = u[k] * v[j];
    value += c.rounded[i] * (x - y);
    size += std::abs(c.rounded[i]) * (std::abs(x) + std::abs(y));
  }
  if (size > 0x1p-600 && std::abs(value) > 32 * kUnit * size) return sign_of(value);
  const RingVector n = cross(direction(e), direction(f));
  return sign_of(c.d[0] * n[0] + c.d[1] * n[1] + c.d[2] * n[2], c.radicand);
}

/// The side of `line` on which the sides of a polygon lie that it does not touch.
Sign common_side(const ExactLine& line, const Portal& polygon) {
  for (const LineThrough& e : polygon.edges) {
    const Sign s = line.side(e);
    if (s != Sign::Zero) return s;
  }
  return Sign::Zero;
}

// ---- rank -----------------------------------------------------------------------------

using Q = CGAL::Gmpq;

Q product(const PlueckerRow& a, const PlueckerRow& b) {
  Q sum = 0;
  for (int k = 0; k < 3; ++k) sum += a[k] * b[3 + k] + a[3 + k] * b[k];
  return sum;
}

/// Independent rows, each with a column that is 1 in it and 0 in all others.
class RowSpace {
 public:
  [[nodiscard]] int rank() const { return static_cast<int>(rows_.size()); }

  void add(PlueckerRow row) {
    for (std::size_t i = 0; i < rows_.size(); ++i) subtract(row, rows_[i], columns_[i]);
    int column = 0;
    while (column < 6 && row[column] == 0) ++column;
    if (column == 6) return;
    const Q scale = row[column];
    for (Q& x : row) x /= scale;
    for (PlueckerRow& other : rows_) subtract(other, row, column);
    rows_.push_back(row);
    columns_.push_back(column);
  }

  /// A basis of the lines (and other vectors) whose product with all rows is 0.
  [[nodiscard]] std::vector<PlueckerRow> complement() const {
    std::vector<PlueckerRow> basis;
    for (int column = 0; column < 6; ++column) {
      if (std::ranges::count(columns_, column) > 0) continue;
      PlueckerRow v;
      v.fill(0);
      v[column] = 1;
      for (std::size_t i = 0; i < rows_.size(); ++i) v[columns_[i]] = -rows_[i][column];
      basis.push_back({v[3], v[4], v[5], v[0], v[1], v[2]});
    }
    return basis;
  }

 private:
  static void subtract(PlueckerRow& row, const PlueckerRow& other, int column) {
    const Q factor = row[column];
    if (factor == 0) return;
    for (int k = 0; k < 6; ++k) row[k] -= factor * other[k];
  }

  std::vector<PlueckerRow> rows_;
  std::vector<int> columns_;
};

// ---- what M touches
// --------------------------------------------------------------------

/// What M touches, as a table: an edge is touched in a place of M, and spans a plane with
/// it.
class TouchTable {
 public:
  TouchTable(PortalState& state, const HeldLine& held)
      : s_(state), m_(held), places_(static_cast<int>(held.contacts.size())) {
    for (int place = 0; place < places_; ++place) add_place(place);
    for (PlaneClass& plane : planes_) find_open_places(plane);
  }

  LineFamilies families() {
    LineFamilies out;
    find_skew(out);
    find_pencils(out);
    for (const PlaneClass& plane : planes_) {
      if (const auto through = points_of(plane)) out.planes.push_back(*through);
    }
    return out;
  }

 private:
  /// Half-space of lines near M that a portal allows beside one of its edges: bounded by
  /// lines that touch the edge.
  enum class Bound {
    None,  ///< M lies in the portal's plane, and lines nearby may pass it either way
    Left,  ///< a sign, relative to the plane's normal
    Right,
    Both,  ///< a slit: all stabbing lines touch it
  };
  struct Hold {
    int edge;     // the first on its line
    int touched;  // the one that M touches
    int place, plane;
    Sign side;  // of the portal's sides, seen from M; Zero for a slit
    Bound bound;
  };
  /// Edges in one plane with M.
  struct PlaneClass {
    int edge;                            // one of them
    int axis;                            // along which the plane's normal is not 0
    int portal = -1;                     // a polygon that lies in the plane
    int other_edge = -1;                 // one on another line
    std::vector<char> open_places = {};  // where lines that leave the plane may cross it
  };

  [[nodiscard]] const LineThrough& edge(int e) const { return s_.edges[e]; }

  void add_place(int place) {
    for (const PortalGenerator& g : m_.contacts[place].generators) {
      const Portal& portal = s_.portals[g.portal];
      const Meeting& meeting = m_.meetings[g.portal];
      const bool beside = meeting.in_plane || meeting.along;
      Sign side = Sign::Zero;
      if (portal.shape == Shape::Polygon && !beside) side = common_side(m_.line, portal);
      for (const int e : s_.edges_at(g)) {
        if (beside && m_.line.meets(edge(e)) == SegmentContact::Along) {
          along_ = e;
          continue;
        }
        const int plane = plane_of(e);
        if (meeting.in_plane && portal.planar) planes_[plane].portal = g.portal;
        const Bound bound = beside                                      ? Bound::None
                            : side == Sign::Zero                        ? Bound::Both
                            : side * across(e, plane) == Sign::Positive ? Bound::Right
                                                                        : Bound::Left;
        holds_.push_back({s_.carriers[e], e, place, plane, side, bound});
      }
    }
  }

  /// A component of direction(e) x d; all edges of a plane class have multiples of one
  /// such vector.
  [[nodiscard]] Sign component(int e, int axis) const {
    const ExactLine::Coordinates& c = m_.line.coordinates();
    const RingVector u = direction(edge(e));
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    return sign_of(c.d[k] * u[j] - c.d[j] * u[k], c.radicand);
  }
  [[nodiscard]] Sign across(int e, int plane) const {
    return component(e, planes_[plane].axis);
  }

  int plane_of(int e) {
    for (const Hold& hold : holds_) {
      if (hold.edge == s_.carriers[e]) return hold.plane;
    }
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      PlaneClass& plane = planes_[i];
      if (turn(m_.line, edge(plane.edge), edge(e)) != Sign::Zero) continue;
      if (plane.other_edge < 0) plane.other_edge = e;
      return static_cast<int>(i);
    }
    int axis = 0;
    while (axis < 2 && component(e, axis) == Sign::Zero) ++axis;
    planes_.push_back({e, axis});
    return static_cast<int>(planes_.size()) - 1;
  }

  /// A line near M that crosses the plane in a place passes all edges before it above the
  /// plane and all edges behind it below, or the other way round.
  void find_open_places(PlaneClass& plane) {
    const int number = static_cast<int>(&plane - planes_.data());
    const auto n = static_cast<std::size_t>(places_);
    std::vector<unsigned> before(n + 1, 0), behind(n + 1, 0);  // bits of Bound
    std::vector<unsigned> here(n, 0);
    for (const Hold& hold : holds_) {
      if (hold.plane != number) continue;
      here[hold.place] |= hold.bound == Bound::Left    ? 1U
                          : hold.bound == Bound::Right ? 2U
                          : hold.bound == Bound::Both  ? 3U
                                                       : 0U;
    }
    for (std::size_t i = 0; i < n; ++i) before[i + 1] = before[i] | here[i];
    for (std::size_t i = n; i-- > 0;) behind[i] = behind[i + 1] | here[i];
    for (std::size_t i = 0; i < n; ++i) {
      const unsigned a = before[i], b = behind[i + 1];
      plane.open_places.push_back(a != 3 && b != 3 && (a & b) == 0 ? 1 : 0);
    }
  }

  /// Whether lines near M that miss the point at the hold's place may touch its edge
  /// there: then all other edges at this place allow the same side.
  [[nodiscard]] bool may_leave_point(const Hold& hold) const {
    Sign common = Sign::Zero;
    for (const Hold& other : holds_) {
      if (other.place != hold.place || other.plane == hold.plane ||
          other.bound == Bound::None) {
        continue;
      }
      if (other.bound == Bound::Both) return false;
      const Sign s = other.side * turn(m_.line, edge(hold.edge), edge(other.touched));
      if (common != Sign::Zero && s != common) return false;
      common = s;
    }
    return true;
  }

  /// The edges that lines near M may touch without keeping to a plane or a point.
  [[nodiscard]] std::vector<Hold> skew_holds() const {
    std::vector<Hold> free;
    for (const Hold& hold : holds_) {
      if (!planes_[hold.plane].open_places[hold.place] || !may_leave_point(hold))
        continue;
      const bool known = std::ranges::any_of(
          free, [&hold](const Hold& other) { return other.edge == hold.edge; });
      if (!known) free.push_back(hold);
    }
    return free;
  }

  static bool skew(const Hold& a, const Hold& b) {
    return a.place != b.place && a.plane != b.plane;
  }

  void find_skew(LineFamilies& out) const {
    const std::vector<Hold> free = skew_holds();
    // An edge on M is in one plane with all others.
    if (along_ >= 0) out.edges.push_back(s_.carriers[along_]);
    for (std::size_t i = 0; i < free.size(); ++i) {
      out.edges.push_back(free[i].edge);
      for (std::size_t j = i + 1; j < free.size(); ++j) {
        if (skew(free[i], free[j])) out.pairs.push_back({free[i].edge, free[j].edge});
      }
    }
    if (free.size() > 2) find_triples(free, out);
  }

  /// All holds as edges of NearbyLines, those of `free` first.
  [[nodiscard]] NearbyLines nearby(const std::vector<Hold>& free) const {
    std::vector<NearbyLines::Edge> edges;
    const auto add = [&](const Hold& hold) {
      const AllowedSide allowed = hold.bound == Bound::None     ? AllowedSide::Any
                                  : hold.bound == Bound::Both   ? AllowedSide::None
                                  : hold.side == Sign::Positive ? AllowedSide::Positive
                                                                : AllowedSide::Negative;
      edges.push_back({edge(hold.touched), allowed});
    };
    for (const Hold& hold : free) add(hold);
    for (const Hold& hold : holds_) add(hold);
    return {m_.line, edges};
  }

  /// Three edges skew to each other, once for all edges of one regulus.
  void find_triples(const std::vector<Hold>& free, LineFamilies& out) const {
    const NearbyLines lines = nearby(free);
    const int n = static_cast<int>(free.size());
    std::vector<std::vector<char>> reguli;  // of more than three edges: which are on it
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        if (!skew(free[i], free[j])) continue;
        for (int k = j + 1; k < n; ++k) {
          if (!skew(free[i], free[k]) || !skew(free[j], free[k])) continue;
          if (std::ranges::any_of(reguli, [&](const std::vector<char>& on) {
                return on[i] && on[j] && on[k];
              })) {
            continue;
          }
          const NearbyLines::Way way = lines.way(i, j, k);
          if (!lines.may_pass(way)) continue;
          out.triples.push_back({free[i].edge, free[j].edge, free[k].edge});
          std::vector<char> on = regulus(free, lines, {i, j, k});
          if (std::ranges::count(on, 1) > 3) reguli.push_back(std::move(on));
        }
      }
    }
  }

  /// Which edges are on the regulus of three: all lines that touch these touch them too.
  [[nodiscard]] std::vector<char> regulus(const std::vector<Hold>& free,
                                          const NearbyLines& lines,
                                          const std::array<int, 3>& three) const {
    std::vector<char> on(free.size(), 0);
    const NearbyLines::Way way = lines.way(three[0], three[1], three[2]);
    RowSpace space;
    for (const int i : three) {
      on[i] = 1;
      space.add(pluecker(edge(free[i].edge)));
    }
    for (std::size_t h = 0; h < free.size(); ++h) {
      if (on[h] || !lines.may_touch(way, static_cast<int>(h))) continue;
      RowSpace with = space;
      with.add(pluecker(edge(free[h].edge)));
      on[h] = with.rank() == space.rank() ? 1 : 0;
    }
    return on;
  }

  /// The plane of a class by three corners, if it is held by more than one edge.
  [[nodiscard]] std::optional<PlaneThrough> points_of(const PlaneClass& plane) const {
    if (plane.portal >= 0) return s_.portals[plane.portal].plane();
    const int other = plane.other_edge >= 0 ? plane.other_edge : along_;
    if (other < 0) return std::nullopt;
    const LineThrough& e = edge(plane.edge);
    const LineThrough& f = edge(other);
    return PlaneThrough{e.from, e.to, collinear(e.from, e.to, f.from) ? f.to : f.from};
  }

  /// An edge in the plane that is not touched in the place; nullopt when there is none.
  [[nodiscard]] std::optional<int> edge_beside(int plane, int place) const {
    std::optional<int> found;
    for (const Hold& hold : holds_) {
      if (hold.plane == plane && hold.place != place) {
        found = found ? std::min(*found, hold.edge) : hold.edge;
      }
    }
    const int portal = planes_[plane].portal;
    if (found || portal < 0) return found;
    // M only touches a corner of the polygon: a side that does not end there.
    const int point = m_.contacts[place].point;
    const int n = static_cast<int>(s_.portals[portal].edges.size());
    for (int i = 0; i < n && point >= 0; ++i) {
      const int e = s_.first_edges[portal] + i;
      if (!lies_on(s_.points[point], edge(e))) return s_.carriers[e];
    }
    return std::nullopt;
  }

  /// The point of a place, if lines in that plane are held there.
  std::optional<int> point_held(int place, const PlaneClass& plane) {
    if (m_.contacts[place].point >= 0) return m_.contacts[place].point;
    const auto through = points_of(plane);
    if (!through) return std::nullopt;
    for (const Hold& hold : holds_) {
      if (hold.place != place || &planes_[hold.plane] == &plane) continue;
      if (auto p = crossing(edge(hold.touched), *through))
        return s_.point_id(*std::move(p));
    }
    return std::nullopt;
  }

  /// Lines through a point of M cross all planes there, but for the plane they lie in.
  void find_pencils(LineFamilies& out) {
    for (int place = 0; place < places_; ++place) {
      std::vector<int> closed;
      for (int i = 0; i < static_cast<int>(planes_.size()); ++i) {
        if (!planes_[i].open_places[place]) closed.push_back(i);
      }
      if (closed.size() > 1) continue;
      if (closed.empty() && m_.contacts[place].point >= 0) {
        out.stars.push_back(m_.contacts[place].point);
      }
      for (int i = 0; i < static_cast<int>(planes_.size()); ++i) {
        if (!closed.empty() && closed.front() != i) continue;
        const auto beside = edge_beside(i, place);
        if (!beside) continue;
        if (const auto p = point_held(place, planes_[i])) {
          out.pencils.push_back({*p, *beside});
        }
      }
    }
  }

  PortalState& s_;
  const HeldLine& m_;
  int places_;
  int along_ = -1;  // an edge on M
  std::vector<Hold> holds_;
  std::vector<PlaneClass> planes_;
};

/// Three lines through a point, parallel to the axes.
void add_star(RowSpace& space, const HomogeneousPoint& p) {
  for (int k = 0; k < 3; ++k) {
    PlueckerRow row;
    row.fill(0);
    row[k] = 1;
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    row[3 + i] = Q(p.x[j]) / Q(p.w);
    row[3 + j] = -Q(p.x[i]) / Q(p.w);
    space.add(row);
  }
}

}  // namespace

PlueckerRow pluecker(const LineThrough& line) {
  const RingVector d = direction(line);
  const RingVector m = cross(ring_point(line.from), ring_point(line.to));
  return {Q(d[0]), Q(d[1]), Q(d[2]), Q(m[0]), Q(m[1]), Q(m[2])};
}

LineFamilies families_at(PortalState& state, const HeldLine& held) {
  return TouchTable(state, held).families();
}

LineFamilies all_families(PortalState& state, int portal) {
  LineFamilies out;
  for (int e = 0; e < state.first_edges[portal]; ++e) {
    if (state.carriers[e] == e) out.edges.push_back(e);
  }
  for (int i = 0; i < portal; ++i) {
    for (const Eigen::Vector3d& v : state.portals[i].corners) {
      out.stars.push_back(state.point_id(homogeneous(v)));
    }
  }
  for (const int e : out.edges) {
    for (const int p : out.stars) {
      if (!lies_on(state.points[p], state.edges[e])) out.pencils.push_back({p, e});
    }
    for (const int f : out.edges) {
      if (e < f) out.pairs.push_back({e, f});
    }
  }
  out.any_three = out.edges;
  return out;
}

// The lines that touch what `held` touches are the lines of a linear space W of dimension
// 6 - rank.  Rank 5 leaves one line.  Rank 4 leaves the zeros of a quadratic form in two
// variables: at most two lines, unless the form vanishes on W and all are a pencil.
bool is_extremal(const PortalState& state, const HeldLine& held) {
  RowSpace space;
  for (const PortalContact& c : held.contacts) {
    if (c.point >= 0) {
      add_star(space, state.points[c.point]);
    } else {
      const PortalGenerator& g = c.generators.front();
      space.add(pluecker(state.portals[g.portal].edges[g.index]));
    }
    if (space.rank() >= 5) return true;
  }
  for (const int p : held.planes) {
    if (!state.portals[p].planar) continue;
    // Three sides of a convex polygon never pass through one point.
    for (int i = 0; i < 3; ++i) space.add(pluecker(state.portals[p].edges[i]));
    if (space.rank() >= 5) return true;
  }
  if (space.rank() < 4) return false;
  const std::vector<PlueckerRow> w = space.complement();
  return product(w[0], w[0]) != 0 || product(w[0], w[1]) != 0 || product(w[1], w[1]) != 0;
}

}  // namespace sightline::internal
