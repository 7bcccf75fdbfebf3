// What is fuzzed: every reader, and every JSON question, up to where computing begins.

#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sightline::fuzz {

struct Function {
  const char* name;  ///< also of its folder in corpus/
  /// Reads the bytes.  Bad input is refused inside; whatever else is thrown is a finding.
  void (*run)(const std::string& bytes);
};

[[nodiscard]] std::span<const Function> functions();

}  // namespace sightline::fuzz
