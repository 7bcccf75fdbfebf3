#include "tests/support/naive_view.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "tests/support/naive_borders.h"
#include "tests/support/naive_picture.h"
#include "tests/support/naive_sets.h"

namespace sightline::testing {
namespace {

bool meet(const std::vector<int>& a, const std::vector<int>& b) {
  return std::ranges::any_of(a,
                             [&](int x) { return std::ranges::find(b, x) != b.end(); });
}

/// A straight line in space, by its picture and the nearness along it.
using SpaceLine = std::pair<std::array<Integer, 3>, std::array<Rational, 3>>;

SpaceLine space_line(const Ray& line, const Vec3& nearness) {
  // Functions that differ by a multiple of the normal are equal on the line: the one
  // without that coordinate stands for them.
  const Vec3 h = line.rational();
  int k = 0;
  while (h[k].sign() == 0) ++k;
  return {line.exact(), nearness - Rational(nearness[k] / h[k]) * h};
}

/// The line through two points, the same for all pairs of its points.
std::string text_of_line(const Vec3& p, const Vec3& q) {
  const Vec3 way = q - p;
  int k = 0;
  while (way[k].sign() == 0) ++k;
  const Vec3 d = Rational(1 / way[k]) * way, moment = cross(p, d);
  std::string text;
  for (const Rational& x : {d[0], d[1], d[2], moment[0], moment[1], moment[2]}) {
    text += x.str() + ",";
  }
  return text;
}

/// A border between regions.
struct Piece {
  Border at;
  Vec3 nearness;  ///< of its points in space
  SpaceLine line;
  bool meeting;  ///< what is seen on both sides meets here
  NaiveLine name;
  std::optional<MapEdgeKind> kind;
  bool several = false;
};

class MapMaker {
 public:
  MapMaker(const Scene& scene, const NaiveViewer& viewer, const NaiveEye& eye)
      : scene_(scene),
        viewer_(viewer),
        lens_(eye),
        picture_(picture(scene, lens_)),
        borders_(borders(picture_.cells)),
        regions_(picture_.cells.size()) {
    for (const PictureCell& cell : picture_.cells) {
      labels_.push_back(label_of(cell));
      facets_.push_back(facets_of(cell));
    }
    for (int e = 0; e < static_cast<int>(scene.edges().size()); ++e) {
      const auto& ends = scene.edges()[e].points;
      const Vec3 a = lens_.picture(exact(scene.point(ends[0])));
      const Vec3 b = lens_.picture(exact(scene.point(ends[1])));
      const Vec3 n = cross(a, b);
      if (!is_zero(n)) scene_edges_[canonical(Ray(n))].push_back(e);
    }
    for (const int p : scene.corners()) {
      const Vec3 v = lens_.picture(exact(scene.point(p)));
      if (!is_zero(v)) corners_[Ray(v)].push_back(p);
    }
  }

  NaiveView run() {
    find_place();
    find_regions();
    find_facets();
    find_edges();
    find_vertices();
    view_.structure = structure_of(view_);
    return std::move(view_);
  }

 private:
  using Cells = std::vector<PictureCell>;

  /// Patches seen, ascending; {-1} for the background, {-2} where the eye's own solid is.
  [[nodiscard]] std::vector<int> label_of(const PictureCell& cell) const {
    if (cell.faces.empty()) return {cell.blocked ? -2 : -1};
    std::vector<int> result;
    for (const int f : cell.faces) {
      result.push_back(viewer_.patch_of(scene_.faces()[f].facet, picture_.front[f] != 0));
    }
    return sorted_set(result);
  }
  [[nodiscard]] std::vector<int> facets_of(const PictureCell& cell) const {
    std::vector<int> result;
    for (const int f : cell.faces) result.push_back(scene_.faces()[f].facet);
    return sorted_set(result);
  }
  [[nodiscard]] std::vector<int> objects_of(int cell) const {
    std::vector<int> result;
    for (const int f : picture_.cells[cell].faces) {
      result.push_back(scene_.faces()[f].object);
    }
    return sorted_set(result);
  }

