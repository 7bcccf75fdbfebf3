// One loop over independent items for all parts of a skeleton: threads, budget, stop,
// progress and counts, the same answer whatever the number of threads.

#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "linespace/generator.h"
#include "linespace/predicates.h"
#include "linespace/request.h"
#include "linespace/work/deadline.h"
#include "linespace/work/stage.h"

namespace sightline::internal {

[[nodiscard]] inline int threads_of(const Request& request) {
  return request.threads > 0 ? request.threads
                             : static_cast<int>(std::thread::hardware_concurrency());
}

[[nodiscard]] inline StageCounts difference(const StageCounts& a, const StageCounts& b) {
  return {a.by_double - b.by_double, a.by_interval - b.by_interval,
          a.by_exact - b.by_exact};
}

/// Calls step(i) for i = from, ..., to - 1 on several threads, in no order.  Steps must
/// not depend on each other; they may hear_stop().  The stage hears of the share of
/// `count` that is done, and throws Stopped.  Predicates run at the calling thread's
/// precision and are counted there.
template <class Step>
void for_each_of(std::size_t from, std::size_t to, std::size_t count,
                 const Request& request, Stage& stage, Step&& step) {
  constexpr std::size_t kBlock = 256;
  const auto threads = static_cast<std::size_t>(threads_of(request));
  const Precision precision = thread_precision;
  const StageCounts at_first = thread_stage_counts();
  std::atomic<std::size_t> done{from};
  std::mutex adding;
  StageCounts sum = at_first;
  const std::function<bool()> stop = [&] { return stage.stopped(); };
  const auto block = [&](const oneapi::tbb::blocked_range<std::size_t>& range) {
    const PrecisionScope scope(precision);
    const StopScope stop_scope(stop, &stage.name());
    const StageCounts before = thread_stage_counts();
    for (std::size_t i = range.begin(); i < range.end(); ++i) step(i);
    const StageCounts used = difference(thread_stage_counts(), before);
    const std::size_t so_far = done += range.size();
    stage.check(static_cast<double>(so_far) / static_cast<double>(count));
    const std::scoped_lock lock(adding);
    sum.by_double += used.by_double;
    sum.by_interval += used.by_interval;
    sum.by_exact += used.by_exact;
  };
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                    threads);
  oneapi::tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(from, to, kBlock),
                              block, oneapi::tbb::simple_partitioner());
  });
  thread_stage_counts() = sum;  // this thread's own blocks are in it too
}

/// Calls step(worker, i) for i = 0, ..., count - 1 on several threads, with a worker per
/// thread from make(), and consume(i, result) with what it returns: one at a time, in
/// order, soon after, so that results need not be held.  Stops early once the deadline
/// has passed: what is finished by then is consumed, a prefix of all.  A step that asks
/// the deadline itself may break off; one that calls hear_stop() does.  Stops, too, when
/// consume returns false, after which nothing is consumed.  Returns why not all was
/// consumed, or Nothing.  Progress is told under the name of the stage.  At most
/// `in_flight` results are held: where consume is slow, steps wait for it.
template <class Make, class Step, class Consume>
StoppedBy for_each_parallel(std::size_t count, const Request& request,
                            const Deadline& deadline, std::string_view stage,
                            StageCounts& counts, Make&& make, Step&& step,
                            Consume&& consume, std::size_t in_flight = 1024) {
  const int threads = threads_of(request);
  using Worker = decltype(make());
  using Result = decltype(step(*std::declval<Worker&>(), std::size_t{0}));
  struct Item {
    std::size_t number = 0;
    std::optional<Result> result;
    StageCounts counts;
  };
  std::atomic<bool> stopped{false};
  std::size_t next = 0;
  bool cut = false;
  std::size_t consumed = 0;
  StoppedBy by = StoppedBy::Nothing;
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  oneapi::tbb::enumerable_thread_specific<Worker> workers;
  const auto number = [&](oneapi::tbb::flow_control& flow) -> std::size_t {
    if (next >= count || stopped.load(std::memory_order_relaxed)) {
      flow.stop();
      return 0;
    }
    return next++;
  };
  const std::function<bool()> stop = [&] {
    return stopped.load(std::memory_order_relaxed) || deadline.passed();
  };
  // nullopt once it must stop.
  const auto unless_stopped = [&](std::size_t i) -> std::optional<Result> {
    const StopScope scope(stop);
    try {
      hear_stop_now();
      Worker& worker = workers.local();
      if (!worker) worker = make();
      Result result = step(*worker, i);
      hear_stop_now();
      return result;
    } catch (const Stopped&) {
      stopped = true;
      return std::nullopt;
    }
  };
  const auto compute = [&](std::size_t i) {
    const PrecisionScope scope(request.precision);
    const StageCounts at_first = thread_stage_counts();
    auto item = std::make_shared<Item>();
    item->number = i;
    item->result = unless_stopped(i);
    item->counts = difference(thread_stage_counts(), at_first);
    return item;
  };
  const auto deliver = [&](const std::shared_ptr<Item>& item) {
    // Nothing after a gap, so that a partial answer is a prefix.
    cut = cut || !item->result;
    if (!cut) {
      ++consumed;
      if (!consume(item->number, std::move(*item->result))) {
        if (consumed < count) by = StoppedBy::Bytes;
        cut = stopped = true;
      }
    }
    counts.by_double += item->counts.by_double;
    counts.by_interval += item->counts.by_interval;
    counts.by_exact += item->counts.by_exact;
    if (request.progress) {
      const double share = static_cast<double>(item->number + 1) /
                           static_cast<double>(std::max<std::size_t>(1, count));
      request.progress(stage, share);
    }
  };
  arena.execute([&] {
    using oneapi::tbb::filter_mode;
    oneapi::tbb::parallel_pipeline(
        in_flight, oneapi::tbb::make_filter<void, std::size_t>(
                       filter_mode::serial_in_order, number) &
                       oneapi::tbb::make_filter<std::size_t, std::shared_ptr<Item>>(
                           filter_mode::parallel, compute) &
                       oneapi::tbb::make_filter<std::shared_ptr<Item>, void>(
                           filter_mode::serial_in_order, deliver));
  });
  if (consumed == count || by != StoppedBy::Nothing) return by;
  return request.stop.stop_requested() ? StoppedBy::Request : StoppedBy::Seconds;
}

}  // namespace sightline::internal
