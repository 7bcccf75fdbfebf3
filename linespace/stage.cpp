#include <utility>

#include "linespace/stage_internal.h"

namespace sightline {

Stopped::Stopped(std::string stage, double share)
    : std::runtime_error(stage + ": stopped before it was done"),
      stage_(std::move(stage)),
      share_(share) {}

namespace internal {

Stage::Stage(const Request& request, std::string name, Clock::time_point start)
    : request_(request),
      name_(std::move(name)),
      start_(start),
      stop_([this] { return must_stop(request_, start_); }),
      scope_(stop_, &name_) {
  check(0);
}

void hear_stop_now() {
  if (!StopScope::stopped()) return;
  const StopScope* named = StopScope::innermost_;
  while (named != nullptr && named->stage_ == nullptr) named = named->outer_;
  throw Stopped(named != nullptr ? *named->stage_ : "a step", 0);
}

void Stage::begin(std::string name) {
  name_ = std::move(name);
  check(0);
}

void Stage::check(double share) {
  if (must_stop(request_, start_)) throw Stopped(name_, share);
  if (!request_.progress) return;
  const std::scoped_lock lock(telling_);
  request_.progress(name_, share);
}

}  // namespace internal
}  // namespace sightline
