#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "linespace/numbers/rational.h"
#include "shadows/small_blockers.h"

namespace sightline {

using namespace internal;

namespace {

// Faces of an object that hang together by corners, in order of the first.
std::vector<std::vector<int>> parts_of(const Scene& scene, const Object& object) {
  std::vector<int> root(object.faces.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  std::map<int, int> first;  // face with that point
  for (std::size_t i = 0; i < object.faces.size(); ++i) {
    for (const int p : scene.face_points(object.faces[i])) {
      const int at = first.try_emplace(p, static_cast<int>(i)).first->second;
      const int a = find(at), b = find(static_cast<int>(i));
      root[std::max(a, b)] = std::min(a, b);
    }
  }
  std::map<int, std::vector<int>> parts;
  for (std::size_t i = 0; i < object.faces.size(); ++i)
    parts[find(static_cast<int>(i))].push_back(object.faces[i]);
  std::vector<std::vector<int>> all;
  for (auto& [_, faces] : parts) all.push_back(std::move(faces));
  return all;
}

// Every side is used equally often in both directions.
bool is_closed(const Scene& scene, const std::vector<int>& faces) {
  std::map<std::array<int, 2>, int> uses;
  for (const int f : faces) {
    const auto points = scene.face_points(f);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const int p = points[k], q = points[(k + 1) % points.size()];
      uses[{std::min(p, q), std::max(p, q)}] += p < q ? 1 : -1;
    }
  }
  return std::ranges::all_of(uses, [](const auto& use) { return use.second == 0; });
}

bool is_shorter(const Point& p, const Point& q, double length) {
  const ExactPoint way = exact_difference(exact_point(q), exact_point(p));
  return exact_dot(way, way) < Rational(length) * Rational(length);
}

// May not be taken out part by part, or not at all.
bool is_hollow(const Scene& scene, int number) {
  const Object& object = scene.objects()[number];
  return object.inside_out ||
         std::ranges::any_of(object.faces, [&](int f) { return scene.turned(f); }) ||
         std::ranges::any_of(scene.hollows(), [&](const Scene::Hollow& hollow) {
           return hollow.object == number;
         });
}

}  // namespace

std::vector<SmallPart> small_parts(const Scene& scene, double feature_size,
                                   const std::vector<int>& kept) {
  if (!(std::isfinite(feature_size) && feature_size >= 0))
    throw InvalidInput("a feature size must be finite and not below 0");
  std::vector<SmallPart> small;
  if (feature_size == 0) return small;
  std::vector<std::uint8_t> is_kept(scene.faces().size(), 0);
  for (const int f : kept) is_kept[f] = 1;
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    const Object& object = scene.objects()[o];
    if (object.faces.empty() || is_hollow(scene, static_cast<int>(o))) continue;
    auto parts = parts_of(scene, object);
    if (!object.closed && parts.size() > 1 &&
        std::ranges::any_of(parts, [&](const auto& p) { return is_closed(scene, p); })) {
      parts = {object.faces};
    }
    for (std::vector<int>& faces : parts) {
      if (std::ranges::any_of(faces, [&](int f) { return is_kept[f] != 0; })) continue;
      Point low = scene.point(scene.face_points(faces.front())[0]), high = low;
      SmallPart part{static_cast<int>(o), std::move(faces), {}, 0};
      for (const int f : part.faces) {
        part.polygons.push_back(scene.faces()[f].source);
        for (const int p : scene.face_points(f)) {
          low = low.cwiseMin(scene.point(p));
          high = high.cwiseMax(scene.point(p));
        }
      }
      if (!is_shorter(low, high, feature_size)) continue;
      std::ranges::sort(part.polygons);
      const auto [from, to] = std::ranges::unique(part.polygons);
      part.polygons.erase(from, to);
      part.diagonal = (high - low).norm();
      small.push_back(std::move(part));
    }
  }
  return small;
}

}  // namespace sightline
