#include "linespace/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace sightline {
namespace {

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) ==
         std::tolower(static_cast<unsigned char>(b));
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Row i holds the distances from the first i characters of a to all beginnings of b.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = same_letter(a[i - 1], b[j - 1]) ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) &&
          same_letter(a[i - 2], b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest_name(std::string_view wrong,
                                        std::span<const std::string> names) {
  constexpr std::size_t kLongest = 200;  // a longer one is no slip of a finger
  if (wrong.size() > kLongest) return std::nullopt;
  const std::string* best = nullptr;
  std::size_t least = 0;
  for (const std::string& name : names) {
    const std::size_t longer = std::max(wrong.size(), name.size());
    const std::size_t allowed = (longer + 2) / 3;
    const std::size_t shorter = std::min(wrong.size(), name.size());
    if (longer - shorter > allowed) continue;
    const std::size_t distance = edit_distance(wrong, name);
    if (distance > allowed || (best != nullptr && distance >= least)) continue;
    best = &name;
    least = distance;
  }
  return best == nullptr ? std::nullopt : std::optional(*best);
}

std::string did_you_mean(std::string_view wrong, std::span<const std::string> names) {
  const std::optional<std::string> near = nearest_name(wrong, names);
  return near ? "; did you mean '" + *near + "'?" : "";
}

}  // namespace sightline
