// Contacts of a line with faces, by exact signs.
//
// Notation.  The line L is a + t (b - a).  With integers (or doubles) A, alpha > 0, D
// such that a = A / alpha and b - a = D / delta, every point p of the scene has
//   v(p) = alpha p - A,   u(p) = (v_i D_k - v_k D_i, v_j D_k - v_k D_j),
// where k is an axis with D_k != 0: u is, up to a linear map, the projection of p along L
// onto the plane across L, with L at the origin.  For a point on L, u = 0 and
// t = (delta / alpha) x with x = v_k / D_k.  All of it is ring arithmetic on doubles and
// integers, done in CGAL::Mpzf; nothing is divided before a position is handed out.
//
// To first order a line near L is a point w(x) = w0 + w1 x of the plane across L that
// moves at constant velocity, x being time:
// - a face that L crosses at x_i is an obstacle at that instant: a closed *sector* of the
//   plane (all of it, a half-plane, or an angle at a corner);
// - a face that contains a stretch [x_i, x_j] of L is a *barrier* meanwhile: one ray or
//   two opposite rays that w must not cross.
// A motion that crosses a ray just at an instant is decided by the second order: when, in
// proportion to its distance from L, it crosses, against the *slopes* of the edges there.
// The contact blocks iff no w in general position avoids all of them.

#include "linespace/contacts/contact.h"

#include <CGAL/Gmpq.h>
#include <CGAL/Mpzf.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

using Ring = CGAL::Mpzf;
using CGAL::Gmpq;

constexpr double kUlp = std::numeric_limits<double>::epsilon() / 2;  // 2^-53
// Added to bounds so that underflow cannot make them too small.  The smallest products
// that matter are of degree 4 in coordinates of at least 2^-192 (differences of doubles
// of at least 2^-140), that is 2^-768.
constexpr double kUnderflow = 1e-300;

// Mpzf's own conversion expects a positive number.
Ring ring(const mpz_t z) {
  if (mpz_sgn(z) == 0) return Ring(0);
  CGAL::Gmpz absolute;
  mpz_abs(absolute.mpz(), z);
  Ring r(absolute);
  return mpz_sgn(z) < 0 ? -r : r;
}

Gmpq gmpq(const Ring& r) { return Gmpq(r); }
Rational rational(const Gmpq& q) { return Rational(q.mpq()); }

int sign_of(const Ring& r) { return static_cast<int>(CGAL::sign(r)); }

// A direction in the plane across L, with its rounded coordinates (each within a relative
// 2^-52; infinite when out of range) for a first look.
struct Ray {
  Ring x, y;
  double rx = 0, ry = 0;

  Ray() = default;
  Ray(Ring x_, Ring y_) : x(std::move(x_)), y(std::move(y_)) {
    rx = CGAL::to_double(x);
    ry = CGAL::to_double(y);
  }
  [[nodiscard]] bool zero() const { return sign_of(x) == 0 && sign_of(y) == 0; }
  Ray operator-() const {
    Ray r;
    r.x = -x;
    r.y = -y;
    r.rx = -rx;
    r.ry = -ry;
    return r;
  }
};

// Sign of p * q + r * s.  The rounded factors are within 2 ulp each, so the rounded sum
// is within (4 + 1 + 1) ulp of the exact one plus higher orders; 8 ulp bounds it.
template <class Exact>
int sum_sign(double p, double q, double r, double s, Exact&& exact) {
  const double pq = p * q, rs = r * s;
  const double sum = pq + rs;
  const double bound = 8 * kUlp * (std::abs(pq) + std::abs(rs)) + kUnderflow;
  if (sum > bound && bound < std::numeric_limits<double>::infinity()) return 1;
  if (sum < -bound && bound < std::numeric_limits<double>::infinity()) return -1;
  return exact();
}

int cross(const Ray& p, const Ray& q) {
  return sum_sign(p.rx, q.ry, -p.ry, q.rx,
                  [&] { return sign_of(Ring(p.x * q.y) - Ring(p.y * q.x)); });
}

int dot(const Ray& p, const Ray& q) {
  return sum_sign(p.rx, q.rx, p.ry, q.ry,
                  [&] { return sign_of(Ring(p.x * q.x) + Ring(p.y * q.y)); });
}

bool same_direction(const Ray& p, const Ray& q) {
  return cross(p, q) == 0 && dot(p, q) > 0;
}

// A corner of a face as seen along L.
struct Corner {
  int point;
  Ring v;  // v_k
  Ray u;
};

// What a face is to a moving point w: see the top of this file.
enum class Obstacle : std::uint8_t { None, Full, Sector, Barrier };

// One face's part in a contact.  Rays and positions are numbers into LineScan::Impl.
struct Hit {
  int face;
  TouchKind kind;
  Obstacle obstacle;
  int index = -1;
  int from, to;
  int start = -1, end = -1;  // Sector: counter-clockwise from start, at most a half turn
  // In a plane with L: where the ids of its corners begin, and which of them is at
  // `from`, or begins the side that is.
  int loop = -1, from_at = -1;
};

// A position x = num / den along L, den > 0.
struct Position {
  Ring num, den;
  double approx = 0;
  std::optional<Rational> t;
};

// ---- Obstacles. ----

struct SectorAt {
  int instant;
  const Corner *start, *end;  // counter-clockwise
};

// One side of a face in a plane with L: along `ray` it is up from `from` to `to`.  Its
// ends lie on the lines from there to two corners; none where the judged part of L ends.
// from = to where the face meets L in a corner.
struct Fin {
  Rational from, to;
  const Corner *from_side, *to_side;
  const Ray* ray;
};

bool contains_inside(const SectorAt& s, const Ray& r) {
  return cross(s.start->u, r) > 0 && cross(r, s.end->u) > 0;
}

// Directions just counter-clockwise of r are in the sector.
bool contains_after(const SectorAt& s, const Ray& r) {
  return same_direction(s.start->u, r) || contains_inside(s, r);
}

// Directions just clockwise of r are in the sector.
bool contains_before(const SectorAt& s, const Ray& r) {
  return same_direction(s.end->u, r) || contains_inside(s, r);
}

// The union of the closed sectors is the whole plane: no sector's end is followed by a
// gap.
bool covers(std::span<const SectorAt> sectors) {
  if (sectors.size() < 2) return false;
  return std::all_of(sectors.begin(), sectors.end(), [&](const SectorAt& s) {
    return std::any_of(sectors.begin(), sectors.end(), [&](const SectorAt& other) {
      return contains_after(other, s.end->u);
    });
  });
}

// The unit of distances along a ray, the same for all that have its direction.
const Ring& coordinate(const Ray& r) { return sign_of(r.x) != 0 ? r.x : r.y; }

Rational measure(const Ray& r) { return abs(rational(gmpq(coordinate(r)))); }

// Where in time a motion may cross a ray, in second order: open intervals of slopes.
struct Opening {
  std::optional<Rational> low, high;
};
struct Openings {
  std::vector<Opening> intervals;
  bool bounded = false;  // not all slopes
};

using CornerTimes = std::function<Rational(const Corner&)>;

// A motion whose w is on a ray, at distance r, at time t crosses it at t + r k to second
// order, k being ours to choose.  A sector's side on that ray runs from (t, L) to
// (t + r s, distance r), s being its slope: a sector on the side that w leaves must be
// met after the crossing, k < s, one on the side that w enters before it.  A fin along
// the ray must not be up.  All k that do, counter-clockwise for sense > 0; unless `exact`
// is asked for, a single interval may be replaced by another one.
Openings openings(int sense, const Ray& ray, const Rational& t,
                  std::span<const SectorAt> sectors, std::span<const Fin* const> fins,
                  const CornerTimes& corner_time, bool exact) {
  // 1. What bounds k: it must be less than the slopes to the corners in `less`, and
  // greater than the slopes to those in `greater`.  A sector with the ray inside leaves
  // no k at all.
  std::vector<const Corner*> less, greater;
  for (const SectorAt& s : sectors) {
    if (contains_inside(s, ray)) return {};
    if (same_direction(s.end->u, ray)) less.push_back(s.end);
    if (same_direction(s.start->u, ray)) greater.push_back(s.start);
  }
  // Turning clockwise, w leaves the side that it would enter turning the other way.
  if (sense < 0) std::swap(less, greater);
  // A fin that begins at t bounds k from above, one that ends at t from below; one that
  // is up before and after leaves no k.  A fin that meets L in a corner is up in a wedge:
  // between the slopes of its two sides.
  std::vector<const Fin*> wedges;
  for (const Fin* f : fins) {
    if (t < f->from || f->to < t) continue;
    if (f->from == f->to) {
      wedges.push_back(f);
    } else if (f->from == t) {
      if (f->from_side != nullptr) less.push_back(f->from_side);
    } else if (f->to == t) {
      if (f->to_side != nullptr) greater.push_back(f->to_side);
    } else {
      return {};
    }
  }
  // A corner in both leaves no k: two obstacles share the side to it.
  for (const Corner* c : less) {
    if (std::find(greater.begin(), greater.end(), c) != greater.end()) return {};
  }
  // 2. Bounds on one side only leave some k, whatever the slopes are: no need of them.
  Openings out;
  out.bounded = !less.empty() || !greater.empty() || !wedges.empty();
  if (!exact && (less.empty() || greater.empty())) {
    out.intervals.emplace_back();
    return out;
  }
  // Time per distance along the side from (t, L) to a corner on this ray.
  const auto slope = [&](const Corner* c) {
    return Rational(Rational(corner_time(*c) - t) / measure(c->u));
  };
  // 3. The interval between all bounds.
  Opening all;
  for (const Corner* c : less) {
    const Rational s = slope(c);
    if (!all.high || s < *all.high) all.high = s;
  }
  for (const Corner* c : greater) {
    const Rational s = slope(c);
    if (!all.low || s > *all.low) all.low = s;
  }
  if (all.low && all.high && *all.low >= *all.high) return {};
  // 4. That interval without the wedges, from low to high: `all` is what is left of it.
  std::vector<std::pair<Rational, Rational>> closed;
  for (const Fin* f : wedges) {
    const Rational p = slope(f->from_side), q = slope(f->to_side);
    closed.emplace_back(std::min(p, q), std::max(p, q));
  }
  std::sort(closed.begin(), closed.end());
  // What lies below a wedge is an interval of its own; then `all` begins above the wedge.
  for (const auto& [low, high] : closed) {
    if (all.high && low >= *all.high) break;
    if (!all.low || low > *all.low) out.intervals.push_back({all.low, low});
    if (!all.low || high > *all.low) all.low = high;
  }
  // The last one, above all wedges, unless these reach up to its end.
  if (!all.high || !all.low || *all.low < *all.high) {
    out.intervals.push_back(std::move(all));
  }
  return out;
}

