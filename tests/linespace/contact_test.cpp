// The cases of docs/contacts.md, one test each, and the same code against a naive
// rational classification and against perturbed lines.

#include "linespace/contacts/contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/generators.h"

namespace sightline {
namespace {

using internal::exact_point;
using internal::ExactPoint;
using internal::LineScan;
using internal::Rational;
using testing::AlignedBox;

using Polygons = std::vector<std::vector<Point>>;

/// A Contact with its exact ends along the line a + t (b - a).
struct ExactContact {
  Rational from, to;
  bool blocked;
  std::vector<Touch> touches;
};

/// All that a scan of the line through two points finds.
template <class AnyPoint>
std::vector<ExactContact> line_contacts(const Scene& scene, std::span<const int> faces,
                                        const AnyPoint& a, const AnyPoint& b) {
  const LineScan scan(scene, faces, a, b);
  std::vector<ExactContact> out;
  for (int c = 0; c < scan.size(); ++c) {
    out.push_back({scan.from(c), scan.to(c), scan.blocked(c), scan.touches(c)});
  }
  return out;
}

PolygonSoup soup_of(const Polygons& polygons) {
  PolygonSoup soup;
  for (const auto& polygon : polygons) {
    std::vector<int> ids;
    for (const Point& p : polygon) {
      ids.push_back(static_cast<int>(soup.vertices.size()));
      soup.vertices.push_back(p);
    }
    soup.polygons.push_back(ids);
  }
  return soup;
}

Polygons polygons_of(const PolygonSoup& soup) {
  Polygons out;
  for (const auto& ids : soup.polygons) {
    out.emplace_back();
    for (const int v : ids) out.back().push_back(soup.vertices[v]);
  }
  return out;
}

Polygons boxes(const std::vector<AlignedBox>& list) {
  return polygons_of(testing::boxes_soup(list));
}

Polygons operator+(Polygons a, const Polygons& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<int> all_faces(const Scene& scene) {
  std::vector<int> out(scene.faces().size());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

// ---- The naive classification: one face, in rationals, from the definitions. ----

using Vector = ExactPoint;

Vector minus(const Vector& p, const Vector& q) {
  return {Rational(p[0] - q[0]), Rational(p[1] - q[1]), Rational(p[2] - q[2])};
}
Vector cross(const Vector& p, const Vector& q) {
  return {Rational(p[1] * q[2] - p[2] * q[1]), Rational(p[2] * q[0] - p[0] * q[2]),
          Rational(p[0] * q[1] - p[1] * q[0])};
}
Rational dot(const Vector& p, const Vector& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

struct NaiveHit {
  Rational from, to;
  Touch touch;
};

std::optional<NaiveHit> naive_hit(const Scene& scene, int face, const Vector& a,
                                  const Vector& b) {
  std::vector<Vector> p;
  for (const int id : scene.face_points(face)) p.push_back(exact_point(scene.point(id)));
  const std::size_t n = p.size();
  Vector normal{0, 0, 0};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vector part = cross(minus(p[i], p[0]), minus(p[i + 1], p[0]));
    for (int c = 0; c < 3; ++c) normal[c] += part[c];
  }
  const Vector d = minus(b, a);
  const Rational slope = dot(normal, d), height = dot(normal, minus(a, p[0]));
  // Inward height of a point above side i.
  const auto above = [&](std::size_t i, const Vector& x) {
    const Vector inward = cross(normal, minus(p[(i + 1) % n], p[i]));
    return dot(inward, minus(x, p[i]));
  };
  NaiveHit hit;
  hit.touch = {face, TouchKind::Interior, -1};
  if (slope != 0) {
    hit.from = hit.to = -height / slope;
    const Vector x = {Rational(a[0] + hit.from * d[0]), Rational(a[1] + hit.from * d[1]),
                      Rational(a[2] + hit.from * d[2])};
    std::vector<int> on;
    for (std::size_t i = 0; i < n; ++i) {
      const Rational h = above(i, x);
      if (h < 0) return std::nullopt;
      if (h == 0) on.push_back(static_cast<int>(i));
    }
    if (on.size() == 1) hit.touch = {face, TouchKind::Edge, on[0]};
    for (std::size_t i = 0; i < n; ++i) {
      if (p[i] == x) hit.touch = {face, TouchKind::Corner, static_cast<int>(i)};
    }
    return hit;
  }
  if (height != 0) return std::nullopt;
  std::optional<Rational> low, high;
  for (std::size_t i = 0; i < n; ++i) {
    const Rational at_a = above(i, a), rate = Rational(above(i, b) - at_a);
    if (rate == 0) {
      if (at_a < 0) return std::nullopt;
      continue;
    }
    const Rational t = -at_a / rate;
    if (rate > 0 && (!low || t > *low)) low = t;
    if (rate < 0 && (!high || t < *high)) high = t;
  }
  if (*low > *high) return std::nullopt;
  hit.from = *low;
  hit.to = *high;
  hit.touch.kind = TouchKind::EdgeOn;
  if (*low == *high) {
    for (std::size_t i = 0; i < n; ++i) {
      const Vector x = {Rational(a[0] + *low * d[0]), Rational(a[1] + *low * d[1]),
                        Rational(a[2] + *low * d[2])};
      if (p[i] == x) hit.touch = {face, TouchKind::Corner, static_cast<int>(i)};
    }
  }
  return hit;
}

std::vector<ExactContact> naive_contacts(const Scene& scene, const Vector& a,
                                         const Vector& b) {
  std::vector<NaiveHit> hits;
  for (const int f : all_faces(scene)) {
    if (auto hit = naive_hit(scene, f, a, b)) hits.push_back(*hit);
  }
  std::sort(hits.begin(), hits.end(),
            [](const NaiveHit& p, const NaiveHit& q) { return p.from < q.from; });
  std::vector<ExactContact> out;
  for (const NaiveHit& hit : hits) {
    if (out.empty() || hit.from > out.back().to) {
      out.push_back({hit.from, hit.to, false, {}});
    }
    out.back().to = std::max(out.back().to, hit.to);
    out.back().touches.push_back(hit.touch);
  }
  for (ExactContact& c : out) {
    std::sort(c.touches.begin(), c.touches.end(),
              [](const Touch& p, const Touch& q) { return p.face < q.face; });
  }
  return out;
}

// ---- Perturbed lines, in integers: coordinates of scenes are small integers. ----

using Wide = __int128;
using Lattice = std::array<std::int64_t, 3>;
constexpr int kShift = 26;

Lattice lattice(const Point& p) {
  Lattice out;
  for (int i = 0; i < 3; ++i) out[i] = std::llround(std::ldexp(p[i], kShift));
  return out;
}

int orientation(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& d) {
  Wide m[3][3];
  for (int i = 0; i < 3; ++i) {
    m[0][i] = a[i] - d[i];
    m[1][i] = b[i] - d[i];
    m[2][i] = c[i] - d[i];
  }
  const Wide det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                   m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det > 0 ? 1 : det < 0 ? -1 : 0;
}

bool line_meets(const Scene& scene, int face, const Lattice& a, const Lattice& b) {
  const auto ids = scene.face_points(face);
  bool left = false, right = false;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const int s = orientation(a, b, lattice(scene.point(ids[i])),
                              lattice(scene.point(ids[(i + 1) % ids.size()])));
    left |= s > 0;
    right |= s < 0;
  }
  return !(left && right);
}

// Some line within about 2^-7 of the line ab, out of `tries`, misses the touched faces.
// Displacements at a and b are spread over several scales, so that narrow slits are hit.
// A slit of second order is narrower than any of them: it is met by lines that are moved
// aside towards a corner of a touched face, as seen from a position where something
// begins or ends, turn around just there, and are off it by no more than the product of
// the two.
bool some_perturbed_line_passes(const Scene& scene, const ExactContact& contact,
                                const Point& a, const Point& b, testing::Random& random,
                                int tries) {
  std::vector<int> faces;
  for (const Touch& t : contact.touches) faces.push_back(t.face);
  const LineScan scan(scene, faces, a, b);
  std::vector<double> turns;
  for (int c = 0; c < scan.size(); ++c) {
    for (const Rational& t : scan.instants(c)) turns.push_back(static_cast<double>(t));
  }
  const auto some = [&](const auto& list) {
    return list[random.integer(0, static_cast<int>(list.size()) - 1)];
  };
  const auto vector = [&](double size) {
    return Point(random.uniform(-size, size), random.uniform(-size, size),
                 random.uniform(-size, size));
  };
  for (int i = 0; i < tries; ++i) {
    Point at_a, at_b;
    if (i % 2 == 0) {
      at_a = vector(std::ldexp(1.0, -random.integer(8, 14)));
      at_b = vector(std::ldexp(1.0, -random.integer(8, 14)));
    } else {
      const double t = some(turns);
      const double aside = std::ldexp(random.uniform(0.5, 1), -random.integer(9, 13));
      const double tilt = std::ldexp(1.0, -random.integer(8, 12));
      const auto corners = scene.face_points(some(faces));
      const Point towards = scene.point(some(corners)) - (a + t * (b - a));
      const Point turn = vector(tilt), off = vector(8 * aside * tilt);
      at_a = aside * towards - t * turn + off;
      at_b = aside * towards + (1 - t) * turn + off;
    }
    const Lattice p = lattice(a + at_a), q = lattice(b + at_b);
    if (std::none_of(faces.begin(), faces.end(),
                     [&](int face) { return line_meets(scene, face, p, q); })) {
      return true;
    }
  }
  return false;
}

// ---- Expectations. ----

// blocked or grazed, contact by contact along the line from a to b.
std::string verdicts(const std::vector<ExactContact>& contacts) {
  std::string out;
  for (const ExactContact& c : contacts) out += c.blocked ? 'B' : 'g';
  return out;
}

void expect_same(const std::vector<ExactContact>& found,
                 const std::vector<ExactContact>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << "contact " << i);
    EXPECT_EQ(found[i].from, expected[i].from);
    EXPECT_EQ(found[i].to, expected[i].to);
    ASSERT_EQ(found[i].touches.size(), expected[i].touches.size());
    for (std::size_t j = 0; j < found[i].touches.size(); ++j) {
      EXPECT_EQ(found[i].touches[j].face, expected[i].touches[j].face);
      EXPECT_EQ(found[i].touches[j].kind, expected[i].touches[j].kind);
      EXPECT_EQ(found[i].touches[j].index, expected[i].touches[j].index);
    }
  }
}

// The expected verdicts, however the scene is turned, mirrored, scaled, reordered and
// split into points, and whichever kind of numbers the line is given in.
void expect_verdicts(const Polygons& polygons, const Point& a, const Point& b,
                     const std::string& expected, bool perturb = true) {
  std::array<int, 3> axes = {0, 1, 2};
  testing::Random random(1);
  do {
    for (int signs = 0; signs < 8; ++signs) {
      const double scale = std::ldexp(1.0, signs * 9 - 30);
      const auto moved = [&](const Point& p) {
        Point out;
        for (int i = 0; i < 3; ++i) {
          out[i] = p[axes[i]] * scale * ((signs >> i) & 1 ? -1 : 1);
        }
        return out;
      };
      Polygons copy = polygons;
      random.shuffle(copy);
      for (auto& polygon : copy) {
        for (Point& p : polygon) p = moved(p);
        std::rotate(
            polygon.begin(),
            polygon.begin() + random.integer(0, static_cast<int>(polygon.size()) - 1),
            polygon.end());
        if (random.integer(0, 1) == 0) std::reverse(polygon.begin(), polygon.end());
      }
      const Scene scene(soup_of(copy));
      const auto faces = all_faces(scene);
      const Point p = moved(a), q = moved(b);
      const auto contacts = line_contacts(scene, faces, p, q);
      ASSERT_EQ(verdicts(contacts), expected);
      std::string backwards(expected.rbegin(), expected.rend());
      ASSERT_EQ(verdicts(line_contacts(scene, faces, q, p)), backwards);
      // The same line by two other of its points, no doubles.
      ExactPoint r, s;
      for (int i = 0; i < 3; ++i) {
        const Rational d = Rational(q[i]) - Rational(p[i]);
        r[i] = Rational(p[i]) - d / 3;
        s[i] = Rational(p[i]) + d * 5 / 7;
      }
      ASSERT_EQ(verdicts(line_contacts(scene, faces, r, s)), expected);
      expect_same(contacts, naive_contacts(scene, exact_point(p), exact_point(q)));
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  // Perturbed lines, once.
  if (!perturb) return;
  const Scene scene(soup_of(polygons));
  const auto contacts = line_contacts(scene, all_faces(scene), a, b);
  for (const ExactContact& c : contacts) {
    const int tries = c.blocked ? 20000 : 1000000;
    EXPECT_EQ(some_perturbed_line_passes(scene, c, a, b, random, tries), !c.blocked);
  }
}

const Polygons kCube = boxes({{{0, 0, 0}, {4, 4, 4}}});

// ---- The cases. ----

TEST(ContactCases, FaceCrossed) { expect_verdicts(kCube, {2, 2, -1}, {1, 2, 5}, "BB"); }

TEST(ContactCases, EdgeGrazed) { expect_verdicts(kCube, {-1, 2, 3}, {1, 2, 5}, "g"); }

TEST(ContactCases, EdgeEntered) { expect_verdicts(kCube, {-1, 2, 5}, {1, 2, 3}, "BB"); }

TEST(ContactCases, CornerGrazed) {
  expect_verdicts(kCube, {5, 3, 4.5}, {3, 5, 3.5}, "g");
}

TEST(ContactCases, CornerEntered) { expect_verdicts(kCube, {5, 5, 5}, {3, 3, 3}, "BB"); }

TEST(ContactCases, ValleyMet) {
  // A step: the line meets the valley between tread and riser, coming from the open side.
  const Polygons step = {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}},
                         {{0, 0, 0}, {0, 4, 0}, {0, 4, 4}, {0, 0, 4}}};
  expect_verdicts(step, {1, 2, 1}, {-1, 2, -1}, "B");
  expect_verdicts(step, {1, 2, -1}, {-1, 2, 1}, "g");
}

TEST(ContactCases, SheetBoundary) {
  const Polygons sheet = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  expect_verdicts(sheet, {1, 0, 1}, {1, 0, -1}, "g");  // its side
  expect_verdicts(sheet, {0, 0, 1}, {0, 0, -1}, "g");  // its corner
  expect_verdicts(sheet, {1, 1, 1}, {1, 1, -1}, "B");  // its inside
}

TEST(ContactCases, SheetsSharingASide) {
  const Polygons flat = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                         {{0, 0, 0}, {4, 0, 0}, {0, -4, 1}}};
  expect_verdicts(flat, {1, 0, 1}, {1, 0, -1}, "B");
  const Polygons fold = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                         {{0, 0, 0}, {4, 0, 0}, {0, 4, 1}}};
  expect_verdicts(fold, {1, 0, 1}, {1, 0, -1}, "g");
}

