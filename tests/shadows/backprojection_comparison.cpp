#include "tests/shadows/backprojection_comparison.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "linespace/numbers/exact_position.h"

namespace sightline::testing {
namespace {

constexpr double kAllowed = 1e-12, kAllowedGradient = 1e-7;
/// Corners of boundaries are rounded.
constexpr double kSamePoint = 1e-9;

ShadowPoint point_of(const AskedPoint& p) {
  const auto position = [](const Vec3& v) {
    return internal::exact_position({v[0], v[1], v[2]});
  };
  ShadowPoint result{position(p.at), std::nullopt};
  if (p.normal) result.normal = position(*p.normal);
  return result;
}

std::string text_of(const Vec3& v) {
  return v[0].str() + "," + v[1].str() + "," + v[2].str();
}

std::string text_of(const Backprojection& seen) {
  std::ostringstream out;
  for (const SeenBoundary& b : seen.boundaries) {
    out << "face " << b.source_face << ':';
    for (std::size_t k = 0; k < b.sides.size(); ++k) {
      out << " |";
      for (const SeenSide& s : b.sides[k]) {
        out << ' ' << "SECH"[static_cast<int>(s.kind)] << s.id;
      }
      out << " from (" << b.corners[k].transpose() << ')';
    }
    out << '\n';
  }
  return out.str();
}

/// The positions of `turns` among `seen`, from its position `first` on; what lies between
/// them is on their lines.  Empty where it is not so.
std::vector<std::size_t> matches(const std::vector<Point>& seen, std::size_t first,
                                 const std::vector<NaiveSeenSource::Corner>& corners,
                                 const std::vector<std::size_t>& turns, double off) {
  const auto turn = [&](std::size_t i) { return corners[turns[i % turns.size()]].at; };
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const std::size_t at = (first + k) % seen.size();
    if (result.size() < turns.size() && (seen[at] - turn(result.size())).norm() < off) {
      result.push_back(at);
      continue;
    }
    if (result.empty()) return {};
    const Point a = turn(result.size() - 1), way = turn(result.size()) - a;
    if ((seen[at] - a).cross(way).norm() > off * way.norm()) return {};
  }
  return result.size() == turns.size() ? result : std::vector<std::size_t>{};
}

}  // namespace

BackprojectionComparison::BackprojectionComparison(const ShadowScene& lit)
    : name_(lit.name),
      scene_(lit.soup),
      index_(scene_, light_source(scene_, lit.lights, lit.two_sided)),
      naive_(naive_shadow(scene_, lit)) {}

std::optional<std::string> BackprojectionComparison::difference(
    const AskedPoint& p, const ComparedParts& parts) {
  const Backprojection seen = index_.from(
      point_of(p), {.gradient = parts.gradient, .boundaries = parts.structure});
  const NaiveLightAt expected = naive_.at(p.at, p.normal);
  ++counts_.points;
  ++(expected.light == NaiveLight::Umbra      ? counts_.umbra
     : expected.light == NaiveLight::Penumbra ? counts_.penumbra
                                              : counts_.lit);
  std::ostringstream out;
  if (static_cast<int>(seen.shadow) != static_cast<int>(expected.light)) {
    out << "\nclass " << static_cast<int>(seen.shadow) << ", expected "
        << static_cast<int>(expected.light);
  }
  const auto compare = [&](const char* what, double value, long double right,
                           double& most) {
    const auto off = static_cast<double>(std::abs(value - right));
    most = std::max(most, off);
    if (off <= kAllowed) return;
    out.precision(17);
    out << "\n" << what << ' ' << value << ", expected " << right;
  };
  compare("fraction", seen.visible_fraction, expected.visible_fraction, counts_.fraction);
  if (seen.form_factor.has_value() != expected.form_factor.has_value()) {
    out << "\na form factor iff there is a normal";
  } else if (seen.form_factor) {
    compare("form factor", *seen.form_factor, *expected.form_factor, counts_.form_factor);
  }
  if (parts.gradient && p.normal) out << gradient_difference(p, seen);
  if (parts.structure) out << structure_difference(p, seen);
  if (out.str().empty()) return std::nullopt;
  return name_ + ", from " + text_of(p.at) +
         (p.normal ? " normal " + text_of(*p.normal) : "") + out.str();
}

