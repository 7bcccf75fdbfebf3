// Segments against a scene: Embree finds candidates in float, bounded double arithmetic
// certifies nearly all of them, and LineScan judges the few that touch.
//
// Embree holds a box per face, as user geometry, moved to the centre of the scene's box
// and scaled by a power of two so that the latter fits in [-1, 1]^3, then widened by
// kInflation.  A segment that enters the box of no face but those it certainly misses
// meets no face.  This serves both answers in one traversal; going through Embree's own
// triangles first, whose hits would only be proposals, was slower even where they were
// confirmed.
//
// Why kInflation suffices.  Ends of a ray are within 2 of the origin in each coordinate,
// so its direction is within 4.  Rounding to float (u = 2^-24) moves a point of the ray
// by at most 2u (origin) + 4u (direction).  A slab test computes (bound - origin) /
// direction, whatever the order of its operations, with a few relative errors u of terms
// of magnitude at most 4 / direction: as if the box had moved by at most 4 * 6u.  In all
// under 32u = 2^-19; we widen by 2^-18.

#include "linespace/occlusion.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include "linespace/contacts/contact.h"
#include "linespace/contacts/seen_along.h"
#include "linespace/numbers/exact_numbers.h"
#include "linespace/sight/occlusion.h"
#include "linespace/space/bvh.h"
#include "linespace/work/stage.h"

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace sightline {
namespace {

using internal::Box;
using internal::Bvh;
using internal::kUnit;
using internal::LineScan;
using internal::Rational;
using internal::contacts::kUnderflow;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kInflation = 0x1p-18f;
// Ends of a line are looked at within this many scene sizes; beyond, Embree is not asked.
constexpr double kFar = 0x1p20;

// Where a line meets a polygon, as far as double arithmetic can tell.
enum class Passage : std::uint8_t { Misses, Crosses, Doubtful };

// A face, or a piece of one with many corners.
constexpr int kMostCorners = 4;
using Four [[gnu::vector_size(32)]] = double;
struct alignas(64) Item {     // two cache lines
  double p[3][kMostCorners];  // an axis a row; a triangle's last corner is its first
  int face;
  int count;
};

// Rays reach the items in no order: large arrays lie in large pages where the system has
// them, so that a look-up costs one cache miss and not two.
template <class T>
struct HugePageAllocator {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{1} << 21;

  HugePageAllocator() = default;
  template <class U>
  explicit HugePageAllocator(const HugePageAllocator<U>&) {}

  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    const std::size_t alignment = bytes >= kPage ? kPage : alignof(T);
    void* memory = ::operator new(bytes, std::align_val_t(alignment));
#ifdef MADV_HUGEPAGE
    if (bytes >= kPage) madvise(memory, bytes, MADV_HUGEPAGE);  // only advice
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) {
    const std::size_t alignment = n * sizeof(T) >= kPage ? kPage : alignof(T);
    ::operator delete(memory, std::align_val_t(alignment));
  }
  friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) {
    return true;
  }
};

// The line through a and b, prepared for passage().  Coordinates in the order i, j, k,
// with k the axis of the largest |b - a|.
struct Line {
  int axis[3];
  double a[3], b[3], d[3];
  double shear[2];          // d_i / d_k, d_j / d_k
  double sense;             // the sign of d_k
  double s_bound, n_bound;  // see passage()

  Line() = default;
  // low, high: the box of all points that will be asked about.
  Line(const Point& p, const Point& q, const std::array<Point, 2>& bounds) {
    const Point e = q - p;
    const double e0 = std::abs(e[0]), e1 = std::abs(e[1]), e2 = std::abs(e[2]);
    static constexpr int kAxes[4][3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}, {0, 1, 2}};
    const int largest =
        static_cast<int>(e1 > e0) + 2 * static_cast<int>(e2 > std::max(e0, e1));
    std::copy_n(kAxes[largest], 3, axis);
    const int k = axis[2];
    const double size = std::abs(e[k]);
    double v = size;
    for (int i = 0; i < 3; ++i) {
      a[i] = p[axis[i]];
      b[i] = q[axis[i]];
      d[i] = e[axis[i]];
      v = std::max(v, std::max(bounds[1][i] - p[i], p[i] - bounds[0][i]));
    }
    shear[0] = d[0] / d[2];
    shear[1] = d[1] / d[2];
    sense = std::copysign(1.0, d[2]);
    s_bound = 90 * kUnit * (v * v) + kUnderflow;
    n_bound = 800 * kUnit * (v * v) * v + kUnderflow;
  }
};

struct Crossing {
  Passage line;                // by the whole line
  int past_a = 0, past_b = 0;  // sign of t, of t - 1; 0 when uncertain; only for Crosses
  // Only for Crosses: t = (n / s) / d_k within these bounds.
  double n = 0, n_error = 0, s = 0, s_error = 0;
};

