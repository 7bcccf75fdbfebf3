#include "linespace/face_visibility.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <span>

#include "linespace/between/glued_solids.h"
#include "linespace/between/occluder_source.h"
#include "linespace/between/polygon_visibility.h"
#include "linespace/between/seams.h"
#include "linespace/numbers/unit_scale.h"
#include "linespace/scene/scene.h"
#include "linespace/seams.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/work/stage.h"

namespace sightline {

using namespace internal;

namespace {

Polygon polygon_of(const Scene& scene, int face) {
  Polygon polygon;
  for (const int p : scene.face_points(face)) polygon.push_back(scene.point(p));
  return polygon;
}

/// Polygons that block, each with the face that it is of.
struct FacePieces {
  std::vector<Polygon> polygons;
  std::vector<int> face;

  /// The faces, and behind them what lies around each one.
  FacePieces(const Scene& scene, double seam) {
    const int count = static_cast<int>(scene.faces().size());
    for (int f = 0; f < count; ++f) {
      hear_stop();
      add(polygon_of(scene, f), f);
    }
    if (seam == 0) return;
    for (int f = 0; f < count; ++f) {
      hear_stop();
      for (Polygon& flap : flaps(polygons[f], seam / 2)) add(std::move(flap), f);
    }
  }

  void add(Polygon polygon, int f) {
    polygons.push_back(std::move(polygon));
    face.push_back(f);
  }

  [[nodiscard]] int scale() const {
    UnitScale scale;
    for (const Polygon& polygon : polygons) scale.add(polygon);
    return scale.exponent();
  }
};

std::vector<Polygon> scaled(std::vector<Polygon> polygons, int exponent) {
  for (Polygon& polygon : polygons) {
    for (Point& p : polygon) p = internal::scaled(p, exponent);
  }
  return polygons;
}

/// What a pair may cost in one pass.
struct Effort {
  int samples;
  bool samples_only;
  std::int64_t cells;
};

/// The passes over the pairs: a few samples; then all of them and a search that may look
/// at more cells each time.
Effort effort_of_pass(int pass, const VisibilityRequest& request) {
  constexpr int kFirstSamples = 64;
  constexpr std::int64_t kFirstCells = 256;
  if (pass == 0) return {std::min(kFirstSamples, request.samples), true, 0};
  // 16 times as many each time; from pass 15 on there is no limit.
  const std::int64_t cells = pass < 15 ? kFirstCells << (4 * (pass - 1))
                                       : std::numeric_limits<std::int64_t>::max();
  return {request.samples, false, cells};
}

}  // namespace

struct FaceVisibility::Impl {
  const Scene& scene;
  bool grown;
  int scaled_by;
  OccluderSet set;           // the pieces times 2^scaled_by
  std::vector<int> face_of;  // per piece

  // Hears a stop of the thread's own scopes.
  Impl(const Scene& s, double seam) : Impl(s, seam > 0, FacePieces(s, seam)) {}
  Impl(const Scene& s, bool is_grown, FacePieces pieces)
      : scene(s),
        grown(is_grown),
        scaled_by(pieces.scale()),
        set(scaled(std::move(pieces.polygons), scaled_by)),
        face_of(std::move(pieces.face)) {}

  // In the units of the scene.
  [[nodiscard]] Polygon piece(int number) const {
    Polygon polygon = set[number];
    for (Point& p : polygon) p = internal::scaled(p, -scaled_by);
    return polygon;
  }

  // A face that does not block between a and b.
  [[nodiscard]] bool is_left_out(int face, int a, int b) const {
    return face == a || face == b || in_one_plane(scene, a, face) ||
           in_one_plane(scene, b, face);
  }

  void check(int face) const {
    if (face < 0 || face >= static_cast<int>(scene.faces().size())) {
      throw InvalidInput("there is no face " + std::to_string(face));
    }
  }

