#include "shadows/factors/contour_events.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace sightline::internal {
namespace {

// In the frame's units, in which coordinates are about 1.  Far above what rounding does
// (some 1e-15 each): an event too many costs time, one too few hides a kink.
constexpr double kLoose = 1e-9;

using Vector = Eigen::Vector3d;

struct Side {
  Vector a, b;
  int plate;
};

struct Corner {
  Vector at;
  int plate;
};

/// Corners and sides of sender, target and shading blockers in the shaft, each once.
struct Elements {
  const ExchangeGeometry& g;
  std::vector<Corner> corners;
  std::vector<Side> sides;

  void add(int plate, const std::vector<Vector>& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector& a = polygon[i];
      const Vector& b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
      if (plate >= 0 && !g.in_shaft(a, b)) continue;
      add_corner(plate, a);
      add_corner(plate, b);
      if (std::ranges::none_of(sides, [&](const Side& s) {
            return (s.a == a && s.b == b) || (s.a == b && s.b == a);
          })) {
        sides.push_back({a, b, plate});
      }
    }
  }
  void add_corner(int plate, const Vector& a) {
    if (std::ranges::any_of(corners, [&](const Corner& c) { return c.at == a; })) return;
    if (std::ranges::any_of(g.shaft, [&](const Eigen::Vector4d& plane) {
          return plane.head<3>().dot(a) + plane[3] > kShaftSlack;
        })) {
      return;
    }
    corners.push_back({a, plate});
  }
};

std::vector<Vector> in_space(const PlanePolygon& polygon) {
  std::vector<Vector> corners;
  for (const FlatPoint& p : polygon) corners.emplace_back(p.x, p.y, 0);
  return corners;
}

/// Of a side's two ends, by how far they are beside a line: the line passes between them.
bool straddles(double from, double to) {
  const double slack = kLoose * (std::abs(from) + std::abs(to));
  return std::min(from, to) <= slack && std::max(from, to) >= -slack;
}

/// Tells which lines can matter: those that run from the sender, past the piece on its
/// open side, to the target.  With slack, since an event may lie at an end of any of
/// them.
class Relevance {
 public:
  Relevance(const ExchangeGeometry& g, const ContourPiece& piece)
      : g_(g), piece_(piece) {}

  /// The line through q and v, which lies in the plane of v and a side.
  [[nodiscard]] bool holds(const Vector& q, const Vector& v, const Side& side,
                           const Vector& normal) const {
    const Vector across = (v - q).cross(normal);
    if (!straddles(across.dot(side.a - q), across.dot(side.b - q))) return false;
    return holds(q, v - q);
  }
  /// The line through q in that direction.
  [[nodiscard]] bool holds(const Vector& q, Vector along) const {
    if (along.z() < 0) along = -along;
    if (!(along.z() > 0)) return q.z() <= kLoose;
    const Vector x = q - (q.z() / along.z()) * along;
    return leaves_sender(x) && passes_beside(along) &&
           (piece_.on_target || meets_target(q, along));
  }

 private:
  [[nodiscard]] bool leaves_sender(const Vector& x) const {
    const PlanePolygon& p = g_.sender;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const FlatPoint& a = p[i];
      const FlatPoint& b = p[i + 1 < p.size() ? i + 1 : 0];
      const double ux = b.x - a.x, uy = b.y - a.y;
      const double beside = ux * (x.y() - a.y) - uy * (x.x() - a.x);
      if (beside < -kLoose * (std::abs(ux) + std::abs(uy))) return false;
    }
    return true;
  }
  [[nodiscard]] bool passes_beside(const Vector& along) const {
    bool plus = false, minus = false;
    for (const Vector& n : piece_.attached) {
      const double side = n.dot(along);
      plus = plus || side > kLoose * along.norm();
      minus = minus || side < -kLoose * along.norm();
    }
    return !(plus && minus);
  }
  [[nodiscard]] bool meets_target(const Vector& q, const Vector& along) const {
    const Plate& t = g_.target;
    const double fall = t.normal.dot(along);
    if (!(fall < 0)) return false;
    const Vector y = q - (t.height(q) / fall) * along;
    for (std::size_t i = 0; i < t.corners.size(); ++i) {
      const Vector& a = t.corners[i];
      const Vector u = t.corners[i + 1 < t.corners.size() ? i + 1 : 0] - a;
      if (t.normal.dot(u.cross(y - a)) < -kLoose * u.norm()) return false;
    }
    return true;
  }

  const ExchangeGeometry& g_;
  const ContourPiece& piece_;
};

