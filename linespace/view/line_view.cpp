#include "linespace/view/line_view.h"

#include <algorithm>

#include "linespace/view/sight_triangle.h"

namespace sightline::internal {

LineViewer::LineViewer(const EyeSpace& eye, std::span<const std::uint8_t> possibly_seen)
    : eye_(&eye), possibly_seen_(possibly_seen) {}

void LineViewer::view(int line, std::vector<LinePiece>& pieces) {
  if (eye_->end_on(line)) return;
  const LineCuts cuts(*eye_, line);
  find_faces(line);
  covers_.clear();
  hidden_ = false;
  for (const int face : faces_) {
    if (auto cover = own_side(line, face)) {
      covers_.push_back(*cover);
    } else if (auto other = overlap(line, face, cuts)) {
      covers_.push_back(*other);
    }
    if (hidden_) return;
  }
  scan(line, cuts, pieces);
}

// Faces that sight may meet on its way to the line.
void LineViewer::find_faces(int line) {
  faces_.clear();
  const ViewScene& scene = eye_->scene();
  const SightTriangle triangle(*eye_, line);
  scene.silhouettes().face_tree().traverse(
      [&](const Box& box) { return !triangle.misses(box); },
      [&](std::uint32_t face) {
        if (possibly_seen_[face] == 0) return;
        if (triangle.misses(scene.silhouettes().face_box(static_cast<int>(face)))) return;
        if (eye_->front(static_cast<int>(face)) == Sign::Zero) return;
        faces_.push_back(static_cast<int>(face));
      });
}

// Of a face that has both ends of the line as neighbouring corners.
std::optional<LineViewer::Cover> LineViewer::own_side(int line, int face) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const auto corners = eye_->scene().scene().face_points(face);
  const std::size_t n = corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    const int p = corners[k];
    const int q = corners[(k + 1) % n];
    const bool forward = p == a && q == b;
    if (!forward && (p != b || q != a)) continue;
    // A face is on the left of its own sides, seen from its front.
    const bool left = forward == (eye_->front(face) == Sign::Positive);
    return Cover{face, start_cut(), finish_cut(), left, !left, false};
  }
  return std::nullopt;
}

std::optional<LineViewer::Cover> LineViewer::overlap(int line, int face,
                                                     const LineCuts& cuts) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const auto corners = eye_->scene().scene().face_points(face);
  const std::size_t n = corners.size();

  // On which sides of the line the face is seen.
  Cover cover{face, start_cut(), finish_cut(), false, false, false};
  for (const int c : corners) {
    const Sign s = eye_->orient(a, b, c);
    cover.left |= s == Sign::Positive;
    cover.right |= s == Sign::Negative;
  }
  // Only what is nearer than the line, or contains it, counts.
  const Sign before_a = eye_->before(face, a);
  const Sign before_b = eye_->before(face, b);
  if (before_a != Sign::Negative && before_b != Sign::Negative &&
      (before_a != Sign::Zero || before_b != Sign::Zero)) {
    return std::nullopt;
  }
  cover.hides = before_a != Sign::Zero || before_b != Sign::Zero;

  // The part of the line that is seen within the face, side by side.
  const auto later = [&](const LineCut& x, const LineCut& y) {
    return cuts.compare(x, y) > 0;
  };
  const bool front = eye_->front(face) == Sign::Positive;
  for (std::size_t k = 0; k < n; ++k) {
    int p = corners[k];
    int q = corners[(k + 1) % n];
    const int own = eye_->scene().line_of_side(face, static_cast<int>(k));
    const Sign at_a = front ? eye_->orient(p, q, a) : eye_->orient(q, p, a);
    const Sign at_b = front ? eye_->orient(p, q, b) : eye_->orient(q, p, b);
    if (at_a == Sign::Zero && at_b == Sign::Zero) continue;
    if (at_a != Sign::Positive && at_b != Sign::Positive) return std::nullopt;
    if (at_a != Sign::Negative && at_b != Sign::Negative) continue;
    // Named by the whole line, so that faces beside each other give the same cut.
    if (own >= 0) std::tie(p, q) = std::tuple_cat(eye_->scene().lines()[own].ends);
    const LineCut cut = cuts.at_side(p, q);
    if (at_a == Sign::Negative) {
      if (later(cut, cover.from)) cover.from = cut;
    } else if (later(cover.to, cut)) {
      cover.to = cut;
    }
  }
  // The part of that which lies behind the face.
  if (before_a * before_b == Sign::Negative) {
    const LineCut cut = cuts.at_plane(face);
    if (before_a == Sign::Positive) {
      if (later(cut, cover.from)) cover.from = cut;
    } else if (later(cover.to, cut)) {
      cover.to = cut;
    }
  }
  if (!later(cover.to, cover.from)) return std::nullopt;
  return cover;
}

