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
// two
//   opposite rays that w must not cross.
// The contact blocks iff no w in general position avoids all of them.

#include <CGAL/Gmpq.h>
#include <CGAL/Mpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "linespace/contact_internal.h"

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
Gmpq gmpq(const Rational& r) { return Gmpq(r.backend().data()); }
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
  Ray operator-() const { return {-x, -y}; }
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

// What a face is to a moving point w: see the top of this file.
enum class Obstacle : std::uint8_t { None, Full, Sector, Barrier };

// One face's part in a contact.  Rays and positions are numbers into LineScan::Impl.
struct Hit {
  int face;
  TouchKind kind;
  Obstacle obstacle;
  bool plus = false, minus = false;  // Barrier: along the ray, against it
  int index = -1;
  int from, to;
  int start = -1, end = -1;  // Sector: counter-clockwise from start, at most a half turn
};

// A position x = num / den along L, den > 0.
struct Position {
  Ring num, den;
  double approx = 0;
  std::optional<Rational> t;
};

struct SectorAt {
  int instant;
  const Ray *start, *end;
};

struct BarrierDuring {
  int from, to;  // instants
  const Ray* ray;
  bool plus, minus;
};

// Directions just counter-clockwise of r are in the sector.
bool contains_after(const SectorAt& s, const Ray& r) {
  if (same_direction(*s.start, r)) return true;
  return cross(*s.start, r) > 0 && cross(r, *s.end) > 0;
}

// The union of the closed sectors is the whole plane: no sector's end is followed by a
// gap.
bool covers(std::span<const SectorAt> sectors) {
  if (sectors.size() < 2) return false;
  return std::all_of(sectors.begin(), sectors.end(), [&](const SectorAt& s) {
    return std::any_of(sectors.begin(), sectors.end(), [&](const SectorAt& other) {
      return contains_after(other, *s.end);
    });
  });
}

// Decides whether some w passes, once no constant w does.
//
// The critical rays and their opposites cut the plane into 2m cells.  A straight motion
// that misses the origin turns by less than a half turn in all, in one sense, so it is
// described by the cell it is in at each instant; between two instants it crosses the
// rays between the two cells, and no ray may be one of a barrier that is up.  Whether
// cells c_0, ..., c_k are those of a motion is a linear program in (w(x_0), w(x_k)). Only
// from a cell straight to the opposite one is the sense not given by the cells; then all
// cells before are the first and all after the second, and both senses are possible: in
// the coordinates of the cell's two sides both must change sign between the two instants,
// in any order.
//
// Which cells can be followed by which is found first, without regard to straightness
// (passable_); only what can be completed so is tried, and asked of the linear program.
class MotionSearch {
 public:
  MotionSearch(std::vector<Rational> instants, std::span<const SectorAt> sectors,
               std::span<const BarrierDuring> barriers)
      : instants_(std::move(instants)) {
    cut_into_cells(sectors, barriers);
    const std::size_t cells = rays_.size(), count = instants_.size();
    closed_.assign(count, std::vector<char>(cells, 0));
    for (std::size_t c = 0; c < cells; ++c) {
      const Ray& r = rays_[c];
      for (const SectorAt& s : sectors) {
        if (contains_after(s, r)) closed_[s.instant][c] = 1;
      }
    }
    up_.assign(count - 1, std::vector<char>(cells, 0));
    for (const BarrierDuring& b : barriers) {
      for (std::size_t c = 0; c < cells; ++c) {
        if ((b.plus && same_direction(*b.ray, rays_[c])) ||
            (b.minus && same_direction(-*b.ray, rays_[c]))) {
          for (int gap = b.from; gap < b.to; ++gap) up_[gap][c] = 1;
        }
      }
    }
  }

  bool possible() {
    for (const int sense : {1, -1}) {
      find_passable(sense);
      for (int c = 0; c < size(); ++c) {
        if (!passable(0, c, 0)) continue;
        cells_.assign(1, c);
        if (extend(sense, 0)) return true;
      }
    }
    return false;
  }

 private:
  [[nodiscard]] int size() const { return static_cast<int>(rays_.size()); }
  [[nodiscard]] int half() const { return size() / 2; }
  [[nodiscard]] int wrapped(int c) const { return (c + 2 * size()) % size(); }

