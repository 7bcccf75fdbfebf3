// Lines through a sequence of convex openings: is there one, and which are the extremal
// ones that bound the set of all (the antipenumbra of the first opening).
//
// A *portal* is a closed convex polygon: boundary included.  A line *stabs* a sequence
// when, in one of its two directions, it meets every portal, each at or before the next.
// So the set of stabbing lines is compact.  docs/portals.md has the definitions, the
// proof that the search finds everything, and the degenerate cases one by one.
//
// Source: S. Teller, "Computing the Antipenumbra of an Area Light Source", SIGGRAPH 1992.
// We depart from it in that nothing is computed in five dimensions: the extremal lines
// are followed along the one-parameter families that join them.

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "linespace/request.h"

namespace sightline {

namespace internal {
struct PortalState;
struct PlanesState;
}  // namespace internal

/// What an extremal stabbing line is held by.  A contact is a *point* of the line at
/// which it touches the boundary of portals: V where it cannot leave the point (a corner
/// of a portal, or a crossing of two portals' edges), E where it can slide (along an
/// edge, or edges of several portals that lie on one line).
enum class StabbingKind {
  VV,
  VEE,  ///< the V is first or last
  EVE,  ///< the V is in the middle
  EEEE,
  InPlane,     ///< lies in the plane of a portal, or along a slit; held there
  Degenerate,  ///< has more contacts than four degrees of freedom need
};
inline constexpr std::size_t kStabbingKinds = 6;
/// "VV", "VEE", "EVE", "EEEE", "in_plane", "degenerate".
[[nodiscard]] std::string_view name(StabbingKind kind);

/// A part of a portal's boundary, or its plane.  Corners are numbered as given; edge i
/// begins at corner i.
struct PortalGenerator {
  enum class Kind { Vertex, Edge, Plane };
  Kind kind;
  int portal;
  int index;  ///< 0 for a plane
  friend auto operator<=>(const PortalGenerator&, const PortalGenerator&) = default;
};

/// One point of a stabbing line that touches portals.
struct StabbingContact {
  std::vector<PortalGenerator> generators;  ///< sorted; no planes
  bool fixed;                               ///< V; otherwise E
  Eigen::Vector3d at;                       ///< rounded
};

struct ExtremalStabbingLine {
  StabbingKind kind;
  std::vector<StabbingContact> contacts;   ///< in order from the first portal to the last
  std::vector<int> planes;                 ///< portals in whose planes the line lies
  std::array<Eigen::Vector3d, 2> segment;  ///< from first to last portal, rounded
};

/// A stabbing line by two of its points, exact.  Where doubles do not suffice the points
/// are rational, written "p/q".
struct StabbingWitness {
  std::array<Eigen::Vector3d, 2> points;  ///< rounded if `exact_in_doubles` is false
  bool exact_in_doubles;
  std::array<std::array<std::string, 3>, 2> rational;
  /// It passes through the interiors of all portals and lies in no portal's plane, so
  /// that all lines close to it stab too.
  bool interior;
};

/// Whether the stabbing lines have room to move in all four directions.
enum class StabbingRoom {
  None,       ///< there are no stabbing lines
  Open,       ///< some line passes through all interiors; proved
  Thin,       ///< every portal is met, but no line passes through all interiors; proved
  Undecided,  ///< neither proof was found (docs/portals.md says when that can be)
};

/// One-parameter families of stabbing lines (EV or EEE) between two extremal ones: what
/// bounds the antipenumbra.
struct StabbingSwath {
  std::vector<PortalGenerator> generators;  ///< of the fixed point, then of the edges
  bool has_vertex;                          ///< EV; otherwise EEE
  Eigen::Vector3d vertex;                   ///< of an EV: the fixed point, rounded
  std::array<int, 2> lines;                 ///< positions in extremal_lines()
  /// Lines of the family from one end to the other, from first to last portal, rounded.
  std::vector<std::array<Eigen::Vector3d, 2>> rungs;
};

struct PortalStatistics {
  std::size_t candidates = 0;  ///< lines constructed by the last push
  std::size_t repeated = 0;    ///< candidates that were extremal lines known already
  std::size_t kept = 0;        ///< extremal lines that outlived it
  std::size_t found = 0;       ///< extremal lines that it added
};

/// A sequence of portals that grows at its end, with its extremal stabbing lines.
/// Not safe to share between threads while it grows.
class PortalSequence {
 public:
  PortalSequence();
  ~PortalSequence();
  PortalSequence(const PortalSequence& other);
  PortalSequence& operator=(const PortalSequence& other);
  PortalSequence(PortalSequence&&) noexcept;
  PortalSequence& operator=(PortalSequence&&) noexcept;

