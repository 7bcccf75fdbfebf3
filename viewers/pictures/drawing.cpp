#include "viewers/drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "linespace/work/stage.h"
#include "viewers/clip.h"
#include "viewers/envelope.h"
#include "viewers/kinds.h"
#include "viewers/palette.h"

namespace sightline::viewers {
namespace {

constexpr Colour kInk{0.17F, 0.18F, 0.22F};

Point normal_of(const Scene& scene, int face) {
  const std::span<const int> ids = scene.face_points(face);
  const Point& a = scene.point(ids[0]);
  return (scene.point(ids[1]) - a).cross(scene.point(ids[2]) - a).normalized();
}

double area_of(const Scene& scene, int face) {
  const std::span<const int> ids = scene.face_points(face);
  Point twice = Point::Zero();
  for (std::size_t i = 2; i < ids.size(); ++i) {
    const Point& a = scene.point(ids[0]);
    twice += (scene.point(ids[i - 1]) - a).cross(scene.point(ids[i]) - a);
  }
  return 0.5 * twice.norm();
}

/// The object looks like a solid from everywhere: its faces' normals, weighted by area,
/// cancel, as those of every closed surface do, also where the file's edges do not match.
bool encloses_solid(const Scene& scene, const Object& object) {
  if (object.closed) return !object.inside_out;
  Point sum = Point::Zero();
  double area = 0;
  for (const int f : object.faces) {
    const double a = area_of(scene, f);
    sum += a * normal_of(scene, f);
    area += a;
  }
  return sum.norm() <= 1e-6 * area;
}

/// Some point of the object lies in the plane of that axis at that coordinate.
bool touches_plane(const Scene& scene, const Object& object, int axis, double at) {
  return std::ranges::any_of(object.faces, [&](int f) {
    return std::ranges::any_of(scene.face_points(f),
                               [&](int p) { return scene.point(p)[axis] == at; });
  });
}

/// The faces left when the walls between the eye and the scene are taken away.
std::vector<char> faces_shown(const Scene& scene, const Point& towards_eye) {
  const auto [low, high] = scene.bounds();
  const Point extent = high - low;
  std::vector<char> shown(scene.faces().size(), 1);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(towards_eye[axis]) < 0.15 || extent[axis] <= 0) continue;
    const double sign = towards_eye[axis] > 0 ? 1 : -1;
    const double wall = sign > 0 ? high[axis] : low[axis];
    const double thickness = 0.12 * extent[axis];
    const auto is_near = [&](int f) {
      return std::ranges::all_of(scene.face_points(f), [&](int p) {
        return sign * (wall - scene.point(p)[axis]) <= thickness;
      });
    };
    std::vector<char> near(scene.faces().size());
    double facing_out = 0, facing_in = 0;
    for (std::size_t f = 0; f < near.size(); ++f) {
      const int face = static_cast<int>(f);
      if (!(near[f] = is_near(face))) continue;
      const double lean = sign * normal_of(scene, face)[axis];
      if (lean > 0.9) facing_out += area_of(scene, face);
      if (lean < -0.9) facing_in += area_of(scene, face);
    }
    const double side = extent.prod() / extent[axis];
    if (std::max(facing_out, facing_in) < 0.5 * side) continue;
    for (const Object& object : scene.objects()) {
      // A closed thing goes whole or stays; a shelf on the wall stays.
      if (object.closed && (!std::ranges::all_of(object.faces, [&](int f) {
            return near[f];
          }) || !touches_plane(scene, object, axis, wall))) {
        continue;
      }
      for (const int f : object.faces) {
        if (near[f]) shown[f] = 0;
      }
    }
  }
  return shown;
}

Drawing draw_faces(const Scene& scene, const std::vector<char>& shown) {
  Drawing drawing;
  const std::vector<Colour> colours = object_colours(scene);
  std::vector<char> solid;
  for (const Object& object : scene.objects()) {
    solid.push_back(encloses_solid(scene, object) ? 1 : 0);
  }
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    if (!shown[f]) continue;
    const Face& face = scene.faces()[f];
    const std::span<const int> ids = scene.face_points(static_cast<int>(f));
    const bool closed = scene.solid_behind(static_cast<int>(f));
    for (std::size_t i = 2; i < ids.size(); ++i) {
      drawing.triangles.push_back(
          {{scene.point(ids[0]), scene.point(ids[i - 1]), scene.point(ids[i])},
           colours[face.object],
           closed,
           face.facet,
           solid[face.object] != 0});
    }
  }
  return drawing;
}

