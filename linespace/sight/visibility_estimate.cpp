// Samples are worked on in blocks of a fixed size, and what the blocks found is added up
// in their order, so that not even rounding depends on the threads.  Threads take blocks
// in order and finish what they took: what is done when the budget ends is a prefix.

#include "linespace/visibility_estimate.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "linespace/line_sampling.h"
#include "linespace/sight/occlusion.h"
#include "linespace/work/deadline.h"

namespace sightline {
namespace {

using internal::Certainty;
using internal::FaceSegment;
using internal::kPacket;
using internal::OcclusionAccess;

constexpr std::int64_t kBlock = 2048;  // samples

struct BlockResult {
  std::int64_t free = 0, doubtful = 0;
  std::int64_t first_free = -1;
  double measure = 0, squared_measure = 0;  // sums over free samples
};

class Estimator {
 public:
  Estimator(const OcclusionIndex& index, std::span<const int> faces_a,
            std::span<const int> faces_b, const EstimateOptions& options,
            const Request& request)
      : index_(index),
        faces_a_(faces_a),
        faces_b_(faces_b),
        a_(index.scene(), faces_a),
        b_(index.scene(), faces_b),
        options_(options),
        exact_(request.precision == Precision::Exact) {}

  [[nodiscard]] PairSegment pair(std::int64_t sample) const {
    SampleNumbers numbers(options_.seed, static_cast<std::uint64_t>(sample));
    return segment_between(a_, b_, numbers);
  }

  [[nodiscard]] FaceSegment segment(const PairSegment& pair) const {
    return {pair.a.point, pair.b.point, faces_a_[pair.a.polygon],
            faces_b_[pair.b.polygon]};
  }

  [[nodiscard]] BlockResult block(std::int64_t begin, std::int64_t end) const {
    BlockResult out;
    std::array<FaceSegment, kPacket> segments;
    std::array<double, kPacket> measures;
    std::array<std::int64_t, kPacket> samples;
    std::array<Certainty, kPacket> answers;
    std::array<std::vector<int>, kPacket> doubtful;
    const auto found_free = [&](std::int64_t sample, double measure) {
      ++out.free;
      out.first_free = out.first_free < 0 ? sample : std::min(out.first_free, sample);
      out.measure += measure;
      out.squared_measure += measure * measure;
    };
    while (begin < end) {
      std::size_t count = 0;
      for (; begin < end && count < kPacket; ++begin) {
        const PairSegment p = pair(begin);
        if (p.a.point == p.b.point) {  // nothing between
          found_free(begin, p.measure);
          continue;
        }
        segments[count] = segment(p);
        measures[count] = p.measure;
        samples[count++] = begin;
      }
      OcclusionAccess::ask_packet(index_, std::span(segments).first(count), answers,
                                  doubtful);
      for (std::size_t i = 0; i < count; ++i) {
        if (answers[i] == Certainty::Doubtful) {
          ++out.doubtful;
          answers[i] = exact_ && OcclusionAccess::is_free_of(index_.scene(), doubtful[i],
                                                             segments[i].a, segments[i].b)
                           ? Certainty::Free
                           : Certainty::Blocked;
        }
        if (answers[i] == Certainty::Free) found_free(samples[i], measures[i]);
      }
    }
    return out;
  }

