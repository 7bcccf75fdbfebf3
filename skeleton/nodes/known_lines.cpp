#include "skeleton/nodes/known_lines.h"

#include <algorithm>

namespace sightline::internal {
namespace {

// Bounds the memory, to some megabytes.
constexpr std::size_t kMostLines = 1 << 14;

}  // namespace

const NodeContacts* KnownLines::find(const std::array<ExactPoint, 2>& line) {
  name_ = name_of_line(line);
  axis_ = 0;
  while (line[0][axis_] == line[1][axis_]) ++axis_;
  at_ = {line[0][axis_], line[1][axis_]};
  const auto found = parts_.find(name_);
  if (found == parts_.end()) return nullptr;
  for (const Part& part : found->second) {
    const auto inside = [&](const Rational& x) { return part.from <= x && x <= part.to; };
    if (inside(at_[0]) && inside(at_[1])) return &part.contacts;
  }
  return nullptr;
}

void KnownLines::keep(const NodeContacts& contacts) {
  if (!contacts.free_part) return;
  if (parts_.size() >= kMostLines) parts_.clear();
  const auto coordinate = [&](const Rational& t) {
    return Rational(at_[0] + t * (at_[1] - at_[0]));
  };
  Part part{coordinate((*contacts.free_part)[0]), coordinate((*contacts.free_part)[1]),
            contacts};
  if (part.to < part.from) std::swap(part.from, part.to);
  parts_[name_].push_back(std::move(part));
}

}  // namespace sightline::internal
