// What blocks a line: contacts in order, free segments, and the faces that meet a
// triangle.
//
// Embree proposes, exact contact tests dispose.  The definitions of contact, blocked,
// grazing and free are those of docs/contacts.md.
// Neighbours: contacts/contact.h decides one contact; space/bvh.h finds faces.

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

namespace internal {
struct OcclusionAccess;
}

/// How a line meets a face at a contact.
enum class TouchKind : std::uint8_t {
  Interior,  ///< crosses the face's relative interior at a point
  Edge,      ///< crosses one of its sides at a point inside that side
  Corner,    ///< passes through one of its corners
  EdgeOn     ///< lies in the face's plane and meets it along a segment
};

/// One face's part in a contact.
struct Touch {
  int face;
  TouchKind kind;
  /// Edge: the side from corner `index` to the next; Corner: that corner's position;
  /// -1 otherwise.
  int index;
};

/// A connected component of a line's intersection with the union of all faces.
struct Contact {
  /// Position along the line, 0 at its first point, 1 at its second, rounded to double;
  /// equal when the contact is a point.
  double from, to;
  /// No nearby line, tilted ones included, passes free near it.
  bool blocked;
  std::vector<Touch> touches;  ///< by face id
};

/// The longest segment through a given one that no contact inside blocks.
struct FreeSegment {
  /// Ends as parameters (0 and 1 at the given points); infinite where nothing blocks.
  double from, to;
  /// Faces touched by the blocking contact at that end; empty means the outside.
  std::vector<int> from_faces, to_faces;
  /// Grazing contacts strictly inside, in order.
  std::vector<Contact> contacts;
};

/// Answers about one scene, to which it keeps a reference.  Immutable once built; every
/// member function is safe to call from several threads.
class OcclusionIndex {
 public:
  /// The request's budget, stop and progress are heard, its other members are not asked.
  /// Throws Stopped when time is over.
  explicit OcclusionIndex(const Scene& scene, const Request& request = {});
  ~OcclusionIndex();
  OcclusionIndex(OcclusionIndex&&) noexcept;

  [[nodiscard]] const Scene& scene() const;

  /// No contact inside the open segment ab blocks.  Contacts at a and b themselves do not
  /// count; a contact that contains a or b and extends into the segment is judged by
  /// its part inside the open segment together with what surrounds that part.
  /// thread_stage_counts() says what decided: double arithmetic, or exact numbers where a
  /// contact may touch a face's boundary or an end.
  [[nodiscard]] bool is_free(const Point& a, const Point& b) const;

  /// All contacts of the closed segment ab, from a to b.
  [[nodiscard]] std::vector<Contact> contacts(const Point& a, const Point& b) const;

  /// The first blocking contact inside the open segment ab, seen from a.
  [[nodiscard]] std::optional<Contact> first_blocker(const Point& a,
                                                     const Point& b) const;

  /// Extends the open segment ab both ways until a contact blocks; nullopt when ab itself
  /// is not free.  Its ends are the doubles nearest to the exact positions.
  /// Cost: about two closest hits, half a microsecond, where doubles are certain that the
  /// line touches nothing but the faces at its ends; exact numbers else, some
  /// microseconds.
  [[nodiscard]] std::optional<FreeSegment> maximal_free_segment(const Point& a,
                                                                const Point& b) const;

  /// Ids of all faces that have a point in common with the closed triangle abc,
  /// ascending.
  [[nodiscard]] std::vector<int> faces_meeting_triangle(const Point& a, const Point& b,
                                                        const Point& c) const;

 private:
  friend struct internal::OcclusionAccess;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
