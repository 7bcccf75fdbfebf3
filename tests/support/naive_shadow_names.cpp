#include "tests/support/naive_shadow_names.h"

#include <algorithm>
#include <stdexcept>

namespace sightline::testing {
namespace {

Vec3 normal_of(const std::vector<Vec3>& corners) {
  Vec3 sum{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return sum;
}

bool holds(const NaiveShadowFace& face, const Vec3& x) {
  const Vec3 n = normal_of(face.corners);
  if (dot(n, x - face.corners[0]).sign() != 0) return false;
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const Vec3& a = face.corners[i];
    const Vec3& b = face.corners[(i + 1) % face.corners.size()];
    if (dot(n, cross(b - a, x - a)).sign() < 0) return false;
  }
  return true;
}

/// Some corner of the face is in the half-plane to which u points, beyond a.
bool reaches(const NaiveShadowFace& face, const Vec3& u, const Vec3& a) {
  return std::ranges::any_of(face.corners,
                             [&](const Vec3& c) { return dot(u, c - a).sign() > 0; });
}

/// The other face, in the plane of this one, has x and reaches beyond the line through
/// this one's side ab.
bool goes_on(const NaiveShadowFace& other, const NaiveShadowFace& face, const Vec3& a,
             const Vec3& b, const Vec3& x) {
  const Vec3 across = cross(normal_of(face.corners), b - a);
  const Vec3 outwards = reaches(face, across, a) ? Rational(-1) * across : across;
  return holds(other, x) && reaches(other, outwards, a);
}

}  // namespace

const SideNames& NaiveShadow::Setup::names() const {
  std::call_once(names_once_, [&] { names_ = std::make_shared<const SideNames>(faces); });
  return *names_;
}

SpaceLine line_through(const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a, moment = cross(a, b);
  Integer common = 1, divisor = 0;
  for (int i = 0; i < 3; ++i) {
    common =
        lcm(common, lcm(Integer(denominator(way[i])), Integer(denominator(moment[i]))));
  }
  SpaceLine line;
  for (int i = 0; i < 6; ++i) {
    line.at[i] = Integer(numerator(Rational(common) * (i < 3 ? way[i] : moment[i - 3])));
    divisor = gcd(divisor, line.at[i]);
  }
  for (int i = 0; i < 3; ++i) {
    if (line.at[i] == 0) continue;
    if (line.at[i] < 0) divisor = -divisor;
    break;
  }
  for (Integer& x : line.at) x /= divisor;
  return line;
}

SideNames::SideNames(const std::vector<NaiveShadowFace>& faces) : faces_(faces) {
  for (const NaiveShadowFace& f : faces) {
    const Vec3 n = normal_of(f.corners);
    std::vector<int>& others = coplanar_.emplace_back();
    for (int g = 0; g < static_cast<int>(faces.size()); ++g) {
      if (&faces[g] == &f) continue;
      if (std::ranges::all_of(faces[g].corners, [&](const Vec3& c) {
            return dot(n, c - f.corners[0]).sign() == 0;
          })) {
        others.push_back(g);
      }
    }
  }
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    const std::vector<Vec3>& c = faces[f].corners;
    for (std::size_t i = 0; i < c.size(); ++i) {
      const Vec3 &a = c[i], &b = c[(i + 1) % c.size()];
      // What the side is may change at corners of faces in its plane.
      std::vector<Vec3> stops{a, b};
      for (const int g : coplanar_[f]) {
        for (const Vec3& x : faces[g].corners) {
          const Rational at = dot(x - a, b - a);
          if (is_zero(cross(x - a, b - a)) && at > 0 && at < dot(b - a, b - a)) {
            stops.push_back(x);
          }
        }
      }
      std::ranges::sort(stops);
      for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
        const Vec3 middle = Rational(1, 2) * (stops[k] + stops[k + 1]);
        if (stops[k] == stops[k + 1] || what(f, a, b, middle) != What::Edge) continue;
        edges_[line_through(a, b)].push_back({stops[k], stops[k + 1]});
      }
    }
  }
  for (auto& [line, stretches] : edges_) {
    std::ranges::sort(stretches);
    std::vector<std::array<Vec3, 2>> joined;
    for (const auto& stretch : stretches) {
      if (!joined.empty() && !(joined.back()[1] < stretch[0])) {
        joined.back()[1] = std::max(joined.back()[1], stretch[1]);
      } else {
        joined.push_back(stretch);
      }
    }
    stretches = std::move(joined);
  }
}

SideNames::What SideNames::what(int face, const Vec3& a, const Vec3& b,
                                const Vec3& x) const {
  const NaiveShadowFace& f = faces_[face];
  for (std::size_t g = 0; g < faces_.size(); ++g) {
    const bool other = static_cast<int>(g) != face && faces_[g].polygon == f.polygon;
    if (other && holds(faces_[g], x) &&
        std::ranges::find(coplanar_[face], static_cast<int>(g)) ==
            coplanar_[face].end()) {
      return What::Fold;
    }
  }
  if (f.source && on_outline(face, a, b, x)) return What::Edge;
  const bool flat = std::ranges::any_of(coplanar_[face], [&](int g) {
    return faces_[g].object == f.object && goes_on(faces_[g], f, a, b, x);
  });
  return flat ? What::Nothing : What::Edge;
}

bool SideNames::on_outline(int face, const Vec3& a, const Vec3& b, const Vec3& x) const {
  const Vec3 n = normal_of(faces_[face].corners);
  return std::ranges::none_of(coplanar_[face], [&](int g) {
    const NaiveShadowFace& other = faces_[g];
    const bool alike = other.two_sided || faces_[face].two_sided ||
                       dot(n, normal_of(other.corners)).sign() > 0;
    return other.source && alike && goes_on(other, faces_[face], a, b, x);
  });
}

std::optional<NaiveSideName> SideNames::name(int face, const Vec3& a, const Vec3& b,
                                             const Vec3& x) const {
  switch (what(face, a, b, x)) {
    case What::Nothing:
      return std::nullopt;
    case What::Fold:
      return NaiveSideName{NaiveSideName::Kind::Fold, {std::min(a, b), std::max(a, b)}};
    case What::Edge:
      for (const auto& edge : edges_.at(line_through(a, b))) {
        if (!(x < edge[0]) && !(edge[1] < x)) {
          return NaiveSideName{NaiveSideName::Kind::Edge, edge};
        }
      }
  }
  throw std::logic_error("naive shadow: an edge without a name");
}

}  // namespace sightline::testing
