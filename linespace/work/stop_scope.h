// How loops far below a caller hear that it wants no more of them.
//
// A budget or a stop belongs to a request, and a request is known to few functions.
// Those few open a scope; what they call, however deep, asks hear_stop().  As the
// precision and the counts of the predicates are, the scopes are the thread's own.

#pragma once

#include <functional>
#include <string>

#include "linespace/request.h"

namespace sightline::internal {

/// While it lives, hear_stop() in the thread that made it throws Stopped once stop() is
/// true.  Scopes nest, first in, last out; a stop of any of them counts.
class StopScope {
 public:
  /// Keeps references to `stop`, which may be empty (then it never stops), and to the
  /// name of the stage, for what is thrown.
  explicit StopScope(const std::function<bool()>& stop,
                     const std::string* stage = nullptr)
      : stop_(stop), stage_(stage), outer_(innermost_) {
    innermost_ = this;
  }
  ~StopScope() { innermost_ = outer_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  /// Some scope of this thread wants to stop.
  [[nodiscard]] static bool stopped() {
    for (const StopScope* scope = innermost_; scope != nullptr; scope = scope->outer_) {
      if (scope->stop_ && scope->stop_()) return true;
    }
    return false;
  }

 private:
  friend void hear_stop_now();
  const std::function<bool()>& stop_;
  const std::string* stage_;
  const StopScope* outer_;
  static inline constinit thread_local const StopScope* innermost_ = nullptr;
};

inline constinit thread_local unsigned steps_before_stop = 0;

/// Called before a step that may take ten microseconds or more.
void hear_stop_now();

/// Called in loops whose steps take microseconds at most: asks once in 64 calls.
inline void hear_stop() {
  if ((++steps_before_stop & 63) == 0) hear_stop_now();
}

}  // namespace sightline::internal