/// Lines through the piece and three sides of different surfaces.
///
/// Planes through q and a side have normals that are linear in the position of q.  Three
/// of them share a line where their determinant vanishes, which is of degree two: its
/// leading coefficient would be the determinant of three vectors across the piece.
///
/// The planes of blockers at whose sides the piece lies count as sides without ends: they
/// bound from where the blocker is seen beside the piece.
class TripleEvents {
 public:
  TripleEvents(const ContourPiece& piece, const Elements& elements,
               const Relevance& relevance)
      : piece_(piece),
        sides_(elements.sides),
        relevance_(relevance),
        count_(sides_.size() + piece.attached.size()),
        pairs_(count_ * count_) {}

  void add_to(std::vector<double>& events) {
    find_pairs();
    int triples = 0;
    for (std::size_t f = 0; f < count_; ++f) {
      for (std::size_t g = f + 1; g < count_; ++g) {
        if (!pairs_[f * count_ + g]) continue;
        for (std::size_t h = g + 1; h < count_; ++h) {
          if (!pairs_[f * count_ + h] || !pairs_[g * count_ + h]) continue;
          if (++triples > kMostTriples) return;
          add_roots({f, g, h}, events);
        }
      }
    }
  }

 private:
  /// An upper bound for time, in crowds of blockers.
  static constexpr int kMostTriples = 20000;

  [[nodiscard]] Vector at(double s) const { return piece_.start + s * piece_.direction; }
  [[nodiscard]] bool has_ends(std::size_t f) const { return f < sides_.size(); }
  [[nodiscard]] Vector normal(std::size_t f, const Vector& q) const {
    if (!has_ends(f)) return piece_.attached[f - sides_.size()];
    return (sides_[f].a - q).cross(sides_[f].b - q);
  }
  /// Pairs of which some line through the piece may meet both.
  void find_pairs() {
    const std::array<Vector, 2> ends{at(0), at(piece_.length)};
    for (std::size_t f = 0; f < count_; ++f) {
      for (std::size_t g = f + 1; g < count_; ++g) {
        pairs_[f * count_ + g] = has_ends(f) &&
                                 (!has_ends(g) || sides_[f].plate != sides_[g].plate) &&
                                 may_cut(f, g, ends) && may_cut(g, f, ends);
      }
    }
  }
  /// The plane through some q and side f may separate the ends of g: on which side of it
  /// an end lies is linear in the position of q.
  [[nodiscard]] bool may_cut(std::size_t f, std::size_t g,
                             const std::array<Vector, 2>& ends) const {
    if (!has_ends(g)) return true;
    bool plus = false, minus = false;
    for (const Vector& q : ends) {
      const Vector n = normal(f, q);
      for (const Vector* v : {&sides_[g].a, &sides_[g].b}) {
        const double value = n.dot(*v - q);
        plus = plus || value >= -kLoose;
        minus = minus || value <= kLoose;
      }
    }
    return plus && minus;
  }
  /// The line through q in that direction meets the side, which lies in a plane with it.
  [[nodiscard]] bool meets(std::size_t f, const Vector& q, const Vector& along) const {
    if (!has_ends(f)) return true;
    const Vector across = along.cross(normal(f, q));
    return straddles(across.dot(sides_[f].a - q), across.dot(sides_[f].b - q));
  }
  void add_roots(const std::array<std::size_t, 3>& triple,
                 std::vector<double>& events) const {
    const double half = 0.5 * piece_.length;
    std::array<double, 3> value{};
    for (int k = 0; k < 3; ++k) {
      const Vector q = at(k * half);
      value[k] =
          normal(triple[0], q).dot(normal(triple[1], q).cross(normal(triple[2], q)));
    }
    const double a = 0.5 * (value[0] + value[2]) - value[1];
    const double b = 0.5 * (value[2] - value[0]), c = value[1];
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return;
    const double w = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    for (const double u : {w / a, c / w}) {
      if (!(u > -1 && u < 1)) continue;
      const Vector q = at(half * (1 + u));
      const Vector along = common_direction(triple, q);
      if (std::ranges::all_of(triple,
                              [&](std::size_t f) { return meets(f, q, along); }) &&
          relevance_.holds(q, along)) {
        events.push_back(half * (1 + u));
      }
    }
  }
  /// Of the three planes through q, of which two may coincide.
  [[nodiscard]] Vector common_direction(const std::array<std::size_t, 3>& triple,
                                        const Vector& q) const {
    Vector best = Vector::Zero();
    double largest = -1;
    for (int k = 0; k < 3; ++k) {
      const Vector n = normal(triple[k], q).normalized();
      const Vector m = normal(triple[(k + 1) % 3], q).normalized();
      const Vector d = n.cross(m);
      if (d.squaredNorm() > largest) {
        largest = d.squaredNorm();
        best = d;
      }
    }
    return best;
  }