// Each sector's end is inside another sector or the beginning of another one, along the
// same side: closed to first and second order.  May be false of closed ones that share
// no corners.
bool sealed(std::span<const SectorAt> sectors) {
  return std::all_of(sectors.begin(), sectors.end(), [&](const SectorAt& s) {
    return std::any_of(sectors.begin(), sectors.end(), [&](const SectorAt& other) {
      return other.start == s.end || contains_inside(other, s.end->u);
    });
  });
}

// Some motion in either sense crosses the ray just at the instant of these sectors;
// `order` compares the slopes of two corners.
template <class Order>
bool crossable(const Ray& ray, std::span<const SectorAt> sectors, Order&& order) {
  std::vector<const Corner*> right, left;
  for (const SectorAt& s : sectors) {
    if (contains_inside(s, ray)) return false;
    if (same_direction(s.end->u, ray)) right.push_back(s.end);
    if (same_direction(s.start->u, ray)) left.push_back(s.start);
  }
  int sign = 0;  // of the slopes on the right less those on the left
  for (const Corner* r : right) {
    for (const Corner* l : left) {
      const int here = r == l ? 0 : order(*r, *l);
      if (here == 0 || here == -sign) return false;
      sign = here;
    }
  }
  return true;
}

// The fins along each ray, for each direction that some fin has.
std::vector<std::vector<const Fin*>> by_direction(std::span<const Fin> fins) {
  std::vector<std::vector<const Fin*>> directions;
  for (const Fin& f : fins) {
    hear_stop();
    const auto known = std::find_if(
        directions.begin(), directions.end(),
        [&](const auto& d) { return same_direction(*d.front()->ray, *f.ray); });
    if (known == directions.end()) {
      directions.push_back({&f});
    } else {
      known->push_back(&f);
    }
  }
  return directions;
}

// Adds the instants at which one of the fins along a ray begins or ends; false: none of
// them is up for any time.  Where one fin goes on as another, without a gap between them,
// nothing happens.
bool add_instants(std::span<const Fin* const> along, const CornerTimes& corner_time,
                  std::vector<Rational>& instants) {
  std::vector<Rational> ends;
  for (const Fin* f : along) {
    if (f->from == f->to) continue;
    ends.push_back(f->from);
    ends.push_back(f->to);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const Rational& end : ends) {
    bool before = false, after = false;
    for (const Fin* f : along) {
      hear_stop();
      before |= f->from < end && end <= f->to;
      after |= f->from <= end && end < f->to;
    }
    if (before && after &&
        openings(1, *along.front()->ray, end, {}, along, corner_time, false)
            .intervals.empty()) {
      continue;
    }
    instants.push_back(end);
  }
  return !ends.empty();
}

// ---- Strict linear inequalities. ----

// A row, or a solution, of a homogeneous system.  `r` is `e` times some power of two,
// rounded: each entry within a relative 2^-52 or 2^-1022.
struct Row {
  static constexpr int kMax = 5;
  std::array<Ring, kMax> e;
  std::array<double, kMax> r{};

