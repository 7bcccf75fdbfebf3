#include "linespace/view/view_accidents.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "linespace/view/first_seen.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// A line of the scene that passes a point of the picture, as seen there.
struct Passing {
  int line;
  bool ahead, behind;  // it goes on towards its second end, its first end
};

// What passes one point of space: lines, and the corner that it may be.
struct Group {
  Rational nearness;
  std::vector<Passing> lines;
};

class PointInspector {
 public:
  PointInspector(const EyeSpace& eye, std::span<const std::uint8_t> possibly_seen,
                 PicturePoint at)
      : eye_(&eye), possibly_seen_(possibly_seen), at_(std::move(at)) {}

  std::optional<Accident> inspect(bool stretch);
  [[nodiscard]] bool goes_straight_on(int line);

 private:
  void find_lines();
  void add_line(int line);
  void leave_out_hidden();
  void leave_out_seams();
  [[nodiscard]] bool straight(const Group& group) const;
  [[nodiscard]] bool in_one_stretch() const;
  [[nodiscard]] int corner(const Group& group) const;
  [[nodiscard]] std::vector<ExactPoint> ways(const Passing& p) const;
  [[nodiscard]] std::vector<PictureRay> rays(std::span<const Passing> lines) const;
  [[nodiscard]] std::vector<int> patches_beside(const Rational& nearness,
                                                const PictureRay& ray) const;
  [[nodiscard]] bool is_seam(const Rational& nearness, const Passing& line) const;
  [[nodiscard]] Accident name() const;

  const EyeSpace* eye_;
  std::span<const std::uint8_t> possibly_seen_;
  PicturePoint at_;
  // A face with the point in its closed picture, and how near it is there.
  struct FaceThere {
    int face;
    Rational nearness;
  };
  std::vector<FaceThere> faces_;  // the nearest first
  std::vector<Group> groups_;
};

// The vector along which a passing line leaves the point, on either way on which it does.
std::vector<ExactPoint> PointInspector::ways(const Passing& p) const {
  const auto [a, b] = eye_->scene().lines()[p.line].ends;
  std::vector<ExactPoint> found;
  if (p.ahead) found.push_back(eye_->exact_vector(b));
  if (p.behind) found.push_back(eye_->exact_vector(a));
  return found;
}

void PointInspector::add_line(int line) {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  if (eye_->end_on(line)) return;
  const PicturePoint p(*eye_, a), q(*eye_, b);
  if (orient(p, q, at_) != Sign::Zero) return;
  const LineCuts cuts(*eye_, line);
  const auto [s, t] = cuts.shares(at_.exact());
  if (s < 0 || t < 0) return;
  const Rational nearness = cuts.nearness(at_.exact());
  auto group = std::ranges::find(groups_, nearness, &Group::nearness);
  if (group == groups_.end()) group = groups_.insert(group, Group{nearness, {}});
  if (std::ranges::find(group->lines, line, &Passing::line) == group->lines.end())
    group->lines.push_back({line, s > 0, t > 0});
}

void PointInspector::find_lines() {
  for (const int face : faces_near(*eye_, at_, possibly_seen_)) {
    const auto corners = eye_->scene().corners(face);
    const Sign front = eye_->front(face);
    bool within = true;
    for (std::size_t k = 0; k < corners.size() && within; ++k) {
      within = orient(PicturePoint(*eye_, corners[k]),
                      PicturePoint(*eye_, corners[(k + 1) % corners.size()]), at_) *
                   front !=
               Sign::Negative;
    }
    if (!within) continue;
    faces_.push_back({face, Nearness(*eye_, face).at(at_.exact())});
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int line = eye_->scene().line_of_side(face, static_cast<int>(k));
      if (line >= 0) add_line(line);
    }
    for (const int line : eye_->scene().crossings_of(face)) add_line(line);
  }
  std::ranges::sort(faces_, [](const FaceThere& x, const FaceThere& y) {
    return y.nearness < x.nearness;
  });
}

// Just beside all passing lines, on either side and either way.
std::vector<PictureRay> PointInspector::rays(std::span<const Passing> lines) const {
  std::vector<PictureRay> found;
  for (const Passing& p : lines) {
    const auto [a, b] = eye_->scene().lines()[p.line].ends;
    const ExactPoint n = exact_cross(eye_->exact_vector(a), eye_->exact_vector(b));
    for (const ExactPoint& way : ways(p)) {
      found.push_back({at_, {way, n}});
      found.push_back({at_, {way, {-n[0], -n[1], -n[2]}}});
    }
  }
  return found;
}

