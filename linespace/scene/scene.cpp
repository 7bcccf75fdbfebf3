// From polygons to points and faces, and what is asked of a finished scene.

#include "linespace/scene.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "linespace/nearest_name.h"
#include "linespace/scene/scene.h"

namespace sightline {
namespace internal {
namespace {

// Bits of a coordinate such that equal numbers have equal bits: adding 0 turns -0 into 0.
std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x + 0.0); }

std::uint64_t hash_of(const Point& p) {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) {
    h = (h ^ bits_of(p[k])) * 0x9E3779B97F4A7C15u;
    h ^= h >> 29;
  }
  return h;
}

// Drops corners equal to the one before (cyclically), and there-and-back spikes a, b, a.
std::vector<int> without_spikes(std::span<const int> ring) {
  std::vector<int> kept;
  kept.reserve(ring.size());
  const auto settle = [&] {
    for (;;) {
      const std::size_t n = kept.size();
      if (n >= 2 && kept[n - 1] == kept[n - 2]) {
        kept.pop_back();
      } else if (n >= 3 && kept[n - 1] == kept[n - 3]) {
        kept.resize(n - 2);
      } else {
        return;
      }
    }
  };
  for (const int v : ring) {
    kept.push_back(v);
    settle();
  }
  // The same across the seam.
  std::size_t first = 0;
  for (;;) {
    const std::size_t n = kept.size() - first;
    if (n >= 2 && kept.back() == kept[first]) {
      kept.pop_back();
    } else if (n >= 3 && kept.back() == kept[first + 1]) {
      ++first;
      kept.pop_back();
    } else if (n >= 3 && kept[kept.size() - 2] == kept[first]) {
      kept.resize(kept.size() - 2);
    } else {
      break;
    }
  }
  kept.erase(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(first));
  return kept;
}

// File vertices of `polygon` whose coordinates an earlier corner of it has.
std::vector<int> repeated_vertices(std::span<const int> polygon,
                                   std::span<const int> weld) {
  if (polygon.size() == 3) {  // the common case, without allocation
    const int a = weld[polygon[0]], b = weld[polygon[1]], c = weld[polygon[2]];
    if (a != b && b != c && a != c) return {};
  }
  std::vector<std::pair<int, std::size_t>> seen;
  seen.reserve(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) seen.emplace_back(weld[polygon[i]], i);
  std::sort(seen.begin(), seen.end());
  std::vector<int> repeats;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    if (seen[i].first == seen[i - 1].first) repeats.push_back(polygon[seen[i].second]);
  }
  return repeats;
}

std::string format_length(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

}  // namespace

void SceneBuilder::run() {
  check_usable();
  scene.defects_ = scene.soup_.defects;
  weld_vertices();
  stage.begin("faces");
  make_faces();
  number_points();
  index_faces();
  stage.begin("objects");
  make_objects();
  check_duplicates();
  drop_copies();
  stage.begin("sides");
  collect_half_edges();
  stage.begin("shells");
  turn_shells();
  stage.begin("edges");
  classify_edges();
  stage.begin("straight edges");
  join_edges();
  stage.begin("solids");
  describe_objects();
  find_bounds();
}

void SceneBuilder::weld_vertices() {
  const auto& vertices = scene.soup_.vertices;
  const std::size_t capacity = std::bit_ceil(2 * vertices.size() + 1);
  std::vector<int> table(capacity, -1);
  weld.resize(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    stage.at(v, vertices.size());
    std::size_t slot = hash_of(vertices[v]) & (capacity - 1);
    while (table[slot] >= 0 && vertices[table[slot]] != vertices[v]) {
      slot = (slot + 1) & (capacity - 1);
    }
    if (table[slot] < 0) table[slot] = static_cast<int>(v);
    weld[v] = table[slot];
  }
}

