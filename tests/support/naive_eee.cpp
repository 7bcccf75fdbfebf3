#include "tests/support/naive_eee.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tests/support/naive_ev.h"
#include "tests/support/naive_solids_internal.h"
#include "tests/support/naive_surd_internal.h"
#include "tests/support/naive_transversals.h"

namespace sightline::testing {
namespace {

/// Edges of three distinct solids.  The lines that meet all three are told by where they
/// meet the first: at parameter t in [0, 1] from its end a to its end b.
using Triple = std::array<int, 3>;
using Quadruple = std::array<int, 4>;  // ascending

/// A line at which something can change along the family of a triple.
struct Critical {
  Surd t;
  /// Through vertex 'V' id or in the plane of face 'F' id, of the edge in that place of
  /// the triple; or meeting a fourth edge 'E' id.
  char cause;
  int place;
  int id;
};

/// The lines of a triple between neighbouring critical lines that meet all three edges
/// and support there; blockers are not looked at.
struct SupportingLines {
  Triple edges;
  std::vector<Critical> critical;  ///< without fourth edges; ascending, from 0 to 1
  std::vector<bool> gaps;          ///< between critical[i] and critical[i + 1]
};

template <class T>
struct Contacts {
  std::array<Vec<T>, 3> points;
  Vec<T> direction;
  std::vector<int> order{};  ///< of the points along the direction
  std::array<Met, 2> outer{Met::Graze, Met::Graze};  ///< at the first, at the last
};

/// Indices of points in their order along a direction.
template <class T>
std::vector<int> order_along(std::span<const Vec<T>> points, const Vec<T>& direction) {
  std::vector<int> order;
  for (std::size_t i = 0; i < points.size(); ++i) order.push_back(static_cast<int>(i));
  std::ranges::sort(order, [&](int i, int j) {
    return sign_of(dot(points[j] - points[i], direction)) > 0;
  });
  return order;
}

/// A short number strictly between: the first that halving [0, 1] comes to.
Number between(const Surd& low, const Surd& high) {
  Number from = 0, to = 1;
  while (true) {
    const Number middle = (from.exact() + to.exact()) / 2;
    if (compare(Surd(middle), low) <= 0) {
      from = middle;
    } else if (compare(Surd(middle), high) >= 0) {
      to = middle;
    } else {
      return middle;
    }
  }
}

/// sqrt(x) for x that is the square of a rational.
Rational root_of_square(const Rational& x) {
  using boost::multiprecision::mpz_int;
  const mpz_int p = sqrt(mpz_int(numerator(x))), q = sqrt(mpz_int(denominator(x)));
  const Rational result = Rational(p) / Rational(q);
  if (result * result != x) throw std::logic_error("two roots in one line");
  return result;
}

/// A line's coordinates as numbers of one root.
std::array<Surd, 6> with_surds(const CanonicalLine& line) {
  Rational root = 0;
  for (const QuadraticNumber& x : line) {
    if (x.w != 0) root = abs(x.w);
  }
  std::array<Surd, 6> result;
  for (int i = 0; i < 6; ++i) {
    if (line[i].w == 0) {
      result[i] = Surd(Number(line[i].x));
      continue;
    }
    const Rational factor = root_of_square(abs(line[i].w) / root) * line[i].w.sign();
    result[i] = Surd(Number(line[i].x), Number(factor), Number(root));
  }
  return result;
}

struct Eeee {
  int node;
  Quadruple edges;
  std::array<Surd, 4> at;  ///< where on each edge
};

class Enumeration {
 public:
  Enumeration(const PolygonSoup& soup, bool end_contacts)
      : s_(soup), end_contacts_(end_contacts) {
    find_sides();
    take_vertex_nodes(naive_ev(soup, end_contacts));
    for (int f = 0; f < static_cast<int>(s_.faces.size()); ++f) find_fee(f);
    find_supporting_triples();
    find_eeee();
    for (const SupportingLines& lines : triples_) find_arcs(lines);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const NodeKey& node = result_.nodes[i];
      const bool more = end_contacts && node.kind.starts_with("VEE");
      if (more ? ends_[i] < 2 : ends_[i] != expected_ends(node)) {
        throw std::logic_error("a node is the end of a wrong number of EEE arcs: " +
                               node.kind);
      }
    }
    result_.sort();
  }
  CanonicalSkeleton take() { return std::move(result_); }