// How the line passes the polygon.
//
// The formulas and bounds for u and s are those of contact.cpp, first_stage(), with exact
// a and |d| up to D = |d_k|, where d is off by one rounding:
//   v: e V,   u: du = 10 e V D (taken as 12),   s: ds = 4 U du + 2 du^2 + 8 e U^2.
// The crossing is at barycentric weights w (three values s of pairs of corners 0, 1, 2):
//   n = sum of w v_k over three corners: dn <= 3 V ds + 3 * 2 U^2 * e V (v's rounding)
//       + 3 * 2 U^2 V * 3e (products and sums), taken as 3 V ds + 32 e U^2 V;
//   sum of w: 3 ds + 2 * 6 U^2 e (sums).
// n has the sign of t times that of the sum times that of d_k; with v from b instead of
// a, t - 1.
Crossing certify(const Line& line, const Item& item) {
  const auto& points = item.p;
  const int count = item.count;
  const int i = line.axis[0], j = line.axis[1], k = line.axis[2];
  double ux[kMostCorners], uy[kMostCorners], vk[kMostCorners];
  double v = 0, u = 0;
  for (int c = 0; c < count; ++c) {
    const double vi = points[i][c] - line.a[0], vj = points[j][c] - line.a[1];
    vk[c] = points[k][c] - line.a[2];
    ux[c] = vi * line.d[2] - vk[c] * line.d[0];
    uy[c] = vj * line.d[2] - vk[c] * line.d[1];
    v = std::max(std::max(v, std::abs(vi)), std::max(std::abs(vj), std::abs(vk[c])));
    u = std::max(u, std::max(std::abs(ux[c]), std::abs(uy[c])));
  }
  const double du = 12 * kUnit * v * std::abs(line.d[2]) + kUnderflow;
  const double ds = 4 * u * du + 2 * du * du + 8 * kUnit * u * u + kUnderflow;
  double least = kInfinity, most = -kInfinity;
  double s[kMostCorners];
  for (int c = 0; c < count; ++c) {
    const int next = c + 1 == count ? 0 : c + 1;
    s[c] = ux[c] * uy[next] - uy[c] * ux[next];
    least = std::min(least, s[c]);
    most = std::max(most, s[c]);
  }
  if (least < -ds && most > ds) return {Passage::Misses};
  if (!(least > ds || most < -ds)) return {Passage::Doubtful};
  // Weights of corners 0, 1, 2.
  const double w2 = s[0], w0 = s[1];
  const double w1 = count == 3 ? s[2] : ux[2] * uy[0] - uy[2] * ux[0];
  Crossing out{Passage::Crosses};
  out.s = w0 + w1 + w2;
  out.s_error = 3 * ds + 12 * kUnit * u * u;
  if (std::abs(out.s) <= out.s_error) return {Passage::Doubtful};
  out.n = w0 * vk[0] + w1 * vk[1] + w2 * vk[2];
  out.n_error = 3 * v * ds + 32 * kUnit * u * u * v + kUnderflow;
  const double flip = (out.s > 0) == (line.d[2] > 0) ? 1 : -1;
  const double na = flip * out.n;
  out.past_a = na > out.n_error ? 1 : na < -out.n_error ? -1 : 0;
  double largest = 0, nb = 0;
  const double w[3] = {w0, w1, w2};
  for (int c = 0; c < 3; ++c) {
    const double vb = points[k][c] - line.b[2];
    largest = std::max(largest, std::abs(vb));
    nb += w[c] * vb;
  }
  nb *= flip;
  const double nb_error = 3 * largest * ds + 32 * kUnit * u * u * largest + kUnderflow;
  out.past_b = nb > nb_error ? 1 : nb < -nb_error ? -1 : 0;
  return out;
}

// By the open segment ab; Doubtful if perhaps at an end of it.
Passage of_segment(const Crossing& c) {
  if (c.line != Passage::Crosses) return c.line;
  if (c.past_a > 0 && c.past_b < 0) return Passage::Crosses;
  if (c.past_a < 0 || c.past_b > 0) return Passage::Misses;
  return Passage::Doubtful;
}

// The same as of_segment(certify()), with bounds for the whole scene, so that there is
// nothing to find but signs.  Which way a face turns and which axis leads is anybody's
// guess, and a branch on it costs more than the arithmetic: there is none.
//
// Corners are sheared along the line onto the plane through a across axis k: with
// g = d_i / d_k, |g| <= 1, off by 3e, and V at least D = |d_k| and every |v|,
//   u = v_i - v_k g:  |u| <= 2V, du <= e V + (e V + 3e V + e V) + 2e V, taken as 9e V;
//   s:  |s| <= 8 V^2, ds <= 2 (2 * 2V du + 4e V^2) + 8e V^2 = 88e V^2, taken as 90;
//   n:  dn <= 3 (V ds + 8 V^2 * e V + 8e V^3) + 48e V^3 (sums) = 366e V^3;
//   sum of w:  3 ds + 48e V^2 = 318e V^2;
//   n - d_k sum, of the sign of t - 1:  dn + 318e V^3 + 24e V^3 (d_k) + 24e V^3
//     (product) + 48e V^3 (difference) = 780e V^3, taken as 800.
Passage passage(const Line& line, const Item& item) {
  Four x, y, z;
  std::memcpy(&x, item.p[line.axis[0]], sizeof x);
  std::memcpy(&y, item.p[line.axis[1]], sizeof y);
  std::memcpy(&z, item.p[line.axis[2]], sizeof z);
  z -= line.a[2];
  const Four ux = (x - line.a[0]) - z * line.shear[0];
  const Four uy = (y - line.a[1]) - z * line.shear[1];
  const Four s = ux * __builtin_shufflevector(uy, uy, 1, 2, 3, 0) -
                 uy * __builtin_shufflevector(ux, ux, 1, 2, 3, 0);
  // Turned so that the first is positive; the last of a triangle is no side's.
  const double turn = std::copysign(1.0, s[0]);
  const Four t = s * turn;
  const double last = item.count == 3 ? t[2] : t[3];
  const double least = std::min(std::min(t[0], t[1]), std::min(t[2], last));
  if (!(least > line.s_bound)) {
    const double most = std::max(std::max(t[0], t[1]), std::max(t[2], last));
    return least < -line.s_bound && most > line.s_bound ? Passage::Misses
                                                        : Passage::Doubtful;
  }
  // The weights' sum has the sign of every s: it is the face's area but for what w1
  // leaves out.
  const double w1 = ux[2] * uy[0] - uy[2] * ux[0];
  const double n = s[1] * z[0] + w1 * z[1] + s[0] * z[2];
  const double sum = s[1] + w1 + s[0];
  const double sense = turn * line.sense;
  const double past_a = n * sense;
  const double past_b = (n - line.d[2] * sum) * sense;
  if (past_a > line.n_bound && past_b < -line.n_bound) return Passage::Crosses;
  if (past_a < -line.n_bound || past_b > line.n_bound) return Passage::Misses;
  return Passage::Doubtful;
}

