#include "tests/support/view_comparison.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "tests/support/generators.h"
#include "tests/support/naive_picture.h"

namespace sightline::testing {
namespace {

const char* name(MapVertexKind kind) {
  constexpr std::array kNames{"corner", "T", "touch", "accident"};
  return kNames[static_cast<int>(kind)];
}
const char* name(MapEdgeKind kind) {
  constexpr std::array kNames{"silhouette", "crease",   "valley", "boundary",
                              "contact",    "crossing", "cut"};
  return kNames[static_cast<int>(kind)];
}

std::string text(const std::vector<int>& numbers) {
  std::string result("{");
  for (const int n : numbers) result += std::to_string(n) + " ";
  return result + "}";
}
std::string text(const Point& p) {
  std::ostringstream out;
  out.precision(12);
  out << "(" << p[0] << ", " << p[1] << ", " << p[2] << ")";
  return out.str();
}
Point rounded(const Vec3& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]),
          static_cast<double>(v[2])};
}
std::string text(const NaiveLine& line) {
  std::string result("edges ");
  result += text(line.edges) + " crossing";
  for (const auto& [f, g] : line.crossings) {
    result += std::string(" ") + std::to_string(f) + "x" + std::to_string(g);
  }
  return result;
}
std::string text(const MapLine& line) {
  return "edge " + std::to_string(line.edge) + " crossing " +
         std::to_string(line.facets[0]) + "x" + std::to_string(line.facets[1]);
}

bool is_part_of(const MapLine& line, const NaiveLine& naive) {
  if (line.edge < 0) return std::ranges::binary_search(naive.crossings, line.facets);
  return std::ranges::binary_search(naive.edges, line.edge);
}

bool near(const Point& a, const Point& b) {
  return (a - b).norm() <= 1e-9 * std::max({1.0, a.norm(), b.norm()});
}
bool near(std::optional<double> a, std::optional<double> b, double absolute) {
  if (a.has_value() != b.has_value()) return false;
  return !a || std::abs(*a - *b) <= std::max(1e-12 * std::abs(*b), absolute);
}

class Comparison {
 public:
  Comparison(const NaiveEye& eye, const NaiveView& naive, const PointView& view)
      : eye_(eye), naive_(naive), view_(view) {}

  std::vector<std::string> run() {
    same("place", static_cast<int>(view_.place), static_cast<int>(naive_.place));
    if (view_.place_ids != naive_.place_ids) {
      tell("place_ids: " + text(view_.place_ids) + ", naive " + text(naive_.place_ids));
    }
    compare_facets();
    if (naive_.place != EyePlace::Free && naive_.place != EyePlace::Inside) return found_;
    same("components", view_.components, naive_.components);
    same("background pieces", view_.background_pieces, naive_.background_pieces);
    if (view_.seams != naive_.seams_between_edges)
      same("seams", view_.seams, naive_.seams);
    compare_vertices();
    compare_edges();
    compare_regions();
    compare_boundaries();
    return found_;
  }

 private:
  void tell(const std::string& difference) { found_.push_back(difference); }
  void same(const std::string& what, long view, long naive) {
    if (view == naive) return;
    tell(what + ": " + std::to_string(view) + ", naive " + std::to_string(naive));
  }
  [[nodiscard]] double absolute() const {
    return eye_.kind == Viewpoint::Kind::Eye ? 1e-15 : 0;
  }

  void compare_facets() {
    std::map<int, const NaiveFacet*> naive;
    for (const NaiveFacet& f : naive_.facets) naive[f.facet] = &f;
    for (const SeenFacet& f : view_.facets) {
      const std::string facet = "facet " + std::to_string(f.facet);
      const auto at = naive.find(f.facet);
      if (at == naive.end()) {
        tell(facet + ": not seen by the naive view");
        continue;
      }
      same(facet + " front", f.front ? 1 : 0, at->second->front ? 1 : 0);
      same(facet + " pieces", f.pieces, at->second->pieces);
      if (!near(f.measure, at->second->measure, absolute())) {
        std::ostringstream out;
        out.precision(17);
        out << facet << " measure: " << f.measure << ", naive " << at->second->measure;
        tell(out.str());
      }
      naive.erase(at);
    }
    for (const auto& [facet, f] : naive) {
      tell("facet " + std::to_string(facet) + ": seen by the naive view only, " +
           std::to_string(f->measure));
    }
  }

