#include "linespace/picture/view_scene.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "linespace/picture/classes.h"
#include "linespace/picture/patches.h"
#include "linespace/sight/face_crossings.h"
#include "linespace/silhouettes/rooms.h"
#include "linespace/work/stage.h"

namespace sightline::internal {

SharedViewScene::SharedViewScene(const Scene& scene, const std::optional<BoxCut>& box,
                                 const Request& request)
    : scene_(&scene), silhouettes_(scene, EventMode::Solid, request), solids_(scene) {
  Stage stage(request, "what views share");
  add_lines();
  cut_and_cross(box);
  find_whole_lines();
  patches_ = find_patches(silhouettes_, [&](int object) {
    return !scene.objects()[object].closed || (cut_ && cut_->is_open(object));
  });
}

void SharedViewScene::add_lines() {
  const Scene& scene = *scene_;
  for (int e = 0; e < static_cast<int>(scene.edges().size()); ++e) {
    lines_.push_back({scene.edges()[e].points, {e, {-1, -1}}});
    edge_ids_.push_back(e);
  }
  std::ranges::stable_sort(edge_ids_, {}, [&](int e) { return scene.edges()[e].object; });
  edge_starts_.assign(scene.objects().size() + 1, 0);
  for (const Edge& e : scene.edges()) ++edge_starts_[e.object + 1];
  std::partial_sum(edge_starts_.begin(), edge_starts_.end(), edge_starts_.begin());
  // Flat sides at which a facet is bent, by their points.
  std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> flat_sides;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    const auto corners = scene.face_points(f);
    const int n = static_cast<int>(corners.size());
    for (int k = 0; k < n; ++k) {
      side_lines_.push_back(scene.edge_of_side(f, k));
      if (side_lines_.back() >= 0 || scene.facets()[scene.faces()[f].facet].planar)
        continue;
      flat_sides[std::minmax(corners[k], corners[(k + 1) % n])].emplace_back(f, k);
    }
  }
  for (const auto& [points, sides] : flat_sides) {
    const int facet = scene.faces()[sides.front().first].facet;
    for (const auto& [f, k] : sides) {
      side_lines_[scene.faces()[f].first_corner + k] = static_cast<int>(lines_.size());
    }
    lines_.push_back({{points.first, points.second}, {-1, {facet, facet}}});
  }
}

void SharedViewScene::cut_and_cross(const std::optional<BoxCut>& box) {
  const FaceCrossings crossings(silhouettes_);
  // Points of the scene at which others may be constructed.
  PointNumbers numbers(*scene_, constructed_);
  for (int p = 0; p < static_cast<int>(scene_->points().size()); ++p) {
    bool may_meet = !crossings.empty();
    for (int side = 0; box && side < BoxCut::kSides; ++side)
      may_meet |= box->within(side, scene_->point(p)) == Sign::Zero;
    if (may_meet) numbers.add(*scene_, p);
  }
  if (box) cut_.emplace(*scene_, *box, side_lines_, numbers, lines_);
  add_crossings(crossings, numbers);
}

void SharedViewScene::add_crossings(const FaceCrossings& crossings,
                                    PointNumbers& numbers) {
  const std::size_t n = scene_->faces().size();
  std::vector<std::vector<int>> of_face(crossings.empty() ? 0 : n);
  crossing_starts_.assign(n + 1, 0);
  for (std::uint32_t i = 0; i < crossings.count(); ++i) {
    const FaceCrossing& c = crossings.at(i);
    std::optional segment(c.segment);
    // In a side of the box the two faces end, and do not cross any more.
    if (cut_) segment = cut_->box().clip(c.segment);
    if (!segment || (cut_ && cut_->box().in_a_side(*segment))) continue;
    const auto facets =
        std::minmax(scene_->faces()[c.f].facet, scene_->faces()[c.h].facet);
    const int line = static_cast<int>(lines_.size());
    std::array<int, 2> ends{numbers.of((*segment)[0]), numbers.of((*segment)[1])};
    lines_.push_back({ends, {-1, {facets.first, facets.second}}, {c.f, c.h}});
    of_face[c.f].push_back(line);
    of_face[c.h].push_back(line);
  }
  for (std::size_t f = 0; f < n; ++f) {
    if (!of_face.empty()) {
      crossing_lines_.insert(crossing_lines_.end(), of_face[f].begin(), of_face[f].end());
    }
    crossing_starts_[f + 1] = static_cast<int>(crossing_lines_.size());
  }
}