  void round(int dimension) {
    double largest = 0;
    for (int i = 0; i < dimension; ++i) {
      r[i] = CGAL::to_double(e[i]);
      largest = std::max(largest, std::abs(r[i]));
    }
    if (!(largest > 1e-290 && largest < 1e290)) {
      r.fill(std::numeric_limits<double>::quiet_NaN());  // only exact from here
      return;
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (int i = 0; i < dimension; ++i) r[i] = std::ldexp(r[i], -exponent);
  }
};

Ring exact_dot(const Row& p, const Row& q, int dimension) {
  Ring sum(0);
  for (int i = 0; i < dimension; ++i) sum = sum + Ring(p.e[i] * q.e[i]);
  return sum;
}

// Each rounded product is within 5 ulp, the sum of five within 4 more: 12 ulp bounds it
// with the higher orders.
int dot_sign(const Row& p, const Row& q, int dimension) {
  double sum = 0, size = 0;
  for (int i = 0; i < dimension; ++i) {
    const double product = p.r[i] * q.r[i];
    sum += product;
    size += std::abs(product);
  }
  const double bound = 12 * kUlp * size + kUnderflow;
  if (sum > bound) return 1;
  if (sum < -bound) return -1;
  return sign_of(exact_dot(p, q, dimension));
}

int pivot_of(const Row& row, int dimension) {
  int best = -1;
  for (int i = 0; i < dimension; ++i) {
    if (sign_of(row.e[i]) == 0) continue;
    if (best < 0 || std::abs(row.r[i]) > std::abs(row.r[best])) best = i;
  }
  return best;
}

// The row on the hyperplane normal * c = 0, without the pivot's unknown.
Row restricted(const Row& row, const Row& normal, int pivot, int dimension) {
  Row out;
  const bool negative = sign_of(normal.e[pivot]) < 0;
  for (int i = 0, j = 0; i < dimension; ++i) {
    if (i == pivot) continue;
    Ring e = Ring(row.e[i] * normal.e[pivot]) - Ring(row.e[pivot] * normal.e[i]);
    out.e[j++] = negative ? Ring(-e) : e;
  }
  out.round(dimension - 1);
  return out;
}

// Some c with row * c > 0 for all rows.  One row after the other: if the c found so far
// fails the next row, and another c does not, then one on that row's hyperplane is
// positive on the rows before, which is the same question in one unknown less.
// Cost: linear in the rows, times the factorial of the dimension, for rows in random
// order.  (R. Seidel, Small-dimensional linear programming and convex hulls made easy,
// 1991; here without an objective.)
bool positive_point(std::span<const Row> rows, int dimension, Row& c) {
  // Without rows any point does; without unknowns no row can be positive.
  if (rows.empty()) {
    for (int i = 0; i < dimension; ++i) c.e[i] = Ring(1);
    c.round(dimension);
    return true;
  }
  if (dimension == 0) return false;
  // Invariant: c is positive on the rows before n.
  c = rows[0];
  for (std::size_t n = 0; n < rows.size(); ++n) {
    // Nearly always c is positive on row n already.
    if (dot_sign(rows[n], c, dimension) > 0) continue;
    // 1. The same question for the rows before n on the hyperplane of row n.  A row of
    // zeros is positive nowhere.
    const Row& normal = rows[n];
    const int pivot = pivot_of(normal, dimension);
    if (pivot < 0) return false;
    std::vector<Row> reduced;
    reduced.reserve(n);
    for (std::size_t j = 0; j < n; ++j) {
      reduced.push_back(restricted(rows[j], normal, pivot, dimension));
    }
    Row inside;
    if (!positive_point(reduced, dimension - 1, inside)) return false;
    // 2. Its answer in all unknowns, times |normal[pivot]| to stay without quotients: the
    // pivot's unknown is the one that makes normal * on = 0.
    Row on;
    const bool negative = sign_of(normal.e[pivot]) < 0;
    const Ring size = negative ? Ring(-normal.e[pivot]) : normal.e[pivot];
    Ring rest(0);
    for (int i = 0, j = 0; i < dimension; ++i) {
      if (i == pivot) continue;
      rest = rest + Ring(normal.e[i] * inside.e[j]);
      on.e[i] = Ring(size * inside.e[j]);
      ++j;
    }
    on.e[pivot] = negative ? rest : Ring(-rest);
    // 3. Off the hyperplane, to row n's positive side: on + step * normal.  A row before,
    // worth `up` at `on`, loses `-fall` per step, so that the step must stay below
    // up / -fall; the smallest of these is height / loss, and half of it is taken.
    Ring height(0), loss(0);
    for (std::size_t j = 0; j < n; ++j) {
      const Ring fall = exact_dot(rows[j], normal, dimension);
      if (sign_of(fall) >= 0) continue;
      const Ring up = exact_dot(rows[j], on, dimension);
      if (sign_of(loss) == 0 || sign_of(Ring(up * loss) - Ring(height * -fall)) < 0) {
        height = up;
        loss = -fall;
      }
    }
    // Where no row before loses anything, any step does.  The new point is the sum above
    // times 2 loss, which is positive.
    if (sign_of(loss) == 0) height = loss = Ring(1);
    const Ring twice = loss + loss;
    for (int i = 0; i < dimension; ++i) {
      c.e[i] = Ring(twice * on.e[i]) + Ring(height * normal.e[i]);
    }
    c.round(dimension);
    // 4. Rounded to doubles the numbers are shorter, and all that follows is cheaper:
    // kept where the rounded point is positive on all rows so far, too.
    // NaN stands for numbers beyond the range of doubles.
    Row rounded;
    rounded.r = c.r;
    if (!std::isnan(c.r[0])) {
      for (int i = 0; i < dimension; ++i) rounded.e[i] = Ring(c.r[i]);
      if (std::all_of(rows.begin(), rows.begin() + n + 1, [&](const Row& row) {
            return dot_sign(row, rounded, dimension) > 0;
          })) {
        c = rounded;
      }
    }
  }
  return true;
}

// Some c has row * c > 0 for all rows and row * c = 0 for all equalities.
bool feasible(std::vector<Row> rows, std::vector<Row> equalities, int dimension) {
  while (!equalities.empty()) {
    const Row normal = equalities.back();
    equalities.pop_back();
    const int pivot = pivot_of(normal, dimension);
    if (pivot < 0) continue;
    for (std::vector<Row>* part : {&rows, &equalities}) {
      for (Row& row : *part) row = restricted(row, normal, pivot, dimension);
    }
    --dimension;
  }
  Row c;
  return positive_point(rows, dimension, c);
}

// ---- Motions. ----

// Decides whether some w passes, once no constant w does.
//
// The critical rays and their opposites cut the plane into cells.  A straight motion that
// misses the origin turns by less than a half turn in all, in one sense, so it is
// described by where it is at each instant, in a cell or on a ray; between two instants
// it crosses the rays between the two, and no ray may be one of a barrier that is up.
// Whether a sequence of such places is that of a motion is a question of linear
// inequalities in the four numbers of w. Only from a cell straight to the opposite one is
// the sense not given by the cells; then all cells before are the first and all after the
// second, and both senses are possible: in the coordinates of the cell's two sides both
// must change sign between the two instants, in any order.
//
// On a ray the second order decides (openings).  With the sense h = +-1, scaled from
// cross(w0, w1), a line near L passes a side of slope s, along the unit ray e, at the
// instant x on the side that is the sign of cross(e, W(x)) + s h, where W is the line's
// own w, as large as we like along a motion in first order that solves the system with
// all slopes zero.  So both orders together are exact: some line near L passes iff some
// motion has open places only and some W has its slopes in the openings.  W's values on
// up to three rays are independent; on more they are a second system.
//
// Which places can be followed by which is found first, without regard to straightness
// (passable_); only what can be completed so is tried, and asked of the inequalities.
class MotionSearch {
 public:
  // Sectors by instant, fins by direction; `rays` are those that matter.
  MotionSearch(std::vector<Rational> instants, std::span<const SectorAt> sectors,
               std::span<const std::vector<const Fin*>> fins,
               std::span<const Ray* const> rays, const CornerTimes& corner_time)
      : instants_(std::move(instants)), corner_time_(corner_time) {
    cut_into_cells(rays);
    const std::size_t count = instants_.size();
    sectors_at_.resize(count);
    for (std::size_t first = 0, last; first < sectors.size(); first = last) {
      const int i = sectors[first].instant;
      for (last = first; last < sectors.size() && sectors[last].instant == i;) ++last;
      sectors_at_[i] = sectors.subspan(first, last - first);
    }
    closed_.assign(count, std::vector<char>(2 * rays_.size(), 1));
    for (std::size_t i = 0; i < count; ++i) {
      for (int c = 0; c < ray_count(); ++c) {
        hear_stop();
        closed_[i][2 * c + 1] =
            std::any_of(sectors_at_[i].begin(), sectors_at_[i].end(),
                        [&](const SectorAt& s) { return contains_after(s, rays_[c]); });
      }
    }
    up_.assign(count - 1, std::vector<char>(rays_.size(), 0));
    fins_.resize(rays_.size());
    for (const std::vector<const Fin*>& direction : fins) {
      for (int r = 0; r < ray_count(); ++r) {
        if (!same_direction(*direction.front()->ray, rays_[r])) continue;
        fins_[r] = direction;
        for (std::size_t gap = 0; gap + 1 < count; ++gap) {
          hear_stop_now();
          up_[gap][r] =
              std::any_of(direction.begin(), direction.end(), [&](const Fin* f) {
                return f->from <= instants_[gap] && f->to > instants_[gap];
              });
        }
      }
    }
  }

