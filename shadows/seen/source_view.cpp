#include "shadows/seen/source_view.h"

#include <algorithm>
#include <map>

namespace sightline::internal {
namespace {

// Towards a point.  For an eye on the scene a short way says the same as a long one and
// meets the planes of fewer faces.
ExactPoint short_way(const ExactPoint& from, const ExactPoint& to) {
  ExactPoint way = exact_difference(to, from);
  for (Rational& x : way) x *= Rational(0x1p-20);
  return way;
}

}  // namespace

SourceView::SourceView(const Question& question)
    : question_(question), scene_(question.source->scene()) {
  std::vector<HidingFace> hiding_faces;
  if (question.hide) {
    hiding_faces =
        find_hiding_faces(*question.source, *question.plane, question.eye.at.nearest);
  }
  // What this eye adds to the scene: where hiding faces cut the plane, and the horizon.
  std::vector<ExactPoint> points;
  std::vector<std::array<int, 2>> lines;
  const int first_point = scene_.point_count();
  first_cut_line_ = static_cast<int>(scene_.lines().size());
  for (HidingFace& b : hiding_faces) {
    if (b.part.empty()) continue;
    std::array<int, 2> ends = b.cut_ends;
    for (int i = 0; i < 2; ++i) {
      if (ends[i] < 0) ends[i] = first_point + static_cast<int>(points.size());
      points.push_back(b.cut[i]);
    }
    lines.push_back(ends);
    cut_faces_.push_back(b.face);
  }
  add_horizon(points, lines);
  if (horizon_hides_all()) {
    any_hidden_ = true;
    eye_.emplace(scene_, question.eye);
    return;
  }
  if (!points.empty()) scene_ = scene_.with_lines(std::move(points), lines);
  eye_.emplace(scene_, question.eye);
  ask_star();
  if (any_hidden_) return;
  if (question.all_lines) find_edge_on(hiding_faces);
  find_shades(hiding_faces, first_point);
  if (any_hidden_) return;
  for (const Line& line : lines_to_ask()) view(line);
}

bool SourceView::horizon_hides_all() const {
  if (question_.horizon == nullptr) return false;
  return std::ranges::all_of(question_.plane->sides, [&](const auto& sides) {
    return std::ranges::all_of(sides, [&](const SourcePlane::Side& side) {
      return question_.horizon->above(scene_.scene().point(side.ends[0])) !=
             Sign::Positive;
    });
  });
}

// Where the horizon passes between corners of the plane's faces: a line in the plane,
// longer than the faces, below which, on its left, nothing is seen.
void SourceView::add_horizon(std::vector<ExactPoint>& points,
                             std::vector<std::array<int, 2>>& lines) {
  const Horizon* horizon = question_.horizon;
  if (horizon == nullptr) return;
  std::vector<int> corners;
  std::optional<int> above, below;
  for (const auto& sides : question_.plane->sides) {
    for (const SourcePlane::Side& side : sides) {
      const Sign s = horizon->above(scene_.scene().point(side.ends[0]));
      if (s == Sign::Positive) above = side.ends[0];
      if (s == Sign::Negative) below = side.ends[0];
      corners.push_back(side.ends[0]);
    }
  }
  if (!above || !below) return;
  const ExactPoint p = scene_.exact(*above), q = scene_.exact(*below);
  const Rational u = horizon->height(p), v = horizon->height(q);
  const ExactPoint on = along(p, q, quotient(u, u - v));
  const auto t = plane_points(scene_.scene(), question_.plane->faces.front());
  const ExactPoint a = scene_.exact(t[0]);
  const ExactPoint normal = exact_cross(exact_difference(scene_.exact(t[1]), a),
                                        exact_difference(scene_.exact(t[2]), a));
  const ExactPoint way = exact_cross(horizon->normal(), normal);
  const Rational length = exact_dot(way, way);
  Rational first = 0, last = 0;
  for (const int c : corners) {
    const Rational s =
        quotient(exact_dot(way, exact_difference(scene_.exact(c), on)), length);
    first = std::min(first, s);
    last = std::max(last, s);
  }
  ExactPoint from = on, to = on;
  for (int i = 0; i < 3; ++i) {
    from[i] += (first - 1) * way[i];
    to[i] += (last + 1) * way[i];
  }
  const int n = scene_.point_count() + static_cast<int>(points.size());
  horizon_line_ = static_cast<int>(scene_.lines().size() + lines.size());
  // Below on the left, as the eye sees it from the side to which the faces emit: the
  // vectors E - from, E - to and E - q make a positive determinant.
  const auto vector = [&](const ExactPoint& x) {
    return exact_difference(horizon->eye(), x);
  };
  if (exact_dot(vector(from), exact_cross(vector(to), vector(q))) < 0)
    std::swap(from, to);
  points.push_back(std::move(from));
  points.push_back(std::move(to));
  lines.push_back({n, n + 1});
}

// An eye on the scene: whether all of the plane's faces lie where sight runs freely, all
// where it runs into material, or some here and some there.
void SourceView::ask_star() {
  const EyeStar* star = question_.star;
  if (star == nullptr || star->faces().empty()) return;
  for (const int f : star->faces()) {
    bool positive = false, negative = false;
    for (const auto& sides : question_.plane->sides) {
      for (const SourcePlane::Side& side : sides) {
        const Sign s = scene_.plane_side(f, side.ends[0]);
        positive |= s == Sign::Positive;
        negative |= s == Sign::Negative;
      }
    }
    ask_star_ |= positive && negative;
  }
  if (ask_star_) return;
  // Towards a point inside the first face.
  const auto corners = scene_.scene().face_points(question_.plane->faces.front());
  ExactPoint middle = scene_.exact(corners[0]);
  for (int k = 1; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) middle[i] += scene_.exact(corners[k])[i];
  }
  for (Rational& x : middle) x /= 3;
  any_hidden_ = star->blocked(short_way(eye_->eye(), middle), {});
}

