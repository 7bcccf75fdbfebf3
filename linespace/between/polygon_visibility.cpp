#include "linespace/polygon_visibility.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "linespace/between/occluder_source.h"
#include "linespace/between/polygon_visibility.h"
#include "linespace/between/segment_sampler.h"
#include "linespace/numbers/exact_position.h"
#include "linespace/numbers/unit_scale.h"
#include "linespace/scene/scene.h"
#include "linespace/work/deadline.h"
#include "linespace/work/stop_scope.h"

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

ExactPoint exact_mean(const Triangle& t, const ExactWeights& w) {
  ExactPoint p;
  for (int axis = 0; axis < 3; ++axis) {
    for (int j = 0; j < 3; ++j) p[axis] += w[j] * Rational(t[j][axis]);
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

namespace {

Triangle scaled(const Triangle& t, int exponent) {
  return {internal::scaled(t[0], exponent), internal::scaled(t[1], exponent),
          internal::scaled(t[2], exponent)};
}

/// One pair of triangles: samples, then the search.
class PairSearch {
 public:
  PairSearch(const Triangle& a, const Triangle& b, const PairTerms& terms,
             const VisibilityRequest& request)
      : terms_(terms),
        request_(request),
        space_(a, b, terms.scaled_by),
        sampler_(a, b, request.seed) {}

  SearchResult decide() {
    const StopScope scope(terms_.stop);
    SearchResult result;
    try {
      result = search();
    } catch (const Stopped&) {
      result.outcome = SearchOutcome::Undecided;
      result.counts.undecided = 1;
    }
    result.counts.samples = sampler_.tried();
    return result;
  }

  [[nodiscard]] const SightSpace& space() const { return space_; }

 private:
  SearchResult search() {
    for (const int i : terms_.source.start(terms_.known)) know(i);
    const std::optional<SightPoint> sampled = sample();
    SearchResult result;
    if (sampled || request_.samples_only) {
      result.outcome = sampled ? SearchOutcome::Free : SearchOutcome::Undecided;
      result.segment = sampled;
      result.counts.undecided = sampled ? 0 : 1;
    } else {
      const std::vector<SightPoint> pool = sampler_.first();
      for (const int i : sampler_.heavy()) add_with_patch(known_[i], pool);
      SearchTerms terms{.precision = request_.precision,
                        .seed = request_.seed,
                        .pool = pool,
                        .keep_cover = request_.keep_cover,
                        .most_cells = terms_.most_cells,
                        .stop = terms_.stop,
                        .confirm = [this](const SightPoint& s) { return confirm(s); }};
      result = search_cover(space_, terms);
    }
    return result;
  }

  void know(int i) {
    known_.push_back(i);
    sampler_.add(terms_.source.set()[i]);
  }

  std::optional<SightPoint> sample() {
    const SegmentSampler::Confirm confirm = [this](const SightPoint& s) {
      return std::ranges::none_of(
                 space_.blockers(),
                 [&](const Blocker& blocker) { return space_.blocks(blocker, s); }) &&
             this->confirm(s);
    };
    if (request_.samples_only) return sampler_.spread(request_.samples, confirm);
    const int spread = (request_.samples + 7) / 8;
    std::optional<SightPoint> s = sampler_.spread(spread, confirm);
    return s ? s : sampler_.descend(request_.samples - spread, confirm);
  }

  // Of a patch that is there, one piece is enough.
  void add_with_patch(int i, const std::vector<SightPoint>& pool) {
    if (terms_.source.in_patch(i)) return;
    const std::size_t before = space_.blockers().size();
    terms_.source.add(space_, i);
    const auto blockers = space_.blockers().subspan(before);
    const auto s = std::ranges::find_if(pool, [&](const SightPoint& point) {
      return std::ranges::any_of(blockers, [&](const Blocker& blocker) {
        return space_.blocks(blocker, point);
      });
    });
    if (s != pool.end()) terms_.source.add_patch(space_, i, *s);
  }

  // No occluder blocks the segment; or one does that the space lacked, and has now.
  bool confirm(const SightPoint& s) {
    const int found = terms_.source.find_blocker(space_, s);
    if (found < 0) return !terms_.accept || terms_.accept(space_, s);
    if (std::ranges::find(known_, found) == known_.end()) know(found);
    return false;
  }

  const PairTerms& terms_;
  const VisibilityRequest& request_;
  SightSpace space_;
  SegmentSampler sampler_;
  std::vector<int> known_;  // what the sampler was given, in order
};

}  // namespace

std::function<bool()> stop_of(const VisibilityRequest& request) {
  return [deadline = Deadline(request)] { return deadline.passed(); };
}

Decision decide(std::span<const Triangle> a, std::span<const Triangle> b,
                const PairTerms& terms, const VisibilityRequest& request) {
  Decision decision;
  VisibilityAnswer& answer = decision.answer;
  auto data = std::make_shared<VisibilityCover::Data>();
  bool undecided = false, certified = true;
  for (const Triangle& from : a) {
    for (const Triangle& to : b) {
      PairSearch pair(scaled(from, terms.scaled_by), scaled(to, terms.scaled_by), terms,
                      request);
      SearchResult result = pair.decide();
      answer.cost += result.counts;
      if (result.outcome == SearchOutcome::Free) {
        const auto [alpha, beta] = weights_of(*result.segment);
        answer.verdict = Verdict::Visible;
        answer.witness = {exact_position(exact_mean(from, alpha)),
                          exact_position(exact_mean(to, beta))};
        decision.out_of_effort = false;
        return decision;
      }
      undecided |= result.outcome == SearchOutcome::Undecided;
      if (result.outcome == SearchOutcome::Undecided && answer.occluders.empty()) {
        answer.occluders = std::move(result.stuck_between);
        answer.width = std::ldexp(result.stuck_width, -terms.scaled_by);
      }
      decision.out_of_effort |= result.out_of_effort;
      certified &= result.certified;
      if (request.keep_cover) {
        const SightSpace& space = pair.space();
        auto& cover = data->pairs.emplace_back();
        cover.a = from;
        cover.b = to;
        for (const Form& form : space.forms()) cover.forms.push_back(form.name);
        cover.blockers.assign(space.blockers().begin(), space.blockers().end());
        cover.patches = space.patches();
        cover.cover = std::move(result.cover);
      }
    }
  }
  answer.verdict = undecided ? Verdict::Undecided : Verdict::Hidden;
  if (request.keep_cover && !undecided && certified) {
    answer.cover = std::make_shared<VisibilityCover>(std::move(data));
  }
  return decision;
}

void name_occluders(VisibilityAnswer& answer,
                    const std::function<int(int)>& occluder_of_piece) {
  std::vector<int>& names = answer.occluders;
  for (int& name : names) name = occluder_of_piece(name);
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace internal

VisibilityCost& operator+=(VisibilityCost& sum, const VisibilityCost& cost) {
  sum.samples += cost.samples;
  sum.cells += cost.cells;
  sum.games += cost.games;
  sum.exact_games += cost.exact_games;
  sum.halvings += cost.halvings;
  sum.exact_cells += cost.exact_cells;
  sum.undecided += cost.undecided;
  return sum;
}

namespace {

int scale_of(const internal::CutQuestion& cut) {
  internal::UnitScale scale;
  for (const internal::Triangle& t : cut.a) scale.add(t);
  for (const internal::Triangle& t : cut.b) scale.add(t);
  for (const internal::Piece& piece : cut.pieces) scale.add(piece.corners);
  for (const std::array<Point, 2>& sliver : cut.slivers) scale.add(sliver);
  return scale.exponent();
}

}  // namespace

VisibilityAnswer polygon_visibility(const VisibilityQuestion& question,
                                    const VisibilityRequest& request) {
  const PrecisionScope precision(request.precision);
  const internal::CutQuestion cut = internal::cut(question);
  const int scaled_by = scale_of(cut);
  std::vector<Polygon> polygons;
  for (const internal::Piece& piece : cut.pieces) {
    Polygon& polygon = polygons.emplace_back();
    for (const Point& p : piece.corners) {
      polygon.push_back(internal::scaled(p, scaled_by));
    }
  }
  const internal::OccluderSet set(std::move(polygons));
  internal::OccluderSource source(set, internal::OccluderSource::Numbers::AsInSet, {});
  const auto misses_slivers = [&](const internal::SightSpace& space,
                                  const internal::SightPoint& s) {
    if (cut.slivers.empty()) return true;
    const auto [alpha, beta] = internal::weights_of(s);
    const auto p = internal::exact_mean(space.a(), alpha);
    const auto q = internal::exact_mean(space.b(), beta);
    return std::ranges::none_of(cut.slivers, [&](const auto& sliver) {
      return internal::may_touch(p, q,
                                 {internal::scaled(sliver[0], scaled_by),
                                  internal::scaled(sliver[1], scaled_by)});
    });
  };
  internal::PairTerms terms{.source = source,
                            .known = {},
                            .accept = misses_slivers,
                            .scaled_by = scaled_by,
                            .stop = internal::stop_of(request)};
  VisibilityAnswer answer = internal::decide(cut.a, cut.b, terms, request).answer;
  internal::name_occluders(answer, [&](int piece) { return cut.pieces[piece].occluder; });
  return answer;
}

}  // namespace sightline