inline Passage segment_passage(const Line& line, const Item& item) {
  const Passage first = passage(line, item);
  return first == Passage::Doubtful ? of_segment(certify(line, item)) : first;
}

// What is known of the faces that a line a + t (b - a) meets on one side of a, t > 0 or
// t < 0, by their distance |t|: the nearest that it certainly crosses, and how near
// anything else may be.
struct Nearest {
  const Item* item = nullptr;                  // none: no face is certainly crossed
  const Item* same = nullptr;                  // crossed with it, in its plane
  double least = kInfinity, most = kInfinity;  // bounds of their distance
  int past_b = 0;                              // sign of t - 1
  double other = kInfinity;                    // nothing else is nearer than that

  // No other item meets the line up to where it crosses the nearest; where it crosses
  // none, no other at all.
  [[nodiscard]] bool alone() const {
    return item == nullptr ? other == kInfinity : other > most;
  }
  // The faces crossed there, ascending.
  [[nodiscard]] std::vector<int> faces() const {
    if (item == nullptr) return {};
    if (same == nullptr) return {item->face};
    return {std::min(item->face, same->face), std::max(item->face, same->face)};
  }
  void add(const Line& line, const Item& item_, int beyond);
};

// Both lie in one plane across an axis, as a building's floor and the ground do.
bool share_axis_plane(const Item& p, const Item& q) {
  return std::ranges::any_of(std::array{0, 1, 2}, [&](int axis) {
    const auto in_plane = [&](double x) { return x == p.p[axis][0]; };
    return std::ranges::all_of(p.p[axis], in_plane) &&
           std::ranges::all_of(q.p[axis], in_plane);
  });
}

// Distances are rounded up or down by this share of themselves: quotients of bounds, a
// product or two.
constexpr double kSlack = 16 * kUnit;

// Of all points of the item, as the line's leading coordinate tells.
double least_distance(const Line& line, const Item& item, int beyond) {
  double least = kInfinity;
  for (int c = 0; c < item.count; ++c) {
    least = std::min(least, beyond * (item.p[line.axis[2]][c] - line.a[2]) / line.d[2]);
  }
  return std::max(0.0, least - kSlack * std::abs(least));
}

void Nearest::add(const Line& line, const Item& item_, int beyond) {
  const Crossing c = certify(line, item_);
  if (c.line == Passage::Misses) return;
  if (c.line == Passage::Doubtful || c.past_a == 0) {
    other = std::min(other, least_distance(line, item_, beyond));
    return;
  }
  if (c.past_a != beyond) return;
  // |t| is |n| / |s| / |d_k|.
  const double d = std::abs(line.d[2]);
  const double n = std::abs(c.n), w = std::abs(c.s);
  const double low = (n - c.n_error) / (w + c.s_error) / d * (1 - kSlack);
  const double high = (n + c.n_error) / (w - c.s_error) / d * (1 + kSlack);
  if (item != nullptr && low <= most && least <= high && same == nullptr &&
      item->face != item_.face && share_axis_plane(*item, item_)) {
    same = &item_;
  } else if (high < most) {
    other = std::min(other, least);
    same = nullptr;
    least = low;
    most = high;
    past_b = c.past_b;
    item = &item_;
  } else {
    other = std::min(other, low);
  }
}

// The position t at which the line crosses the item's plane, rounded to the nearest
// double; nullopt where double-double arithmetic does not tell which that is.
//
// With the plane's normal N, t = N (p - a) / N (b - a).
std::optional<double> crossing_position(const Line& line, const Item& item) {
  using internal::BallNumber;
  using internal::exact_difference;
  std::array<BallNumber, 3> u, v, w, d;
  for (int i = 0; i < 3; ++i) {
    const double* p = item.p[line.axis[i]];
    u[i] = exact_difference(p[1], p[0]);
    v[i] = exact_difference(p[2], p[0]);
    w[i] = exact_difference(p[0], line.a[i]);
    d[i] = exact_difference(line.b[i], line.a[i]);
  }
  const BallNumber n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                           u[0] * v[1] - u[1] * v[0]};
  const BallNumber num = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
  const BallNumber den = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
  return internal::nearest_quotient(num, den);
}

// A part of a line in Embree's coordinates: ray parameter 0 is t0, 1 is t1.
struct FloatRay {
  enum { Outside, Inside, TooFar } where;
  RTCRay ray;
  double t0, t1;
};

}  // namespace

struct OcclusionIndex::Impl {
  Impl(const Scene& scene_, internal::Stage& stage);
  ~Impl();

  const Scene& scene;
  std::vector<Item, HugePageAllocator<Item>> items;
  Point center;
  double scale = 1;  // a power of two
  Bvh bvh;           // over faces
  RTCDevice device = nullptr;
  RTCScene boxes = nullptr;

  void add_items();
  void choose_frame();
  void build(internal::Stage& stage);
  void release();