  struct PairDecision {
    FacePairAnswer pair;
    bool out_of_effort = false;
  };
  /// `blockers` block although they lie in the plane of a or b.  `recent`: what was found
  /// for the last target of the same source is tried first.
  PairDecision decide_pair(int a, int b, std::span<const int> blockers,
                           std::vector<int>& recent, const Effort& effort,
                           const VisibilityRequest& request,
                           const std::function<bool()>& stop) const;
  [[nodiscard]] GluedSolids glued_to(int face) const;
};

GluedSolids FaceVisibility::Impl::glued_to(int face) const {
  hear_stop();
  // The set begins with the faces, in their order.
  return GluedSolids(scene, face, [this](int f) {
    std::vector<int> near = set.meeting(box_of(set[f]));
    std::erase_if(near, [this](int piece) {
      return piece >= static_cast<int>(scene.faces().size());
    });
    return near;
  });
}

FaceVisibility::Impl::PairDecision FaceVisibility::Impl::decide_pair(
    int a, int b, std::span<const int> blockers, std::vector<int>& recent,
    const Effort& effort, const VisibilityRequest& request,
    const std::function<bool()>& stop) const {
  constexpr std::size_t kRemembered = 64;
  PairDecision result{{a, b, {}, {}}};
  FacePairAnswer& pair = result.pair;
  if (in_one_plane(scene, a, b)) {
    pair.answer.verdict = Verdict::Hidden;
    return result;
  }
  OccluderSource source(set, OccluderSource::Numbers::AsFound, [&](int piece) {
    const int face = face_of[piece];
    return is_left_out(face, a, b) && std::ranges::find(blockers, face) == blockers.end();
  });
  VisibilityRequest terms = request;
  terms.samples = effort.samples;
  terms.samples_only = effort.samples_only;
  Decision decision = decide(fan(polygon_of(scene, a)), fan(polygon_of(scene, b)),
                             {.source = source,
                              .known = recent,
                              .accept = {},
                              .scaled_by = scaled_by,
                              .most_cells = effort.cells,
                              .stop = stop},
                             terms);
  pair.answer = std::move(decision.answer);
  recent = source.found();
  for (const int piece : recent) pair.occluders.push_back(face_of[piece]);
  name_occluders(pair.answer, [&](int piece) { return pair.occluders[piece]; });
  if (grown) {
    pair.pieces = recent;
    std::ranges::sort(pair.occluders);
    const auto [rest, end] = std::ranges::unique(pair.occluders);
    pair.occluders.erase(rest, end);
  }
  if (recent.size() > kRemembered)
    recent.erase(recent.begin(), recent.end() - kRemembered);
  result.out_of_effort = decision.out_of_effort;
  return result;
}

FaceVisibility::FaceVisibility(const Scene& scene, const Request& request, double seam) {
  check_seam(seam);
  const Stage stage(request, "faces");
  impl_ = std::make_unique<Impl>(scene, seam);
}
FaceVisibility::~FaceVisibility() = default;
FaceVisibility::FaceVisibility(FaceVisibility&&) noexcept = default;

FacePairAnswer FaceVisibility::between(int a, int b,
                                       const VisibilityRequest& request) const {
  impl_->check(a);
  impl_->check(b);
  const PrecisionScope precision(request.precision);
  std::vector<int> recent;
  const Effort all{request.samples, request.samples_only,
                   std::numeric_limits<std::int64_t>::max()};
  return impl_->decide_pair(a, b, {}, recent, all, request, stop_of(request)).pair;
}

namespace {

/// The pairs of two sets of faces, asked in passes.  In a pass all pairs of one face of
/// `as`, a row, are one task, and what was found for one pair helps the next.
template <class DecidePair, class IsHidden>
class GroupQuestion {
 public:
  GroupQuestion(std::span<const int> as, std::span<const int> bs, bool all_pairs,
                const VisibilityRequest& request, DecidePair decide_pair,
                IsHidden is_hidden)
      : as_(as),
        bs_(bs),
        all_pairs_(all_pairs),
        request_(request),
        decide_pair_(decide_pair),
        is_hidden_(is_hidden),
        over_(stop_of(request)),
        open_(as.size() * bs.size(), kOpen),
        recent_(as.size()) {}