 private:
  /// On which side of the face's plane is the vertex.
  void find_sides();
  [[nodiscard]] bool crosses(int e, int face) const {
    return side_[face][s_.edges[e].a] * side_[face][s_.edges[e].b] < 0;
  }
  /// Some line from a point of f to a point of e supports e's solid there: the points of
  /// f are not all inside, nor all outside of both planes of the faces at e.
  [[nodiscard]] bool can_support(int e, int f) const {
    const int left = s_.edges[e].left, right = s_.edges[e].right;
    if (end_contacts_ && side_[left][s_.edges[f].a] > 0 &&
        side_[right][s_.edges[f].a] > 0) {
      return true;  // a line can end there
    }
    return crosses(f, left) || crosses(f, right) ||
           side_[left][s_.edges[f].a] != side_[right][s_.edges[f].a];
  }
  [[nodiscard]] bool can_support_each_other(int e, int f) const {
    return s_.edges[e].solid != s_.edges[f].solid && can_support(e, f) &&
           can_support(f, e);
  }

  template <class T>
  [[nodiscard]] Vec<T> point_on(int e, const T& t) const {
    const Vector& a = s_.vertices[s_.edges[e].a];
    const Vector& b = s_.vertices[s_.edges[e].b];
    return as<T>(a) + t * as<T>(b - a);
  }
  /// How many arcs end at a node with these contacts.
  [[nodiscard]] int expected_ends(const NodeKey& node) const {
    const bool face_outside =
        node.generators.front().kind == 'F' || node.generators.back().kind == 'F';
    return end_contacts_ && face_outside ? 3 : 2;
  }
  [[nodiscard]] bool can_be_outer(Met met) const {
    return met == Met::Graze || (met == Met::End && end_contacts_);
  }
  /// How the line meets the outer two of these edges, in that order along the direction,
  /// if those in between graze and the outer ones may do what they do.
  template <class T>
  [[nodiscard]] std::optional<std::array<Met, 2>> outer_contacts(
      std::span<const int> along_line, const Vec<T>& direction) const {
    for (const int e : along_line.subspan(1, along_line.size() - 2)) {
      if (enters(e, direction) > 0) return std::nullopt;
    }
    const Vec<T> back = T(Number(-1)) * direction;
    const Met first = s_.met_at_edge<T>(along_line.front(), direction);
    const Met last = s_.met_at_edge<T>(along_line.back(), back);
    if (!can_be_outer(first) || !can_be_outer(last)) return std::nullopt;
    return std::array{first, last};
  }
  /// Generators of edges in their order along a line.
  [[nodiscard]] std::vector<GeneratorKey> keys(std::span<const int> along_line,
                                               const std::array<Met, 2>& outer) const {
    std::vector<GeneratorKey> result;
    for (const int e : along_line) result.push_back(s_.edge_key(e));
    result.front() = s_.edge_key(along_line.front(), outer[0]);
    result.back() = s_.edge_key(along_line.back(), outer[1]);
    return result;
  }
  static std::string name(const std::string& kind,
                          std::span<const GeneratorKey> along_line) {
    const auto ends = [](const GeneratorKey& g) {
      return g.kind == 'v' || g.kind == 'e';
    };
    return std::ranges::any_of(along_line, ends) ? kind + "_end" : kind;
  }
  /// Negative when a line through e in that direction supports there, zero when it lies
  /// in the plane of a face at e, positive when it enters.
  template <class T>
  [[nodiscard]] int enters(int e, const Vec<T>& direction) const {
    return sign_of(dot(as<T>(s_.faces[s_.edges[e].left].plane.normal), direction)) *
           sign_of(dot(as<T>(s_.faces[s_.edges[e].right].plane.normal), direction));
  }
  /// The line at t, if it meets the second and third edge.
  template <class T>
  [[nodiscard]] std::optional<Contacts<T>> contacts(const Triple& edges,
                                                    const T& t) const;
  /// The same, if moreover it enters none of the three solids.
  template <class T>
  [[nodiscard]] std::optional<Contacts<T>> supporting(const Triple& edges,
                                                      const T& t) const;
  /// The same, if moreover the segment between the outer contacts is free.
  template <class T>
  [[nodiscard]] std::optional<Contacts<T>> free_line(const Triple& edges,
                                                     const T& t) const;

