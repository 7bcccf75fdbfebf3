#include "tests/shadows/mesh_proof/mesh_structures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <set>
#include <sstream>
#include <tuple>

namespace sightline::testing {
namespace {

// Edges shorter than that, of the facet's size, have no sides that doubles could tell.
constexpr double kShort = 1e-6;
// Of the facet's size: where the oracle changes, and where the mesh has the edge.
constexpr double kSamePlace = 1e-9;

std::vector<Receiver> all_objects(const Scene& scene) {
  std::vector<Receiver> result;
  for (const Object& o : scene.objects()) result.push_back({o.name, o.faces, true});
  return result;
}

bool may_change_nothing(ShadowEdgeKind kind) {
  return kind == ShadowEdgeKind::Boundary || kind == ShadowEdgeKind::Contact ||
         kind == ShadowEdgeKind::Plane;
}

double unit(std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(0, 1)(random);
}

// At most `most` of the numbers below n, at random.
std::vector<int> some_of(int n, int most, std::mt19937_64& random) {
  std::vector<int> all(n);
  for (int i = 0; i < n; ++i) all[i] = i;
  std::ranges::shuffle(all, random);
  if (n > most) all.resize(most);
  return all;
}

// Neighbours that are the same are one; beginning with the smallest.
std::vector<std::string> joined_cycle(const std::vector<std::string>& sides) {
  std::vector<std::string> result;
  for (const std::string& side : sides) {
    if (result.empty() || result.back() != side) result.push_back(side);
  }
  if (result.size() > 1 && result.front() == result.back()) result.pop_back();
  std::ranges::rotate(result, std::ranges::min_element(result));
  return result;
}

// The oracle's structure without edges in line with the horizon.
std::vector<NaiveSeenSource> without_edges_at_horizon(std::vector<NaiveSeenSource> seen) {
  const auto is_horizon = [](const NaiveSideName& n) {
    return n.kind == NaiveSideName::Kind::Horizon;
  };
  for (NaiveSeenSource& source : seen) {
    for (auto& boundary : source.boundaries) {
      std::vector<NaiveSide> sides;
      for (NaiveSide& side : boundary) {
        if (std::ranges::any_of(side, is_horizon))
          side = {{NaiveSideName::Kind::Horizon, {}}};
        if (sides.empty() || sides.back() != side) sides.push_back(std::move(side));
      }
      if (sides.size() > 1 && sides.front() == sides.back()) sides.pop_back();
      std::ranges::rotate(sides, std::ranges::min_element(sides));
      boundary = std::move(sides);
    }
    std::ranges::sort(source.boundaries);
  }
  std::ranges::sort(seen, [](const NaiveSeenSource& a, const NaiveSeenSource& b) {
    return std::tie(a.polygons, a.boundaries) < std::tie(b.polygons, b.boundaries);
  });
  return seen;
}

}  // namespace

MeshSampleCounts& MeshSampleCounts::operator+=(const MeshSampleCounts& more) {
  meshes += more.meshes;
  faces += more.faces;
  face_points += more.face_points;
  edges += more.edges;
  edge_points += more.edge_points;
  narrow += more.narrow;
  segments += more.segments;
  segment_points += more.segment_points;
  changes += more.changes;
  return *this;
}

std::ostream& operator<<(std::ostream& out, const MeshSampleCounts& c) {
  return out << c.meshes << " meshes, " << c.faces << " faces, " << c.face_points
             << " points in them, " << c.edges << " edges, " << c.edge_points
             << " points on them, " << c.narrow << " left out as narrow, " << c.segments
             << " segments, " << c.segment_points << " points, " << c.changes
             << " changes";
}

bool edges_at_horizon_differ(const ShadowScene& lit) {
  constexpr std::array kScenes{"sheets 1, level 46", "sheets 2, bent 11",
                               "stacks 2, flush 13"};
  return std::ranges::find(kScenes, lit.name) != kScenes.end();
}

MeshStructures::MeshStructures(const ShadowScene& lit)
    : name_(lit.name),
      scene_(lit.soup),
      faces_(naive_shadow_faces(scene_, faces_of_groups(scene_, lit.lights),
                                faces_of_groups(scene_, lit.two_sided))),
      naive_(faces_),
      shadows_(find_shadows(scene_, light_source(scene_, lit.lights, lit.two_sided),
                            all_objects(scene_))) {}

std::vector<std::string> MeshStructures::differences(const MeshSamples& samples,
                                                     std::uint64_t seed) {
  random_.seed(seed);
  no_edges_at_horizon_ = samples.no_edges_at_horizon;
  for (const ReceiverShadows& receiver : shadows_.receivers) {
    for (const ShadowMesh& mesh : receiver.meshes) {
      const MeshPlane plane(scene_, faces_, mesh, true);
      ++counts_.meshes;
      look_at_faces(plane, samples);
      look_at_edges(plane, samples);
      for (int i = 0; i < samples.segments && differences_.size() < 10; ++i) walk(plane);
    }
  }
  return differences_;
}

std::string MeshStructures::seen_at(const MeshPlane& plane, const Flat& p) const {
  std::vector<NaiveSeenSource> seen = naive_.structure(plane.lift(p), plane.normal());
  return text_of(no_edges_at_horizon_ ? without_edges_at_horizon(std::move(seen)) : seen);
}

void MeshStructures::report(const MeshPlane& plane, const Flat& p,
                            const std::string& message) {
  if (differences_.size() >= 10) return;
  std::ostringstream out;
  out.precision(17);
  const auto& frame = plane.mesh().frame;
  out << name_ << ", facet " << plane.mesh().facet << " at "
      << (frame.origin + p[0] * frame.x_axis + p[1] * frame.y_axis).transpose() << ": "
      << message;
  differences_.push_back(out.str());
}

std::string MeshStructures::told(int structure, Told what) const {
  std::ostringstream out;
  for (const SeenBoundary& b : shadows_.structures[structure]) {
    std::vector<std::string> sides;
    for (const auto& side : b.sides) {
      const bool brief = std::ranges::any_of(side, [&](const SeenSide& s) {
        return (what != Told::All && s.kind == SeenSide::Kind::Horizon) ||
               (what == Told::NoEdgesAtSource && s.kind == SeenSide::Kind::Source);
      });
      std::string names;
      for (const SeenSide& s : side) {
        if (brief && s.kind == SeenSide::Kind::Edge) continue;
        names +=
            std::string(" ") + "SECH"[static_cast<int>(s.kind)] + std::to_string(s.id);
      }
      sides.push_back(names);
    }
    if (what != Told::All) sides = joined_cycle(sides);
    out << b.source_face << ':';
    for (const std::string& side : sides) out << " |" << side;
    out << '\n';
  }
  return out.str();
}

std::string MeshStructures::compare(const MeshPlane& plane, int face, const Flat& p,
                                    const char* where) {
  const int number = plane.mesh().faces[face].structure;
  std::string seen = seen_at(plane, p);
  const std::string key =
      told(number, no_edges_at_horizon_ ? Told::NoEdgesAtHorizon : Told::All);
  const std::string& known = text_of_.try_emplace(key, seen).first->second;
  if (known != seen) {
    report(plane, p,
           std::string(where) + " the oracle sees\n" + seen +
               "but where else the mesh has the same structure\n" + told(number) +
               "it sees\n" + known);
  } else if (const int other = number_of_.try_emplace(seen, number).first->second;
             told(other, Told::NoEdgesAtSource) != told(number, Told::NoEdgesAtSource)) {
    report(plane, p,
           std::string(where) + " the mesh has structure\n" + told(number) +
               "and elsewhere\n" + told(other) + "where the oracle sees in both\n" +
               seen);
  }
  return seen;
}

void MeshStructures::compare_class(const MeshPlane& plane, int face, const Flat& p) {
  const NaiveLight light = naive_.at(plane.lift(p), plane.normal()).light;
  const ShadowClass shadow = plane.mesh().faces[face].shadow;
  if (static_cast<int>(light) != static_cast<int>(shadow)) {
    report(plane, p,
           "class " + std::to_string(static_cast<int>(shadow)) + ", expected " +
               std::to_string(static_cast<int>(light)));
  }
}

void MeshStructures::look_at_faces(const MeshPlane& plane, const MeshSamples& samples) {
  const ShadowMesh& mesh = plane.mesh();
  std::vector<std::vector<int>> half_edges(mesh.faces.size());
  for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e) {
    if (plane.length(e) < kShort * plane.size()) continue;
    if (mesh.edges[e].left >= 0) half_edges[mesh.edges[e].left].push_back(2 * e);
    if (mesh.edges[e].right >= 0) half_edges[mesh.edges[e].right].push_back(2 * e + 1);
  }
  for (const int f :
       some_of(static_cast<int>(mesh.faces.size()), samples.faces, random_)) {
    if (half_edges[f].empty()) continue;
    ++counts_.faces;
    look_at_face(plane, f, half_edges[f], samples.points);
  }
}

