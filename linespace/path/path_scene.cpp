#include "linespace/path/path_scene.h"

#include <algorithm>

#include "linespace/space/bvh.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

PathScene::PathScene(const ViewScene& scene, double size) : scene_(&scene), size_(size) {
  add_lines();
  add_touches();
  points_on_.resize(lines_.size());
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    auto& through = points_[p].lines;
    std::ranges::sort(through);
    through.erase(std::ranges::unique(through).begin(), through.end());
    for (const int line : through) points_on_[line].push_back(p);
  }
}

void PathScene::add_lines() {
  const auto n = static_cast<int>(scene_->lines().size());
  for (int line = 0; line < n; ++line) {
    const auto [a, b] = scene_->lines()[line].ends;
    lines_.push_back({{scene_->exact(a), scene_->position(a)},
                      {scene_->exact(b), scene_->position(b)}});
    named_[scene_->lines()[line].name].push_back(line);
  }
  ranges_.assign(lines_.size(), {0, 1});
  for (int line = 0; line < n; ++line) {
    const int whole = scene_->whole_line(line);
    const Point from = lines_[whole].a.rounded;
    const Eigen::Vector3d way = lines_[whole].b.rounded - from;
    for (const PathPoint* end : {&lines_[line].a, &lines_[line].b}) {
      const double t = way.dot(end->rounded - from) / way.squaredNorm();
      ranges_[whole][0] = std::min(ranges_[whole][0], t);
      ranges_[whole][1] = std::max(ranges_[whole][1], t);
    }
  }
}

int PathScene::add_point(const ExactPoint& p, int id,
                         std::map<ExactPoint, int>& numbers) {
  const auto [it, is_new] = numbers.emplace(p, static_cast<int>(points_.size()));
  if (is_new) points_.push_back({{p, rounded(p)}, id, {}});
  return it->second;
}

void PathScene::add_touches() {
  std::map<ExactPoint, int> numbers;
  point_of_.assign(scene_->scene().points().size(), -1);
  std::vector<Box> boxes;
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    for (const int end : scene_->lines()[line].ends) {
      const int id = scene_->is_constructed(end) ? -1 : end;
      const int p = add_point(scene_->exact(end), id, numbers);
      points_[p].lines.push_back(line);
      if (id >= 0) point_of_[id] = p;
    }
    boxes.push_back(box_of(std::array{lines_[line].a.rounded, lines_[line].b.rounded}));
  }
  // Constructed ends are rounded.
  const double slack = 0x1p-48 * size_;
  const Bvh tree(boxes);
  for (int line = 0; line < static_cast<int>(lines_.size()); ++line) {
    hear_stop();
    const auto meets = [&](const Box& box) {
      for (int i = 0; i < 3; ++i) {
        if (boxes[line].min[i] > box.max[i] + slack ||
            boxes[line].max[i] < box.min[i] - slack) {
          return false;
        }
      }
      return true;
    };
    tree.traverse(meets, [&](std::uint32_t other) {
      if (static_cast<int>(other) > line && meets(boxes[other]))
        touch(line, static_cast<int>(other), numbers);
    });
  }
}

// Adds the point in which two lines cross in space, if they do.
void PathScene::touch(int line, int other, std::map<ExactPoint, int>& numbers) {
  const PathLine &l = lines_[line], &m = lines_[other];
  const ExactPoint u = exact_difference(l.b.exact, l.a.exact);
  const ExactPoint v = exact_difference(m.b.exact, m.a.exact);
  const ExactPoint between = exact_difference(m.a.exact, l.a.exact);
  const ExactPoint n = exact_cross(u, v);
  if (exact_dot(between, n) != 0) return;
  const Rational squared = exact_dot(n, n);
  if (squared == 0) return;
  const Rational t = exact_dot(exact_cross(between, v), n) / squared;
  const Rational s = exact_dot(exact_cross(between, u), n) / squared;
  if (t < 0 || t > 1 || s < 0 || s > 1) return;
  auto& through = points_[add_point(along(l.a.exact, l.b.exact, t), -1, numbers)].lines;
  through.push_back(line);
  through.push_back(other);
}

std::span<const int> PathScene::lines_of(const MapLine& name) const {
  const auto it = named_.find(name);
  return it == named_.end() ? std::span<const int>() : std::span<const int>(it->second);
}

}  // namespace sightline::internal