  /// Where MapVertex::at should be.
  [[nodiscard]] Point in_picture(const NaiveVertex& v) const {
    if (eye_.kind == Viewpoint::Kind::Eye) {
      // Scaled before it is rounded: the eye may be very near.
      const Vec3 way = v.in_space - eye_.at;
      const Rational size =
          std::max({Rational(abs(way[0])), Rational(abs(way[1])), Rational(abs(way[2]))});
      return rounded(Rational(1 / size) * way).normalized();
    }
    const Rational share = dot(v.in_space, eye_.at) / dot(eye_.at, eye_.at);
    return rounded(v.in_space - share * eye_.at);
  }

  [[nodiscard]] bool same_vertex(const MapVertex& v, const NaiveVertex& naive,
                                 bool to_the_letter = false) const {
    if (!near(v.at, in_picture(naive))) return false;
    if (v.kind == MapVertexKind::Touch && naive.or_touch && !to_the_letter) return true;
    if (v.kind != naive.kind) return false;
    if (v.kind == MapVertexKind::Corner) return v.corner == naive.corner;
    if (v.kind != MapVertexKind::T) return true;
    return is_part_of(v.near, naive.near) && is_part_of(v.far, naive.far);
  }

  void compare_vertices() {
    std::vector<char> used(naive_.vertices.size(), 0), matched(view_.vertices.size(), 0);
    // From far away many are seen in nearly one point: what is the same to the letter is
    // matched first.
    for (const bool to_the_letter : {true, false}) {
      for (std::size_t i = 0; i < matched.size(); ++i) {
        for (std::size_t k = 0; k < used.size() && matched[i] == 0; ++k) {
          if (used[k] != 0) continue;
          if (!same_vertex(view_.vertices[i], naive_.vertices[k], to_the_letter))
            continue;
          used[k] = matched[i] = 1;
        }
      }
    }
    for (std::size_t i = 0; i < matched.size(); ++i) {
      const MapVertex& v = view_.vertices[i];
      if (matched[i] == 0) {
        tell(std::string("vertex ") + name(v.kind) + " corner " +
             std::to_string(v.corner) + " near " + text(v.near) + " far " + text(v.far) +
             " at " + text(v.at) + ": the library's only");
      }
    }
    for (std::size_t k = 0; k < used.size(); ++k) {
      const NaiveVertex& v = naive_.vertices[k];
      if (used[k] != 0) continue;
      tell(std::string("vertex ") + name(v.kind) + " corner " + std::to_string(v.corner) +
           " near " + text(v.near) + " far " + text(v.far) + " at " +
           text(in_picture(v)) + ": the naive one's only");
    }
  }

  [[nodiscard]] bool same_edge(const MapEdge& e, const NaiveEdge& naive) const {
    if (!is_part_of(e.line, naive.line)) return false;
    const auto ends = [&](int first, int second, int left, int right) {
      return near(e.segment[0], rounded(naive.in_space[first])) &&
             near(e.segment[1], rounded(naive.in_space[second])) &&
             same_vertex(view_.vertices[e.ends[0]], naive_.vertices[naive.ends[first]]) &&
             same_vertex(view_.vertices[e.ends[1]],
                         naive_.vertices[naive.ends[second]]) &&
             view_.regions[e.left].facets == naive_.regions[left].facets &&
             view_.regions[e.right].facets == naive_.regions[right].facets;
    };
    return ends(0, 1, naive.left, naive.right) || ends(1, 0, naive.right, naive.left);
  }
  [[nodiscard]] static bool same_kind(const MapEdge& e, const NaiveEdge& naive) {
    if (naive.several || naive.kinds.empty()) return true;
    return std::ranges::find(naive.kinds, e.kind) != naive.kinds.end();
  }