// From a point of its boundary to where the boundary is met again.
void MeshStructures::look_at_face(const MeshPlane& plane, int face,
                                  const std::vector<int>& half_edges, int points) {
  for (int i = 0; i < points; ++i) {
    const int h = half_edges[random_() % half_edges.size()];
    const auto [from, left] = plane.edge_point(h / 2, 0.01 + 0.98 * unit(random_));
    const Flat across = h % 2 == 0 ? left : Flat(-left);
    // Another edge that is as good as there leaves no room for a face.
    const Flat step = 1e-9 * plane.size() * across;
    if (std::ranges::any_of(plane.crossings(from - step, from + step),
                            [&](const auto& c) { return c.edge != h / 2; })) {
      ++counts_.narrow;
      continue;
    }
    const double turn = 2.8 * (unit(random_) - 0.5);
    const Flat way = Eigen::Rotation2D<double>(turn) * across;
    const Flat p = from + 1e-10 * plane.size() * way;
    const Flat q = from + 3 * plane.size() * way;
    const auto met = plane.crossings(p, q);
    if (met.empty()) {
      report(plane, from, "a face without an end");
      continue;
    }
    const double reach = met[0].at * (q - p).norm();
    if (reach < 1e-8 * plane.size()) continue;  // at a corner
    const Flat at = p + (0.02 + 0.96 * unit(random_)) * met[0].at * (q - p);
    ++counts_.face_points;
    compare(plane, face, at, "in a face");
    if (i < 3) compare_class(plane, face, at);
  }
}

