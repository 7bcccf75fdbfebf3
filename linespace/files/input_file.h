// Files that are read whole, and why they cannot be.

#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace sightline::internal {

/// The name that stands for standard input.
inline constexpr const char* kStandardInput = "-";

/// The file's name in messages.
[[nodiscard]] std::string told_name(const std::string& file);

/// The bytes of a file, or of standard input.  Throws InvalidInput, "FILE: WHY", when
/// there is no such file, it is a folder, it may not or cannot be read, or it has more
/// than `most` bytes.  Hears a stop (work/stop_scope.h) between blocks.
[[nodiscard]] std::string read_whole(
    const std::string& file, std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace sightline::internal