  bool possible() {
    for (const int sense : {1, -1}) {
      if (possible(sense)) return true;
    }
    for (const int sense : {1, -1}) {
      if (open_rays(sense) && possible(sense)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] int ray_count() const { return static_cast<int>(rays_.size()); }
  // Places: 2 c is ray c, 2 c + 1 the cell from there to ray c + 1.
  [[nodiscard]] int size() const { return 2 * ray_count(); }
  [[nodiscard]] int half() const { return ray_count(); }
  [[nodiscard]] int wrapped(int place) const { return (place + 2 * size()) % size(); }
  static bool is_ray(int place) { return place % 2 == 0; }

  // rays_: all critical rays and their opposites by angle.
  void cut_into_cells(std::span<const Ray* const> rays) {
    std::vector<Ray> upper;
    for (const Ray* r : rays) {
      const int y = sign_of(r->y);
      upper.push_back(y > 0 || (y == 0 && sign_of(r->x) > 0) ? *r : -*r);
    }
    // A cell must be less than a half-plane: rays in two directions at least.
    upper.emplace_back(Ring(1), Ring(0));
    if (sign_of(upper.front().y) == 0) upper.emplace_back(Ring(0), Ring(1));
    std::sort(upper.begin(), upper.end(),
              [](const Ray& p, const Ray& q) { return cross(p, q) > 0; });
    upper.erase(std::unique(upper.begin(), upper.end(),
                            [](const Ray& p, const Ray& q) { return cross(p, q) == 0; }),
                upper.end());
    rays_ = upper;
    for (const Ray& r : upper) rays_.push_back(-r);
  }

  // Opens the places on rays where the second order allows to cross.  False when this
  // adds nothing: where a ray can as well be crossed a little earlier or later, a motion
  // on it can be moved off, unless it has no freedom left, being on four.
  bool open_rays(int sense) {
    const std::size_t count = instants_.size();
    bool adds = false;
    std::size_t bounded = 0;
    for (std::size_t i = 0; i < count; ++i) {
      bool bound_here = false;
      for (int r = 0; r < ray_count(); ++r) {
        hear_stop_now();
        const Openings open = openings(sense, rays_[r], instants_[i], sectors_at_[i],
                                       fins_[r], corner_time_, false);
        closed_[i][2 * r] = open.intervals.empty();
        if (open.intervals.empty()) continue;
        const int left = wrapped(2 * r - sense), entered = wrapped(2 * r + sense);
        const bool earlier = !closed_[i][entered] && (i == 0 || !up_[i - 1][r]);
        const bool later = !closed_[i][left] && (i + 1 == count || !up_[i][r]);
        adds |= !earlier && !later;
        bound_here |= open.bounded;
      }
      bounded += bound_here;
    }
    return adds || bounded >= 4;
  }

  bool possible(int sense) {
    find_passable(sense);
    for (int c = 0; c < size(); ++c) {
      if (!passable(0, c, 0)) continue;
      places_.assign(1, c);
      if (extend(sense, 0)) return true;
    }
    return false;
  }

  // From the place at instant i, having turned by `turned` places so far, free places
  // lead to the last instant.
  [[nodiscard]] char& passable(std::size_t i, int place, int turned) {
    return passable_[(i * static_cast<std::size_t>(size()) +
                      static_cast<std::size_t>(place)) *
                         static_cast<std::size_t>(half() + 1) +
                     static_cast<std::size_t>(turned)];
  }

  void find_passable(int sense) {
    const std::size_t count = instants_.size();
    passable_.assign(count * static_cast<std::size_t>(size() * (half() + 1)), 0);
    for (std::size_t i = count; i-- > 0;) {
      for (int c = 0; c < size(); ++c) {
        hear_stop();
        if (closed_[i][c]) continue;
        for (int turned = 0; turned <= half(); ++turned) {
          passable(i, c, turned) =
              i + 1 == count || any_step(sense, i, c, turned, [&](int next, int step) {
                return step == half() ? stays_free(next, i + 1)
                                      : passable(i + 1, next, turned + step) != 0;
              });
        }
      }
    }
  }

  // Some step from a place at instant i to a place at the next, past no barrier, is
  // accepted.
  template <class Accept>
  bool any_step(int sense, std::size_t i, int here, int turned, Accept&& accept) const {
    // No motion stays on a ray or gets to the opposite one.
    for (int step = is_ray(here) ? 1 : 0; turned + step <= half(); ++step) {
      if (step > 1) {
        const int crossed = wrapped(here + sense * (step - 1));
        if (is_ray(crossed) && up_[i][crossed / 2]) return false;
      }
      const int next = wrapped(here + sense * step);
      if (is_ray(next) && turned + step == half()) continue;
      if (accept(next, step)) return true;
    }
    return false;
  }

  // Continues the places found so far, having turned by `turned` in all.
  bool extend(int sense, int turned) {
    hear_stop();
    const std::size_t i = places_.size();
    if (i == instants_.size()) return slopes_fit(sense);
    return any_step(sense, i - 1, places_.back(), turned, [&](int next, int step) {
      if (step == half()) return stays_free(next, i);
      if (!passable(i, next, turned + step)) return false;
      places_.push_back(next);
      // A step to the same cell needs no look of its own unless it is the last.
      const bool look = step > 0 || i + 1 == instants_.size();
      if ((!look || is_a_motion()) && extend(sense, turned + step)) return true;
      places_.pop_back();
      return false;
    });
  }

  [[nodiscard]] bool stays_free(int cell, std::size_t from) const {
    for (std::size_t i = from; i < instants_.size(); ++i) {
      if (closed_[i][cell]) return false;
    }
    return true;
  }

  // The side of the line along a ray that a place is on.
  [[nodiscard]] int side(int ray, int place) const {
    const int turned = wrapped(place - 2 * ray);
    return turned % half() == 0 ? 0 : turned < half() ? 1 : -1;
  }

  // factor * (x w_y - y w_x) at an instant, times a positive number, for w = A + x B.
  [[nodiscard]] Row side_row(int ray, std::size_t i, int factor) const {
    const Ray& r = rays_[ray];
    const auto& [num, den] = elapsed_[i];
    const Ring x = factor > 0 ? r.x : Ring(-r.x), y = factor > 0 ? Ring(-r.y) : r.y;
    Row row;
    row.e = {Ring(y * den), Ring(x * den), Ring(y * num), Ring(x * num), Ring(0)};
    row.round(4);
    return row;
  }

  // Some motion is at these places at the first instants.  For each line through the
  // origin the side of w is the sign of an affine function of time, so that the instants
  // next to its change say all.
  [[nodiscard]] bool is_a_motion() {
    const std::size_t count = places_.size();
    if (count <= 2) return true;
    for (std::size_t i = elapsed_.size(); i < instants_.size(); ++i) {
      const Rational after(instants_[i] - instants_.front());
      elapsed_.emplace_back(ring(mpq_numref(after.backend().data())),
                            ring(mpq_denref(after.backend().data())));
    }
    std::vector<Row> rows, equalities;
    const auto require = [&](int ray, std::size_t i) {
      const int s = side(ray, places_[i]);
      if (s == 0) {
        equalities.push_back(side_row(ray, i, 1));
      } else {
        rows.push_back(side_row(ray, i, s));
      }
    };
    for (int ray = 0; ray < half() / 2; ++ray) {
      // Lines that bound none of the places say nothing that others do not.
      if (std::none_of(places_.begin(), places_.end(), [&](int place) {
            const int turned = wrapped(place - 2 * ray) % half();
            return turned <= 1 || turned + 1 == half() ||
                   (is_ray(place) && turned + 2 == half());
          })) {
        continue;
      }
      std::size_t required = count;  // the last one that is
      for (std::size_t i = 0; i + 1 < count; ++i) {
        if (side(ray, places_[i]) == side(ray, places_[i + 1])) continue;
        if (required != i) require(ray, i);
        require(ray, required = i + 1);
      }
      if (required == count) {
        require(ray, 0);
        require(ray, count - 1);
      }
    }
    return feasible(std::move(rows), std::move(equalities), 4);
  }

  // Some W crosses the rays that the motion is on within their openings.
  [[nodiscard]] bool slopes_fit(int sense) const {
    std::vector<std::size_t> on;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (is_ray(places_[i])) on.push_back(i);
    }
    if (on.size() <= 3) return true;
    // W and a last unknown z > 0, for homogeneity; the slope is -sense cross(e, W) / z.
    std::vector<Row> rows(1);
    rows[0].e[4] = Ring(1);
    rows[0].round(5);
    return slopes_fit(sense, on, rows);
  }

  bool slopes_fit(int sense, std::span<const std::size_t> on,
                  std::vector<Row>& rows) const {
    if (on.empty()) return feasible(rows, {}, 5);
    const std::size_t i = on.front();
    const int ray = places_[i] / 2;
    const Ring& c = coordinate(rays_[ray]);
    const Ring unit = Ring((sign_of(c) < 0 ? Ring(-c) : c) * elapsed_[i].second);
    // factor * (slope - bound) > 0
    const auto bound = [&](const Rational& slope, int factor) {
      const Ring num = ring(mpq_numref(slope.backend().data())),
                 den = ring(mpq_denref(slope.backend().data()));
      Row row = side_row(ray, i, -sense * factor);
      for (int j = 0; j < 4; ++j) row.e[j] = Ring(row.e[j] * den);
      row.e[4] = Ring(num * unit);
      if (factor > 0) row.e[4] = -row.e[4];
      row.round(5);
      rows.push_back(std::move(row));
    };
    const Openings open = openings(sense, rays_[ray], instants_[i], sectors_at_[i],
                                   fins_[ray], corner_time_, true);
    return std::any_of(open.intervals.begin(), open.intervals.end(),
                       [&](const Opening& o) {
                         const std::size_t before = rows.size();
                         if (o.low) bound(*o.low, 1);
                         if (o.high) bound(*o.high, -1);
                         const bool fits = slopes_fit(sense, on.subspan(1), rows);
                         rows.resize(before);
                         return fits;
                       });
  }

  std::vector<Rational> instants_;
  const CornerTimes& corner_time_;
  std::vector<std::pair<Ring, Ring>> elapsed_;  // since the first, num / den
  std::vector<Ray> rays_;
  std::vector<std::span<const SectorAt>> sectors_at_;
  std::vector<std::vector<const Fin*>> fins_;  // [ray]
  std::vector<std::vector<char>> closed_;      // [instant][place]
  std::vector<std::vector<char>> up_;          // [until the next][ray]
  std::vector<int> places_;                    // at the first instants
  std::vector<char> passable_;                 // see passable()
};

// The rounded line for the first stage: |a - line a| <= a_error, direction scaled to
// about 1 with an error of at most 2 ulp of its largest component.
struct RoundedLine {
  double a[3], d[3];
  double a_error;  // largest error of a coordinate of a
  bool usable;
};

}  // namespace

struct LineScan::Impl {
  // Kept by the thread when their LineScan ends: they are made by the million, and what
  // they keep need not be allocated again.
  static std::unique_ptr<Impl> take(const Scene& scene) {
    auto& spare = spares();
    std::unique_ptr<Impl> impl;
    if (spare.empty()) {
      impl = std::make_unique<Impl>();
    } else {
      impl = std::move(spare.back());
      spare.pop_back();
    }
    impl->scene = &scene;
    return impl;
  }
  static void give_back(std::unique_ptr<Impl> impl) {
    constexpr std::size_t kMostSpares = 8;
    constexpr std::size_t kMostCorners = 256;
    auto& spare = spares();
    if (spare.size() >= kMostSpares || impl->corners.capacity() > kMostCorners) return;
    impl->corners.clear();
    impl->positions.clear();
    impl->hits.clear();
    impl->first_hit.clear();
    impl->contact_to.clear();
    impl->blocked.clear();
    impl->loops.clear();
    spare.push_back(std::move(impl));
  }
  static std::vector<std::unique_ptr<Impl>>& spares() {
    thread_local std::vector<std::unique_ptr<Impl>> spares;
    return spares;
  }

  const Scene* scene = nullptr;
  Ring alpha, origin[3], direction[3];
  bool alpha_is_one = true;
  Gmpq scale;            // delta / alpha
  double rounded_scale;  // within 2 ulp
  int k = 0;
  RoundedLine rounded;

  std::vector<Corner> corners;
  mutable std::vector<Position> positions;
  std::vector<Hit> hits;                     // by position `from` once sorted
  std::vector<int> first_hit;                // of each contact, and the end
  std::vector<int> contact_to;               // position
  std::vector<std::optional<bool>> blocked;  // of each contact, once asked
  std::vector<int> loops;  // corner ids of faces in a plane with L, face by face
  // Scratch of the first stage, per corner of a face.
  std::vector<double> u_scratch;
  std::vector<std::int8_t> signs;

  void set_line(const Point& a, const Point& b);
  void set_line(const ExactPoint& a, const ExactPoint& b);
  void round_line(const double* a, const double* d, double a_relative_error);
  void scan(std::span<const int> faces);

  [[nodiscard]] Corner seen(int point, const Point& p) const;
  int corner(int point);
  int corner_position(int corner_id);
  int edge_position(int p, int q);
  int plane_position(std::span<const int> points);
  int add_position(Ring num, Ring den) const;
  int compare(int p, int q) const;
  [[nodiscard]] Rational quotient_times_scale(const Ring& num, const Ring& den) const;
  const Rational& t(int position) const;
  [[nodiscard]] int t_against(int position, int s) const;