void add_edges(Drawing& drawing, const Scene& scene, const std::vector<char>& shown,
               const Point& eye, const std::optional<std::array<Point, 2>>& box) {
  std::vector<std::array<Point, 2>> seen;
  for (const Edge& edge : scene.edges()) {
    const bool is_seen = std::ranges::any_of(edge.sides, [&](const Edge::Side& side) {
      if (!shown[side.face]) return false;
      const Point& p = scene.point(scene.face_points(side.face)[0]);
      return !scene.solid_behind(side.face) ||
             normal_of(scene, side.face).dot(eye - p) > 0;
    });
    if (!is_seen) continue;
    const std::array<Point, 2> ends{scene.point(edge.points[0]),
                                    scene.point(edge.points[1])};
    if (const auto part = box ? clip_segment(ends, *box) : std::optional(ends))
      seen.push_back(*part);
  }
  // Fine meshes would be black with edges: fewer pixels and less ink for more edges.
  const double crowd = static_cast<double>(box ? seen.size() : scene.edges().size());
  const float opacity = static_cast<float>(std::clamp(900 / crowd, 0.07, 0.8));
  const float width = crowd > 3000 ? 0.8F : 1.4F;
  for (const std::array<Point, 2>& ends : seen) {
    drawing.strokes.push_back({ends, kInk, width, opacity});
  }
}

/// Of the facets that count.
double entropy(const std::vector<int>& ids, const std::vector<char>& counts) {
  std::map<int, int> pixels;
  for (const int id : ids) ++pixels[id < 0 || counts[id] ? id : -1];
  double sum = 0;
  for (const auto& [id, count] : pixels) {
    if (id < 0) continue;
    const double p = static_cast<double>(count) / static_cast<double>(ids.size());
    sum -= p * std::log(p);
  }
  return sum;
}

}  // namespace

int guess_up_axis(const Scene& scene) {
  const Point extent = scene.bounds()[1] - scene.bounds()[0];
  int thinnest = 0;
  extent.minCoeff(&thinnest);
  double others = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != thinnest) others = std::min(others, extent[axis]);
  }
  if (extent[thinnest] < 0.7 * others) return thinnest;
  const std::string_view name = scene.soup().source;
  for (const std::string_view upright : {".stl", ".STL", ".ifc", ".IFC", ".ac", ".AC"}) {
    if (name.ends_with(upright)) return 2;
  }
  return 1;
}

namespace {

/// What the options leave of the faces.
Drawing faces_within(const Scene& scene, const std::vector<char>& shown,
                     const ViewOptions& options) {
  Drawing faces = draw_faces(scene, shown);
  return options.box ? clipped(faces, *options.box) : faces;
}

}  // namespace

SceneView view_scene(const Scene& scene, const ViewOptions& options) {
  // Unless it is told, the axis that points up is guessed from the scene.
  const int axis = options.up_axis >= 0 ? options.up_axis : guess_up_axis(scene);
  const Point up = Point::Unit(axis);
  const double aspect = static_cast<double>(options.width) / options.height;

  // 1. What the picture frames, and which facets count when views are compared: with a
  // focus, those with a corner in it.  The focus is framed with some of its surroundings.
  std::array<Point, 2> framed = options.box.value_or(scene.bounds());
  std::vector<char> counts(scene.facets().size(), 1);
  if (options.focus) {
    const auto& [low, high] = *options.focus;
    const Point margin = 0.25 * (high - low);
    framed = {framed[0].cwiseMax(low - margin), framed[1].cwiseMin(high + margin)};
    // A focus outside of the scene is framed alone.
    if ((framed[0].array() > framed[1].array()).any()) framed = *options.focus;
    for (std::size_t f = 0; f < counts.size(); ++f) {
      counts[f] = std::ranges::any_of(scene.facets()[f].faces, [&](int face) {
        const Point& p = scene.point(scene.face_points(face)[0]);
        return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
      });
    }
  }

  // 2. Inside of a box, or from an eye of the user's, all faces are shown; else the walls
  // between the eye and the scene are left away, which depends on the view.
  SceneView view;
  std::vector<char> shown(scene.faces().size(), 1);
  const bool whole = options.box || options.look;
  if (whole) view.drawing = faces_within(scene, shown, options);
  if (options.look) {
    view.camera = look_from(options.look->eye, options.look->at, framed, axis, aspect);
  } else {
    // 3. Without an eye: directions all around, at a few heights, each judged by how
    // evenly the picture is divided among facets (the entropy of their areas in a small
    // picture).
    // Large scenes take long to draw: fewer directions.
    const bool large = scene.faces().size() > 20000;
    const int turns = large ? 6 : 12;
    // What a box cuts open is best looked into from above.
    std::vector<double> elevations{0.42, 0.62};
    if (options.box) elevations.insert(elevations.end(), {0.85, 1.1});
    Point best = Point::Zero();
    double best_score = -1;
    internal::Stage stage(options.request, "choosing a view");
    std::size_t tried = 0;
    for (const double elevation : elevations) {
      for (int turn = 0; turn < turns; ++turn) {
        stage.check(static_cast<double>(tried++) /
                    static_cast<double>(elevations.size() * turns));
        const Point direction =
            eye_direction(axis, elevation, static_cast<double>(turn) / turns);
        const Camera camera = frame(framed, direction, up, aspect);
        // With a box the drawing is the same from everywhere: made once, above.
        const Drawing faces =
            whole ? Drawing{} : draw_faces(scene, faces_shown(scene, direction));
        const double score =
            entropy(visible_ids(whole ? view.drawing : faces, camera, 168, 118), counts);
        // Of views that are as good but for rounding the first one is taken: the same on
        // every machine.
        if (score > best_score * (1 + 1e-9)) {
          best_score = score;
          best = direction;
        }
      }
    }
    // Drawings of views that were only tried are not kept.
    view.camera = frame(framed, best, up, aspect);
    if (!whole) {
      shown = faces_shown(scene, best);
      view.drawing = draw_faces(scene, shown);
    }
  }

  // 4. A polygon of the file is shown when one of the faces that it was cut into is.
  view.polygon_shown.assign(scene.soup().polygons.size(), 0);
  for (std::size_t f = 0; f < shown.size(); ++f) {
    if (shown[f]) view.polygon_shown[scene.faces()[f].source] = 1;
  }
  // Edges last: which of them are drawn depends on the faces shown and on the eye.
  add_edges(view.drawing, scene, shown, view.camera.eye, options.box);
  return view;
}

