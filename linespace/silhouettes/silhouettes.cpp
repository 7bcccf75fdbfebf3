#include "linespace/silhouettes/silhouettes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <optional>

#include "linespace/scene/scene.h"
#include "linespace/scene/solid_index.h"
#include "linespace/silhouettes/rooms.h"
#include "linespace/work/parallel.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

Box box_of_face(const Scene& scene, int face) {
  std::vector<Point> points;
  for (const int p : scene.face_points(face)) points.push_back(scene.point(p));
  return box_of(points);
}

std::vector<Box> boxes_of_faces(const Scene& scene) {
  std::vector<Box> boxes;
  boxes.reserve(scene.faces().size());
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    hear_stop();
    boxes.push_back(box_of_face(scene, static_cast<int>(f)));
  }
  return boxes;
}

}  // namespace

InPlaneSide::InPlaneSide(const Scene& scene, int face) {
  const auto corners = scene.face_points(face);
  const Point& a = scene.point(corners[0]);
  const Point& b = scene.point(corners[1]);
  const Point& c = scene.point(corners[2]);
  const Point n = (b - a).cross(c - a);
  n.cwiseAbs().maxCoeff(&axis_);
  // The rounded normal only proposes the axis; take the first that really works.
  for (int tried = 0; tried < 3; ++tried, axis_ = (axis_ + 1) % 3) {
    orientation_ = Sign::Positive;
    orientation_ = (*this)(a, b, c);
    if (orientation_ != Sign::Zero) return;
  }
}

Sign InPlaneSide::operator()(const Point& p, const Point& q, const Point& x) const {
  // Any point above p on the axis spans the same plane with p and q: exactness does not
  // depend on which one.
  Point above = p;
  above[axis_] = p[axis_] > 0 ? -p[axis_] : (p[axis_] < 0 ? -p[axis_] : 1.0);
  const Sign s = orient3d(p, q, above, x);
  return (above[axis_] > p[axis_] ? s : -s) * orientation_;
}

PointInFace locate_in_plane(const Scene& scene, int face, const Point& x) {
  const InPlaneSide left_of(scene, face);
  const auto corners = scene.face_points(face);
  bool boundary = false;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point& p = scene.point(corners[k]);
    const Point& q = scene.point(corners[(k + 1) % corners.size()]);
    const Sign s = left_of(p, q, x);
    if (s == Sign::Negative) return PointInFace::Outside;
    if (s == Sign::Zero) boundary = true;
  }
  return boundary ? PointInFace::Boundary : PointInFace::Inside;
}

Rational InPlaneSide::value(const Point& p, const Point& q, const Point& x) const {
  const int i = (axis_ + 1) % 3;
  const int j = (axis_ + 2) % 3;
  return (Rational(q[i]) - Rational(p[i])) * (Rational(x[j]) - Rational(p[j])) -
         (Rational(q[j]) - Rational(p[j])) * (Rational(x[i]) - Rational(p[i]));
}

Silhouettes::Silhouettes(const Scene& scene, EventMode events, const Request& request)
    : Silhouettes(scene, events, request, Deadline(request)) {}

Silhouettes::Silhouettes(const Scene& scene, EventMode events, const Request& request,
                         const Deadline& deadline)
    : scene_(&scene),
      events_(events),
      face_tree_(std::vector<Box>{}),
      ridge_tree_(std::vector<Box>{}),
      blocker_tree_(std::vector<Box>{}) {
  Stage stage(request, "faces", deadline);
  face_boxes_ = boxes_of_faces(scene);
  face_tree_ = Bvh(face_boxes_);
  stage.begin("planes");
  face_planes_.reserve(scene.faces().size());
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    stage.at(f, scene.faces().size());
    face_planes_.emplace_back(face_plane_through(scene, static_cast<int>(f)));
  }
  object_starts_.assign(scene.points().size() + 1, 0);
  stage.begin("objects");
  for (std::size_t p = 0; p < scene.points().size(); ++p) {
    stage.at(p, scene.points().size());
    std::vector<std::int32_t> ids;
    for (const int e : scene.edges_at(static_cast<int>(p)))
      ids.push_back(scene.edges()[e].object);
    sort_unique(ids);
    object_ids_.insert(object_ids_.end(), ids.begin(), ids.end());
    object_starts_[p + 1] = static_cast<std::int32_t>(object_ids_.size());
  }
  find_object_boxes();
  find_convex_solids();
  find_rooms();
  find_shells();
  find_blockers();
  find_outlines();
  stage.begin("corners' faces");
  find_stars(request, stage);
  stage.begin("corners in solids");
  find_inside(request, stage);
  stage.begin("edges' faces");
  find_ridges(request, stage);
  find_touched_facets();
}

void Silhouettes::find_convex_solids() {
  const Scene& s = *scene_;
  convex_.assign(s.objects().size(), 0);
  std::vector<std::uint8_t> all_convex(s.objects().size(), 1);
  for (const Edge& e : s.edges()) {
    if (e.kind != EdgeKind::Convex) all_convex[e.object] = 0;
  }
  for (std::size_t o = 0; o < s.objects().size(); ++o) {
    const Object& object = s.objects()[o];
    if (object.convex) {
      convex_[o] = 1;
      continue;
    }
    // Folds by an ulp inside a facet do not count: every point lies behind every plane
    // but those of its own facets.
    if (!object.closed || !all_convex[o] || object.faces.size() > 400) continue;
    bool ok = true;
    for (std::size_t i = 0; i < object.faces.size() && ok; ++i) {
      const int f = object.faces[i];
      hear_stop_now();
      for (std::size_t j = 0; j < object.faces.size() && ok; ++j) {
        const int g = object.faces[j];
        if (s.faces()[g].facet == s.faces()[f].facet) continue;
        for (const int p : s.face_points(g)) {
          if (face_planes_[f](s.point(p)) != Sign::Positive) continue;
          const auto near = s.faces_at(p);
          ok = ok && std::any_of(near.begin(), near.end(), [&](int h) {
                 return s.faces()[h].facet == s.faces()[f].facet;
               });
        }
      }
    }
    convex_[o] = ok;
  }
}