// Some side of one of the two has all of the other on its outside; where lines are asked
// for, two that touch along a side are not apart.
bool SourceView::apart(const Shade& shade, const Shade& of_source) const {
  const auto separates = [&](const Shade& s, const Shade& t) {
    return std::ranges::any_of(s.sides, [&](const Shade::Side& side) {
      int on_it = 0;
      for (const Shade::Side& other : t.sides) {
        const Sign at = eye_->orient(side.ends[0], side.ends[1], other.ends[0]);
        if (at == Sign::Positive) return false;
        on_it += at == Sign::Zero ? 1 : 0;
      }
      return !question_.all_lines || on_it < 2;
    });
  };
  return separates(shade, of_source) || separates(of_source, shade);
}

bool SourceView::covers_all(const Shade& shade) const {
  return std::ranges::all_of(shade.sides, [&](const Shade::Side& side) {
    return std::ranges::all_of(question_.plane->sides, [&](const auto& sides) {
      return std::ranges::all_of(sides, [&](const SourcePlane::Side& s) {
        return eye_->orient(side.ends[0], side.ends[1], s.ends[0]) != Sign::Negative;
      });
    });
  });
}

void SourceView::find_edge_on(const std::vector<HidingFace>& hiding_faces) {
  for (const HidingFace& b : hiding_faces) {
    if (eye_->front(b.face) != Sign::Zero) continue;
    bool positive = false, negative = false;
    for (const auto& sides : question_.plane->sides) {
      for (const SourcePlane::Side& side : sides) {
        const Sign s = scene_.plane_side(b.face, side.ends[0]);
        positive |= s == Sign::Positive;
        negative |= s == Sign::Negative;
      }
    }
    if (positive && negative) edge_on_faces_.push_back(b.face);
  }
}

void SourceView::find_shades(const std::vector<HidingFace>& hiding_faces,
                             int first_cut_point) {
  for (const auto& sides : question_.plane->sides) {
    Shade& shade = shades_.emplace_back();
    for (const SourcePlane::Side& side : sides)
      shade.sides.push_back({side.ends, side.line});
  }
  source_shades_ = shades_.size();
  const ShadeMaker maker(*eye_, *question_.source, *question_.plane, question_.all_lines);
  for (Shade& shade : maker.shades(hiding_faces, first_cut_point, first_cut_line_)) {
    bool near = false;
    for (std::size_t i = 0; i < source_shades_ && !near; ++i)
      near = !apart(shade, shades_[i]);
    if (!near) continue;
    if (covers_all(shade)) {
      any_hidden_ = true;
      return;
    }
    shades_.push_back(std::move(shade));
  }
}

std::vector<SourceView::Line> SourceView::lines_to_ask() const {
  std::map<int, std::vector<int>> shades_of_line;
  for (int i = 0; i < static_cast<int>(shades_.size()); ++i) {
    for (const Shade::Side& side : shades_[i].sides) {
      if (side.line >= 0) shades_of_line[side.line].push_back(i);
    }
    for (const int line : shades_[i].further_lines) shades_of_line[line].push_back(i);
  }
  if (horizon_line_ >= 0) shades_of_line[horizon_line_];
  if (ask_star_) {
    for (const int line : question_.star->sides()) shades_of_line[line];
  }
  std::vector<Line> lines;
  for (auto& [line, shades] : shades_of_line) lines.push_back({line, std::move(shades)});
  return lines;
}

