// What an option's value may be, said in words when it is not.

#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace sightline::viewers {

/// The finite numbers of a text with commas between them; empty when one of them is none.
[[nodiscard]] std::vector<double> numbers_of(std::string_view text);

/// Refuses all but finite numbers above 0 (from 0 on), at most `most`.
[[nodiscard]] CLI::Validator number_above_zero(
    double most = std::numeric_limits<double>::max());
[[nodiscard]] CLI::Validator number_from_zero(
    double most = std::numeric_limits<double>::max());
/// Refuses all but finite numbers.
[[nodiscard]] CLI::Validator finite_number();
/// Refuses all but whole numbers from least to most.
[[nodiscard]] CLI::Validator whole_number(
    std::uint64_t least, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
/// Refuses all but these words, and suggests the nearest.
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);

/// Why a command line was refused, as one line without CLI11's wording: an unknown
/// command or option suggests the nearest of those that `app` has.
[[nodiscard]] std::string told(const CLI::App& app, const CLI::ParseError& error);

}  // namespace sightline::viewers
