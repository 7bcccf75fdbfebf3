#include "tests/support/naive_ff.h"

#include <algorithm>
#include <array>
#include <optional>

#include "tests/support/naive_ev.h"
#include "tests/support/naive_solids_internal.h"

namespace sightline::testing {
namespace {

/// The two points at which a plane crosses a face's sides; nothing when it does not
/// cross the face's inside.
std::optional<std::array<Vector, 2>> crossed_sides(const Solids& s, const SolidFace& face,
                                                   const Plane& plane) {
  std::vector<Vector> points;
  bool corner = false;
  for (std::size_t i = 0; i < face.vertices.size(); ++i) {
    const Vector& a = s.vertices[face.vertices[i]];
    const Vector& b = s.vertices[face.vertices[(i + 1) % face.vertices.size()]];
    const Number at_a = plane(a), at_b = plane(b);
    corner = corner || sign_of(at_a) == 0;
    if (sign_of(at_a) * sign_of(at_b) < 0) {
      points.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
  }
  if (points.size() == 2) return std::array{points[0], points[1]};
  if (corner && !points.empty()) throw NotGeneral("a line of two faces meets a corner");
  return std::nullopt;
}

/// No solid but the two has inside points on the segment or next to its ends.
bool enters_nothing(const Solids& s, const Vector& a, const Vector& b) {
  for (const auto& faces : s.faces_of_solid) {
    std::optional<Number> from, to;  // where the line is inside, from -inf to inf
    bool misses = false;
    for (const int f : faces) {
      const Number at_a = s.faces[f].plane(a), at_b = s.faces[f].plane(b);
      const int slope = sign_of(at_b - at_a);
      if (slope == 0) {
        misses = misses || sign_of(at_a) >= 0;
        continue;
      }
      const Number at = at_a / (at_a - at_b);
      if (slope < 0 && (!from || sign_of(at - *from) > 0)) from = at;
      if (slope > 0 && (!to || sign_of(at - *to) < 0)) to = at;
    }
    if (misses || sign_of(*to - *from) <= 0) continue;
    if (sign_of(*from - Number(1)) <= 0 && sign_of(*to) >= 0) return false;
  }
  return true;
}

}  // namespace

std::vector<NodeKey> naive_ff(const PolygonSoup& soup) {
  const Solids s(soup);
  std::vector<NodeKey> found;
  const int count = static_cast<int>(s.faces.size());
  for (int f = 0; f < count; ++f) {
    for (int g = f + 1; g < count; ++g) {
      if (s.faces[f].solid == s.faces[g].solid) continue;
      const auto on_f = crossed_sides(s, s.faces[f], s.faces[g].plane);
      const auto on_g = crossed_sides(s, s.faces[g], s.faces[f].plane);
      if (!on_f || !on_g) continue;
      std::array<Vector, 4> all = {(*on_f)[0], (*on_f)[1], (*on_g)[0], (*on_g)[1]};
      const Vector direction = all[1] - all[0];
      std::ranges::sort(all, [&](const Vector& x, const Vector& y) {
        return sign_of(dot(y - x, direction)) > 0;
      });
      if (!enters_nothing(s, all[0], all[3])) continue;
      found.push_back(node_key("FF", {s.face_key(f), s.face_key(g)}));
    }
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace sightline::testing
