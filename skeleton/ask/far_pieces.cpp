#include "skeleton/ask/far_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "linespace/numbers/rational.h"
#include "linespace/sight/plane_crossings.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/swaths/eee_curve.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {
namespace {

// The rays Q + l (Q - P), l >= 0, of all P and Q in two boxes, as bounds on each
// coordinate that are linear in l.
class Sweep {
 public:
  // `pad` covers the rounding of the boxes, and of what is computed below: four roundings
  // relative to the scene's size.
  Sweep(const Box& p, const Box& q, double pad) {
    for (int i = 0; i < 3; ++i) {
      low_[i] = q.min[i] - pad;
      high_[i] = q.max[i] + pad;
      low_rate_[i] = (q.min[i] - pad) - (p.max[i] + pad);
      high_rate_[i] = (q.max[i] + pad) - (p.min[i] - pad);
    }
  }

  [[nodiscard]] bool may_meet(const Box& box) const {
    double from = 0;
    double to = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      if (!clip(box.max[i] - low_[i], low_rate_[i], from, to) ||
          !clip(high_[i] - box.min[i], -high_rate_[i], from, to)) {
        return false;
      }
    }
    return true;
  }

 private:
  // Where rate * l <= room.
  static bool clip(double room, double rate, double& from, double& to) {
    if (rate > 0) {
      to = std::min(to, room / rate);
    } else if (rate < 0) {
      from = std::max(from, room / rate);
    } else if (room < 0) {
      return false;
    }
    return from <= to;
  }

  std::array<double, 3> low_, high_, low_rate_, high_rate_;
};

double size_of(const Scene& scene) {
  double size = 0;
  for (const Point& corner : scene.bounds()) {
    size = std::max(size, corner.cwiseAbs().maxCoeff());
  }
  return size;
}

// Faces that lines from the chain `p` through the chain `q` may meet beyond it: the boxes
// of each step of both are swept.  `error` is that of the points, if they are not on
// their edges at known parameters.  Ascending.
std::vector<int> faces_beyond(const Silhouettes& g, const std::vector<Point>& p,
                              const std::vector<Point>& q, double error) {
  // Points on edges are off by a few units of the last place, their parameters by
  // kRangeError times an edge's length, which is at most 2 sqrt(3) times the size.
  const double pad = 16 * kRangeError * size_of(g.scene()) + error;
  std::vector<int> found;
  for (std::size_t k = 0; k + 1 < p.size(); ++k) {
    const std::array<Point, 2> at_p{p[k], p[k + 1]};
    const std::array<Point, 2> at_q{q[k], q[k + 1]};
    const Sweep sweep(box_of(at_p), box_of(at_q), pad);
    g.face_tree().traverse([&](const Box& box) { return sweep.may_meet(box); },
                           [&](std::uint32_t f) {
                             if (sweep.may_meet(g.face_box(static_cast<int>(f)))) {
                               found.push_back(static_cast<int>(f));
                             }
                           });
  }
  sort_unique(found);
  return found;
}

// In how many steps an arc is swept: speed only.
int steps_for(const Point& p0, const Point& p1, const Point& q0, const Point& q1) {
  const double wide = (p1 - p0).norm() + (q1 - q0).norm();
  const double apart = (p0 + p1 - q0 - q1).norm() / 2;
  return wide < 0.1 * apart ? 1 : wide < 0.3 * apart ? 2 : wide < apart ? 4 : 8;
}

// A part of an arc whose lines meet a face beyond one of the contacts.
template <class CutType>
struct Met {
  CutType from, to;
  int face;
  int wing;   // 0: before the first contact, 1: beyond the last
  Sign near;  // the side of the face's plane that the contacts are on
};

enum class Order : std::uint8_t { First, Second, Same, Unknown };

// Which of two faces that a line meets is nearer to its contacts, where the plane of one
// tells: the other face is wholly beyond it.
Order order_by_planes(const Silhouettes& g, int f, Sign near_f, int h, Sign near_h) {
  const auto beyond = [&](int plane_of, Sign near, int face, bool& in_plane) {
    in_plane = true;
    for (const int p : g.scene().face_points(face)) {
      const Sign s = g.face_plane(plane_of)(g.scene().point(p));
      if (s == near) return false;
      in_plane = in_plane && s == Sign::Zero;
    }
    return true;
  };
  bool in_plane = false;
  if (beyond(f, near_f, h, in_plane)) return in_plane ? Order::Same : Order::First;
  if (beyond(h, near_h, f, in_plane)) return in_plane ? Order::Same : Order::Second;
  return Order::Unknown;
}

