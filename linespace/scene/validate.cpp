// What a scene must not contain, and what it may contain but should not.

#include <algorithm>
#include <cmath>
#include <limits>

#include "linespace/scene/scene.h"

namespace sightline {
namespace internal {
namespace {

// Nothing that predicates.h computes over- or underflows within these bounds.
constexpr double kSmallest = 0x1p-140;
constexpr double kLargest = 0x1p140;

std::string in_file(const PolygonSoup& soup, const std::string& message) {
  return soup.source.empty() ? message : soup.source + ": " + message;
}

}  // namespace

void SceneBuilder::report(std::string kind, std::string message, std::vector<int> faces,
                          std::vector<int> vertices) {
  scene.defects_.push_back(
      {std::move(kind), std::move(message), std::move(faces), std::move(vertices)});
}

void SceneBuilder::check_usable() const {
  const auto& soup = scene.soup_;
  const auto refuse = [&](const std::string& message) {
    throw InvalidInput(in_file(soup, message));
  };
  constexpr std::size_t kMost = std::numeric_limits<int>::max();
  if (soup.vertices.size() > kMost || soup.polygons.size() > kMost) {
    refuse("more than 2147483647 vertices or faces");
  }
  if (soup.polygons.empty()) refuse("no faces");
  if (soup.vertices.empty()) refuse("no vertices");
  for (std::size_t v = 0; v < soup.vertices.size(); ++v) {
    for (const double x : soup.vertices[v]) {
      const double size = std::abs(x);
      if (!std::isfinite(x)) {
        refuse("vertex " + std::to_string(v) + " has a coordinate that is not finite");
      }
      if (size != 0 && (size < kSmallest || size > kLargest)) {
        refuse("vertex " + std::to_string(v) +
               " has a coordinate outside [2^-140, 2^140] in magnitude");
      }
    }
  }
  const int vertex_count = static_cast<int>(soup.vertices.size());
  std::size_t corner_count = 0;
  for (std::size_t f = 0; f < soup.polygons.size(); ++f) {
    corner_count += soup.polygons[f].size();
    for (const int v : soup.polygons[f]) {
      if (v < 0 || v >= vertex_count) {
        refuse("face " + std::to_string(f) + " names vertex " + std::to_string(v) +
               " of " + std::to_string(vertex_count));
      }
    }
  }
  // A triangulated polygon has up to three corners for each of its own.
  if (corner_count > kMost / 3) refuse("more than 715827882 corners of faces");
  const int face_count = static_cast<int>(soup.polygons.size());
  for (const auto& group : soup.groups) {
    for (const int f : group.faces) {
      if (f < 0 || f >= face_count) {
        refuse("group '" + group.name + "' names face " + std::to_string(f) + " of " +
               std::to_string(face_count));
      }
    }
  }
}

// Two polygons of one object with the same corners are a defect either way round; of two
// objects only when they face the same way, because solids may touch.
void SceneBuilder::check_duplicates() {
  const auto& faces = scene.faces_;
  // A polygon of the file: faces [first, last) are its pieces.
  struct Polygon {
    std::uint64_t hash;
    int first, last;
  };
  // Fills `ids` with the polygon's points, ascending: the same for all its copies,
  // however they were cut.
  std::vector<int> ids;
  const auto points_of = [&](int first, int last) {
    ids.clear();
    for (int f = first; f < last; ++f) {
      const auto corners = scene.face_points(f);
      ids.insert(ids.end(), corners.begin(), corners.end());
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  };
  // 1. Hash every polygon by its points and its number of them.  Equal polygons come to
  // stand together, the first of the file first.
  std::vector<Polygon> polygons;
  polygons.reserve(faces.size());
  for (std::size_t f = 0; f < faces.size();) {
    // The pieces of a polygon stand together.
    std::size_t last = f + 1;
    while (last < faces.size() && faces[last].source == faces[f].source) ++last;
    points_of(static_cast<int>(f), static_cast<int>(last));
    std::uint64_t h = ids.size();
    for (const int id : ids) {
      h = (h ^ static_cast<std::uint64_t>(id)) * 0x9E3779B97F4A7C15u;
      h ^= h >> 31;
    }
    polygons.push_back({h, static_cast<int>(f), static_cast<int>(last)});
    f = last;
  }
  std::sort(polygons.begin(), polygons.end(), [](const Polygon& p, const Polygon& q) {
    return std::pair(p.hash, p.first) < std::pair(q.hash, q.first);
  });
  // Same front: some side of the file's polygon runs the same way in both.  Where two
  // copies share no side in either sense they count as facing the same way, so that they
  // are reported.
  const auto same_front = [&](const Polygon& p, const Polygon& q) {
    const auto a = scene.face_points(p.first);
    for (int f = q.first; f < q.last; ++f) {
      const auto b = scene.face_points(f);
      for (std::size_t i = 0; i < a.size(); ++i) {
        // A diagonal is no side of the polygon: copies may be cut differently.
        if (is_diagonal[faces[p.first].first_corner + i]) continue;
        const int from = a[i], to = a[(i + 1) % a.size()];
        for (std::size_t j = 0; j < b.size(); ++j) {
          const int next = b[(j + 1) % b.size()];
          if (from == b[j] && to == next) return true;
          if (to == b[j] && from == next) return false;
        }
      }
    }
    return true;
  };
  // 2. Pair each polygon with its next copy.  An equal hash is only a hint: the points
  // decide.
  std::vector<std::pair<int, int>> pairs;  // positions in `polygons`, first of its kind
  std::vector<int> ids_of_first;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    for (std::size_t j = i + 1;
         j < polygons.size() && polygons[j].hash == polygons[i].hash; ++j) {
      hear_stop();
      points_of(polygons[i].first, polygons[i].last);
      ids_of_first = ids;
      points_of(polygons[j].first, polygons[j].last);
      // Different polygons of one hash.
      if (ids != ids_of_first) continue;
      pairs.emplace_back(static_cast<int>(i), static_cast<int>(j));
      break;  // the next copy is reported with this one
    }
  }
  // 3. Report them in the order of the file, which the hashes have lost.
  std::sort(pairs.begin(), pairs.end(), [&](const auto& p, const auto& q) {
    return polygons[p.first].first < polygons[q.first].first;
  });
  for (const auto& [i, j] : pairs) {
    const Polygon& p = polygons[i];
    const Polygon& q = polygons[j];
    const bool same = same_front(p, q);
    // Where two objects touch face to face, the fronts differ: no defect.
    if (!same && faces[p.first].object != faces[q.first].object) continue;
    // Named by their numbers in the file.
    const int a = faces[p.first].source, b = faces[q.first].source;
    report("duplicate face",
           "faces " + std::to_string(a) + " and " + std::to_string(b) +
               " have the same corners" + (same ? "" : ", in opposite order"),
           {a, b});
  }
}

}  // namespace internal

std::vector<Defect> validate(const Scene& scene, const Request& request) {
  const internal::Stage stage(request, "looking for defects");
  std::vector<Defect> all(scene.defects().begin(), scene.defects().end());
  std::vector<Defect> touching = find_self_touching(scene);
  all.insert(all.end(), std::make_move_iterator(touching.begin()),
             std::make_move_iterator(touching.end()));
  return all;
}

}  // namespace sightline
