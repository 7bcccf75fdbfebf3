#include "linespace/work/stage.h"

#include <utility>

namespace sightline {

Stopped::Stopped(std::string stage, double share)
    : std::runtime_error(stage + ": stopped before it was done"),
      stage_(std::move(stage)),
      share_(share) {}

namespace internal {

Stage::Stage(const Request& request, std::string name)
    : Stage(request, std::move(name), Deadline(request)) {}

Stage::Stage(const Request& request, std::string name, const Deadline& deadline)
    : request_(request),
      name_(std::move(name)),
      deadline_(deadline),
      stop_([this] { return deadline_.passed(); }),
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
  if (stopped()) throw Stopped(name_, share);
  if (!request_.progress) return;
  const std::scoped_lock lock(telling_);
  request_.progress(name_, share);
}

}  // namespace internal
}  // namespace sightline
