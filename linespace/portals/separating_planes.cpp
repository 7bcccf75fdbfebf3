// The conservative stabbing test by planes that separate two portals.

#include <CGAL/Gmpq.h>

#include <algorithm>
#include <array>
#include <vector>

#include "linespace/portals/portal.h"

namespace sightline {
namespace internal {

/// Half-spaces in which a line is after it has passed two portals: the front of each
/// plane.
struct PlanesState {
  std::vector<Portal> portals;
  std::vector<PlaneThrough> planes;
  bool maybe = true;
};

namespace {

using Q = CGAL::Gmpq;
using RationalPoint = std::array<Q, 3>;

RationalPoint rational(const Eigen::Vector3d& p) {
  return {Q(p.x()), Q(p.y()), Q(p.z())};
}

/// Cut to the closed front of a plane.
std::vector<RationalPoint> clipped(const std::vector<RationalPoint>& polygon,
                                   const PlaneThrough& plane) {
  const RingVector normal =
      cross(ring_difference(plane.b, plane.a), ring_difference(plane.c, plane.a));
  const std::array<Q, 3> n{Q(normal[0]), Q(normal[1]), Q(normal[2])};
  const Q offset(dot(normal, ring_point(plane.a)));
  std::vector<Q> height;
  for (const RationalPoint& p : polygon) {
    height.push_back(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - offset);
  }
  std::vector<RationalPoint> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    if (height[i] >= 0) out.push_back(polygon[i]);
    if (height[i] * height[j] < 0) {
      RationalPoint p;
      const Q t = height[i] / (height[i] - height[j]);
      for (int k = 0; k < 3; ++k)
        p[k] = polygon[i][k] + t * (polygon[j][k] - polygon[i][k]);
      out.push_back(p);
    }
  }
  return out;
}

/// Whether some part of the portal is in front of all planes.
bool reaches(const PlanesState& s, const Portal& portal) {
  std::vector<RationalPoint> left;
  for (const Eigen::Vector3d& v : portal.corners) left.push_back(rational(v));
  for (const PlaneThrough& plane : s.planes) {
    const PlaneSide side(plane);
    const auto behind = [&side](const auto& v) { return side(v) == Sign::Negative; };
    if (std::ranges::none_of(portal.corners, behind)) continue;
    left = clipped(left, plane);
    if (left.empty()) return false;
  }
  return true;
}

/// Turned so that `before` is behind the plane and `after` in front of it, both closed;
/// nullopt when it does not separate them so.
std::optional<PlaneThrough> separating(PlaneThrough plane, const Portal& before,
                                       const Portal& after) {
  const PlaneSide side(plane);
  bool turn = false, keep = false;
  const auto look = [&](const Portal& p, Sign wanted) {
    for (const Eigen::Vector3d& v : p.corners) {
      const Sign s = side(v);
      keep |= s == wanted;
      turn |= s == -wanted;
    }
  };
  look(before, Sign::Negative);
  look(after, Sign::Positive);
  if (turn == keep) return std::nullopt;  // neither: all in the plane
  if (turn) std::swap(plane.a, plane.b);
  return plane;
}

void add_planes(PlanesState& s, const Portal& before, const Portal& after) {
  const auto through = [&](const Portal& edges, const Portal& corners) {
    for (const LineThrough& e : edges.edges) {
      for (const Eigen::Vector3d& v : corners.corners) {
        if (collinear(e.from, e.to, v)) continue;
        if (auto plane = separating({e.from, e.to, v}, before, after)) {
          s.planes.push_back(*plane);
        }
      }
    }
  };
  through(before, after);
  through(after, before);
}

}  // namespace
}  // namespace internal

SeparatingPlanesSequence::SeparatingPlanesSequence()
    : state_(std::make_unique<internal::PlanesState>()) {}
SeparatingPlanesSequence::~SeparatingPlanesSequence() = default;
SeparatingPlanesSequence::SeparatingPlanesSequence(SeparatingPlanesSequence&&) noexcept =
    default;
SeparatingPlanesSequence& SeparatingPlanesSequence::operator=(
    SeparatingPlanesSequence&&) noexcept = default;

void SeparatingPlanesSequence::push(std::span<const Eigen::Vector3d> corners) {
  internal::PlanesState& s = *state_;
  const int index = static_cast<int>(s.portals.size());
  internal::Portal portal = internal::make_portal(corners, index);
  s.maybe = s.maybe && internal::reaches(s, portal);
  for (const internal::Portal& before : s.portals) {
    // A line may pass two portals that touch in one point, and then go anywhere.
    if (s.maybe && !internal::touch(before, portal)) {
      internal::add_planes(s, before, portal);
    }
  }
  s.portals.push_back(std::move(portal));
}

std::size_t SeparatingPlanesSequence::size() const { return state_->portals.size(); }
bool SeparatingPlanesSequence::maybe_stabbable() const { return state_->maybe; }

}  // namespace sightline
