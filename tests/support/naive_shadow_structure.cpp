// The structure of what a point sees of a light, for naive_shadow.h: the borders of its
// convex parts that have seen parts on one side only, named and chained.

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "tests/support/naive_sets.h"
#include "tests/support/naive_shadow_names.h"
#include "tests/support/naive_shadow_rays.h"

namespace sightline::testing {
namespace {

/// A straight piece of a border, the seen part on its left as seen from the point.
struct Step {
  Ray from, to, line;
  NaiveSide on;
  int face;  ///< in whose plane it lies
};

/// A side of some part or face in the picture.
struct Stretch {
  int face;
  Ray begin, end;  ///< counter-clockwise about their line
};

class Structure {
 public:
  Structure(const NaiveRays& rays, const SideNames& names, const Vec3& p,
            const std::optional<Vec3>& normal)
      : rays_(rays), names_(names), p_(p) {
    if (normal) horizon_ = canonical(Ray(*normal));
    parts_ = parts_seen(rays, normal);
    for (int f = 0; f < static_cast<int>(faces().size()); ++f) {
      if (rays.height(f).sign() == 0) {
        if (rays.on_face(f)) own_planes_.push_back(canonical(rays.setup().normals[f]));
        continue;
      }
      for (const auto& [line, stretch] : sides_of(f, rays.cone(f))) {
        sides_[line].push_back(stretch);
      }
    }
  }

  [[nodiscard]] std::vector<NaiveSeenSource> run() const {
    std::map<int, std::vector<int>> patches;
    const Sets sets = joined_patches();
    for (std::size_t i = 0; i < parts_.shown.size(); ++i) {
      patches[sets.find(static_cast<int>(i))].push_back(parts_.shown[i]);
    }
    // Triangles of one polygon that rounding has bent are a source face together.
    std::vector<std::pair<std::vector<int>, std::vector<Step>>> joined;
    for (const auto& [root, members] : patches) {
      std::vector<int> polygons;
      for (const int f : members) polygons.push_back(faces()[f].polygon);
      polygons = sorted_set(polygons);
      std::vector<Step> steps = steps_of(members);
      const auto same = std::ranges::find_if(joined, [&](const auto& known) {
        return std::ranges::any_of(polygons, [&](int polygon) {
          return std::ranges::find(known.first, polygon) != known.first.end();
        });
      });
      if (same == joined.end()) {
        joined.emplace_back(std::move(polygons), std::move(steps));
      } else {
        same->second.insert(same->second.end(), steps.begin(), steps.end());
      }
    }
    std::vector<NaiveSeenSource> result;
    for (const auto& [polygons, steps] : joined) {
      NaiveSeenSource seen;
      seen.polygons = polygons;
      chain(without_doubles(steps), seen);
      if (!seen.boundaries.empty()) result.push_back(std::move(seen));
    }
    std::ranges::sort(result, [](const NaiveSeenSource& a, const NaiveSeenSource& b) {
      return std::tie(a.polygons, a.boundaries) < std::tie(b.polygons, b.boundaries);
    });
    return result;
  }

 private:
  [[nodiscard]] const std::vector<NaiveShadowFace>& faces() const {
    return rays_.setup().faces;
  }

  [[nodiscard]] static std::vector<std::pair<Ray, Stretch>> sides_of(int f,
                                                                     const Cone& cone) {
    std::vector<std::pair<Ray, Stretch>> result;
    for (std::size_t i = 0; i < cone.corners.size(); ++i) {
      const Ray &a = cone.corners[i], &b = cone.corners[(i + 1) % cone.corners.size()];
      const bool turned = reversed(cone.sides[i]);
      result.emplace_back(canonical(cone.sides[i]),
                          turned ? Stretch{f, b, a} : Stretch{f, a, b});
    }
    return result;
  }

  /// Shown source faces in one plane that overlap or touch along a stretch.
  [[nodiscard]] Sets joined_patches() const {
    Sets sets(parts_.shown.size());
    for (std::size_t i = 0; i < parts_.shown.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const int f = parts_.shown[i], g = parts_.shown[j];
        if (rays_.before(f, g)) continue;
        if (touch(rays_.cone(f), rays_.cone(g))) {
          sets.join(static_cast<int>(i), static_cast<int>(j));
        }
      }
    }
    return sets;
  }
  [[nodiscard]] static bool touch(const Cone& f, const Cone& g) {
    if (cut(f, g.sides).inside) return true;
    for (const auto& [line, a] : sides_of(0, f)) {
      for (const auto& [other, b] : sides_of(0, g)) {
        if (line == other && is_before(line, a.begin, b.end) &&
            is_before(line, b.begin, a.end)) {
          return true;
        }
      }
    }
    return false;
  }