TEST(ContactCases, FanAroundACorner) {
  // Three sheets close the view around a corner; without one of them a gap is left.
  const Point top(0, 0, 1), p(4, 0, 0), q(-3, 4, 0), r(-3, -4, 0);
  const Polygons hat = {{top, p, q}, {top, q, r}, {top, r, p}};
  expect_verdicts(hat, {0, 0, 3}, {0, 0, 2}, "B");
  expect_verdicts({hat[0], hat[1]}, {0, 0, 3}, {0, 0, 2}, "g");
}

TEST(ContactCases, RoofEdgeOn) {
  expect_verdicts(kCube, {-1, 1, 4}, {5, 2, 4}, "g");
  const Scene scene(soup_of(kCube));
  const auto contacts =
      line_contacts(scene, all_faces(scene), Point(-1, 1, 4), Point(5, 1, 4));
  EXPECT_EQ(contacts[0].from, Rational(1) / 6);
  EXPECT_EQ(contacts[0].to, Rational(5) / 6);
}

TEST(ContactCases, AlongAnEdge) { expect_verdicts(kCube, {-1, 4, 4}, {5, 4, 4}, "g"); }

TEST(ContactCases, AlongAValley) {
  const Polygons step = boxes({{{0, 0, 0}, {4, 4, 4}}, {{0, 4, 0}, {4, 8, 8}}});
  expect_verdicts(step, {-1, 4, 4}, {5, 4, 4}, "g");
}

