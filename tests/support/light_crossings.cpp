#include "tests/support/light_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sightline::testing {
namespace {

using internal::Four;
using internal::LightTrace;
using internal::Ring;

// The points in which the lines of a family meet a plane: weighted, of degree 2 in s.
class PlaneTrace {
 public:
  PlaneTrace(const LightTrace& trace, const Eigen::Vector4d& plane) : plane_(plane) {
    // One scale for both ends.
    const auto rescale = [](const std::array<Four<Ring>, 2>& exact,
                            std::array<Eigen::Vector4d, 2>& points) {
      double size = 0;
      for (const auto& p : exact) {
        for (const Ring& r : p) size = std::max(size, std::abs(CGAL::to_double(r)));
      }
      for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < 4; ++i) {
          points[k][i] = CGAL::to_double(exact[k][i]) / size;
        }
      }
    };
    rescale(trace.first, x_);
    rescale(trace.last, y_);
  }
  [[nodiscard]] Eigen::Vector4d first(double s) const {
    return (1 - s) * x_[0] + s * x_[1];
  }
  [[nodiscard]] Eigen::Vector4d last(double s) const {
    return (1 - s) * y_[0] + s * y_[1];
  }
  [[nodiscard]] Eigen::Vector4d at(double s) const {
    const Eigen::Vector4d x = first(s);
    const Eigen::Vector4d y = last(s);
    return plane_.dot(y) * x - plane_.dot(x) * y;
  }

 private:
  Eigen::Vector4d plane_;
  std::array<Eigen::Vector4d, 2> x_, y_;
};

// Roots of the quadratic with these values at 0, 1/2, 1.
std::vector<double> roots(double at0, double at_half, double at1) {
  const double c = at0;
  const double a = 2 * (at0 + at1 - 2 * at_half);
  const double b = at1 - at0 - a;
  const double size = std::max({std::abs(at0), std::abs(at1), std::abs(at_half)});
  if (size == 0) return {};
  if (std::abs(a) < 1e-14 * size) {
    if (std::abs(b) < 1e-14 * size) return {};
    return {-c / b};
  }
  const double d = b * b - 4 * a * c;
  if (d < 0) return {-b / (2 * a)};
  const double q = -0.5 * (b + std::copysign(std::sqrt(d), b));
  if (q == 0) return {0.0};
  return {q / a, c / q};
}

// A plane as normal and offset, of length 1.
Eigen::Vector4d plane_of_face(const Scene& scene, int face) {
  const auto ids = scene.face_points(face);
  const Point normal = (scene.point(ids[1]) - scene.point(ids[0]))
                           .cross(scene.point(ids[2]) - scene.point(ids[0]))
                           .normalized();
  Eigen::Vector4d plane;
  plane << normal, -normal.dot(scene.point(ids[0]));
  return plane;
}

// The first edge of the scene on the line of this one.
int first_in_line(const Scene& scene, int edge) {
  const auto& [p, q] = scene.edges()[edge].points;
  for (int e = 0; e < edge; ++e) {
    const auto& [a, b] = scene.edges()[e].points;
    if (collinear(scene.point(p), scene.point(q), scene.point(a)) &&
        collinear(scene.point(p), scene.point(q), scene.point(b))) {
      return e;
    }
  }
  return edge;
}

}  // namespace

std::vector<double> foot_crossings(const Scene& scene, int facet, const Point& p,
                                   const Point& q) {
  const Eigen::Vector4d plane = plane_of_face(scene, scene.facets()[facet].faces[0]);
  const Point normal = plane.head<3>();
  const Point way = q - p;
  std::vector<double> out;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    if (scene.faces()[f].facet == facet) continue;
    const auto ids = scene.face_points(static_cast<int>(f));
    std::vector<Point> on;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      const Point a = scene.point(ids[k]);
      const Point b = scene.point(ids[(k + 1) % ids.size()]);
      const double at_a = normal.dot(a) + plane[3];
      const double at_b = normal.dot(b) + plane[3];
      if (at_a == 0) on.push_back(a);
      if (at_a * at_b < 0) on.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    for (std::size_t k = 0; k < on.size() && on.size() > 1; ++k) {
      const Point& a = on[k];
      const Point along = on[(k + 1) % on.size()] - a;
      const double turn = normal.dot(way.cross(along));
      if (turn == 0) continue;
      const double u = normal.dot((a - p).cross(along)) / turn;
      const double t = normal.dot((a - p).cross(way)) / turn;
      if (u >= 0 && u <= 1 && t >= -1e-9 && t <= 1 + 1e-9) out.push_back(u);
    }
  }
  std::ranges::sort(out);
  return out;
}

