#include "linespace/between/sight_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

namespace sightline::internal {
namespace {

// The common power of two: values times 2^-exponent have their largest in [1/2, 1).
int exponent_of(std::span<const double> values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  if (largest == 0) return 0;
  int exponent;
  std::frexp(largest, &exponent);
  return exponent;
}

Dependence dependence_of(FormKind kind) {
  switch (kind) {
    case FormKind::FromPlane:
    case FormKind::FromEdge:
      return Dependence::From;
    case FormKind::ToPlane:
    case FormKind::ToEdge:
      return Dependence::To;
    default:
      return Dependence::Both;
  }
}

Sign exact_sign(const Rational& x) { return static_cast<Sign>(x.sign()); }

std::int8_t constant_sign(const std::array<Sign, 9>& signs) {
  const bool up = std::ranges::none_of(signs, [](Sign s) { return s == Sign::Negative; });
  const bool down =
      std::ranges::none_of(signs, [](Sign s) { return s == Sign::Positive; });
  return static_cast<std::int8_t>(up && down ? 2 : up ? 1 : down ? -1 : 0);
}

}  // namespace

std::array<ExactWeights, 2> weights_of(const SightPoint& s) {
  if (s.exact) return *s.exact;
  std::array<ExactWeights, 2> weights;
  for (int i = 0; i < 3; ++i) {
    weights[0][i] = s.alpha[i];
    weights[1][i] = s.beta[i];
  }
  return weights;
}

bool CornerValues::certainly(int sign) const {
  for (int i = 0; i < 9; ++i) {
    if (!(sign * value[i] >= error[i])) return false;
  }
  return true;
}

Rational exact_orient3d(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                        const ExactPoint& d) {
  ExactPoint u, v, w;
  for (int i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    v[i] = c[i] - a[i];
    w[i] = d[i] - a[i];
  }
  return w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
         w[2] * (u[0] * v[1] - u[1] * v[0]);
}

Rational exact_form_value(FormKind kind, const FormPoints& x, const ExactPoint& p,
                          const ExactPoint& q) {
  switch (kind) {
    case FormKind::EdgeSide:
    case FormKind::CornerSide:
      return exact_orient3d(p, q, exact_point(x[0]), exact_point(x[1]));
    case FormKind::FromPlane:
    case FormKind::FromEdge:
      return exact_orient3d(exact_point(x[0]), exact_point(x[1]), exact_point(x[2]), p);
    default:
      return exact_orient3d(exact_point(x[0]), exact_point(x[1]), exact_point(x[2]), q);
  }
}

Point apex_off(const Triangle& t) {
  // One step along the axis that the normal is most along; the step is a power of two
  // about as large as the triangle, or large enough to change the coordinate.
  const Point normal = (t[1] - t[0]).cross(t[2] - t[0]);
  int axis;
  normal.cwiseAbs().maxCoeff(&axis);
  const double size =
      std::max((t[1] - t[0]).cwiseAbs().maxCoeff(), std::abs(t[0][axis]) * 0x1p-40);
  int exponent;
  std::frexp(size, &exponent);
  const double step = std::ldexp(1.0, exponent);
  Point apex = t[0];
  apex[axis] += step;
  for (int i = 0; orient3d(t[0], t[1], t[2], apex) == Sign::Zero && i < 3; ++i) {
    apex = t[0];
    apex[i] += step;
  }
  return apex;
}

int side_of_plane(const Triangle& plane, std::span<const Point> points) {
  bool above = false, below = false;
  for (const Point& x : points) {
    const Sign side = orient3d(plane[0], plane[1], plane[2], x);
    above |= side == Sign::Positive;
    below |= side == Sign::Negative;
  }
  return above && !below ? 1 : below && !above ? -1 : 0;
}

std::size_t SightSpace::KeyHash::operator()(const Key& key) const {
  std::uint64_t h = 0;
  for (const double x : key.numbers) {
    h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15;
    h ^= h >> 32;
  }
  return h;
}

SightSpace::SightSpace(const Triangle& a, const Triangle& b, int scaled_by)
    : a_(a), b_(b), scaled_by_(scaled_by) {
  apex_ = apex_off(a);
  double largest = 0;
  for (const Triangle* t : {&a_, &b_}) {
    for (const Point& p : *t) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  size_ = std::ldexp(1.0, exponent_of(std::array{largest}));
  b_of_a_ = side_of_plane(a_, b_);
  a_of_b_ = side_of_plane(b_, a_);
}

SightSpace::Key SightSpace::line_key(const Point& from, const Point& to) const {
  constexpr double kSteps = 0x1p20;
  const Point along = (to - from).normalized();
  const Point moment = from.cross(along) / size_;
  Key key;
  for (int i = 0; i < 3; ++i) {
    key.numbers[i] = std::nearbyint(along[i] * kSteps) + 0.0;
    key.numbers[3 + i] = std::nearbyint(moment[i] * kSteps) + 0.0;
  }
  return key;
}

// Edges on one line, in either direction, are one form: the sign is the same for all.
int SightSpace::form(const FormName& name, const Piece& piece, bool* reversed) {
  const int n = static_cast<int>(piece.corners.size());
  FormPoints x;
  *reversed = false;
  switch (name.kind) {
    case FormKind::EdgeSide:
      x = {piece.corners[name.corner], piece.corners[(name.corner + 1) % n], apex_};
      break;
    case FormKind::CornerSide:
      x = {piece.corners[name.corner], apex_, apex_};
      break;
    case FormKind::FromPlane:
    case FormKind::ToPlane:
      x = {piece.corners[0], piece.corners[1], piece.corners[2]};
      break;
    default:
      x = {piece.corners[name.corner], piece.corners[(name.corner + 1) % n], apex_};
  }
  if (name.kind == FormKind::EdgeSide) {
    const auto less = [](const Point& u, const Point& v) {
      return std::lexicographical_compare(u.data(), u.data() + 3, v.data(), v.data() + 3);
    };
    if (less(x[1], x[0])) {
      std::swap(x[0], x[1]);
      *reversed = true;
    }
    std::vector<int>& known = edge_forms_[line_key(x[0], x[1])];
    for (const int f : known) {
      const FormPoints& y = points_[f];
      if (collinear(y[0], y[1], x[0]) && collinear(y[0], y[1], x[1])) return f;
    }
    known.push_back(static_cast<int>(forms_.size()));
  }
  return new_form(name, x);
}

int SightSpace::new_form(const FormName& name, const FormPoints& x) {
  Form& f = forms_.emplace_back();
  f.name = name;
  f.depends = dependence_of(name.kind);
  const bool is_side =
      name.kind == FormKind::EdgeSide || name.kind == FormKind::CornerSide;
  // orient3d(p, q, u, v) == orient3d(u, v, p, q), which starts from v - u and so stays
  // sharp for short edges; of a plane, all three are the same.
  const auto plane = [&](int j) {
    return is_side ? PlaneThrough{x[0], x[1], a_[j]} : PlaneThrough{x[0], x[1], x[2]};
  };
  const std::array<PlaneSide, 3> sides{PlaneSide(plane(0)), PlaneSide(plane(1)),
                                       PlaneSide(plane(2))};
  std::array<Sign, 9> signs;
  for (int i = 0; i < 9; ++i) {
    const int j = i / 3, k = i % 3;
    const int same = f.depends == Dependence::From ? 3 * j
                     : f.depends == Dependence::To ? k
                                                   : i;
    if (same != i) {
      f.at.value[i] = f.at.value[same];
      f.at.error[i] = f.at.error[same];
      signs[i] = signs[same];
      continue;
    }
    auto [value, error] = sides[j].value(f.depends == Dependence::From ? a_[j] : b_[k]);
    signs[i] = internal::sign_of(value);
    if (!(std::abs(value) > error) && error != 0) {
      signs[i] = exact_sign(
          exact_form_value(name.kind, x, exact_point(a_[j]), exact_point(b_[k])));
      if (signs[i] == Sign::Zero) value = error = 0;
    }
    f.at.value[i] = value;
    f.at.error[i] = error;
  }
  f.constant = constant_sign(signs);
  const int exponent = exponent_of(f.at.value);
  const double scale = std::exp2(-exponent);
  for (int i = 0; i < 9; ++i) {
    f.at.value[i] *= scale;
    // Kept a normal number where it is not 0: scaled, it may fall below these.
    if (f.at.error[i] != 0) f.at.error[i] = std::max(f.at.error[i] * scale, 0x1p-1000);
  }
  exponents_.push_back(exponent);
  points_.push_back(x);
  return static_cast<int>(forms_.size()) - 1;
}

void SightSpace::add_blocker(int number, std::span<const Blocker::Part> parts) {
  std::vector<Blocker::Part> open;
  for (const Blocker::Part& part : parts) {
    const std::int8_t constant = forms_[part.form].constant;
    if (constant == -part.sign) return;  // fails in all the open sight space
    if (constant == 0) open.push_back(part);
  }
  store({number, 0}, open);
}

void SightSpace::store(Blocker blocker, std::span<const Blocker::Part> parts) {
  blocker.first = static_cast<int>(parts_.size());
  blocker.count = static_cast<int>(parts.size());
  parts_.insert(parts_.end(), parts.begin(), parts.end());
  for (const auto& [form, sign] : parts) {
    if (blocker.patch >= 0 || forms_[form].name.kind != FormKind::EdgeSide) continue;
    users_[form].emplace_back(static_cast<int>(blockers_.size()), sign);
  }
  blockers_.push_back(blocker);
}

// Blockers are joined, joined ones again, up to a size and a number that keep them
// useful: a wall of triangles becomes one blocker with the wall's outline.
void SightSpace::join_neighbours() {
  for (; neighbours_known_ < blockers_.size(); ++neighbours_known_) {
    const int b = static_cast<int>(neighbours_known_);
    const auto own = this->parts(blockers_[b]);
    const std::vector<Blocker::Part> edges(own.begin(), own.end());
    for (const Blocker::Part& part : edges) {
      const auto users = users_.find(part.form);
      if (users == users_.end()) continue;
      const auto others = users->second;
      for (const auto& [other, sign] : others) {
        if (other < b && sign == -part.sign) join(b, other, part);
      }
    }
  }
}

void SightSpace::join(int b, int other, const Blocker::Part& shared) {
  constexpr std::size_t kMostParts = 8;
  constexpr std::size_t kMostJoined = 256;
  if (joined_.size() >= kMostJoined) return;
  std::vector<Blocker::Part> all;
  for (const int half : {b, other}) {
    for (const Blocker::Part& part : parts(blockers_[half])) {
      if (part.form != shared.form) all.push_back(part);
    }
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].form == all[i - 1].form) return;  // asks for both signs
  }
  if (all.size() > kMostParts || !joined_.insert(all).second) return;
  store({-1, 0, 0, {b, other}, shared}, all);
}