TEST(ContactCases, AlongASheetsSide) {
  const Polygons sheet = {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}};
  expect_verdicts(sheet, {-1, 0, 0}, {5, 0, 0}, "g");
}

TEST(ContactCases, SheetEdgeOn) {
  const Polygons sheet = {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}};
  expect_verdicts(sheet, {-1, 1, 0}, {5, 2, 0}, "g");
  // Only a corner of it is met: it takes no part in the verdict.
  expect_verdicts(sheet, {-1, 1, 0}, {1, -1, 0}, "g");
}

TEST(ContactCases, SeamOfTwoBoxes) {
  const Polygons pair = boxes({{{0, 0, 0}, {4, 4, 4}}, {{0, 4, 0}, {4, 8, 4}}});
  expect_verdicts(pair, {-1, 4, 2}, {5, 4, 2}, "B");    // in the common face
  expect_verdicts(pair, {-1, 4, 4}, {5, 4, 4}, "g");    // along its upper side
  expect_verdicts(pair, {-1, 2, 2}, {1, 4, 2}, "BBB");  // across it
  expect_verdicts(pair, {2, 4, 5}, {2, 4, 3}, "B");     // down into it
}

TEST(ContactCases, FlushRoofs) {
  const Polygons pair = boxes({{{0, 0, 0}, {4, 4, 4}}, {{4, 0, 0}, {8, 4, 4}}});
  expect_verdicts(pair, {-1, 1, 4}, {9, 2, 4}, "g");
}

TEST(ContactCases, RowOfRoofs) {
  const Polygons row = boxes({{{0, 0, 0}, {1, 4, 4}},
                              {{2, 0, 0}, {3, 4, 4}},
                              {{4, 0, 0}, {5, 4, 4}},
                              {{6, 0, 0}, {7, 4, 4}}});
  expect_verdicts(row, {-1, 1, 4}, {8, 2, 4}, "gggg");
}

TEST(ContactCases, BoxesTouchingAlongAnEdge) {
  const Polygons pair = boxes({{{0, 0, 0}, {4, 4, 4}}, {{0, 4, 4}, {4, 8, 8}}});
  expect_verdicts(pair, {-1, 4, 4}, {5, 4, 4}, "g");  // along the edge
  expect_verdicts(pair, {2, 5, 3}, {2, 3, 5}, "B");   // between them, through the edge
  expect_verdicts(pair, {1, 5, 3}, {3, 3, 5}, "B");
  expect_verdicts(pair, {2, 2, 4}, {2, 6, 4}, "B");  // over one, under the other
  expect_verdicts(pair, {0, 5, 3}, {0, 3, 5}, "g");  // past the end of the edge
}

