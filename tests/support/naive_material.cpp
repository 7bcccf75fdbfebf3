#include "tests/support/naive_material.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "tests/support/naive_sets.h"

namespace sightline::testing {
namespace {

using Faces = std::vector<NaiveShadowFace>;

Vec3 normal_of(const std::vector<Vec3>& corners) {
  Vec3 sum{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return sum;
}

bool holds(const std::vector<Vec3>& corners, const Vec3& p) {
  const Vec3 normal = normal_of(corners);
  if (dot(normal, p - corners[0]).sign() != 0) return false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = corners[i];
    const Vec3& b = corners[(i + 1) % corners.size()];
    if (dot(normal, cross(b - a, p - a)).sign() < 0) return false;
  }
  return true;
}

/// How often the faces wind around p; nullopt where p is on one of them.
std::optional<int> winding(const Faces& faces, const std::vector<int>& which,
                           const Vec3& p) {
  for (const int f : which) {
    if (holds(faces[f].corners, p)) return std::nullopt;
  }
  for (int t = 1;; ++t) {
    const Vec3 along{Rational(1), Rational(t), Rational(t * t)};
    int result = 0;
    bool degenerate = false;
    for (const int f : which) {
      const std::vector<Vec3>& c = faces[f].corners;
      const int slope = dot(normal_of(c), along).sign();
      bool outside = slope == 0, on_side = false;
      for (std::size_t i = 0; i < c.size() && !outside; ++i) {
        const int s =
            slope * dot(along, cross(c[i] - p, c[(i + 1) % c.size()] - p)).sign();
        outside = s < 0;
        on_side = on_side || s == 0;
      }
      // In the plane of a face that does not hold p the ray may meet it all the same.
      degenerate = degenerate || slope == 0 || (!outside && on_side);
      if (outside || dot(normal_of(c), c[0] - p).sign() * slope <= 0) continue;
      result += slope;
    }
    if (!degenerate) return result;
  }
}

int volume_sign(const Faces& faces, const std::vector<int>& which) {
  Rational sum = 0;
  for (const int f : which) {
    const std::vector<Vec3>& c = faces[f].corners;
    for (std::size_t i = 1; i + 1 < c.size(); ++i)
      sum += dot(c[0], cross(c[i], c[i + 1]));
  }
  return sum.sign();
}

struct Shell {
  std::vector<int> faces;
  int object;
  bool inverse;  // fronts inside
  std::vector<Vec3> corners;
};

std::vector<Shell> shells_of(const Faces& faces) {
  Sets together(faces.size());
  std::map<std::pair<int, std::pair<Vec3, Vec3>>, std::pair<int, int>> sides;
  std::map<int, bool> open;
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    const std::vector<Vec3>& c = faces[f].corners;
    for (std::size_t i = 0; i < c.size(); ++i) {
      const Vec3 &a = c[i], &b = c[(i + 1) % c.size()];
      auto& [face, balance] =
          sides.try_emplace({faces[f].object, std::minmax(a, b)}, f, 0).first->second;
      together.join(face, f);
      balance += a < b ? 1 : -1;
    }
  }
  for (const auto& [side, use] : sides) {
    if (use.second != 0) open[side.first] = true;
  }
  std::map<int, Shell> by_root;
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    if (open[faces[f].object]) continue;
    Shell& shell = by_root[together.find(f)];
    shell.object = faces[f].object;
    shell.faces.push_back(f);
    for (const Vec3& c : faces[f].corners) shell.corners.push_back(c);
  }
  std::vector<Shell> result;
  for (auto& [root, shell] : by_root) {
    shell.inverse = volume_sign(faces, shell.faces) < 0;
    result.push_back(std::move(shell));
  }
  return result;
}

/// Of the corners of the shell that are on none of the faces, whether these wind around
/// all; true if there are none.
bool is_within(const Faces& faces, const Shell& shell, const std::vector<int>& around) {
  return std::ranges::all_of(shell.corners, [&](const Vec3& corner) {
    const std::optional<int> w = winding(faces, around, corner);
    return !w || *w > 0;
  });
}

void append(std::vector<int>& to, const std::vector<int>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

std::vector<Body> bodies_of(const std::vector<NaiveShadowFace>& faces) {
  const std::vector<Shell> shells = shells_of(faces);
  std::map<int, Body> bodies;  // by object
  std::vector<const Shell*> outcasts;
  for (const Shell& shell : shells) {
    std::vector<int> others;
    for (const Shell& other : shells) {
      if (&other != &shell && other.object == shell.object) append(others, other.faces);
    }
    if (!shell.inverse || (!others.empty() && is_within(faces, shell, others))) {
      append(bodies[shell.object], shell.faces);
    } else {
      outcasts.push_back(&shell);
    }
  }
  std::map<int, Body> with_hollows = bodies;
  for (const Shell* shell : outcasts) {
    for (const auto& [object, body] : bodies) {
      if (object != shell->object && is_within(faces, *shell, body)) {
        append(with_hollows[object], shell->faces);
      }
    }
  }
  std::vector<Body> result;
  for (auto& [object, body] : with_hollows) result.push_back(std::move(body));
  return result;
}

}  // namespace sightline::testing
