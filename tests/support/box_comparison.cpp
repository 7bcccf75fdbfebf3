#include "tests/support/box_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <tuple>

#include "tests/support/view_comparison.h"

namespace sightline::testing {
namespace {

using Polygon = std::vector<Vec3>;

// The part with sign * (x[axis] - bound) >= 0, corner by corner.
Polygon part_of(const Polygon& polygon, int axis, const Rational& bound, int sign) {
  Polygon part;
  const auto off = [&](const Vec3& p) { return Rational(sign * (p[axis] - bound)); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Rational a = off(p), b = off(q);
    if (a >= 0) part.push_back(p);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      part.push_back(p + Rational(a / (a - b)) * (q - p));
    }
  }
  return part;
}

Vec3 normal(const Scene& scene, const Face& face) {
  const auto c = scene.face_points(static_cast<int>(&face - scene.faces().data()));
  const Vec3 at = exact(scene.point(c[0]));
  return cross(exact(scene.point(c[1])) - at, exact(scene.point(c[2])) - at);
}

bool has_area(const Polygon& p) {
  for (std::size_t i = 2; i < p.size(); ++i) {
    if (!is_zero(cross(p[i - 1] - p[0], p[i] - p[0]))) return true;
  }
  return false;
}

// Of every element of a view what both scenes call alike, facets by the numbers of the
// uncut scene.
struct Told {
  std::map<std::pair<int, bool>, std::pair<int, double>> facets;  // pieces, measure
  std::vector<std::pair<std::vector<int>, double>> regions;
  using Place = std::array<long, 3>;
  std::vector<std::tuple<Place, Place, std::vector<int>, std::vector<int>, int>> edges;
  std::array<int, 3> vertices{};  // corners and touches, Ts, accidents
  int components, background, seams;
  bool general;
};

using ToldEdge =
    std::tuple<Told::Place, Told::Place, std::vector<int>, std::vector<int>, int>;

Told::Place place(const Point& p) {
  return {std::lround(p[0] * 1e7), std::lround(p[1] * 1e7), std::lround(p[2] * 1e7)};
}

// In a side of the box the cut makes lines on edges of the scene, and which of these
// names the kind is a matter of order.
int kind_of(const MapEdge& e, const std::array<Vec3, 2>& box) {
  for (int side = 0; side < 6; ++side) {
    const auto bound = static_cast<double>(box[side / 3][side % 3]);
    if (e.segment[0][side % 3] == bound && e.segment[1][side % 3] == bound) return -1;
  }
  return static_cast<int>(e.kind);
}

Told told(const PointView& view, const std::vector<int>& facet,
          const std::array<Vec3, 2>& box) {
  const auto number = [&](int f) { return facet.empty() ? f : facet[f]; };
  const auto numbers = [&](const std::vector<int>& facets) {
    std::vector<int> result;
    for (const int f : facets) result.push_back(number(f));
    std::ranges::sort(result);
    result.erase(std::ranges::unique(result).begin(), result.end());
    return result;
  };
  Told t{};
  for (const SeenFacet& f : view.facets) {
    auto& [pieces, measure] = t.facets[{number(f.facet), f.front}];
    pieces += f.pieces;
    measure += f.measure;
  }
  for (const MapRegion& r : view.regions)
    t.regions.emplace_back(numbers(r.facets), r.measure.value_or(-1));
  std::ranges::sort(t.regions);
  for (const MapEdge& e : view.edges) {
    const auto beside = [&](int r) {
      return r < 0 ? std::vector{-1} : numbers(view.regions[r].facets);
    };
    std::array ends{place(e.segment[0]), place(e.segment[1])};
    std::array sides{beside(e.left), beside(e.right)};
    if (ends[1] < ends[0]) {
      std::swap(ends[0], ends[1]);
      std::swap(sides[0], sides[1]);
    }
    t.edges.emplace_back(ends[0], ends[1], sides[0], sides[1], kind_of(e, box));
  }
  std::ranges::sort(t.edges);
  for (const MapVertex& v : view.vertices) {
    ++t.vertices[v.kind == MapVertexKind::T          ? 1
                 : v.kind == MapVertexKind::Accident ? 2
                                                     : 0];
  }
  t.components = view.components;
  t.background = view.background_pieces;
  t.seams = view.seams;
  t.general = view.general;
  return t;
}

bool near(double a, double b) {
  return std::abs(a - b) <= std::max(1e-12 * std::abs(b), 1e-13);
}
bool near(const Told::Place& a, const Told::Place& b) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(a[i] - b[i]) > 1) return false;
  }
  return true;
}

