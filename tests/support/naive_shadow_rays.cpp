#include "tests/support/naive_shadow_rays.h"

#include <algorithm>

namespace sightline::testing {
namespace {

Integer dot_of(const Integers& a, const Integers& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Integers difference(const Integers& a, const Integers& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Integers cross_of(const Integers& a, const Integers& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0]};
}

Integer common_denominator(const Vec3& v, const Integer& with) {
  Integer result = with;
  for (const Rational& x : v) result = lcm(result, Integer(denominator(x)));
  return result;
}
Integers times(const Integer& scale, const Vec3& v) {
  Integers result;
  for (int i = 0; i < 3; ++i) {
    result[i] = Integer(numerator(v[i])) * (scale / Integer(denominator(v[i])));
  }
  return result;
}

/// Some corners of a face may be collinear.
Ray normal_of(const std::vector<Integers>& corners) {
  Integers sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Integers part = cross_of(difference(corners[i], corners[0]),
                                   difference(corners[i + 1], corners[0]));
    for (int k = 0; k < 3; ++k) sum[k] += part[k];
  }
  return Ray(sum);
}

/// Ends of the list are cut along the half-space.
void keep_within(std::vector<SourcePart>& parts, const Ray& half_space, bool& hides) {
  std::vector<SourcePart> result;
  for (const SourcePart& part : parts) {
    std::optional<Cone> inside = clip(part.cone, half_space);
    hides = hides || clip(part.cone, -half_space).has_value();
    if (inside) result.push_back({part.face, std::move(*inside)});
  }
  parts = std::move(result);
}

void take_away(std::vector<SourcePart>& parts, int face,
               const std::vector<Ray>& half_spaces, bool& hides) {
  std::vector<SourcePart> result;
  for (const SourcePart& part : parts) {
    if (part.face != face) {
      result.push_back(part);
      continue;
    }
    Cut pieces = cut(part.cone, half_spaces);
    hides = hides || pieces.inside.has_value();
    for (Cone& cone : pieces.outside) result.push_back({face, std::move(cone)});
  }
  parts = std::move(result);
}

bool misses(const Cone& a, const Cone& b) {
  return std::ranges::any_of(a.sides, [&](const Ray& s) {
    return std::ranges::all_of(b.corners, [&](const Ray& c) { return side(s, c) <= 0; });
  });
}

void take_away_hidden(const NaiveRays& rays, SourceParts& parts) {
  const int n = static_cast<int>(rays.setup().faces.size());
  for (const int source : parts.shown) {
    for (int f = 0; f < n; ++f) {
      if (f == source || rays.height(f).sign() == 0) continue;
      const std::optional<Ray> nearer = rays.before(f, source);
      if (!nearer) continue;
      if (misses(rays.cone(f), rays.cone(source))) continue;
      if (misses(rays.cone(source), rays.cone(f))) continue;
      std::vector<Ray> half_spaces = rays.cone(f).sides;
      half_spaces.push_back(*nearer);
      take_away(parts.seen, source, half_spaces, parts.hides);
    }
  }
}

/// Rays into material are taken away.  Faces that the point is on are the only ones
/// across which that changes.
void take_away_material(const NaiveRays& rays, SourceParts& parts) {
  for (int f = 0; f < static_cast<int>(rays.setup().faces.size()); ++f) {
    if (rays.setup().in_body[f] == 0 || !rays.on_face(f)) continue;
    std::vector<SourcePart> split;
    for (const SourcePart& part : parts.seen) {
      for (const Ray& way : {rays.setup().normals[f], -rays.setup().normals[f]}) {
        if (auto cone = clip(part.cone, way)) split.push_back({part.face, *cone});
      }
    }
    parts.seen = std::move(split);
  }
  const auto in_material = [&](const SourcePart& part) {
    std::vector<Ray> towards = part.cone.corners;
    std::optional<bool> answer;
    while (!answer) {
      // A random mean: the rays so far, and a corner once more.
      const Ray ray = between(towards);
      answer = rays.begins_in_material(ray);
      towards = {ray, part.cone.corners[towards.size() % part.cone.corners.size()],
                 between({ray, part.cone.corners[0]})};
    }
    return *answer;
  };
  const std::size_t before = parts.seen.size();
  std::erase_if(parts.seen, in_material);
  parts.hides = parts.hides || parts.seen.size() < before;
}

}  // namespace

