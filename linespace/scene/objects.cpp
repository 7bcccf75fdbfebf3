// Which faces make an object, and whether it is closed, convex, solid.

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

#include "linespace/predicates.h"
#include "linespace/scene/scene.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Faces joined through the points they share, when label(face), from 0 to labels - 1, is
// the same.
template <class Label>
DisjointSets components(const Scene& scene, std::size_t labels, const Label& label) {
  DisjointSets sets(scene.faces().size());
  struct Latest {
    int point = -1;  // the last one where a face of this label was seen
    int face = -1;   // the first of them there
  };
  std::vector<Latest> latest(labels);
  for (std::size_t i = 0; i < scene.points().size(); ++i) {
    hear_stop();
    const int p = static_cast<int>(i);
    for (const int f : scene.faces_at(p)) {
      Latest& of_label = latest[label(f)];
      if (of_label.point == p) {
        sets.unite(f, of_label.face);
      } else {
        of_label = {p, f};
      }
    }
  }
  return sets;
}

// How often the ray from `from` through `to` passes through faces of the object; nullopt
// when it meets the border of one.  Requires that `from` is behind all the planes: then
// the ray leaves through a face iff it turns the right-handed way around all its sides.
std::optional<int> exits(const Scene& scene, const Object& object, const Point& from,
                         const Point& to) {
  int count = 0;
  for (const int f : object.faces) {
    const auto ids = scene.face_points(f);
    bool missed = false, touched = false;
    for (std::size_t i = 0; i < ids.size() && !missed; ++i) {
      const Sign s =
          orient3d(from, to, scene.point(ids[i]), scene.point(ids[(i + 1) % ids.size()]));
      missed = s == Sign::Negative;
      touched = touched || s == Sign::Zero;
    }
    if (missed) continue;
    if (touched) return std::nullopt;
    ++count;
  }
  return count;
}