std::vector<double> light_crossings(const internal::LightSpace& space,
                                    const internal::LightEvents& events, int facet,
                                    const Point& p, const Point& q) {
  const Scene& scene = space.scene();
  const Eigen::Vector4d plane = plane_of_face(scene, scene.facets()[facet].faces[0]);
  const Point way = q - p;
  const Point across = plane.head<3>().cross(way);
  Eigen::Vector4d beside;
  beside << across, -across.dot(p);
  std::vector<double> out;
  const auto cross = [&](const Point& a, const Point& b) {
    const double at_a = across.dot(a - p);
    const double at_b = across.dot(b - p);
    if (at_a * at_b > 0 || at_a == at_b) return;
    const Point x = a + at_a / (at_a - at_b) * (b - a);
    const double u = (x - p).dot(way) / way.squaredNorm();
    if (u >= 0 && u <= 1) out.push_back(u);
  };
  for (const LightTrace& trace : events.traces) {
    if (trace.straight) {
      for (const LightTrace::Piece& piece : trace.pieces) {
        if (scene.faces()[piece.face].facet != facet) continue;
        cross(internal::light_point(piece.ends[0]).rounded,
              internal::light_point(piece.ends[1]).rounded);
      }
      continue;
    }
    const PlaneTrace at(trace, plane);
    const std::vector<double> found =
        roots(beside.dot(at.at(0)), beside.dot(at.at(0.5)), beside.dot(at.at(1)));
    for (const LightTrace::Piece& piece : trace.pieces) {
      if (scene.faces()[piece.face].facet != facet) continue;
      for (const double s : found) {
        if (s < piece.rounded[0] - 1e-9 || s > piece.rounded[1] + 1e-9) continue;
        const Eigen::Vector4d x = at.at(s);
        const Point hit = x.head<3>() / x[3];
        const double u = (hit - p).dot(way) / way.squaredNorm();
        if (u >= 0 && u <= 1) out.push_back(u);
      }
    }
  }
  std::ranges::sort(out);
  return out;
}

namespace {

// Whether the segment passes a face's inside with that much to spare: below 0 means that
// it may pass that far outside of it.
bool passes(const Scene& scene, int face, const Point& p, const Point& q, double spare) {
  const auto ids = scene.face_points(face);
  const Point a = scene.point(ids[0]);
  const Point normal =
      (scene.point(ids[1]) - a).cross(scene.point(ids[2]) - a).normalized();
  const double at_p = normal.dot(p - a);
  const double at_q = normal.dot(q - a);
  if (std::min(at_p, at_q) > -spare || std::max(at_p, at_q) < spare) return false;
  const Point x = p + at_p / (at_p - at_q) * (q - p);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const Point& b = scene.point(ids[k]);
    const Point& c = scene.point(ids[(k + 1) % ids.size()]);
    if (normal.cross((c - b).normalized()).dot(x - b) < spare) return false;
  }
  return true;
}

}  // namespace