void MeshStructures::look_at_edges(const MeshPlane& plane, const MeshSamples& samples) {
  const int count = static_cast<int>(plane.mesh().edges.size());
  for (const int e : some_of(count, samples.edges, random_)) {
    if (plane.length(e) < kShort * plane.size()) continue;
    ++counts_.edges;
    look_at_edge(plane, e, samples.points);
  }
}

void MeshStructures::look_at_edge(const MeshPlane& plane, int edge, int points) {
  const ShadowMesh::Edge& e = plane.mesh().edges[edge];
  const double off = 1e-6 * plane.length(edge);
  for (int i = 0; i < points; ++i) {
    const auto [at, left] = plane.edge_point(edge, 0.01 + 0.98 * unit(random_));
    const auto met = plane.crossings(at - 2 * off * left, at + 2 * off * left);
    if (std::ranges::any_of(met, [&](const auto& c) { return c.edge != edge; })) {
      ++counts_.narrow;
      continue;
    }
    ++counts_.edge_points;
    std::string on_left, on_right;
    if (e.left >= 0) on_left = compare(plane, e.left, at + off * left, "left of an edge");
    if (e.right >= 0)
      on_right = compare(plane, e.right, at - off * left, "right of an edge");
    if (e.kind == ShadowEdgeKind::Boundary) continue;
    const int left_number = plane.mesh().faces[e.left].structure;
    const int right_number = plane.mesh().faces[e.right].structure;
    const bool changes = left_number != right_number;
    if (!changes && !may_change_nothing(e.kind)) report(plane, at, "a needless edge");
    if (changes != e.order.has_value())
      report(plane, at, "an order iff the structure changes");
    if (told(left_number, Told::NoEdgesAtSource) !=
            told(right_number, Told::NoEdgesAtSource) &&
        on_left == on_right)
      report(plane, at, "an edge along which the oracle sees no change");
  }
}

void MeshStructures::walk(const MeshPlane& plane) {
  const Flat extent = plane.high() - plane.low();
  const auto point = [&]() -> Flat {
    return plane.low() + extent.cwiseProduct(Flat(unit(random_), unit(random_)));
  };
  const Flat p = point(), q = point();
  const double length = (q - p).norm();
  const auto met = plane.crossings(p, q);
  if (met.size() < 2) return;
  ++counts_.segments;
  std::vector<Flat> places;
  for (const auto& c : met) places.emplace_back(p + c.at * (q - p));
  const double from = std::max(met.front().at, 0.0), to = met.back().at;
  std::string before;
  Flat last = p;
  bool there = false;
  for (int k = 0; k < 100; ++k) {
    const double t = from + (to - from) * (k + unit(random_)) / 100;
    const auto next = std::ranges::upper_bound(met, t, {}, &MeshPlane::Crossing::at);
    if (next == met.begin() || next == met.end()) continue;
    const auto here = next - 1;
    if (std::min(t - here->at, next->at - t) * length < kSamePlace * plane.size())
      continue;
    // Crossings in one place, in whatever order they came, have slivers between them.
    std::set<int> behind, ahead, both;
    for (const auto& c : met) {
      const ShadowMesh::Edge& e = plane.mesh().edges[c.edge];
      if (std::abs(c.at - here->at) * length < kSamePlace * plane.size())
        behind.insert(c.to_left ? e.left : e.right);
      if (std::abs(c.at - next->at) * length < kSamePlace * plane.size())
        ahead.insert(c.to_left ? e.right : e.left);
    }
    std::ranges::set_intersection(behind, ahead, std::inserter(both, both.end()));
    const Flat x = p + t * (q - p);
    if (both.empty()) {
      report(plane, x, "one face becomes another on the way");
      return;
    }
    if (both.size() > 1) continue;
    const int face = *both.begin();
    if (face < 0) {
      there = false;
      continue;
    }
    ++counts_.segment_points;
    const std::string seen = compare(plane, face, x, "on a segment");
    if (there && seen != before) find_change(plane, last, x, before, places);
    before = seen;
    last = x;
    there = true;
  }
}

// Somewhere between a, where `seen` is seen, and b it is not any more: at a crossing.
void MeshStructures::find_change(const MeshPlane& plane, Flat a, Flat b,
                                 const std::string& seen,
                                 const std::vector<Flat>& crossings) {
  ++counts_.changes;
  while ((b - a).norm() > 0.1 * kSamePlace * plane.size()) {
    const Flat middle = 0.5 * (a + b);
    (seen_at(plane, middle) == seen ? a : b) = middle;
  }
  for (const Flat& c : crossings) {
    if ((c - a).norm() < kSamePlace * plane.size()) return;
  }
  report(plane, a,
         "a change without an edge, from\n" + seen + "to\n" + seen_at(plane, b));
}

}  // namespace sightline::testing