void SceneBuilder::make_faces() {
  const auto& soup = scene.soup_;
  scene.faces_.reserve(soup.polygons.size());
  std::vector<int> ring;
  for (std::size_t i = 0; i < soup.polygons.size(); ++i) {
    stage.at(i, soup.polygons.size());
    const auto& polygon = soup.polygons[i];
    const int source = static_cast<int>(i);
    if (std::binary_search(options.without.begin(), options.without.end(), source))
      continue;
    const std::string name = "face " + std::to_string(source);
    if (polygon.size() < 3) {
      report("fewer than three corners",
             name + " has " + std::to_string(polygon.size()) + " corners", {source},
             polygon);
      continue;
    }
    ring.clear();
    for (const int v : polygon) ring.push_back(weld[v]);
    auto repeats = repeated_vertices(polygon, weld);
    if (!repeats.empty()) {
      const std::string message = name +
                                  " passes more than once through the place of vertex " +
                                  std::to_string(repeats.front());
      report("repeated vertex", message, {source}, std::move(repeats));
      ring = without_spikes(ring);
    }
    const PolygonPieces pieces = cut_into_pieces(soup.vertices, ring);
    if (pieces.zero_area) {
      report("zero area", name + " has zero area", {source});
      continue;
    }
    if (!pieces.planar) {
      report("non-planar polygon",
             name + " is not planar: its corners lie up to " +
                 format_length(pieces.off_plane) + " off their mean plane",
             {source});
    }
    if (pieces.crossing) {
      report("self-crossing polygon", name + " crosses itself", {source});
    } else if (!pieces.convex) {
      report("non-convex polygon", name + " is not convex: used as triangles", {source});
    }
    int first = 0;
    for (const int size : pieces.sizes) {
      scene.faces_.push_back(
          {static_cast<int>(scene.corners_.size()), size, source, -1, -1});
      scene.corners_.insert(scene.corners_.end(), pieces.corners.begin() + first,
                            pieces.corners.begin() + first + size);
      is_diagonal.insert(is_diagonal.end(), pieces.is_diagonal.begin() + first,
                         pieces.is_diagonal.begin() + first + size);
      first += size;
    }
  }
}

void SceneBuilder::number_points() {
  const auto& vertices = scene.soup_.vertices;
  std::vector<int> id(vertices.size(), -1);
  for (int& corner : scene.corners_) {
    const int v = corner;
    if (id[v] < 0) {
      id[v] = static_cast<int>(scene.points_.size());
      scene.points_.push_back((vertices[v].array() + 0.0).matrix());  // -0 becomes 0
      scene.point_vertices_.push_back(v);
    }
    corner = id[v];
  }
  std::vector<std::uint8_t> used(vertices.size(), 0);
  for (const auto& polygon : scene.soup_.polygons) {
    for (const int v : polygon) used[v] = 1;
  }
  std::vector<int> unused;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) unused.push_back(static_cast<int>(v));
  }
  if (!unused.empty()) {
    const std::string message = std::to_string(unused.size()) +
                                " vertices are used by no face, the first is " +
                                std::to_string(unused.front());
    report("unused vertex", message, {}, std::move(unused));
  }
}

void SceneBuilder::index_faces() {
  auto& starts = scene.face_starts_;
  starts.assign(scene.points_.size() + 1, 0);
  for (const int p : scene.corners_) ++starts[p + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  scene.face_ids_.resize(scene.corners_.size());
  std::vector<int> next(starts.begin(), starts.end() - 1);
  for (std::size_t f = 0; f < scene.faces_.size(); ++f) {
    for (const int p : scene.face_points(static_cast<int>(f))) {
      scene.face_ids_[next[p]++] = static_cast<int>(f);
    }
  }
}

void SceneBuilder::find_bounds() {
  // A scene of zero-area faces alone has no points; its file's vertices stand in.
  const auto& points = scene.points_.empty() ? scene.soup_.vertices : scene.points_;
  scene.bounds_ = {points.front(), points.front()};
  for (const Point& p : points) {
    scene.bounds_[0] = scene.bounds_[0].cwiseMin(p);
    scene.bounds_[1] = scene.bounds_[1].cwiseMax(p);
  }
}

}  // namespace internal

Scene::Scene(PolygonSoup soup, const SceneOptions& options, const Request& request)
    : soup_(std::move(soup)) {
  internal::Stage stage(request, "vertices");
  internal::SceneBuilder(*this, options, stage).run();
}

std::span<const int> Scene::edges_at(int p) const {
  return std::span(edge_ids_).subspan(edge_starts_[p],
                                      edge_starts_[p + 1] - edge_starts_[p]);
}