std::array<Point, 2> bounds_of(std::span<const VeilTriangle> veils,
                               std::span<const Stroke> strokes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<Point, 2> bounds = {Point::Constant(kInfinity), Point::Constant(-kInfinity)};
  const auto include = [&](std::span<const Point> points) {
    for (const Point& p : points) bounds = {bounds[0].cwiseMin(p), bounds[1].cwiseMax(p)};
  };
  for (const VeilTriangle& veil : veils) include(veil.points);
  for (const Stroke& stroke : strokes) include(stroke.points);
  return bounds;
}

SceneView view_marks(std::span<const VeilTriangle> veils, std::span<const Stroke> strokes,
                     const ViewOptions& options) {
  const std::array<Point, 2> framed =
      options.box ? *options.box : bounds_of(veils, strokes);
  const int axis = options.up_axis >= 0 ? options.up_axis : 2;
  const double aspect = static_cast<double>(options.width) / options.height;
  SceneView view;
  view.camera =
      options.look
          ? look_from(options.look->eye, options.look->at, framed, axis, aspect)
          : frame(framed, eye_direction(axis, 0.42, 0), Point::Unit(axis), aspect);
  return view;
}

void add_arcs(Drawing& drawing, const Scene& scene, const Skeleton& skeleton,
              std::span<const int> arcs, float opacity) {
  for (const int i : arcs) {
    const SkeletonArc& arc = skeleton.arcs[i];
    const Edge& edge = scene.edges()[arc.edge()];
    const Colour colour = colour_of_kind(kind_name(arc));
    const Point& v = scene.point(arc.vertex());
    const Point a = point_on_edge(scene, edge, arc.range[0]);
    const Point b = point_on_edge(scene, edge, arc.range[1]);
    drawing.veils.push_back({{v, a, b}, colour, opacity});
    drawing.strokes.push_back({{a, b}, colour, 1.6F, std::min(1.0F, 4 * opacity)});
  }
}

std::vector<std::array<Point, 2>> rungs_of(const Scene& scene, const SkeletonArc& arc) {
  const double size = (scene.bounds()[1] - scene.bounds()[0]).norm();
  const auto swath = swath_of(scene, arc);
  return swath ? swath->rungs(arc.range, kEeeDeviation * size)
               : std::vector<std::array<Point, 2>>{};
}

double spanned_volume(const Scene& scene, const SkeletonArc& arc) {
  const auto swath = swath_of(scene, arc);
  return swath ? swath->spanned_volume(arc.range) : 0;
}