  void find_place() {
    const auto found = [&](EyePlace place, std::vector<int> ids) {
      view_.place = place;
      view_.place_ids = sorted_set(std::move(ids));
      return !view_.place_ids.empty();
    };
    if (!lens_.is_direction()) {
      const Vec3& eye = lens_.at();
      std::vector<int> ids;
      for (const int p : scene_.corners()) {
        if (exact(scene_.point(p)) == eye) ids.push_back(p);
      }
      if (found(EyePlace::Corner, std::move(ids))) return;
      ids = {};
      for (int e = 0; e < static_cast<int>(scene_.edges().size()); ++e) {
        const auto& ends = scene_.edges()[e].points;
        if (segment_holds(exact(scene_.point(ends[0])), exact(scene_.point(ends[1])),
                          eye)) {
          ids.push_back(e);
        }
      }
      if (found(EyePlace::Edge, std::move(ids))) return;
      ids = {};
      for (int f = 0; f < static_cast<int>(scene_.faces().size()); ++f) {
        if (face_holds(scene_, f, eye)) ids.push_back(scene_.faces()[f].facet);
      }
      if (found(EyePlace::Facet, std::move(ids))) return;
      std::optional<std::vector<int>> solids;
      for (int i = 1; !solids; ++i) {
        solids =
            material(scene_, eye,
                     {Rational(7 * i + 1), Rational(i * i + 3), Rational(1 - 5 * i, 3)});
      }
      if (found(EyePlace::Inside, *solids)) return;
    }
    found(EyePlace::Free, {});
  }

  void find_regions() {
    Cells& cells = picture_.cells;
    for (const Border& i : borders_) {
      if (i.plus >= 0 && i.minus >= 0 && labels_[i.plus] == labels_[i.minus]) {
        regions_.join(i.plus, i.minus);
      }
    }
    for (int c = 0; c < static_cast<int>(cells.size()); ++c) {
      const int root = regions_.find(c);
      if (root == c) {
        region_number_[c] = static_cast<int>(view_.regions.size());
        view_.regions.push_back({{}, labels_[c], 0.0});
        if (labels_[c][0] == -1) ++view_.background_pieces;
      }
      NaiveRegion& region = view_.regions[region_number_[root]];
      region.facets.insert(region.facets.end(), facets_[c].begin(), facets_[c].end());
      region.facets = sorted_set(region.facets);
      if (cells[c].infinite) {
        region.measure.reset();
      } else if (region.measure) {
        *region.measure += measure(cells[c]);
      }
    }
    find_seams();
  }

  /// Maximal straight pieces on which the same facets of one region are beside.
  void find_seams() {
    std::map<Ray, int> bordering;  // whether edges of the map meet the ray
    for (const Border& i : borders_) {
      if (i.plus < 0 || i.minus < 0 || labels_[i.plus] == labels_[i.minus]) continue;
      ++bordering[i.begin];
      ++bordering[i.end];
    }
    std::map<std::pair<Ray, Ray>, std::vector<std::vector<int>>> seams;  // begin, line
    for (const Border& i : borders_) {
      if (i.plus < 0 || i.minus < 0 || labels_[i.plus] != labels_[i.minus]) continue;
      if (facets_[i.plus] == facets_[i.minus]) continue;
      seams[{i.begin, i.line}] = {facets_[i.plus], facets_[i.minus]};
    }
    for (const Border& i : borders_) {
      const auto here = seams.find({i.begin, i.line});
      if (here == seams.end()) continue;
      const auto next = seams.find({i.end, i.line});
      const bool ends = next == seams.end() || next->second != here->second;
      view_.seams += ends ? 1 : 0;
      view_.seams_between_edges += ends || bordering.contains(i.end) ? 1 : 0;
    }
  }

  [[nodiscard]] double measure(const PictureCell& cell) const {
    if (!lens_.is_direction()) return solid_angle(cell.cone);
    return static_cast<double>(lens_.scaled_area(cell.cone)) / lens_.length();
  }

