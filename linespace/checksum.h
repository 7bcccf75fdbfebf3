// A number for a file or a scene that tells whether it is still the same one.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace sightline {

/// 128 bits of a sequence of bytes.  Any change within eight bytes that follow each other
/// at a multiple of eight changes it; other changes keep it by chance only, one in 2^128.
/// It guards against accidents, not against forgery.
class Checksum {
 public:
  /// Appends bytes; how they are cut into calls makes no difference.
  void add(std::string_view bytes);
  /// Appends the eight bytes of a number, lowest first.
  void add(std::uint64_t number);
  void add(double number);

  /// 32 hexadecimal digits for what was added so far.
  [[nodiscard]] std::string text() const;

 private:
  void mix(std::uint64_t word);

  std::array<std::uint64_t, 2> state_ = {0x243F6A8885A308D3u, 0x13198A2E03707344u};
  std::uint64_t pending_ = 0;  // bytes that make no word yet, lowest first
  std::uint64_t count_ = 0;    // bytes added
};

}  // namespace sightline