  // What an Embree call of ours carries.  Of a packet of rays, the one with id r has the
  // line lines[r] and so on.  A ray that certainly crosses an item ends up with a
  // negative tfar, as is Embree's way.
  struct Query {
    RTCIntersectContext context;  // first: Embree hands out its address
    const Line* lines;
    const Item* items;
    std::vector<int>* faces;                      // that perhaps meet the line, per ray
    const internal::FaceSegment* ends = nullptr;  // whose end faces do not count, per ray
    bool whole_line = false;  // faces_near(): whatever meets the line is wanted

    // Ray n of `count`, of id r, comes to an item's box.
    void meet(const Item& item, RTCRayN* rays, unsigned count, unsigned n,
              unsigned r) const {
      if (ends && (item.face == ends[r].face_a || item.face == ends[r].face_b)) return;
      const Passage passage =
          whole_line ? certify(lines[r], item).line : segment_passage(lines[r], item);
      if (passage == Passage::Misses) return;
      if (passage == Passage::Crosses && !whole_line) {
        RTCRayN_tfar(rays, count, n) = -std::numeric_limits<float>::infinity();
      } else {
        faces[r].push_back(item.face);
      }
    }

    // nearest(): which way, the ray's range, the answer.
    int beyond = 0;
    double t0 = 0, t1 = 1;
    Nearest* nearest = nullptr;
  };

  [[nodiscard]] FloatRay float_ray(const Point& a, const Point& b, double t0,
                                   double t1) const;
  [[nodiscard]] std::optional<Nearest> nearest(const Line& line, const Point& a,
                                               const Point& b, int beyond) const;
  [[nodiscard]] std::optional<FreeSegment> maximal_by_all_contacts(const Point& a,
                                                                   const Point& b,
                                                                   double lowest,
                                                                   double highest) const;
  [[nodiscard]] std::vector<int> faces_near(const Point& a, const Point& b, double t0,
                                            double t1) const;
  [[nodiscard]] std::optional<bool> is_free_for_certain(const Point& a, const Point& b,
                                                        std::vector<int>& doubtful) const;
  void ask_packet(std::span<const internal::FaceSegment> segments,
                  std::span<internal::Certainty> answers,
                  std::span<std::vector<int>> doubtful) const;
};

OcclusionIndex::Impl::Impl(const Scene& scene_, internal::Stage& stage)
    : scene(scene_), bvh([&] {
        std::vector<Box> boxes_of_faces;
        std::vector<Point> corners;
        for (std::size_t f = 0; f < scene_.faces().size(); ++f) {
          internal::hear_stop();
          corners.clear();
          for (const int p : scene_.face_points(static_cast<int>(f))) {
            corners.push_back(scene_.point(p));
          }
          boxes_of_faces.push_back(internal::box_of(corners));
        }
        return Bvh(boxes_of_faces);
      }()) {
  add_items();
  choose_frame();
  build(stage);
}

OcclusionIndex::Impl::~Impl() { release(); }

void OcclusionIndex::Impl::release() {
  rtcReleaseScene(boxes);
  rtcReleaseDevice(device);
}

void OcclusionIndex::Impl::add_items() {
  items.reserve(scene.faces().size());
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    const auto ids = scene.face_points(f);
    const int n = static_cast<int>(ids.size());
    // Pieces with corners 0 and i, i + 1, i + 2 or, at the end, i, i + 1.
    for (int i = 1; i + 1 < n; i += 2) {
      Item item{{}, f, std::min(kMostCorners, n - i + 1)};
      for (int c = 0; c < kMostCorners; ++c) {
        const Point& p = scene.point(ids[c % item.count == 0 ? 0 : i + c - 1]);
        for (int axis = 0; axis < 3; ++axis) item.p[axis][c] = p[axis];
      }
      items.push_back(item);
    }
  }
}

void OcclusionIndex::Impl::choose_frame() {
  const auto& [low, high] = scene.bounds();
  center = low + (high - low) / 2;
  const double half = std::max((high - center).maxCoeff(), (center - low).maxCoeff());
  int exponent = 0;
  std::frexp(half, &exponent);
  scale = half > 0 ? std::ldexp(1.0, -exponent) : 1;
}

void OcclusionIndex::Impl::build(internal::Stage& stage) {
  device = rtcNewDevice(nullptr);
  boxes = rtcNewScene(device);
  rtcSetSceneFlags(boxes, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(boxes, RTC_BUILD_QUALITY_HIGH);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(items.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        const auto& self = *static_cast<const Impl*>(args->geometryUserPtr);
        const Item& item = self.items[args->primID];
        std::array<float, 3> low, high;
        low.fill(std::numeric_limits<float>::infinity());
        high.fill(-std::numeric_limits<float>::infinity());
        for (int c = 0; c < item.count; ++c) {
          for (int i = 0; i < 3; ++i) {
            const auto x =
                static_cast<float>((item.p[i][c] - self.center[i]) * self.scale);
            low[i] = std::min(low[i], x - kInflation);
            high[i] = std::max(high[i], x + kInflation);
          }
        }
        *args->bounds_o = {low[0], low[1], low[2], 0, high[0], high[1], high[2], 0};
      },
      nullptr);
  rtcSetGeometryOccludedFunction(geometry, [](const RTCOccludedFunctionNArguments* args) {
    const auto& query = *reinterpret_cast<const Query*>(args->context);
    const Item& item = query.items[args->primID];
    if (args->N == 1) {  // the usual case: its places in memory are constants
      query.meet(item, args->ray, 1, 0, 0);
      return;
    }
    for (unsigned n = 0; n < args->N; ++n) {
      if (!args->valid[n]) continue;
      query.meet(item, args->ray, args->N, n, RTCRayN_id(args->ray, args->N, n));
    }
  });
  rtcSetGeometryIntersectFunction(
      geometry, [](const RTCIntersectFunctionNArguments* args) {
        auto& query = *reinterpret_cast<Query*>(args->context);
        query.nearest->add(*query.lines, query.items[args->primID], query.beyond);
        // Along the ray, whose position 0 is a: later is harmless.
        const double ray = (query.nearest->most - query.t0) / (query.t1 - query.t0);
        float& tfar = RTCRayN_tfar(reinterpret_cast<RTCRayN*>(args->rayhit), 1, 0);
        tfar = std::min(tfar, static_cast<float>(ray * (1 + 1e-6) + 1e-6));
      });
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(boxes, geometry);
  rtcReleaseGeometry(geometry);
  // Embree asks from threads of its own, which know no scope.
  rtcSetSceneProgressMonitorFunction(
      boxes,
      [](void* asked, double) {
        return !static_cast<internal::Stage*>(asked)->stopped();
      },
      &stage);
  rtcCommitScene(boxes);
  rtcSetSceneProgressMonitorFunction(boxes, nullptr, nullptr);
  if (stage.stopped()) {
    release();
    stage.check(1);
  }
}