// Of what is farther than all that is seen around the point, no eye near by sees
// anything.
void PointInspector::leave_out_hidden() {
  const FaceThere* farthest = nullptr;
  for (const Group& g : groups_) {
    for (const PictureRay& ray : rays(g.lines)) {
      const auto seen = std::ranges::find_if(
          faces_, [&](const FaceThere& f) { return contains(*eye_, f.face, ray); });
      if (seen == faces_.end()) return;
      if (farthest == nullptr || seen->nearness < farthest->nearness) farthest = &*seen;
    }
  }
  if (farthest != nullptr)
    std::erase_if(groups_,
                  [&](const Group& g) { return g.nearness < farthest->nearness; });
}

// The patches that the faces at one depth show along a ray just beside a line there,
// ascending.  Behind them others may hang on the same line, as where flush boxes touch.
std::vector<int> PointInspector::patches_beside(const Rational& nearness,
                                                const PictureRay& ray) const {
  std::vector<int> shown;
  std::array<Rational, 2> nearest;
  for (const FaceThere& f : faces_) {
    if (f.nearness != nearness || !contains(*eye_, f.face, ray)) continue;
    const Nearness there(*eye_, f.face);
    const std::array<Rational, 2> here{there.at(ray.beside[0]), there.at(ray.beside[1])};
    if (!shown.empty() && here < nearest) continue;
    if (!shown.empty() && nearest < here) shown.clear();
    nearest = here;
    shown.push_back(eye_->scene().patch(eye_->scene().scene().faces()[f.face].facet,
                                        eye_->front(f.face) == Sign::Positive));
  }
  std::ranges::sort(shown);
  shown.erase(std::ranges::unique(shown).begin(), shown.end());
  return shown;
}

// The same patches are seen on either side, each way along the line.
bool PointInspector::is_seam(const Rational& nearness, const Passing& line) const {
  const std::vector<PictureRay> beside = rays(std::span(&line, 1));  // left, right, ...
  for (std::size_t i = 0; i < beside.size(); i += 2) {
    if (patches_beside(nearness, beside[i]) != patches_beside(nearness, beside[i + 1])) {
      return false;
    }
  }
  return true;
}

void PointInspector::leave_out_seams() {
  for (Group& g : groups_) {
    std::erase_if(g.lines, [&](const Passing& p) { return is_seam(g.nearness, p); });
  }
  std::erase_if(groups_, [](const Group& g) { return g.lines.empty(); });
}

// One line of space that goes straight on.
bool PointInspector::straight(const Group& g) const {
  const ViewScene& scene = eye_->scene();
  const auto [a, b] = scene.lines()[g.lines.front().line].ends;
  std::array<bool, 2> on{};
  for (const Passing& p : g.lines) {
    if (!scene.on_one_line(g.lines.front().line, p.line)) return false;
    const auto [c, d] = scene.lines()[p.line].ends;
    const ExactPoint u = exact_difference(scene.exact(b), scene.exact(a));
    const ExactPoint v = exact_difference(scene.exact(d), scene.exact(c));
    const bool same = exact_dot(u, v) > 0;
    on[same ? 0 : 1] |= p.ahead;
    on[same ? 1 : 0] |= p.behind;
  }
  return on[0] && on[1];
}

int PointInspector::corner(const Group& g) const {
  for (const Passing& p : g.lines) {
    const auto [a, b] = eye_->scene().lines()[p.line].ends;
    const int end = !p.ahead ? b : !p.behind ? a : -1;
    if (end >= 0 && !eye_->scene().is_constructed(end)) return end;
  }
  return -1;
}

Accident PointInspector::name() const {
  Accident found{};
  int corners = 0;
  for (const Group& g : groups_) {
    const bool simple = straight(g);
    const int point = simple ? -1 : corner(g);
    corners += simple ? 0 : 1;
    if (point >= 0) {
      found.generators.push_back({GeneratorKind::Vertex, point});
      continue;
    }
    for (const Passing& p : g.lines) {
      const MapLine& line = eye_->scene().lines()[p.line].name;
      if (line.edge >= 0) {
        found.generators.push_back({GeneratorKind::Edge, line.edge});
      } else {
        for (const int f : line.facets)
          if (f >= 0) found.generators.push_back({GeneratorKind::Face, f});
      }
    }
  }
  std::ranges::sort(found.generators);
  found.generators.erase(std::ranges::unique(found.generators).begin(),
                         found.generators.end());
  found.kind = corners > 1    ? AccidentKind::CornerOnCorner
               : corners == 1 ? AccidentKind::CornerOnEdge
                              : AccidentKind::ThreeEdges;
  return found;
}

