#include "linespace/view/line_view.h"

#include <algorithm>

#include "linespace/view/sight_triangle.h"

namespace sightline::internal {

LineViewer::LineViewer(const EyeSpace& eye, const EyeStar& star, const Window& window,
                       std::span<const std::uint8_t> possibly_seen)
    : eye_(&eye), star_(&star), window_(&window), tree_(std::vector<Box>{}) {
  std::vector<Box> boxes;
  for (int f = 0; f < static_cast<int>(possibly_seen.size()); ++f) {
    if (possibly_seen[f] == 0 || eye.front(f) == Sign::Zero) continue;
    askable_.push_back(f);
    boxes.push_back(eye.scene().silhouettes().face_box(f));
  }
  tree_ = Bvh(boxes);
}

// False when one face hides all of the line.
bool LineViewer::cover(int line, const LineCuts& cuts) {
  find_faces(line);
  covers_.clear();
  along_ = false;
  for (const int face : faces_) {
    if (auto own = own_side(line, face)) {
      covers_.push_back(*own);
    } else if (auto other = overlap(line, face, cuts)) {
      covers_.push_back(*other);
      const bool whole = other->from.kind == LineCut::Kind::Start &&
                         other->to.kind == LineCut::Kind::Finish;
      if (whole && other->hides && other->left && other->right) return false;
    }
  }
  return true;
}

void LineViewer::view(int line, std::vector<LinePiece>& pieces) {
  if (eye_->end_on(line)) return;
  const LineCuts cuts(*eye_, line);
  if (window_->has(line)) {
    covers_.clear();  // nothing hides the window
  } else if (!cover(line, cuts) && !star_->bounds(line)) {
    return;
  }
  const Scan scan = scan_covers(line, cuts);
  const std::size_t first = pieces.size();
  for (std::size_t i = 0; i < scan.hidden.size(); ++i) {
    const bool in_sight = scan.hidden[i][0] == 0 || scan.hidden[i][1] == 0;
    if (along_ && in_sight) suspects_.push_back({-1, line, scan.at[i], scan.at[i + 1]});
    auto next = piece(line, scan, i);
    if (!next) continue;
    if (pieces.size() > first && pieces.back().left == next->left &&
        pieces.back().right == next->right &&
        cuts.compare(pieces.back().to, next->from) == 0) {
      pieces.back().to = next->to;
    } else {
      pieces.push_back(std::move(*next));
    }
  }
}

// The piece between two neighbouring positions; nullopt where nothing begins or ends.
std::optional<LinePiece> LineViewer::piece(int line, const Scan& scan,
                                           std::size_t i) const {
  const std::array<bool, 2> blocked =
      scan.blocked.empty() ? std::array{false, false} : scan.blocked[i];
  const auto& hidden = scan.hidden[i];
  if (blocked[0] && blocked[1]) return std::nullopt;
  const bool bounds_sight = blocked[0] || blocked[1];
  if (bounds_sight != window_->has(line) && !(bounds_sight && star_->bounds(line)))
    return std::nullopt;
  // Where a nearer face ends along the line, its own side is the piece.
  if (!bounds_sight && (hidden[0] > 0 || hidden[1] > 0 || scan.containing[i].empty()))
    return std::nullopt;
  std::vector<int> left, right;
  for (const Cover* c : scan.containing[i]) {
    if (c->left && !blocked[0] && hidden[0] == 0) left.push_back(c->face);
    if (c->right && !blocked[1] && hidden[1] == 0) right.push_back(c->face);
  }
  LinePiece piece{line, scan.at[i], scan.at[i + 1], nearest(left, line, true),
                  nearest(right, line, false)};
  piece.left.blocked = blocked[0];
  piece.right.blocked = blocked[1];
  if (piece.left == piece.right) return std::nullopt;
  return piece;
}

std::vector<std::array<LineCut, 2>> LineViewer::parts_in_sight(int line) {
  std::vector<std::array<LineCut, 2>> parts;
  if (eye_->end_on(line)) return parts;
  const LineCuts cuts(*eye_, line);
  if (!cover(line, cuts)) return parts;
  const Scan scan = scan_covers(line, cuts);
  for (std::size_t i = 0; i < scan.hidden.size(); ++i) {
    const bool outside =
        !scan.blocked.empty() && scan.blocked[i][0] && scan.blocked[i][1];
    if (!outside && (scan.hidden[i][0] == 0 || scan.hidden[i][1] == 0))
      parts.push_back({scan.at[i], scan.at[i + 1]});
  }
  return parts;
}

std::vector<std::array<LineCut, 2>> LineViewer::hidden_parts(int line) {
  std::vector<std::array<LineCut, 2>> parts;
  if (eye_->end_on(line)) return parts;
  const LineCuts cuts(*eye_, line);
  if (!cover(line, cuts)) return {{line_start(), line_finish()}};
  const Scan scan = scan_covers(line, cuts);
  for (std::size_t i = 0; i < scan.hidden.size(); ++i) {
    if (scan.hidden[i][0] == 0 || scan.hidden[i][1] == 0) continue;
    if (!parts.empty() && cuts.compare(parts.back()[1], scan.at[i]) == 0) {
      parts.back()[1] = scan.at[i + 1];
    } else {
      parts.push_back({scan.at[i], scan.at[i + 1]});
    }
  }
  return parts;
}

// A corner that is seen on a line, but does not lie on it.
void LineViewer::suspect_corner(int line, int corner) {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  if (!eye_->scene().in_line(a, b, corner)) suspects_.push_back({corner, line, {}, {}});
}

// Those ends of a line, seen on the line of side k of a face, for which `nearer` is
// Negative: the face is nearer.
void LineViewer::suspect_ends(int line, int face, std::size_t k,
                              const std::array<Sign, 2>& nearer) {
  const int own = eye_->scene().line_of_side(face, static_cast<int>(k));
  for (int i = 0; i < 2; ++i) {
    if (nearer[i] == Sign::Negative)
      suspect_corner(own >= 0 ? own : line, eye_->scene().lines()[line].ends[i]);
  }
}

// Faces that sight may meet on its way to the line.
void LineViewer::find_faces(int line) {
  faces_.clear();
  const ViewScene& scene = eye_->scene();
  const SightTriangle triangle(*eye_, line);
  tree_.traverse([&](const Box& box) { return !triangle.misses(box); },
                 [&](std::uint32_t item) {
                   const int face = askable_[item];
                   if (!triangle.misses(scene.silhouettes().face_box(face)))
                     faces_.push_back(face);
                 });
}

// Of a face that has both ends of the line as neighbouring corners.
std::optional<LineViewer::Cover> LineViewer::own_side(int line, int face) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const auto corners = eye_->scene().corners(face);
  const std::size_t n = corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    const int p = corners[k];
    const int q = corners[(k + 1) % n];
    const bool forward = p == a && q == b;
    if (!forward && (p != b || q != a)) continue;
    // A face is on the left of its own sides, seen from its front.
    const bool left = forward == (eye_->front(face) == Sign::Positive);
    return Cover{face, line_start(), line_finish(), left, !left, false};
  }
  return std::nullopt;
}