void SightSpace::add(int number, const Piece& piece) {
  const int n = static_cast<int>(piece.corners.size());
  bool reversed;
  const int from = form({FormKind::FromPlane, number, 0}, piece, &reversed);
  const int to = form({FormKind::ToPlane, number, 0}, piece, &reversed);
  if (forms_[from].constant == 2 && forms_[to].constant == 2) {
    add_coplanar(number, piece);
    return;
  }
  std::vector<Blocker::Part> parts;
  // front: p in front of the piece's plane or on it, q behind it or on it.
  for (const int front : {1, -1}) {
    if (forms_[from].constant == -front || forms_[to].constant == front) continue;
    parts.assign({{from, static_cast<std::int8_t>(front)},
                  {to, static_cast<std::int8_t>(-front)}});
    for (int i = 0; i < n; ++i) {
      const int edge = form({FormKind::EdgeSide, number, i}, piece, &reversed);
      // Seen from p in front the corners run counter-clockwise around the line to q,
      // which orient3d counts as negative (tests hold this against exact crossings).
      parts.push_back({edge, static_cast<std::int8_t>(reversed ? front : -front)});
    }
    add_blocker(number, parts);
  }
  join_neighbours();
}

SightSpace::Between SightSpace::between(const Piece& piece, int front) const {
  // A corner in the plane of a is as good as one beyond it: q is not in that plane.
  const auto on_side = [&](const Triangle& plane, int side) {
    return side != 0 && std::ranges::all_of(piece.corners, [&](const Point& x) {
             return static_cast<int>(orient3d(plane[0], plane[1], plane[2], x)) != -side;
           });
  };
  if (on_side(a_, b_of_a_) && on_side(b_, a_of_b_)) return Between::Always;
  const Triangle plane{piece.corners[0], piece.corners[1], piece.corners[2]};
  const int a = side_of_plane(plane, a_), b = side_of_plane(plane, b_);
  const auto in_plane = [&](const Point& x) {
    return orient3d(plane[0], plane[1], plane[2], x) == Sign::Zero;
  };
  if (a == -front || b == front) return Between::Never;
  if (a == 0 && b == 0 && std::ranges::all_of(a_, in_plane) &&
      std::ranges::all_of(b_, in_plane))
    return Between::Never;  // all of it in one plane
  return a == front && b == -front ? Between::Always : Between::WhereItsPlaneDivides;
}

