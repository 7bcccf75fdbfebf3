#include "linespace/view/possibly_seen.h"

namespace sightline::internal {

std::vector<std::uint8_t> possibly_seen(const EyeSpace& eye) {
  return std::vector<std::uint8_t>(eye.scene().scene().faces().size(), 1);
}

}  // namespace sightline::internal