  // rays_: all critical rays and their opposites by angle, cell c from ray c to ray c
  // + 1.
  void cut_into_cells(std::span<const SectorAt> sectors,
                      std::span<const BarrierDuring> barriers) {
    std::vector<Ray> upper;
    const auto add = [&](const Ray& r) {
      const int y = sign_of(r.y);
      upper.push_back(y > 0 || (y == 0 && sign_of(r.x) > 0) ? r : -r);
    };
    for (const SectorAt& s : sectors) {
      add(*s.start);
      add(*s.end);
    }
    for (const BarrierDuring& b : barriers) add(*b.ray);
    // A cell must be less than a half-plane: rays in two directions at least.
    add(Ray(-upper.front().y, upper.front().x));
    std::sort(upper.begin(), upper.end(),
              [](const Ray& p, const Ray& q) { return cross(p, q) > 0; });
    upper.erase(std::unique(upper.begin(), upper.end(),
                            [](const Ray& p, const Ray& q) { return cross(p, q) == 0; }),
                upper.end());
    rays_ = upper;
    for (const Ray& r : upper) rays_.push_back(-r);
  }

  // From the cell at instant i, having turned by `turned` cells so far, free cells lead
  // to the last instant.
  [[nodiscard]] char& passable(std::size_t i, int cell, int turned) {
    return passable_[(i * rays_.size() + static_cast<std::size_t>(cell)) *
                         static_cast<std::size_t>(half() + 1) +
                     static_cast<std::size_t>(turned)];
  }

