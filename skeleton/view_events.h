// The visual events that a moving viewpoint meets: which arcs of a skeleton, and planes
// of facets, a segment crosses, in order.
//
// An arc is crossed at the viewpoint x when x lies on a line of the arc, on its maximal
// free segment and beyond one of the outer contacts: there the generators appear in line,
// and the view changes.  A facet is crossed where x lies in its plane, outside it, and
// sees it edge-on: there it turns its front towards x or away.

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "skeleton/end_index.h"
#include "skeleton/graph.h"

namespace sightline {

enum class EventKind : std::uint8_t { EV, EEE, F };

/// Where a path crosses an event.
struct ViewEvent {
  EventKind kind;
  std::uint32_t id;  ///< position in Skeleton::arcs; F: facet id
  /// EV, EEE: the viewpoint is before the first contact (0: it sees the vertex, or the
  /// first edge, nearest) or beyond the last (1).  F: 0.
  std::uint8_t side = 0;
  /// Met in the same point of the path as the one listed before.
  bool tie = false;
  double u = 0;  ///< parameter on the path, rounded
  Point point;   ///< the viewpoint, rounded
  friend bool operator==(const ViewEvent&, const ViewEvent&) = default;
};

/// Immutable; safe to share between threads; keeps references to all it is given, which
/// must belong together.
class ViewEvents {
 public:
  ViewEvents(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends,
             const Request& request = {});
  ~ViewEvents();
  ViewEvents(ViewEvents&&) noexcept;

  /// All events that the open segment from a to b crosses, in order; ties by kind and id.
  /// A segment that only touches an event's plane or surface, lies in it, or passes
  /// through a generator or through the facet itself does not cross it.  A line that ends
  /// on the viewpoint itself (which then lies on a face) is met.
  ///
  /// Every crossing is decided by exact signs on the input, and so is the order; the
  /// ranges and pieces of arcs, which are rounded, only where they are certain.  Arcs of
  /// one pair or triple of generators that are closer than 2^-39 of the edge are not told
  /// apart.  A facet is seen edge-on where an open piece of its sides is: what touches
  /// its plane from one side, or lies in it, does not hide it, and single points between
  /// two that touch do not show it.  A facet that is flat only by tolerance counts with
  /// the plane of its first face.
  ///
  /// Throws InvalidInput when a coordinate is not admissible or a == b.  Cost: 25
  /// nanoseconds a facet, some 200 an arc near the path, and 1 (EV) to 100 (EEE, F)
  /// microseconds an event.  The first call builds an index of all arcs by space, on all
  /// cores: about two microseconds and 130 bytes an arc.
  [[nodiscard]] std::vector<ViewEvent> crossed(const Point& a, const Point& b) const;
  /// The events among the arcs with these numbers, in order; no facets.  Asks each of the
  /// arcs, and needs no index.
  [[nodiscard]] std::vector<ViewEvent> crossed(const Point& a, const Point& b,
                                               std::span<const std::uint32_t> arcs) const;

  /// Bytes of the index of arcs, which this builds if need be.
  [[nodiscard]] std::size_t index_bytes() const;

  /// The events that separate two viewpoints: those that the segment between them crosses
  /// an odd number of times, each with its first crossing, in order.  EV and F events are
  /// crossed at most once by a segment, EEE events, which are curved, at most twice.  So
  /// these are the events that lie between the two views; one crossed twice is undone on
  /// the way.
  [[nodiscard]] std::vector<ViewEvent> separating(const Point& a, const Point& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
