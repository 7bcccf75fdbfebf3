// Disjoint convex polyhedra, told so that naive oracles can ask what the contract's
// definitions speak of: does a line enter a solid at a contact, is a segment free.  For
// .cpp files of tests only.

#pragma once

#include <CGAL/Lazy_exact_nt.h>
#include <CGAL/boost_mp.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "linespace/scene.h"
#include "tests/support/canonical_skeleton.h"
#include "tests/support/exact.h"

namespace sightline::testing {

/// Rationals that look at an interval first; every sign is exact.
using Number = CGAL::Lazy_exact_nt<Rational>;
using Vector = Vec<Number>;

inline int sign_of(const Number& x) { return static_cast<int>(CGAL::sign(x)); }

/// The same vector over a larger field.
template <class T>
Vec<T> as(const Vector& v) {
  return {T(v[0]), T(v[1]), T(v[2])};
}

/// { x : normal . x = offset }; a solid lies where normal . x <= offset.
struct Plane {
  Vector normal;
  Number offset;
  template <class T>
  [[nodiscard]] T operator()(const Vec<T>& p) const {
    return dot(as<T>(normal), p) - T(offset);
  }
};

inline Plane plane_through(const Vector& a, const Vector& b, const Vector& c) {
  const Vector normal = cross(b - a, c - a);
  return {normal, dot(normal, a)};
}

struct SolidFace {
  std::vector<int> vertices;  // counter-clockwise seen from outside
  Plane plane;
  int solid;
};

struct SolidEdge {
  int a, b;
  int left, right;  // its two faces
  int solid;
};

/// How a line meets a solid in a point of its boundary, told from one of the line's two
/// directions: it leaves the solid that way, does not enter it, or leaves it the other
/// way.
enum class Met { FromInside, Graze, End };

/// The polyhedra, with all indices global.
struct Solids {
  std::vector<Coordinates> coordinates;
  std::vector<Vector> vertices;
  std::vector<int> solid_of_vertex;
  std::vector<std::vector<int>> faces_of_vertex;
  std::vector<SolidFace> faces;
  std::vector<SolidEdge> edges;
  std::vector<std::vector<int>> faces_of_solid;

  /// Throws NotGeneral when a group is not a closed convex polyhedron with planar faces,
  /// no two of them coplanar.
  explicit Solids(const PolygonSoup& soup);

  /// With the letter of an end contact where it is one.
  [[nodiscard]] GeneratorKey vertex_key(int v, Met met = Met::Graze) const;
  [[nodiscard]] GeneratorKey edge_key(int e, Met met = Met::Graze) const;
  [[nodiscard]] GeneratorKey face_key(int f) const;

  /// The line through v in that direction does not enter v's solid near v: neither
  /// direction points into the interior of the cone that the faces at v bound.
  [[nodiscard]] bool supports_at_vertex(int v, const Vector& direction) const;
  /// The same for a line through a point inside edge e.
  [[nodiscard]] bool supports_at_edge(int e, const Vector& direction) const;

  /// How a line from v, from a point inside edge e, in that direction meets the solid.
  [[nodiscard]] Met met_at_vertex(int v, const Vector& direction) const {
    return met<Number>(faces_of_vertex[v], direction);
  }
  template <class T>
  [[nodiscard]] Met met_at_edge(int e, const Vec<T>& direction) const {
    return met<T>({edges[e].left, edges[e].right}, direction);
  }

  /// No solid's interior meets the open segment ab, those in `known` not looked at.
  template <class T>
  [[nodiscard]] bool is_free(const Vec<T>& a, const Vec<T>& b,
                             std::initializer_list<int> known = {}) const;

 private:
  [[nodiscard]] bool does_not_enter(const std::vector<int>& around,
                                    const Vector& direction) const {
    return met<Number>(around, direction) == Met::Graze;
  }
  template <class T>
  [[nodiscard]] Met met(const std::vector<int>& around, const Vec<T>& direction) const {
    bool all_in = true, all_out = true;
    for (const int f : around) {
      const int s = sign_of(dot(as<T>(faces[f].plane.normal), direction));
      all_in = all_in && s < 0;
      all_out = all_out && s > 0;
    }
    return all_in ? Met::FromInside : all_out ? Met::End : Met::Graze;
  }
};

template <class T>
bool Solids::is_free(const Vec<T>& a, const Vec<T>& b,
                     std::initializer_list<int> known) const {
  for (int s = 0; s < static_cast<int>(faces_of_solid.size()); ++s) {
    if (std::ranges::find(known, s) != known.end()) continue;
    // The open interval of parameters at which the segment is inside the solid.
    T from(Number(0)), to(Number(1));
    bool misses = false;
    for (const int f : faces_of_solid[s]) {
      const T at_a = faces[f].plane(a);
      const T at_b = faces[f].plane(b);
      const int sign_a = sign_of(at_a), sign_b = sign_of(at_b);
      if (sign_a >= 0 && sign_b >= 0) {
        misses = true;
        break;
      }
      if (sign_a <= 0 && sign_b <= 0) continue;
      const T at = at_a / (at_a - at_b);
      if (sign_a > 0 && sign_of(at - from) > 0) from = at;
      if (sign_b > 0 && sign_of(at - to) < 0) to = at;
    }
    if (!misses && sign_of(to - from) > 0) return false;
  }
  return true;
}

}  // namespace sightline::testing
