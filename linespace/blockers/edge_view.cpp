#include "linespace/blockers/edge_view.h"

#include <algorithm>
#include <bit>

#include "linespace/blockers/occluder_shadow.h"

namespace sightline::internal {
namespace {

// Speed only: a long edge is looked at by pieces when so many blockers are between it and
// the group: fewer are sorted out pair by pair.
constexpr std::size_t kManyBlockers = 24;

}  // namespace

EdgeView::EdgeView(const Silhouettes& silhouettes)
    : g_(silhouettes), cutter_(silhouettes), facing_(silhouettes) {
  views_.emplace_back(g_);
}

void EdgeView::begin(int ridge) {
  const Scene& scene = g_.scene();
  ridge_ = &g_.ridges()[ridge];
  ends_ = {scene.point(ridge_->points[0]), scene.point(ridge_->points[1])};
  box_ = box_of(ends_);
  facing_.begin(ends_);
  for (int k = 0; k < 2; ++k) {
    wedge_[k] =
        plane_seen_from(ends_[0], scene.point(ridge_->points[1 - k]),
                        scene.point(ridge_->points[k]), scene.point(ridge_->thirds[k]));
  }
  touched_on_ = touched_on(*ridge_);
  begin_piece(0, 0, 1);
  piece_count_ = cutter_.pieces(ends_[0], ends_[1]);
  pieces_ = 0;
  if (piece_count_ == 1) return;
  for (int k = 0; k < piece_count_; ++k) {
    begin_piece(k + 1, static_cast<double>(k) / piece_count_,
                static_cast<double>(k + 1) / piece_count_);
    pieces_ |= Pieces(1) << k;
  }
}

void EdgeView::begin_piece(std::size_t view, double from, double to) {
  while (views_.size() <= view) views_.emplace_back(g_);
  PieceView& v = views_[view];
  v.piece = piece_of(ends_[0], ends_[1], from, to);
  v.occluders.begin(v.piece.corners(), ridge_->objects, ridge_->all_facets);
}

void EdgeView::look_at(const Box& group, Pieces open) {
  group_ = group;
  decided_ = cut_ = false;
  const auto look = [&](PieceView& view) {
    view.between.forget();
    view.occluders.look_at(group);
  };
  look(whole());
  for (Pieces left = open; left != 0; left &= left - 1) {
    look(views_[std::countr_zero(left) + 1]);
  }
}

void EdgeView::look_away() {
  for (PieceView& view : views_) view.occluders.look_away();
}

EdgeView::Pieces EdgeView::open(Pieces pieces, const Box& box) {
  Pieces open = pieces;
  for (Pieces left = pieces; left != 0; left &= left - 1) {
    const int k = std::countr_zero(left);
    PieceView& view = views_[k + 1];
    view.hidden_by = view.occluders.hider(box);
    if (view.hidden_by >= 0) open &= ~(Pieces(1) << k);
  }
  return open;
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

void EdgeView::list_blockers(PieceView& view) const {
  const EdgePiece& piece = view.piece;
  view.between.list({piece.point(0), piece.point(1), group_, piece.pad()},
                    centre(group_) - piece.point(0));
}

// A blocker whose box the hull may meet.
void EdgeView::add_between(std::int32_t blocker, const Shaft& hull) {
  blockers_.push_back(blocker);
  if (blocker < 0) {
    between_.push_back(~blocker);
    return;
  }
  // Lines that touch a convex solid's edge do not meet it elsewhere.
  if (std::find(ridge_->objects.begin(), ridge_->objects.end(), blocker) !=
      ridge_->objects.end()) {
    return;
  }
  for (const std::int32_t face : facing_.of(blocker)) {
    if (hull.may_meet(g_.face_box(face))) between_.push_back(face);
  }
}

// Replaces between_ by the faces that the hull of the piece and an edge of the group may
// meet first of anything.
void EdgeView::find_between(PieceView& view, const Shaft& hull) {
  if (!view.between.listed()) list_blockers(view);
  between_.clear();
  view.between.any_of(hull, [&](std::int32_t blocker) {
    add_between(blocker, hull);
    return false;
  });
}

bool EdgeView::look(Pieces open, const Point& q0, const Point& q1,
                    std::vector<Part>& parts, std::vector<std::int32_t>& faces) {
  if (!decided_) {
    decided_ = true;
    list_blockers(whole());
    cut_ = pieces_ != 0 && whole().between.size() > kManyBlockers;
  }
  parts.clear();
  faces.clear();
  blockers_.clear();
  hider_faces_.clear();
  bool some_open = false;
  for (int k = 0; k < (cut_ ? piece_count_ : 1); ++k) {
    PieceView& view = part_view(k);
    const EdgePiece& piece = view.piece;
    int hidden_by = -1;
    if (cut_) {
      hidden_by = (open >> k & 1u) == 0 ? view.hidden_by : view.occluders.hider(q0, q1);
    }
    if (hidden_by < 0) {
      const std::size_t kept = blockers_.size();
      hull_.emplace(piece.point(0), piece.point(1), q0, q1, piece.pad());
      find_between(view, *hull_);
      hidden_by = view.occluders.hider(between_, q0, q1);
      if (hidden_by >= 0) blockers_.resize(kept);
    }
    if (hidden_by < 0) {
      some_open = true;
      faces.insert(faces.end(), between_.begin(), between_.end());
    }
    parts.push_back({piece.from, piece.to, hidden_by});
  }
  if (!some_open) return false;
  if (!cut_) return true;
  // What hides a part is asked for with the curves that pass it.
  int last = -1;
  for (const Part& part : parts) {
    if (part.hidden_by < 0 || part.hidden_by == last) continue;
    last = part.hidden_by;
    add_occluder_faces(g_, last, hider_faces_);
  }
  faces.insert(faces.end(), hider_faces_.begin(), hider_faces_.end());
  sort_unique(faces);
  hull_.emplace(ends_[0], ends_[1], q0, q1);
  return true;
}

std::vector<int> EdgeView::all_faces() const {
  std::vector<int> faces(hider_faces_.begin(), hider_faces_.end());
  for (const std::int32_t blocker : blockers_) {
    if (blocker < 0) {
      faces.push_back(~blocker);
      continue;
    }
    for (const int face : g_.scene().objects()[blocker].faces) {
      if (hull_->may_meet(g_.face_box(face))) faces.push_back(face);
    }
  }
  sort_unique(faces);
  return faces;
}

}  // namespace sightline::internal
