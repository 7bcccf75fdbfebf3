#include <algorithm>

#include "skeleton/edge_view_internal.h"

namespace sightline::internal {
namespace {

// Speed only: longer lists are not kept: the tree of faces is asked for each edge of the
// group.
constexpr std::size_t kLongestList = 512;

}  // namespace

std::array<bool, 2> touched_on(const Ridge& r) {
  return {r.contact(Sign::Negative, Sign::Negative) != EdgeContact::None,
          r.contact(Sign::Positive, Sign::Positive) != EdgeContact::None};
}

EdgeView::EdgeView(const Generators& generators)
    : g_(generators), occluders_(generators) {}

void EdgeView::begin(int ridge) {
  const Scene& scene = g_.scene();
  const Ridge& r = g_.ridges()[ridge];
  ends_ = {scene.point(r.points[0]), scene.point(r.points[1])};
  box_ = box_of(ends_);
  for (int k = 0; k < 2; ++k) {
    wedge_[k] = plane_seen_from(ends_[0], scene.point(r.points[1 - k]),
                                scene.point(r.points[k]), scene.point(r.thirds[k]));
  }
  touched_on_ = touched_on(r);
  occluders_.begin(ends_, r.objects, r.all_facets);
}

void EdgeView::look_at(const Box& group) {
  group_ = group;
  listed_ = false;
}

// All of the box is behind both planes of the wedge or in front of both.
bool EdgeView::never_touched_from(const Box& box) const {
  const CentredBox b = centred(box);
  std::array<double, 3> c;
  for (int i = 0; i < 3; ++i) c[i] = b.centre[i] - ends_[0][i];
  return (!touched_on_[0] && wedge_[0].negative_on(c, b.half) &&
          wedge_[1].negative_on(c, b.half)) ||
         (!touched_on_[1] && wedge_[0].positive_on(c, b.half) &&
          wedge_[1].positive_on(c, b.half));
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