  void find_facets() {
    const Cells& cells = picture_.cells;
    std::map<int, std::vector<int>> seen;  // cells by facet
    for (int c = 0; c < static_cast<int>(cells.size()); ++c) {
      for (const int f : facets_[c]) seen[f].push_back(c);
    }
    for (const auto& [facet, its_cells] : seen) {
      Sets pieces(cells.size());
      for (const Border& i : borders_) {
        if (i.plus < 0 || i.minus < 0) continue;
        const auto has = [&](int c) {
          return std::ranges::binary_search(facets_[c], facet);
        };
        if (has(i.plus) && has(i.minus)) pieces.join(i.plus, i.minus);
      }
      NaiveFacet result{facet, picture_.front[scene_.facets()[facet].faces[0]] != 0, 0, 0,
                        ""};
      Rational area = 0;
      for (const int c : its_cells) {
        result.pieces += pieces.find(c) == c ? 1 : 0;
        if (lens_.is_direction()) {
          area += lens_.scaled_area(cells[c].cone);
        } else {
          result.measure += solid_angle(cells[c].cone);
        }
      }
      if (lens_.is_direction()) {
        result.scaled_area = area.str();
        result.measure = static_cast<double>(area) / lens_.length();
      }
      view_.facets.push_back(std::move(result));
    }
  }

  /// Where in space a border of a picture is.
  static void place(Piece& piece, const std::vector<PictureCell>& cells) {
    const auto nearness_at = [&](int cell) -> std::optional<Vec3> {
      if (cells[cell].faces.empty()) return std::nullopt;
      return cells[cell].nearness;
    };
    const auto p = nearness_at(piece.at.plus), m = nearness_at(piece.at.minus);
    const Vec3 a = piece.at.begin.rational(), b = piece.at.end.rational();
    piece.meeting = p && m && dot(*p, a) == dot(*m, a) && dot(*p, b) == dot(*m, b);
    const Vec3 middle = between({piece.at.begin, piece.at.end}).rational();
    const bool take_plus = p && (!m || dot(*p, middle) > dot(*m, middle));
    piece.nearness = take_plus || !m ? p.value() : *m;
    piece.line = space_line(piece.at.line, piece.nearness);
  }

  /// The scene's edges on its line that overlap it.
  [[nodiscard]] std::vector<int> edges_under(const Piece& piece) const {
    std::vector<int> result;
    const auto candidates = scene_edges_.find(piece.at.line);
    if (candidates == scene_edges_.end()) return result;
    const Vec3 a = lens_.in_space(piece.at.begin, piece.nearness);
    const Vec3 b = lens_.in_space(piece.at.end, piece.nearness);
    for (const int e : candidates->second) {
      const auto& ends = scene_.edges()[e].points;
      const Vec3 p = exact(scene_.point(ends[0])), q = exact(scene_.point(ends[1]));
      // More than a point in common: on one line, one holds an end of the other inside,
      // or both have the same ends.
      if (!is_zero(cross(q - p, a - p)) || !is_zero(cross(q - p, b - p))) continue;
      const Rational x = dot(q - p, a - p), y = dot(q - p, b - p),
                     size = dot(q - p, q - p);
      if (std::max(x, y).sign() > 0 && std::min(x, y) < size) result.push_back(e);
    }
    return result;
  }

  /// The point is in the facet's inside.
  [[nodiscard]] bool inside_facet(int facet, const Vec3& point) const {
    bool inside = false;
    for (const int f : scene_.facets()[facet].faces) {
      if (!face_holds(scene_, f, point)) continue;
      inside = true;
      const auto corners = scene_.face_points(f);
      for (int k = 0; k < static_cast<int>(corners.size()); ++k) {
        const Vec3 a = exact(scene_.point(corners[k]));
        const Vec3 b = exact(scene_.point(corners[(k + 1) % corners.size()]));
        if (scene_.edge_of_side(f, k) >= 0 && segment_holds(a, b, point)) return false;
      }
    }
    return inside;
  }