// Of a line that is seen to end in the point.
bool PointInspector::goes_straight_on(int line) {
  find_lines();
  leave_out_seams();
  return std::ranges::any_of(groups_, [&](const Group& g) {
    return std::ranges::find(g.lines, line, &Passing::line) != g.lines.end() &&
           straight(g);
  });
}

// Of a point that some lines may share, or of one within a stretch that they may share.
std::optional<Accident> PointInspector::inspect(bool stretch) {
  find_lines();
  if (groups_.size() < 2) return std::nullopt;
  leave_out_hidden();
  leave_out_seams();
  if (groups_.size() < 2) return std::nullopt;
  if (in_one_stretch()) {
    if (!stretch) return std::nullopt;
    // Lines that continue each other are named as one.
    for (Group& g : groups_) {
      g.lines = {{eye_->scene().whole_line(g.lines[0].line), true, true}};
    }
    Accident found = name();
    found.kind = AccidentKind::AlongEdge;
    return found;
  }
  if (stretch) return std::nullopt;
  // One edge that passes behind another.
  if (groups_.size() == 2 && straight(groups_[0]) && straight(groups_[1]))
    return std::nullopt;
  return name();
}

// All that passes here are lines that go straight on, one behind the other.
bool PointInspector::in_one_stretch() const {
  const auto [a, b] = eye_->scene().lines()[groups_[0].lines.front().line].ends;
  return std::ranges::all_of(groups_, [&](const Group& g) {
    const auto [c, d] = eye_->scene().lines()[g.lines.front().line].ends;
    return straight(g) && eye_->orient(a, b, c) == Sign::Zero &&
           eye_->orient(a, b, d) == Sign::Zero;
  });
}

// Whether an eye near by would see a facet that is seen edge-on: does sight reach a point
// of its face just inside the middle of a part of its side, on either of its sides?
class EdgeOnFace {
 public:
  EdgeOnFace(const EyeSpace& eye, std::span<const std::uint8_t> possibly_seen, int face)
      : eye_(&eye), possibly_seen_(possibly_seen), face_(face) {}

  [[nodiscard]] bool exposed(int line, const std::array<LineCut, 2>& part) const {
    const ViewScene& scene = eye_->scene();
    const LineCuts cuts(*eye_, line);
    const auto [a, b] = scene.lines()[line].ends;
    const Rational middle = (cuts.exact(part[0]) + cuts.exact(part[1])) / 2;
    const ExactPoint on = along(scene.exact(a), scene.exact(b), middle);
    const ExactPoint inside = centroid();
    // A 2^-40th of the way into the face; and as much of that off it.
    const Rational step(0x1p-40);
    const ExactPoint point = along(on, inside, step);
    ExactPoint off = normal();
    const ExactPoint way = exact_difference(inside, on);
    const Rational scale = step * step * size(way) / size(off);
    for (Rational& x : off) x *= scale;
    return exposed(line, point, off) || exposed(line, point, {-off[0], -off[1], -off[2]});
  }

 private:
  static Rational size(const ExactPoint& v) { return abs(v[0]) + abs(v[1]) + abs(v[2]); }

  [[nodiscard]] ExactPoint centroid() const {
    const auto corners = eye_->scene().corners(face_);
    ExactPoint sum{};
    for (const int c : corners) {
      const ExactPoint p = eye_->scene().exact(c);
      for (int i = 0; i < 3; ++i) sum[i] += p[i];
    }
    for (Rational& x : sum) x /= static_cast<int>(corners.size());
    return sum;
  }

  [[nodiscard]] ExactPoint normal() const {
    const Scene& scene = eye_->scene().scene();
    const auto t = plane_points(scene, face_);
    const ExactPoint at = exact_point(scene.point(t[0]));
    return exact_cross(exact_difference(exact_point(scene.point(t[1])), at),
                       exact_difference(exact_point(scene.point(t[2])), at));
  }