// Where a line meets a face's plane: 0 at its first point, 1 at its second.
Rational meeting(const Scene& scene, int face, const std::array<ExactPoint, 2>& line) {
  const auto ids = plane_points(scene, face);
  const ExactPoint a = exact_point(scene.point(ids[0]));
  const ExactPoint b = exact_point(scene.point(ids[1]));
  const ExactPoint c = exact_point(scene.point(ids[2]));
  const Rational x = exact_orient(a, b, c, line[0]);
  return quotient(x, x - exact_orient(a, b, c, line[1]));
}

// The lower envelopes of both wings.  `Family` compares cuts, rounds them to within
// kRangeError and gives exact lines.
template <class Family>
class Envelope {
 public:
  using CutType = typename Family::CutType;

  Envelope(const Silhouettes& g, const FaceCrossings& crossings, const Family& family,
           std::vector<Met<CutType>>& met, const std::array<double, 2>& range)
      : g_(g), crossings_(crossings), family_(family), met_(met), range_(range) {}

  std::optional<std::vector<FarPiece>> pieces() {
    number_cuts();
    for (auto& wing : nearest_) wing.assign(at_.size() - 1, -1);
    for (std::size_t i = 0; i < met_.size(); ++i) {
      for (int k = first_[i]; k < last_[i]; ++k) {
        if (!put(static_cast<int>(i), k)) return std::nullopt;
      }
    }
    std::vector<FarPiece> out;
    for (std::size_t k = 0; k + 1 < at_.size(); ++k) {
      if (too_short(k)) continue;
      FarPiece piece{{out.empty() ? range_[0] : at_[k], range_[1]}, {-1, -1}};
      for (int w = 0; w < 2; ++w) {
        if (nearest_[w][k] >= 0) piece.faces[w] = met_[nearest_[w][k]].face;
      }
      if (!out.empty() && out.back().faces == piece.faces) continue;
      if (!out.empty()) out.back().range[1] = piece.range[0];
      out.push_back(piece);
    }
    const bool bounds_all = !merged_ && !any_gap();
    for (FarPiece& piece : out) piece.bounds_all = bounds_all;
    return out;
  }

 private:
  // Positions of all cuts in order, the range's ends first and last.
  void number_cuts() {
    const auto cut = [&](std::size_t c) -> const CutType& {
      return c % 2 == 0 ? met_[c / 2].from : met_[c / 2].to;
    };
    std::vector<std::size_t> order(2 * met_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return family_.compare(cut(a), cut(b)) == Sign::Negative;
    });
    first_.resize(met_.size());
    last_.resize(met_.size());
    at_.assign(1, range_[0]);
    std::vector<int> slots(order.size());
    constexpr int kEnd = std::numeric_limits<int>::max();
    int slot = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool same =
          i > 0 && family_.compare(cut(order[i - 1]), cut(order[i])) == Sign::Zero;
      if (!same) {
        const double s = family_.rounded(cut(order[i]));
        merged_ = merged_ || (!family_.is_limit(cut(order[i])) && near_range_end(s));
        if (s >= range_[1] - kShortestPiece) {
          slot = kEnd;
        } else if (s > range_[0] + kShortestPiece) {
          slot = static_cast<int>(at_.size());
          at_.push_back(s);
        }
      }
      slots[order[i]] = slot;
    }
    const int end = static_cast<int>(at_.size());
    at_.push_back(range_[1]);
    for (std::size_t i = 0; i < met_.size(); ++i) {
      first_[i] = std::min(end, slots[2 * i]);
      last_[i] = std::min(end, slots[2 * i + 1]);
    }
  }

  [[nodiscard]] bool near_range_end(double s) const {
    return std::abs(s - range_[0]) <= kShortestPiece ||
           std::abs(s - range_[1]) <= kShortestPiece;
  }

  // Between two stretches neither of whose nearest faces goes on beyond the cut there is
  // a line that may touch both and end on neither; and a stretch that is left out may
  // reach farther than others.
  [[nodiscard]] bool any_gap() const {
    for (std::size_t k = 0; k + 1 < at_.size(); ++k) {
      if (too_short(k)) return true;
      for (int w = 0; w < 2 && k > 0; ++w) {
        if (!closed_at(nearest_[w][k - 1], nearest_[w][k], static_cast<int>(k))) {
          return true;
        }
      }
    }
    return false;
  }

  // Whether the line at the cut k ends where one of the lines beside it do.
  [[nodiscard]] bool closed_at(int before, int after, int k) const {
    if (before < 0 || after < 0 || last_[before] > k || first_[after] < k) return true;
    // It enters a convex solid where two of its faces meet.
    const auto& m = met_[before];
    const auto& n = met_[after];
    const int object = g_.scene().faces()[m.face].object;
    return object == g_.scene().faces()[n.face].object && g_.convex_solid(object) &&
           m.near == Sign::Positive && n.near == Sign::Positive &&
           family_.same_side(m.to, n.from);
  }

  [[nodiscard]] bool too_short(std::size_t k) const {
    return at_[k + 1] - at_[k] < kShortestPiece;
  }

  // False when the faces are met in one point, or may be somewhere in the part.
  bool put(int i, int k) {
    int& best = nearest_[met_[i].wing][k];
    if (too_short(static_cast<std::size_t>(k))) return true;
    if (best < 0) {
      best = i;
      return true;
    }
    const auto& m = met_[i];
    const auto& n = met_[best];
    Order order = order_by_planes(g_, m.face, m.near, n.face, n.near);
    if (order == Order::Unknown) {
      if (crossings_.cross(m.face, n.face)) return false;
      order = order_at(k, m.face, n.face, m.wing);
    }
    if (order == Order::First) best = i;
    return order != Order::Same && order != Order::Unknown;
  }

  // By the line in the middle of a part.
  Order order_at(int k, int f, int h, int wing) const {
    const auto line = family_.line(at_[k] + 0.5 * (at_[k + 1] - at_[k]));
    if (!line) return Order::Unknown;
    const Rational x = meeting(g_.scene(), f, *line);
    const Rational y = meeting(g_.scene(), h, *line);
    if (x == y) return Order::Same;
    return (x < y) == (wing == 1) ? Order::First : Order::Second;
  }

  const Silhouettes& g_;
  const FaceCrossings& crossings_;
  const Family& family_;
  const std::vector<Met<CutType>>& met_;
  std::array<double, 2> range_;
  std::vector<double> at_;
  std::vector<int> first_, last_;  // of each met part, positions in at_
  std::array<std::vector<int>, 2> nearest_;
  bool merged_ = false;  // some cut was taken for an end of the range
};