  int add_node(NodeKey key) {
    result_.nodes.push_back(std::move(key));
    ends_.push_back(0);
    return static_cast<int>(ends_.size()) - 1;
  }
  void add_unique_node(NodeKey key) {
    if (!node_of_.try_emplace(key, static_cast<int>(ends_.size())).second) {
      throw std::logic_error("a node found twice");
    }
    add_node(std::move(key));
  }

  void take_vertex_nodes(const CanonicalSkeleton& ev);
  void find_fee(int f);
  void add_fee(int f, int e, const Vector& on_e, int g, const Vector& on_g);

  void find_supporting_triples();
  void add_vertex_criticals(SupportingLines& lines, int place) const;
  void add_face_criticals(SupportingLines& lines, int place) const;
  [[nodiscard]] SupportingLines supporting_lines(const Triple& edges) const;

  void find_eeee();
  void add_eeee(const Quadruple& edges, const CanonicalLine& line);

  void find_arcs(const SupportingLines& lines);
  void add_fourth_edges(const SupportingLines& lines, std::vector<Critical>& out) const;
  void add_arc(const Triple& along_line, const std::array<Met, 2>& outer,
               const Triple& edges, const Critical& first, const Critical& last);
  /// The node at a critical line, for arcs whose contacts are in that order.
  [[nodiscard]] int end_node(const Triple& along_line, const std::array<Met, 2>& outer,
                             const Triple& edges, const Critical& at) const;