NaiveShadow::Setup::Setup(std::vector<NaiveShadowFace> all) : faces(std::move(all)) {
  scale = 1;
  for (const NaiveShadowFace& f : faces) {
    for (const Vec3& c : f.corners) scale = common_denominator(c, scale);
  }
  for (const NaiveShadowFace& f : faces) {
    corners.emplace_back();
    for (const Vec3& c : f.corners) corners.back().push_back(times(scale, c));
    normals.push_back(normal_of(corners.back()));
  }
  bodies = bodies_of(faces);
  in_body.assign(faces.size(), 0);
  for (const Body& body : bodies) {
    for (const int f : body) in_body[f] = 1;
  }
}

NaiveRays::NaiveRays(const NaiveShadow::Setup& setup, const Vec3& p) : setup_(setup) {
  const Vec3 scaled = Rational(setup.scale) * p;
  unit_ = common_denominator(scaled, 1);
  at_ = times(unit_, scaled);
  for (int f = 0; f < static_cast<int>(setup.faces.size()); ++f) {
    heights_.push_back(dot_of(setup.normals[f].exact(), to_corner(f, 0)));
  }
}

Integers NaiveRays::to_corner(int f, std::size_t corner) const {
  Integers result;
  for (int i = 0; i < 3; ++i) result[i] = setup_.corners[f][corner][i] * unit_ - at_[i];
  return result;
}

const Cone& NaiveRays::cone(int f) const {
  const auto known = cones_.find(f);
  if (known != cones_.end()) return known->second;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < setup_.corners[f].size(); ++i) {
    rays.emplace_back(to_corner(f, i));
  }
  return cones_.emplace(f, cone_of(std::move(rays)).value()).first->second;
}

bool NaiveRays::on_face(int f) const {
  if (heights_[f].sign() != 0) return false;
  const std::size_t n = setup_.corners[f].size();
  for (std::size_t i = 0; i < n; ++i) {
    const Integers turn = cross_of(to_corner(f, i), to_corner(f, (i + 1) % n));
    if (dot_of(setup_.normals[f].exact(), turn).sign() < 0) return false;
  }
  return true;
}

std::optional<Ray> NaiveRays::before(int f, int g) const {
  // A ray d meets a plane at d height / (n . d), so that the nearer one has the larger
  // (n . d) / height.
  const int product = heights_[f].sign() * heights_[g].sign();
  Integers result;
  for (int i = 0; i < 3; ++i) {
    result[i] = (heights_[g] * setup_.normals[f].exact()[i] -
                 heights_[f] * setup_.normals[g].exact()[i]) *
                product;
  }
  if (result == Integers{0, 0, 0}) return std::nullopt;
  return Ray(result);
}

std::optional<bool> NaiveRays::begins_in_material(const Ray& ray) const {
  bool result = false;
  for (const Body& body : setup_.bodies) {
    int winding = 0;
    for (const int f : body) {
      const int slope = side(setup_.normals[f], ray);
      if (heights_[f].sign() == 0) {
        if (slope == 0 && on_face(f)) return std::nullopt;
        continue;
      }
      if (slope * heights_[f].sign() <= 0) continue;
      int least = 1;
      for (const Ray& s : cone(f).sides) least = std::min(least, side(s, ray));
      if (least == 0) return std::nullopt;
      if (least > 0) winding += slope;
    }
    result = result || winding > 0;
  }
  return result;
}

SourceParts parts_seen(const NaiveRays& rays, const std::optional<Vec3>& normal) {
  SourceParts parts;
  const auto& faces = rays.setup().faces;
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    const int behind = rays.height(f).sign();
    if (!faces[f].source || behind == 0 || (behind > 0 && !faces[f].two_sided)) continue;
    std::vector<SourcePart> part{{f, rays.cone(f)}};
    bool ignored = false;
    for (const int other : parts.shown) {
      if (!rays.before(f, other)) take_away(part, f, rays.cone(other).sides, ignored);
    }
    parts.shown.push_back(f);
    parts.whole.insert(parts.whole.end(), part.begin(), part.end());
  }
  parts.seen = parts.whole;
  if (normal) keep_within(parts.seen, Ray(*normal), parts.hides);
  take_away_hidden(rays, parts);
  take_away_material(rays, parts);
  return parts;
}

}  // namespace sightline::testing
