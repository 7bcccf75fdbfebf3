#include "linespace/picture/cut_faces.h"

#include <algorithm>

namespace sightline::internal {

CutFaces::CutFaces(const Scene& scene, const BoxCut& box, std::span<const int> side_lines,
                   PointNumbers& numbers, std::vector<ViewLine>& lines)
    : scene_(&scene), box_(box), starts_{0}, open_(scene.objects().size(), 0) {
  const std::size_t given = lines.size();
  facet_.assign(given, kNone);
  for (int face = 0; face < static_cast<int>(scene.faces().size()); ++face) {
    const Left left = left_of(face);
    if (left == Left::Whole) {
      add_whole(face, side_lines);
    } else if (left == Left::Part) {
      add_part(face, cut(face, side_lines), side_lines, numbers, lines);
    }
    starts_.push_back(static_cast<int>(corners_.size()));
    const auto corners = scene.face_points(face);
    const bool whole = std::ranges::equal(this->corners(face), corners);
    whole_.push_back(whole ? 1 : 0);
    if (!whole) open_[scene.faces()[face].object] = 1;
  }
  cut_lines(given, numbers, lines);
}

// Part: perhaps.
CutFaces::Left CutFaces::left_of(int face) const {
  bool whole = true;
  for (int side = 0; side < BoxCut::kSides; ++side) {
    bool any_within = false, any_beyond = false;
    for (const int p : scene_->face_points(face)) {
      const Sign s = box_.within(side, scene_->point(p));
      any_within |= s == Sign::Positive;
      any_beyond |= s == Sign::Negative;
      whole &= s == Sign::Positive;
    }
    if (any_beyond && !any_within) return Left::Nothing;
  }
  return whole ? Left::Whole : Left::Part;
}

std::vector<CutCorner> CutFaces::cut(int face, std::span<const int> side_lines) const {
  std::vector<CutCorner> polygon;
  const auto corners = scene_->face_points(face);
  const int first = scene_->faces()[face].first_corner;
  for (int k = 0; k < static_cast<int>(corners.size()); ++k) {
    polygon.push_back({exact_point(scene_->point(corners[k])), corners[k], k,
                       side_lines[first + k] < 0});
  }
  return box_.clip(std::move(polygon));
}

void CutFaces::add_side(int face, int line) {
  lines_.push_back(line);
  if (line < 0 || line >= static_cast<int>(facet_.size())) return;
  int& known = facet_[line];
  const int facet = scene_->faces()[face].facet;
  known = known == kNone || known == facet ? facet : kSeveral;
}

void CutFaces::add_whole(int face, std::span<const int> side_lines) {
  const auto corners = scene_->face_points(face);
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  for (std::size_t k = 0; k < corners.size(); ++k)
    add_side(face, side_lines[scene_->faces()[face].first_corner + k]);
}

void CutFaces::add_part(int face, std::span<const CutCorner> polygon,
                        std::span<const int> side_lines, PointNumbers& numbers,
                        std::vector<ViewLine>& lines) {
  const std::size_t n = polygon.size(), first = corners_.size();
  for (const CutCorner& c : polygon)
    corners_.push_back(c.point >= 0 ? c.point : numbers.of(c.at));
  for (std::size_t k = 0; k < n; ++k) {
    const CutCorner& c = polygon[k];
    if (c.box_side < 0) {
      add_side(face, side_lines[scene_->faces()[face].first_corner + c.side]);
      continue;
    }
    add_side(face, static_cast<int>(lines.size()));
    lines.push_back({{corners_[first + k], corners_[first + (k + 1) % n]},
                     {-1, {scene_->faces()[face].facet, -1}, c.box_side}});
  }
}

// A line may be longer than the sides on it: an edge goes on from face to face.
void CutFaces::cut_lines(std::size_t count, PointNumbers& numbers,
                         std::vector<ViewLine>& lines) const {
  for (std::size_t l = 0; l < count; ++l) {
    auto& ends = lines[l].ends;
    const Point &a = scene_->point(ends[0]), &b = scene_->point(ends[1]);
    bool whole = facet_[l] != kNone;
    for (int side = 0; side < BoxCut::kSides; ++side) {
      whole &= box_.within(side, a) != Sign::Negative &&
               box_.within(side, b) != Sign::Negative;
    }
    if (whole) continue;
    const std::array given{exact_point(a), exact_point(b)};
    const auto left = facet_[l] == kNone ? std::nullopt : box_.clip(given);
    for (int i = 0; i < 2; ++i) {
      if (!left) ends[i] = -1;
      if (left && (*left)[i] != given[i]) ends[i] = numbers.of((*left)[i]);
    }
  }
}

bool CutFaces::leaves_one_facet(int edge) const {
  const int facet = facet_[edge];
  return facet >= 0 &&
         std::ranges::any_of(scene_->edges()[edge].sides, [&](const Edge::Side& side) {
           return scene_->faces()[side.face].facet != facet;
         });
}

}  // namespace sightline::internal
