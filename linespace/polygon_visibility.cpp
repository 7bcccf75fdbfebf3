#include "linespace/polygon_visibility.h"

#include <algorithm>
#include <chrono>

#include "linespace/occluder_source_internal.h"
#include "linespace/polygon_visibility_internal.h"
#include "linespace/scene_internal.h"

namespace sightline {
namespace internal {
namespace {

// Without repeats in a row, which change nothing.
Polygon checked_corners(const Polygon& polygon, const std::string& name) {
  if (polygon.empty()) throw InvalidInput(name + ": a polygon without corners");
  Polygon corners;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (const double x : polygon[i]) {
      if (is_admissible(x)) continue;
      throw InvalidInput(name + ": corner " + std::to_string(i) +
                         " has a coordinate that is not finite, or neither 0 nor of "
                         "magnitude in [2^-140, 2^140]");
    }
    if (corners.empty() || polygon[i] != corners.back()) corners.push_back(polygon[i]);
  }
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  return corners;
}

// Convex planar pieces; none for a polygon without area.
std::vector<Polygon> pieces_of(const Polygon& given, const std::string& name) {
  const Polygon polygon = checked_corners(given, name);
  if (polygon.size() < 3) return {};
  std::vector<int> ring(polygon.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<int>(i);
  const PolygonPieces cut = cut_into_pieces(polygon, ring);
  if (cut.zero_area) return {};
  if (!cut.convex) throw InvalidInput(name + ": not convex");
  std::vector<Polygon> pieces;
  std::size_t next = 0;
  for (const int size : cut.sizes) {
    Polygon& piece = pieces.emplace_back();
    for (int i = 0; i < size; ++i) piece.push_back(polygon[cut.corners[next++]]);
  }
  return pieces;
}

std::vector<Triangle> triangles_of(const Polygon& polygon, const std::string& name) {
  std::vector<Triangle> triangles;
  for (const Polygon& piece : pieces_of(polygon, name)) {
    const std::vector<Triangle> part = fan(piece);
    triangles.insert(triangles.end(), part.begin(), part.end());
  }
  if (triangles.empty()) throw InvalidInput(name + ": has no area");
  return triangles;
}

std::array<Point, 2> outermost(const Polygon& polygon) {
  const auto less = [](const Point& u, const Point& v) {
    return std::lexicographical_compare(u.data(), u.data() + 3, v.data(), v.data() + 3);
  };
  const auto [low, high] = std::minmax_element(polygon.begin(), polygon.end(), less);
  return {*low, *high};
}

// The segment pq may meet the sliver: its line meets the sliver's line, or, for a point,
// goes through it.  Exact, and on the safe side.
bool may_touch(const ExactPoint& p, const ExactPoint& q,
               const std::array<Point, 2>& sliver) {
  const ExactPoint u = exact_point(sliver[0]);
  if (sliver[0] != sliver[1]) {
    return exact_orient3d(p, q, u, exact_point(sliver[1])) == 0;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if ((q[i] - p[i]) * (u[j] - p[j]) != (q[j] - p[j]) * (u[i] - p[i])) return false;
  }
  return true;
}

ExactPosition position(const ExactPoint& p) {
  ExactPosition out;
  for (int axis = 0; axis < 3; ++axis) {
    out.nearest[axis] = static_cast<double>(p[axis]);
    out.exact[axis] = p[axis].str();
    out.is_double[axis] = Rational(out.nearest[axis]) == p[axis];
  }
  return out;
}

}  // namespace

CutQuestion cut(const VisibilityQuestion& question) {
  CutQuestion result;
  result.a = triangles_of(question.a, "a");
  result.b = triangles_of(question.b, "b");
  for (std::size_t i = 0; i < question.occluders.size(); ++i) {
    const Polygon& occluder = question.occluders[i];
    std::string name = "occluders[";
    name += std::to_string(i);
    name += "]";
    const auto pieces = pieces_of(occluder, name);
    if (pieces.empty()) result.slivers.push_back(outermost(occluder));
    for (const Polygon& piece : pieces) {
      result.pieces.push_back({static_cast<int>(i), piece});
    }
  }
  return result;
}

ExactPoint exact_mean(const Triangle& t, const Weights& w) {
  ExactPoint p;
  for (int axis = 0; axis < 3; ++axis) {
    for (int j = 0; j < 3; ++j) p[axis] += Rational(w[j]) * Rational(t[j][axis]);
  }
  return p;
}

std::vector<Triangle> fan(std::span<const Point> p) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 2; i < p.size(); ++i) {
    if (!collinear(p[0], p[i - 1], p[i])) triangles.push_back({p[0], p[i - 1], p[i]});
  }
  return triangles;
}

