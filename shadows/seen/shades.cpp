#include "shadows/seen/shades.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace sightline::internal {
namespace {

// Relative margin: far above what a dozen roundings of coordinates do.
constexpr double kMargin = 0x1p-36;

// The cone from a point over the hull of a plane's faces, cut off at that plane.
class Cone {
 public:
  Cone(const SourcePlane& plane, const Point& apex) {
    const auto& hull = plane.hull;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const Point &a = hull[k], &b = hull[(k + 1) % hull.size()];
      // Counter-clockwise as the apex sees it: inside is where this is negative.
      add_plane(apex, a, b, a, 1);
    }
    for (std::size_t k = 2; k < hull.size(); ++k) {
      if (add_plane(hull[0], hull[k - 1], hull[k], hull[0], -1) &&
          add_plane(hull[0], hull[k - 1], hull[k], apex, 1)) {
        break;
      }
    }
  }

  [[nodiscard]] bool misses(const Box& box) const {
    for (const auto& [normal, point, size] : planes_) {
      double least = 0, extent = size;
      for (int i = 0; i < 3; ++i) {
        const double x = normal[i] > 0 ? box.min[i] : box.max[i];
        least += normal[i] * (x - point[i]);
        extent += std::abs(x);
      }
      if (least > kMargin * extent) return true;
    }
    return false;
  }

 private:
  struct HalfSpace {
    Eigen::Vector3d normal;  // outwards, of length 1
    Point point;
    double size;  // of its coordinates
  };

  // The half-space of the plane parallel to o, a, b through the point `at`.  False, and
  // nothing bounded, where rounding of the corners may turn the normal by more than
  // misses() allows for: the eye may be far away and see the plane all but edge-on.
  bool add_plane(const Point& o, const Point& a, const Point& b, const Point& at,
                 double sign) {
    const Eigen::Vector3d u = a - o, v = b - o, normal = u.cross(v);
    constexpr double kRounding = 0x1p-51;
    const double size = o.cwiseAbs().sum() + a.cwiseAbs().sum() + b.cwiseAbs().sum();
    const double off = kRounding * (size * (u.norm() + v.norm()) + u.norm() * v.norm());
    const double length = normal.norm();
    if (!(off < kMargin / 4 * length)) return false;
    planes_.push_back({sign / length * normal, at, at.cwiseAbs().sum()});
    return true;
  }

  std::vector<HalfSpace> planes_;
};

// The part of a face before the source's plane; sides: of its corners, some before the
// plane and some beyond it.
HidingFace cut_face(const SourceScene& source, const SourcePlane& plane, int face,
                    const std::vector<Sign>& sides) {
  const auto corners = source.scene().scene().face_points(face);
  const auto n = static_cast<int>(corners.size());
  HidingFace hiding{.face = face};
  const auto crossing = [&](int p, int q) { return source.crossing(plane, p, q); };
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    const bool goes_on = sides[next] != Sign::Negative;
    if (sides[k] == Sign::Negative) {
      if (sides[next] == Sign::Positive) {
        hiding.cut[1] = crossing(corners[k], corners[next]);
        hiding.part.push_back({HidingFace::kEntering, k});
      } else if (sides[next] == Sign::Zero) {
        hiding.cut_ends[1] = corners[next];
      }
      continue;
    }
    const bool leaves_here = !goes_on && sides[k] == Sign::Zero;
    hiding.part.push_back({corners[k], leaves_here ? -1 : k});
    if (leaves_here) hiding.cut_ends[0] = corners[k];
    if (goes_on || leaves_here) continue;
    hiding.cut[0] = crossing(corners[k], corners[next]);
    hiding.part.push_back({HidingFace::kLeaving, -1});
  }
  return hiding;
}

}  // namespace

std::vector<HidingFace> find_hiding_faces(const SourceScene& source,
                                          const SourcePlane& plane,
                                          const Point& rounded_point) {
  const ViewScene& view = source.scene();
  const Scene& scene = view.scene();
  const Cone cone(plane, rounded_point);
  std::vector<HidingFace> hiding_faces;
  const auto visit = [&](std::uint32_t item) {
    const int face = static_cast<int>(item);
    if (cone.misses(view.silhouettes().face_box(face))) return;
    const auto corners = scene.face_points(face);
    std::vector<Sign> sides;
    bool before = false, beyond = false;
    for (const int c : scene.face_points(face)) {
      sides.push_back(source.side(plane, c));
      before |= sides.back() == Sign::Positive;
      beyond |= sides.back() == Sign::Negative;
    }
    if (!before) return;
    hiding_faces.push_back(beyond ? cut_face(source, plane, face, sides)
                                  : HidingFace{.face = face});
  };
  view.silhouettes().face_tree().traverse(
      [&](const Box& box) { return !cone.misses(box); }, visit);
  std::ranges::sort(hiding_faces, {}, &HidingFace::face);
  return hiding_faces;
}