  /// Of two rays in the plane with that normal, less than half a turn apart.
  [[nodiscard]] static bool is_before(const Ray& line, const Ray& a, const Ray& b) {
    return orientation(line, a, b) > 0;
  }

  [[nodiscard]] Vec3 in_space(const Ray& ray, int face) const {
    // The face's plane by its own corners.
    const Vec3 n = rays_.setup().normals[face].rational(), v = ray.rational();
    return p_ + Rational(dot(n, faces()[face].corners[0] - p_) / dot(n, v)) * v;
  }

  /// Where the line is cut by a face that goes through the plane of a light; nullopt
  /// where it does not.
  [[nodiscard]] std::optional<Stretch> cut_of(int face, int source,
                                              const Ray& line) const {
    if (rays_.height(face).sign() == 0) return std::nullopt;
    const std::optional<Ray> nearer = rays_.before(face, source);
    if (!nearer || canonical(*nearer) != line) return std::nullopt;
    const std::optional<Cone> front = clip(rays_.cone(face), *nearer);
    if (!front || !clip(rays_.cone(face), -*nearer)) return std::nullopt;
    for (const auto& [side_line, stretch] : sides_of(face, *front)) {
      if (side_line == line) return stretch;
    }
    return std::nullopt;
  }

  /// All that a border of the light may lie on at the ray `at` of the line.
  [[nodiscard]] NaiveSide names_at(const Ray& at, const Ray& line,
                                   const std::vector<int>& patch) const {
    NaiveSide result;
    const auto within = [&](const Stretch& s) {
      return is_before(line, s.begin, at) && is_before(line, at, s.end);
    };
    const auto known = sides_.find(line);
    if (known != sides_.end()) {
      for (const Stretch& s : known->second) {
        if (!within(s) || !counts(s, at, patch)) continue;
        const auto name = names_.name(s.face, in_space(s.begin, s.face),
                                      in_space(s.end, s.face), in_space(at, s.face));
        if (name) result.push_back(*name);
      }
    }
    for (int f = 0; f < static_cast<int>(faces().size()); ++f) {
      const std::optional<Stretch> s = cut_of(f, patch[0], line);
      if (!s || !within(*s)) continue;
      // By the line alone: its point nearest to the origin, and its direction.
      const Vec3 a = in_space(s->begin, patch[0]), way = in_space(s->end, patch[0]) - a;
      const Vec3 foot = a - Rational(dot(a, way) / dot(way, way)) * way;
      result.push_back(
          {NaiveSideName::Kind::Cut, {foot, canonical(Ray(way)).rational()}});
    }
    if (horizon_ == line || std::ranges::find(own_planes_, line) != own_planes_.end()) {
      result.push_back({NaiveSideName::Kind::Horizon, {}});
    }
    return sorted_set(result);
  }

  /// The side is one of the light's outline, or of a face that is before the light there.
  [[nodiscard]] bool counts(const Stretch& s, const Ray& at,
                            const std::vector<int>& patch) const {
    const std::optional<Ray> nearer = rays_.before(s.face, patch[0]);
    if (!nearer) {
      return std::ranges::find(patch, s.face) != patch.end() &&
             names_.on_outline(s.face, in_space(s.begin, s.face), in_space(s.end, s.face),
                               in_space(at, s.face));
    }
    const int here = side(*nearer, at);
    return here > 0 || (here == 0 && std::ranges::any_of(rays_.cone(s.face).corners,
                                                         [&](const Ray& c) {
                                                           return side(*nearer, c) > 0;
                                                         }));
  }

