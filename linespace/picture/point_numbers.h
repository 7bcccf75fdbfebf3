// Numbers of exact points: those of a scene, and others after them.

#pragma once

#include <map>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/scene.h"

namespace sightline::internal {

/// Gives points that are constructed their numbers, each point one.
class PointNumbers {
 public:
  /// Keeps references; `constructed` grows.
  PointNumbers(const Scene& scene, std::vector<ExactPoint>& constructed)
      : count_(static_cast<int>(scene.points().size())), constructed_(&constructed) {}

  /// From now on a point of the scene is known by its number there.
  void add(const Scene& scene, int point) {
    numbers_.emplace(exact_point(scene.point(point)), point);
  }
  [[nodiscard]] int of(const ExactPoint& p) {
    const auto [it, is_new] =
        numbers_.emplace(p, count_ + static_cast<int>(constructed_->size()));
    if (is_new) constructed_->push_back(p);
    return it->second;
  }

 private:
  int count_;
  std::vector<ExactPoint>* constructed_;
  std::map<ExactPoint, int> numbers_;
};

}  // namespace sightline::internal
