// How a line meets faces, by exact signs: the notation is that of seen_along.h.

#include "linespace/contacts/line_scan.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace contacts {

void Scan::set_line(const Point& a, const Point& b) {
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

void Scan::set_line(const ExactPoint& a, const ExactPoint& b) {
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
  round_line(ra, rd, 2 * kUnit);
}

void Scan::round_line(const double* a, const double* d, double a_relative_error) {
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
bool Scan::first_stage(std::span<const int> points) {
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
  const double du = 12 * kUnit * largest_v + 3 * rounded.a_error + kUnderflow;
  if (low_x > du || high_x < -du || low_y > du || high_y < -du) return false;
  const double bound =
      4 * largest_u * du + 2 * du * du + 8 * kUnit * largest_u * largest_u + kUnderflow;
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

int Scan::corner(int point) {
  for (int c = static_cast<int>(corners.size()) - 1; c >= 0; --c) {
    if (corners[c].point == point) return c;
  }
  corners.push_back(seen(point, scene->point(point)));
  return static_cast<int>(corners.size()) - 1;
}

// A point as seen along L, under an id.
Corner Scan::seen(int point, const Point& p) const {
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

int Scan::add_position(Ring num, Ring den) const {
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

int Scan::corner_position(int c) { return add_position(corners[c].v, direction[k]); }

// Where the segment between two corners on opposite sides of L in one plane meets L.
int Scan::edge_position(int p, int q) {
  const Corner &cp = corners[p], &cq = corners[q];
  const bool use_x = sign_of(cp.u.x) != 0;
  const Ring& up = use_x ? cp.u.x : cp.u.y;
  const Ring& uq = use_x ? cq.u.x : cq.u.y;
  return add_position(Ring(up * cq.v) - Ring(uq * cp.v),
                      Ring(Ring(up - uq) * direction[k]));
}

// Where L meets the plane of a face: the origin's barycentric coordinates in the first
// three corners, which are never collinear.
int Scan::plane_position(std::span<const int> points) {
  const auto det = [](const Ray& p, const Ray& q) {
    return Ring(Ring(p.x * q.y) - Ring(p.y * q.x));
  };
  const int c0 = corner(points[0]), c1 = corner(points[1]), c2 = corner(points[2]);
  const Corner &p = corners[c0], &q = corners[c1], &r = corners[c2];
  const Ring wp = det(q.u, r.u), wq = det(r.u, p.u), wr = det(p.u, q.u);
  return add_position(Ring(Ring(wp * p.v) + Ring(wq * q.v)) + Ring(wr * r.v),
                      Ring(Ring(Ring(wp + wq) + wr) * direction[k]));
}

int Scan::compare(int p, int q) const {
  if (p == q) return 0;
  const Position &a = positions[p], &b = positions[q];
  // Each is within a relative 6 ulp.
  const double gap = a.approx - b.approx;
  const double bound =
      16 * kUnit * (std::abs(a.approx) + std::abs(b.approx)) + kUnderflow;
  if (bound < std::numeric_limits<double>::infinity()) {
    if (gap > bound) return 1;
    if (gap < -bound) return -1;
  }
  return sign_of(Ring(a.num * b.den) - Ring(b.num * a.den));
}

// num / den times scale, brought to lowest terms once.
Rational Scan::quotient_times_scale(const Ring& num, const Ring& den) const {
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

const Rational& Scan::t(int position) const {
  Position& p = positions[position];
  if (!p.t) p.t = quotient_times_scale(p.num, p.den);
  return *p.t;
}

// The sign of t(position) - s, s being 0 or 1.
int Scan::t_against(int position, int s) const {
  const Position& p = positions[position];
  if (s == 0) return sign_of(p.num);  // den and scale are positive
  // approx is within a relative 6 ulp, rounded_scale within 2, the product within 1.
  const double gap = p.approx * rounded_scale - 1;
  const double bound = 16 * kUnit * (std::abs(gap) + 1) + kUnderflow;
  if (gap > bound) return 1;
  if (gap < -bound) return -1;
  return t(position).compare(1);
}

// A cut inside a polygon of the file: no feature, whether or not the polygon is flat.
bool Scan::is_diagonal(int face, int side) const {
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

void Scan::meet(int face) {
  // 1. In doubles: most faces are missed for certain.  Of the others `signs` holds how L
  // passes each side, zero where that is not certain.
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
  // As if L crossed the inside; what is different at the boundary is set below.
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
void Scan::meet_in_plane(int face, std::span<const int> ids) {
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

void Scan::scan(std::span<const int> faces) {
  for (const int f : faces) {
    hear_stop();
    meet(f);
  }
  group();
}

// Sorts the hits and cuts them into connected components.
void Scan::group() {
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

}  // namespace contacts

struct LineScan::Impl : contacts::Scan {
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
};

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
    const contacts::Hit& hit = impl_->hits[h];
    out.push_back({hit.face, hit.kind, hit.index});
  }
  std::sort(out.begin(), out.end(),
            [](const Touch& p, const Touch& q) { return p.face < q.face; });
  return out;
}

std::vector<int> LineScan::edge_on_corners(int contact) const {
  std::vector<int> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    const contacts::Hit& hit = impl_->hits[h];
    if (hit.kind != TouchKind::EdgeOn) continue;
    const int n = impl_->scene->faces()[hit.face].corner_count;
    for (int i = hit.loop; i < hit.loop + n; ++i) {
      const contacts::Corner& c = impl_->corners[impl_->loops[i]];
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
    const contacts::Hit& hit = impl_->hits[h];
    if (impl_->t(hit.from) <= t && t <= impl_->t(hit.to)) out.push_back(hit.face);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<int> LineScan::faces_within(int contact, const std::optional<Rational>& lo,
                                        const std::optional<Rational>& hi) const {
  std::vector<int> out;
  for (int h = impl_->first_hit[contact]; h < impl_->first_hit[contact + 1]; ++h) {
    const contacts::Hit& hit = impl_->hits[h];
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

bool LineScan::blocked(int contact) const { return impl_->blocks(contact); }

bool LineScan::blocked_between(int contact, const Rational& lo,
                               const Rational& hi) const {
  return impl_->judge(contact, &lo, &hi);
}

bool LineScan::blocked_between(int contact, const Rational& lo, const Rational& hi,
                               const std::function<bool(int)>& solid_behind) const {
  return impl_->judge(contact, &lo, &hi, &solid_behind);
}

}  // namespace sightline::internal
