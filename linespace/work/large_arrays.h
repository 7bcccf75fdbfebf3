// Arrays that grow to gigabytes, in large pages where the system gives them on request:
// skeletons are filled once and joined at random places, so that much of the time of the
// largest would go to page faults and address translation.

#pragma once

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sightline::internal {

/// A hint for memory that is not in use yet; none for less than a few large pages.
inline void prefer_large_pages([[maybe_unused]] void* memory,
                               [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t kLargePage = std::uintptr_t{1} << 21;
  if (bytes < 4 * kLargePage) return;
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + kLargePage - 1) / kLargePage * kLargePage;
  const std::uintptr_t end = (begin + bytes) / kLargePage * kLargePage;
  madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

/// Makes room for `more` elements at the end, as appending them would.
template <class T>
void make_room(std::vector<T>& array, std::size_t more) {
  if (array.capacity() - array.size() >= more) return;
  std::vector<T> larger;
  larger.reserve(std::max(2 * array.capacity(), array.size() + more));
  prefer_large_pages(larger.data(), larger.capacity() * sizeof(T));
  larger.assign(array.begin(), array.end());
  array.swap(larger);
}

}  // namespace sightline::internal
