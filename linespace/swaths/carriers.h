// The lines that forms are asked of, once per scene: those of edges and of flat sides.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/bvh.h"
#include "linespace/swaths/eee_curve.h"

namespace sightline::internal {

/// Lines of edges and flat sides, once per scene; immutable.
struct Carriers {
  explicit Carriers(const Silhouettes& silhouettes);

  std::vector<Carrier> all;
  std::vector<std::int32_t> of_ridge;
  std::vector<std::int32_t> ridge;  ///< of a carrier, -1 for none
  /// Sides of face f: positions starts[f] to starts[f + 1].
  struct Side {
    std::int32_t carrier;
    bool forward;  ///< the face runs along it from its smaller point id
  };
  std::vector<std::int32_t> starts;
  std::vector<Side> sides;

  [[nodiscard]] std::span<const Side> of_face(int face) const {
    return {sides.data() + starts[face],
            static_cast<std::size_t>(starts[face + 1] - starts[face])};
  }
};

}  // namespace sightline::internal