VisibilityAnswer decide(std::span<const Triangle> a, std::span<const Triangle> b,
                        const PairTerms& pair_terms, const VisibilityRequest& request) {
  const auto started = std::chrono::steady_clock::now();
  VisibilityAnswer answer;
  auto data = std::make_shared<VisibilityCover::Data>();
  bool undecided = false;
  for (const Triangle& from : a) {
    for (const Triangle& to : b) {
      SightSpace space(from, to);
      pair_terms.start(space);
      SearchTerms terms;
      terms.precision = request.precision;
      terms.samples = request.samples;
      terms.samples_only = request.samples_only;
      terms.seed = request.seed;
      terms.keep_cover = request.keep_cover;
      terms.stop = [&] {
        const std::chrono::duration<double> spent =
            std::chrono::steady_clock::now() - started;
        return request.stop.stop_requested() || spent.count() > request.budget_seconds;
      };
      terms.confirm = [&](const SightPoint& s) { return pair_terms.confirm(space, s); };
      SearchResult result = search_cover(space, terms);
      answer.cost += result.counts;
      if (result.outcome == SearchOutcome::Free) {
        answer.verdict = Verdict::Visible;
        answer.witness = {position(exact_mean(from, result.segment->alpha)),
                          position(exact_mean(to, result.segment->beta))};
        return answer;
      }
      undecided |= result.outcome == SearchOutcome::Undecided;
      if (request.keep_cover) {
        auto& pair = data->pairs.emplace_back();
        pair.a = from;
        pair.b = to;
        for (const Form& form : space.forms()) pair.forms.push_back(form.name);
        pair.blockers.assign(space.blockers().begin(), space.blockers().end());
        pair.cover = std::move(result.cover);
      }
    }
  }
  answer.verdict = undecided ? Verdict::Undecided : Verdict::Hidden;
  if (request.keep_cover && !undecided) {
    answer.cover = std::make_shared<VisibilityCover>(std::move(data));
  }
  return answer;
}

}  // namespace internal

VisibilityCost& operator+=(VisibilityCost& sum, const VisibilityCost& cost) {
  sum.samples += cost.samples;
  sum.cells += cost.cells;
  sum.games += cost.games;
  sum.exact_games += cost.exact_games;
  sum.halvings += cost.halvings;
  sum.undecided += cost.undecided;
  return sum;
}

VisibilityAnswer polygon_visibility(const VisibilityQuestion& question,
                                    const VisibilityRequest& request) {
  const PrecisionScope precision(request.precision);
  const internal::CutQuestion cut = internal::cut(question);
  std::vector<Polygon> polygons;
  for (const internal::Piece& piece : cut.pieces) polygons.push_back(piece.corners);
  const internal::OccluderSet set(std::move(polygons));
  internal::OccluderSource source(set, internal::OccluderSource::Numbers::AsInSet, {});
  const auto misses_slivers = [&](const internal::SightSpace& space,
                                  const internal::SightPoint& s) {
    if (cut.slivers.empty()) return true;
    const auto p = internal::exact_mean(space.a(), s.alpha);
    const auto q = internal::exact_mean(space.b(), s.beta);
    return std::ranges::none_of(cut.slivers, [&](const auto& sliver) {
      return internal::may_touch(p, q, sliver);
    });
  };
  return internal::decide(
      cut.a, cut.b,
      {[&](internal::SightSpace& space) { source.start(space); },
       [&](internal::SightSpace& space, const internal::SightPoint& s) {
         return source.is_free(space, s) && misses_slivers(space, s);
       }},
      request);
}

}  // namespace sightline