std::vector<int> points_of(const Scene& scene, const Object& object) {
  std::vector<int> ids;
  for (const int f : object.faces) {
    const auto corners = scene.face_points(f);
    ids.insert(ids.end(), corners.begin(), corners.end());
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

Point mean(const Scene& scene, std::span<const int> ids) {
  Point sum = Point::Zero();
  for (const int p : ids) sum += scene.point(p) / static_cast<double>(ids.size());
  return sum.unaryExpr([](double x) { return std::abs(x) < 0x1p-140 ? 0 : x; });
}

bool behind_all(const Scene& scene, const Object& object, const Point& p, bool allow_on) {
  return std::all_of(object.faces.begin(), object.faces.end(), [&](int f) {
    hear_stop();
    const auto t = plane_corners(scene, f);
    const Sign s = orient3d(t[0], t[1], t[2], p);
    return s == Sign::Negative || (allow_on && s == Sign::Zero);
  });
}

// For a closed object without reflex or non-manifold edges.  Such a surface bounds a
// convex solid iff, from a point behind all its planes, a ray leaves through one face
// only (Mehlhorn et al. 1996, "Checking geometric programs or verification of geometric
// structures", theorem 7): linear.  An object so thin that the rounded mean of its points
// is not strictly inside gets the quadratic test of every point against every plane,
// unless it is large; then the answer is a cautious no.
bool bounds_convex_solid(const Scene& scene, const Object& object) {
  const auto ids = points_of(scene, object);
  const Point inside = mean(scene, ids);
  if (behind_all(scene, object, inside, false)) {
    const std::size_t tries = std::min<std::size_t>(8, object.faces.size());
    for (std::size_t i = 0; i < tries; ++i) {
      const int f = object.faces[i * object.faces.size() / tries];
      const auto corners = scene.face_points(f);
      const Point target = (scene.point(corners[0]) + 2 * scene.point(corners[1]) +
                            4 * scene.point(corners[2])) /
                           7;
      if (const auto count = exits(scene, object, inside, target)) return *count == 1;
    }
  }
  constexpr double kMostPairs = 4e6;
  if (static_cast<double>(ids.size()) * static_cast<double>(object.faces.size()) >
      kMostPairs) {
    return false;
  }
  return std::all_of(ids.begin(), ids.end(), [&](int p) {
    return behind_all(scene, object, scene.point(p), true);
  });
}

}  // namespace

void SceneBuilder::make_objects() {
  // 1. Polygons with a name: an object per name.  A polygon that several groups hold goes
  // with the first of them; a name that comes twice is one group.
  const auto& soup = scene.soup_;
  std::vector<int> object_of(soup.polygons.size(), -1);  // first: group of that name
  std::vector<std::string> names;
  std::unordered_map<std::string, int> number_of;
  std::unordered_set<std::string> aliases;  // name no object
  for (const auto& group : soup.groups) {
    const auto [entry, is_new] =
        number_of.emplace(group.name, static_cast<int>(names.size()));
    // An alias tells a group by another name: no object may take it for its own.
    if (is_new) names.push_back(group.name);
    aliases.insert(group.aliases.begin(), group.aliases.end());
    for (const int f : group.faces) {
      if (object_of[f] < 0) object_of[f] = entry->second;
    }
  }
  // 2. The same by face: a face has the name of the polygon that it was cut from.
  std::vector<int> group_of(scene.faces_.size());
  for (std::size_t f = 0; f < group_of.size(); ++f) {
    group_of[f] = object_of[scene.faces_[f].source];
  }
  // 3. Faces without a name: one object per component, component0 and so on.  Faces that
  // have a name do not connect others, and names that the file uses are passed over.
  if (std::find(group_of.begin(), group_of.end(), -1) != group_of.end()) {
    auto sets = components(scene, 2, [&](int f) { return group_of[f] < 0 ? 0 : 1; });
    std::vector<int> component(scene.faces_.size(), -1);
    int next = 0;
    for (std::size_t f = 0; f < group_of.size(); ++f) {
      if (group_of[f] >= 0) continue;
      // The component is named when its first face comes: by its smallest face.
      int& number = component[sets.find(static_cast<int>(f))];
      if (number < 0) {
        number = static_cast<int>(names.size());
        std::string name;
        do {
          name = "component" + std::to_string(next++);
        } while (number_of.contains(name) || aliases.contains(name));
        names.push_back(std::move(name));
      }
      component[f] = number;
    }
    for (std::size_t f = 0; f < group_of.size(); ++f) {
      if (group_of[f] < 0) group_of[f] = component[f];
    }
  }
  // 4. The objects, in the order in which the file names them.  Names that no usable face
  // has are not objects.
  std::vector<std::vector<int>> faces(names.size());
  for (std::size_t f = 0; f < group_of.size(); ++f) {
    faces[group_of[f]].push_back(static_cast<int>(f));
  }
  // Faces and object know each other; the name leads to the object, for those who ask.
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (faces[i].empty()) continue;
    const int object = static_cast<int>(scene.objects_.size());
    for (const int f : faces[i]) scene.faces_[f].object = object;
    scene.object_names_.emplace(names[i], object);
    scene.objects_.push_back({std::move(names[i]), std::move(faces[i]), true, false});
  }
}

void SceneBuilder::describe_objects() {
  auto sets = components(scene, scene.objects_.size(),
                         [&](int f) { return scene.faces_[f].object; });
  // By component: used equally often in both directions, edge by edge.
  std::vector<std::uint8_t> balanced(scene.faces_.size(), 1);
  for (std::size_t i = 0; i < half_edges.size();) {
    const auto edge = same_edge(half_edges, i);
    if (!is_balanced(edge)) {
      balanced[sets.find(edge[0].face)] = 0;
      scene.objects_[edge[0].object].closed = false;
    }
    i += edge.size();
  }
  for (std::size_t f = 0; f < scene.faces_.size(); ++f) {
    const int i = static_cast<int>(f);
    if (sets.find(i) == i && balanced[f]) ++scene.solids_;
  }
  for (std::size_t i = 0; i < scene.objects_.size(); ++i) {
    stage.at(i, scene.objects_.size());
    Object& object = scene.objects_[i];
    object.convex = object.closed && bulges[i] && bounds_convex_solid(scene, object);
  }
}

}  // namespace sightline::internal
