// Answers as text: valid UTF-8 whatever bytes the names in a file consist of.

#pragma once

#include <string>
#include <string_view>

#include "viewers/answer.h"

namespace sightline::viewers {

/// The text of a JSON value.  Strings and keys in it may hold any bytes: each is written
/// as escaped_bytes gives it.  Indented by `indent` blanks a level; on one line if
/// negative.
[[nodiscard]] std::string json_text(const Json& value, int indent = -1);

/// Valid UTF-8 for any bytes, equal to them where they are valid UTF-8 without `\x`.
/// A byte that is part of no UTF-8 character becomes `\x` and two capital hexadecimal
/// digits ("T\xFCr" for the name Tür in Latin-1), and so does a backslash that would read
/// as the beginning of that.  Two different names stay different.
[[nodiscard]] std::string escaped_bytes(std::string_view bytes);

/// The bytes that escaped_bytes made this text of.
[[nodiscard]] std::string unescaped_bytes(std::string_view text);

}  // namespace sightline::viewers