  void compare_edges() {
    std::vector<char> used(naive_.edges.size(), 0);
    for (const MapEdge& e : view_.edges) {
      bool found = false;
      for (std::size_t k = 0; k < used.size() && !found; ++k) {
        if (used[k] != 0 || !same_edge(e, naive_.edges[k])) continue;
        used[k] = 1;
        found = true;
        if (!same_kind(e, naive_.edges[k])) {
          tell("edge " + text(e.line) + " kind: " + name(e.kind) + ", naive " +
               name(naive_.edges[k].kinds[0]));
        }
      }
      if (found) continue;
      tell(std::string("edge ") + name(e.kind) + " " + text(e.line) + " from " +
           text(e.segment[0]) + " to " + text(e.segment[1]) + " left " +
           text(view_.regions[e.left].facets) + " right " +
           text(view_.regions[e.right].facets) + ": the library's only");
    }
    for (std::size_t k = 0; k < used.size(); ++k) {
      const NaiveEdge& e = naive_.edges[k];
      if (used[k] != 0) continue;
      tell(std::string("edge ") + (e.kinds.empty() ? "flat" : name(e.kinds[0])) + " " +
           text(e.line) + " from " + text(rounded(e.in_space[0])) + " to " +
           text(rounded(e.in_space[1])) + " left " + text(naive_.regions[e.left].facets) +
           " right " + text(naive_.regions[e.right].facets) + ": the naive one's only");
    }
  }

  void compare_regions() {
    std::vector<char> used(naive_.regions.size(), 0);
    for (const MapRegion& r : view_.regions) {
      bool found = false;
      for (std::size_t k = 0; k < used.size() && !found; ++k) {
        const NaiveRegion& naive = naive_.regions[k];
        if (used[k] != 0 || r.facets != naive.facets) continue;
        // The background's is what the others leave: not better than of all together.
        const double slack = naive.facets.empty() && eye_.kind == Viewpoint::Kind::Eye
                                 ? 1e-13
                                 : absolute();
        if (!near(r.measure, naive.measure, slack)) continue;
        used[k] = 1;
        found = true;
      }
      if (!found) {
        tell("region " + text(r.facets) + " measure " +
             (r.measure ? std::to_string(*r.measure) : "infinite") +
             ": the library's only");
      }
    }
    for (std::size_t k = 0; k < used.size(); ++k) {
      const NaiveRegion& r = naive_.regions[k];
      if (used[k] != 0) continue;
      tell("region " + text(r.facets) + " measure " +
           (r.measure ? std::to_string(*r.measure) : "infinite") +
           ": the naive one's only");
    }
  }

  /// Every side of every edge is once in the boundary of the region that is there.
  void compare_boundaries() {
    std::vector<int> walked(2 * view_.edges.size(), 0);
    for (int r = 0; r < static_cast<int>(view_.regions.size()); ++r) {
      for (const std::vector<int>& walk : view_.regions[r].boundary) {
        for (std::size_t i = 0; i < walk.size(); ++i) {
          const int here = walk[i], next = walk[(i + 1) % walk.size()];
          const MapEdge& e = view_.edges[here / 2];
          ++walked[here];
          if ((here % 2 == 0 ? e.left : e.right) != r ||
              e.ends[here % 2 == 0 ? 1 : 0] != view_.edges[next / 2].ends[next % 2]) {
            tell("boundary of region " + std::to_string(r) + " is no walk around it");
          }
        }
      }
    }
    for (std::size_t i = 0; i < walked.size(); ++i) {
      if (walked[i] == 1) continue;
      tell("side " + std::to_string(i) + " is in " + std::to_string(walked[i]) +
           " boundaries");
    }
  }

  const NaiveEye& eye_;
  const NaiveView& naive_;
  const PointView& view_;
  std::vector<std::string> found_;
};

/// Without the polygons that are marked; without its group, if that is empty then.
PolygonSoup without(const PolygonSoup& soup, const std::vector<char>& marked) {
  PolygonSoup result;
  result.vertices = soup.vertices;
  std::vector<int> number(soup.polygons.size(), -1);
  for (std::size_t f = 0; f < soup.polygons.size(); ++f) {
    if (marked[f] != 0) continue;
    number[f] = static_cast<int>(result.polygons.size());
    result.polygons.push_back(soup.polygons[f]);
  }
  for (const PolygonSoup::Group& group : soup.groups) {
    PolygonSoup::Group left{.name = group.name, .faces = {}};
    for (const int f : group.faces) {
      if (number[f] >= 0) left.faces.push_back(number[f]);
    }
    if (!left.faces.empty()) result.groups.push_back(std::move(left));
  }
  return result;
}

}  // namespace