TEST(ContactCases, FourBoxesAroundAnEdge) {
  const std::vector<AlignedBox> four = {{{0, 0, 0}, {4, 4, 4}},
                                        {{0, 4, 4}, {4, 8, 8}},
                                        {{0, 4, 0}, {4, 8, 4}},
                                        {{0, 0, 4}, {4, 4, 8}}};
  expect_verdicts(boxes(four), {-1, 4, 4}, {5, 4, 4}, "B");
  // The fourth a step aside: the way in is open, but not the way on.
  std::vector<AlignedBox> shifted = four;
  shifted[3] = {{5, 0, 4}, {9, 4, 8}};
  expect_verdicts(boxes(shifted), {-1, 4, 4}, {10, 4, 4}, "gg");
}

TEST(ContactCases, BoxesTouchingAtACorner) {
  const Polygons pair = boxes({{{0, 0, 0}, {4, 4, 4}}, {{4, 4, 4}, {8, 8, 8}}});
  expect_verdicts(pair, {3, 5, 4}, {5, 3, 4}, "g");
  expect_verdicts(pair, {0, 0, 0}, {1, 1, 1}, "BBB");
}

TEST(ContactCases, TeeOfSheets) {
  // A wall stands on the inside of a floor.
  const Polygons tee = {{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}},
                        {{4, 1, 0}, {4, 7, 0}, {4, 7, 4}, {4, 1, 4}}};
  expect_verdicts(tee, {3, 4, 1}, {5, 4, -1}, "B");
  expect_verdicts(tee, {3, 4, 0}, {5, 4, 0}, "g");  // in the floor: under it is free
  expect_verdicts(tee, {4, 0, 0}, {4, 8, 0}, "g");  // along the foot
}

TEST(ContactCases, TeeJunctionOfMeshes) {
  // One large face beside two small ones that share a corner in the middle of its side.
  const Polygons tee = {{{0, 0, 0}, {8, 0, 0}, {8, 4, 0}, {0, 4, 0}},
                        {{0, 4, 0}, {4, 4, 0}, {4, 8, 0}, {0, 8, 0}},
                        {{4, 4, 0}, {8, 4, 0}, {8, 8, 0}, {4, 8, 0}}};
  expect_verdicts(tee, {4, 4, 1}, {4, 4, -1}, "B");
  expect_verdicts(tee, {3, 4, 1}, {3, 4, -1}, "B");
  expect_verdicts({tee[0], tee[1]}, {4, 4, 1}, {4, 4, -1}, "g");
}

// Sheets across the x axis at the origin's height, for the cases below: at x, the angle
// at the axis from direction p counter-clockwise to q (coordinates y, z), q - p < pi.
std::vector<Point> angle(double x, std::array<double, 2> p, std::array<double, 2> q) {
  return {{x, 0, 0}, {x, p[0], p[1]}, {x, q[0], q[1]}};
}
Polygons half_plane(double x, std::array<double, 2> p) {
  const std::array<double, 2> q = {-p[1], p[0]}, r = {-p[0], -p[1]};
  return {angle(x, p, q), angle(x, q, r)};
}
// Part of a plane through the axis: from x0 to x1, along the ray p.
std::vector<Point> fin(double x0, double x1, std::array<double, 2> p) {
  return {{x0, 0, 0}, {x1, 0, 0}, {x1, p[0], p[1]}, {x0, p[0], p[1]}};
}

const Point kAxisFrom(-8, 0, 0), kAxisTo(16, 0, 0);

TEST(ContactCases, SlitForTiltedLines) {
  // Below the axis at 0, above it at 4: only a line that comes down passes.  The wall in
  // between joins both into one contact.
  const Polygons wall = {fin(0, 4, {0, 2}), fin(0, 4, {0, -2})};
  const Polygons slit = wall + half_plane(0, {-4, 0}) + half_plane(4, {4, 0});
  expect_verdicts(slit, kAxisFrom, kAxisTo, "g");
  // A floor on one side leaves the other; on both sides it closes the slit.
  expect_verdicts(slit + Polygons{fin(0, 4, {3, 0})}, kAxisFrom, kAxisTo, "g");
  expect_verdicts(slit + Polygons{fin(0, 4, {3, 0}), fin(0, 4, {-3, 0})}, kAxisFrom,
                  kAxisTo, "B");
  // A floor along a part of the way leaves the rest.
  expect_verdicts(slit + Polygons{fin(0, 3, {3, 0}), fin(1, 3, {-3, 0})}, kAxisFrom,
                  kAxisTo, "g");
}

TEST(ContactCases, WallBetweenGrazedCorners) {
  // Two boxes, a sheet spanned between their edges: one contact from box to box.
  const Polygons scene = boxes({{{0, 0, 0}, {1, 4, 4}}, {{5, 0, 0}, {6, 4, 4}}}) +
                         Polygons{{{1, 4, 0}, {5, 4, 0}, {5, 4, 4}, {1, 4, 4}}};
  expect_verdicts(scene, {-1, 4, 2}, {7, 4, 2}, "g");
  // On opposite sides of the sheet's plane: still one contact, and it blocks.
  const Polygons opposite = boxes({{{0, 0, 0}, {1, 4, 4}}, {{5, 4, 0}, {6, 8, 4}}}) +
                            Polygons{{{1, 4, 0}, {5, 4, 0}, {5, 4, 4}, {1, 4, 4}}};
  expect_verdicts(opposite, {-1, 4, 2}, {7, 4, 2}, "B");
  // Without the sheet they are two contacts, both grazed.
  expect_verdicts(boxes({{{0, 0, 0}, {1, 4, 4}}, {{5, 4, 0}, {6, 8, 4}}}), {-1, 4, 2},
                  {7, 4, 2}, "gg");
}

// All of the plane but the open angle from p counter-clockwise to q (less than pi).
Polygons all_but(double x, std::array<double, 2> p, std::array<double, 2> q) {
  // Around from q to p in three steps through the opposites.
  const std::array<double, 2> np = {-p[0], -p[1]}, nq = {-q[0], -q[1]};
  return {angle(x, q, np), angle(x, np, nq), angle(x, nq, p)};
}