  /// Ends of all that may matter on the line, in order, each once.
  [[nodiscard]] std::vector<Ray> stops(const Ray& line, const std::vector<Stretch>& plus,
                                       const std::vector<Stretch>& minus,
                                       int source) const {
    std::vector<Ray> result;
    const auto add = [&](const Stretch& s) {
      // Others are not in the half-space of rays that meet the light's plane.
      const int way = rays_.height(source).sign();
      for (const Ray& r : {s.begin, s.end}) {
        if (side(rays_.setup().normals[source], r) == way) result.push_back(r);
      }
    };
    for (const Stretch& s : plus) add(s);
    for (const Stretch& s : minus) add(s);
    const auto known = sides_.find(line);
    if (known != sides_.end()) {
      for (const Stretch& s : known->second) {
        add(s);
        // Where its face passes through the plane of the light.
        const std::optional<Ray> nearer = rays_.before(s.face, source);
        if (!nearer || canonical(*nearer) == line) continue;
        const Vec3 way = cross(nearer->rational(), line.rational());
        for (const Ray& r : {Ray(way), Ray(Rational(-1) * way)}) {
          if (is_before(line, s.begin, r) && is_before(line, r, s.end))
            add({s.face, r, r});
        }
      }
    }
    for (int f = 0; f < static_cast<int>(faces().size()); ++f) {
      if (const auto s = cut_of(f, source, line)) add(*s);
    }
    std::ranges::sort(result,
                      [&](const Ray& a, const Ray& b) { return is_before(line, a, b); });
    result.erase(std::ranges::unique(result).begin(), result.end());
    return result;
  }

  [[nodiscard]] std::vector<Step> steps_of(const std::vector<int>& patch) const {
    // Sides of parts by line: those that have their part on its positive side, others.
    std::map<Ray, std::array<std::vector<Stretch>, 2>> by_line;
    for (const SourcePart& part : parts_.seen) {
      if (std::ranges::find(patch, part.face) == patch.end()) continue;
      for (std::size_t i = 0; i < part.cone.sides.size(); ++i) {
        const auto [line, stretch] = sides_of(part.face, part.cone)[i];
        by_line[line][reversed(part.cone.sides[i]) ? 1 : 0].push_back(stretch);
      }
    }
    std::vector<Step> result;
    for (const auto& [line, sides] : by_line) {
      const std::vector<Ray> at = stops(line, sides[0], sides[1], patch[0]);
      for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        const auto covered = [&, &line = line](const std::vector<Stretch>& list) {
          return std::ranges::any_of(list, [&](const Stretch& s) {
            return !is_before(line, at[i], s.begin) && !is_before(line, s.end, at[i + 1]);
          });
        };
        const bool plus = covered(sides[0]), minus = covered(sides[1]);
        if (plus == minus) continue;
        NaiveSide on = names_at(between({at[i], at[i + 1]}), line, patch);
        // Counter-clockwise about the line its positive side is seen on the right.
        result.push_back(plus ? Step{at[i + 1], at[i], line, std::move(on), patch[0]}
                              : Step{at[i], at[i + 1], line, std::move(on), patch[0]});
      }
    }
    return result;
  }