  Solids s_;
  bool end_contacts_;
  CanonicalSkeleton result_;
  std::vector<int> ends_;  // arcs that end at each of result_'s nodes, until it is sorted
  std::vector<std::vector<int>> side_;           // by face, then vertex
  std::map<NodeKey, int> node_of_;               // VEE, EVE, FEE
  std::map<Quadruple, std::vector<Eeee>> eeee_;  // by edges
  std::vector<SupportingLines> triples_;         // that have any; edges ascending
};

void Enumeration::find_sides() {
  for (const SolidFace& face : s_.faces) {
    side_.emplace_back();
    for (std::size_t v = 0; v < s_.vertices.size(); ++v) {
      side_.back().push_back(sign_of(face.plane(s_.vertices[v])));
      if (side_.back().back() == 0 && s_.solid_of_vertex[v] != face.solid) {
        throw NotGeneral("a vertex in the plane of another solid's face");
      }
    }
  }
}

template <class T>
std::optional<Contacts<T>> Enumeration::contacts(const Triple& edges, const T& t) const {
  Contacts<T> result;
  result.points[0] = point_on(edges[0], t);
  // The line lies in the planes through that point and either of the other edges.
  std::array<Vec<T>, 3> normal;
  for (int k = 1; k < 3; ++k) {
    const Vector& a = s_.vertices[s_.edges[edges[k]].a];
    const Vector& b = s_.vertices[s_.edges[edges[k]].b];
    normal[k] = cross(as<T>(a) - result.points[0], as<T>(b - a));
  }
  for (int k = 1; k < 3; ++k) {
    const auto height = [&](int v) {
      return dot(normal[3 - k], as<T>(s_.vertices[v]) - result.points[0]);
    };
    const T at_a = height(s_.edges[edges[k]].a), at_b = height(s_.edges[edges[k]].b);
    const int sign_a = sign_of(at_a), sign_b = sign_of(at_b);
    if (sign_a * sign_b > 0) return std::nullopt;
    if (sign_a == 0 && sign_b == 0) throw NotGeneral("an edge in a plane with another");
    result.points[k] = point_on(edges[k], T(at_a / (at_a - at_b)));
  }
  result.direction = cross(normal[1], normal[2]);
  return result;
}

template <class T>
std::optional<Contacts<T>> Enumeration::supporting(const Triple& edges,
                                                   const T& t) const {
  std::optional<Contacts<T>> line = contacts(edges, t);
  if (!line) return std::nullopt;
  line->order = order_along<T>(line->points, line->direction);
  const Triple along_line = {edges[line->order[0]], edges[line->order[1]],
                             edges[line->order[2]]};
  const auto outer = outer_contacts<T>(along_line, line->direction);
  if (!outer) return std::nullopt;
  line->outer = *outer;
  return line;
}

template <class T>
std::optional<Contacts<T>> Enumeration::free_line(const Triple& edges, const T& t) const {
  std::optional<Contacts<T>> line = supporting(edges, t);
  if (!line) return std::nullopt;
  const Vec<T>& from = line->points[line->order.front()];
  const Vec<T>& to = line->points[line->order.back()];
  // A line that does not enter a convex solid at a contact does not enter it at all.
  const bool free = end_contacts_
                        ? s_.is_free(from, to)
                        : s_.is_free(from, to,
                                     {s_.edges[edges[0]].solid, s_.edges[edges[1]].solid,
                                      s_.edges[edges[2]].solid});
  return free ? line : std::nullopt;
}

void Enumeration::take_vertex_nodes(const CanonicalSkeleton& ev) {
  for (const NodeKey& node : ev.nodes) {
    if (node.kind.starts_with("VEE") || node.kind.starts_with("EVE")) {
      add_unique_node(node);
    }
  }
}

void Enumeration::find_fee(int f) {
  std::vector<std::pair<int, Vector>> crossings;
  for (int e = 0; e < static_cast<int>(s_.edges.size()); ++e) {
    if (s_.edges[e].solid == s_.faces[f].solid || !crosses(e, f)) continue;
    const Number at_a = s_.faces[f].plane(s_.vertices[s_.edges[e].a]);
    const Number at_b = s_.faces[f].plane(s_.vertices[s_.edges[e].b]);
    crossings.emplace_back(e, point_on(e, Number(at_a / (at_a - at_b))));
  }
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& [e, on_e] = crossings[i];
      const auto& [g, on_g] = crossings[j];
      if (s_.edges[e].solid != s_.edges[g].solid) add_fee(f, e, on_e, g, on_g);
    }
  }
}

void Enumeration::add_fee(int f, int e, const Vector& on_e, int g, const Vector& on_g) {
  const SolidFace& face = s_.faces[f];
  const Vector direction = on_g - on_e;
  const int at_e = enters(e, direction), at_g = enters(g, direction);
  if (!end_contacts_ && (at_e > 0 || at_g > 0)) return;
  // The two points at which the line crosses the face's outline.
  std::vector<Vector> points = {on_e, on_g};
  const Vector across = cross(face.plane.normal, direction);
  const auto height = [&](int v) { return dot(across, s_.vertices[v] - on_e); };
  const std::size_t n = face.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const int v = face.vertices[i], w = face.vertices[(i + 1) % n];
    const Number at_v = height(v), at_w = height(w);
    if (sign_of(at_v) == 0) throw NotGeneral("an edge-edge line through a face's corner");
    if (sign_of(at_v) * sign_of(at_w) > 0) continue;
    points.push_back(s_.vertices[v] +
                     Number(at_v / (at_v - at_w)) * (s_.vertices[w] - s_.vertices[v]));
  }
  if (points.size() != 4) return;
  if (at_e == 0 || at_g == 0) throw NotGeneral("a line in the planes of two faces");
  const std::vector<int> order = order_along<Number>(points, direction);
  if (!s_.is_free(points[order.front()], points[order.back()])) return;
  // An edge may be an end contact where nothing lies beyond it.
  std::array<Met, 2> met = {at_e > 0 ? Met::FromInside : Met::Graze,
                            at_g > 0 ? Met::FromInside : Met::Graze};
  for (const int i : {0, 1}) {
    if (order.front() == i) met[i] = s_.met_at_edge<Number>(i == 0 ? e : g, direction);
    if (order.back() == i) {
      met[i] = s_.met_at_edge<Number>(i == 0 ? e : g, Number(-1) * direction);
    }
    if (!can_be_outer(met[i])) return;
  }
  std::vector<GeneratorKey> along_line;
  int last = -1;
  for (const int i : order) {
    if (i < 2) along_line.push_back(s_.edge_key(i == 0 ? e : g, met[i]));
    if (i >= 2 && last < 2) along_line.push_back(s_.face_key(f));
    last = i;
  }
  if (along_line.size() != 3) throw std::logic_error("a contact inside a face");
  const std::string kind = name("FEE", along_line);
  add_unique_node(node_key(kind, std::move(along_line)));
}

