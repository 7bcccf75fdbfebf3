#include <algorithm>

#include "skeleton/edge_view_internal.h"
#include "skeleton/occluder_shadow_internal.h"

namespace sightline::internal {
namespace {

// The rest is speed only.
constexpr std::size_t kRecent = 16;
// Longer lists are not kept: the tree of faces is asked for each edge of the group.
constexpr std::size_t kLongestList = 512;

}  // namespace

std::array<bool, 2> touched_on(const Ridge& r) {
  return {r.contact(Sign::Negative, Sign::Negative) != EdgeContact::None,
          r.contact(Sign::Positive, Sign::Positive) != EdgeContact::None};
}

EdgeView::EdgeView(const Generators& generators)
    : g_(generators),
      facet_stamp_(generators.scene().facets().size(), 0),
      shadow_index_(generators.scene().objects().size() +
                        generators.scene().facets().size() +
                        generators.scene().faces().size(),
                    -2) {}

void EdgeView::begin(int ridge) {
  ridge_ = ridge;
  const Scene& scene = g_.scene();
  const Ridge& r = g_.ridges()[ridge];
  ends_ = {scene.point(r.points[0]), scene.point(r.points[1])};
  box_ = box_of(ends_);
  for (int k = 0; k < 2; ++k) {
    wedge_[k] = plane_seen_from(ends_[0], scene.point(r.points[1 - k]),
                                scene.point(r.points[k]), scene.point(r.thirds[k]));
  }
  touched_on_ = touched_on(r);
  ++stamp_;
  for (const Edge::Side& side : scene.edges()[r.edge].sides) {
    facet_stamp_[scene.faces()[side.face].facet] = stamp_;
  }
  for (const std::int64_t key : shadow_keys_) shadow_index_[key] = -2;
  shadow_keys_.clear();
  shadows_.clear();
  recent_.clear();
}

std::array<double, 3> EdgeView::relative(const std::array<double, 3>& p, int end) const {
  return {p[0] - ends_[end][0], p[1] - ends_[end][1], p[2] - ends_[end][2]};
}

void EdgeView::look_at(const Box& group) {
  group_ = group;
  listed_ = false;
}

// All of the box is behind both planes of the wedge or in front of both.
bool EdgeView::never_touched_from(const Box& box) const {
  const CentredBox b = centred(box);
  const auto c = relative(b.centre, 0);
  return (!touched_on_[0] && wedge_[0].negative_on(c, b.half) &&
          wedge_[1].negative_on(c, b.half)) ||
         (!touched_on_[1] && wedge_[0].positive_on(c, b.half) &&
          wedge_[1].positive_on(c, b.half));
}

// -1 for the edge's own solid or facet, and where nothing is hidden.
int EdgeView::shadow_of(int face) {
  const Face& f = g_.scene().faces()[face];
  const std::int64_t key = occluder_key(g_, face);
  std::int32_t& index = shadow_index_[key];
  if (index != -2) return index;
  shadow_keys_.push_back(key);
  index = -1;
  const bool solid = g_.convex_solid(f.object);
  if (solid ? share(std::span(&f.object, 1), g_.ridges()[ridge_].objects)
            : facet_stamp_[f.facet] == stamp_) {
    return -1;
  }
  const auto shadow = [&](const Point& at) {
    return solid ? solid_shadow(g_, f.object, at) : facet_shadow(g_, face, at);
  };
  Shadows both{shadow(ends_[0]), shadow(ends_[1])};
  if (both[0].planes.empty() || both[1].planes.empty()) return -1;
  index = static_cast<int>(shadows_.size());
  shadows_.push_back(std::move(both));
  return index;
}

// Seen from a point, what is behind a convex occluder is convex.  So where segments from
// both ends of an edge to both ends of another meet it, all segments between the two do;
// and where one of the four passes its inside, all do that are between inner points.
bool EdgeView::hides(const Shadows& shadows, const Box& box) const {
  const Hides first = shadows[0].hides(relative(box.min, 0), relative(box.max, 0));
  if (first == Hides::No) return false;
  const Hides last = shadows[1].hides(relative(box.min, 1), relative(box.max, 1));
  return last != Hides::No && (first == Hides::Inside || last == Hides::Inside);
}

bool EdgeView::hides(const Shadows& shadows, const Point& q0, const Point& q1) const {
  bool inside = false;
  for (int k = 0; k < 2; ++k) {
    for (const Point& q : {q0, q1}) {
      const auto at = relative({q[0], q[1], q[2]}, k);
      const Hides here = shadows[k].hides(at, at);
      if (here == Hides::No) return false;
      inside |= here == Hides::Inside;
    }
  }
  return inside;
}

bool EdgeView::hidden(const Box& box) {
  for (std::size_t k = 0; k < recent_.size(); ++k) {
    if (hides(shadows_[recent_[k]], box)) {
      const auto at = recent_.begin() + static_cast<std::ptrdiff_t>(k);
      std::rotate(recent_.begin(), at, at + 1);
      return true;
    }
  }
  return false;
}

bool EdgeView::hidden(const Point& q0, const Point& q1) const {
  return std::any_of(recent_.begin(), recent_.end(),
                     [&](int s) { return hides(shadows_[s], q0, q1); });
}

bool EdgeView::hidden_by_one_of(const std::vector<std::int32_t>& faces, const Point& q0,
                                const Point& q1) {
  int last = -1;
  for (const std::int32_t face : faces) {
    const int shadow = shadow_of(face);
    if (shadow < 0 || shadow == last) continue;
    last = shadow;
    if (!hides(shadows_[shadow], q0, q1)) continue;
    keep(shadow);
    return true;
  }
  return false;
}

void EdgeView::remember(int face) {
  const int shadow = shadow_of(face);
  if (shadow >= 0) keep(shadow);
}

void EdgeView::keep(int shadow) {
  if (std::find(recent_.begin(), recent_.end(), shadow) != recent_.end()) return;
  if (recent_.size() >= kRecent) recent_.pop_back();
  recent_.insert(recent_.begin(), shadow);
}

void EdgeView::list_faces() {
  listed_ = true;
  list_.clear();
  const Shaft hull(ends_[0], ends_[1], group_);
  g_.face_tree().traverse(
      [&](const Box& box) { return list_.size() <= kLongestList && hull.may_meet(box); },
      [&](std::uint32_t item) {
        const int face = static_cast<int>(item);
        const Box& box = g_.face_box(face);
        if (hull.may_meet(box)) list_.push_back({box, face});
      });
  too_many_ = list_.size() > kLongestList;
}

void EdgeView::faces_between(const Shaft& hull, std::vector<std::int32_t>& faces) {
  if (!listed_) list_faces();
  faces.clear();
  if (too_many_) {
    g_.face_tree().traverse([&](const Box& box) { return hull.may_meet(box); },
                            [&](std::uint32_t item) {
                              const int face = static_cast<int>(item);
                              if (hull.may_meet(g_.face_box(face))) faces.push_back(face);
                            });
    return;
  }
  for (const Listed& l : list_) {
    if (hull.may_meet(l.box)) faces.push_back(l.face);
  }
}

}  // namespace sightline::internal