  // On the side of the face to which `off` points.
  [[nodiscard]] bool exposed(int line, const ExactPoint& point,
                             const ExactPoint& off) const {
    ExactPoint over = point;
    for (int i = 0; i < 3; ++i) over[i] += off[i];
    if (eye_->scene().in_material(over)) return false;
    const auto [a, b] = eye_->scene().lines()[line].ends;
    ExactPoint left = exact_cross(eye_->exact_vector(a), eye_->exact_vector(b));
    if (exact_dot(left, eye_->vector_to(over)) < 0) {
      left = {-left[0], -left[1], -left[2]};
    }
    const ExactPoint vector = eye_->vector_to(point);
    const auto seen = first_seen(*eye_, {{*eye_, vector}, {left}}, possibly_seen_);
    return seen.empty() ||
           Nearness(*eye_, seen.front()).at(vector) <= eye_->height_of(point);
  }

  const EyeSpace* eye_;
  std::span<const std::uint8_t> possibly_seen_;
  int face_;
};

PicturePoint middle(const EyeSpace& eye, const Suspect& s) {
  const LineCuts cuts(eye, s.line);
  const auto [a, b] = eye.scene().lines()[s.line].ends;
  return {eye, along(eye.exact_vector(a), eye.exact_vector(b),
                     Rational((cuts.exact(s.at) + cuts.exact(*s.to)) / 2))};
}

void find_edge_on(const EyeSpace& eye, LineViewer& viewer,
                  std::span<const std::uint8_t> possibly_seen,
                  std::vector<Accident>& accidents) {
  const ViewScene& scene = eye.scene();
  std::vector<int> ends;
  for (int f = 0; f < static_cast<int>(possibly_seen.size()); ++f) {
    if (possibly_seen[f] == 0 || eye.front(f) != Sign::Zero) continue;
    hear_stop();
    const int facet = scene.scene().faces()[f].facet;
    const int sides = static_cast<int>(scene.corners(f).size());
    for (int k = 0; k < sides; ++k) {
      const int line = scene.line_of_side(f, k);
      if (line < 0) continue;
      if (eye.end_on(line)) {
        ends.push_back(line);
      } else if (std::ranges::any_of(viewer.parts_in_sight(line), [&](const auto& part) {
                   return EdgeOnFace(eye, possibly_seen, f).exposed(line, part);
                 })) {
        accidents.push_back({AccidentKind::EdgeOn, {{GeneratorKind::Face, facet}}});
      }
    }
  }
  // An edge seen end-on belongs to facets seen edge-on.
  for (const int line : ends) {
    const int edge = scene.lines()[line].name.edge;
    if (edge < 0) continue;
    const bool beside = std::ranges::any_of(
        scene.scene().edges()[edge].sides, [&](const Edge::Side& side) {
          const Generator facet{GeneratorKind::Face,
                                scene.scene().faces()[side.face].facet};
          return std::ranges::any_of(accidents, [&](const Accident& a) {
            return a.kind == AccidentKind::EdgeOn && a.generators.front() == facet;
          });
        });
    if (beside) accidents.push_back({AccidentKind::EndOn, {{GeneratorKind::Edge, edge}}});
  }
}

}  // namespace

SuspectPoints suspect_points(const EyeSpace& eye, const LineViewer& viewer) {
  SuspectPoints found;
  for (const Suspect& s : viewer.suspects()) {
    found.points.push_back(s.point >= 0 ? PicturePoint(eye, s.point)
                           : s.to       ? middle(eye, s)
                                        : PicturePoint(eye, s.line, s.at));
    found.in_stretch.push_back(s.to ? 1 : 0);
  }
  return found;
}

bool goes_straight_on(const EyeSpace& eye, const PicturePoint& point, int line,
                      std::span<const std::uint8_t> possibly_seen) {
  return PointInspector(eye, possibly_seen, point).goes_straight_on(line);
}

std::vector<Accident> find_accidents(const EyeSpace& eye, const Window& window,
                                     LineViewer& viewer, const SuspectPoints& suspects,
                                     std::span<const std::uint8_t> possibly_seen) {
  std::vector<Accident> found;
  find_edge_on(eye, viewer, possibly_seen, found);
  const std::vector<PicturePoint>& points = suspects.points;
  const std::vector<int> numbers = number_points(points);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    hear_stop();
    const bool stretch = suspects.in_stretch[i] != 0;
    if (numbers[i] != i && !stretch) continue;
    if (!window.contains(points[i])) continue;
    PointInspector inspector(eye, possibly_seen, points[i]);
    if (auto accident = inspector.inspect(stretch)) found.push_back(std::move(*accident));
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  return found;
}

}  // namespace sightline::internal