void Enumeration::find_supporting_triples() {
  const int n = static_cast<int>(s_.edges.size());
  std::vector<std::vector<bool>> possible(n, std::vector<bool>(n));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) possible[i][j] = can_support_each_other(i, j);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (!possible[i][j]) continue;
      for (int k = j + 1; k < n; ++k) {
        if (!possible[i][k] || !possible[j][k]) continue;
        SupportingLines lines = supporting_lines({i, j, k});
        if (std::ranges::count(lines.gaps, true) > 0) {
          triples_.push_back(std::move(lines));
        }
      }
    }
  }
}

void Enumeration::add_vertex_criticals(SupportingLines& lines, int place) const {
  const int e = lines.edges[place];
  // The line through a vertex of e lies in the planes through it and f, and it and g.
  const int f = lines.edges[place == 0 ? 1 : 0], g = lines.edges[place == 2 ? 1 : 2];
  for (const int v : {s_.edges[e].a, s_.edges[e].b}) {
    if (place == 0) {
      lines.critical.push_back({Surd(Number(v == s_.edges[e].a ? 0 : 1)), 'V', 0, v});
      continue;
    }
    const auto plane = [&](int edge) {
      return plane_through(s_.vertices[v], s_.vertices[s_.edges[edge].a],
                           s_.vertices[s_.edges[edge].b]);
    };
    const Plane with_f = plane(f), with_g = plane(g);
    const Number at_a = with_g(s_.vertices[s_.edges[f].a]);
    const Number at_b = with_g(s_.vertices[s_.edges[f].b]);
    if (sign_of(at_a) * sign_of(at_b) >= 0) continue;
    if (sign_of(with_f(s_.vertices[s_.edges[g].a])) *
            sign_of(with_f(s_.vertices[s_.edges[g].b])) >=
        0) {
      continue;
    }
    lines.critical.push_back({Surd(at_a / (at_a - at_b)), 'V', place, v});
  }
}

void Enumeration::add_face_criticals(SupportingLines& lines, int place) const {
  const SolidEdge& edge = s_.edges[lines.edges[place]];
  const int f = lines.edges[place == 0 ? 1 : 0], g = lines.edges[place == 2 ? 1 : 2];
  for (const int face : {edge.left, edge.right}) {
    if (!crosses(f, face) || !crosses(g, face)) continue;
    const Plane& plane = s_.faces[face].plane;
    const auto crossing = [&](int e) -> Number {
      const Number at_a = plane(s_.vertices[s_.edges[e].a]);
      return at_a / (at_a - plane(s_.vertices[s_.edges[e].b]));
    };
    const Number on_f = crossing(f);
    const Vector y = point_on(f, on_f), z = point_on(g, crossing(g));
    const Vector across = cross(plane.normal, z - y);
    const Number at_a = dot(across, s_.vertices[edge.a] - y);
    const Number at_b = dot(across, s_.vertices[edge.b] - y);
    if (sign_of(at_a) * sign_of(at_b) >= 0) continue;
    const Number t = place == 0 ? Number(at_a / (at_a - at_b)) : on_f;
    lines.critical.push_back({Surd(t), 'F', place, face});
  }
}

