#include "linespace/blockers/occluders.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "linespace/blockers/occluder_shadow.h"

namespace sightline::internal {
namespace {

constexpr std::size_t kRecent = 6;  // speed only

std::array<double, 3> relative(const std::array<double, 3>& p, const Point& origin) {
  return {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
}

// Adds what is not there.
void move_to_front(std::int32_t x, std::vector<std::int32_t>& items) {
  const auto at = std::find(items.begin(), items.end(), x);
  if (at == items.end()) {
    items.insert(items.begin(), x);
  } else {
    std::rotate(items.begin(), at, at + 1);
  }
}

// A segment held against boxes, in doubles as they come: speed only.
class Way {
 public:
  Way(const Point& from, const Point& to)
      : middle_(0.5 * (from + to)),
        half_((0.5 * (to - from)).cwiseAbs()),
        direction_(to - from) {}

  [[nodiscard]] bool meets(const Box& box) const {
    std::array<double, 3> c, h;
    for (int i = 0; i < 3; ++i) {
      c[i] = 0.5 * (box.min[i] + box.max[i]) - middle_[i];
      // Wider by a rounding or two: much touches on a ground.
      h[i] = 0.5 * (box.max[i] - box.min[i]) +
             8 * kUnit * (std::abs(box.max[i]) + std::abs(middle_[i]));
      if (std::abs(c[i]) > h[i] + half_[i]) return false;
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      if (std::abs(direction_[j] * c[k] - direction_[k] * c[j]) >
          2 * (half_[j] * h[k] + half_[k] * h[j])) {
        return false;
      }
    }
    return true;
  }

 private:
  Point middle_, half_, direction_;
};

}  // namespace

Occluders::Occluders(const Silhouettes& silhouettes)
    : g_(silhouettes),
      shadow_index_(silhouettes.scene().objects().size() +
                        silhouettes.scene().facets().size() +
                        silhouettes.scene().faces().size(),
                    -2) {}

void Occluders::begin(std::span<const Point> viewpoints,
                      std::span<const std::int32_t> own_objects,
                      std::span<const std::int32_t> own_facets) {
  viewpoints_.assign(viewpoints.begin(), viewpoints.end());
  own_objects_.assign(own_objects.begin(), own_objects.end());
  own_facets_.assign(own_facets.begin(), own_facets.end());
  middle_ = Point::Zero();
  for (const Point& p : viewpoints) {
    middle_ += p / static_cast<double>(viewpoints.size());
  }
  for (const std::int64_t key : shadow_keys_) shadow_index_[key] = -2;
  shadow_keys_.clear();
  shadows_.clear();
  faces_.clear();
  recent_.clear();
  looking_ = false;
}

// -1 for the viewpoints' own, and where nothing is hidden.
int Occluders::shadow_of(int face) {
  const std::int64_t key = occluder_key(g_, face);
  std::int32_t& index = shadow_index_[key];
  if (index != -2) return index;
  shadow_keys_.push_back(key);
  index = -1;
  const Face& f = g_.scene().faces()[face];
  const bool solid = g_.convex_solid(f.object);
  const bool own = solid ? share(std::span(&f.object, 1), own_objects_)
                         : share(std::span(&f.facet, 1), own_facets_);
  if (own) return -1;
  const std::size_t before = shadows_.size();
  for (const Point& at : viewpoints_) {
    shadows_.push_back(solid ? solid_shadow(g_, f.object, at)
                             : facet_shadow(g_, face, at));
    if (!shadows_.back().planes.empty()) continue;
    shadows_.resize(before);
    return -1;
  }
  index = static_cast<int>(faces_.size());
  faces_.push_back(face);
  return index;
}

void Occluders::aim(std::span<const Box> parts) {
  targets_.clear();
  for (const Point& at : viewpoints_) {
    Target target;
    target.parts = parts.size();
    for (std::size_t k = 0; k < parts.size(); ++k) {
      target.low[k] = relative(parts[k].min, at);
      target.high[k] = relative(parts[k].max, at);
    }
    for (int i = 0; i < 3; ++i) {
      target.middle[i] = 0.5 * (target.low.front()[i] + target.high[parts.size() - 1][i]);
    }
    targets_.push_back(target);
  }
}

bool Occluders::hides(int shadow) const {
  const auto all = shadows(shadow);
  // Most are beside: their middle shows it soonest.
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!all[k].near(targets_[k].middle)) return false;
  }
  bool inside = false;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Target& target = targets_[k];
    for (std::size_t part = 0; part < target.parts; ++part) {
      const Hides here = all[k].hides(target.low[part], target.high[part]);
      if (here == Hides::No) return false;
      inside |= here == Hides::Inside;
    }
  }
  return inside;
}

// Nothing inside the one box looked at is hidden.
bool Occluders::beside(int shadow) const {
  const auto all = shadows(shadow);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].beside(targets_[k].low.front(), targets_[k].high.front())) return true;
  }
  return false;
}

void Occluders::look_at(const Box& box) {
  looking_ = true;
  in_view_.clear();
  if (recent_.empty()) return;
  aim(std::span(&box, 1));
  std::copy_if(recent_.begin(), recent_.end(), std::back_inserter(in_view_),
               [&](std::int32_t shadow) { return !beside(shadow); });
}

int Occluders::recent_hider() {
  const auto hider = std::find_if(asked().begin(), asked().end(),
                                  [&](int shadow) { return hides(shadow); });
  if (hider == asked().end()) return -1;
  const int shadow = *hider;
  keep(shadow);
  return faces_[shadow];
}

int Occluders::hider(const Box& box) {
  if (asked().empty()) return -1;
  aim(std::span(&box, 1));
  return recent_hider();
}

int Occluders::hider(const Point& q0, const Point& q1) {
  if (asked().empty()) return -1;
  aim(std::array{box_of(std::span(&q0, 1)), box_of(std::span(&q1, 1))});
  return recent_hider();
}

int Occluders::hider(std::span<const std::int32_t> faces, const Point& q0,
                     const Point& q1) {
  aim(std::array{box_of(std::span(&q0, 1)), box_of(std::span(&q1, 1))});
  const Way way(middle_, 0.5 * (q0 + q1));
  int last = -1;
  for (const std::int32_t face : faces) {
    // What hides all segments is met by this one, by a face on the near side first.
    if (!way.meets(g_.face_box(face))) continue;
    const int shadow = shadow_of(face);
    if (shadow < 0 || shadow == last) continue;
    last = shadow;
    if (!hides(shadow)) continue;
    keep(shadow);
    return faces_[shadow];
  }
  return -1;
}

void Occluders::remember(int face) {
  const int shadow = shadow_of(face);
  if (shadow >= 0) keep(shadow);
}

void Occluders::keep(int shadow) {
  move_to_front(shadow, recent_);
  if (recent_.size() > kRecent) recent_.pop_back();
  if (looking_) move_to_front(shadow, in_view_);
}

}  // namespace sightline::internal