bool SightSpace::add_patch(std::span<const PatchPiece> patch) {
  std::map<int, const Piece*> pieces;
  std::vector<FacingPiece> facing;
  std::set<Blocker::Part> parts;
  bool possible = true;
  const auto require = [&](int form, int sign) {
    const std::int8_t constant = forms_[form].constant;
    possible &=
        constant != -sign && !parts.contains({form, static_cast<std::int8_t>(-sign)});
    if (constant == 0) parts.insert({form, static_cast<std::int8_t>(sign)});
  };
  bool reversed;
  for (const auto& [faces, piece] : patch) {
    pieces[faces.piece] = piece;
    facing.push_back(faces);
    if (between(*piece, faces.front) == Between::Always) continue;
    require(form({FormKind::FromPlane, faces.piece, 0}, *piece, &reversed), faces.front);
    require(form({FormKind::ToPlane, faces.piece, 0}, *piece, &reversed), -faces.front);
  }
  const auto corners_of = [&](int piece) {
    return std::span<const Point>(pieces[piece]->corners);
  };
  const std::vector<OutlineSide> sides = outline(facing, corners_of);
  for (const OutlineSide& side : sides) {
    // As in add(): a side passed from corner to corner is counted as negative.
    require(form({FormKind::EdgeSide, side.piece, side.corner}, *pieces[side.piece],
                 &reversed),
            side.times > 0 ? -1 : 1);
  }
  if (!possible || sides.empty()) return false;
  Blocker blocker{-1, 0};
  blocker.patch = static_cast<int>(patches_.size());
  patches_.push_back(std::move(facing));
  store(blocker, std::vector<Blocker::Part>(parts.begin(), parts.end()));
  neighbours_known_ = blockers_.size();
  return true;
}