/// Ascending; no two may be equal.
void sort(std::vector<Critical>& critical) {
  std::ranges::sort(critical, [](const Critical& x, const Critical& y) {
    return compare(x.t, y.t) < 0;
  });
  for (std::size_t i = 1; i < critical.size(); ++i) {
    if (compare(critical[i - 1].t, critical[i].t) == 0) {
      throw NotGeneral("two critical lines coincide");
    }
  }
}

SupportingLines Enumeration::supporting_lines(const Triple& edges) const {
  SupportingLines lines{edges, {}, {}};
  for (int place = 0; place < 3; ++place) {
    add_vertex_criticals(lines, place);
    add_face_criticals(lines, place);
  }
  sort(lines.critical);
  for (std::size_t i = 0; i + 1 < lines.critical.size(); ++i) {
    const Number t = between(lines.critical[i].t, lines.critical[i + 1].t);
    lines.gaps.push_back(supporting(edges, t).has_value());
  }
  return lines;
}

void Enumeration::find_eeee() {
  // Every three edges of such a line have it as a line that meets and supports them, and
  // in general position all lines near it that meet them support them as well.
  const int n = static_cast<int>(s_.edges.size());
  std::map<std::pair<int, int>, std::vector<bool>> third;
  for (const SupportingLines& lines : triples_) {
    const auto& [i, j, k] = lines.edges;
    std::vector<bool>& row = third[{i, j}];
    row.resize(n);
    row[k] = true;
  }
  const auto segment = [&](int e) {
    const Coordinates& a = s_.coordinates[s_.edges[e].a];
    const Coordinates& b = s_.coordinates[s_.edges[e].b];
    return ExactSegment{exact({a[0], a[1], a[2]}), exact({b[0], b[1], b[2]})};
  };
  for (const SupportingLines& lines : triples_) {
    const auto& [i, j, k] = lines.edges;
    const auto ij = third.find({i, j}), ik = third.find({i, k}), jk = third.find({j, k});
    if (ik == third.end() || jk == third.end()) continue;
    for (int l = k + 1; l < n; ++l) {
      if (!ij->second[l] || !ik->second[l] || !jk->second[l]) continue;
      const std::array q = {segment(i), segment(j), segment(k), segment(l)};
      const QuadrupleTransversals found = naive_quadruple(q);
      if (!found.families.empty()) throw NotGeneral("infinitely many lines");
      for (const CanonicalLine& line : found.isolated) add_eeee({i, j, k, l}, line);
    }
  }
}

void Enumeration::add_eeee(const Quadruple& edges, const CanonicalLine& line) {
  const std::array<Surd, 6> x = with_surds(line);
  const Vec<Surd> direction = {x[0], x[1], x[2]}, moment = {x[3], x[4], x[5]};
  bool in_plane = false;
  for (const int e : edges) {
    const int sign = enters(e, direction);
    if (sign > 0 && !end_contacts_) return;
    in_plane = in_plane || sign == 0;
  }
  if (in_plane) throw NotGeneral("four edges and the plane of a face");
  std::array<Surd, 4> at;
  std::array<Vec<Surd>, 4> points;
  for (int i = 0; i < 4; ++i) {
    const Vec<Surd> a = as<Surd>(s_.vertices[s_.edges[edges[i]].a]);
    const Vec<Surd> b = as<Surd>(s_.vertices[s_.edges[edges[i]].b]);
    // y is on the line iff y x direction = moment.
    const Vec<Surd> off_a = cross(a, direction) - moment, slope = cross(b - a, direction);
    int axis = 0;
    while (axis < 3 && sign_of(slope[axis]) == 0) ++axis;
    if (axis == 3) throw NotGeneral("a line along an edge");
    at[i] = -off_a[axis] / slope[axis];
    if (sign_of(at[i]) == 0 || sign_of(at[i] - Surd(Number(1))) == 0) {
      throw NotGeneral("a vertex and three edges");
    }
    points[i] = point_on(edges[i], at[i]);
  }
  const std::vector<int> order = order_along<Surd>(points, direction);
  Quadruple along_line;
  for (int i = 0; i < 4; ++i) along_line[i] = edges[order[i]];
  const auto outer = outer_contacts<Surd>(along_line, direction);
  if (!outer || !s_.is_free(points[order.front()], points[order.back()])) return;
  std::vector<GeneratorKey> generators = keys(along_line, *outer);
  const std::string kind = name("EEEE", generators);
  const int node = add_node(node_key(kind, std::move(generators)));
  eeee_[edges].push_back({node, edges, std::move(at)});
}