void Silhouettes::find_rooms() {
  const auto objects = scene_->objects();
  for (const Scene::Hollow& hollow : scene_->hollows()) convex_[hollow.around] = 0;
  empty_room_.assign(objects.size(), 0);
  const auto is_room = [](const Object& object) { return object.inside_out; };
  if (std::none_of(objects.begin(), objects.end(), is_room)) return;
  empty_room_ = empty_rooms({*scene_, face_planes_, face_tree_, object_boxes_, convex_});
  for (std::size_t o = 0; o < objects.size(); ++o) {
    if (is_room(objects[o]) && empty_room_[o] == 0) convex_[o] = 0;
  }
}

void Silhouettes::find_shells() {
  DisjointSets sets(scene_->faces().size());
  for (const Edge& e : scene_->edges()) {
    if (e.sides.size() == 2) sets.unite(e.sides[0].face, e.sides[1].face);
  }
  for (const Facet& facet : scene_->facets()) {
    for (const int f : facet.faces) sets.unite(f, facet.faces[0]);
  }
  for (std::size_t f = 0; f < scene_->faces().size(); ++f) {
    shells_.push_back(static_cast<std::int32_t>(sets.find(static_cast<int>(f))));
  }
}

void Silhouettes::find_touched_facets() {
  touched_facets_.assign(scene_->facets().size(), 0);
  for (std::size_t e = 0; e < scene_->edges().size(); ++e) {
    const int ridge = ridge_of_edge_[e];
    if (ridge >= 0 && !ridges_[ridge].touched) continue;
    for (const Edge::Side& side : scene_->edges()[e].sides) {
      touched_facets_[scene_->faces()[side.face].facet] = 1;
    }
  }
}

void Silhouettes::find_outlines() {
  constexpr std::size_t kMostFaces = 64;  // larger facets are seldom convex
  const Scene& s = *scene_;
  outlines_.resize(s.facets().size());
  for (std::size_t i = 0; i < s.facets().size(); ++i) {
    hear_stop();
    const Facet& facet = s.facets()[i];
    if (!facet.planar || facet.faces.size() < 2 || facet.faces.size() > kMostFaces)
      continue;
    std::vector<std::array<std::int32_t, 2>> sides;
    for (const int f : facet.faces) {
      const auto c = s.face_points(f);
      for (std::size_t k = 0; k < c.size(); ++k)
        sides.push_back({c[k], c[(k + 1) % c.size()]});
    }
    std::sort(sides.begin(), sides.end());
    std::vector<std::array<std::int32_t, 2>> outline;
    for (const auto& side : sides) {
      if (!std::binary_search(sides.begin(), sides.end(),
                              std::array<std::int32_t, 2>{side[1], side[0]})) {
        outline.push_back(side);
      }
    }
    const InPlaneSide left_of(s, facet.faces[0]);
    const bool convex =
        std::all_of(outline.begin(), outline.end(), [&](const auto& side) {
          return std::all_of(outline.begin(), outline.end(), [&](const auto& other) {
            return left_of(s.point(side[0]), s.point(side[1]), s.point(other[0])) !=
                   Sign::Negative;
          });
        });
    if (convex) outlines_[i] = std::move(outline);
  }
}

void Silhouettes::find_object_boxes() {
  std::vector<Point> points;
  for (const Object& object : scene_->objects()) {
    hear_stop();
    points.clear();
    for (const int f : object.faces) {
      for (const int p : scene_->face_points(f)) points.push_back(scene_->point(p));
    }
    object_boxes_.push_back(points.empty() ? Box{} : box_of(points));
  }
}

void Silhouettes::find_blockers() {
  // Speed only: of solids with more faces most are far from a segment that meets the box.
  constexpr std::size_t kFewFaces = 32;
  const Scene& s = *scene_;
  std::vector<Box> boxes;
  for (std::size_t o = 0; o < s.objects().size(); ++o) {
    hear_stop();
    const auto& faces = s.objects()[o].faces;
    if (convex_[o] == 0 || faces.size() > kFewFaces) {
      for (const int f : faces) {
        blockers_.push_back(~f);
        boxes.push_back(face_boxes_[f]);
      }
      continue;
    }
    blockers_.push_back(static_cast<std::int32_t>(o));
    boxes.push_back(object_boxes_[o]);
  }
  blocker_tree_ = Bvh(boxes, 1);
}

void Silhouettes::find_inside(const Request& request, Stage& stage) {
  solids_ = std::make_shared<const SolidIndex>(*scene_);
  inside_.resize(stars_.size());
  for_each_of(0, stars_.size(), stars_.size(), request, stage, [&](std::size_t i) {
    inside_[i] =
        internal::in_material(*scene_, *solids_, scene_->point(stars_[i].point)) ? 1 : 0;
  });
}

std::span<const std::int32_t> Silhouettes::objects_of(const Generator& x) const {
  if (x.kind == GeneratorKind::Vertex) return objects_at(x.id);
  if (x.kind == GeneratorKind::Face) return {&scene_->facets()[x.id].object, 1};
  if (x.id < 0) return {};
  const int ridge = ridge_of_edge_[x.id];
  if (ridge >= 0) return ridges_[ridge].objects;
  return {&scene_->edges()[x.id].object, 1};
}

bool Silhouettes::in_material(const ExactPoint& p) const {
  return internal::in_material(*scene_, *solids_, p);
}

}  // namespace sightline::internal