  bool first_stage(std::span<const int> points);
  void meet(int face);
  void meet_in_plane(int face, std::span<const int> ids);
  [[nodiscard]] bool is_diagonal(int face, int side) const;
  void group();
  [[nodiscard]] Rational corner_t(const Corner& c) const;
  [[nodiscard]] int compare_slopes(const Corner& p, const Corner& q, int position) const;
  void add_fins(const Hit& hit, const Rational* lo, const Rational* hi,
                std::vector<Fin>& fins) const;
  [[nodiscard]] std::span<const Hit> hits_of(int contact) const {
    return {hits.data() + first_hit[contact], hits.data() + first_hit[contact + 1]};
  }
  // The order of the slopes of two sides that begin at a position.
  [[nodiscard]] auto slope_order(int position) const {
    return [this, position](const Corner& p, const Corner& q) {
      return compare_slopes(p, q, position);
    };
  }
  bool judge(int contact, const Rational* lo, const Rational* hi,
             const std::function<bool(int)>* solid_behind = nullptr) const;

  // An obstacle at a position, its sides along corners.
  struct Material {
    int position;
    Corner start, end;  // counter-clockwise, at most a half turn
  };
  [[nodiscard]] std::vector<Material> material_at_ends(
      int contact, const Rational& lo, const Rational& hi,
      const std::function<bool(int)>& solid_behind) const;
  void add_material(int contact, const Rational& t,
                    const std::function<bool(int)>& solid_behind,
                    std::vector<Material>& out) const;

  // The sectors of a contact, in order along L, and the position of each.
  struct Sectors {
    std::vector<SectorAt> sectors;
    std::vector<int> at;
  };
  void add_sector(int position, const Corner* start, const Corner* end,
                  Sectors& out) const;
  [[nodiscard]] bool add_sectors(int contact, const Rational* lo, const Rational* hi,
                                 std::span<const Material> material, Sectors& out) const;
  [[nodiscard]] bool block_at_once(std::span<const SectorAt> now, int position) const;
  void add_rays(std::span<const SectorAt> now, int position,
                std::vector<const Ray*>& rays) const;
};

void LineScan::Impl::set_line(const Point& a, const Point& b) {
  alpha = Ring(1);
  alpha_is_one = true;
  scale = Gmpq(1);
  rounded_scale = 1;
  double d[3];
  for (int i = 0; i < 3; ++i) {
    origin[i] = Ring(a[i]);
    direction[i] = Ring(b[i]) - origin[i];
    d[i] = b[i] - a[i];
  }
  round_line(a.data(), d, 0);
}

void LineScan::Impl::set_line(const ExactPoint& a, const ExactPoint& b) {
  const auto common_denominator = [](const Rational* q, CGAL::Gmpz& out) {
    mpz_set_ui(out.mpz(), 1);
    for (int i = 0; i < 3; ++i) {
      mpz_lcm(out.mpz(), out.mpz(), mpq_denref(q[i].backend().data()));
    }
  };
  const auto scaled = [](const Rational& q, const CGAL::Gmpz& denominator) {
    CGAL::Gmpz n;
    mpz_divexact(n.mpz(), denominator.mpz(), mpq_denref(q.backend().data()));
    mpz_mul(n.mpz(), n.mpz(), mpq_numref(q.backend().data()));
    return ring(n.mpz());
  };
  const ExactPoint d = {Rational(b[0] - a[0]), Rational(b[1] - a[1]),
                        Rational(b[2] - a[2])};
  CGAL::Gmpz alpha_z, delta_z;
  common_denominator(a.data(), alpha_z);
  common_denominator(d.data(), delta_z);
  alpha = ring(alpha_z.mpz());
  alpha_is_one = mpz_cmp_ui(alpha_z.mpz(), 1) == 0;
  scale = Gmpq(delta_z, alpha_z);
  rounded_scale = mpq_get_d(scale.mpq());  // truncates
  double ra[3], rd[3];
  for (int i = 0; i < 3; ++i) {
    origin[i] = scaled(a[i], alpha_z);
    direction[i] = scaled(d[i], delta_z);
    ra[i] = mpq_get_d(a[i].backend().data());
    rd[i] = mpq_get_d(d[i].backend().data());
  }
  // mpq_get_d truncates: an error of less than 2 ulp.
  round_line(ra, rd, 2 * kUlp);
}

void LineScan::Impl::round_line(const double* a, const double* d,
                                double a_relative_error) {
  double largest = 0;
  k = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(d[i]) > largest) {
      largest = std::abs(d[i]);
      k = i;
    }
  }
  while (k < 2 && sign_of(direction[k]) == 0) ++k;  // only if d rounds to 0
  assert(sign_of(direction[k]) != 0 && "a line needs two different points");
  int exponent = 0;
  rounded.usable = largest > 1e-200 && largest < 1e200;
  if (rounded.usable) std::frexp(largest, &exponent);
  rounded.a_error = 0;
  for (int i = 0; i < 3; ++i) {
    rounded.a[i] = a[i];
    rounded.d[i] = std::ldexp(d[i], -exponent);
    rounded.a_error = std::max(rounded.a_error, std::abs(a[i]) * a_relative_error);
    rounded.usable = rounded.usable && std::abs(a[i]) < 1e100;
  }
}

// Fills `signs` with how L passes the face's sides, 0 where this stage cannot tell; false
// when L misses the face for certain: passes sides on both hands, or has all corners on
// one side (so told of a face in a plane with L, too).
//
// Let V be the largest |v| (here alpha = 1), |d| <= 1 with error 2 ulp, e = 2^-53.
//   v = fl(p - a):   error <= e V + a_error
//   u = fl(fl(v_i d_k) - fl(v_k d_i)): two products, each off by 2e V (d's error) +
//       e V + a_error (v's error) + e V (rounding), and 2e V for the difference:
//       du <= 10 e V + 2 a_error, taken as 12 e V + 3 a_error for the higher orders
//   s = fl(u_p x u_q), with U the largest |u|: ds <= 4 U du + 2 du^2 + 4 e U^2,
//       taken with 8 e U^2.
bool LineScan::Impl::first_stage(std::span<const int> points) {
  const std::size_t n = points.size();
  signs.assign(n, 0);
  if (!rounded.usable) return true;
  u_scratch.resize(2 * n);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const double di = rounded.d[i], dj = rounded.d[j], dk = rounded.d[k];
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double largest_v = 0, largest_u = 0;
  double low_x = kInfinity, high_x = -kInfinity, low_y = kInfinity, high_y = -kInfinity;
  for (std::size_t c = 0; c < n; ++c) {
    const Point& p = scene->point(points[c]);
    const double vi = p[i] - rounded.a[i], vj = p[j] - rounded.a[j],
                 vk = p[k] - rounded.a[k];
    largest_v = std::max({largest_v, std::abs(vi), std::abs(vj), std::abs(vk)});
    const double ux = vi * dk - vk * di, uy = vj * dk - vk * dj;
    low_x = std::min(low_x, ux);
    high_x = std::max(high_x, ux);
    low_y = std::min(low_y, uy);
    high_y = std::max(high_y, uy);
    u_scratch[2 * c] = ux;
    u_scratch[2 * c + 1] = uy;
  }
  largest_u = std::max({-low_x, high_x, -low_y, high_y});
  const double du = 12 * kUlp * largest_v + 3 * rounded.a_error + kUnderflow;
  if (low_x > du || high_x < -du || low_y > du || high_y < -du) return false;
  const double bound =
      4 * largest_u * du + 2 * du * du + 8 * kUlp * largest_u * largest_u + kUnderflow;
  bool left = false, right = false;
  for (std::size_t c = 0; c < n; ++c) {
    const double* p = &u_scratch[2 * c];
    const double* q = &u_scratch[c + 1 == n ? 0 : 2 * c + 2];
    const double s = p[0] * q[1] - p[1] * q[0];
    signs[c] = s > bound ? 1 : s < -bound ? -1 : 0;
    left |= s > bound;
    right |= s < -bound;
  }
  return !(left && right);
}

int LineScan::Impl::corner(int point) {
  for (int c = static_cast<int>(corners.size()) - 1; c >= 0; --c) {
    if (corners[c].point == point) return c;
  }
  corners.push_back(seen(point, scene->point(point)));
  return static_cast<int>(corners.size()) - 1;
}

// A point as seen along L, under an id.
Corner LineScan::Impl::seen(int point, const Point& p) const {
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const auto v = [&](int axis) {
    const Ring coordinate(p[axis]);
    if (alpha_is_one) return Ring(coordinate - origin[axis]);
    return Ring(Ring(alpha * coordinate) - origin[axis]);
  };
  const Ring vi = v(i), vj = v(j);
  Ring vk = v(k);
  Ray u(Ring(vi * direction[k]) - Ring(vk * direction[i]),
        Ring(vj * direction[k]) - Ring(vk * direction[j]));
  return {point, std::move(vk), std::move(u)};
}