  /// Facets that cut through each other where others are seen to meet: the edge may be
  /// read as their crossing.
  void note_hidden_crossings(Piece& piece) const {
    const Vec3 a = lens_.in_space(piece.at.begin, piece.nearness);
    const Vec3 b = lens_.in_space(piece.at.end, piece.nearness);
    const Vec3 middle = Rational(1, 2) * (a + b);
    std::vector<int> through;
    for (int f = 0; f < static_cast<int>(scene_.facets().size()); ++f) {
      const int face = scene_.facets()[f].faces[0];
      const Vec3 normal = face_normal(scene_, face).rational();
      const Vec3 corner = exact(scene_.point(scene_.face_points(face)[0]));
      if (dot(normal, a - corner).sign() == 0 && dot(normal, b - corner).sign() == 0 &&
          inside_facet(f, middle)) {
        through.push_back(f);
      }
    }
    for (const int f : through) {
      for (const int g : through) {
        const auto normal = [&](int facet) {
          return canonical(face_normal(scene_, scene_.facets()[facet].faces[0]));
        };
        if (f >= g || normal(f) == normal(g)) continue;
        piece.name.crossings.push_back({f, g});
        piece.several = true;
      }
    }
  }

  void name(Piece& piece) const {
    piece.name.edges = edges_under(piece);
    const int plus = piece.at.plus, minus = piece.at.minus;
    if (piece.meeting) {
      const Vec3 middle =
          lens_.in_space(between({piece.at.begin, piece.at.end}), piece.nearness);
      for (const int f : facets_[plus]) {
        for (const int g : facets_[minus]) {
          if (f == g || picture_.cells[plus].nearness == picture_.cells[minus].nearness ||
              !inside_facet(f, middle) || !inside_facet(g, middle)) {
            continue;
          }
          piece.kind = MapEdgeKind::Crossing;
          piece.name.edges.clear();
          piece.name.crossings.push_back({std::min(f, g), std::max(f, g)});
        }
      }
    }
    if (piece.kind) return;
    if (piece.meeting) note_hidden_crossings(piece);
    if (piece.name.edges.empty())
      throw std::logic_error("naive view: a border without edge");
    piece.several = piece.several || piece.name.edges.size() > 1 ||
                    objects_of(plus).size() > 1 || objects_of(minus).size() > 1;
    if (!piece.meeting) {
      std::size_t faces = 0;
      for (const int e : piece.name.edges) faces += scene_.edges()[e].sides.size();
      piece.kind = faces == 1 ? MapEdgeKind::Boundary : MapEdgeKind::Silhouette;
    } else if (!meet(objects_of(plus), objects_of(minus))) {
      piece.kind = MapEdgeKind::Contact;
    } else {
      // Does the other side's plane, continued, hide what is seen on this side?
      const Vec3 there = between(picture_.cells[plus].cone.corners).rational();
      const int nearer = sgn(Rational(dot(picture_.cells[minus].nearness, there) -
                                      dot(picture_.cells[plus].nearness, there)));
      if (nearer != 0)
        piece.kind = nearer > 0 ? MapEdgeKind::Crease : MapEdgeKind::Valley;
    }
  }

  [[nodiscard]] std::pair<int, int> regions_beside(const Piece& p) const {
    return {region_number_.at(regions_.find(p.at.plus)),
            region_number_.at(regions_.find(p.at.minus))};
  }
  [[nodiscard]] bool goes_on(const std::vector<int>& pieces) const {
    return pieces.size() == 2 && pieces_[pieces[0]].line == pieces_[pieces[1]].line &&
           regions_beside(pieces_[pieces[0]]) == regions_beside(pieces_[pieces[1]]);
  }

