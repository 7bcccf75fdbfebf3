// What one edge sees: which groups of other edges no line through it can touch or reach,
// by its own wedge or behind one convex occluder, and which faces are on the way.
// In bounded doubles: what is left out is proved to be.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "skeleton/generators_internal.h"
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
  /// One convex occluder that has hidden something lately stands before all of the box,
  /// seen from the whole edge.
  [[nodiscard]] bool hidden(const Box& box);
  /// The same of the segment q0 q1.
  [[nodiscard]] bool hidden(const Point& q0, const Point& q1) const;
  /// The same by any occluder that some of these faces belong to.
  [[nodiscard]] bool hidden_by_one_of(const std::vector<std::int32_t>& faces,
                                      const Point& q0, const Point& q1);

  /// Replaces `faces` by those whose boxes may meet the hull of the edge and one of the
  /// group.
  void faces_between(const Shaft& hull, std::vector<std::int32_t>& faces);

  /// An occluder to try first.
  void remember(int face);

 private:
  using Shadows = std::array<Shadow, 2>;  // from both ends

  [[nodiscard]] int shadow_of(int face);
  void keep(int shadow);
  [[nodiscard]] std::array<double, 3> relative(const std::array<double, 3>& p,
                                               int end) const;
  [[nodiscard]] bool hides(const Shadows& shadows, const Box& box) const;
  [[nodiscard]] bool hides(const Shadows& shadows, const Point& q0,
                           const Point& q1) const;
  void list_faces();

  const Generators& g_;
  int ridge_ = -1;
  std::array<Point, 2> ends_;
  Box box_;
  std::array<BoundedPlane, 2> wedge_;
  std::array<bool, 2> touched_on_{};

  std::vector<std::uint32_t> facet_stamp_;  // of the edge's own facets
  std::uint32_t stamp_ = 0;
  std::vector<Shadows> shadows_;
  std::vector<std::int32_t> shadow_index_;  // by occluder, -2 unknown, -1 none
  std::vector<std::int64_t> shadow_keys_;   // to reset
  std::vector<std::int32_t> recent_;        // those that hid something last come first

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