  GroupAnswer run() {
    if (all_pairs_ || request_.samples_only) {
      run_pass({request_.samples, request_.samples_only,
                std::numeric_limits<std::int64_t>::max()});
    } else {
      for (; !answer_.visible && more_; ++pass_) {
        run_pass(effort_of_pass(pass_, request_));
      }
    }
    answer_.pairs_undecided = std::ranges::count(open_, kOpen);
    if (answer_.visible && !all_pairs_) answer_.pairs_undecided = 0;
    if (answer_.pairs_undecided == 0) answer_.undecided.reset();
    answer_.verdict = answer_.visible               ? Verdict::Visible
                      : answer_.pairs_undecided > 0 ? Verdict::Undecided
                                                    : Verdict::Hidden;
    return std::move(answer_);
  }

 private:
  enum : std::uint8_t { kDone, kOpen };
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  struct Row {
    std::vector<FacePairAnswer> pairs;  // all, or the visible one
    VisibilityCost cost;
    std::int64_t hidden = 0;
    bool more = false;                        // a pair of it is worth another pass
    std::optional<FacePairAnswer> undecided;  // the first
  };

  void run_pass(const Effort& effort) {
    std::vector<Row> rows(as_.size());
    std::atomic<std::size_t> done = 0;
    tbb::task_arena arena(request_.threads > 0 ? request_.threads
                                               : tbb::task_arena::automatic);
    const auto task = [&](std::size_t i) {
      const PrecisionScope precision(request_.precision);
      const StageCounts before = thread_stage_counts();
      run_row(i, effort, rows[i]);
      const std::scoped_lock lock(mutex_);
      count_predicates(before);
      ++done;
      if (request_.progress) {
        request_.progress("pairs of faces", share(static_cast<double>(done) /
                                                  static_cast<double>(as_.size())));
      }
    };
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, as_.size(), task, tbb::simple_partitioner());
    });
    collect(rows);
  }

  // Of all the work, of which nobody knows how many passes it takes: each pass is half of
  // what is left.
  [[nodiscard]] double share(double of_pass) const {
    return all_pairs_ ? of_pass : 1 - std::ldexp(1 - of_pass / 2, -pass_);
  }

  void run_row(std::size_t i, const Effort& effort, Row& row) {
    for (std::size_t j = 0; j < bs_.size(); ++j) {
      const std::size_t number = i * bs_.size() + j;
      if (open_[number] != kOpen && !all_pairs_) continue;
      if (!all_pairs_ && first_visible_ < number) return;
      // What comes before a visible pair is finished, so that the pair that is told does
      // not depend on the budget.
      const auto stop = [&] {
        const bool must_finish = first_visible_ != kNone;
        return request_.stop.stop_requested() || (!must_finish && over_());
      };
      if (!all_pairs_ && is_hidden_(as_[i], bs_[j])) {
        open_[number] = kDone;
        ++row.hidden;
        continue;
      }
      auto [pair, out_of_effort] =
          decide_pair_(as_[i], bs_[j], recent_[i], effort, request_, stop);
      row.cost += pair.answer.cost;
      row.more |= out_of_effort || effort.samples_only;
      row.hidden += pair.answer.verdict == Verdict::Hidden;
      if (pair.answer.verdict != Verdict::Undecided) open_[number] = kDone;
      if (pair.answer.verdict == Verdict::Undecided && !row.undecided) {
        row.undecided = pair;
      }
      const bool visible = pair.answer.verdict == Verdict::Visible;
      if (visible && !all_pairs_) note_visible(number);
      if (visible || all_pairs_) row.pairs.push_back(std::move(pair));
      if (visible && !all_pairs_) return;
    }
  }

  void note_visible(std::size_t number) {
    std::size_t known = first_visible_;
    while (number < known && !first_visible_.compare_exchange_weak(known, number)) {
    }
  }

  void count_predicates(const StageCounts& before) {
    const StageCounts& after = thread_stage_counts();
    answer_.predicates.by_double += after.by_double - before.by_double;
    answer_.predicates.by_interval += after.by_interval - before.by_interval;
    answer_.predicates.by_exact += after.by_exact - before.by_exact;
  }

  // Rows behind the first visible pair's were dropped or not, as it happened.
  void collect(std::vector<Row>& rows) {
    more_ = false;
    answer_.undecided.reset();
    for (Row& row : rows) {
      if (row.undecided && !answer_.undecided) answer_.undecided = row.undecided;
      answer_.cost += row.cost;
      answer_.pairs_hidden += row.hidden;
      more_ |= row.more;
      for (FacePairAnswer& pair : row.pairs) {
        if (pair.answer.verdict == Verdict::Visible && !answer_.visible) {
          answer_.visible = pair;
        }
        if (all_pairs_) answer_.pairs.push_back(std::move(pair));
      }
      if (answer_.visible && !all_pairs_) return;
    }
    more_ &= !over_();
  }

  std::span<const int> as_, bs_;
  bool all_pairs_;
  const VisibilityRequest& request_;
  DecidePair decide_pair_;
  IsHidden is_hidden_;
  std::function<bool()> over_;
  std::vector<std::uint8_t> open_;        // per pair
  std::vector<std::vector<int>> recent_;  // per row
  std::atomic<std::size_t> first_visible_ = kNone;
  int pass_ = 0;
  bool more_ = true;
  std::mutex mutex_;
  GroupAnswer answer_;
};

}  // namespace