void SharedViewScene::find_whole_lines() {
  const auto is_left = [&](int line) { return lines_[line].ends[0] >= 0; };
  std::vector<Box> boxes;
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    const auto [a, b] = lines_[line].ends;
    boxes.push_back(is_left(line) ? box_of(std::array{position(a), position(b)}) : Box{});
  }
  const Bvh tree(boxes);
  Classes classes(lines_.size());
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    hear_stop();
    if (!is_left(line)) continue;
    for (const int end : lines_[line].ends) {
      const Point p = position(end);
      // Where points are constructed boxes are rounded, too.
      const double slack = constructed_.empty() ? 0 : 4 * kUnit * p.cwiseAbs().maxCoeff();
      const auto holds = [&](const Box& box) {
        for (int i = 0; i < 3; ++i) {
          if (p[i] < box.min[i] - slack || p[i] > box.max[i] + slack) return false;
        }
        return true;
      };
      tree.traverse(holds, [&](std::uint32_t item) {
        const int other = static_cast<int>(item);
        if (!is_left(other)) return;
        if (other < line && holds(boxes[item]) && on_one_line(line, other))
          classes.join(line, other);
        if (other > line && holds(boxes[item]) && on_one_line(other, line))
          classes.join(line, other);
      });
    }
  }
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    whole_lines_.push_back(classes.root(line));
  }
}

std::span<const int> SharedViewScene::crossings_of(int face) const {
  return std::span(crossing_lines_)
      .subspan(crossing_starts_[face],
               crossing_starts_[face + 1] - crossing_starts_[face]);
}

Rational SharedViewScene::exact_plane_value(int face, const ExactPoint& p) const {
  const auto t = plane_points(*scene_, face);
  return exact_orient(exact_point(scene_->point(t[0])), exact_point(scene_->point(t[1])),
                      exact_point(scene_->point(t[2])), p);
}

Sign SharedViewScene::plane_side(int face, int point) const {
  if (!is_constructed(point)) return silhouettes_.face_plane(face)(scene_->point(point));
  return static_cast<Sign>(exact_plane_value(face, exact(point)).sign());
}

std::vector<int> SharedViewScene::material_at(const ExactPoint& p) const {
  std::vector<int> objects = internal::material_at(*scene_, solids_, p);
  if (cut_) std::erase_if(objects, [&](int object) { return cut_->is_open(object); });
  return objects;
}

bool SharedViewScene::has_one_facet(int line) const {
  const int edge = lines_[line].name.edge;
  if (edge < 0) return false;
  return scene_->edges()[edge].sides.size() == 1 ||
         (cut_ && cut_->leaves_one_facet(edge));
}

bool SharedViewScene::in_line(int a, int b, int p) const {
  if (p == a || p == b) return true;
  if (!is_constructed(a) && !is_constructed(b) && !is_constructed(p)) {
    return collinear(scene_->point(a), scene_->point(b), scene_->point(p));
  }
  const ExactPoint at = exact(a);
  return exact_cross(exact_difference(exact(b), at), exact_difference(exact(p), at)) ==
         ExactPoint{};
}

bool SharedViewScene::on_one_line(int line, int other) const {
  const auto [a, b] = lines_[line].ends;
  const auto [c, d] = lines_[other].ends;
  return line == other || (in_line(a, b, c) && in_line(a, b, d));
}

ViewScene ViewScene::with_window(std::span<const Point> corners) const {
  const int first = shared_->point_count(), n = static_cast<int>(corners.size());
  std::vector<ExactPoint> points;
  std::vector<std::array<int, 2>> sides;
  for (int k = 0; k < n; ++k) {
    points.push_back(exact_point(corners[k]));
    sides.push_back({first + k, first + (k + 1) % n});
  }
  ViewScene scene(*this);
  scene.added_points_.clear();
  scene.added_lines_.clear();
  return scene.with_lines(std::move(points), sides);
}

ViewScene ViewScene::with_lines(std::vector<ExactPoint> points,
                                std::span<const std::array<int, 2>> lines) const {
  ViewScene scene(*this);
  std::ranges::move(points, std::back_inserter(scene.added_points_));
  for (const auto& ends : lines) scene.added_lines_.push_back({ends, {}});
  return scene;
}

bool ViewScene::in_line(int a, int b, int p) const {
  const int n = shared_->point_count();
  if (a < n && b < n && p < n) return shared_->in_line(a, b, p);
  const ExactPoint at = exact(a);
  return exact_cross(exact_difference(exact(b), at), exact_difference(exact(p), at)) ==
         ExactPoint{};
}

bool ViewScene::on_one_line(int line, int other) const {
  if (line == other) return true;
  const auto [a, b] = lines()[line].ends;
  const auto [c, d] = lines()[other].ends;
  return in_line(a, b, c) && in_line(a, b, d);
}

}  // namespace sightline::internal