int LineScan::Impl::add_position(Ring num, Ring den) const {
  if (sign_of(den) < 0) {
    num = -num;
    den = -den;
  }
  // Out of the range of doubles the quotient would say nothing (a den that rounds to
  // infinity would make it 0): NaN leaves every comparison to the exact numbers.
  const double n = CGAL::to_double(num), d = CGAL::to_double(den);
  const bool in_range = std::isfinite(n) && std::isfinite(d) && d > kUnderflow &&
                        (std::abs(n) > kUnderflow || sign_of(num) == 0);
  const double approx = in_range ? n / d : std::numeric_limits<double>::quiet_NaN();
  positions.push_back({std::move(num), std::move(den), approx, std::nullopt});
  return static_cast<int>(positions.size()) - 1;
}

int LineScan::Impl::corner_position(int c) {
  return add_position(corners[c].v, direction[k]);
}

// Where the segment between two corners on opposite sides of L in one plane meets L.
int LineScan::Impl::edge_position(int p, int q) {
  const Corner &cp = corners[p], &cq = corners[q];
  const bool use_x = sign_of(cp.u.x) != 0;
  const Ring& up = use_x ? cp.u.x : cp.u.y;
  const Ring& uq = use_x ? cq.u.x : cq.u.y;
  return add_position(Ring(up * cq.v) - Ring(uq * cp.v),
                      Ring(Ring(up - uq) * direction[k]));
}

// Where L meets the plane of a face: the origin's barycentric coordinates in the first
// three corners, which are never collinear.
int LineScan::Impl::plane_position(std::span<const int> points) {
  const auto det = [](const Ray& p, const Ray& q) {
    return Ring(Ring(p.x * q.y) - Ring(p.y * q.x));
  };
  const int c0 = corner(points[0]), c1 = corner(points[1]), c2 = corner(points[2]);
  const Corner &p = corners[c0], &q = corners[c1], &r = corners[c2];
  const Ring wp = det(q.u, r.u), wq = det(r.u, p.u), wr = det(p.u, q.u);
  return add_position(Ring(Ring(wp * p.v) + Ring(wq * q.v)) + Ring(wr * r.v),
                      Ring(Ring(Ring(wp + wq) + wr) * direction[k]));
}

int LineScan::Impl::compare(int p, int q) const {
  if (p == q) return 0;
  const Position &a = positions[p], &b = positions[q];
  // Each is within a relative 6 ulp.
  const double gap = a.approx - b.approx;
  const double bound = 16 * kUlp * (std::abs(a.approx) + std::abs(b.approx)) + kUnderflow;
  if (bound < std::numeric_limits<double>::infinity()) {
    if (gap > bound) return 1;
    if (gap < -bound) return -1;
  }
  return sign_of(Ring(a.num * b.den) - Ring(b.num * a.den));
}

// num / den times scale, brought to lowest terms once.
Rational LineScan::Impl::quotient_times_scale(const Ring& num, const Ring& den) const {
  const Gmpq n = gmpq(num);
  const Gmpq d = gmpq(den);
  Rational out;
  mpq_t& q = out.backend().data();
  mpz_mul(mpq_numref(q), mpq_numref(n.mpq()), mpq_denref(d.mpq()));
  mpz_mul(mpq_denref(q), mpq_denref(n.mpq()), mpq_numref(d.mpq()));
  mpz_mul(mpq_numref(q), mpq_numref(q), mpq_numref(scale.mpq()));
  mpz_mul(mpq_denref(q), mpq_denref(q), mpq_denref(scale.mpq()));
  mpq_canonicalize(q);
  return out;
}

const Rational& LineScan::Impl::t(int position) const {
  Position& p = positions[position];
  if (!p.t) p.t = quotient_times_scale(p.num, p.den);
  return *p.t;
}

// The sign of t(position) - s, s being 0 or 1.
int LineScan::Impl::t_against(int position, int s) const {
  const Position& p = positions[position];
  if (s == 0) return sign_of(p.num);  // den and scale are positive
  // approx is within a relative 6 ulp, rounded_scale within 2, the product within 1.
  const double gap = p.approx * rounded_scale - 1;
  const double bound = 16 * kUlp * (std::abs(gap) + 1) + kUnderflow;
  if (gap > bound) return 1;
  if (gap < -bound) return -1;
  return t(position).compare(1);
}

// A cut inside a polygon of the file: no feature, whether or not the polygon is flat.
bool LineScan::Impl::is_diagonal(int face, int side) const {
  const auto points = scene->face_points(face);
  if (points.size() != 3) return false;  // only triangles are cut from polygons
  const int p = points[side], q = points[(side + 1) % 3];
  const auto near = scene->faces_at(p);
  return std::any_of(near.begin(), near.end(), [&](int f) {
    if (f == face || scene->faces()[f].source != scene->faces()[face].source)
      return false;
    const auto other = scene->face_points(f);
    return std::find(other.begin(), other.end(), q) != other.end();
  });
}

void LineScan::Impl::meet(int face) {
  // 1. In doubles: most faces are missed for certain.
  const auto points = scene->face_points(face);
  if (!first_stage(points)) return;
  const int n = static_cast<int>(points.size());
  const auto next = [n](int i) { return i + 1 == n ? 0 : i + 1; };
  const auto previous = [n](int i) { return i == 0 ? n - 1 : i - 1; };

  // Exact corners are made when they are first needed: ids[i] is -1 until then.  Faces
  // have few corners nearly always: no allocation for them.
  std::array<int, 8> few;
  std::vector<int> many;
  if (n > 8) many.resize(n);
  const std::span<int> ids(n > 8 ? many.data() : few.data(), n);
  std::fill(ids.begin(), ids.end(), -1);
  const auto id = [&](int i) {
    if (ids[i] < 0) ids[i] = corner(points[i]);
    return ids[i];
  };
  // 2. Complete the signs of the turns from corner to corner around L; the certain ones
  // stay.  L misses a face with sides on both hands of it.
  bool left = false, right = false, zero = false;
  for (int i = 0; i < n; ++i) {
    if (signs[i] == 0) {
      const int p = id(i), q = id(next(i));
      signs[i] = static_cast<std::int8_t>(cross(corners[p].u, corners[q].u));
    }
    left |= signs[i] > 0;
    right |= signs[i] < 0;
    zero |= signs[i] == 0;
    if (left && right) return;
  }
  Hit hit{.face = face,
          .kind = TouchKind::Interior,
          .obstacle = Obstacle::Full,
          .from = -1,
          .to = -1};
  // 3. No turn at all: L and the face are in one plane, and may share a whole segment.
  if (!left && !right) {
    for (int i = 0; i < n; ++i) id(i);
    return meet_in_plane(face, ids);
  }
  // 4. All sides turn one way: L crosses the face inside, and no line near L misses it.
  if (!zero) {
    hit.from = hit.to = plane_position(points);
    hits.push_back(hit);
    return;
  }
  // 5. L passes a corner: the face is there a sector between its two sides, taken
  // counter-clockwise as they appear along L.  The face's own sense tells which side is
  // first: it is `left` where the face appears counter-clockwise itself.
  for (int i = 0; i < n; ++i) {
    if (signs[i] != 0 || !corners[id(i)].u.zero()) continue;
    hit.kind = TouchKind::Corner;
    hit.obstacle = Obstacle::Sector;
    hit.index = i;
    hit.from = hit.to = corner_position(id(i));
    hit.start = id(left ? next(i) : previous(i));
    hit.end = id(left ? previous(i) : next(i));
    hits.push_back(hit);
    return;
  }
  // 6. L passes the inside of a side: the face is a half-plane.  The two corners then lie
  // on opposite sides of L.  A cut inside a polygon of the file is as good as its inside.
  for (int i = 0; i < n; ++i) {
    if (signs[i] != 0) continue;
    const int p = id(i), q = id(next(i));
    if (dot(corners[p].u, corners[q].u) > 0) continue;  // on the same line, another side
    if (!is_diagonal(face, i)) {
      hit.kind = TouchKind::Edge;
      hit.obstacle = Obstacle::Sector;
      hit.index = i;
    }
    hit.from = hit.to = edge_position(p, q);
    hit.start = left ? q : p;
    hit.end = left ? p : q;
    hits.push_back(hit);
    return;
  }
  // Not reached: with one sign zero and no two opposite, L meets a side or a corner.
  assert(false && "L meets the boundary of the face");
}

// L is in the plane of the face, whose corners have these ids.
void LineScan::Impl::meet_in_plane(int face, std::span<const int> ids) {
  const int n = static_cast<int>(ids.size());
  int reference = -1;
  for (const int c : ids) {
    if (!corners[c].u.zero()) reference = c;
  }
  assert(reference >= 0 && "a face has an area");
  Hit hit{.face = face,
          .kind = TouchKind::EdgeOn,
          .obstacle = Obstacle::Barrier,
          .from = -1,
          .to = -1};
  const auto side = [&](int i) { return dot(corners[ids[i]].u, corners[reference].u); };
  const auto include = [&](int position, int i) {
    if (hit.from < 0 || compare(position, hit.from) < 0) {
      hit.from = position;
      hit.from_at = i;
    }
    if (hit.to < 0 || compare(position, hit.to) > 0) hit.to = position;
  };
  for (int i = 0; i < n; ++i) {
    const int j = i + 1 == n ? 0 : i + 1;
    const int s = side(i);
    if (s == 0) {
      hit.index = i;
      include(corner_position(ids[i]), i);
    } else if (s * side(j) < 0) {
      include(edge_position(ids[i], ids[j]), i);
    }
  }
  if (hit.from < 0) return;
  if (compare(hit.from, hit.to) == 0) {
    hit.kind = TouchKind::Corner;
    hit.obstacle = Obstacle::None;
  } else {
    hit.index = -1;
  }
  hit.start = reference;
  hit.loop = static_cast<int>(loops.size());
  loops.insert(loops.end(), ids.begin(), ids.end());
  hits.push_back(hit);
}