std::string text(const ToldEdge& edge) {
  std::ostringstream out;
  const auto& [a, b, left, right, kind] = edge;
  for (const auto& p : {a, b}) out << p[0] << ' ' << p[1] << ' ' << p[2] << "  ";
  for (const int f : left) out << f << ' ';
  out << "| ";
  for (const int f : right) out << f << ' ';
  out << "kind " << kind;
  return out.str();
}

// The shortest may be told either way.
bool alike(const ToldEdge& e, const ToldEdge& o) {
  const auto& [from, to, left, right, kind] = e;
  const auto& [a, b, x, y, other_kind] = o;
  return kind == other_kind &&
         ((near(from, a) && near(to, b) && left == x && right == y) ||
          (near(from, b) && near(to, a) && left == y && right == x));
}

std::string edge_differences(const Told& mine, const Told& other) {
  std::vector<char> used(other.edges.size(), 0);
  std::string found;
  for (const auto& e : mine.edges) {
    bool matched = false;
    for (std::size_t k = 0; k < used.size() && !matched; ++k) {
      if (used[k] != 0 || !alike(e, other.edges[k])) continue;
      used[k] = 1;
      matched = true;
    }
    if (!matched) found += "\n    in the box only: " + text(e);
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (used[k] == 0) found += "\n    of the cut scene only: " + text(other.edges[k]);
  }
  return found;
}

void compare_facets(const Told& mine, const Told& other, const std::string& whose,
                    std::vector<std::string>& found) {
  if (mine.facets.size() != other.facets.size())
    found.push_back("numbers of facets seen, " + whose);
  for (const auto& [facet, seen] : mine.facets) {
    const auto at = other.facets.find(facet);
    const std::string name =
        "facet " + std::to_string(facet.first) + (facet.second ? "" : " (back)");
    if (at == other.facets.end()) {
      found.push_back(name + ": seen in the box only, " + whose);
    } else if (seen.first != at->second.first) {
      found.push_back(name + ": pieces, " + whose);
    } else if (!near(seen.second, at->second.second)) {
      found.push_back(name + ": measure, " + whose);
    }
  }
}

}  // namespace

BoxComparison::BoxComparison(const Scene& scene, const std::array<Vec3, 2>& box)
    : scene_(&scene), box_(box) {
  cut(box);
  if (!cut_) return;
  const auto position = [](const Vec3& p) {
    return viewpoint_of({Viewpoint::Kind::Eye, p}).at;
  };
  in_box_.emplace(scene, ViewBox{position(box[0]), position(box[1])});
  of_cut_.emplace(*cut_);
  naive_.emplace(*cut_);
}