TEST(ContactCases, OppositeAngles) {
  // Free between the rays (1,0) and (0,1) at 0, between their opposites at 4.  From one
  // to the other a line passes the axis on either side.
  const Polygons ends = all_but(0, {4, 0}, {0, 4}) + all_but(4, {-4, 0}, {0, -4});
  const Polygons first = {fin(0, 4, {-2, 0})}, second = {fin(0, 4, {2, 0})};
  expect_verdicts(ends + first, kAxisFrom, kAxisTo, "g");
  expect_verdicts(ends + second, kAxisFrom, kAxisTo, "g");
  expect_verdicts(ends + first + second, kAxisFrom, kAxisTo, "B");
  // Both on one side of the motion: the other side is open.
  expect_verdicts(ends + first + Polygons{fin(0, 4, {0, 2})}, kAxisFrom, kAxisTo, "g");
  // Never up together, but each meets one of the ways at some time.
  expect_verdicts(
      ends + Polygons{fin(0, 2, {2, 0}), fin(0, 4, {-2, 0}), fin(2, 4, {2, 0})},
      kAxisFrom, kAxisTo, "B");
  // Clockwise the rays (1,0) and (0,-1) are crossed in this order.
  expect_verdicts(
      ends + Polygons{fin(0, 4, {-1, 1}), fin(0, 2, {2, 0}), fin(2, 4, {0, -2})},
      kAxisFrom, kAxisTo, "B");
  expect_verdicts(
      ends + Polygons{fin(0, 4, {-1, 1}), fin(0, 2, {0, -2}), fin(2, 4, {2, 0})},
      kAxisFrom, kAxisTo, "g");
}

TEST(ContactCases, ThreeAnglesInTurn) {
  // A straight motion from angle to angle to angle: the middle one must lie between.
  const auto scene = [](std::array<double, 2> p, std::array<double, 2> q) {
    return all_but(0, {4, 1}, {4, 2}) + all_but(2, p, q) + all_but(4, {-4, 1}, {-4, -1}) +
           Polygons{fin(0, 4, {0, -1})};
  };
  expect_verdicts(scene({1, 4}, {-1, 4}), kAxisFrom, kAxisTo, "g");
  expect_verdicts(scene({1, -4}, {2, -4}), kAxisFrom, kAxisTo, "B");
}

TEST(ContactCases, FourAnglesInTurn) {
  // Angles alone would allow it, the speed of a straight motion decides: its angle's
  // tangent is a quotient of linear functions of time.  Narrow gaps at the directions of
  // w = (4 - x, 2) pass; the same gaps in equal steps of angle do not.
  const auto gap = [](double x, double y, double z) {
    // From a little before to a little after direction (y, z).
    const double s = 1.0 / 64;
    return all_but(x, {y + s * z, z - s * y}, {y - s * z, z + s * y});
  };
  const Polygons joint = {fin(0, 8, {0, -1})};
  expect_verdicts(gap(0, 4, 2) + gap(2, 2, 2) + gap(4, 0, 2) + gap(8, -4, 2) + joint,
                  kAxisFrom, kAxisTo, "g", false);
  expect_verdicts(gap(0, 4, 2) + gap(2, 2, 2) + gap(4, 0, 2) + gap(8, -2, 2) + joint,
                  kAxisFrom, kAxisTo, "B", false);
}

TEST(ContactCases, FoldedQuad) {
  // Turned by doubles, the quad is not flat; its diagonal must not show.
  const Polygons quad = {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0x1p-40}, {0, 4, 0}}};
  const Scene scene(soup_of(quad));
  ASSERT_EQ(scene.faces().size(), 2u);  // triangles; the diagonal's ends may be 0 and 2
  const auto at = [&](const Point& a, const Point& b) {
    return line_contacts(scene, all_faces(scene), a, b);
  };
  // Whichever diagonal was taken, one of these crosses it.
  const auto middle = at({2, 2, 1}, {2, 2, -1});
  ASSERT_EQ(verdicts(middle), "B");
  ASSERT_EQ(middle[0].touches.size(), 2u);
  for (const Touch& t : middle[0].touches) {
    EXPECT_EQ(t.kind, TouchKind::Interior);
    EXPECT_EQ(t.index, -1);
  }
  EXPECT_EQ(verdicts(at({0, 0, 1}, {0, 0, -1})), "g");
  EXPECT_EQ(verdicts(at({4, 4, 1}, {4, 4, -1})), "g");
  EXPECT_EQ(verdicts(at({0, 4, 1}, {0, 4, -1})), "g");
  const auto side = at({0, 1, 1}, {0, 1, -1});
  ASSERT_EQ(verdicts(side), "g");
  EXPECT_EQ(side[0].touches[0].kind, TouchKind::Edge);
  EXPECT_EQ(verdicts(at({-1, 0, 0}, {5, 0, 0})), "g");  // along a side
  // Over the fold, which bulges or sags: an edge between flat faces would be grazed.
  for (const Point& d : {Point(1, -1, 0), Point(1, 1, 0)}) {
    const Point m(2, 2, d.y() > 0 ? 0.0 : 0x1p-41);
    const auto contacts = at(m - 4 * d, m + 4 * d);
    for (const ExactContact& c : contacts) {
      for (const Touch& t : c.touches) EXPECT_NE(t.kind, TouchKind::Edge);
    }
  }
}

// ---- Second order: what is passed just at an instant. ----

// Two ridges that cross and touch in one point: between them lines pass that are moved
// aside, on the one side, and come down, or on the other and go up.
TEST(ContactCases, CrossedRidges) {
  const Polygons below = {{{-4, -4, 0}, {4, 4, 0}, {4, -4, -4}},
                          {{-4, -4, 0}, {4, 4, 0}, {-4, 4, -4}}};
  const Polygons above = {{{-4, 4, 0}, {4, -4, 0}, {4, 4, 4}},
                          {{-4, 4, 0}, {4, -4, 0}, {-4, -4, 4}}};
  expect_verdicts(below + above, {-4, 0, 0}, {4, 0, 0}, "g");
  // Along one of them nothing is left: the other is crossed from below to above.
  expect_verdicts(below + above, {-4, -4, 0}, {4, 4, 0}, "g");
  // The same ridge twice closes.
  const Polygons same = {{{-4, -4, 0}, {4, 4, 0}, {4, -4, 4}},
                         {{-4, -4, 0}, {4, 4, 0}, {-4, 4, 4}}};
  expect_verdicts(below + same, {-4, 0, 0}, {4, 0, 0}, "B");
}