void LineScan::Impl::scan(std::span<const int> faces) {
  for (const int f : faces) {
    hear_stop();
    meet(f);
  }
  group();
}

// Sorts the hits and cuts them into connected components.
void LineScan::Impl::group() {
  std::sort(hits.begin(), hits.end(), [&](const Hit& p, const Hit& q) {
    const int order = compare(p.from, q.from);
    return order != 0 ? order < 0 : p.face < q.face;
  });
  for (int h = 0; h < static_cast<int>(hits.size()); ++h) {
    if (h == 0 || compare(hits[h].from, contact_to.back()) > 0) {
      first_hit.push_back(h);
      contact_to.push_back(hits[h].to);
    } else if (compare(hits[h].to, contact_to.back()) > 0) {
      contact_to.back() = hits[h].to;
    }
  }
  first_hit.push_back(static_cast<int>(hits.size()));
}

Rational LineScan::Impl::corner_t(const Corner& c) const {
  return quotient_times_scale(c.v, direction[k]);
}

// The slopes of two sides from a position on L to corners that are in one direction seen
// along L: ((x_p - x) / |u_p|) against the same of q.
int LineScan::Impl::compare_slopes(const Corner& p, const Corner& q, int position) const {
  const Position& at = positions[position];
  const auto ahead = [&](const Corner& c) {
    return Ring(Ring(c.v * at.den) - Ring(at.num * direction[k]));
  };
  // Both coordinates have one sign.
  const int sign =
      sign_of(Ring(ahead(p) * coordinate(q.u)) - Ring(ahead(q) * coordinate(p.u)));
  return sign * sign_of(coordinate(p.u)) * sign_of(direction[k]);
}

// The sides of an edge-on face, cut to the part from lo to hi.
void LineScan::Impl::add_fins(const Hit& hit, const Rational* lo, const Rational* hi,
                              std::vector<Fin>& fins) const {
  const int n = static_cast<int>(scene->face_points(hit.face).size());
  const auto at = [&](int i) -> const Corner& {
    return corners[loops[hit.loop + (i + n) % n]];
  };
  for (const int sign : {1, -1}) {
    const auto on_this_side = [&](int i) {
      return sign * dot(at(i).u, corners[hit.start].u) > 0;
    };
    int first = 0;
    while (first < n && (!on_this_side(first) || on_this_side(first - 1))) ++first;
    if (first == n) continue;
    int last = first;
    while (on_this_side(last + 1)) ++last;
    // The side before `first` meets L in its own corner or inside, both numbered so.
    const bool forwards = hit.from_at == (first + n - 1) % n;
    const Corner &entry = at(first), &exit = at(last);
    Fin fin{t(hit.from), t(hit.to), forwards ? &entry : &exit, forwards ? &exit : &entry,
            &entry.u};
    if (hit.obstacle == Obstacle::None) {
      if ((lo != nullptr && fin.from <= *lo) || (hi != nullptr && fin.to >= *hi))
        continue;
    } else {
      if (lo != nullptr && fin.from <= *lo) {
        fin.from = *lo;
        fin.from_side = nullptr;
      }
      if (hi != nullptr && fin.to >= *hi) {
        fin.to = *hi;
        fin.to_side = nullptr;
      }
      if (fin.from >= fin.to) continue;
    }
    fins.push_back(std::move(fin));
  }
}

// The faces in a plane with L that are met at t, which is inside their stretches, cut the
// plane across L into cells; those that are material.
void LineScan::Impl::add_material(int contact, const Rational& at,
                                  const std::function<bool(int)>& solid_behind,
                                  std::vector<Material>& out) const {
  // 1. Across L each face is one leaf, or two opposite ones where L runs through its
  // inside.  Faces in one direction share a leaf.
  struct Leaf {
    Corner corner;
    bool after = false, before = false;  // material counter-clockwise, clockwise of it
  };
  std::vector<Leaf> leaves;
  const auto opposite = [](const Corner& c) { return Corner{-1, c.v, -c.u}; };
  const auto add = [&](Corner corner, bool after, bool before) {
    const auto known = std::ranges::find_if(
        leaves, [&](const Leaf& l) { return same_direction(l.corner.u, corner.u); });
    Leaf& leaf =
        known == leaves.end() ? leaves.emplace_back(Leaf{std::move(corner)}) : *known;
    leaf.after |= after;
    leaf.before |= before;
  };
  bool any = false;
  for (int h = first_hit[contact]; h < first_hit[contact + 1]; ++h) {
    // Faces that L leaves before `at`, or meets only after it, are no leaves there.
    const Hit& hit = hits[h];
    if (hit.obstacle != Obstacle::Barrier || t(hit.from) >= at || t(hit.to) <= at)
      continue;
    // On which hand of its leaf the face has its material: a point w off the face's plane
    // tells the hand that the plane's back is on.
    const bool solid = solid_behind(hit.face);
    any |= solid;
    const auto points = scene->face_points(hit.face);
    const Corner& reference = corners[hit.start];
    const std::array<Point, 3> plane{scene->point(points[0]), scene->point(points[1]),
                                     scene->point(points[2])};
    const Point w = point_off_plane(plane[0], plane[1], plane[2]);
    const bool behind = orient3d(plane[0], plane[1], plane[2], w) == Sign::Negative;
    const int turn = cross(reference.u, seen(-1, w).u);  // w's plane is not L's: not 0
    const bool after = solid && (turn > 0) == behind;
    const bool before = solid && !after;
    // Which of the two opposite leaves the face has: by the sides of L its corners are
    // on.  At the opposite leaf the hands are exchanged.
    bool ahead = false, back = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int side = dot(corners[loops[hit.loop + i]].u, reference.u);
      ahead |= side > 0;
      back |= side < 0;
    }
    if (ahead) add(reference, after, before);
    if (back) add(opposite(reference), before, after);
  }
  // Sheets alone enclose no material.
  if (!any) return;
  // 2. The leaves in counter-clockwise order cut the plane across L into cells.
  std::sort(leaves.begin() + 1, leaves.end(), [&](const Leaf& p, const Leaf& q) {
    // By the turn from the first leaf: its half turn, its opposite, the other half.
    const auto half = [&](const Leaf& l) {
      const int side = cross(leaves[0].corner.u, l.corner.u);
      return side > 0 ? 0 : side == 0 ? 1 : 2;
    };
    const int a = half(p), b = half(q);
    return a != b ? a < b : cross(p.corner.u, q.corner.u) > 0;
  });
  // 3. A cell is material when the leaf before or after it says so.  An obstacle is at
  // most a half turn, so that a cell of more is two.
  // Positions are kept without `scale`, as those of all hits.
  const Rational x = at / rational(scale);
  const int position = add_position(ring(mpq_numref(x.backend().data())),
                                    ring(mpq_denref(x.backend().data())));
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Leaf& from = leaves[i];
    const Leaf& to = leaves[(i + 1) % leaves.size()];
    if (!from.after && !to.before) continue;
    // Counter-clockwise: less than a half turn, a half, more, or all of it.
    const int turn = &from == &to ? -1 : cross(from.corner.u, to.corner.u);
    if (turn >= 0) {
      out.push_back({position, from.corner, to.corner});
    } else {
      out.push_back({position, from.corner, opposite(from.corner)});
      out.push_back({position, opposite(from.corner), to.corner});
    }
  }
}

// Just after lo and just before hi.
std::vector<LineScan::Impl::Material> LineScan::Impl::material_at_ends(
    int contact, const Rational& lo, const Rational& hi,
    const std::function<bool(int)>& solid_behind) const {
  const bool along_solid = std::any_of(
      hits.begin() + first_hit[contact], hits.begin() + first_hit[contact + 1],
      [&](const Hit& h) {
        return h.obstacle == Obstacle::Barrier && solid_behind(h.face) &&
               ((t(h.from) <= lo && lo < t(h.to)) || (t(h.from) < hi && hi <= t(h.to)));
      });
  if (!along_solid) return {};
  Rational first = hi;
  Rational last = lo;
  for (int h = first_hit[contact]; h < first_hit[contact + 1]; ++h) {
    for (const int position : {hits[h].from, hits[h].to}) {
      const Rational& at = t(position);
      if (lo < at && at < first) first = at;
      if (last < at && at < hi) last = at;
    }
  }
  std::vector<Material> out;
  add_material(contact, (lo + first) / 2, solid_behind, out);
  if (last > lo) add_material(contact, (last + hi) / 2, solid_behind, out);
  return out;
}

// Adds a sector at a position at or beyond those of the sectors before.
void LineScan::Impl::add_sector(int position, const Corner* start, const Corner* end,
                                Sectors& out) const {
  const bool later = !out.at.empty() && compare(out.at.back(), position) != 0;
  const int instant = out.at.empty() ? 0 : out.sectors.back().instant + (later ? 1 : 0);
  out.sectors.push_back({instant, start, end});
  out.at.push_back(position);
}