// The part [t0, t1] of the line a + t (b - a), cut to a box a little larger than the
// scene's.
FloatRay OcclusionIndex::Impl::float_ray(const Point& a, const Point& b, double t0,
                                         double t1) const {
  FloatRay out;
  const Point p = (a - center) * scale;
  const Point d = (b - a) * scale;
  Point from = p, along = d;
  if (!(t0 == 0 && t1 == 1 && p.cwiseAbs().maxCoeff() <= 2 &&
        (p + d).cwiseAbs().maxCoeff() <= 2)) {
    out.where = FloatRay::TooFar;
    if (!(p.cwiseAbs().maxCoeff() < kFar) || !(d.cwiseAbs().maxCoeff() < kFar) ||
        !(d.cwiseAbs().maxCoeff() > 1e-100)) {
      return out;
    }
    // Rounding moves points within kFar by far less than the slack of 1/2 here.
    constexpr double kHalf = 1.5;
    for (int i = 0; i < 3; ++i) {
      if (std::abs(d[i]) < 1e-30) {
        // Over t up to kFar / |d| this coordinate hardly changes.
        if (std::abs(p[i]) > kHalf) t1 = -kInfinity;
        continue;
      }
      const double at_low = (-kHalf - p[i]) / d[i], at_high = (kHalf - p[i]) / d[i];
      t0 = std::max(t0, std::min(at_low, at_high));
      t1 = std::min(t1, std::max(at_low, at_high));
    }
    if (!(t0 <= t1)) {
      out.where = FloatRay::Outside;
      return out;
    }
    from = p + t0 * d;
    along = (t1 - t0) * d;
  }
  out.where = FloatRay::Inside;
  out.t0 = t0;
  out.t1 = t1;
  out.ray.org_x = static_cast<float>(from[0]);
  out.ray.org_y = static_cast<float>(from[1]);
  out.ray.org_z = static_cast<float>(from[2]);
  out.ray.dir_x = static_cast<float>(along[0]);
  out.ray.dir_y = static_cast<float>(along[1]);
  out.ray.dir_z = static_cast<float>(along[2]);
  out.ray.tnear = 0;
  out.ray.tfar = 1;
  out.ray.time = 0;
  out.ray.mask = ~0u;
  out.ray.id = 0;
  out.ray.flags = 0;
  return out;
}

// The answer where double arithmetic can certify it; else the faces that the closed
// segment perhaps meets, one entry per item.
std::optional<bool> OcclusionIndex::Impl::is_free_for_certain(
    const Point& a, const Point& b, std::vector<int>& doubtful) const {
  const Line line(a, b, scene.bounds());
  Query query;
  rtcInitIntersectContext(&query.context);
  query.lines = &line;
  query.items = items.data();
  query.faces = &doubtful;
  FloatRay r = float_ray(a, b, 0, 1);
  if (r.where == FloatRay::Outside) return true;
  if (r.where == FloatRay::TooFar) {
    for (const Item& item : items) {
      const Passage passage = segment_passage(line, item);
      if (passage == Passage::Crosses) return false;
      if (passage == Passage::Doubtful) doubtful.push_back(item.face);
    }
  } else {
    rtcOccluded1(boxes, &query.context, &r.ray);
    if (r.ray.tfar < 0) return false;
  }
  if (doubtful.empty()) return true;
  return std::nullopt;
}

