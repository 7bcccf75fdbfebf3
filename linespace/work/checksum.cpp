#include "linespace/checksum.h"

#include <bit>
#include <iomanip>
#include <sstream>

namespace sightline {
namespace {

// Odd factors, so that multiplying by them can be undone: states that differ stay
// different.  The digits are those of the golden ratio and of pi.
constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15u;
constexpr std::uint64_t kPi = 0xA4093822299F31D1u;

std::uint64_t scattered(std::uint64_t x) {
  x = (x ^ (x >> 32)) * kGolden;
  x = (x ^ (x >> 29)) * kPi;
  return x ^ (x >> 32);
}

}  // namespace

void Checksum::mix(std::uint64_t word) {
  state_[0] = std::rotl((state_[0] ^ word) * kGolden, 29) + 1;
  state_[1] = std::rotl((state_[1] ^ scattered(word)) * kPi, 31) + 1;
}

void Checksum::add(std::string_view bytes) {
  for (const char c : bytes) {
    pending_ |= std::uint64_t{static_cast<unsigned char>(c)} << (8 * (count_ % 8));
    if (++count_ % 8 != 0) continue;
    mix(pending_);
    pending_ = 0;
  }
}

void Checksum::add(std::uint64_t number) {
  std::array<char, 8> bytes{};
  for (char& byte : bytes) {
    byte = static_cast<char>(number & 255);
    number >>= 8;
  }
  add(std::string_view(bytes.data(), bytes.size()));
}

void Checksum::add(double number) {
  add(std::bit_cast<std::uint64_t>(number + 0.0));  // -0 is 0
}

std::string Checksum::text() const {
  Checksum end = *this;
  end.mix(pending_);
  end.mix(count_);
  const std::uint64_t a = scattered(end.state_[0] ^ std::rotl(end.state_[1], 17));
  std::ostringstream out;
  out << std::hex << std::setfill('0') << std::setw(16) << a << std::setw(16)
      << scattered(end.state_[1] + a);
  return out.str();
}

}  // namespace sightline
