// When the time that a request gives is over: the one test of budgets and stops.

#pragma once

#include <chrono>
#include <stop_token>

#include "linespace/request.h"

namespace sightline::internal {

/// The budget of a request, running since this was made, and its stop token.
class Deadline {
 public:
  explicit Deadline(const Request& request)
      : budget_seconds_(request.budget_seconds), stop_(request.stop) {}

  /// Since it was made.
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }
  /// The budget is used up, or a stop is requested.
  [[nodiscard]] bool passed() const {
    return stop_.stop_requested() || seconds() >= budget_seconds_;
  }
  /// Throws Stopped, naming the stage, when it has passed.
  void check(const char* stage) const {
    if (passed()) throw Stopped(stage, 0);
  }
  /// The same request with what is left of its budget, for work that counts anew.
  [[nodiscard]] Request what_is_left(Request request) const {
    request.budget_seconds = budget_seconds_ - seconds();
    return request;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  double budget_seconds_;
  std::stop_token stop_;
};

}  // namespace sightline::internal