void Enumeration::find_arcs(const SupportingLines& lines) {
  const Triple& edges = lines.edges;
  std::vector<Critical> critical = lines.critical;
  add_fourth_edges(lines, critical);
  sort(critical);
  // Maximal runs [first, last] of critical lines between which every line is in.
  std::size_t first = 0;
  std::vector<int> order;  // of the contacts, in the current run; empty: none
  std::array<Met, 2> outer{};
  const auto add_run = [&](std::size_t last) {
    add_arc({edges[order[0]], edges[order[1]], edges[order[2]]}, outer, edges,
            critical[first], critical[last]);
    order.clear();
  };
  for (std::size_t i = 0; i + 1 < critical.size(); ++i) {
    const Number t = between(critical[i].t, critical[i + 1].t);
    const std::optional<Contacts<Number>> line = free_line(edges, t);
    // Being in is closed; at a run's ends, the node there was found to be in.
    if (line && !order.empty() && !free_line(edges, critical[i].t)) {
      throw std::logic_error("a component is not closed");
    }
    if (!order.empty() && !line) add_run(i);
    if (!line) continue;
    std::vector<int> here = line->order;
    std::array<Met, 2> outer_here = line->outer;
    if (!order.empty() && here.front() != order.front()) {
      std::ranges::reverse(here);
      std::swap(outer_here[0], outer_here[1]);
    }
    if (!order.empty() && order != here) {
      throw std::logic_error("contacts change places along an arc");
    }
    if (!order.empty() && outer != outer_here) add_run(i);
    if (!order.empty()) continue;
    first = i;
    order = here;
    outer = outer_here;
  }
  if (!order.empty()) add_run(critical.size() - 1);
}