  /// Without the parts of steps along which another one runs the other way: what is seen
  /// goes on across a fold.
  [[nodiscard]] static std::vector<Step> without_doubles(const std::vector<Step>& steps) {
    std::vector<Step> result;
    for (const Step& step : steps) {
      const auto forward = [&](const Step& s) {
        return is_before(step.line, s.from, s.to);
      };
      const auto low = [&](const Step& s) { return forward(s) ? s.from : s.to; };
      const auto high = [&](const Step& s) { return forward(s) ? s.to : s.from; };
      std::vector<Ray> at{low(step), high(step)};
      std::vector<const Step*> against;
      for (const Step& other : steps) {
        if (other.line != step.line || forward(other) == forward(step)) continue;
        against.push_back(&other);
        for (const Ray& r : {other.from, other.to}) {
          if (is_before(step.line, at[0], r) && is_before(step.line, r, at[1])) {
            at.push_back(r);
          }
        }
      }
      std::ranges::sort(
          at, [&](const Ray& a, const Ray& b) { return is_before(step.line, a, b); });
      for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        if (at[i] == at[i + 1]) continue;
        const bool doubled = std::ranges::any_of(against, [&](const Step* other) {
          return !is_before(step.line, at[i], low(*other)) &&
                 !is_before(step.line, high(*other), at[i + 1]);
        });
        if (doubled) continue;
        Step part = step;
        part.from = forward(step) ? at[i] : at[i + 1];
        part.to = forward(step) ? at[i + 1] : at[i];
        result.push_back(std::move(part));
      }
    }
    return result;
  }

  /// The step that goes on along the same seen part: the first one clockwise from where
  /// this one comes from.
  [[nodiscard]] static std::size_t next_of(const Step& step, const std::vector<Step>& all,
                                           const std::vector<char>& used) {
    const auto half = [&](const Ray& to) {
      const int turn = orientation(step.to, step.from, to);
      return turn > 0 ? 0 : turn == 0 ? 1 : 2;
    };
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (used[i] != 0 || all[i].from != step.to) continue;
      if (best) {
        const int a = half(all[i].to), b = half(all[*best].to);
        if (a > b || (a == b && orientation(step.to, all[i].to, all[*best].to) < 0)) {
          continue;
        }
      }
      best = i;
    }
    if (!best) throw std::logic_error("naive shadow: a border that ends");
    return *best;
  }

  void chain(const std::vector<Step>& steps, NaiveSeenSource& seen) const {
    std::vector<char> used(steps.size(), 0);
    std::vector<std::pair<std::vector<NaiveSide>, std::vector<NaiveSeenSource::Corner>>>
        loops;
    for (std::size_t first = 0; first < steps.size(); ++first) {
      if (used[first] != 0) continue;
      std::vector<std::size_t> loop{first};
      // The first one is left free, so that it is found at the end.
      while (true) {
        const std::size_t next = next_of(steps[loop.back()], steps, used);
        used[next] = 1;
        if (next == first) break;
        loop.push_back(next);
      }
      loops.push_back(told(steps, loop));
    }
    std::ranges::sort(loops,
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [boundary, corners] : loops) {
      seen.boundaries.push_back(std::move(boundary));
      seen.corners.push_back(std::move(corners));
    }
  }

  /// Steps on one line with one name are one; the smallest rotation.
  [[nodiscard]] std::pair<std::vector<NaiveSide>, std::vector<NaiveSeenSource::Corner>>
  told(const std::vector<Step>& steps, const std::vector<std::size_t>& loop) const {
    std::vector<NaiveSide> sides;
    std::vector<NaiveSeenSource::Corner> corners;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Step& last = steps[loop[(i + loop.size() - 1) % loop.size()]];
      const Step& step = steps[loop[i]];
      if (last.line == step.line && last.on == step.on) continue;
      sides.push_back(step.on);
      const Vec3 at = in_space(step.from, step.face);
      corners.push_back({Point(static_cast<double>(at[0]), static_cast<double>(at[1]),
                               static_cast<double>(at[2])),
                         last.line == step.line});
    }
    std::vector<NaiveSide> best = sides;
    std::size_t shift = 0;
    for (std::size_t i = 1; i < sides.size(); ++i) {
      std::vector<NaiveSide> rotated = sides;
      std::rotate(rotated.begin(), rotated.begin() + static_cast<std::ptrdiff_t>(i),
                  rotated.end());
      if (rotated < best) {
        best = std::move(rotated);
        shift = i;
      }
    }
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(shift),
                corners.end());
    return {best, corners};
  }

  const NaiveRays& rays_;
  const SideNames& names_;
  Vec3 p_;
  std::optional<Ray> horizon_;
  std::vector<Ray> own_planes_;
  SourceParts parts_;
  std::map<Ray, std::vector<Stretch>> sides_;  ///< of faces, by their lines
};

}  // namespace

std::vector<NaiveSeenSource> NaiveShadow::structure(
    const Vec3& p, const std::optional<Vec3>& normal) const {
  const NaiveRays rays(*setup_, p);
  return Structure(rays, setup_->names(), p, normal).run();
}

std::string text_of(const std::vector<NaiveSeenSource>& structure) {
  constexpr std::array kKinds{"edge", "cut", "horizon", "fold"};
  std::ostringstream out;
  for (const NaiveSeenSource& source : structure) {
    out << "source";
    for (const int polygon : source.polygons) out << ' ' << polygon;
    for (const auto& boundary : source.boundaries) {
      out << "\n  boundary";
      for (const NaiveSide& on : boundary) {
        out << " |";
        for (const NaiveSideName& name : on) {
          out << ' ' << kKinds[static_cast<int>(name.kind)];
          if (name.kind == NaiveSideName::Kind::Horizon) continue;
          for (const Vec3& end : name.ends) {
            out << " (" << end[0] << ' ' << end[1] << ' ' << end[2] << ')';
          }
        }
      }
    }
    out << '\n';
  }
  return out.str();
}

}  // namespace sightline::testing
