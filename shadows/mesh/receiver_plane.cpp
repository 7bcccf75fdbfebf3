#include "shadows/mesh/receiver_plane.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sightline::internal {
namespace {

Rational cross(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

PlanePoint between(const PlanePoint& a, const PlanePoint& b, const Rational& t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

ExactPoint exact_of(const LightPoint& p) {
  const Rational w = rational(p.exact[3]);
  return {rational(p.exact[0]) / w, rational(p.exact[1]) / w, rational(p.exact[2]) / w};
}

}  // namespace

ReceiverPlane::ReceiverPlane(const SourcePatch& patch) {
  for (int i = 0; i < 3; ++i) normal_[i] = rational(patch.plane.exact[i]);
  offset_ = rational(patch.plane.exact[3]);
  for (int i = 0; i < 3; ++i) {
    if (abs(normal_[i]) > abs(normal_[w_])) w_ = i;
  }
  u_ = (w_ + 1) % 3;
  v_ = (w_ + 2) % 3;
  Rational squared = 0;
  for (const Rational& x : normal_) squared += (x / normal_[w_]) * (x / normal_[w_]);
  area_factor_ = std::sqrt(nearest_double(squared));
  find_outline(patch);
}

// Chains of the outline's sides.
void ReceiverPlane::find_outline(const SourcePatch& patch) {
  std::map<PlanePoint, std::vector<PlanePoint>> next;
  for (const SourcePatch::Side& side : patch.sides) {
    if (side.foot_of >= 0) continue;
    next[drop(exact_of(*side.ends[0]))].push_back(drop(exact_of(*side.ends[1])));
  }
  while (!next.empty()) {
    auto& ring = outline_.emplace_back();
    auto at = next.begin();
    while (at != next.end()) {
      ring.push_back(at->first);
      const PlanePoint to = at->second.back();
      at->second.pop_back();
      if (at->second.empty()) next.erase(at);
      at = next.find(to);
    }
  }
}

double ReceiverPlane::area() const {
  Rational twice = 0;
  for (const auto& ring : outline_) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const PlanePoint &a = ring[k], &b = ring[(k + 1) % ring.size()];
      twice += a[0] * b[1] - a[1] * b[0];
    }
  }
  return std::abs(nearest_double(twice)) / 2 * area_factor_;
}

double ReceiverPlane::size() const {
  PlanePoint low = outline_[0][0], high = low;
  for (const auto& ring : outline_) {
    for (const PlanePoint& p : ring) {
      for (int i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
  }
  return std::max(nearest_double(high[0] - low[0]), nearest_double(high[1] - low[1]));
}

ShadowMesh::Frame ReceiverPlane::frame() const {
  ShadowMesh::Frame frame{Point::Zero(), Eigen::Vector3d::Zero(),
                          Eigen::Vector3d::Zero()};
  frame.origin[w_] = nearest_double(-offset_ / normal_[w_]);
  frame.x_axis[u_] = 1;
  frame.x_axis[w_] = nearest_double(-normal_[u_] / normal_[w_]);
  frame.y_axis[v_] = 1;
  frame.y_axis[w_] = nearest_double(-normal_[v_] / normal_[w_]);
  return frame;
}

ExactPoint ReceiverPlane::lift(const PlanePoint& p) const {
  ExactPoint x;
  x[u_] = p[0];
  x[v_] = p[1];
  x[w_] = -(offset_ + normal_[u_] * p[0] + normal_[v_] * p[1]) / normal_[w_];
  return x;
}

// A ray from p towards larger first coordinates crosses the outline an odd number of
// times.  p must not lie on it.
bool ReceiverPlane::contains(const PlanePoint& p) const {
  bool inside = false;
  for (const auto& ring : outline_) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const PlanePoint &a = ring[k], &b = ring[(k + 1) % ring.size()];
      if ((a[1] > p[1]) == (b[1] > p[1])) continue;
      const Rational turn = cross(a, b, p);
      if (b[1] > a[1] ? turn > 0 : turn < 0) inside = !inside;
    }
  }
  return inside;
}

std::vector<std::array<PlanePoint, 2>> ReceiverPlane::clip(const PlanePoint& a,
                                                           const PlanePoint& b) const {
  // Where it crosses or touches the outline, 0 at a and 1 at b.
  std::vector<Rational> at{0, 1};
  std::vector<std::array<Rational, 2>> along_side;
  const std::size_t axis = a[0] == b[0] ? 1 : 0;
  const auto position = [&](const PlanePoint& p) {
    return Rational((p[axis] - a[axis]) / (b[axis] - a[axis]));
  };
  const auto add = [&](const Rational& t) {
    if (t > 0 && t < 1) at.push_back(t);
  };
  for (const auto& ring : outline_) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const PlanePoint &p = ring[k], &q = ring[(k + 1) % ring.size()];
      if (std::max(p[0], q[0]) < std::min(a[0], b[0]) ||
          std::max(a[0], b[0]) < std::min(p[0], q[0]) ||
          std::max(p[1], q[1]) < std::min(a[1], b[1]) ||
          std::max(a[1], b[1]) < std::min(p[1], q[1])) {
        continue;
      }
      const Rational at_p = cross(a, b, p), at_q = cross(a, b, q);
      if (at_p == 0 && at_q == 0) {
        const Rational s = position(p), t = position(q);
        add(s);
        add(t);
        along_side.push_back({std::min(s, t), std::max(s, t)});
      } else if (at_p.sign() * at_q.sign() <= 0) {
        add(position(between(p, q, at_p / (at_p - at_q))));
      }
    }
  }
  std::ranges::sort(at);
  std::vector<std::array<PlanePoint, 2>> pieces;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (at[i] == at[i + 1]) continue;
    const Rational middle = (at[i] + at[i + 1]) / 2;
    const bool on_side = std::ranges::any_of(along_side, [&](const auto& side) {
      return side[0] < middle && middle < side[1];
    });
    if (!on_side && contains(between(a, b, middle)))
      pieces.push_back({between(a, b, at[i]), between(a, b, at[i + 1])});
  }
  return pieces;
}

std::vector<std::array<PlanePoint, 2>> ReceiverPlane::cut_by(const ExactPoint& n,
                                                             const Rational& k) const {
  // n . lift(x, y) + k = a x + b y + c
  const Rational s = n[w_] / normal_[w_];
  const Rational a = n[u_] - s * normal_[u_], b = n[v_] - s * normal_[v_];
  const Rational c = k - s * offset_;
  if (a == 0 && b == 0) return {};
  // Between the extreme projections of the outline onto the line.
  const Rational squared = a * a + b * b;
  const PlanePoint on{-a * c / squared, -b * c / squared};
  std::optional<Rational> least, most;
  for (const auto& ring : outline_) {
    for (const PlanePoint& p : ring) {
      const Rational t = ((p[1] - on[1]) * a - (p[0] - on[0]) * b) / squared;
      if (!least || t < *least) least = t;
      if (!most || t > *most) most = t;
    }
  }
  const auto point = [&](const Rational& t) {
    return PlanePoint{on[0] - t * b, on[1] + t * a};
  };
  return clip(point(*least - 1), point(*most + 1));
}

}  // namespace sightline::internal