// Sides of sheets across the x axis, seen from it in the directions +-y: at x = 0 one
// from below and one from above.  What matters is which of them recedes faster.
TEST(ContactCases, SidesThatRecede) {
  const auto sheet = [](double x1, double x2, double z) {
    return std::vector<Point>{{-x1, -4, 0}, {x2, 4, 0}, {x2, 4, z}, {-x1, -4, z}};
  };
  // Towards +y at x = 1 and 2: as crossed ridges.
  expect_verdicts({sheet(1, 1, -4), sheet(2, 2, 4)}, kAxisFrom, kAxisTo, "g");
  // The same side of both, or one that goes on as the other.
  expect_verdicts({sheet(1, 1, -4), sheet(1, 1, 4)}, kAxisFrom, kAxisTo, "B");
  // A sheet edge-on at +y, in the way only there.
  const std::vector<Point> right = {{-3, 0, 0}, {3, 0, 0}, {6, 4, 0}, {-6, 4, 0}};
  std::vector<Point> left = right;
  for (Point& p : left) p.y() = -p.y();
  const Polygons crossed = {sheet(1, 1, -4), sheet(2, 2, 4)};
  expect_verdicts(crossed + Polygons{right}, kAxisFrom, kAxisTo, "g");
  expect_verdicts(crossed + Polygons{left}, kAxisFrom, kAxisTo, "g");
  expect_verdicts(crossed + Polygons{left, right}, kAxisFrom, kAxisTo, "B");
  // Met in a corner only, they close if they fill what is between the two sides.
  const auto wedge = [](double low, double high, double y) {
    return std::vector<Point>{{0, 0, 0}, {low, y, 0}, {high, y, 0}};
  };
  expect_verdicts(crossed + Polygons{wedge(1, 2, 4), wedge(-2, -1, -4)}, kAxisFrom,
                  kAxisTo, "B");
  expect_verdicts(crossed + Polygons{wedge(1, 1.5, 4), wedge(-2, -1, -4)}, kAxisFrom,
                  kAxisTo, "g");
  expect_verdicts(crossed + Polygons{wedge(1, 1.5, 4), wedge(1.5, 3, 4), left}, kAxisFrom,
                  kAxisTo, "B");
}

// Two boxes that touch at a corner, or along a side that a line crosses aslant: the roof
// of one, then the bottom of the other, in one plane.  Moved aside, a line leaves the
// roof before it gets under the bottom.
TEST(ContactCases, FlushInOpposition) {
  const Polygons corner = boxes({{{0, 0, 0}, {2, 2, 2}}, {{2, 2, 2}, {4, 4, 4}}});
  expect_verdicts(corner, {2, 1, 1}, {2, 3, 3}, "g");
  expect_verdicts(corner, {1, 1, 2}, {3, 3, 2}, "g");
  expect_verdicts(corner, {1, 0, 2}, {3, 4, 2}, "g");
  // Along a common edge nothing is left, however aslant the line.
  const Polygons edge = boxes({{{0, 0, 0}, {4, 4, 4}}, {{0, 4, 4}, {4, 8, 8}}});
  expect_verdicts(edge, {1, 2, 4}, {3, 6, 4}, "B");
  // Half of an edge: past the corner of the edge that is longer, on the one side.
  const Polygons part = boxes({{{0, 0, 0}, {4, 4, 4}}, {{2, 4, 4}, {6, 8, 8}}});
  expect_verdicts(part, {3, 2, 4}, {3, 6, 4}, "B");
  expect_verdicts(part, {1, 2, 4}, {3, 6, 4}, "g");
  expect_verdicts(part, {3, 2, 4}, {1, 6, 4}, "g");
}

// Slits of second order at two instants: the motion crosses one ray at each.
TEST(ContactCases, TwoSlitsOfSecondOrder) {
  // At 0 it must cross +-y between two sides, at 4 the same for +-z.
  const auto slit = [](double x, bool turned, double first, double second) {
    const auto sheet = [&](double shift, double z) {
      std::vector<Point> out = {
          {x - shift, -4, 0}, {x + shift, 4, 0}, {x + shift, 4, z}, {x - shift, -4, z}};
      if (turned) {
        for (Point& p : out) p = Point(p.x(), p.z(), p.y());
      }
      return out;
    };
    return Polygons{sheet(first, -4), sheet(second, 4)};
  };
  const Polygons joint = {fin(0, 4, {1, -1})};
  // Both can be passed counter-clockwise, by the line from +y at 0 to +z at 4, say.
  const Polygons both = slit(0, false, 1, -1) + slit(4, true, -1, 1) + joint;
  const Scene scene(soup_of(both));
  const Lattice p = lattice({0, 0x1p-10, 0}), q = lattice({4, 0, 0x1p-10});
  for (const int f : all_faces(scene)) EXPECT_FALSE(line_meets(scene, f, p, q));
  expect_verdicts(both, kAxisFrom, kAxisTo, "g", false);
  // With a fin in the way, from -y to -z; with two, not at all.
  expect_verdicts(both + Polygons{fin(0, 4, {1, 1})}, kAxisFrom, kAxisTo, "g", false);
  expect_verdicts(both + Polygons{fin(0, 4, {1, 1}), fin(0, 4, {-1, -1})}, kAxisFrom,
                  kAxisTo, "B");
  // On the same or the opposite ray at both: no straight motion is.
  expect_verdicts(slit(0, false, 1, -1) + slit(4, false, 1, -1) + joint, kAxisFrom,
                  kAxisTo, "B");
  // One counter-clockwise, the other clockwise; and one closed.
  expect_verdicts(slit(0, false, 1, -1) + slit(4, true, 1, -1) + joint, kAxisFrom,
                  kAxisTo, "B");
  expect_verdicts(slit(0, false, 1, 1) + slit(4, true, -1, 1) + joint, kAxisFrom, kAxisTo,
                  "B");
}

