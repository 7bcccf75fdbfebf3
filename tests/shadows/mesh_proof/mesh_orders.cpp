#include "tests/shadows/mesh_proof/mesh_orders.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <sstream>

#include "tests/shadows/mesh_proof/structure_formula.h"

namespace sightline::testing {
namespace {

constexpr double kSlack = 0.1;

// Slope of the best line through (x, y).
double slope_of(const std::vector<std::array<double, 2>>& at) {
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [u, v] : at) {
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  const auto n = static_cast<double>(at.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

class Orders {
 public:
  Orders(const ShadowScene& lit, std::uint64_t seed)
      : name_(lit.name),
        scene_(lit.soup),
        faces_(naive_shadow_faces(scene_, faces_of_groups(scene_, lit.lights),
                                  faces_of_groups(scene_, lit.two_sided))),
        naive_(faces_),
        random_(seed) {
    std::vector<Receiver> receivers;
    for (const Object& o : scene_.objects()) receivers.push_back({o.name, o.faces, true});
    shadows_ =
        find_shadows(scene_, light_source(scene_, lit.lights, lit.two_sided), receivers);
  }

  EdgeOrders find(int edges, int points) {
    std::vector<std::pair<const ShadowMesh*, int>> all;
    for (const ReceiverShadows& r : shadows_.receivers) {
      for (const ShadowMesh& mesh : r.meshes) {
        for (int e = 0; e < static_cast<int>(mesh.edges.size()); ++e) {
          // What is in line with the horizon changes no irradiance.
          const bool at_horizon = std::ranges::any_of(
              mesh.edges[e].generators,
              [](const std::string& g) { return g.starts_with("horizon"); });
          if (mesh.edges[e].order.value_or(0) > 0 && !at_horizon)
            all.emplace_back(&mesh, e);
        }
      }
    }
    std::ranges::shuffle(all, random_);
    for (const auto& [mesh, e] : all) {
      if (out_.edges >= edges || out_.differences.size() >= 10) break;
      const MeshPlane plane(scene_, faces_, *mesh, true);
      if (plane.length(e) < 1e-3 * plane.size()) continue;
      const int before = out_.points;
      for (int i = 0; i < points; ++i) look(plane, e);
      if (out_.points == before) continue;
      ++out_.edges;
      ++out_.by_kind[static_cast<int>(mesh->edges[e].kind)];
    }
    return out_;
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  // How far the face beyond the edge reaches.
  static double reach(const MeshPlane& plane, const Flat& from, const Flat& way) {
    const Flat p = from + 1e-10 * plane.size() * way, q = from + 3 * plane.size() * way;
    const auto met = plane.crossings(p, q);
    return met.empty() ? 0 : met[0].at * (q - p).norm();
  }

  void look(const MeshPlane& plane, int edge) {
    const auto [at, left] = plane.edge_point(edge, 0.05 + 0.9 * unit());
    const Flat across = random_() % 2 == 0 ? left : Flat(-left);
    const double here = reach(plane, at, -across), there = reach(plane, at, across);
    if (std::min(here, there) < 1e-3 * plane.size()) {
      ++out_.left_out;
      return;
    }
    const auto formula = StructureFormula::at(
        faces_, naive_, plane.lift(at - 0x1p-8 * here * across), plane.normal());
    if (!formula) {
      ++out_.left_out;
      return;
    }
    std::vector<std::array<double, 2>> points;
    for (int k = 4; k <= 12; ++k) {
      const Vec3 p = plane.lift(at + std::ldexp(there, -k) * across);
      const long double off = (*formula)(p) - *naive_.at(p, plane.normal()).form_factor;
      points.push_back(
          {static_cast<double>(-k), static_cast<double>(std::log2(std::abs(off)))});
    }
    ++out_.points;
    // Terms of higher order are still felt at the larger distances.
    const double power = slope_of({points.begin() + 4, points.end()});
    const ShadowMesh::Edge& e = plane.mesh().edges[edge];
    const double off = std::abs(power - *e.order);
    if (off < kSlack) {
      out_.most_off = std::max(out_.most_off, off);
      return;
    }
    std::ostringstream out;
    out.precision(17);
    const auto& frame = plane.mesh().frame;
    out << name_ << ", facet " << plane.mesh().facet << " at "
        << (frame.origin + at[0] * frame.x_axis + at[1] * frame.y_axis).transpose()
        << ": power " << power << " across an edge of kind " << static_cast<int>(e.kind);
    for (const std::string& g : e.generators) out << ", " << g;
    out << "; logarithms";
    for (const auto& [x, y] : points) out << ' ' << std::round(100 * y) / 100;
    out_.differences.push_back(out.str());
  }

  std::string name_;
  Scene scene_;
  std::vector<NaiveShadowFace> faces_;
  NaiveShadow naive_;
  Shadows shadows_;
  std::mt19937_64 random_;
  EdgeOrders out_;
};

}  // namespace

EdgeOrders& EdgeOrders::operator+=(const EdgeOrders& more) {
  edges += more.edges;
  points += more.points;
  left_out += more.left_out;
  most_off = std::max(most_off, more.most_off);
  for (int k = 0; k < kShadowEdgeKinds; ++k) by_kind[k] += more.by_kind[k];
  return *this;
}

std::ostream& operator<<(std::ostream& out, const EdgeOrders& orders) {
  out << orders.edges << " edges, " << orders.points << " points, " << orders.left_out
      << " left out; powers off by at most " << orders.most_off << "; by kind";
  for (const int n : orders.by_kind) out << ' ' << n;
  return out;
}

EdgeOrders edge_orders(const ShadowScene& lit, int edges, int points,
                       std::uint64_t seed) {
  return Orders(lit, seed).find(edges, points);
}

}  // namespace sightline::testing
