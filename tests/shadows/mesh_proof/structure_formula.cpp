#include "tests/shadows/mesh_proof/structure_formula.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sightline::testing {
namespace {

using Long = std::array<long double, 3>;

Long operator-(const Long& a, const Long& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Long operator*(long double s, const Long& a) { return {s * a[0], s * a[1], s * a[2]}; }
long double dot_of(const Long& a, const Long& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Long cross_of(const Long& a, const Long& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0]};
}
Long unit(const Long& a) { return (1 / std::sqrt(dot_of(a, a))) * a; }
Long rounded(const Vec3& v) {
  return {static_cast<long double>(v[0]), static_cast<long double>(v[1]),
          static_cast<long double>(v[2])};
}

Vec3 way_of(const NaiveSideName& name) {
  return name.kind == NaiveSideName::Kind::Cut ? name.ends[1]
                                               : name.ends[1] - name.ends[0];
}

// Where two lines of one plane meet.
std::optional<Vec3> meeting_of(const NaiveSideName& s, const NaiveSideName& t) {
  const Vec3 u = way_of(s), v = way_of(t), across = cross(u, v),
             to = t.ends[0] - s.ends[0];
  if (is_zero(across) || dot(across, to) != 0) return std::nullopt;
  return s.ends[0] + Rational(dot(cross(to, v), across) / dot(across, across)) * u;
}

}  // namespace

Long StructureFormula::plane(const Side& side, const Long& p, const Long& normal) {
  return side.horizon ? normal : unit(cross_of(side.a - p, side.way));
}

Long StructureFormula::ray(const Side& side, const Long& before, const Long& own,
                           const Long& p) {
  switch (side.corner) {
    case Side::Corner::Point:
      return side.meeting - p;
    case Side::Corner::Direction:
      return side.way;
    case Side::Corner::Planes:
      break;
  }
  return cross_of(before, own);
}

// Fixes the signs at a point from which the boundary is seen.
bool StructureFormula::orient(std::vector<Side>& boundary, const Long& p,
                              const Long& towards) {
  const std::size_t n = boundary.size();
  std::vector<Long> planes, rays;
  for (const Side& s : boundary) planes.push_back(plane(s, p, normal_));
  for (std::size_t k = 0; k < n; ++k) {
    const Long to = ray(boundary[k], planes[(k + n - 1) % n], planes[k], p);
    if (dot_of(to, to) < 1e-24L) return false;
    boundary[k].reach = dot_of(to, towards) < 0 ? -1 : 1;
    rays.push_back(boundary[k].reach * unit(to));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Long across = cross_of(rays[k], rays[(k + 1) % n]);
    boundary[k].turn = dot_of(across, planes[k]) < 0 ? -1 : 1;
  }
  return true;
}

long double StructureFormula::sum(const std::vector<Side>& boundary,
                                  const Long& p) const {
  const std::size_t n = boundary.size();
  std::vector<Long> planes, rays;
  for (const Side& s : boundary) planes.push_back(plane(s, p, normal_));
  for (std::size_t k = 0; k < n; ++k)
    rays.push_back(boundary[k].reach *
                   unit(ray(boundary[k], planes[(k + n - 1) % n], planes[k], p)));
  long double result = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Long& next = rays[(k + 1) % n];
    const Long across = boundary[k].turn * planes[k];
    const long double angle =
        std::atan2(dot_of(cross_of(rays[k], next), across), dot_of(rays[k], next));
    result += angle * dot_of(across, normal_);
  }
  return result / (2 * std::numbers::pi_v<long double>);
}

long double StructureFormula::operator()(const Vec3& p) const {
  long double result = 0;
  for (const auto& boundary : boundaries_) result += sum(boundary, rounded(p));
  return sign_ * result;
}

std::optional<StructureFormula> StructureFormula::at(
    std::span<const NaiveShadowFace> faces, const NaiveShadow& naive, const Vec3& p,
    const Vec3& normal) {
  StructureFormula result;
  result.normal_ = unit(rounded(normal));
  for (const NaiveSeenSource& source : naive.structure(p, normal)) {
    const auto face =
        std::ranges::find(faces, source.polygons[0], &NaiveShadowFace::polygon);
    const Long towards = rounded(face->corners[0] - p);
    Long up = unit(rounded(
        cross(face->corners[1] - face->corners[0], face->corners[2] - face->corners[0])));
    if (dot_of(up, towards) < 0) up = -1.0L * up;
    for (std::size_t b = 0; b < source.boundaries.size(); ++b) {
      std::vector<Side> boundary;
      const auto& names = source.boundaries[b];
      for (std::size_t k = 0; k < source.boundaries[b].size(); ++k) {
        if (source.corners[b][k].straight) return std::nullopt;
        const NaiveSideName& name = source.boundaries[b][k].front();
        Side side{
            .horizon = name.kind == NaiveSideName::Kind::Horizon, .a = {}, .way = {}};
        side.a = rounded(name.ends[0]);
        side.way = rounded(way_of(name));
        const NaiveSideName& last = names[(k + names.size() - 1) % names.size()].front();
        const bool lines = !side.horizon && last.kind != NaiveSideName::Kind::Horizon;
        if (lines) {
          if (const auto x = meeting_of(last, name)) {
            side.corner = Side::Corner::Point;
            side.meeting = rounded(*x);
          } else if (is_zero(cross(way_of(last), way_of(name)))) {
            side.corner = Side::Corner::Direction;
          }
        }
        boundary.push_back(side);
      }
      if (!result.orient(boundary, rounded(p), up)) return std::nullopt;
      result.boundaries_.push_back(std::move(boundary));
    }
  }
  const long double right = *naive.at(p, normal).form_factor;
  if (result(p) < 0) result.sign_ = -1;
  if (std::abs(result(p) - right) > 1e-14L) return std::nullopt;
  return result;
}

}  // namespace sightline::testing
