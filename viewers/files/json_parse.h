// Parsing JSON so that a stop is heard on the way.

#pragma once

#include <cstddef>
#include <iterator>
#include <string_view>

#include "linespace/work/stop_scope.h"

namespace sightline::viewers {

/// Walks over characters and hears a stop (linespace/work/stop_scope.h).
class HeardText {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  explicit HeardText(const char* at) : at_(at) {}
  const char& operator*() const { return *at_; }
  HeardText& operator++() {
    internal::hear_stop();
    ++at_;
    return *this;
  }
  bool operator==(const HeardText& other) const { return at_ == other.at_; }

 private:
  const char* at_;
};

/// The value that the text says, as one of nlohmann's types.  Throws nlohmann's
/// exceptions, and Stopped.
template <class Value>
[[nodiscard]] Value parse_json(std::string_view text) {
  return Value::parse(HeardText(text.data()), HeardText(text.data() + text.size()));
}

}  // namespace sightline::viewers