bool too_short(const std::array<double, 2>& range) {
  return range[1] - range[0] < 4 * kShortestPiece;
}

// The same faces are at the edge from end to end: it is no chain of several mesh edges.
bool same_faces_along(const Scene& scene, int edge) {
  const Edge& e = scene.edges()[edge];
  return std::all_of(e.sides.begin(), e.sides.end(), [&](const Edge::Side& side) {
    return has_point(scene, side.face, e.points[0]) &&
           has_point(scene, side.face, e.points[1]);
  });
}

std::vector<int> faces_at_edge(const Scene& scene, int edge) {
  std::vector<int> faces;
  for (const Edge::Side& side : scene.edges()[edge].sides) faces.push_back(side.face);
  sort_unique(faces);
  return faces;
}

// Whether the lines that support the ridge cannot meet the face elsewhere.
bool of_own_solid(const Silhouettes& g, const Ridge& r, int face) {
  const int object = g.scene().faces()[face].object;
  return g.convex_solid(object) &&
         std::find(r.objects.begin(), r.objects.end(), object) != r.objects.end();
}

// ---- Through a vertex and an edge -----------------------------------------------------

class EvFamily {
 public:
  using CutType = Cut;

  EvFamily(const Silhouettes& g, const SkeletonArc& arc)
      : g_(g),
        scene_(g.scene()),
        ridge_(g.ridges()[g.ridge_of_edge(arc.edge())]),
        vertex_(arc.vertex()),
        v_(scene_.point(arc.vertex())),
        e0_(scene_.point(scene_.edges()[arc.edge()].points[0])),
        e1_(scene_.point(scene_.edges()[arc.edge()].points[1])),
        plane_({v_, e0_, e1_}) {}

  [[nodiscard]] Sign compare(const Cut& a, const Cut& b) const {
    if (a.kind == b.kind && a.plane == b.plane) return Sign::Zero;
    return internal::compare(scene_, {e0_, e1_}, a, b);
  }
  // No side of a face cuts there, but the family ends.
  [[nodiscard]] static bool is_limit(const Cut& cut) {
    return cut.kind == CutKind::Start || cut.kind == CutKind::End;
  }
  // Of two cuts in one place, and a convex solid met before and after.
  [[nodiscard]] static bool same_side(const Cut& /*a*/, const Cut& /*b*/) {
    return true;  // its section with the plane of all lines is convex
  }
  [[nodiscard]] double rounded(const Cut& cut) const {
    return rounded_parameter(scene_, {e0_, e1_}, cut);
  }
  [[nodiscard]] std::optional<std::array<ExactPoint, 2>> line(double s) const {
    return std::array<ExactPoint, 2>{
        exact_point(v_), along(exact_point(e0_), exact_point(e1_), Rational(s))};
  }

