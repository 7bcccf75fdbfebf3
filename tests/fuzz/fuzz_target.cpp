// One libFuzzer program: SIGHTLINE_FUZZ_NAME says which of the functions.

#include <cstdint>
#include <cstring>

#include "fuzz_functions.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto* const function = [] {
    for (const auto& f : sightline::fuzz::functions()) {
      if (std::strcmp(f.name, SIGHTLINE_FUZZ_NAME) == 0) return &f;
    }
    __builtin_trap();
  }();
  function->run(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
