// One loop over independent items for all parts of a skeleton: threads, budget, stop,
// progress and counts, the same answer whatever the number of threads.

#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>

#include "linespace/predicates.h"
#include "linespace/request.h"

namespace sightline::internal {

[[nodiscard]] inline int threads_of(const Request& request) {
  return request.threads > 0 ? request.threads
                             : static_cast<int>(std::thread::hardware_concurrency());
}

[[nodiscard]] inline StageCounts difference(const StageCounts& a, const StageCounts& b) {
  return {a.by_double - b.by_double, a.by_interval - b.by_interval,
          a.by_exact - b.by_exact};
}

/// Calls step(worker, i) for i = 0, ..., count - 1, in chunks of 8, with a worker per
/// thread from make(); stops early when the request's budget, counted from `start`, ends
/// or a stop is requested.  Progress goes from progress[0] to progress[1].
template <class Make, class Step>
void for_each_parallel(std::size_t count, const Request& request,
                       std::chrono::steady_clock::time_point start,
                       std::array<double, 2> progress, StageCounts& counts, Make&& make,
                       Step&& step) {
  const int threads = threads_of(request);
  std::atomic<bool> stopped{false};
  std::atomic<std::size_t> done{0};
  std::mutex mutex;
  using Worker = decltype(make());
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  oneapi::tbb::enumerable_thread_specific<Worker> workers;
  arena.execute([&] {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, count, 8), [&](const auto& range) {
          const PrecisionScope scope(request.precision);
          const StageCounts at_first = thread_stage_counts();
          Worker& worker = workers.local();
          if (!worker) worker = make();
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            if (stopped.load(std::memory_order_relaxed)) break;
            const std::chrono::duration<double> elapsed =
                std::chrono::steady_clock::now() - start;
            if (request.stop.stop_requested() ||
                elapsed.count() > request.budget_seconds) {
              stopped = true;
              break;
            }
            step(*worker, i);
            ++done;
          }
          const StageCounts used = difference(thread_stage_counts(), at_first);
          const std::lock_guard lock(mutex);
          counts.by_double += used.by_double;
          counts.by_interval += used.by_interval;
          counts.by_exact += used.by_exact;
          if (request.progress) {
            const double share = static_cast<double>(done.load()) /
                                 static_cast<double>(std::max<std::size_t>(1, count));
            request.progress(progress[0] + (progress[1] - progress[0]) * share);
          }
        });
  });
}

}  // namespace sightline::internal