 private:
  const OcclusionIndex& index_;
  std::span<const int> faces_a_, faces_b_;
  PolygonSampler a_, b_;
  EstimateOptions options_;
  bool exact_;
};

void check(const Scene& scene, std::span<const int> faces, const char* name) {
  if (faces.empty()) {
    throw InvalidInput(std::string("visibility estimate: no faces in ") + name);
  }
  const int count = static_cast<int>(scene.faces().size());
  for (const int f : faces) {
    if (f < 0 || f >= count) {
      throw InvalidInput("visibility estimate: there is no face " + std::to_string(f));
    }
  }
}

// Wilson 1927: the fractions from which the one seen is within 1.96 standard deviations.
std::array<double, 2> wilson_interval(double n, double free) {
  constexpr double kZ = 1.959963984540054;  // a normal variable is within, at 95 %
  const double f = free / n, spread = kZ * kZ / n;
  const double center = (f + spread / 2) / (1 + spread);
  const double half = std::sqrt(spread * (f * (1 - f) + spread / 4)) / (1 + spread);
  return {free == 0 ? 0 : center - half, free == n ? 1 : center + half};
}

Estimate mean(double n, double sum, double squared_sum) {
  const double value = sum / n;
  if (n < 2) return {value, std::numeric_limits<double>::infinity()};
  const double variance = std::max(0.0, squared_sum / n - value * value);
  return {value, std::sqrt(variance / (n - 1))};
}

// Runs blocks 0, 1, ... until all are done or it is time to stop; what was done.
std::vector<BlockResult> run(const Estimator& estimator, std::int64_t samples,
                             const internal::Deadline& deadline, const Request& request) {
  const std::int64_t blocks = (samples + kBlock - 1) / kBlock;
  std::vector<BlockResult> results(static_cast<std::size_t>(blocks));
  std::atomic<std::int64_t> next = 0;
  std::mutex telling;
  std::int64_t told = 0;
  const auto work = [&](int) {
    while (!deadline.passed()) {
      const std::int64_t b = next++;
      if (b >= blocks) return;
      results[static_cast<std::size_t>(b)] =
          estimator.block(b * kBlock, std::min(samples, (b + 1) * kBlock));
      if (!request.progress) continue;
      const std::scoped_lock lock(telling);
      request.progress("segments",
                       static_cast<double>(++told) / static_cast<double>(blocks));
    }
  };
  const int threads = request.threads > 0
                          ? request.threads
                          : static_cast<int>(std::thread::hardware_concurrency());
  const oneapi::tbb::global_control limit(
      oneapi::tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  arena.execute([&] { oneapi::tbb::parallel_for(0, threads, work); });
  results.resize(static_cast<std::size_t>(std::min(next.load(), blocks)));
  return results;
}

}  // namespace

VisibilityEstimate estimate_visibility(const OcclusionIndex& index,
                                       std::span<const int> faces_a,
                                       std::span<const int> faces_b,
                                       const EstimateOptions& options,
                                       const Request& request) {
  const internal::Deadline deadline(request);
  if (options.samples < 1) {
    throw InvalidInput("visibility estimate: at least one sample is needed");
  }
  check(index.scene(), faces_a, "A");
  check(index.scene(), faces_b, "B");
  const Estimator estimator(index, faces_a, faces_b, options, request);
  const auto results = run(estimator, options.samples, deadline, request);

  VisibilityEstimate out;
  out.samples =
      std::min(options.samples, static_cast<std::int64_t>(results.size()) * kBlock);
  out.complete = out.samples == options.samples;
  double measure = 0, squared_measure = 0;
  for (const BlockResult& r : results) {
    if (!out.candidate && r.first_free >= 0) {
      const FaceSegment s = estimator.segment(estimator.pair(r.first_free));
      out.candidate = FreePair{s.a, s.b, s.face_a, s.face_b, r.first_free};
    }
    out.free += r.free;
    out.doubtful += r.doubtful;
    measure += r.measure;
    squared_measure += r.squared_measure;
  }
  if (out.samples > 0) {
    const auto n = static_cast<double>(out.samples), free = static_cast<double>(out.free);
    out.fraction = mean(n, free, free);
    out.interval = wilson_interval(n, free);
    out.line_measure = mean(n, measure, squared_measure);
  } else {
    out.fraction.standard_error = out.line_measure.standard_error =
        std::numeric_limits<double>::infinity();
  }
  out.seconds = deadline.seconds();
  return out;
}

}  // namespace sightline