  void find_edges() {
    for (const Border& i : borders_) {
      if (i.plus < 0 || i.minus < 0 || labels_[i.plus] == labels_[i.minus]) continue;
      if (labels_[i.plus][0] < 0 && labels_[i.minus][0] < 0) continue;
      Piece piece{i, {}, {}, false, {}, {}};
      place(piece, picture_.cells);
      // Where the eye's own solid begins there may be no edge; such a map is not asked
      // for.
      if (labels_[i.plus][0] == -2 || labels_[i.minus][0] == -2) {
        piece.name.edges = edges_under(piece);
      } else {
        name(piece);
      }
      piece.name.in_space = text_of_line(lens_.in_space(piece.at.begin, piece.nearness),
                                         lens_.in_space(piece.at.end, piece.nearness));
      const int number = static_cast<int>(pieces_.size());
      pieces_.push_back(std::move(piece));
      around_[i.begin].push_back(number);
      around_[i.end].push_back(number);
    }
    Sets chains(pieces_.size());
    for (const auto& [ray, pieces] : around_) {
      if (goes_on(pieces)) chains.join(pieces[0], pieces[1]);
    }
    for (int i = 0; i < static_cast<int>(pieces_.size()); ++i) {
      if (chains.find(i) == i) {
        edge_number_[i] = static_cast<int>(view_.edges.size());
        view_.edges.emplace_back();
      }
      edge_of_.push_back(edge_number_[chains.find(i)]);
      add_to(view_.edges[edge_of_[i]], pieces_[i]);
    }
  }

  static void add_to(NaiveLine& line, const NaiveLine& more) {
    line.edges.insert(line.edges.end(), more.edges.begin(), more.edges.end());
    line.edges = sorted_set(line.edges);
    line.crossings.insert(line.crossings.end(), more.crossings.begin(),
                          more.crossings.end());
    line.crossings = sorted_set(line.crossings);
    line.in_space = more.in_space;
  }

  void add_to(NaiveEdge& edge, const Piece& piece) const {
    edge.several = edge.several || piece.several;
    if (piece.kind && std::ranges::find(edge.kinds, *piece.kind) == edge.kinds.end()) {
      edge.kinds.push_back(*piece.kind);
      std::ranges::sort(edge.kinds);
    }
    add_to(edge.line, piece.name);
    const auto [plus, minus] = regions_beside(piece);
    // Going from `begin` to `end` the positive side is on the left in a picture drawn
    // counter-clockwise, else on the right.
    edge.left = lens_.counterclockwise() ? plus : minus;
    edge.right = lens_.counterclockwise() ? minus : plus;
  }

  void find_vertices() {
    std::vector<std::vector<int>> ends(view_.edges.size());
    for (const auto& [ray, pieces] : around_) {
      if (goes_on(pieces)) continue;
      const int number = static_cast<int>(view_.vertices.size());
      view_.vertices.push_back(vertex(ray, pieces));
      for (const int p : pieces) {
        NaiveEdge& edge = view_.edges[edge_of_[p]];
        const int which = pieces_[p].at.begin == ray ? 0 : 1;
        edge.ends[which] = number;
        edge.in_space[which] = lens_.in_space(ray, pieces_[p].nearness);
      }
    }
    Sets components(view_.vertices.size());
    for (const NaiveEdge& edge : view_.edges) components.join(edge.ends[0], edge.ends[1]);
    for (int v = 0; v < static_cast<int>(view_.vertices.size()); ++v) {
      view_.components += components.find(v) == v ? 1 : 0;
    }
  }

  /// The line on which the piece lies does not end in space where it meets the ray.
  [[nodiscard]] bool goes_through(const Piece& piece, const Ray& ray) const {
    const Vec3 point = lens_.in_space(ray, piece.nearness);
    for (const auto& [f, g] : piece.name.crossings) {
      if (inside_facet(f, point) && inside_facet(g, point)) return true;
    }
    return std::ranges::any_of(piece.name.edges, [&](int e) {
      const auto& ends = scene_.edges()[e].points;
      return exact(scene_.point(ends[0])) != point &&
             exact(scene_.point(ends[1])) != point;
    });
  }

  /// How many ends of the border's two halves, or of the whole, lie on the ray.
  static int ends_on(const Border& border, const Ray& ray) {
    if (border.begin == ray || border.end == ray) return 1;
    const Vec3 n = border.line.rational(), v = ray.rational();
    if (dot(n, v).sign() != 0) return 0;
    return dot(n, cross(border.begin.rational(), v)).sign() > 0 &&
                   dot(n, cross(v, border.end.rational())).sign() > 0
               ? 2
               : 0;
  }

