#include "viewers/json_text.h"

#include <algorithm>
#include <array>

namespace sightline::viewers {
namespace {

constexpr std::string_view kDigits = "0123456789ABCDEF";
constexpr std::size_t kEscapeLength = 4;  // \xFC

bool is_continuation(unsigned char byte) { return (byte & 0xC0) == 0x80; }

// Bytes of the UTF-8 character that `text` begins with; 0 if it begins with none.  The
// table is that of the Unicode standard, "well-formed UTF-8 byte sequences": no overlong
// forms, no surrogates, nothing above U+10FFFF.
std::size_t character_length(std::string_view text) {
  struct Form {
    unsigned char first_low, first_high, second_low, second_high;
    std::size_t length;
  };
  constexpr std::array<Form, 7> kForms{{{0xC2, 0xDF, 0x80, 0xBF, 2},
                                        {0xE0, 0xE0, 0xA0, 0xBF, 3},
                                        {0xE1, 0xEC, 0x80, 0xBF, 3},
                                        {0xED, 0xED, 0x80, 0x9F, 3},
                                        {0xEE, 0xEF, 0x80, 0xBF, 3},
                                        {0xF0, 0xF0, 0x90, 0xBF, 4},
                                        {0xF1, 0xF4, 0x80, 0xBF, 4}}};
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  for (const Form& form : kForms) {
    if (byte(0) < form.first_low || byte(0) > form.first_high) continue;
    if (text.size() < form.length) return 0;
    const unsigned char second_high = byte(0) == 0xF4 ? 0x8F : form.second_high;
    if (byte(1) < form.second_low || byte(1) > second_high) return 0;
    for (std::size_t i = 2; i < form.length; ++i) {
      if (!is_continuation(byte(i))) return 0;
    }
    return form.length;
  }
  return 0;
}

// Whether `text` begins with an escape as escaped_bytes writes it.
bool begins_with_escape(std::string_view text) {
  return text.size() >= kEscapeLength && text.starts_with("\\x") &&
         kDigits.find(text[2]) != std::string_view::npos &&
         kDigits.find(text[3]) != std::string_view::npos;
}

// Length of the longest beginning of `text` that needs no escape.
std::size_t plain_length(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = character_length(text.substr(at));
    if (length == 0 || begins_with_escape(text.substr(at))) break;
    at += length;
  }
  return at;
}

// Whether a string or key anywhere in the value needs an escape.
bool needs_escape(const Json& value) {
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    return plain_length(text) < text.size();
  }
  if (value.is_object()) {
    return std::any_of(value.items().begin(), value.items().end(), [](const auto& item) {
      return plain_length(item.key()) < item.key().size() || needs_escape(item.value());
    });
  }
  return value.is_array() && std::any_of(value.begin(), value.end(), needs_escape);
}

Json with_escapes(const Json& value) {
  if (value.is_string()) return escaped_bytes(value.get_ref<const std::string&>());
  if (value.is_array()) {
    Json copy = Json::array();
    for (const Json& item : value) copy.push_back(with_escapes(item));
    return copy;
  }
  if (value.is_object()) {
    Json copy = Json::object();
    for (const auto& [key, item] : value.items()) {
      copy[escaped_bytes(key)] = with_escapes(item);
    }
    return copy;
  }
  return value;
}

}  // namespace

std::string json_text(const Json& value, int indent) {
  return needs_escape(value) ? with_escapes(value).dump(indent) : value.dump(indent);
}

// Different bytes give different text, because unescaped_bytes leads back: an escape in
// the text was written as one.  Were it not, its backslash would have been copied, and
// the three characters behind it too, so that it stood in `bytes` as well; but there such
// a backslash is escaped.
std::string escaped_bytes(std::string_view bytes) {
  std::string text;
  for (;;) {
    const std::size_t plain = plain_length(bytes);
    text.append(bytes.substr(0, plain));
    if (plain == bytes.size()) return text;
    const auto byte = static_cast<unsigned char>(bytes[plain]);
    text.append("\\x").append(1, kDigits[byte / 16]).append(1, kDigits[byte % 16]);
    bytes.remove_prefix(plain + 1);
  }
}

std::string unescaped_bytes(std::string_view text) {
  std::string bytes;
  while (!text.empty()) {
    const bool escaped = begins_with_escape(text);
    bytes += escaped
                 ? static_cast<char>(16 * kDigits.find(text[2]) + kDigits.find(text[3]))
                 : text.front();
    text.remove_prefix(escaped ? kEscapeLength : 1);
  }
  return bytes;
}

}  // namespace sightline::viewers