void add_eee_arc(Drawing& drawing, const Scene& scene, const SkeletonArc& arc,
                 float opacity) {
  const Colour colour = colour_of_kind(kind_name(arc));
  const std::vector<std::array<Point, 2>> rungs = rungs_of(scene, arc);
  for (std::size_t i = 1; i < rungs.size(); ++i) {
    const auto& [p0, q0] = rungs[i - 1];
    const auto& [p1, q1] = rungs[i];
    drawing.veils.push_back({{p0, q0, p1}, colour, opacity});
    drawing.veils.push_back({{q0, q1, p1}, colour, opacity});
  }
}

void add_edge(Drawing& drawing, const Scene& scene, int edge, const Colour& colour,
              float width, float hidden_opacity) {
  const auto& ends = scene.edges()[edge].points;
  drawing.strokes.push_back(
      {{scene.point(ends[0]), scene.point(ends[1])}, colour, width, 1, hidden_opacity});
}

RuledStrip ruled_strip(const Scene& scene, const SkeletonLines& lines,
                       const Skeleton& skeleton, int arc, int count) {
  const SkeletonArc& a = skeleton.arcs[arc];
  struct Rung {
    double t;  // 0 at the arc's one end, 1 at the other
    FarEnds ends;
  };
  const auto rung_at = [&](double t) {
    const double s = a.range[0] + t * (a.range[1] - a.range[0]);
    return Rung{t, *far_ends(scene, lines, a, s)};
  };
  // The two rungs next to the change between x and y, to a picture's accuracy.
  const auto add_change = [&](RuledStrip& strip, Rung x, Rung y) {
    for (int step = 0; step < 12; ++step) {
      Rung middle = rung_at(0.5 * (x.t + y.t));
      (middle.ends.faces == x.ends.faces ? x : y) = std::move(middle);
    }
    strip.rungs.push_back(std::move(x.ends));
    strip.rungs.push_back(std::move(y.ends));
  };
  RuledStrip strip{arc, {}};
  std::optional<Rung> last;
  for (int i = 0; i < count; ++i) {
    // The ends of the open interval are not part of the arc: stay a little inside.
    Rung rung = rung_at((i + 1e-3) / (count - 1 + 2e-3));
    if (last && last->ends.faces != rung.ends.faces) add_change(strip, *last, rung);
    strip.rungs.push_back(rung.ends);
    last = std::move(rung);
  }
  return strip;
}

void add_strip(SceneView& view, const Scene& scene, const Skeleton& skeleton,
               const RuledStrip& strip, float opacity) {
  const SkeletonArc& arc = skeleton.arcs[strip.arc];
  const Colour colour = colour_of_kind(kind_name(arc));
  const Point& v = scene.point(arc.vertex());
  for (std::size_t i = 1; i < strip.rungs.size(); ++i) {
    const FarEnds& a = strip.rungs[i - 1];
    const FarEnds& b = strip.rungs[i];
    for (int end = 0; end < 2; ++end) {
      if (a.faces[end] != b.faces[end]) continue;
      // Both halves are fans from the vertex, through which all lines of the arc pass.
      const std::vector<int>& faces = a.faces[end];
      const bool lands = std::ranges::any_of(
          faces, [&](int polygon) { return view.polygon_shown[polygon] != 0; });
      view.drawing.veils.push_back(
          {{v, a.points[end], b.points[end]}, colour, lands ? opacity : 0.3F * opacity});
      if (lands) {
        view.drawing.strokes.push_back({{a.points[end], b.points[end]},
                                        colour,
                                        2.2F,
                                        std::min(1.0F, 9 * opacity),
                                        std::min(0.25F, 2 * opacity)});
      }
    }
  }
}

void add_nodes(Drawing& drawing, const Skeleton& skeleton, std::span<const int> nodes,
               float opacity, float width) {
  for (const int i : nodes) {
    const SkeletonNode& node = skeleton.nodes[i];
    drawing.strokes.push_back(
        {node.segment, colour_of_kind(kind_name(node)), width, opacity, 0.12F * opacity});
  }
}

void add_box(Drawing& drawing, const std::array<Point, 2>& box, const Colour& colour) {
  const auto corner = [&](int i) {
    return Point(box[i & 1].x(), box[(i >> 1) & 1].y(), box[(i >> 2) & 1].z());
  };
  for (int i = 0; i < 8; ++i) {
    for (int bit = 1; bit < 8; bit <<= 1) {
      if (i & bit) continue;
      drawing.strokes.push_back({{corner(i), corner(i | bit)}, colour, 2, 0.9F, 0.35F});
    }
  }
}

std::vector<int> evenly_spread(std::size_t size, std::size_t limit) {
  std::vector<int> chosen;
  const std::size_t count = std::min(size, limit);
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(static_cast<int>(i * size / count));
  }
  return chosen;
}

}  // namespace sightline::viewers
