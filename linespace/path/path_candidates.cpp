#include "linespace/path/path_candidates.h"

#include "linespace/work/stop_scope.h"

namespace sightline::internal {

PathCandidates::PathCandidates(const PathScene& scene, const SightPath& path)
    : scene_(&scene), path_(&path) {
  add_planes();
}

void PathCandidates::add(const SeenElements& seen) {
  for (const auto& [line, edges] : seen.lines()) {
    if (lines_.insert(line).second) add_line(line);
  }
  for (const auto& [point, vertices] : seen.points()) {
    if (points_.insert(point).second) add_point(point);
  }
  for (const auto& [pair, vertices] : seen.pairs()) {
    if (pairs_.insert(pair).second) add_pair(pair);
  }
}

void PathCandidates::add_planes() {
  for (const Facet& facet : scene_->scene().scene().facets()) {
    hear_stop();
    // A bent facet has a plane for each face.
    const std::size_t planes = facet.planar ? 1 : facet.faces.size();
    for (std::size_t i = 0; i < planes; ++i) add_plane(facet.faces[i]);
  }
}

void PathCandidates::add_plane(int face) {
  const Scene& scene = scene_->scene().scene();
  const int facet = scene.faces()[face].facet;
  std::array<PathPoint, 3> p;
  const auto t = plane_points(scene, face);
  for (int k = 0; k < 3; ++k) p[k] = {exact_point(scene.point(t[k])), scene.point(t[k])};
  if (const auto root = path_->in_plane(p[0], p[1], p[2])) {
    by_root_[*root].push_back({Candidate::Kind::Plane, facet, -1, -1});
  } else if (path_->stays_in_plane(p[0], p[1], p[2])) {
    for (const int f : scene.facets()[facet].faces) add_lines_in_plane(f);
  }
}

// Where an eye that stays in the plane of a face passes its sides' lines.
void PathCandidates::add_lines_in_plane(int face) {
  const Scene& scene = scene_->scene().scene();
  const auto t = plane_points(scene, face);
  const ExactPoint at = exact_point(scene.point(t[0]));
  const ExactPoint n = exact_cross(exact_difference(exact_point(scene.point(t[1])), at),
                                   exact_difference(exact_point(scene.point(t[2])), at));
  for (int k = 0; k < scene.faces()[face].corner_count; ++k) {
    const int line = scene_->scene().line_of_side(face, k);
    if (line < 0) continue;
    const PathLine& l = scene_->lines()[line];
    ExactPoint off = l.a.exact;
    for (int i = 0; i < 3; ++i) off[i] += n[i];
    if (const auto root = path_->in_plane(l.a, l.b, {off, rounded(off)}))
      by_root_[*root].push_back({Candidate::Kind::EyeOnLine, line, -1, -1});
  }
}

void PathCandidates::add_line(int line) {
  const PathLine& l = scene_->lines()[line];
  for (int p = 0; p < static_cast<int>(scene_->points().size()); ++p) {
    hear_stop();
    const auto root = path_->in_plane(l.a, l.b, scene_->points()[p].at);
    if (root && in_line(path_->rounded(root->rounded()), line, p))
      by_root_[*root].push_back({Candidate::Kind::LinePoint, line, -1, p});
  }
}

void PathCandidates::add_point(int point) {
  const PathPoint& p = scene_->points()[point].at;
  for (int line = 0; line < static_cast<int>(scene_->lines().size()); ++line) {
    hear_stop();
    const PathLine& l = scene_->lines()[line];
    const auto root = path_->in_plane(l.a, l.b, p);
    if (!root) continue;
    const RoundedEye eye = path_->rounded(root->rounded());
    if (behind(eye, line, p.rounded))
      by_root_[*root].push_back({Candidate::Kind::PointLine, point, -1, line});
  }
}

void PathCandidates::add_pair(const LinePair& pair) {
  const std::span<const PathLine> lines = scene_->lines();
  for (int line = 0; line < static_cast<int>(lines.size()); ++line) {
    hear_stop();
    const int whole = scene_->scene().whole_line(line);
    if (whole == pair.first || whole == pair.second) continue;
    const auto plausible = [&](double u) {
      return in_line(path_->rounded(u), pair, line);
    };
    for (const PathRoot& root : path_->in_one_point(
             {&lines[pair.first], &lines[pair.second], &lines[line]}, plausible)) {
      if (plausible(root.rounded())) {
        by_root_[root].push_back(
            {Candidate::Kind::PairLine, pair.first, pair.second, line});
      }
    }
  }
}

// p is seen on the same side as `from`, not on the other side of the eye.
bool PathCandidates::before_eye(const RoundedEye& eye, const Point& from,
                                const Point& p) const {
  if (eye.is_direction) return true;
  const Eigen::Vector3d d = from - eye.at;
  return d.dot(p - eye.at) > -kDepthMargin * scene_->size() * d.norm();
}

// A point that is known to be on the line's picture lies behind the line.
bool PathCandidates::in_line(const RoundedEye& eye, int line, int point) const {
  const Point& x = scene_->points()[point].at.rounded;
  const auto seen = seen_in_line(eye, scene_->lines()[line], x, scene_->size());
  if (!seen) return true;
  const auto [from, to] = scene_->range(line);
  return seen->ratio > from - kRatioMargin && seen->ratio < to + kRatioMargin &&
         seen->depth < kDepthMargin * scene_->size() && before_eye(eye, x, seen->at);
}

// Where the line is seen behind x; nullopt where it is not.  In doubt it is x itself.
std::optional<Point> PathCandidates::behind(const RoundedEye& eye, int line,
                                            const Point& x) const {
  const auto seen = seen_in_line(eye, scene_->lines()[line], x, scene_->size());
  if (!seen) return x;
  if (seen->ratio < -kRatioMargin || seen->ratio > 1 + kRatioMargin ||
      seen->depth < -kDepthMargin * scene_->size()) {
    return std::nullopt;
  }
  return seen->at;
}

// The point of the pair's farther line that is seen where they cross; nullopt in doubt.
std::optional<Point> PathCandidates::crossing(const RoundedEye& eye,
                                              const LinePair& pair) const {
  const PathLine& far = scene_->lines()[pair.second];
  const auto ratio = seen_crossing(eye, far, scene_->lines()[pair.first], scene_->size());
  if (!ratio) return std::nullopt;
  return at_ratio(far, *ratio);
}

bool PathCandidates::in_line(const RoundedEye& eye, const LinePair& pair,
                             int line) const {
  const auto x = crossing(eye, pair);
  if (!x) return true;
  const PathLine& far = scene_->lines()[pair.second];
  const Eigen::Vector3d way = far.b.rounded - far.a.rounded;
  const double ratio = way.dot(*x - far.a.rounded) / way.squaredNorm();
  const auto [low, high] = scene_->range(pair.second);
  if (ratio < low - kRatioMargin || ratio > high + kRatioMargin) return false;
  const auto near = seen_in_line(eye, scene_->lines()[pair.first], *x, scene_->size());
  if (near) {
    const auto [from, to] = scene_->range(pair.first);
    if (near->ratio < from - kRatioMargin || near->ratio > to + kRatioMargin ||
        near->depth > kDepthMargin * scene_->size() || !before_eye(eye, *x, near->at)) {
      return false;
    }
  }
  return behind(eye, line, *x).has_value();
}

bool PathCandidates::may_change(const Candidate& candidate, const PathRoot& root,
                                const SeenElements& seen) const {
  const RoundedEye eye = path_->rounded(root.rounded());
  switch (candidate.kind) {
    case Candidate::Kind::LinePoint:
      return seen.may_show_point(eye, candidate.a, candidate.c);
    case Candidate::Kind::PointLine: {
      const auto y = behind(eye, candidate.c, scene_->points()[candidate.a].at.rounded);
      return y && seen.may_show_behind_point(candidate.a, *y);
    }
    case Candidate::Kind::PairLine: {
      const LinePair pair{candidate.a, candidate.b};
      const auto x = crossing(eye, pair);
      if (!x) return true;
      const auto y = behind(eye, candidate.c, *x);
      return y && seen.may_show_behind_pair(pair, *y);
    }
    case Candidate::Kind::Plane:
      return seen.shows_facet(candidate.a);
    case Candidate::Kind::EyeOnLine:
      return true;
  }
  return true;
}

}  // namespace sightline::internal