  void find_passable(int sense) {
    const std::size_t count = instants_.size();
    passable_.assign(count * rays_.size() * static_cast<std::size_t>(half() + 1), 0);
    for (std::size_t i = count; i-- > 0;) {
      for (int c = 0; c < size(); ++c) {
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

  // Some step from a cell at instant i to a cell at the next, past no barrier, is
  // accepted.
  template <class Accept>
  bool any_step(int sense, std::size_t i, int here, int turned, Accept&& accept) const {
    for (int step = 0; turned + step <= half(); ++step) {
      if (step > 0) {
        const int crossed = sense > 0 ? wrapped(here + step) : wrapped(here - step + 1);
        if (up_[i][crossed]) return false;
      }
      if (accept(wrapped(here + sense * step), step)) return true;
    }
    return false;
  }

  // Continues the cells found so far, having turned by `turned` cells in all.
  bool extend(int sense, int turned) {
    const std::size_t i = cells_.size();
    if (i == instants_.size()) return true;
    return any_step(sense, i - 1, cells_.back(), turned, [&](int next, int step) {
      if (step == half()) return stays_free(next, i);
      if (!passable(i, next, turned + step)) return false;
      cells_.push_back(next);
      // A step to the same cell needs no look of its own unless it is the last.
      const bool look = step > 0 || i + 1 == instants_.size();
      if ((!look || is_a_motion()) && extend(sense, turned + step)) return true;
      cells_.pop_back();
      return false;
    });
  }

  [[nodiscard]] bool stays_free(int cell, std::size_t from) const {
    for (std::size_t i = from; i < instants_.size(); ++i) {
      if (closed_[i][cell]) return false;
    }
    return true;
  }

  // On the left of ray j lie the cells j, ..., j + m - 1.
  [[nodiscard]] bool left_of(int ray, int cell) const {
    return wrapped(cell - ray) < half();
  }

  // Some motion is in these cells at the first instants.  For each line through the
  // origin the side of w is the sign of an affine function of time, so that two instants
  // say all.
  [[nodiscard]] bool is_a_motion() const {
    const std::size_t count = cells_.size();
    if (count <= 2) return true;
    CGAL::Quadratic_program<Gmpq> program(CGAL::LARGER, false, 0, false, 0);
    int row = 0;
    const Gmpq first = gmpq(instants_.front());
    const Gmpq length = gmpq(instants_[count - 1]) - first;
    const auto require = [&](int ray, std::size_t i) {
      const Gmpq s = (gmpq(instants_[i]) - first) / length;
      const Gmpq x = gmpq(rays_[ray].x), y = gmpq(rays_[ray].y);
      const int side = left_of(ray, cells_[i]) ? 1 : -1;
      // side * (x w_y - y w_x) >= 1 for w = (1 - s) w(x_0) + s w(x_k); any positive bound
      // does, because w can be scaled.
      program.set_a(0, row, -y * (1 - s) * side);
      program.set_a(1, row, x * (1 - s) * side);
      program.set_a(2, row, -y * s * side);
      program.set_a(3, row, x * s * side);
      program.set_b(row, 1);
      ++row;
    };
    for (int ray = 0; ray < half(); ++ray) {
      // Lines that bound none of the cells say nothing that others do not.
      if (std::none_of(cells_.begin(), cells_.end(), [&](int c) {
            return c % half() == ray || (c + 1) % half() == ray;
          })) {
        continue;
      }
      std::size_t last = 0;  // last instant before the change of side
      while (last + 1 < count &&
             left_of(ray, cells_[last + 1]) == left_of(ray, cells_[0])) {
        ++last;
      }
      const bool changes = last + 1 < count;
      require(ray, changes ? last : 0);
      require(ray, changes ? last + 1 : count - 1);
    }
    return !CGAL::solve_linear_program(program, Gmpq()).is_infeasible();
  }

  std::vector<Rational> instants_;
  std::vector<Ray> rays_;
  std::vector<std::vector<char>> closed_;  // [instant][cell]
  std::vector<std::vector<char>> up_;      // [between instant and the next][ray]
  std::vector<int> cells_;                 // at the first instants
  std::vector<char> passable_;             // see passable()
};

// The rounded line for the first stage: |a - line a| <= a_error, direction scaled to
// about 1 with an error of at most 2 ulp of its largest component.
struct RoundedLine {
  double a[3], d[3];
  double a_error;  // largest error of a coordinate of a
  bool usable;
};

}  // namespace

ExactPoint exact_point(const Point& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}

struct LineScan::Impl {
  explicit Impl(const Scene& s) : scene(s) {}

  struct Corner {
    int point;
    Ring v;  // v_k
    Ray u;
  };

  const Scene& scene;
  Ring alpha, origin[3], direction[3];
  bool alpha_is_one = true;
  Gmpq scale;  // delta / alpha
  int k = 0;
  RoundedLine rounded;

  std::vector<Corner> corners;
  mutable std::vector<Position> positions;
  std::vector<Hit> hits;        // by position `from` once sorted
  std::vector<int> first_hit;   // of each contact, and the end
  std::vector<int> contact_to;  // position
  // Scratch of the first stage, per corner of a face.
  std::vector<double> u_scratch;
  std::vector<std::int8_t> signs;

  void set_line(const Point& a, const Point& b);
  void set_line(const ExactPoint& a, const ExactPoint& b);
  void round_line(const double* a, const double* d, double a_relative_error);
  void scan(std::span<const int> faces);

  int corner(int point);
  int corner_position(int corner_id);
  int edge_position(int p, int q);
  int plane_position(std::span<const int> points);
  int add_position(Ring num, Ring den);
  int compare(int p, int q) const;
  const Rational& t(int position) const;

  bool first_stage(std::span<const int> points);
  void meet(int face);
  void meet_in_plane(int face, std::span<const int> ids);
  [[nodiscard]] bool is_diagonal(int face, int side) const;
  void group();
  bool judge(int contact, const Rational* lo, const Rational* hi) const;
};

void LineScan::Impl::set_line(const Point& a, const Point& b) {
  alpha = Ring(1);
  alpha_is_one = true;
  scale = Gmpq(1);
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
// when L misses the face for certain.
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
  double largest_v = 0, largest_u = 0;
  for (std::size_t c = 0; c < n; ++c) {
    const Point& p = scene.point(points[c]);
    const double vi = p[i] - rounded.a[i], vj = p[j] - rounded.a[j],
                 vk = p[k] - rounded.a[k];
    largest_v = std::max({largest_v, std::abs(vi), std::abs(vj), std::abs(vk)});
    const double ux = vi * dk - vk * di, uy = vj * dk - vk * dj;
    largest_u = std::max({largest_u, std::abs(ux), std::abs(uy)});
    u_scratch[2 * c] = ux;
    u_scratch[2 * c + 1] = uy;
  }
  const double du = 12 * kUlp * largest_v + 3 * rounded.a_error + kUnderflow;
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
  const Point& p = scene.point(point);
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
  corners.push_back({point, std::move(vk), std::move(u)});
  return static_cast<int>(corners.size()) - 1;
}

int LineScan::Impl::add_position(Ring num, Ring den) {
  if (sign_of(den) < 0) {
    num = -num;
    den = -den;
  }
  const double approx = CGAL::to_double(num) / CGAL::to_double(den);
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

const Rational& LineScan::Impl::t(int position) const {
  Position& p = positions[position];
  if (!p.t) p.t = rational(gmpq(p.num) / gmpq(p.den) * scale);
  return *p.t;
}

// A cut inside a polygon of the file: no feature, whether or not the polygon is flat.
bool LineScan::Impl::is_diagonal(int face, int side) const {
  const auto points = scene.face_points(face);
  if (points.size() != 3) return false;  // only triangles are cut from polygons
  const int p = points[side], q = points[(side + 1) % 3];
  const auto near = scene.faces_at(p);
  return std::any_of(near.begin(), near.end(), [&](int f) {
    if (f == face || scene.faces()[f].source != scene.faces()[face].source) return false;
    const auto other = scene.face_points(f);
    return std::find(other.begin(), other.end(), q) != other.end();
  });
}

void LineScan::Impl::meet(int face) {
  const auto points = scene.face_points(face);
  if (!first_stage(points)) return;
  const int n = static_cast<int>(points.size());
  const auto next = [n](int i) { return i + 1 == n ? 0 : i + 1; };
  const auto previous = [n](int i) { return i == 0 ? n - 1 : i - 1; };

  std::array<int, 8> few;
  std::vector<int> many;
  if (n > 8) many.resize(n);
  const std::span<int> ids(n > 8 ? many.data() : few.data(), n);
  std::fill(ids.begin(), ids.end(), -1);
  const auto id = [&](int i) {
    if (ids[i] < 0) ids[i] = corner(points[i]);
    return ids[i];
  };
  // Complete the signs; the certain ones stay.
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
  if (!left && !right) {
    for (int i = 0; i < n; ++i) id(i);
    return meet_in_plane(face, ids);
  }
  if (!zero) {
    hit.from = hit.to = plane_position(points);
    hits.push_back(hit);
    return;
  }
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
  const auto include = [&](int position) {
    if (hit.from < 0 || compare(position, hit.from) < 0) hit.from = position;
    if (hit.to < 0 || compare(position, hit.to) > 0) hit.to = position;
  };
  for (int i = 0; i < n; ++i) {
    const int j = i + 1 == n ? 0 : i + 1;
    const int s = side(i);
    hit.plus |= s > 0;
    hit.minus |= s < 0;
    if (s == 0) {
      hit.index = i;
      include(corner_position(ids[i]));
    } else if (s * side(j) < 0) {
      include(edge_position(ids[i], ids[j]));
    }
  }
  if (hit.from < 0) return;
  if (compare(hit.from, hit.to) == 0) {
    hit.kind = TouchKind::Corner;
    hit.obstacle = Obstacle::None;
  } else {
    hit.index = -1;
    hit.start = reference;
  }
  hits.push_back(hit);
}

void LineScan::Impl::scan(std::span<const int> faces) {
  for (const int f : faces) meet(f);
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

bool LineScan::Impl::judge(int contact, const Rational* lo, const Rational* hi) const {
  const std::span<const Hit> mine(hits.begin() + first_hit[contact],
                                  hits.begin() + first_hit[contact + 1]);
  const auto inside = [&](int position) {
    return (lo == nullptr || t(position) > *lo) && (hi == nullptr || t(position) < *hi);
  };
  std::vector<SectorAt> sectors;
  std::vector<int> at;  // position of each sector
  bool edge_on = false;
  for (const Hit& h : mine) {
    edge_on |= h.obstacle == Obstacle::Barrier;
    if (h.obstacle != Obstacle::Full && h.obstacle != Obstacle::Sector) continue;
    if (!inside(h.from)) continue;
    if (h.obstacle == Obstacle::Full) return true;
    const int instant =
        at.empty() ? 0
                   : sectors.back().instant + (compare(at.back(), h.from) != 0 ? 1 : 0);
    sectors.push_back({instant, &corners[h.start].u, &corners[h.end].u});
    at.push_back(h.from);
  }
  // A constant w is free, or else no w is at one instant.
  if (!covers(sectors)) return false;
  for (std::size_t first = 0, last; first < sectors.size(); first = last) {
    for (last = first; last < sectors.size(); ++last) {
      if (sectors[last].instant != sectors[first].instant) break;
    }
    if (covers(std::span(sectors).subspan(first, last - first))) return true;
  }
  assert(edge_on && "a point contact has one instant");

  std::vector<Rational> instants;
  for (const int position : at) instants.push_back(t(position));
  struct Stretch {
    Rational from, to;
    const Hit* hit;
  };
  std::vector<Stretch> stretches;
  for (const Hit& h : mine) {
    if (h.obstacle != Obstacle::Barrier) continue;
    Rational from = t(h.from), to = t(h.to);
    if (lo != nullptr && from < *lo) from = *lo;
    if (hi != nullptr && to > *hi) to = *hi;
    if (from >= to) continue;
    instants.push_back(from);
    instants.push_back(to);
    stretches.push_back({std::move(from), std::move(to), &h});
  }
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  const auto number = [&](const Rational& x) {
    return static_cast<int>(std::lower_bound(instants.begin(), instants.end(), x) -
                            instants.begin());
  };
  for (std::size_t i = 0; i < sectors.size(); ++i) sectors[i].instant = number(t(at[i]));
  std::vector<BarrierDuring> barriers;
  for (const Stretch& s : stretches) {
    barriers.push_back({number(s.from), number(s.to), &corners[s.hit->start].u,
                        s.hit->plus, s.hit->minus});
  }
  return !MotionSearch(std::move(instants), sectors, barriers).possible();
}

LineScan::LineScan(const Scene& scene, std::span<const int> faces, const ExactPoint& a,
                   const ExactPoint& b)
    : impl_(std::make_unique<Impl>(scene)) {
  impl_->set_line(a, b);
  impl_->scan(faces);
}

LineScan::LineScan(const Scene& scene, std::span<const int> faces, const Point& a,
                   const Point& b)
    : impl_(std::make_unique<Impl>(scene)) {
  impl_->set_line(a, b);
  impl_->scan(faces);
}

LineScan::~LineScan() = default;
LineScan::LineScan(LineScan&&) noexcept = default;

int LineScan::size() const { return static_cast<int>(impl_->contact_to.size()); }

const Rational& LineScan::from(int contact) const {
  return impl_->t(impl_->hits[impl_->first_hit[contact]].from);
}

const Rational& LineScan::to(int contact) const {
  return impl_->t(impl_->contact_to[contact]);
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

std::vector<int> LineScan::faces_at(int contact, const Rational& t) const {
  std::vector<int> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    const Hit& hit = impl_->hits[h];
    if (impl_->t(hit.from) <= t && t <= impl_->t(hit.to)) out.push_back(hit.face);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Rational> LineScan::instants(int contact) const {
  std::vector<Rational> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    out.push_back(impl_->t(impl_->hits[h].from));
    out.push_back(impl_->t(impl_->hits[h].to));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

bool LineScan::blocked(int contact) const {
  return impl_->judge(contact, nullptr, nullptr);
}

bool LineScan::blocked_between(int contact, const Rational& lo,
                               const Rational& hi) const {
  return impl_->judge(contact, &lo, &hi);
}

namespace {

std::vector<ExactContact> all_contacts(const LineScan& scan) {
  std::vector<ExactContact> out;
  out.reserve(scan.size());
  for (int c = 0; c < scan.size(); ++c) {
    out.push_back({scan.from(c), scan.to(c), scan.blocked(c), scan.touches(c)});
  }
  return out;
}

}  // namespace

std::vector<ExactContact> line_contacts(const Scene& scene, std::span<const int> faces,
                                        const ExactPoint& a, const ExactPoint& b) {
  return all_contacts(LineScan(scene, faces, a, b));
}

std::vector<ExactContact> line_contacts(const Scene& scene, std::span<const int> faces,
                                        const Point& a, const Point& b) {
  return all_contacts(LineScan(scene, faces, a, b));
}

}  // namespace sightline::internal