  const ContourPiece& piece_;
  const std::vector<Side>& sides_;
  const Relevance& relevance_;
  const std::size_t count_;
  std::vector<char> pairs_;
};

/// Ascending, inside the piece, none twice.
std::vector<double> sorted(std::vector<double> events, double length) {
  std::ranges::sort(events);
  // Two events nearer than some dozens of roundings of a position are one.
  constexpr double kOneEvent = 1e-14;
  const double apart = kOneEvent * length;
  std::vector<double> result;
  for (const double s : events) {
    if (s > apart && s < length - apart &&
        (result.empty() || s > result.back() + apart)) {
      result.push_back(s);
    }
  }
  return result;
}

void add_crossing(const ContourPiece& piece, double at_start, double at_end,
                  std::vector<double>& events) {
  if (!((at_start > 0 && at_end < 0) || (at_start < 0 && at_end > 0))) return;
  events.push_back(piece.length * at_start / (at_start - at_end));
}

}  // namespace

std::vector<double> contour_events(const ExchangeGeometry& g, const ContourPiece& piece) {
  Elements elements{g, {}, {}};
  elements.add(-1, in_space(g.sender));
  if (!piece.on_target) elements.add(-2, g.target.corners);
  for (const int b : piece.shading) elements.add(b, g.blockers[b].corners);

  const Vector end = piece.start + piece.length * piece.direction;
  std::vector<double> events = piece.breaks;
  for (const int b : piece.shading) {
    add_crossing(piece, g.blockers[b].height(piece.start), g.blockers[b].height(end),
                 events);
  }
  const Relevance relevance(g, piece);
  for (const Side& side : elements.sides) {
    for (const Corner& corner : elements.corners) {
      if (corner.plate == side.plate) continue;
      const Vector normal = (side.a - corner.at).cross(side.b - corner.at);
      const double h0 = normal.dot(piece.start - corner.at);
      const double h1 = normal.dot(end - corner.at);
      if (!((h0 > 0 && h1 < 0) || (h0 < 0 && h1 > 0))) continue;
      const double s = piece.length * h0 / (h0 - h1);
      if (relevance.holds(piece.start + s * piece.direction, corner.at, side, normal)) {
        events.push_back(s);
      }
    }
  }
  TripleEvents(piece, elements, relevance).add_to(events);
  return sorted(std::move(events), piece.length);
}

}  // namespace sightline::internal