// The same for a packet of segments within the scene's box, without their end faces.
void OcclusionIndex::Impl::ask_packet(std::span<const internal::FaceSegment> segments,
                                      std::span<internal::Certainty> answers,
                                      std::span<std::vector<int>> doubtful) const {
  const int count = static_cast<int>(segments.size());
  std::array<Line, internal::kPacket> lines;
  alignas(32) int valid[internal::kPacket] = {};
  RTCRay8 rays;
  for (int r = 0; r < count; ++r) {
    const Point &a = segments[r].a, &b = segments[r].b;
    lines[r] = Line(a, b, scene.bounds());
    doubtful[r].clear();
    const FloatRay one = float_ray(a, b, 0, 1);
    assert(one.where == FloatRay::Inside);
    valid[r] = -1;
    rays.org_x[r] = one.ray.org_x;
    rays.org_y[r] = one.ray.org_y;
    rays.org_z[r] = one.ray.org_z;
    rays.dir_x[r] = one.ray.dir_x;
    rays.dir_y[r] = one.ray.dir_y;
    rays.dir_z[r] = one.ray.dir_z;
    rays.tnear[r] = one.ray.tnear;
    rays.tfar[r] = one.ray.tfar;
    rays.time[r] = one.ray.time;
    rays.mask[r] = one.ray.mask;
    rays.id[r] = static_cast<unsigned>(r);
    rays.flags[r] = one.ray.flags;
  }
  Query query;
  rtcInitIntersectContext(&query.context);
  query.lines = lines.data();
  query.items = items.data();
  query.faces = doubtful.data();
  query.ends = segments.data();
  rtcOccluded8(valid, boxes, &query.context, &rays);
  for (int r = 0; r < count; ++r) {
    answers[r] = rays.tfar[r] < 0      ? internal::Certainty::Blocked
                 : doubtful[r].empty() ? internal::Certainty::Free
                                       : internal::Certainty::Doubtful;
    thread_stage_counts().by_double += answers[r] != internal::Certainty::Doubtful;
  }
}

// Faces that the part [t0, t1] of the line perhaps meets, ascending.
std::vector<int> OcclusionIndex::Impl::faces_near(const Point& a, const Point& b,
                                                  double t0, double t1) const {
  const Line line(a, b, scene.bounds());
  std::vector<int> out;
  Query query;
  rtcInitIntersectContext(&query.context);
  query.lines = &line;
  query.items = items.data();
  query.whole_line = true;
  query.faces = &out;
  FloatRay r = float_ray(a, b, t0, t1);
  if (r.where == FloatRay::TooFar) {
    for (const Item& item : items) {
      if (certify(line, item).line != Passage::Misses) out.push_back(item.face);
    }
  } else if (r.where == FloatRay::Inside) {
    rtcOccluded1(boxes, &query.context, &r.ray);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

// The nearest faces that the line meets from a on, through b (beyond 1) or away from it
// (-1); nullopt where the ray is too far from the scene for floats.
std::optional<Nearest> OcclusionIndex::Impl::nearest(const Line& line, const Point& a,
                                                     const Point& b, int beyond) const {
  FloatRay r = float_ray(a, beyond > 0 ? b : Point(a - (b - a)), 0, kInfinity);
  Nearest found;
  if (r.where == FloatRay::TooFar) return std::nullopt;
  if (r.where == FloatRay::Outside) return found;
  Query query;
  rtcInitIntersectContext(&query.context);
  query.lines = &line;
  query.items = items.data();
  query.beyond = beyond;
  query.t0 = r.t0;
  query.t1 = r.t1;
  query.nearest = &found;
  RTCRayHit hit;
  hit.ray = r.ray;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(boxes, &query.context, &hit);
  return found;
}

OcclusionIndex::OcclusionIndex(const Scene& scene, const Request& request) {
  internal::Stage stage(request, "occlusion index");
  impl_ = std::make_unique<Impl>(scene, stage);
}
OcclusionIndex::~OcclusionIndex() = default;
OcclusionIndex::OcclusionIndex(OcclusionIndex&&) noexcept = default;
const Scene& OcclusionIndex::scene() const { return impl_->scene; }

namespace {

std::vector<int> unique_sorted(std::vector<int> faces) {
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

// Whether a contact that the part [lo, hi] of the line meets at one of its ends only
// blocks there: judged up to half way to where it changes next, outside.
bool blocked_at_end(const LineScan& scan, int c, const Rational& lo, const Rational& hi) {
  const bool at_low = scan.to(c) <= lo;
  Rational from = scan.from(c) - 1;
  Rational to = scan.to(c) + 1;
  for (const Rational& t : scan.instants(c)) {
    if (at_low && t < lo) from = (t + lo) / 2;
    if (!at_low && t > hi && (t + hi) / 2 < to) to = (t + hi) / 2;
  }
  return scan.blocked_between(c, from, to);
}

// A contact of the line as the part [lo, hi] of it sees it.
Contact clipped(const LineScan& scan, int c, const Rational& lo, const Rational& hi) {
  const Rational& from = std::max(scan.from(c), lo);
  const Rational& to = std::min(scan.to(c), hi);
  const bool within = scan.to(c) > lo && scan.from(c) < hi;
  const bool blocked =
      within ? scan.blocked_between(c, lo, hi) : blocked_at_end(scan, c, lo, hi);
  std::vector<Touch> touches = scan.touches(c);
  if (scan.from(c) < lo || hi < scan.to(c)) {
    const std::vector<int> faces = scan.faces_within(c, lo, hi);
    std::erase_if(touches, [&](const Touch& t) {
      return !std::ranges::binary_search(faces, t.face);
    });
  }
  return {from.convert_to<double>(), to.convert_to<double>(), blocked,
          std::move(touches)};
}

}  // namespace

bool OcclusionIndex::is_free(const Point& a, const Point& b) const {
  if (a == b) return true;
  std::vector<int> doubtful;
  if (const auto certain = impl_->is_free_for_certain(a, b, doubtful)) {
    ++thread_stage_counts().by_double;
    return *certain;
  }
  return internal::OcclusionAccess::is_free_of(scene(), std::move(doubtful), a, b);
}

bool internal::OcclusionAccess::is_free_of(const Scene& scene, std::vector<int> faces,
                                           const Point& a, const Point& b) {
  ++thread_stage_counts().by_exact;
  const LineScan scan(scene, unique_sorted(std::move(faces)), a, b);
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.to(c) <= 0 || scan.from(c) >= 1) continue;
    if (scan.blocked_between(c, 0, 1)) return false;
  }
  return true;
}

void internal::OcclusionAccess::ask_packet(const OcclusionIndex& index,
                                           std::span<const FaceSegment> segments,
                                           std::span<Certainty> answers,
                                           std::span<std::vector<int>> doubtful) {
  index.impl_->ask_packet(segments, answers, doubtful);
}

std::vector<Contact> OcclusionIndex::contacts(const Point& a, const Point& b) const {
  std::vector<Contact> out;
  if (a == b) return out;
  const LineScan scan(impl_->scene, impl_->faces_near(a, b, 0, 1), a, b);
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.to(c) < 0 || scan.from(c) > 1) continue;
    out.push_back(clipped(scan, c, 0, 1));
  }
  return out;
}