std::optional<SourceView::Cover> SourceView::cover(const LineCuts& cuts,
                                                   const Shade& shade) {
  const auto [a, b] = scene_.lines()[cuts.line()].ends;
  Cover cover{line_start(), line_finish(), false, false, false, false};
  corner_signs_.clear();
  std::size_t in_line = 0;  // corners seen in line with the line
  for (const Shade::Side& side : shade.sides) {
    const std::array<Sign, 2> right{eye_->orient(b, a, side.ends[0]),
                                    eye_->orient(b, a, side.ends[1])};
    corner_signs_.push_back(right);
    cover.left |= right[0] == Sign::Negative;
    cover.right |= right[0] == Sign::Positive;
    in_line += right[0] == Sign::Zero ? 1 : 0;
  }
  if (!(cover.left && cover.right) && in_line < 2) return std::nullopt;
  const bool meets = narrow_to_outline(
      cover, shade.sides.size(), Sign::Positive,
      [&](std::size_t k) { return corner_signs_[k]; },
      [&](std::size_t k, bool to_right) {
        const auto [p, q] = shade.sides[k].ends;
        return cuts.against(to_right ? p : q, to_right ? q : p, shade.sides[k].line);
      });
  if (!meets) return std::nullopt;
  return cover;
}

std::optional<SourceView::Cover> SourceView::below_horizon(int line,
                                                           const LineCuts& cuts) const {
  const auto [p, q] = scene_.lines()[horizon_line_].ends;
  const auto [a, b] = scene_.lines()[line].ends;
  Cover cover{line_start(), line_finish(), true, true, false, line == horizon_line_};
  if (line == horizon_line_) {
    cover.right = false;
    return cover;
  }
  const Sign at_a = eye_->orient(p, q, a), at_b = eye_->orient(p, q, b);
  if (at_a == Sign::Zero && at_b == Sign::Zero) {
    // Along the horizon, or against it.
    const auto below = exact_cross(eye_->exact_vector(a), eye_->exact_vector(b));
    // The left of the line runs along -below; it is below where it points down.
    cover.left = exact_dot(question_.horizon->normal(), below) > 0;
    cover.right = !cover.left;
    return cover;
  }
  if (at_a != Sign::Positive && at_b != Sign::Positive) return std::nullopt;
  if (at_a == Sign::Negative) cover.from = cuts.at_side(p, q);
  if (at_b == Sign::Negative) cover.to = cuts.at_side(p, q);
  return cover;
}

std::array<bool, 2> SourceView::into_material(int line, const LineCuts& cuts,
                                              const LineCut& from,
                                              const LineCut& to) const {
  const auto [a, b] = scene_.lines()[line].ends;
  // Rays run against picture vectors.
  const ExactPoint right = exact_cross(eye_->exact_vector(a), eye_->exact_vector(b));
  const ExactPoint left{-right[0], -right[1], -right[2]};
  const Rational middle = (cuts.exact(from) + cuts.exact(to)) / 2;
  const ExactPoint way =
      short_way(eye_->eye(), along(scene_.exact(a), scene_.exact(b), middle));
  return {question_.star->blocked(way, left), question_.star->blocked(way, right)};
}

// A side of a facet that the eye is on, where that meets a face that is not edge-on: a
// sheet that the eye is on hides nothing, and neither do its sides.
bool SourceView::bounds_star(int line) const {
  if (!question_.star->bounds(line)) return false;
  const int edge = scene_.lines()[line].name.edge;
  if (edge < 0) return true;
  return std::ranges::any_of(
      scene_.scene().edges()[edge].sides,
      [&](const Edge::Side& side) { return eye_->front(side.face) != Sign::Zero; });
}

// The stretch of the scene's line lies on the eye's side of the plane, which does not
// pass between its ends.
bool SourceView::before_plane(int line, const LineCuts& cuts, const LineCut& from,
                              const LineCut& to) const {
  const auto [a, b] = scene_.lines()[line].ends;
  const Sign at_a = question_.source->side(*question_.plane, a);
  const Sign at_b = question_.source->side(*question_.plane, b);
  if (at_a != Sign::Positive && at_b != Sign::Positive) return false;
  if (at_a != Sign::Negative && at_b != Sign::Negative) return true;
  const LineCut cut = cuts.at_plane(question_.plane->faces.front());
  return at_a == Sign::Positive ? cuts.compare(to, cut) <= 0
                                : cuts.compare(cut, from) <= 0;
}