  // Adds the part of the edge whose lines meet the face beyond that wing's contact; false
  // when a sign is zero all along.
  bool add(int face, int wing, std::vector<Met<Cut>>& out) const {
    const int object = scene_.faces()[face].object;
    const PlaneSide& plane = g_.face_plane(face);
    const Sign near = plane(v_);
    const bool at_edge = plane(e0_) == Sign::Zero && plane(e1_) == Sign::Zero;
    if (near == Sign::Zero && at_edge) return false;  // all lines are in its plane
    if (near == Sign::Zero || at_edge) return true;   // met at the contact, if at all
    if (of_own_solid(g_, ridge_, face)) return true;
    const auto own = g_.objects_at(vertex_);
    if (g_.convex_solid(object) &&
        std::find(own.begin(), own.end(), object) != own.end()) {
      return true;
    }
    // From outside a closed solid a line must enter it.
    if (near == Sign::Negative && g_.convex_solid(object)) return true;
    const Crossing crossing = crossing_of(face);
    if (crossing != Crossing::Yes) return crossing == Crossing::No;
    const Sign wanted = wing == 1 ? -near : near;
    Met<Cut> part{start_cut(), end_cut(), face, wing, near};
    const auto corners = scene_.face_points(face);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int p = corners[k];
      const int q = corners[(k + 1) % corners.size()];
      if (!restrict_to(p, q, wanted, part)) return false;
      if (compare(part.from, part.to) != Sign::Negative) return true;
    }
    out.push_back(part);
    return true;
  }

 private:
  enum class Crossing : std::uint8_t { No, Yes, Along };

  // How the face meets the plane of all lines: Along, with a whole side.
  [[nodiscard]] Crossing crossing_of(int face) const {
    int positive = 0;
    int negative = 0;
    int zero = 0;
    for (const int p : scene_.face_points(face)) {
      const Sign s = plane_(scene_.point(p));
      ++(s == Sign::Positive ? positive : s == Sign::Negative ? negative : zero);
    }
    if (zero > 1) return Crossing::Along;
    return positive > 0 && negative > 0 ? Crossing::Yes : Crossing::No;
  }

  // To where the line passes the side pq as wanted.
  bool restrict_to(int p, int q, Sign wanted, Met<Cut>& part) const {
    const PlaneSide side({v_, scene_.point(p), scene_.point(q)});
    const BoundedValue x = side.value(e0_);
    const BoundedValue y = side.value(e1_);
    Sign at0 = sign_of(x, side, e0_);
    Sign at1 = sign_of(y, side, e1_);
    if (at0 == Sign::Zero) at0 = at1;
    if (at1 == Sign::Zero) at1 = at0;
    if (at0 == Sign::Zero) return false;
    if (at0 == at1) {
      if (at0 != wanted) part.to = part.from;
      return true;
    }
    const Cut cut =
        make_cut(CutKind::Side, -1, {vertex_, std::min(p, q), std::max(p, q)}, x, y);
    Cut& end = at0 == wanted ? part.to : part.from;
    if (compare(end, cut) == (at0 == wanted ? Sign::Positive : Sign::Negative)) end = cut;
    return true;
  }

  const Silhouettes& g_;
  const Scene& scene_;
  const Ridge& ridge_;
  int vertex_;
  const Point& v_;
  const Point& e0_;
  const Point& e1_;
  PlaneSide plane_;
};

// ---- Through three edges --------------------------------------------------------------

class EeeFamily {
 public:
  using CutType = CurveCut;

  EeeFamily(const Silhouettes& g, const Carriers& carriers, const SkeletonArc& arc)
      : g_(g),
        scene_(g.scene()),
        carriers_(carriers),
        range_(arc.range),
        pair_{&scene_, points_of(arc.edges()[0]), points_of(arc.edges()[2])},
        middle_(carriers.of_ridge[g.ridge_of_edge(arc.edges()[1])]),
        curve_(pair_, carriers.all, middle_, pair_.form(carriers.all[middle_])) {
    for (int i = 0; i < 3; ++i) {
      ridges_[i] = &g.ridges()[g.ridge_of_edge(arc.edges()[i])];
    }
    // Where not on the arc no part is looked for.
    from_.lo = from_.hi = std::max(0.0, range_[0] - 2 * kRangeError);
    to_.lo = to_.hi = std::min(1.0, range_[1] + 2 * kRangeError);
  }