void BoxComparison::cut(const std::array<Vec3, 2>& box) {
  const Scene& scene = *scene_;
  PolygonSoup soup;
  std::vector<int> from;  // face of the scene, by polygon
  std::map<Vec3, int> numbers;
  std::vector<char> loses(scene.objects().size(), 0);
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    PolygonSoup::Group group{.name = scene.objects()[o].name, .faces = {}};
    for (const int f : scene.objects()[o].faces) {
      Polygon polygon;
      for (const int p : scene.face_points(f)) polygon.push_back(exact(scene.point(p)));
      const Polygon whole = polygon;
      for (int axis = 0; axis < 3; ++axis) {
        polygon =
            part_of(part_of(polygon, axis, box[0][axis], 1), axis, box[1][axis], -1);
      }
      if (polygon != whole) loses[o] = 1;
      if (!has_area(polygon)) continue;
      cuts_a_face_ |= polygon != whole;
      // As the file has it: a room is turned when it is read again.
      if (scene.turned(f)) std::ranges::reverse(polygon);
      std::vector<int>& corners = soup.polygons.emplace_back();
      for (const Vec3& p : polygon) {
        const auto [it, fresh] = numbers.emplace(p, static_cast<int>(numbers.size()));
        corners.push_back(it->second);
        if (!fresh) continue;
        const Point rounded(static_cast<double>(p[0]), static_cast<double>(p[1]),
                            static_cast<double>(p[2]));
        if (exact(rounded) != p) return;
        soup.vertices.push_back(rounded);
      }
      group.faces.push_back(static_cast<int>(from.size()));
      from.push_back(f);
    }
    if (!group.faces.empty()) soup.groups.push_back(std::move(group));
  }
  if (soup.polygons.empty()) return;
  Scene cut_scene(std::move(soup));
  facet_.assign(cut_scene.facets().size(), -1);
  for (const Face& face : cut_scene.faces()) {
    const Face& whole = scene.faces()[from[face.source]];
    facet_[face.facet] = whole.facet;
    if (cut_scene.objects()[face.object].closed && loses[whole.object] != 0) return;
    if (dot(normal(cut_scene, face), normal(scene, whole)) < 0) return;
  }
  cut_.emplace(std::move(cut_scene));
}

std::vector<std::string> BoxComparison::differences(const NaiveEye& eye) const {
  std::vector<std::string> found;
  const PointView view = in_box_->view(viewpoint_of(eye));
  const PointView other_view = of_cut_->view(viewpoint_of(eye));
  const Told mine = told(view, {}, box_), other = told(other_view, facet_, box_);
  const auto same = [&](const char* what, long a, long b) {
    if (a == b) return;
    found.push_back(std::string(what) + ": " + std::to_string(a) +
                    " in the box, of the cut scene " + std::to_string(b));
  };
  const auto on_scene = [](EyePlace place) {
    return place != EyePlace::Free && place != EyePlace::Inside;
  };
  same("on the scene", on_scene(view.place) ? 1 : 0, on_scene(other_view.place) ? 1 : 0);
  same("inside", view.place == EyePlace::Inside ? 1 : 0,
       other_view.place == EyePlace::Inside ? 1 : 0);
  compare_facets(mine, other, "cut scene", found);
  same("corners and touches", mine.vertices[0], other.vertices[0]);
  same("T-vertices", mine.vertices[1], other.vertices[1]);
  same("accident vertices", mine.vertices[2], other.vertices[2]);
  same("components", mine.components, other.components);
  same("background pieces", mine.background, other.background);
  same("seams", mine.seams, other.seams);
  same("general", mine.general ? 1 : 0, other.general ? 1 : 0);
  same("regions", std::ssize(mine.regions), std::ssize(other.regions));
  for (std::size_t i = 0; i < std::min(mine.regions.size(), other.regions.size()); ++i) {
    if (mine.regions[i].first != other.regions[i].first ||
        !near(mine.regions[i].second, other.regions[i].second)) {
      found.emplace_back("a region");
    }
  }
  if (const std::string edges = edge_differences(mine, other); !edges.empty())
    found.push_back("edges:" + edges);

  const NaiveView naive = naive_->view(eye);
  Told naive_told{};
  for (const NaiveFacet& f : naive.facets) {
    auto& [pieces, measure] = naive_told.facets[{facet_[f.facet], f.front}];
    pieces += f.pieces;
    measure += f.measure;
  }
  compare_facets(mine, naive_told, "naive", found);
  if (!on_scene(view.place)) {
    same("edges (naive)", std::ssize(view.edges), std::ssize(naive.edges));
    same("vertices (naive)", std::ssize(view.vertices), std::ssize(naive.vertices));
    same("regions (naive)", std::ssize(view.regions), std::ssize(naive.regions));
    same("components (naive)", view.components, naive.components);
  }
  return found;
}

}  // namespace sightline::testing
