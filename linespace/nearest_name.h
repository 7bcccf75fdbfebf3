// Which name somebody may have meant.

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sightline {

/// How many characters have to be put in, left out, changed, or swapped with their
/// neighbour to get from a to b (optimal string alignment); upper and lower case are the
/// same.  Bytes count as characters.  Cost: the product of the lengths.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name nearest to `wrong` by edit_distance, the first of several; nullopt when each
/// is farther than a third of the longer length, rounded up: then it would be a guess.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view wrong,
                                                      std::span<const std::string> names);

/// "; did you mean 'NAME'?" of the nearest one, or nothing: for the end of a message.
[[nodiscard]] std::string did_you_mean(std::string_view wrong,
                                       std::span<const std::string> names);

}  // namespace sightline