Viewpoint viewpoint_of(const NaiveEye& eye) {
  // As fractions: decimal numbers would be rounded to doubles.
  std::array<std::string, 3> coordinates;
  for (int i = 0; i < 3; ++i) {
    coordinates[i] =
        Integer(numerator(eye.at[i])).str() + "/" + Integer(denominator(eye.at[i])).str();
  }
  return viewpoint(eye.kind, coordinates);
}

std::vector<std::string> differences(const NaiveEye& eye, const NaiveView& naive,
                                     const PointView& view) {
  return Comparison(eye, naive, view).run();
}

std::vector<std::string> SceneComparison::differences(const NaiveEye& eye,
                                                      bool general) const {
  try {
    const PointView view = index_.view(viewpoint_of(eye));
    std::vector<std::string> result = testing::differences(eye, viewer_.view(eye), view);
    if (general && view.general != viewer_.general(eye)) {
      result.push_back(view.general ? "general, naive not"
                                    : "not general, naive general");
    }
    return result;
  } catch (const std::exception& error) {
    return {std::string("exception: ") + error.what()};
  }
}

PolygonSoup smallest_differing(const PolygonSoup& soup, const NaiveEye& eye,
                               bool general) {
  PolygonSoup best = soup;
  const auto differs = [&](const PolygonSoup& s) {
    if (s.polygons.empty()) return false;
    const Scene scene(s);
    return !SceneComparison(scene).differences(eye, general).empty();
  };
  // Groups first: a solid without one face is a sheet, and another case.
  for (std::size_t g = 0; g < best.groups.size();) {
    std::vector<char> marked(best.polygons.size(), 0);
    for (const int f : best.groups[g].faces) marked[f] = 1;
    const PolygonSoup smaller = without(best, marked);
    if (differs(smaller)) {
      best = smaller;
    } else {
      ++g;
    }
  }
  for (std::size_t f = 0; f < best.polygons.size();) {
    std::vector<char> marked(best.polygons.size(), 0);
    marked[f] = 1;
    const PolygonSoup smaller = without(best, marked);
    if (differs(smaller)) {
      best = smaller;
    } else {
      ++f;
    }
  }
  return best;
}

std::vector<std::string> SceneComparison::structure_differences(
    const std::vector<NaiveEye>& eyes) const {
  std::vector<std::string> result;
  Random random(eyes.size());
  for (const NaiveEye& eye : eyes) {
    NaiveEye next = eye;
    for (Rational& x : next.at) x += Rational(random.integer(-64, 64), 512);
    if (eye.kind == Viewpoint::Kind::Direction && is_zero(next.at)) continue;
    PointView a, b;
    try {
      a = index_.view(viewpoint_of(eye));
      b = index_.view(viewpoint_of(next));
    } catch (const std::exception&) {
      continue;  // told by differences()
    }
    if (!a.general || !b.general) continue;
    const bool equal = a.structure == b.structure;
    if (equal == (viewer_.view(eye).structure == viewer_.view(next).structure)) continue;
    result.push_back(std::string(equal ? "equal" : "different") +
                     " structures, naive otherwise: " + report({}, eye, {}) + "and " +
                     report({}, next, {}));
  }
  return result;
}

namespace {

/// Solid angles by facet; nullopt for another structure.
std::optional<std::map<int, double>> solid_angles(const NaiveViewer& viewer,
                                                  const NaiveEye& eye,
                                                  const std::string& structure) {
  const NaiveView view = viewer.view(eye);
  if (view.structure != structure) return std::nullopt;
  std::map<int, double> result;
  for (const NaiveFacet& f : view.facets) result[f.facet] = f.measure;
  return result;
}

}  // namespace

