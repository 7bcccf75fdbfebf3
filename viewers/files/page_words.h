// Pieces of HTML that sections of the page share.

#pragma once

#include <cstdint>
#include <string>

#include "viewers/page.h"

namespace sightline::viewers {

/// 12345678 -> "12 345 678", with thin spaces.
[[nodiscard]] std::string grouped(std::int64_t n);

/// A number and what it counts.
[[nodiscard]] std::string card(const std::string& number, const std::string& what);

/// A cell with a bar of that share of its width.
[[nodiscard]] std::string bar(double fraction, const std::string& colour);

/// The picture, inlined, with title and caption.
[[nodiscard]] std::string figure(const PagePicture& picture);

}  // namespace sightline::viewers