  // The sign of F0 along the arc, and points on both outer edges; false when the doubles
  // cannot tell.
  bool prepare() {
    const auto& f = curve_.form();
    const double size = std::abs(f.f[0][0]) + std::abs(f.f[0][1]) + std::abs(f.f[1][0]) +
                        std::abs(f.f[1][1]);
    const double error = 1.1 * f.error + 8 * kUnit * size;
    const auto values = [&](double s) {
      return std::array<double, 2>{f.f[0][0] * (1 - s) + f.f[1][0] * s,
                                   f.f[0][1] * (1 - s) + f.f[1][1] * s};
    };
    const auto middle = values(0.5 * (range_[0] + range_[1]));
    if (std::abs(middle[0]) <= error || std::abs(middle[1]) <= error) return false;
    f0_ = sightline::internal::sign_of(middle[0]);
    // t = F0 / (F0 - F1) is off by at most 3 error / (|F0 - F1| - 2 error), and F0 - F1
    // is linear in s.
    for (const double s : range_) {
      const auto [x, y] = values(s);
      const double apart = std::abs(x - y);
      if (apart <= 20 * error) return false;
      last_error_ = std::max(last_error_, 4 * error / apart);
    }
    last_error_ *= (scene_.point(pair_.q[1]) - scene_.point(pair_.q[0])).norm();
    return true;
  }

  [[nodiscard]] Point first(double s) const { return on(pair_.p, s); }
  [[nodiscard]] Point last(double s) const {
    return on(pair_.q, curve_.last_parameter(s));
  }
  // How far last() may be off.
  [[nodiscard]] double last_error() const { return last_error_; }
  [[nodiscard]] bool touched() const {
    return std::any_of(ridges_.begin(), ridges_.end(),
                       [](const Ridge* r) { return r->touched; });
  }

  [[nodiscard]] Sign compare(const CurveCut& a, const CurveCut& b) const {
    return curve_.compare(a, b);
  }
  [[nodiscard]] static bool is_limit(const CurveCut& cut) {
    return cut.kind == CurveCutKind::Start || cut.kind == CurveCutKind::End;
  }
  [[nodiscard]] static bool same_side(const CurveCut& a, const CurveCut& b) {
    return a.same_as(b);
  }
  // Some part was too short to tell where it lies.
  [[nodiscard]] bool left_out() const { return left_out_; }
  [[nodiscard]] double rounded(const CurveCut& cut) const { return curve_.rounded(cut); }
  [[nodiscard]] std::optional<std::array<ExactPoint, 2>> line(double s) const {
    return curve_.points_at(Rational(s));
  }

  // As that of EvFamily.
  bool add(int face, int wing, std::vector<Met<CurveCut>>& out) {
    const PlaneSide& plane = g_.face_plane(face);
    const auto signs = [&](const std::array<std::int32_t, 2>& e) {
      return std::array<Sign, 2>{plane(scene_.point(e[0])), plane(scene_.point(e[1]))};
    };
    const auto p = signs(pair_.p);
    const auto q = signs(pair_.q);
    const auto m = signs(carriers_.all[middle_].points);
    int in_plane = 0;
    for (const auto& s : {p, q, m}) {
      in_plane += static_cast<int>(s[0] == Sign::Zero && s[1] == Sign::Zero);
    }
    if (in_plane > 1) return false;  // all lines are in its plane
    if (in_plane == 1) return true;  // met at the contact, if at all
    for (const Ridge* r : ridges_) {
      if (of_own_solid(g_, *r, face)) return true;
    }
    // Both outer contacts are on one side where the face is met beyond either.
    const auto differ = [](const std::array<Sign, 2>& s) { return s[0] == -s[1]; };
    const auto known = [](const std::array<Sign, 2>& s) {
      return s[0] == Sign::Zero ? s[1] : s[0];
    };
    if (!differ(p)) return add_parts(face, wing, known(p), false, out);
    if (!differ(q)) return add_parts(face, wing, known(q), false, out);
    return add_parts(face, wing, Sign::Positive, true, out) &&
           add_parts(face, wing, Sign::Negative, true, out);
  }