  /// Appends a portal, given by its corners in order, either way round.  Only lines that
  /// touch the new portal are searched for; the result is that of a sequence built from
  /// nothing.  Corners that repeat, and corners inside a straight edge, are ignored; what
  /// is left may be a slit (two corners) or a point.  A polygon of four or more corners
  /// may be out of plane by rounding: the line must then pass all edges on one side.
  /// Throws InvalidInput when a coordinate is not admissible, there is no corner, or the
  /// polygon is not convex, and leaves the sequence as it was.
  /// False when the request's budget or stop token ended the search, within milliseconds
  /// or, for huge coordinates, tens of them: then too the sequence is as it was.
  /// Cost: docs/portals.md.
  bool push(std::span<const Eigen::Vector3d> corners, const Request& request = {});

  [[nodiscard]] std::size_t size() const;
  /// Whether some line stabs the sequence; true of the empty one.
  [[nodiscard]] bool stabbable() const;
  /// In an order that depends on the portals only.  A line that several sets of
  /// generators fix is listed once: lines are compared exactly.  Empty also when all
  /// portals are one and the same point: every line through it stabs and none is
  /// extremal.
  [[nodiscard]] const std::vector<ExtremalStabbingLine>& extremal_lines() const;
  /// Some stabbing line, through all interiors if one is found; nullopt when there is
  /// none (or no portal), and when all extremal ones are irrational and none was found
  /// beside.  When the request ends the search, an extremal one.
  [[nodiscard]] std::optional<StabbingWitness> witness(const Request& request = {}) const;
  /// Undecided also when the request ends the search.
  [[nodiscard]] StabbingRoom room(const Request& request = {}) const;
  /// The EV and EEE families that join extremal lines; `rungs` lines for each.  A family
  /// that several edges of one plane or of one line hold is told once.  When the request
  /// ends the search, those found so far.
  [[nodiscard]] std::vector<StabbingSwath> swaths(int rungs = 9,
                                                  const Request& request = {}) const;
  /// Portals that are not exactly planar.
  [[nodiscard]] std::vector<int> out_of_plane() const;
  [[nodiscard]] const PortalStatistics& last_push() const;

 private:
  std::unique_ptr<internal::PortalState> state_;
};

/// The conservative version: a line that has passed portals i and then j stays behind
/// every plane that separates the two, so a later portal that lies before such a plane as
/// a whole cannot be reached.  Never refuses a sequence that is stabbable, may accept one
/// that is not (Teller 1992; exact signs here too, so that only the method errs).
class SeparatingPlanesSequence {
 public:
  SeparatingPlanesSequence();
  ~SeparatingPlanesSequence();
  SeparatingPlanesSequence(SeparatingPlanesSequence&&) noexcept;
  SeparatingPlanesSequence& operator=(SeparatingPlanesSequence&&) noexcept;

  /// As PortalSequence::push.
  void push(std::span<const Eigen::Vector3d> corners);
  [[nodiscard]] std::size_t size() const;
  /// False only if no line stabs.
  [[nodiscard]] bool maybe_stabbable() const;

 private:
  std::unique_ptr<internal::PlanesState> state_;
};

}  // namespace sightline