// The sectors at which the faces of the contact are crossed strictly between lo and hi,
// and those of the material just after lo and just before hi, in order.  False: a face is
// crossed in its inside, so that the contact blocks.
bool LineScan::Impl::add_sectors(int contact, const Rational* lo, const Rational* hi,
                                 std::span<const Material> material, Sectors& out) const {
  const auto inside = [&](int position) {
    return (lo == nullptr || t(position) > *lo) && (hi == nullptr || t(position) < *hi);
  };
  const auto is_first = [&](const Material& m) {
    return m.position == material.front().position;
  };
  for (const Material& m : material) {
    if (is_first(m)) add_sector(m.position, &m.start, &m.end, out);
  }
  for (const Hit& h : hits_of(contact)) {
    hear_stop();
    if (h.obstacle != Obstacle::Full && h.obstacle != Obstacle::Sector) continue;
    if (!inside(h.from)) continue;
    if (h.obstacle == Obstacle::Full) return false;
    add_sector(h.from, &corners[h.start], &corners[h.end], out);
  }
  for (const Material& m : material) {
    if (!is_first(m)) add_sector(m.position, &m.start, &m.end, out);
  }
  return true;
}

// The sectors of one instant, which is at this position, leave no way: not a direction is
// free, and no ray can be crossed just then.
bool LineScan::Impl::block_at_once(std::span<const SectorAt> now, int position) const {
  if (sealed(now)) return true;
  return covers(now) && std::none_of(now.begin(), now.end(), [&](const SectorAt& s) {
           return crossable(s.end->u, now, slope_order(position));
         });
}

// Adds the sides of the sectors of one instant, each direction once.  Rays inside of the
// union of the sectors do not matter.
void LineScan::Impl::add_rays(std::span<const SectorAt> now, int position,
                              std::vector<const Ray*>& rays) const {
  const auto matters = [&](const Ray& r) {
    const auto contains = [&](auto&& side) {
      return std::any_of(now.begin(), now.end(),
                         [&](const SectorAt& s) { return side(s, r); });
    };
    return !contains(contains_after) || !contains(contains_before) ||
           crossable(r, now, slope_order(position));
  };
  for (const SectorAt& s : now) {
    for (const Corner* c : {s.start, s.end}) {
      hear_stop();
      if (std::none_of(rays.begin(), rays.end(),
                       [&](const Ray* r) { return same_direction(*r, c->u); }) &&
          matters(c->u)) {
        rays.push_back(&c->u);
      }
    }
  }
}

// Whether the contact blocks the part of the line from lo to hi, or all of it.  First it
// looks for a line at rest, then for an instant at which nothing passes, and only then
// for a motion.
bool LineScan::Impl::judge(int contact, const Rational* lo, const Rational* hi,
                           const std::function<bool(int)>* solid_behind) const {
  // A part of the line that begins or ends along a wall has the wall's material in the
  // way of those nearby lines that are within it there.
  const std::vector<Material> material =
      solid_behind != nullptr ? material_at_ends(contact, *lo, *hi, *solid_behind)
                              : std::vector<Material>{};
  // 1. The faces that are crossed: sectors, in order along the line.  One that is crossed
  // in its inside is met by every line nearby.
  Sectors crossed;
  if (!add_sectors(contact, lo, hi, material, crossed)) return true;
  auto& [sectors, at] = crossed;
  // 2. A direction that no sector covers: the line moved off that way, parallel to
  // itself, is free.  Barriers do not stop it, since it crosses none.
  if (!covers(sectors)) return false;
  // 3. Instant by instant: whether the sectors of one instant alone block everything.  If
  // not, a motion may pass between their sides.
  std::vector<const Ray*> rays;
  for (std::size_t first = 0, last; first < sectors.size(); first = last) {
    for (last = first; last < sectors.size(); ++last) {
      if (sectors[last].instant != sectors[first].instant) break;
    }
    const auto now = std::span(sectors).subspan(first, last - first);
    if (block_at_once(now, at[first])) return true;
    add_rays(now, at[first], rays);
  }

  // 4. The faces in a plane with the line are barriers while they last: their beginnings
  // and ends are instants, too.
  std::vector<Fin> fins;
  for (const Hit& h : hits_of(contact)) {
    hear_stop();
    if (h.loop >= 0) add_fins(h, lo, hi, fins);
  }
  const auto directions = by_direction(fins);
  // Rays along which something is up for a while matter, like the sides of sectors.
  const CornerTimes corner_time = [&](const Corner& c) { return corner_t(c); };
  std::vector<Rational> instants;
  for (const int position : at) instants.push_back(t(position));
  for (const auto& along : directions) {
    if (add_instants(along, corner_time, instants)) rays.push_back(along.front()->ray);
  }
  // 5. Number the instants of both kinds in one order, and search for a motion.
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  for (std::size_t i = 0; i < sectors.size(); ++i) {
    sectors[i].instant = static_cast<int>(
        std::lower_bound(instants.begin(), instants.end(), t(at[i])) - instants.begin());
  }
  return !MotionSearch(std::move(instants), sectors, directions, rays, corner_time)
              .possible();
}

LineScan::LineScan(const Scene& scene, std::span<const int> faces, const ExactPoint& a,
                   const ExactPoint& b)
    : impl_(Impl::take(scene)) {
  impl_->set_line(a, b);
  impl_->scan(faces);
}

LineScan::LineScan(const Scene& scene, std::span<const int> faces, const Point& a,
                   const Point& b)
    : impl_(Impl::take(scene)) {
  impl_->set_line(a, b);
  impl_->scan(faces);
}

LineScan::~LineScan() {
  if (impl_) Impl::give_back(std::move(impl_));
}
LineScan::LineScan(LineScan&&) noexcept = default;

int LineScan::size() const { return static_cast<int>(impl_->contact_to.size()); }

const Rational& LineScan::from(int contact) const {
  return impl_->t(impl_->hits[impl_->first_hit[contact]].from);
}

const Rational& LineScan::to(int contact) const {
  return impl_->t(impl_->contact_to[contact]);
}

int LineScan::from_against(int contact, int s) const {
  return impl_->t_against(impl_->hits[impl_->first_hit[contact]].from, s);
}

int LineScan::to_against(int contact, int s) const {
  return impl_->t_against(impl_->contact_to[contact], s);
}

bool LineScan::is_point(int contact) const {
  const int from = impl_->hits[impl_->first_hit[contact]].from;
  return impl_->compare(from, impl_->contact_to[contact]) == 0;
}

std::vector<Touch> LineScan::touches(int contact) const {
  std::vector<Touch> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    const Hit& hit = impl_->hits[h];
    out.push_back({hit.face, hit.kind, hit.index});
  }
  std::sort(out.begin(), out.end(),
            [](const Touch& p, const Touch& q) { return p.face < q.face; });
  return out;
}

std::vector<int> LineScan::edge_on_corners(int contact) const {
  std::vector<int> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    const Hit& hit = impl_->hits[h];
    if (hit.kind != TouchKind::EdgeOn) continue;
    const int n = impl_->scene->faces()[hit.face].corner_count;
    for (int i = hit.loop; i < hit.loop + n; ++i) {
      const Corner& c = impl_->corners[impl_->loops[i]];
      if (c.u.zero()) out.push_back(c.point);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<int> LineScan::faces_at(int contact, const Rational& t) const {
  std::vector<int> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    const Hit& hit = impl_->hits[h];
    if (impl_->t(hit.from) <= t && t <= impl_->t(hit.to)) out.push_back(hit.face);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<int> LineScan::faces_within(int contact, const std::optional<Rational>& lo,
                                        const std::optional<Rational>& hi) const {
  std::vector<int> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    const Hit& hit = impl_->hits[h];
    if ((!hi || impl_->t(hit.from) <= *hi) && (!lo || *lo <= impl_->t(hit.to)))
      out.push_back(hit.face);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Rational> LineScan::instants(int contact) const {
  std::vector<int> at;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    at.push_back(impl_->hits[h].from);
    if (impl_->hits[h].to != at.back()) at.push_back(impl_->hits[h].to);
  }
  std::sort(at.begin(), at.end(), [&](int p, int q) { return impl_->compare(p, q) < 0; });
  std::vector<Rational> out;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (i == 0 || impl_->compare(at[i - 1], at[i]) != 0) out.push_back(impl_->t(at[i]));
  }
  return out;
}

bool LineScan::blocked(int contact) const {
  if (impl_->blocked.empty()) impl_->blocked.resize(static_cast<std::size_t>(size()));
  std::optional<bool>& known = impl_->blocked[static_cast<std::size_t>(contact)];
  if (!known) known = impl_->judge(contact, nullptr, nullptr);
  return *known;
}

bool LineScan::blocked_between(int contact, const Rational& lo,
                               const Rational& hi) const {
  return impl_->judge(contact, &lo, &hi);
}

bool LineScan::blocked_between(int contact, const Rational& lo, const Rational& hi,
                               const std::function<bool(int)>& solid_behind) const {
  return impl_->judge(contact, &lo, &hi, &solid_behind);
}

}  // namespace sightline::internal
