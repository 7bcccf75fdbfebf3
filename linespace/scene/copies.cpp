// Faces that an object lists more than once.

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "linespace/scene/scene.h"

namespace sightline::internal {
namespace {

// A face's points in their order, from the smallest on.
std::vector<int> ring_of(const Scene& scene, int face) {
  const auto ids = scene.face_points(face);
  std::vector<int> ring(ids.begin(), ids.end());
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

std::uint64_t hash_of(const std::vector<int>& ring, int object) {
  auto h = static_cast<std::uint64_t>(object);
  for (const int p : ring) {
    h = (h ^ static_cast<std::uint64_t>(p)) * 0x9E3779B97F4A7C15u;
    h ^= h >> 31;
  }
  return h;
}

// For each face the first one of its object with the same corners in the same cyclic
// order: itself, unless it is a copy.
std::vector<int> originals(const Scene& scene) {
  struct Entry {
    std::uint64_t hash;
    int face;
  };
  const int n = static_cast<int>(scene.faces().size());
  std::vector<Entry> entries;
  entries.reserve(n);
  for (int f = 0; f < n; ++f) {
    entries.push_back({hash_of(ring_of(scene, f), scene.faces()[f].object), f});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.face < b.face;
  });
  std::vector<int> original(n);
  for (std::size_t i = 0; i < entries.size();) {
    // Faces of one hash: nearly always copies of the first.
    std::vector<int> distinct;
    const std::uint64_t hash = entries[i].hash;
    for (; i < entries.size() && entries[i].hash == hash; ++i) {
      const int f = entries[i].face;
      const auto same = std::find_if(distinct.begin(), distinct.end(), [&](int g) {
        return scene.faces()[f].object == scene.faces()[g].object &&
               ring_of(scene, f) == ring_of(scene, g);
      });
      original[f] = same == distinct.end() ? f : *same;
      if (same == distinct.end()) distinct.push_back(f);
    }
  }
  return original;
}

// The corners of a polygon of the file, -0 as 0.
std::vector<std::array<double, 3>> corners_of(const PolygonSoup& soup, int polygon) {
  std::vector<std::array<double, 3>> corners;
  for (const int v : soup.polygons[polygon]) {
    const Point& p = soup.vertices[v];
    corners.push_back({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0});
  }
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
              corners.end());
  return corners;
}

}  // namespace

std::vector<int> repeated_faces(const Scene& scene,
                                const std::vector<std::uint8_t>& wanted) {
  std::vector<std::uint8_t> has_face(wanted.size(), 0);
  for (const Face& face : scene.faces()) has_face[face.source] = 1;
  const PolygonSoup& soup = scene.soup();
  // With the names of the objects that list them.
  std::set<std::pair<std::vector<std::array<double, 3>>, std::string>> missing;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == 0 || has_face[i] != 0 || soup.polygons[i].size() < 3) continue;
    const int polygon = static_cast<int>(i);
    const auto lists_it = [&](const PolygonSoup::Group& group) {
      return std::binary_search(group.faces.begin(), group.faces.end(), polygon);
    };
    const auto owner = std::find_if(soup.groups.begin(), soup.groups.end(), lists_it);
    missing.emplace(corners_of(soup, polygon),
                    owner == soup.groups.end() ? std::string() : owner->name);
  }
  std::vector<int> found;
  if (missing.empty()) return found;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const Face& face = scene.faces()[f];
    if (wanted[face.source] != 0) continue;
    const auto corners = corners_of(soup, face.source);
    if (missing.contains({corners, scene.objects()[face.object].name}) ||
        missing.contains({corners, std::string()})) {
      found.push_back(static_cast<int>(f));
    }
  }
  return found;
}

void SceneBuilder::drop_copies() {
  const std::vector<int> original = originals(scene);
  const int n = static_cast<int>(original.size());
  std::vector<int> id(n, -1);  // of the faces that stay
  std::vector<Face> kept;
  std::vector<int> corners;
  std::vector<std::uint8_t> diagonals;
  for (int f = 0; f < n; ++f) {
    if (original[f] != f) continue;
    id[f] = static_cast<int>(kept.size());
    Face face = scene.faces_[f];
    const int first = face.first_corner;
    face.first_corner = static_cast<int>(corners.size());
    for (int k = first; k < first + face.corner_count; ++k) {
      corners.push_back(scene.corners_[k]);
      diagonals.push_back(is_diagonal[k]);
    }
    kept.push_back(face);
  }
  if (kept.size() == scene.faces_.size()) return;
  scene.faces_ = std::move(kept);
  scene.corners_ = std::move(corners);
  is_diagonal = std::move(diagonals);
  for (Object& object : scene.objects_) {
    std::erase_if(object.faces, [&](int f) { return id[f] < 0; });
    for (int& f : object.faces) f = id[f];
  }
  index_faces();
}

}  // namespace sightline::internal