std::optional<LineViewer::Cover> LineViewer::overlap(int line, int face,
                                                     const LineCuts& cuts) {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const auto corners = eye_->scene().corners(face);
  const std::size_t n = corners.size();

  // On which sides of the line the face is seen.
  Cover cover{face, line_start(), line_finish(), false, false, false};
  corner_signs_.clear();
  std::size_t in_line = 0;  // corners seen in line with it
  for (const int c : corners) {
    const Sign right = eye_->orient(b, a, c);
    corner_signs_.push_back(right);
    cover.left |= right == Sign::Negative;
    cover.right |= right == Sign::Positive;
    in_line += right == Sign::Zero ? 1 : 0;
  }
  // What lies beside the line, or touches it in a corner, covers none of it.
  const bool across = cover.left && cover.right;
  if (!across && in_line == 0) return std::nullopt;
  // Only what is nearer than the line, or contains it, counts.
  const Sign before_a = eye_->before(face, a);
  const Sign before_b = eye_->before(face, b);
  if (before_a != Sign::Negative && before_b != Sign::Negative &&
      (before_a != Sign::Zero || before_b != Sign::Zero)) {
    return std::nullopt;
  }
  cover.hides = before_a != Sign::Zero || before_b != Sign::Zero;
  if (cover.hides) {
    for (std::size_t k = 0; k < n; ++k) {
      if (corner_signs_[k] != Sign::Zero) continue;
      suspect_corner(line, corners[k]);
      if (corner_signs_[k + 1 < n ? k + 1 : 0] == Sign::Zero)
        suspect_ends(line, face, k, {before_a, before_b});
    }
  }
  if (!across && in_line < 2) return std::nullopt;
  if (!narrow_to_face(cover, face, cuts, {before_a, before_b})) return std::nullopt;
  // The part of that which lies behind the face.
  if (before_a * before_b == Sign::Negative) {
    const auto before = [&](const LineCut& x, const LineCut& y) {
      return cuts.compare(x, y) < 0;
    };
    narrow_to_behind(cover, before_a == Sign::Negative, cuts.at_plane(face), before);
    if (!before(cover.from, cover.to)) return std::nullopt;
  }
  return cover;
}