Shade ShadeMaker::of_face(int face) const {
  const auto corners = eye_->scene().scene().face_points(face);
  const bool front = eye_->front(face) == Sign::Positive;
  Shade shade;
  const auto n = static_cast<int>(corners.size());
  for (int k = 0; k < n; ++k) {
    const int p = corners[k], q = corners[(k + 1) % n];
    shade.sides.push_back({front ? std::array{p, q} : std::array{q, p},
                           eye_->scene().line_of_side(face, k)});
  }
  return shade;
}

Shade ShadeMaker::of_part(const HidingFace& hiding, int cut_point, int cut_line) const {
  const bool front = eye_->front(hiding.face) == Sign::Positive;
  const auto number = [&](const HidingFace::Corner& c) {
    return c.point >= 0 ? c.point : cut_point + (c.point == HidingFace::kLeaving ? 0 : 1);
  };
  Shade shade;
  const std::size_t n = hiding.part.size();
  for (std::size_t k = 0; k < n; ++k) {
    const HidingFace::Corner& corner = hiding.part[k];
    const std::array<int, 2> ends{number(corner), number(hiding.part[(k + 1) % n])};
    shade.sides.push_back({front ? ends : std::array{ends[1], ends[0]},
                           corner.side < 0
                               ? cut_line
                               : eye_->scene().line_of_side(hiding.face, corner.side)});
  }
  return shade;
}

// From outside a convex solid its outline is that of its fronts together.  nullopt for a
// solid that reaches beyond the source's plane, for an eye that sees no front, and for
// one that stands in the fold of a facet bent by rounding.
std::optional<Shade> ShadeMaker::of_solid(int object) const {
  const ViewScene& view = eye_->scene();
  const Scene& scene = view.scene();
  bool any = false, bent = false;
  for (const int f : scene.objects()[object].faces) {
    bent |= !scene.facets()[scene.faces()[f].facet].planar;
    const int first = scene.facets()[scene.faces()[f].facet].faces.front();
    if (eye_->front(f) != eye_->front(first)) return std::nullopt;
    any |= eye_->front(f) == Sign::Positive;
  }
  if (!any) return std::nullopt;
  Shade shade;
  for (const int e : view.edges_of(object)) {
    const Edge& edge = scene.edges()[e];
    if (edge.sides.size() != 2) return std::nullopt;
    for (const int p : edge.points) {
      if (source_->side(*plane_, p) == Sign::Negative) return std::nullopt;
    }
    const auto [f, h] = std::pair(edge.sides[0], edge.sides[1]);
    const Sign at_f = eye_->front(f.face), at_h = eye_->front(h.face);
    if ((at_f == Sign::Positive) != (at_h == Sign::Positive)) {
      const bool forward = at_f == Sign::Positive ? f.forward : h.forward;
      shade.sides.push_back(
          {{edge.points[forward ? 0 : 1], edge.points[forward ? 1 : 0]}, e});
    } else if (all_lines_ && at_f != at_h) {
      shade.further_lines.push_back(e);
    }
  }
  // From very near to a facet that rounding has bent the outline is not convex.
  if (bent && !is_convex(shade)) return std::nullopt;
  return shade;
}

bool ShadeMaker::is_convex(const Shade& shade) const {
  return std::ranges::all_of(shade.sides, [&](const Shade::Side& side) {
    return std::ranges::all_of(shade.sides, [&](const Shade::Side& other) {
      return eye_->orient(side.ends[0], side.ends[1], other.ends[0]) != Sign::Negative;
    });
  });
}

std::vector<Shade> ShadeMaker::shades(const std::vector<HidingFace>& hiding_faces,
                                      int first_cut_point, int first_cut_line) const {
  const ViewScene& view = eye_->scene();
  const Scene& scene = view.scene();
  // Solids of which a face is cut are asked face by face.
  std::map<int, bool> whole;
  for (const HidingFace& b : hiding_faces) {
    const int object = scene.faces()[b.face].object;
    if (!view.silhouettes().convex_solid(object)) continue;
    const auto it = whole.try_emplace(object, true).first;
    it->second = it->second && b.part.empty();
  }
  std::map<int, bool> done;  // solids, and whether their shade is one
  std::vector<Shade> shades;
  int cuts = 0;
  for (const HidingFace& b : hiding_faces) {
    const int number = b.part.empty() ? -1 : cuts++;
    if (eye_->front(b.face) == Sign::Zero) continue;
    const int object = scene.faces()[b.face].object;
    if (const auto it = whole.find(object); it != whole.end() && it->second) {
      const auto [entry, is_new] = done.try_emplace(object, false);
      if (is_new) {
        if (auto solid = of_solid(object)) {
          entry->second = true;
          shades.push_back(std::move(*solid));
        }
      }
      if (entry->second) continue;
    }
    shades.push_back(
        number < 0 ? of_face(b.face)
                   : of_part(b, first_cut_point + 2 * number, first_cut_line + number));
  }
  return shades;
}

}  // namespace sightline::internal