  // Where a side of the face, or its plane, is met: all that can matter.
  void add_stops(int face, std::vector<double>& out) {
    for (const auto& side : carriers_.of_face(face)) {
      next_.clear();
      bool zero = false;
      curve_.where(side.carrier, pair_.form(carriers_.all[side.carrier]), Sign::Positive,
                   {from_, to_}, next_, zero);
      for (const CurveInterval& part : next_) {
        out.push_back(rounded(part.from));
        out.push_back(rounded(part.to));
      }
    }
    const PlaneSide& plane = g_.face_plane(face);
    const auto points = plane_points(scene_, face);
    const auto add_root = [&](CurveCutKind kind, const BoundedLinear& l) {
      if (l.sign0 != -l.sign1 || l.sign0 == Sign::Zero) return;
      CurveCut cut{kind, false, scene_.faces()[face].facet, points, 0, 1};
      enclose_root(l, cut);
      out.push_back(rounded(cut));
    };
    const auto value = [&](std::int32_t point) { return plane.value(pair_.at(point)); };
    const auto sign = [&](std::int32_t point) { return plane(pair_.at(point)); };
    const BoundedValue p0 = value(pair_.p[0]);
    const BoundedValue p1 = value(pair_.p[1]);
    add_root(CurveCutKind::OnPlane, {p0.value, p1.value, p0.error, p1.error,
                                     sign(pair_.p[0]), sign(pair_.p[1])});
    if (sign(pair_.q[0]) == -sign(pair_.q[1])) {
      add_root(CurveCutKind::OnFar,
               curve_.at_last_edge(value(pair_.q[0]), value(pair_.q[1]), points));
    }
  }

  // Of lines in one plane, those to corners there and to crossings of sides.
  void add_stops_in_plane(std::span<const int> faces, std::vector<double>& out) const {
    const auto& middle = carriers_.all[middle_].points;
    for (const Rational& s : pencil_stops(scene_, {pair_.p, middle, pair_.q}, faces)) {
      out.push_back(s.convert_to<double>());
    }
  }

  // The parameters of the lines that meet a segment in which faces cross; where all lines
  // lie in a plane with it, those of the lines to its ends.
  void add_stops(const std::array<ExactPoint, 2>& segment,
                 std::vector<double>& out) const {
    if (add_meeting(segment, out)) return;
    for (const ExactPoint& end : segment) {
      for (std::size_t i = 0; i < 3; ++i) {
        ExactPoint off_plane = end;
        off_plane[i] += 1;
        if (add_meeting({end, off_plane}, out)) break;
      }
    }
  }