// Sides at x = 0, 1, 2, 3 along four lines of the surface z = x y, on alternating sides
// of it.  To first order only its other lines are left, which meet all four sides; the
// slopes together decide whether lines near them pass: with the k of each side on its own
// side of the slope there, k0 - 3 k1 + 3 k2 - k3 = 0.
TEST(ContactCases, FourSidesOfARegulus) {
  const auto scene = [](std::array<int, 4> slopes) {
    Polygons out = {fin(0, 3, {-1, 1})};
    for (int x = 0; x < 4; ++x) {
      const int s = x % 2 == 0 ? 2 : -2;
      const Point p(x - slopes[x], -1, -x), q(x + slopes[x], 1, x), aside(0, s * x, -s);
      out.push_back({p, q, q + aside, p + aside});
    }
    return out;
  };
  expect_verdicts(scene({0, 0, 0, 0}), kAxisFrom, kAxisTo, "B");
  expect_verdicts(scene({-1, 0, 0, 0}), kAxisFrom, kAxisTo, "B");
  expect_verdicts(scene({3, 1, 0, 0}), kAxisFrom, kAxisTo, "B");
  expect_verdicts(scene({4, 1, 0, 0}), kAxisFrom, kAxisTo, "g", false);
  expect_verdicts(scene({0, 1, 2, 1}), kAxisFrom, kAxisTo, "g", false);
  expect_verdicts(scene({0, 2, 1, -3}), kAxisFrom, kAxisTo, "B");
  const Polygons open = scene({1, 0, 0, 0});
  expect_verdicts(open, kAxisFrom, kAxisTo, "g", false);
  // k = 0.7, 0.1, -0.1, 0.1
  const double e = 0x1p-8;
  const Point w0(0, e, -0.7 * e * e), w1(0, 0.2 * e * e, e + 0.8 * e * e);
  const Lattice p = lattice(w0), q = lattice(Point(4, 0, 0) + w0 + 4 * w1);
  const Scene open_scene(soup_of(open));
  for (const int f : all_faces(open_scene)) EXPECT_FALSE(line_meets(open_scene, f, p, q));
}

// A notch in the ground whose tip is on the line lets lines through that are moved aside.
TEST(ContactCases, NotchedGround) {
  const Polygons ends = half_plane(0, {-4, 0}) + half_plane(8, {4, 0});
  const Polygons left = {fin(0, 8, {-3, 0})};
  const Polygons notched = {{{0, 0, 0}, {4, 0, 0}, {3, 4, 0}, {0, 4, 0}},
                            {{4, 0, 0}, {8, 0, 0}, {8, 4, 0}, {5, 4, 0}}};
  expect_verdicts(ends + left + notched, kAxisFrom, kAxisTo, "g");
  const auto wedge = [](double low, double high) {
    return std::vector<Point>{{4, 0, 0}, {low, 4, 0}, {high, 4, 0}};
  };
  expect_verdicts(ends + left + notched + Polygons{wedge(3, 4), wedge(4.5, 5)}, kAxisFrom,
                  kAxisTo, "g");
  expect_verdicts(ends + left + notched + Polygons{wedge(3, 4), wedge(4, 5)}, kAxisFrom,
                  kAxisTo, "B");
  expect_verdicts(ends + left + Polygons{fin(0, 4, {3, 0}), fin(4, 8, {3, 0})}, kAxisFrom,
                  kAxisTo, "B");
}

// A ground of many small faces is one barrier, whatever they are cut into.
TEST(ContactCases, TriangulatedGround) {
  Polygons ground;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Point p(i, j, 0), q(i + 1, j, 0), r(i + 1, j + 1, 0), s(i, j + 1, 0);
      ground.push_back({p, q, r});
      ground.push_back({p, r, s});
    }
  }
  const Polygons houses = boxes({{{3, 0, 0}, {4, 2, 4}}, {{7, 1, -4}, {8, 3, 0}}});
  expect_verdicts(ground, {-1, 1, 0}, {13, 2, 0}, "g");
  expect_verdicts(ground, {-1, 1, 0}, {13, 1, 0}, "g");
  expect_verdicts(ground + houses, {-1, 2, 0}, {13, 2, 0}, "g", false);
  expect_verdicts(ground + houses, {-1, 1, 0}, {13, 1, 0}, "g", false);
  expect_verdicts(ground + houses, {-1, 1, 0}, {13, 2, 0}, "B", false);
}

// ---- Parts of a line. ----

TEST(LineScan, JudgesOpenPartsOnTheirOwn) {
  // A floor between two walls, all of one contact of the line along the floor.
  const Polygons room = {{{0, 0, 0}, {8, 0, 0}, {8, 4, 0}, {0, 4, 0}},
                         {{0, 0, -1}, {0, 4, -1}, {0, 4, 4}, {0, 0, 4}},
                         {{8, 0, -1}, {8, 4, -1}, {8, 4, 4}, {8, 0, 4}}};
  const Scene scene(soup_of(room));
  const LineScan scan(scene, all_faces(scene), Point(0, 2, 0), Point(8, 2, 0));
  ASSERT_EQ(scan.size(), 1);
  EXPECT_TRUE(scan.blocked(0));
  EXPECT_FALSE(scan.blocked_between(0, 0, 1));
  EXPECT_TRUE(scan.blocked_between(0, -1, 1));
  EXPECT_TRUE(scan.blocked_between(0, Rational(1) / 2, 2));
  EXPECT_EQ(scan.instants(0), (std::vector<Rational>{0, 1}));
  EXPECT_EQ(scan.faces_at(0, 1), (std::vector<int>{0, 2}));
  EXPECT_EQ(scan.faces_at(0, Rational(1) / 2), (std::vector<int>{0}));
}

TEST(LineScan, KeepsOrderWhereNumbersLeaveTheRangeOfDoubles) {
  // Lines through points with long denominators, across a wall, an edge and a wall.  As k
  // grows the numbers of the walls' positions overflow before those of the edge's do.
  const Polygons walls = {{{-9, -9, 1}, {9, -9, 1.25}, {9, 9, 1.5}, {-9, 9, 1.25}},
                          {{-9, 0, 4}, {9, 0, 4}, {9, 9, 4}, {-9, 9, 4}},
                          {{-9, -9, 6}, {9, -9, 6.25}, {9, 9, 6.5}, {-9, 9, 6.25}}};
  const Scene scene(soup_of(walls));
  for (unsigned k = 1; k <= 120; ++k) {
    const auto small = [&](int base) {
      Rational power = 1;
      for (unsigned i = 0; i < k; ++i) power /= base;
      return power;
    };
    const ExactPoint a{small(3), small(5), small(7)};
    const ExactPoint b{small(11), 0, 4};
    const LineScan scan(scene, all_faces(scene), a, b);
    ASSERT_EQ(scan.size(), 3) << k;
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(scan.faces_at(c, scan.from(c)), std::vector<int>{c}) << k;
    }
    EXPECT_LT(scan.from(0), scan.from(1)) << k;
    EXPECT_EQ(scan.from(1), 1) << k;
    EXPECT_LT(scan.from(1), scan.from(2)) << k;
  }
}

// ---- Seeded scenes. ----

Point grid_point(testing::Random& random, int low, int high) {
  return {static_cast<double>(random.integer(low, high)),
          static_cast<double>(random.integer(low, high)),
          static_cast<double>(random.integer(low, high))};
}