std::optional<Contact> OcclusionIndex::first_blocker(const Point& a,
                                                     const Point& b) const {
  if (a == b) return std::nullopt;
  const LineScan scan(impl_->scene, impl_->faces_near(a, b, 0, 1), a, b);
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.to(c) <= 0 || scan.from(c) >= 1) continue;
    Contact contact = clipped(scan, c, 0, 1);
    if (contact.blocked) return contact;
  }
  return std::nullopt;
}

namespace {

// One end of a maximal free segment: where, and the contact that blocks there.
struct End {
  std::optional<Rational> t;  // none: infinite
  int contact = -1;
};

// The farthest end beyond 1 such that nothing blocks between 0 and it.
End forward_end(const LineScan& scan) {
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.to(c) < 1) continue;
    if (!scan.blocked_between(c, 0, scan.to(c) + 1)) continue;
    Rational end = std::max(scan.from(c), Rational(1));
    for (const Rational& t : scan.instants(c)) {
      if (t > end && !scan.blocked_between(c, 0, t)) end = t;
    }
    return {end, c};
  }
  return {};
}

End backward_end(const LineScan& scan) {
  for (int c = scan.size() - 1; c >= 0; --c) {
    if (scan.from(c) > 0) continue;
    if (!scan.blocked_between(c, scan.from(c) - 1, 1)) continue;
    Rational end = std::min(scan.to(c), Rational(0));
    for (const Rational& t : scan.instants(c)) {
      if (t < end && !scan.blocked_between(c, t, 1)) end = t;
    }
    return {end, c};
  }
  return {};
}

// A contact along all of the segment can let it grow on either side but not on both.  Of
// the ends possible then, the pair farthest apart is taken, of equals the one that
// reaches farther past b.
void reconcile(const LineScan& scan, int c, End& back, End& forth) {
  const auto limit = [&](const End& end, const Rational& outside) {
    return end.t && scan.from(c) <= *end.t && *end.t <= scan.to(c) ? *end.t : outside;
  };
  const Rational lowest = limit(back, scan.from(c) - 1);
  const Rational highest = limit(forth, scan.to(c) + 1);
  if (!scan.blocked_between(c, lowest, highest)) return;
  std::vector<Rational> lows = {lowest, Rational(0)}, highs = {Rational(1), highest};
  for (const Rational& t : scan.instants(c)) {
    if (lowest < t && t < 0) lows.push_back(t);
    if (1 < t && t < highest) highs.push_back(t);
  }
  Rational best_low = 0, best_high = 1;
  for (const Rational& low : lows) {
    for (const Rational& high : highs) {
      const Rational gain = Rational(high - low) - Rational(best_high - best_low);
      if (gain < 0 || (gain == 0 && high <= best_high)) continue;
      if (scan.blocked_between(c, low, high)) continue;
      best_low = low;
      best_high = high;
    }
  }
  if (best_low != lowest) back = {best_low, c};
  if (best_high != highest) forth = {best_high, c};
}

}  // namespace

std::optional<FreeSegment> OcclusionIndex::maximal_free_segment(const Point& a,
                                                                const Point& b) const {
  assert(a != b);
  const Line line(a, b, impl_->scene.bounds());
  const auto forth = impl_->nearest(line, a, b, 1);
  if (forth && forth->past_b < 0) return std::nullopt;
  const auto back = impl_->nearest(line, a, b, -1);
  // Alone on both sides: nothing else is touched on the way.
  const bool certain = forth && back && forth->alone() && back->alone() &&
                       (forth->item == nullptr || forth->past_b > 0);
  if (certain) {
    FreeSegment out{-kInfinity, kInfinity, {}, {}, {}};
    const auto low = back->item ? crossing_position(line, *back->item) : -kInfinity;
    const auto high = forth->item ? crossing_position(line, *forth->item) : kInfinity;
    if (low && high) {
      out.from = *low;
      out.to = *high;
      out.from_faces = back->faces();
      out.to_faces = forth->faces();
      ++thread_stage_counts().by_double;
      return out;
    }
  }
  if (!is_free(a, b)) return std::nullopt;
  // Beyond a face that is certainly crossed before a, or past b, nothing counts.
  const double lowest = back && back->item ? -back->most : -kInfinity;
  const double highest =
      forth && forth->item && forth->past_b > 0 ? forth->most : kInfinity;
  return impl_->maximal_by_all_contacts(a, b, lowest, highest);
}

std::optional<FreeSegment> internal::OcclusionAccess::maximal_exactly(
    const OcclusionIndex& index, const Point& a, const Point& b) {
  if (!index.is_free(a, b)) return std::nullopt;
  return index.impl_->maximal_by_all_contacts(a, b, -kInfinity, kInfinity);
}