 private:
  // Of the lines that meet the line of a segment; false when all do.
  bool add_meeting(const std::array<ExactPoint, 2>& segment,
                   std::vector<double>& out) const {
    const auto& m = carriers_.all[middle_].points;
    const auto at = [&](std::int32_t p) { return exact_point(pair_.at(p)); };
    const auto form = [&](const ExactPoint& g0, const ExactPoint& g1) {
      BilinearForm<Rational> values;
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          values.f[a][b] = exact_orient(at(pair_.p[a]), at(pair_.q[b]), g0, g1);
        }
      }
      return values;
    };
    const auto h = resultant(form(at(m[0]), at(m[1])), form(segment[0], segment[1]));
    const Rational a = h.h0 - h.h1 + h.h2;
    const Rational b = h.h1 - 2 * h.h0;
    const Rational d = b * b - 4 * a * h.h0;
    if (d < 0) return true;
    // (-b -+ root) / 2a, without cancellation; all scaled, since squares may overflow.
    const Rational size = std::max({abs(a), abs(b), abs(h.h0)});
    if (size == 0) return false;
    const double root = std::sqrt((d / (size * size)).convert_to<double>());
    const double middle = (b / size).convert_to<double>();
    const double q = -0.5 * (middle + std::copysign(root, middle));
    for (const double s :
         {q / (a / size).convert_to<double>(), (h.h0 / size).convert_to<double>() / q}) {
      if (s > range_[0] && s < range_[1]) out.push_back(s);
    }
    return true;
  }

  [[nodiscard]] std::array<std::int32_t, 2> points_of(int edge) const {
    const auto& p = scene_.edges()[edge].points;
    return {p[0], p[1]};
  }
  [[nodiscard]] Point on(const std::array<std::int32_t, 2>& e, double s) const {
    return scene_.point(e[0]) + s * (scene_.point(e[1]) - scene_.point(e[0]));
  }

  // The parts where the contacts are on the side `near` of the face; `ask`: each part
  // says so itself.
  bool add_parts(int face, int wing, Sign near, bool ask,
                 std::vector<Met<CurveCut>>& out) {
    if (near == Sign::Negative && g_.convex_solid(scene_.faces()[face].object)) {
      return true;
    }
    const Sign entry = wing == 1 ? near : -near;
    const auto sides = carriers_.of_face(face);
    forms_.clear();
    for (const auto& side : sides) {
      forms_.push_back(pair_.form(carriers_.all[side.carrier]));
      if (curve_.may_vanish(forms_.back())) return false;
    }
    parts_.assign(1, {from_, to_});
    for (std::size_t k = 0; k < sides.size(); ++k) {
      next_.clear();
      bool zero = false;
      const Sign wanted = sides[k].forward ? -entry * f0_ : entry * f0_;
      for (const CurveInterval& part : parts_) {
        curve_.where(sides[k].carrier, forms_[k], wanted, part, next_, zero);
      }
      if (zero) return false;
      parts_.swap(next_);
      if (parts_.empty()) return true;
    }
    for (const CurveInterval& part : parts_) {
      if (ask) {
        const auto side = side_of(face, part);
        if (!side) continue;  // too short
        if (*side != near) continue;
      }
      out.push_back({part.from, part.to, face, wing, near});
    }
    return true;
  }

  // Of the face's plane that the first contact is on, in the middle of a part.
  [[nodiscard]] std::optional<Sign> side_of(int face, const CurveInterval& part) {
    const double a = std::max(range_[0], rounded(part.from));
    const double b = std::min(range_[1], rounded(part.to));
    if (b - a < kShortestPiece) {
      left_out_ = left_out_ || b - a > -kShortestPiece;  // else wholly off the arc
      return std::nullopt;
    }
    const auto x = line(a + 0.5 * (b - a));
    if (!x) {
      left_out_ = true;
      return std::nullopt;
    }
    const auto ids = plane_points(scene_, face);
    const Rational side =
        exact_orient(exact_point(scene_.point(ids[0])), exact_point(scene_.point(ids[1])),
                     exact_point(scene_.point(ids[2])), (*x)[0]);
    return static_cast<Sign>(side.sign());
  }

  const Silhouettes& g_;
  const Scene& scene_;
  const Carriers& carriers_;
  std::array<double, 2> range_;
  OuterPair pair_;
  int middle_;
  EeeCurve curve_;
  std::array<const Ridge*, 3> ridges_{};
  CurveCut from_ = curve_start();
  CurveCut to_ = curve_end();
  Sign f0_ = Sign::Zero;
  double last_error_ = 0;
  bool left_out_ = false;
  std::vector<CurveInterval> parts_, next_;
  std::vector<BoundedForm> forms_;
};

// The outer contacts of evenly spaced lines of an arc.
struct Chains {
  std::vector<Point> first, last;
  double error = 0;
};
Chains chains_of(const EeeFamily& family, const std::array<double, 2>& range) {
  Chains out;
  out.error = family.last_error();
  const int n = steps_for(family.first(range[0]), family.first(range[1]),
                          family.last(range[0]), family.last(range[1]));
  for (int k = 0; k <= n; ++k) {
    const double s = range[0] + (range[1] - range[0]) * k / n;
    out.first.push_back(family.first(s));
    out.last.push_back(family.last(s));
  }
  return out;
}

