#include "linespace/light/homogeneous.h"

namespace sightline::internal {

LightPoint light_point(const Point& p) {
  LightPoint out;
  for (int i = 0; i < 3; ++i) {
    out.near[i] = {p[i], 0};
    out.exact[i] = Ring(p[i]);
  }
  out.near[3] = {1, 0};
  out.exact[3] = Ring(1);
  out.rounded = p;
  return out;
}

LightPoint light_point(const Four<Ring>& p) {
  LightPoint out;
  out.exact = p;
  if (sign_of(p[3]) == Sign::Negative) {
    for (Ring& x : out.exact) x = -x;
  }
  for (int i = 0; i < 3; ++i) {
    const double x = quotient(Surd{out.exact[i], 0}, Surd{out.exact[3], 0}, Ring(0));
    out.near[i] = {x, 2 * std::abs(x) * kQuotientError + kUnderflow};
    out.rounded[i] = x;
  }
  out.near[3] = {1, 0};
  return out;
}

LightPlane light_plane(const LightPoint& a, const LightPoint& b, const LightPoint& c) {
  return {plane_of(join(a.near, b.near), c.near),
          plane_of(join(a.exact, b.exact), c.exact)};
}

Sign sign_at(const LightPlane& plane, const LightPoint& p) {
  return decide(value(plane.near, p.near), [&] { return value(plane.exact, p.exact); });
}

LightLine light_line(const LightPoint& from, const LightPoint& to) {
  return {{&from, &to}, join(from.near, to.near), join(from.exact, to.exact)};
}

Sign sign_between(const LightLine& l, const LightLine& m) {
  return decide(side(l.near, m.near), [&] { return side(l.exact, m.exact); });
}

}  // namespace sightline::internal