// A sheet soup: triangles and parallelograms with corners on a small grid.
Polygons grid_sheets(testing::Random& random, int count) {
  Polygons out;
  while (static_cast<int>(out.size()) < count) {
    const Point p = grid_point(random, 0, 4), q = grid_point(random, 0, 4),
                r = grid_point(random, 0, 4);
    if ((q - p).cross(r - p).isZero()) continue;
    if (random.integer(0, 1) == 0) {
      out.push_back({p, q, r});
    } else {
      out.push_back({p, q, q + r - p, r});
    }
  }
  return out;
}

void check_random_lines(const Polygons& polygons, testing::Random& random, int lines,
                        std::map<std::string, int>& reached) {
  const Scene scene(soup_of(polygons));
  const auto faces = all_faces(scene);
  for (int i = 0; i < lines; ++i) {
    const Point a = grid_point(random, -1, 5), b = grid_point(random, -1, 5);
    if (a == b) continue;
    const auto contacts = line_contacts(scene, faces, a, b);
    expect_same(contacts, naive_contacts(scene, exact_point(a), exact_point(b)));
    for (const ExactContact& c : contacts) {
      const bool edge_on = c.from != c.to;
      const int tries = c.blocked ? 500 : 20000;
      ASSERT_EQ(some_perturbed_line_passes(scene, c, a, b, random, tries), !c.blocked)
          << a.transpose() << " to " << b.transpose() << " at " << c.from;
      ++reached[std::string(edge_on ? "stretch" : "point") +
                (c.blocked ? " blocked" : " grazed")];
    }
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(Contact, AgreesWithNaiveAndPerturbedLinesOnGridSheets) {
  std::map<std::string, int> reached;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    testing::Random random(seed);
    check_random_lines(grid_sheets(random, random.integer(2, 16)), random, 40, reached);
    if (HasFailure()) return;
  }
  for (const auto& [what, count] : reached) std::printf("%s: %d\n", what.c_str(), count);
  EXPECT_EQ(reached.size(), 4u);
}

TEST(Contact, AgreesWithNaiveAndPerturbedLinesOnGridBoxes) {
  std::map<std::string, int> reached;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    testing::Random random(seed);
    testing::BoxOptions options;
    options.grid = 4;
    options.may_touch = true;
    options.min_size = 1;
    options.max_size = 2;
    const auto soup = testing::random_boxes(seed, random.integer(2, 5), options);
    check_random_lines(polygons_of(soup), random, 40, reached);
    if (HasFailure()) return;
  }
  for (const auto& [what, count] : reached) std::printf("%s: %d\n", what.c_str(), count);
  EXPECT_EQ(reached.size(), 4u);
}

// Fins around one axis and angles across it: the search for a motion, mostly.
TEST(Contact, AgreesWithPerturbedLinesAlongAnAxis) {
  int blocked = 0, grazed = 0;
  const std::vector<std::array<double, 2>> rays = {{2, 0},  {2, 2},   {0, 2},  {-2, 2},
                                                   {-2, 0}, {-2, -2}, {0, -2}, {2, -2}};
  for (unsigned seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    testing::Random random(seed);
    Polygons polygons = {fin(0, 8, rays[random.integer(0, 7)])};
    const int fins = random.integer(0, 5), angles = random.integer(4, 14);
    for (int i = 0; i < fins; ++i) {
      const int from = random.integer(0, 3);
      polygons.push_back(
          fin(2 * from, 2 * random.integer(from + 1, 4), rays[random.integer(0, 7)]));
    }
    for (int i = 0; i < angles; ++i) {
      const int ray = random.integer(0, 7);
      polygons.push_back(angle(2 * random.integer(0, 4), rays[ray],
                               rays[(ray + random.integer(1, 3)) % 8]));
    }
    const Scene scene(soup_of(polygons));
    const auto contacts = line_contacts(scene, all_faces(scene), kAxisFrom, kAxisTo);
    ASSERT_EQ(contacts.size(), 1u);
    (contacts[0].blocked ? blocked : grazed)++;
    const bool passes =
        some_perturbed_line_passes(scene, contacts[0], kAxisFrom, kAxisTo, random,
                                   contacts[0].blocked ? 4000 : 200000);
    ASSERT_EQ(passes, !contacts[0].blocked);
  }
  std::printf("blocked %d, grazed %d\n", blocked, grazed);
  EXPECT_GT(blocked, 20);
  EXPECT_GT(grazed, 20);
}

// The same with sides that recede from the instant at different slopes, and faces edge-on
// that meet the axis in a point: the second order, mostly.
TEST(Contact, AgreesWithPerturbedLinesAtOneInstant) {
  int blocked = 0, grazed = 0;
  const std::vector<std::array<double, 2>> rays = {{2, 0},  {2, 2},   {0, 2},  {-2, 2},
                                                   {-2, 0}, {-2, -2}, {0, -2}, {2, -2}};
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    testing::Random random(seed);
    const auto corner = [&](int ray) {
      const auto& r = rays[ray % 8];
      return Point(random.integer(-2, 2), r[0], r[1]);
    };
    Polygons polygons;
    const int angles = random.integer(4, 12), flat = random.integer(0, 4);
    for (int i = 0; i < angles; ++i) {
      const int ray = random.integer(0, 7);
      polygons.push_back(
          {Point(0, 0, 0), corner(ray), corner(ray + random.integer(1, 3))});
    }
    for (int i = 0; i < flat; ++i) {
      // A wedge, or a barrier before or after.
      const int ray = random.integer(0, 7);
      Point other = corner(ray);
      if (random.one_in(2)) other = Point(random.one_in(2) ? -4 : 4, 0, 0);
      Point p = corner(ray);
      if (p == other) p.x() += 1;
      polygons.push_back({Point(0, 0, 0), p, other});
    }
    const Scene scene(soup_of(polygons));
    const auto contacts = line_contacts(scene, all_faces(scene), kAxisFrom, kAxisTo);
    ASSERT_EQ(contacts.size(), 1u);
    (contacts[0].blocked ? blocked : grazed)++;
    const bool passes =
        some_perturbed_line_passes(scene, contacts[0], kAxisFrom, kAxisTo, random,
                                   contacts[0].blocked ? 3000 : 500000);
    ASSERT_EQ(passes, !contacts[0].blocked);
  }
  std::printf("blocked %d, grazed %d\n", blocked, grazed);
  EXPECT_GT(blocked, 100);
  EXPECT_GT(grazed, 100);
}

}  // namespace
}  // namespace sightline
