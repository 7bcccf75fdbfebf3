// What one edge sees: from where no line can touch it, what hides others from it, and
// which faces are on the way to a group of them.  In bounded doubles: what is left out is
// proved to be.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "skeleton/generators_internal.h"
#include "skeleton/occluders_internal.h"
#include "skeleton/shaft_internal.h"

namespace sightline::internal {

/// From behind both planes of a ridge's wedge, from in front of both: some line touches
/// the edge.
[[nodiscard]] std::array<bool, 2> touched_on(const Ridge& ridge);

/// Keeps scratch, so one per thread.
class EdgeView {
 public:
  explicit EdgeView(const Generators& generators);

  /// Looks from this ridge on.
  void begin(int ridge);
  /// Looks at a group of edges: those inside the box.
  void look_at(const Box& group);

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] const Point& end(int k) const { return ends_[k]; }

  /// No point of the box is on a line that touches the edge.
  [[nodiscard]] bool never_touched_from(const Box& box) const;
  /// What hides from the whole edge.
  [[nodiscard]] Occluders& occluders() { return occluders_; }

  /// Replaces `faces` by those whose boxes may meet the hull of the edge and one of the
  /// group.
  void faces_between(const Shaft& hull, std::vector<std::int32_t>& faces);

 private:
  void list_faces();

  const Generators& g_;
  std::array<Point, 2> ends_;
  Box box_;
  std::array<BoundedPlane, 2> wedge_;
  std::array<bool, 2> touched_on_{};

  Occluders occluders_;

  // The faces between the edge and the group, listed when they are asked for.
  struct Listed {
    Box box;
    std::int32_t face;
  };
  Box group_;
  bool listed_ = false, too_many_ = false;
  std::vector<Listed> list_;
};

}  // namespace sightline::internal