std::string BackprojectionComparison::gradient_difference(const AskedPoint& p,
                                                          const Backprojection& seen) {
  if (!seen.gradient) return "";
  std::ostringstream out;
  const Rational h(0x1p-14);
  const auto moved = [&](int axis, int steps) {
    AskedPoint q = p;
    q.at[axis] += steps * h;
    return q;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto f = [&](int steps) {
      const AskedPoint q = moved(axis, steps);
      return *naive_.at(q.at, q.normal).form_factor;
    };
    const long double slope =
        (8 * (f(1) - f(-1)) - (f(2) - f(-2))) / (12 * static_cast<long double>(h));
    const auto off = static_cast<double>(std::abs(slope - (*seen.gradient)[axis]));
    if (off <= kAllowedGradient) {
      counts_.gradient = std::max(counts_.gradient, off);
      continue;
    }
    // Near an event the differences say nothing.
    const std::string here = text_of(naive_.structure(p.at, p.normal));
    bool same = true;
    for (const int steps : {-2, -1, 1, 2}) {
      const AskedPoint q = moved(axis, steps);
      same = same && text_of(naive_.structure(q.at, q.normal)) == here;
    }
    if (!same) return "";
    out.precision(12);
    out << "\ngradient along axis " << axis << ' ' << (*seen.gradient)[axis]
        << ", expected " << slope;
  }
  ++counts_.gradients;
  return out.str();
}

std::string BackprojectionComparison::structure_difference(const AskedPoint& p,
                                                           const Backprojection& seen) {
  const std::vector<NaiveSeenSource> expected = naive_.structure(p.at, p.normal);
  ++counts_.structures;
  const double size = 1 + (scene_.bounds()[1] - scene_.bounds()[0]).norm();
  const auto failed = [&](const std::string& why) {
    return "\n" + why + "\n" + text_of(seen) + "expected\n" + text_of(expected);
  };
  std::size_t boundaries = 0;
  for (const NaiveSeenSource& source : expected) boundaries += source.boundaries.size();
  if (boundaries != seen.boundaries.size()) return failed("number of boundaries");
  for (const SeenBoundary& boundary : seen.boundaries) {
    std::string least = "no such boundary";
    for (const NaiveSeenSource& source : expected) {
      for (std::size_t i = 0; i < source.boundaries.size() && !least.empty(); ++i) {
        const std::string why = boundary_difference(boundary, source, i, size);
        if (why != "elsewhere") least = why;
      }
    }
    if (!least.empty()) return failed(least);
  }
  return "";
}

std::string BackprojectionComparison::boundary_difference(const SeenBoundary& seen,
                                                          const NaiveSeenSource& expected,
                                                          std::size_t number,
                                                          double size) {
  const auto& corners = expected.corners[number];
  std::vector<std::size_t> turns;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (!corners[k].straight) turns.push_back(k);
  }
  // Where the boundary turns, on both sides; what the library has between is straight.
  for (std::size_t first = 0; first < seen.corners.size(); ++first) {
    const auto matched = matches(seen.corners, first, corners, turns, kSamePoint * size);
    if (matched.empty()) continue;
    const auto face = polygons_.try_emplace(seen.source_face, expected.polygons).first;
    if (face->second != expected.polygons) return "another source face";
    for (std::size_t i = 0; i < turns.size(); ++i) {
      const std::size_t j = (i + 1) % turns.size();
      const std::size_t n = seen.corners.size(), m = corners.size();
      const NaiveSide& on = expected.boundaries[number][turns[i]];
      const std::vector<SeenSide>& its = seen.sides[matched[i]];
      const bool one = (matched[i] + 1) % n == matched[j] && its.size() == 1 &&
                       (turns[i] + 1) % m == turns[j] && on.size() == 1;
      ++(one ? counts_.sides : counts_.in_line);
      if (!one) continue;
      const std::pair key(seen.source_face, its[0]);
      const std::pair naive_key(seen.source_face, on[0]);
      // One naive edge may be several sides of the source, and one naive cut several
      // facets in one plane.
      const bool known = its[0].kind == SeenSide::Kind::Edge;
      if (naive_names_.try_emplace(key, on[0]).first->second != on[0] ||
          (known && names_.try_emplace(naive_key, its[0]).first->second != its[0])) {
        return "another name than before for side " + std::to_string(matched[i]);
      }
    }
    return "";
  }
  return "elsewhere";
}

}  // namespace sightline::testing