// Narrows the cover to the part of the line that is seen within the face; `before`: of
// the line's ends, as EyeSpace::before() has it.
bool LineViewer::narrow_to_face(Cover& cover, int face, const LineCuts& cuts,
                                const std::array<Sign, 2>& before) {
  const ViewScene& scene = eye_->scene();
  const auto corners = scene.corners(face);
  const std::size_t n = corners.size();
  const auto next = [&](std::size_t k) { return k + 1 < n ? k + 1 : 0; };
  const auto corners_of = [&](std::size_t k) {
    return std::array{corner_signs_[k], corner_signs_[next(k)]};
  };
  const auto against = [&](std::size_t k, bool to_right) {
    const int p = corners[to_right ? k : next(k)];
    const int q = corners[to_right ? next(k) : k];
    const auto side = cuts.against(p, q, scene.line_of_side(face, static_cast<int>(k)));
    const std::array<Sign, 2> nearer{side.start == Sign::Zero ? before[0] : Sign::Zero,
                                     side.end == Sign::Zero ? before[1] : Sign::Zero};
    suspect_ends(cuts.line(), face, k, nearer);
    return side;
  };
  if (!narrow_to_outline(cover, n, eye_->front(face), corners_of, against)) return false;
  for (std::size_t k = 0; k < n; ++k) {
    if (corners_of(k) != std::array{Sign::Zero, Sign::Zero}) continue;
    along_ |= cover.hides && scene.line_of_side(face, static_cast<int>(k)) >= 0;
  }
  return true;
}

// Of faces that contain the line and are on one side of it, those seen just beside it.
SeenBeside LineViewer::nearest(std::span<const int> faces, int line, bool left) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const ViewScene& scene = eye_->scene();
  const Sign side = left ? Sign::Positive : Sign::Negative;
  // A point of the face that is seen beside the line.
  const auto beside = [&](int face) {
    for (const int c : scene.corners(face)) {
      if (eye_->orient(a, b, c) == side) return c;
    }
    return scene.corners(face)[0];
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

LineViewer::Scan LineViewer::scan_covers(int line, const LineCuts& cuts) {
  Scan scan;
  scan.at = {line_start(), line_finish()};
  for (const Cover& c : covers_) {
    if (c.from.kind != LineCut::Kind::Start) scan.at.push_back(c.from);
    if (c.to.kind != LineCut::Kind::Finish) scan.at.push_back(c.to);
  }
  // From an eye on a face, sight is blocked up to its plane.
  const auto [a, b] = eye_->scene().lines()[line].ends;
  for (const int face : star_->faces()) {
    const Sign at_a = eye_->scene().plane_side(face, a);
    if (at_a != Sign::Zero && eye_->scene().plane_side(face, b) == -at_a)
      scan.at.push_back(cuts.at_plane(face));
  }
  window_->add_cuts(line, cuts, scan.at);
  cuts.sort_unique(scan.at, [&](const LineCut& x, const LineCut& y) {
    const bool one_line = x.kind == LineCut::Kind::Side && y.kind == x.kind &&
                          eye_->scene().in_line(x.p, x.q, y.p) &&
                          eye_->scene().in_line(x.p, x.q, y.q);
    const bool sides = x.kind == LineCut::Kind::Side || y.kind == LineCut::Kind::Side;
    if (sides && !one_line)
      suspects_.push_back({-1, line, x.kind == LineCut::Kind::Side ? x : y, {}});
  });

  const std::size_t n = scan.at.size() - 1;
  std::vector<std::array<int, 2>> begins(n + 1);
  scan.containing.resize(n);
  for (const Cover& c : covers_) {
    const auto from = cuts.rank(scan.at, c.from);
    const auto to = cuts.rank(scan.at, c.to);
    if (!c.hides) {
      for (auto i = from; i < to; ++i) scan.containing[i].push_back(&c);
      continue;
    }
    for (int side = 0; side < 2; ++side) {
      if (!(side == 0 ? c.left : c.right)) continue;
      ++begins[from][side];
      --begins[to][side];
    }
  }
  std::array<int, 2> hidden{};
  for (std::size_t i = 0; i < n; ++i) {
    for (int side = 0; side < 2; ++side) hidden[side] += begins[i][side];
    scan.hidden.push_back(hidden);
  }
  if (!star_->faces().empty() || !window_->empty()) find_blocked(line, cuts, scan);
  return scan;
}

void LineViewer::find_blocked(int line, const LineCuts& cuts, Scan& scan) const {
  const ViewScene& scene = eye_->scene();
  const auto [a, b] = scene.lines()[line].ends;
  // Rays run against picture vectors.
  const ExactPoint right = exact_cross(eye_->exact_vector(a), eye_->exact_vector(b));
  const ExactPoint left{-right[0], -right[1], -right[2]};
  for (std::size_t i = 0; i < scan.hidden.size(); ++i) {
    std::array<bool, 2> blocked = window_->outside(line, cuts, scan.at[i]);
    if (!star_->faces().empty() && !(blocked[0] && blocked[1])) {
      const Rational middle = (cuts.exact(scan.at[i]) + cuts.exact(scan.at[i + 1])) / 2;
      const ExactPoint way =
          exact_difference(along(scene.exact(a), scene.exact(b), middle), eye_->eye());
      blocked[0] = blocked[0] || star_->blocked(way, left);
      blocked[1] = blocked[1] || star_->blocked(way, right);
    }
    scan.blocked.push_back(blocked);
  }
}

}  // namespace sightline::internal
