// A stage of some work that a caller waits for: it tells how far it is, and breaks off
// when its time is over.

#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

#include "linespace/request.h"
#include "linespace/work/deadline.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

/// Keeps a reference to the request, which must outlive it.  check() may be called from
/// several threads.  While it lives, hear_stop() hears it in the thread that made it.
class Stage {
 public:
  /// The budget counts from now.
  Stage(const Request& request, std::string name);
  /// The budget counts from when the deadline was made.
  Stage(const Request& request, std::string name, const Deadline& deadline);

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
  [[nodiscard]] bool stopped() const { return deadline_.passed(); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  const Request& request_;
  std::string name_;
  const Deadline deadline_;
  std::size_t calls_ = 0;
  std::mutex telling_;
  const std::function<bool()> stop_;
  const StopScope scope_;
};

}  // namespace sightline::internal
