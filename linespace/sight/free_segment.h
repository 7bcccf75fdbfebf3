// Which parts of one exact line are free, and where the maximal free segment around its
// positions 0 and 1 ends.

#pragma once

#include <array>
#include <optional>

#include "linespace/contacts/contact.h"
#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

/// The contact meets the closed segment [0, 1] of the line.
[[nodiscard]] bool meets_segment(const LineScan& scan, int contact);

/// The contact blocks the closed segment [0, 1] of the line.  What the contact meets
/// beyond the segment's ends does not count, what it meets at them does: the part judged
/// ends between there and the next instant outside.
[[nodiscard]] bool blocks_segment(const Silhouettes& silhouettes, const LineScan& scan,
                                  int contact);

/// Where a contact blocks the line beyond position `start`, going up or down (`step` 1 or
/// -1): the first instant past which the part from `start` on is blocked; nullopt where
/// the line passes.  Requires that the contact does not block before `start`.
[[nodiscard]] std::optional<Rational> blocked_beyond(const Silhouettes& silhouettes,
                                                     const LineScan& scan, int contact,
                                                     const Rational& start, int step);

/// No contact blocks the closed segment [0, 1] of the line.
[[nodiscard]] bool is_free(const Silhouettes& silhouettes, const LineScan& scan);

/// No contact blocks the open part of the line between its positions 0 and 1.
[[nodiscard]] bool free_between(const Silhouettes& silhouettes, const LineScan& scan);

/// For each end of the closed segment [0, 1]: whether the contact there blocks the
/// segment.  nullopt when the segment is blocked strictly between its ends.
/// A part of the line that runs between two faces of closed objects that touch each other
/// is inside the union, and blocked.
[[nodiscard]] std::optional<std::array<bool, 2>> blocked_ends(
    const Silhouettes& silhouettes, const LineScan& scan);

/// Where the free segment around the middle of [0, 1] stops in a contact that it meets on
/// its way back (step -1) or on (1); nullopt where it passes.
[[nodiscard]] std::optional<Rational> stop_in(const Silhouettes& silhouettes,
                                              const LineScan& scan, int contact,
                                              int step);

/// A contact that a free segment meets, and where the segment stops in it; nullopt where
/// it passes.
struct FreeEnd {
  int contact;
  std::optional<Rational> stop;
};

/// The last contact that the maximal free segment around [0, 1] meets, on the way back
/// (step -1) or on (1), from a contact that it meets.
[[nodiscard]] FreeEnd last_contact(const Silhouettes& silhouettes, const LineScan& scan,
                                   int contact, int step);

}  // namespace sightline::internal
