// Numbers of the environment, for runs of another size than a test's own.

#pragma once

#include <cstdlib>

namespace sightline::testing {

/// The variable's value; `otherwise` where it is not set.
[[nodiscard]] inline int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

}  // namespace sightline::testing