// By exact numbers.  `lowest` and `highest` are positions beyond which nothing counts.
std::optional<FreeSegment> OcclusionIndex::Impl::maximal_by_all_contacts(
    const Point& a, const Point& b, double lowest, double highest) const {
  const LineScan scan(scene, faces_near(a, b, lowest, highest), a, b);
  End back = backward_end(scan), forth = forward_end(scan);
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.from(c) <= 0 && scan.to(c) >= 1) reconcile(scan, c, back, forth);
  }
  FreeSegment out{-kInfinity, kInfinity, {}, {}, {}};
  if (back.t) {
    out.from = back.t->convert_to<double>();
    out.from_faces = scan.faces_at(back.contact, *back.t);
  }
  if (forth.t) {
    out.to = forth.t->convert_to<double>();
    out.to_faces = scan.faces_at(forth.contact, *forth.t);
  }
  for (int c = 0; c < scan.size(); ++c) {
    const Rational low = back.t ? *back.t : Rational(scan.from(c) - 1);
    const Rational high = forth.t ? *forth.t : Rational(scan.to(c) + 1);
    if (scan.to(c) > low && scan.from(c) < high) {
      out.contacts.push_back(clipped(scan, c, low, high));
    }
  }
  return out;
}

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 kernel_point(const Point& p) { return {p.x(), p.y(), p.z()}; }

// Whether a box is certainly apart from the triangle: by its own sides, by the triangle's
// plane, and by the triangle's sides seen along each axis.
class TriangleShaft {
 public:
  explicit TriangleShaft(const std::array<Point, 3>& corners)
      : corners_(corners), box_(internal::box_of(corners)) {
    normal_ = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  }

  [[nodiscard]] bool may_meet(const Box& box) const {
    for (int i = 0; i < 3; ++i) {
      if (box.min[i] > box_.max[i] || box.max[i] < box_.min[i]) return false;
    }
    return !beside_plane(box) && !beside_sides(box);
  }

 private:
  // n.(x - corner) over the box, n within 4 ulp of |e1||e2| per coordinate.
  [[nodiscard]] bool beside_plane(const Box& box) const {
    double least = 0, most = 0, size = 0;
    for (int i = 0; i < 3; ++i) {
      const double low = box.min[i] - corners_[0][i], high = box.max[i] - corners_[0][i];
      const double p = normal_[i] * low, q = normal_[i] * high;
      least += std::min(p, q);
      most += std::max(p, q);
      size += std::max(std::abs(low), std::abs(high));
    }
    const Point e1 = corners_[1] - corners_[0], e2 = corners_[2] - corners_[0];
    const double bound =
        32 * kUnit * size * 2 * e1.cwiseAbs().maxCoeff() * e2.cwiseAbs().maxCoeff() +
        kUnderflow;
    return least > bound || most < -bound;
  }

  [[nodiscard]] bool beside_sides(const Box& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      const double turn = normal_[axis] > 0 ? 1 : -1;
      for (int c = 0; c < 3; ++c) {
        const Point& p = corners_[c];
        const Point& q = corners_[(c + 1) % 3];
        const Point& r = corners_[(c + 2) % 3];
        // Outward normal of side pq: the triangle is where (x - p).m <= 0.
        const double mi = turn * (q[j] - p[j]), mj = -turn * (q[i] - p[i]);
        const double li = (mi > 0 ? box.min[i] : box.max[i]) - p[i];
        const double lj = (mj > 0 ? box.min[j] : box.max[j]) - p[j];
        const double bound =
            8 * kUnit * (std::abs(mi * li) + std::abs(mj * lj)) + kUnderflow;
        if (mi * li + mj * lj <= bound) continue;
        // The third corner must be certainly on the other side, or the turn may be wrong.
        const double ri = r[i] - p[i], rj = r[j] - p[j];
        if (mi * ri + mj * rj <=
            -8 * kUnit * (std::abs(mi * ri) + std::abs(mj * rj)) - kUnderflow) {
          return true;
        }
      }
    }
    return false;
  }

  std::array<Point, 3> corners_;
  Box box_;
  Point normal_;
};

}  // namespace

std::vector<int> OcclusionIndex::faces_meeting_triangle(const Point& a, const Point& b,
                                                        const Point& c) const {
  const Scene& scene = impl_->scene;
  const TriangleShaft shaft({a, b, c});
  const Kernel::Point_3 p = kernel_point(a), q = kernel_point(b), r = kernel_point(c);
  const bool flat = CGAL::collinear(p, q, r);
  // A triangle without area is its longest side, or a point.
  const auto ends = std::minmax({p, q, r});
  const Kernel::Point_3 &low = ends.first, &high = ends.second;
  const auto meets = [&](const Kernel::Triangle_3& t) {
    if (!flat) return CGAL::do_intersect(t, Kernel::Triangle_3(p, q, r));
    if (low == high) return t.has_on(low);
    return CGAL::do_intersect(t, Kernel::Segment_3(low, high));
  };
  std::vector<int> out;
  impl_->bvh.traverse([&](const Box& box) { return shaft.may_meet(box); },
                      [&](std::uint32_t f) {
                        const auto ids = scene.face_points(static_cast<int>(f));
                        for (std::size_t i = 1; i + 1 < ids.size(); ++i) {
                          const Kernel::Triangle_3 t(
                              kernel_point(scene.point(ids[0])),
                              kernel_point(scene.point(ids[i])),
                              kernel_point(scene.point(ids[i + 1])));
                          if (t.is_degenerate() || !meets(t)) continue;
                          out.push_back(static_cast<int>(f));
                          break;
                        }
                      });
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace sightline