// False when some sign is zero all along.
template <class Family>
bool add_beyond(const Silhouettes& g, const Chains& chains,
                const std::array<bool, 2>& ends, Family& family,
                std::vector<Met<typename Family::CutType>>& met) {
  for (int wing = 0; wing < 2; ++wing) {
    if (ends[wing]) continue;
    const auto& near = wing == 0 ? chains.first : chains.last;
    const auto& far = wing == 0 ? chains.last : chains.first;
    for (const int f : faces_beyond(g, far, near, chains.error)) {
      if (!family.add(f, wing, met)) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<std::vector<FarPiece>> FarPieces::of(const SkeletonArc& arc) const {
  return arc.is_ev() ? of_ev(arc) : of_eee(arc);
}

std::optional<std::vector<FarPiece>> FarPieces::of_ev(const SkeletonArc& arc) const {
  const Star& star = g_.stars()[g_.star_of_point(arc.vertex())];
  if (star.touched || star.in_plane_only || too_short(arc.range)) return std::nullopt;
  if (g_.ridges()[g_.ridge_of_edge(arc.edge())].touched) return std::nullopt;
  if (arc.ends[1] && !same_faces_along(g_.scene(), arc.edge())) return std::nullopt;
  EvFamily family(g_, arc);
  const Scene& scene = g_.scene();
  const Point& e0 = scene.point(scene.edges()[arc.edge()].points[0]);
  const Point& e1 = scene.point(scene.edges()[arc.edge()].points[1]);
  const Point& v = scene.point(arc.vertex());
  const auto at = [&](double s) { return Point(e0 + s * (e1 - e0)); };
  Chains chains;
  const int n = steps_for(v, v, at(arc.range[0]), at(arc.range[1]));
  for (int k = 0; k <= n; ++k) {
    chains.first.push_back(v);
    chains.last.push_back(at(arc.range[0] + (arc.range[1] - arc.range[0]) * k / n));
  }
  std::vector<Met<Cut>> met;
  if (!add_beyond(g_, chains, arc.ends, family, met)) return std::nullopt;
  return Envelope<EvFamily>(g_, crossings_, family, met, arc.range).pieces();
}

std::optional<std::vector<FarPiece>> FarPieces::of_eee(const SkeletonArc& arc) const {
  if (too_short(arc.range)) return std::nullopt;
  for (int wing = 0; wing < 2; ++wing) {
    if (arc.ends[wing] && !same_faces_along(g_.scene(), arc.edges()[2 * wing])) {
      return std::nullopt;
    }
  }
  EeeFamily family(g_, carriers_, arc);
  if (family.touched() || !family.prepare()) return std::nullopt;
  std::vector<Met<CurveCut>> met;
  if (!add_beyond(g_, chains_of(family, arc.range), arc.ends, family, met)) {
    return std::nullopt;
  }
  auto pieces = Envelope<EeeFamily>(g_, crossings_, family, met, arc.range).pieces();
  if (pieces && family.left_out()) {
    for (FarPiece& piece : *pieces) piece.bounds_all = false;
  }
  return pieces;
}

std::array<std::vector<int>, 2> FarPieces::end_faces(const SkeletonArc& arc) const {
  const bool ev = arc.is_ev();
  std::array<std::vector<int>, 2> faces;
  if (ev && arc.ends[0]) {
    const auto at = g_.scene().faces_at(arc.vertex());
    faces[0].assign(at.begin(), at.end());
  }
  if (!ev && arc.ends[0]) faces[0] = faces_at_edge(g_.scene(), arc.edges()[0]);
  if (arc.ends[1]) {
    faces[1] = faces_at_edge(g_.scene(), ev ? arc.edge() : arc.edges()[2]);
  }
  return faces;
}

// Of crossings of these faces.
template <class Family>
void FarPieces::add_crossing_stops(const Family& family, std::span<const int> faces,
                                   std::vector<double>& out) const {
  if (crossings_.empty() || faces.empty()) return;
  Box box = g_.face_box(faces[0]);
  for (const int f : faces) {
    for (int i = 0; i < 3; ++i) {
      box.min[i] = std::min(box.min[i], g_.face_box(f).min[i]);
      box.max[i] = std::max(box.max[i], g_.face_box(f).max[i]);
    }
  }
  crossings_.tree().traverse([&](const Box& other) { return boxes_meet(box, other); },
                             [&](std::uint32_t item) {
                               const FaceCrossing& c = crossings_.at(item);
                               if (std::ranges::binary_search(faces, c.f) &&
                                   std::ranges::binary_search(faces, c.h)) {
                                 family.add_stops(c.segment, out);
                               }
                             });
}

std::vector<double> FarPieces::stops(const SkeletonArc& arc) const {
  EeeFamily family(g_, carriers_, arc);
  std::vector<int> faces;
  if (family.prepare()) {
    const Chains chains = chains_of(family, arc.range);
    faces = faces_beyond(g_, chains.first, chains.last, chains.error);
    const auto before = faces_beyond(g_, chains.last, chains.first, chains.error);
    faces.insert(faces.end(), before.begin(), before.end());
    sort_unique(faces);
  } else {
    for (std::size_t f = 0; f < g_.scene().faces().size(); ++f) {
      faces.push_back(static_cast<int>(f));
    }
  }
  std::vector<double> found;
  for (const int f : faces) family.add_stops(f, found);
  family.add_stops_in_plane(faces, found);
  add_crossing_stops(family, faces, found);
  std::sort(found.begin(), found.end());
  std::vector<double> out{arc.range[0]};
  for (const double s : found) {
    if (s > out.back() + kShortestPiece && s < arc.range[1] - kShortestPiece) {
      out.push_back(s);
    }
  }
  out.push_back(arc.range[1]);
  return out;
}

}  // namespace sightline::internal