  /// In the picture of the faces alone that hold this point of the ray, all that is seen
  /// to begin, end or pass there is one line that goes straight on.
  [[nodiscard]] bool only_goes_straight_on(const Vec3& point, const Ray& ray) const {
    const Picture there = picture(scene_, lens_, point);
    std::vector<SpaceLine> lines;
    for (const Border& i : borders(there.cells)) {
      if (i.plus < 0 || i.minus < 0) continue;
      // Of eyes on the scene, whose map is not asked for.
      if (label_of(there.cells[i.plus])[0] < 0 && label_of(there.cells[i.minus])[0] < 0) {
        continue;
      }
      if (label_of(there.cells[i.plus]) == label_of(there.cells[i.minus])) continue;
      Piece piece{i, {}, {}, false, {}, {}};
      place(piece, there.cells);
      lines.insert(lines.end(), ends_on(i, ray), piece.line);
    }
    return lines.size() == 2 && lines[0] == lines[1];
  }

  [[nodiscard]] NaiveVertex vertex(const Ray& ray, const std::vector<int>& pieces) const {
    const Vec3 v = ray.rational();
    std::map<Rational, std::vector<int>, std::greater<>> by_nearness;
    for (const int p : pieces) by_nearness[dot(pieces_[p].nearness, v)].push_back(p);
    const std::vector<int>& nearest = by_nearness.begin()->second;
    NaiveVertex result{};
    result.in_space = lens_.in_space(ray, pieces_[nearest[0]].nearness);
    if (by_nearness.size() == 1) {
      result.kind = MapVertexKind::Touch;
      const auto candidates = corners_.find(ray);
      if (candidates == corners_.end()) return result;
      for (const int p : candidates->second) {
        if (exact(scene_.point(p)) != result.in_space) continue;
        result.kind = MapVertexKind::Corner;
        result.corner = p;
        result.or_touch = std::ranges::all_of(
            pieces, [&](int piece) { return goes_through(pieces_[piece], ray); });
      }
      return result;
    }
    const std::vector<int>& farthest = by_nearness.rbegin()->second;
    const bool straight =
        nearest.size() == 2 && pieces_[nearest[0]].line == pieces_[nearest[1]].line;
    if (by_nearness.size() == 2 && straight && farthest.size() == 1 &&
        only_goes_straight_on(lens_.in_space(ray, pieces_[farthest[0]].nearness), ray)) {
      result.kind = MapVertexKind::T;
      for (const int p : nearest) add_to(result.near, pieces_[p].name);
      result.far = pieces_[farthest[0]].name;
    } else {
      result.kind = MapVertexKind::Accident;
    }
    return result;
  }

  const Scene& scene_;
  const NaiveViewer& viewer_;
  Lens lens_;
  Picture picture_;
  std::vector<Border> borders_;
  std::vector<std::vector<int>> labels_, facets_;
  Sets regions_;
  std::map<int, int> region_number_, edge_number_;
  std::map<Ray, std::vector<int>> scene_edges_, corners_, around_;
  std::vector<Piece> pieces_;
  std::vector<int> edge_of_;
  NaiveView view_;
};

}  // namespace

NaiveView NaiveViewer::view(const NaiveEye& eye) const {
  return MapMaker(scene_, *this, eye).run();
}

bool NaiveViewer::general(const NaiveEye& eye) const {
  const NaiveView here = view(eye);
  if (here.place != EyePlace::Free && here.place != EyePlace::Inside) return false;
  const Rational tiny = Rational(1) / Rational(Integer(1) << 400);
  for (const auto& [x, y, z] : {std::array{389, -127, 811},
                                {-389, 127, -811},
                                {-97, 613, 241},
                                {503, 331, -179}}) {
    NaiveEye near = eye;
    near.at = near.at + tiny * Vec3{Rational(x), Rational(y), Rational(z)};
    if (view(near).structure != here.structure) return false;
  }
  return true;
}

}  // namespace sightline::testing