int wrong_pieces(const internal::LightSpace& space, const internal::LightEvents& events) {
  const Scene& scene = space.scene();
  const double size = (scene.bounds()[1] - scene.bounds()[0]).norm();
  int wrong = 0;
  for (const LightTrace& trace : events.traces) {
    if (trace.generators.back().kind == internal::LightFeature::Kind::Horizon) continue;
    const internal::SourcePatch& patch = events.patches[trace.patch];
    const PlaneTrace on_source(trace, plane_of_face(scene, patch.faces[0]));
    for (const LightTrace::Piece& piece : trace.pieces) {
      const double s = 0.5 * (piece.rounded[0] + piece.rounded[1]);
      const PlaneTrace on_receiver(trace, plane_of_face(scene, piece.face));
      const Eigen::Vector4d p4 = on_receiver.at(s);
      const Eigen::Vector4d q4 = on_source.at(s);
      const Point p = p4.head<3>() / p4[3];
      const Point q = q4.head<3>() / q4[3];
      const Point way = q - p;
      // A little longer, so that both end faces are passed.
      const bool lit = std::ranges::any_of(patch.faces, [&](int f) {
        return passes(scene, f, p, q + 0.01 * way, -1e-10 * size);
      });
      // Both points that make the line lie on the way.
      const auto on_way = [&](const Eigen::Vector4d& x) {
        return (x.head<3>() / x[3] - p).dot(way) / way.squaredNorm();
      };
      const double first = on_way(on_source.first(s));
      const double last = on_way(on_source.last(s));
      const bool between = std::min(first, last) > -1e-9 &&
                           std::max(first, last) < 1 + 1e-9 &&
                           (trace.straight || first < last);
      bool right =
          lit && between && passes(scene, piece.face, p - 0.01 * way, q, -1e-10 * size);
      for (std::size_t f = 0; f < scene.faces().size() && right; ++f) {
        right = !passes(scene, static_cast<int>(f), p + 1e-9 * way, q - 1e-9 * way,
                        1e-9 * size);
      }
      wrong += right ? 0 : 1;
    }
  }
  return wrong;
}

std::string seen_structure(const PointViewIndex& index, const Scene& scene,
                           const std::vector<Point>& source,
                           const std::vector<int>& facets, int receiver,
                           const Point& eye) {
  const Eigen::Vector4d plane = plane_of_face(scene, scene.facets()[receiver].faces[0]);
  const auto on_horizon = [&](int edge) {
    const auto& ends = scene.edges()[edge].points;
    return std::ranges::all_of(
        ends, [&](int p) { return plane.head<3>().dot(scene.point(p)) + plane[3] == 0; });
  };
  const PointView view = index.view_through(eye_at(eye), source);
  const auto name = [&](int half_edge) -> std::string {
    const MapEdge& e = view.edges[half_edge / 2];
    if (e.line.edge >= 0 && on_horizon(e.line.edge)) return "h";
    if (e.line.edge >= 0) return "e" + std::to_string(first_in_line(scene, e.line.edge));
    if (e.line.facets[0] >= 0) {
      return "x" + std::to_string(e.line.facets[0]) + "," +
             std::to_string(e.line.facets[1]);
    }
    // A side of the window: the one whose line is nearest in the picture.
    const Point middle = (0.5 * (e.segment[0] + e.segment[1]) - eye).normalized();
    int best = 0;
    double least = 2;
    for (std::size_t k = 0; k < source.size(); ++k) {
      const Point n =
          (source[k] - eye).cross(source[(k + 1) % source.size()] - eye).normalized();
      if (std::abs(n.dot(middle)) < least) {
        least = std::abs(n.dot(middle));
        best = static_cast<int>(k);
      }
    }
    return "s" + std::to_string(best);
  };
  std::vector<std::string> cycles;
  for (const MapRegion& region : view.regions) {
    const bool lit = std::ranges::any_of(facets, [&](int f) {
      return std::ranges::find(region.facets, f) != region.facets.end();
    });
    if (!lit) continue;
    for (const std::vector<int>& walk : region.boundary) {
      std::vector<std::string> names;
      for (const int h : walk) {
        std::string n = name(h);
        if (names.empty() || names.back() != n) names.push_back(std::move(n));
      }
      if (names.size() > 1 && names.front() == names.back()) names.pop_back();
      std::string best;
      for (std::size_t k = 0; k < names.size(); ++k) {
        std::string text;
        for (std::size_t i = 0; i < names.size(); ++i) {
          text += names[(k + i) % names.size()] + " ";
        }
        if (best.empty() || text < best) best = text;
      }
      cycles.push_back(best);
    }
  }
  std::ranges::sort(cycles);
  std::string out;
  for (const std::string& c : cycles) out += "(" + c + ")";
  return out;
}

}  // namespace sightline::testing