// All in one plane: the segment meets the piece iff it crosses one of its sides, or p
// lies in the piece.
void SightSpace::add_coplanar(int number, const Piece& piece) {
  const int n = static_cast<int>(piece.corners.size());
  bool reversed;
  // Forms are counted from the apex; which sign is inside is read off the third corner.
  const auto inner = static_cast<std::int8_t>(
      orient3d(piece.corners[0], piece.corners[1], apex_, piece.corners[2]));
  std::vector<Blocker::Part> inside;
  std::vector<int> corner_forms, from_forms, to_forms;
  for (int i = 0; i < n; ++i) {
    corner_forms.push_back(form({FormKind::CornerSide, number, i}, piece, &reversed));
    from_forms.push_back(form({FormKind::FromEdge, number, i}, piece, &reversed));
    to_forms.push_back(form({FormKind::ToEdge, number, i}, piece, &reversed));
    inside.push_back({from_forms.back(), inner});
  }
  add_blocker(number, inside);
  for (int i = 0; i < n; ++i) {
    // The line pq separates the two corners, the side's line separates p and q; which of
    // the corners is left of pq follows from where p is.
    for (const std::int8_t side : {std::int8_t{1}, std::int8_t{-1}}) {
      for (const std::int8_t turn : {std::int8_t{1}, std::int8_t{-1}}) {
        const std::array<Blocker::Part, 4> parts{
            {{from_forms[i], side},
             {to_forms[i], static_cast<std::int8_t>(-side)},
             {corner_forms[i], turn},
             {corner_forms[(i + 1) % n], static_cast<std::int8_t>(-turn)}}};
        add_blocker(number, parts);
      }
    }
  }
}

std::array<Rational, 9> SightSpace::exact(int form) const {
  const Form& f = forms_[form];
  const int exponent = exponents_[form];
  const Rational power =
      Rational(boost::multiprecision::mpz_int(1) << std::abs(exponent));
  std::array<Rational, 9> values;
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) {
      Rational v = exact_form_value(f.name.kind, points_[form], exact_point(a_[j]),
                                    exact_point(b_[k]));
      values[3 * j + k] = exponent > 0 ? Rational(v / power) : Rational(v * power);
    }
  }
  return values;
}

bool SightSpace::blocks(const Blocker& blocker, const SightPoint& s) const {
  // Rounded weights are off by at most kUnit times their size.
  const double off = s.exact ? 4 * kUnit : 0;
  bool certain = true;
  for (const auto& [form, sign] : parts(blocker)) {
    const CornerValues& at = forms_[form].at;
    double value = 0, magnitude = 0, error = 0;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        const double weight = s.alpha[j] * s.beta[k];
        const double term = weight * at.value[3 * j + k];
        value += term;
        magnitude += std::abs(term);
        error += weight * at.error[3 * j + k];
      }
    }
    // A term passes at most 2 roundings and 9 additions, the error sum no more.
    error = (error + (12 * kUnit + off) * magnitude) * (1 + 16 * kUnit);
    if (sign * value < -error) return false;
    certain &= sign * value > error;
  }
  if (certain) return true;
  const auto [alpha, beta] = weights_of(s);
  for (const auto& [form, sign] : parts(blocker)) {
    const std::array<Rational, 9> values = exact(form);
    Rational value = 0;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        value += alpha[j] * beta[k] * values[3 * j + k];
      }
    }
    if (sign * value < 0) return false;
  }
  return true;
}

}  // namespace sightline::internal