void Enumeration::add_fourth_edges(const SupportingLines& lines,
                                   std::vector<Critical>& out) const {
  // A line through the point x(t) of the first edge meets another edge where it lies in
  // the plane through x(t) and that edge, whose normal is linear in t: constant + t
  // slope.  It meets three others where three such normals are dependent, a quadratic
  // equation: the slopes are all orthogonal to the first edge, hence dependent.
  struct Normal {
    Vector constant, slope;
  };
  const Vector& origin = s_.vertices[s_.edges[lines.edges[0]].a];
  const Vector along = s_.vertices[s_.edges[lines.edges[0]].b] - origin;
  const auto normal = [&](int e) -> Normal {
    const Vector& a = s_.vertices[s_.edges[e].a];
    const Vector d = s_.vertices[s_.edges[e].b] - a;
    return {cross(origin - a, d), cross(along, d)};
  };
  const Normal u = normal(lines.edges[1]), v = normal(lines.edges[2]);
  const std::array<Vector, 3> product = {
      cross(u.constant, v.constant),
      cross(u.constant, v.slope) + cross(u.slope, v.constant), cross(u.slope, v.slope)};
  for (int e = 0; e < static_cast<int>(s_.edges.size()); ++e) {
    // A line that enters a solid at an edge is blocked on both sides or on neither.
    if (!std::ranges::all_of(lines.edges, [&](int other) {
          return s_.edges[other].solid != s_.edges[e].solid && can_support(e, other);
        })) {
      continue;
    }
    const Normal w = normal(e);
    const Number c = dot(product[0], w.constant);
    const Number b = dot(product[1], w.constant) + dot(product[0], w.slope);
    const Number a = dot(product[2], w.constant) + dot(product[1], w.slope);
    const Number discriminant = b * b - 4 * a * c;
    if (sign_of(discriminant) < 0) continue;
    if (sign_of(a) == 0 || sign_of(discriminant) == 0) {
      throw NotGeneral("less than two lines through four edges' lines");
    }
    for (const int sign : {-1, 1}) {
      const Surd t(-b / (2 * a), sign / (2 * a), discriminant);
      bool inside = false, at_bound = false;
      for (std::size_t i = 0; i < lines.gaps.size(); ++i) {
        if (!lines.gaps[i]) continue;
        const int from = compare(t, lines.critical[i].t);
        const int to = compare(t, lines.critical[i + 1].t);
        inside = inside || (from >= 0 && to <= 0);
        at_bound = at_bound || from == 0 || to == 0;
      }
      if (!inside) continue;
      // Both ends of e against the plane of the line and the second edge.
      const auto side = [&](int vertex) {
        const Vector p = s_.vertices[vertex] - s_.vertices[s_.edges[lines.edges[1]].a];
        return sign_of(Surd(dot(u.constant, p)) + t * Surd(dot(u.slope, p)));
      };
      const int sides = side(s_.edges[e].a) * side(s_.edges[e].b);
      if (sides > 0) continue;
      if (sides == 0 || at_bound) throw NotGeneral("five contacts");
      out.push_back({t, 'E', -1, e});
    }
  }
}

void Enumeration::add_arc(const Triple& along_line, const std::array<Met, 2>& outer,
                          const Triple& edges, const Critical& first,
                          const Critical& last) {
  std::vector<GeneratorKey> generators = keys(along_line, outer);
  std::array<NodeKey, 2> nodes;
  for (int i = 0; i < 2; ++i) {
    const int node = end_node(along_line, outer, edges, i == 0 ? first : last);
    ++ends_[node];
    nodes[i] = result_.nodes[node];
  }
  result_.arcs.push_back(arc_key("EEE", std::move(generators), false, std::move(nodes)));
}

int Enumeration::end_node(const Triple& along_line, const std::array<Met, 2>& outer,
                          const Triple& edges, const Critical& at) const {
  if (at.cause == 'E') {
    Quadruple key = {edges[0], edges[1], edges[2], at.id};
    std::ranges::sort(key);
    const auto found = eeee_.find(key);
    if (found == eeee_.end()) throw std::logic_error("an arc ends at no EEEE");
    const auto place = std::ranges::find(key, edges[0]) - key.begin();
    for (const Eeee& node : found->second) {
      if (compare(node.at[place], at.t) == 0) return node.node;
    }
    throw std::logic_error("an arc ends at no EEEE");
  }
  const int changed = edges[at.place];
  const std::string kind = at.cause == 'F'            ? "FEE"
                           : changed == along_line[1] ? "EVE"
                                                      : "VEE";
  // A vertex may be an end contact where its edge is none, or the other way round.
  for (const Met met : {Met::Graze, Met::End}) {
    std::vector<GeneratorKey> generators = keys(along_line, outer);
    generators[std::ranges::find(along_line, changed) - along_line.begin()] =
        at.cause == 'V' ? s_.vertex_key(at.id, met) : s_.face_key(at.id);
    const std::string full_name = name(kind, generators);
    const auto found = node_of_.find(node_key(full_name, std::move(generators)));
    if (found != node_of_.end()) return found->second;
  }
  throw std::logic_error("an arc ends at no " + kind);
}

}  // namespace

CanonicalSkeleton naive_eee(const PolygonSoup& soup, bool end_contacts) {
  return Enumeration(soup, end_contacts).take();
}

}  // namespace sightline::testing