std::span<const int> Scene::faces_at(int p) const {
  return std::span(face_ids_).subspan(face_starts_[p],
                                      face_starts_[p + 1] - face_starts_[p]);
}

namespace {

[[noreturn]] void throw_unknown_name(const Scene& scene, const std::string& name) {
  constexpr std::size_t kShown = 5;
  const auto objects = scene.objects();
  std::vector<std::string> names;
  for (const Object& object : objects) names.push_back(object.name);
  for (const PolygonSoup::Group& group : scene.soup().groups) {
    names.push_back(group.name);
    names.insert(names.end(), group.aliases.begin(), group.aliases.end());
  }
  if (const auto near = nearest_name(name, names)) {
    throw InvalidInput("no group named '" + name + "'; did you mean '" + *near + "'?");
  }
  std::string message = "no group named '" + name + "'; there are ";
  if (objects.empty()) message = "no group named '" + name + "'; there are none";
  for (std::size_t i = 0; i < std::min(kShown, objects.size()); ++i) {
    message += (i > 0 ? ", '" : "'") + objects[i].name + "'";
  }
  if (objects.size() > kShown) {
    message += " and " + std::to_string(objects.size() - kShown) + " more";
  }
  throw InvalidInput(message);
}

// Reads "#i-j"; false when the text is something else.
bool parse_range(const std::string& text, int& first, int& last) {
  if (text.empty() || text[0] != '#') return false;
  const char* const end = text.data() + text.size();
  const auto i = std::from_chars(text.data() + 1, end, first);
  if (i.ec != std::errc() || i.ptr == end || *i.ptr != '-') return false;
  const auto j = std::from_chars(i.ptr + 1, end, last);
  return j.ec == std::errc() && j.ptr == end;
}

}  // namespace

int Scene::object_named(const std::string& name) const {
  const auto found = object_names_.find(name);
  if (found == object_names_.end()) throw_unknown_name(*this, name);
  return found->second;
}

std::vector<int> Scene::faces_named(const std::string& name) const {
  const auto found = object_names_.find(name);
  std::vector<std::uint8_t> wanted(soup_.polygons.size(), 0);
  bool known = false;
  for (const auto& group : soup_.groups) {
    if (group.name != name && std::find(group.aliases.begin(), group.aliases.end(),
                                        name) == group.aliases.end()) {
      continue;
    }
    known = true;
    for (const int f : group.faces) wanted[f] = 1;
  }
  if (!known && found != object_names_.end()) return objects_[found->second].faces;
  int first = 0, last = 0;
  if (!known && parse_range(name, first, last)) {
    if (first < 0 || last < first || last >= static_cast<int>(wanted.size())) {
      throw InvalidInput("no faces " + name + ": the file has faces 0 to " +
                         std::to_string(wanted.size() - 1));
    }
    known = true;
    std::fill(wanted.begin() + first, wanted.begin() + last + 1, std::uint8_t{1});
  }
  if (!known) throw_unknown_name(*this, name);
  std::vector<int> faces;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (wanted[faces_[f].source]) faces.push_back(static_cast<int>(f));
  }
  const std::vector<int> repeated = internal::repeated_faces(*this, wanted);
  faces.insert(faces.end(), repeated.begin(), repeated.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

Scene scene_without(const Scene& scene, std::span<const std::string> names,
                    const Request& request) {
  PolygonSoup soup = scene.soup();
  soup.defects.clear();
  // Components keep the names that they have by now.
  if (soup.groups.empty()) {
    for (const Object& object : scene.objects()) {
      PolygonSoup::Group& group = soup.groups.emplace_back();
      group.name = object.name;
      for (const int f : object.faces) {
        if (group.faces.empty() || group.faces.back() != scene.faces()[f].source)
          group.faces.push_back(scene.faces()[f].source);
      }
    }
  }
  SceneOptions options;
  for (const std::string& name : names) {
    for (const int f : scene.faces_named(name))
      options.without.push_back(scene.faces()[f].source);
  }
  std::sort(options.without.begin(), options.without.end());
  return Scene(std::move(soup), options, request);
}

}  // namespace sightline
