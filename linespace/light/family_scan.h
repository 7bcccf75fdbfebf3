// Which lines of a family reach a source on one side and a receiver on the other, with
// nothing between: found at one exact line between any two positions where that can
// change.

#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "linespace/light/family_region.h"
#include "linespace/light/light_space.h"
#include "linespace/light/line_family.h"
#include "linespace/light/source_patches.h"

namespace sightline::internal {

/// Where a line of a family touches a generator.
struct FamilyContact {
  enum class At : std::uint8_t { First, Last, OnEdge };
  At at;
  /// OnEdge: the segment, and its ends each joined to a point beside it: lines of the
  /// family meet the segment where they pass the two joins on different sides.
  const LightLine* edge = nullptr;
  std::array<const LightLine*, 2> joins{};
  /// The edge that the contact moves on, for faces that it passes through; may be null.
  const LightEdge* moves_on = nullptr;
};

struct ScannedPiece {
  int face;
  bool front;
  FamilyCut from, to;
};

/// Scans families of one patch of a source; keeps scratch, one for a thread.
class FamilyScan {
 public:
  FamilyScan(const LightSpace& space, const SourcePatch& patch,
             std::span<const LightLine> sides, std::span<const std::uint8_t> in_front,
             std::span<const std::uint8_t> front_wanted,
             std::span<const std::uint8_t> back_wanted)
      : space_(space),
        patch_(patch),
        sides_(sides),
        in_front_(in_front),
        front_wanted_(front_wanted),
        back_wanted_(back_wanted) {}

  /// `farthest`: position among the contacts of one that must be the farthest from the
  /// source along the line; -1: any may.  `plane`: that all lines lie in, or null.  The
  /// pieces are in order along the family.
  const std::vector<ScannedPiece>& scan(const LineFamily& family,
                                        std::span<const FamilyContact> contacts,
                                        int farthest, const Four<Approx>* plane);
  /// Asked of a family that is one line: it reaches the source past all contacts, and the
  /// inside of no face is in its way.
  [[nodiscard]] bool reaches_freely(const LineFamily& family,
                                    std::span<const FamilyContact> contacts);
  /// What the last scan found.
  [[nodiscard]] std::span<const ScannedPiece> pieces() const { return pieces_; }

 private:
  struct Interval {
    FamilyCut from, to;
  };
  // A position along a line, as the height above the source's plane.
  struct Height {
    Approx num, den;
    int face = -1, contact = -1;
  };

  void find_lit(const LineFamily& family, std::span<const FamilyContact> contacts,
                int farthest);
  void sort_cuts(const LineFamily& family);
  // A position strictly between two cuts, a < b.
  [[nodiscard]] static Ring between(const LineFamily& family, FamilyCut& a, FamilyCut& b);
  [[nodiscard]] bool reaches_source(const FamilyLine& line,
                                    std::span<const FamilyContact> contacts,
                                    int farthest);
  [[nodiscard]] bool on_source(const FamilyLine& line) const;
  void find_near(const FamilyRegion& region);
  void find_candidates(const LineFamily& family, const Four<Approx>* plane);
  void add_face_cuts(const LineFamily& family, std::span<const FamilyContact> contacts);
  struct Met {
    int face;
    bool front;
  };
  // nullopt: blocked.
  [[nodiscard]] std::optional<std::vector<Met>> first_met(
      const FamilyLine& line, std::span<const FamilyContact> contacts);
  [[nodiscard]] bool passes_inside(const FamilyLine& line, int face) const;
  [[nodiscard]] Height height_of_face(const FamilyLine& line, int face) const;
  [[nodiscard]] Height height_of(const FamilyLine& line, const FamilyContact& contact,
                                 int number) const;
  [[nodiscard]] std::array<Ring, 2> exact(const FamilyLine& line, const Height& h,
                                          std::span<const FamilyContact> contacts) const;
  // Sign of a - b.
  [[nodiscard]] Sign compare(const FamilyLine& line, const Height& a, const Height& b,
                             std::span<const FamilyContact> contacts) const;
  [[nodiscard]] Sign sign(const FamilyLine& line, const Height& a,
                          std::span<const FamilyContact> contacts) const;

  const LightSpace& space_;
  const SourcePatch& patch_;
  std::span<const LightLine> sides_;
  std::span<const std::uint8_t> in_front_;  // of faces: reach in front of the patch
  std::span<const std::uint8_t> front_wanted_, back_wanted_;
  std::vector<FamilyCut> cuts_;
  std::vector<Interval> lit_;
  std::vector<int> near_, candidates_;
  std::deque<LightLine> scratch_;  // that cuts point to
  std::vector<ScannedPiece> pieces_, open_;
};

}  // namespace sightline::internal