GroupAnswer FaceVisibility::between(std::span<const int> as, std::span<const int> bs,
                                    bool all_pairs,
                                    const VisibilityRequest& request) const {
  for (const int a : as) impl_->check(a);
  for (const int b : bs) impl_->check(b);
  std::map<int, GluedSolids> glued;
  for (const auto& faces : {as, bs}) {
    for (const int face : faces) {
      if (all_pairs || glued.contains(face)) continue;
      glued.emplace(face, impl_->glued_to(face));
    }
  }
  const auto decide_pair = [&](int a, int b, auto&&... terms) {
    if (all_pairs) return impl_->decide_pair(a, b, {}, terms...);
    // A segment has to miss one of the sets.
    const auto sets = GluedSolids::blockers(glued.at(a), glued.at(b));
    auto found = impl_->decide_pair(a, b, sets[0], terms...);
    if (sets.size() == 1 || found.pair.answer.verdict == Verdict::Visible) return found;
    auto other = impl_->decide_pair(a, b, sets[1], terms...);
    other.pair.answer.cost += found.pair.answer.cost;
    other.out_of_effort |= found.out_of_effort;
    const bool keeps_open = found.pair.answer.verdict == Verdict::Undecided &&
                            other.pair.answer.verdict == Verdict::Hidden;
    if (keeps_open) std::swap(found.pair, other.pair);
    return other;
  };
  const auto is_hidden = [&](int a, int b) {
    return glued.at(a).hide(b) || glued.at(b).hide(a);
  };
  return GroupQuestion(as, bs, all_pairs, request, decide_pair, is_hidden).run();
}

std::vector<int> FaceVisibility::met(int a, int b,
                                     const std::array<ExactPosition, 2>& segment) const {
  impl_->check(a);
  impl_->check(b);
  std::vector<Polygon> pieces;
  for (std::size_t i = 0; i < impl_->face_of.size(); ++i) {
    pieces.push_back(impl_->piece(static_cast<int>(i)));
  }
  std::vector<int> faces;
  for (const int piece : polygons_met(pieces, segment)) {
    const int face = impl_->face_of[piece];
    if (!impl_->is_left_out(face, a, b)) faces.push_back(face);
  }
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

VisibilityQuestion FaceVisibility::question_of(const FacePairAnswer& pair) const {
  const Scene& scene = impl_->scene;
  VisibilityQuestion question{polygon_of(scene, pair.a), polygon_of(scene, pair.b), {}};
  for (const int piece : impl_->grown ? pair.pieces : pair.occluders) {
    question.occluders.push_back(impl_->piece(piece));
  }
  return question;
}

}  // namespace sightline
