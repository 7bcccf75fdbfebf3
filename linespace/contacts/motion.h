// The search for a motion that passes all obstacles.

#pragma once

#include <span>
#include <vector>

#include "linespace/contacts/obstacles.h"

namespace sightline::internal::contacts {

/// Whether some w passes all obstacles, once no constant w does.  `sectors` by instant,
/// `fins` by direction; `rays` are those that matter: of two that have one direction,
/// one.
[[nodiscard]] bool some_motion_passes(std::vector<Rational> instants,
                                      std::span<const SectorAt> sectors,
                                      std::span<const std::vector<const Fin*>> fins,
                                      std::span<const Ray* const> rays,
                                      const CornerTimes& corner_time);

}  // namespace sightline::internal::contacts