// Scans a line from its first end to its second.
void SourceView::view(const Line& line) {
  if (eye_->end_on(line.line)) return;
  const LineCuts cuts(*eye_, line.line);
  const std::array<int, 2> ends = scene_.lines()[line.line].ends;
  covers_.clear();
  for (std::size_t i = 0; i < shades_.size(); ++i) {
    auto found = cover(cuts, shades_[i]);
    if (!found) {
      // A line on which no point of the source is seen, or beside it, bounds nothing.
      if (i + 1 == source_shades_ && covers_.empty()) return;
      continue;
    }
    found->is_source = i < source_shades_;
    found->own = std::ranges::binary_search(line.shades, static_cast<int>(i));
    covers_.push_back(*found);
    if (i + 1 == source_shades_ && covers_.empty()) return;
  }
  if (horizon_line_ >= 0) {
    if (const auto below = below_horizon(line.line, cuts)) covers_.push_back(*below);
  }

  std::vector<LineCut> at{line_start(), line_finish()};
  for (const Cover& c : covers_) {
    if (c.from.kind != LineCut::Kind::Start) at.push_back(c.from);
    if (c.to.kind != LineCut::Kind::Finish) at.push_back(c.to);
  }
  const auto cut_by_plane = [&](int face) {
    const Sign at_a = scene_.plane_side(face, ends[0]);
    if (at_a != Sign::Zero && scene_.plane_side(face, ends[1]) == -at_a)
      at.push_back(cuts.at_plane(face));
  };
  if (ask_star_) {
    for (const int face : question_.star->faces()) cut_by_plane(face);
    if (bounds_star(line.line)) cut_by_plane(question_.plane->faces.front());
  }
  cuts.sort_unique(at, [](const LineCut&, const LineCut&) {});
  std::vector<Beside> beside(at.size() - 1);
  for (const Cover& c : covers_) {
    const auto from = cuts.rank(at, c.from);
    const auto to = cuts.rank(at, c.to);
    for (auto i = from; i < to; ++i) {
      for (int side = 0; side < 2; ++side) {
        if (!(side == 0 ? c.left : c.right)) continue;
        ++(c.is_source ? beside[i].source : beside[i].hidden)[side];
        // A side between two source faces bounds nothing.
        if (c.own) ++(c.is_source ? beside[i].own_source : beside[i].own)[side];
      }
    }
  }
  for (std::size_t i = 0; i < beside.size(); ++i) {
    std::array<bool, 2> in_source, seen, blocked{};
    for (int side = 0; side < 2; ++side) {
      in_source[side] = beside[i].source[side] > 0;
      seen[side] = in_source[side] && beside[i].hidden[side] == 0;
    }
    if (ask_star_ && (seen[0] || seen[1])) {
      blocked = into_material(line.line, cuts, at[i], at[i + 1]);
      for (int side = 0; side < 2; ++side) seen[side] = seen[side] && !blocked[side];
    }
    for (int side = 0; side < 2; ++side) {
      any_seen_ |= seen[side];
      any_hidden_ |= in_source[side] && !seen[side];
    }
    if (seen[0] == seen[1]) continue;
    // A line of which no own shade ends here only happens to be seen in line.
    const int seen_side = seen[0] ? 0 : 1;
    const bool is_source_side =
        beside[i].own_source[seen_side] > 0 && !in_source[1 - seen_side];
    const bool is_star_side = blocked[1 - seen_side] && question_.star->bounds(line.line);
    if (beside[i].own[1 - seen_side] == 0 && !is_source_side && !is_star_side) continue;
    const bool only_carries =
        beside[i].own[1 - seen_side] == 0 && !is_source_side &&
        !(bounds_star(line.line) && before_plane(line.line, cuts, at[i], at[i + 1]));
    LinePiece piece{line.line, at[i], at[i + 1], {}, {}};
    piece.left.blocked = !seen[0];
    piece.right.blocked = !seen[1];
    if (!pieces_.empty() && pieces_.back().line == piece.line &&
        pieces_.back().left == piece.left && only_carries_.back() == only_carries &&
        cuts.compare(pieces_.back().to, piece.from) == 0) {
      pieces_.back().to = piece.to;
    } else {
      pieces_.push_back(piece);
      only_carries_.push_back(only_carries);
    }
  }
}

}  // namespace sightline::internal