// Of faces that contain the line and are on one side of it, those seen just beside it.
SeenBeside LineViewer::nearest(std::span<const int> faces, int line, bool left) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const Scene& scene = eye_->scene().scene();
  const Sign side = left ? Sign::Positive : Sign::Negative;
  // A point of the face that is seen beside the line.
  const auto beside = [&](int face) {
    for (const int c : scene.face_points(face)) {
      if (eye_->orient(a, b, c) == side) return c;
    }
    return scene.face_points(face)[0];
  };
  SeenBeside seen;
  for (const int face : faces) {
    const Sign s =
        seen.faces.empty() ? Sign::Positive : eye_->before(seen.faces[0], beside(face));
    if (s == Sign::Negative) continue;
    if (s == Sign::Positive) seen.faces.clear();
    seen.faces.push_back(face);
  }
  std::ranges::sort(seen.faces);
  return seen;
}

void LineViewer::scan(int line, const LineCuts& cuts, std::vector<LinePiece>& pieces) {
  // The positions at which anything begins or ends, in order, each once.
  std::vector<LineCut> at{start_cut(), finish_cut()};
  for (const Cover& c : covers_) {
    if (c.from.kind != LineCut::Kind::Start) at.push_back(c.from);
    if (c.to.kind != LineCut::Kind::Finish) at.push_back(c.to);
  }
  std::ranges::sort(
      at, [&](const LineCut& x, const LineCut& y) { return cuts.compare(x, y) < 0; });
  at.erase(std::unique(at.begin(), at.end(),
                       [&](const LineCut& x, const LineCut& y) {
                         return cuts.compare(x, y) == 0;
                       }),
           at.end());
  const auto rank = [&](const LineCut& cut) {
    return std::ranges::lower_bound(at, cut,
                                    [&](const LineCut& x, const LineCut& y) {
                                      return cuts.compare(x, y) < 0;
                                    }) -
           at.begin();
  };

  // Between two neighbouring positions: how many faces hide the left, the right; and
  // which contain the line.
  const std::size_t n = at.size() - 1;
  std::vector<std::array<int, 2>> hiding(n + 1);
  std::vector<std::vector<const Cover*>> containing(n);
  for (const Cover& c : covers_) {
    const auto from = rank(c.from);
    const auto to = rank(c.to);
    if (!c.hides) {
      for (auto i = from; i < to; ++i) containing[i].push_back(&c);
      continue;
    }
    for (int side = 0; side < 2; ++side) {
      if (!(side == 0 ? c.left : c.right)) continue;
      ++hiding[from][side];
      --hiding[to][side];
    }
  }

  const std::size_t first = pieces.size();
  std::array<int, 2> hidden{};
  for (std::size_t i = 0; i < n; ++i) {
    for (int side = 0; side < 2; ++side) hidden[side] += hiding[i][side];
    // Where a nearer face ends along the line, its own side is the piece.
    if (hidden[0] > 0 || hidden[1] > 0 || containing[i].empty()) continue;
    std::vector<int> left, right;
    for (const Cover* c : containing[i]) {
      if (c->left) left.push_back(c->face);
      if (c->right) right.push_back(c->face);
    }
    LinePiece piece{line, at[i], at[i + 1], nearest(left, line, true),
                    nearest(right, line, false)};
    if (piece.left == piece.right) continue;
    if (pieces.size() > first && pieces.back().left == piece.left &&
        pieces.back().right == piece.right &&
        cuts.compare(pieces.back().to, piece.from) == 0) {
      pieces.back().to = piece.to;
    } else {
      pieces.push_back(std::move(piece));
    }
  }
}

}  // namespace sightline::internal
