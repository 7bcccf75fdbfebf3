// A stage for internal functions that want one, where nobody waits or stops.

#pragma once

#include "linespace/work/stage.h"

namespace sightline::test {

class Unhurried {
 public:
  /// For the call that it is an argument of.
  operator internal::Stage&() { return stage_; }  // NOLINT: to be passed as one

 private:
  Request request_;
  internal::Stage stage_{request_, "test"};
};

}  // namespace sightline::test