std::vector<std::string> SceneComparison::gradient_differences(
    const NaiveEye& eye) const {
  if (eye.kind == Viewpoint::Kind::Direction) return {};
  PointView view;
  try {
    view = index_.view(viewpoint_of(eye));
  } catch (const std::exception&) {
    return {};  // told by differences()
  }
  if (!view.general) return {};
  const std::string structure = viewer_.view(eye).structure;
  constexpr double kStep = 0x1p-12;
  std::vector<std::string> result;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::map<int, double>> angles;  // at -2, -1, 1, 2 steps
    for (const int steps : {-2, -1, 1, 2}) {
      NaiveEye moved = eye;
      moved.at[axis] += Rational(steps * kStep);
      const auto found = solid_angles(viewer_, moved, structure);
      if (found) angles.push_back(*found);
    }
    if (angles.size() < 4) continue;
    for (const SeenFacet& f : view.facets) {
      const double wide = (angles[3][f.facet] - angles[0][f.facet]) / (4 * kStep);
      const double narrow = (angles[2][f.facet] - angles[1][f.facet]) / (2 * kStep);
      // They differ by half a squared step times the third derivative.
      if (std::abs(wide - narrow) > 1e-6) continue;
      const double expected = (4 * narrow - wide) / 3;
      if (f.gradient && std::abs((*f.gradient)[axis] - expected) <= 1e-8) continue;
      std::ostringstream out;
      out.precision(12);
      out << "facet " << f.facet << " gradient " << axis << ": "
          << (f.gradient ? (*f.gradient)[axis] : NAN) << ", by differences " << expected;
      result.push_back(out.str());
    }
  }
  return result;
}

namespace {

bool lies_on(const Scene& scene, const NaiveEye& eye) {
  if (eye.kind == Viewpoint::Kind::Direction) return false;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    if (face_holds(scene, f, eye.at)) return true;
  }
  return false;
}

/// The first difference without its numbers: what may be one fault has one.
std::string signature(const std::string& difference) {
  std::string result;
  for (const char c : difference) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) result += c;
  }
  return result;
}

}  // namespace

std::vector<std::string> compare_views(const ViewRun& run) {
  std::vector<std::string> result;
  std::uint64_t seed = run.seed;
  std::map<std::string, int> told;
  for (const ViewScene& each : run.large ? large_view_scenes() : view_scenes()) {
    if (++seed % run.every != 0) continue;
    const Scene scene(each.soup);
    const SceneComparison comparison(scene);
    const std::vector<NaiveEye> eyes = run.barely_off
                                           ? eyes_barely_off(scene, seed, run.eyes)
                                           : view_eyes(scene, seed, run.eyes);
    for (const NaiveEye& eye : eyes) {
      if (!run.on_scene && lies_on(scene, eye)) continue;
      if (comparison.differences(eye, run.general).empty()) continue;
      // Smaller than large, a scene would be another case.
      const PolygonSoup soup =
          run.large ? each.soup : smallest_differing(each.soup, eye, run.general);
      const Scene small(soup);
      const std::vector<std::string> found =
          SceneComparison(small).differences(eye, run.general);
      if (++told[signature(found[0])] > 2) continue;
      result.push_back(each.name + "\n" + report(soup, eye, found));
      if (static_cast<int>(result.size()) >= run.most_reports) return result;
    }
    if (!run.general) continue;
    for (const NaiveEye& eye : eyes) {
      const std::vector<std::string> found = comparison.gradient_differences(eye);
      if (found.empty() || ++told["gradient"] > 5) continue;
      result.push_back(each.name + "\n" + report(each.soup, eye, found));
    }
    for (const std::string& pair : comparison.structure_differences(eyes)) {
      if (++told["structures"] <= 5) result.push_back(each.name + " " + pair);
    }
  }
  return result;
}

std::string report(const PolygonSoup& soup, const NaiveEye& eye,
                   const std::vector<std::string>& differences) {
  std::ostringstream out;
  out.precision(17);
  out << (eye.kind == Viewpoint::Kind::Eye ? "from " : "direction ") << eye.at[0] << ","
      << eye.at[1] << "," << eye.at[2] << '\n';
  for (const std::string& d : differences) out << "  " << d << '\n';
  std::map<int, int> number;  // only vertices that are used
  const auto write = [&](int f) {
    std::ostringstream line;
    for (const int v : soup.polygons[f]) {
      const auto [at, fresh] = number.try_emplace(v, static_cast<int>(number.size()) + 1);
      const Point& p = soup.vertices[v];
      if (fresh) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      line << ' ' << at->second;
    }
    out << 'f' << line.str() << '\n';
  };
  for (const PolygonSoup::Group& group : soup.groups) {
    out << "o " << group.name << '\n';
    for (const int f : group.faces) write(f);
  }
  if (soup.groups.empty()) {
    for (int f = 0; f < static_cast<int>(soup.polygons.size()); ++f) write(f);
  }
  return out.str();
}

}  // namespace sightline::testing
