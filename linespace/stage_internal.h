// A stage of some work that a caller waits for: it tells how far it is, and breaks off
// when its time is over.

#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

#include "linespace/request.h"
#include "linespace/stop_scope_internal.h"

namespace sightline::internal {

/// The request's budget, counted from `start`, has ended, or a stop is requested.
[[nodiscard]] inline bool must_stop(const Request& request,
                                    std::chrono::steady_clock::time_point start) {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return request.stop.stop_requested() || elapsed.count() > request.budget_seconds;
}

/// The same request with what is left of its budget, counted from now.
[[nodiscard]] inline Request what_is_left(Request request,
                                          std::chrono::steady_clock::time_point start) {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  request.budget_seconds -= elapsed.count();
  return request;
}

/// Keeps a reference to the request, which must outlive it.  check() may be called from
/// several threads.  While it lives, hear_stop() hears it in the thread that made it.
class Stage {
 public:
  using Clock = std::chrono::steady_clock;

  /// The budget counts from `start`.
  explicit Stage(const Request& request, std::string name,
                 Clock::time_point start = Clock::now());

  /// The same work goes on with its next stage.  Throws Stopped.
  void begin(std::string name);
  /// Step number `step` of `count` steps begins.  Called in loops whose steps take
  /// microseconds: looks at the clock once in 64 calls.  Throws Stopped.
  void at(std::size_t step, std::size_t count) {
    if ((++calls_ & 63) == 0) {
      check(static_cast<double>(step) / static_cast<double>(count));
    }
  }
  /// This share of the stage, in [0, 1], is done.  Throws Stopped.
  void check(double share);
  /// Its time is over.
  [[nodiscard]] bool stopped() const { return must_stop(request_, start_); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  const Request& request_;
  std::string name_;
  Clock::time_point start_;
  std::size_t calls_ = 0;
  std::mutex telling_;
  const std::function<bool()> stop_;
  const StopScope scope_;
};

}  // namespace sightline::internal
