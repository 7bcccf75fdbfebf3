// The form factor to what a face of a mesh sees of a light, as a formula in the point
// that can be continued beyond the face: Lambert's sum over the sides of the boundaries,
// each in the plane of the point and the side's line, between the rays in which
// neighbouring planes meet.

#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tests/support/naive_shadow.h"

namespace sightline::testing {

class StructureFormula {
 public:
  /// The structure that the naive oracle sees at a point with a normal.  nullopt where
  /// sides go on straight under other names, or where the formula does not give the
  /// oracle's form factor at the point to 1e-14: what it is made of is not all in general
  /// position.
  [[nodiscard]] static std::optional<StructureFormula> at(
      std::span<const NaiveShadowFace> faces, const NaiveShadow& naive, const Vec3& p,
      const Vec3& normal);

  [[nodiscard]] long double operator()(const Vec3& p) const;

 private:
  using Long = std::array<long double, 3>;
  struct Side {
    bool horizon;
    Long a, way;  ///< a point of the line and its direction
    /// Its plane, seen from the left, is the cross product times this.
    long double turn = 1;
    /// The ray to its first corner is the cross product of the planes times this, or runs
    /// to where the two lines meet, be it at infinity.
    long double reach = 1;
    enum class Corner { Planes, Point, Direction } corner = Corner::Planes;
    Long meeting{};
  };
  [[nodiscard]] static Long plane(const Side& side, const Long& p, const Long& normal);
  [[nodiscard]] static Long ray(const Side& side, const Long& before, const Long& own,
                                const Long& p);
  [[nodiscard]] long double sum(const std::vector<Side>& boundary, const Long& p) const;
  [[nodiscard]] bool orient(std::vector<Side>& boundary, const Long& p,
                            const Long& towards);

  Long normal_{};
  std::vector<std::vector<Side>> boundaries_;
  long double sign_ = 1;
};

}  // namespace sightline::testing
