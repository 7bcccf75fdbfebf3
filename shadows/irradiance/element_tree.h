// One triangle of a discontinuity mesh, cut in halves until a polynomial on each piece is
// proved to be near enough to the closed form.

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "shadows/irradiance/seen_formula.h"

namespace sightline::internal {

/// Coordinates in a triangle: three shares, which are 1 together.
using Barycentric = std::array<double, 3>;
using Corners = std::array<Eigen::Vector2d, 3>;

/// How a piece of a triangle answers.
enum class PieceKind : std::uint8_t {
  Halved,      ///< by its two halves
  Polynomial,  ///< by its values at nodes
  ClosedForm,  ///< no polynomial is proved to be near enough
  Sampled      ///< linearly, by exact values at its corners: there is no closed form
};

struct ElementPiece {
  PieceKind kind;
  std::uint8_t side = 0;  ///< Halved: from corner `side` to the next
  /// Halved: the first half, which has corner `side`; the second is the next one.  Else
  /// the position of its values.
  int next = 0;
  double bound = 0;  ///< of the error, without that of curved sides
};

struct ElementTree {
  /// Values at the corners, then at the middles of the sides 01, 12 and 20.
  using Nodes = std::array<double, 6>;
  std::vector<ElementPiece> pieces;  ///< the first is the whole
  std::vector<Nodes> values;

  /// The piece that has a place of the triangle, which becomes its place in the piece.
  [[nodiscard]] const ElementPiece& find(Barycentric& place) const;
};

/// Interpolation at the nodes of a triangle with corners on the unit circle, all sides of
/// one length, of a function with a_m >= |D^m f| / m!, is off by at most a_m times a
/// constant: f(x) less the interpolant is the sum of the remainders of Taylor's series
/// about x at the nodes x_i, times the shape functions l_i.  Linear: the sum of
/// l_i |x - x_i|^2 is 1 - |x|^2.
inline constexpr double kLinearError = 1;
/// Quadratic: the sum of |l_i| |x - x_i|^3 is below that.
inline constexpr double kQuadraticError = 0.79;

/// The value of the polynomial of degree 1 or 2.
[[nodiscard]] double polynomial(const ElementTree::Nodes& values,
                                const Barycentric& place, int order);

/// Cuts triangles of the plane of a receiver.
class ElementCutter {
 public:
  struct Options {
    int order;        ///< 1 or 2; 0: closed forms alone
    double accuracy;  ///< pieces are halved until their bound is at most that
    double smallest;  ///< or their area is
  };
  ElementCutter(const ShadowMesh::Frame& frame, const Eigen::Vector3d& normal,
                const Options& options)
      : frame_(frame), normal_(normal), options_(options) {}

  [[nodiscard]] ElementTree cut(const SeenFormula& formula, const Corners& corners) const;

  [[nodiscard]] Point lift(const Eigen::Vector2d& p) const {
    return frame_.origin + p.x() * frame_.x_axis + p.y() * frame_.y_axis;
  }

 private:
  struct Cut;
  void refine(Cut& cut, int piece, const Corners& corners,
              const ElementTree::Nodes& values, double area) const;
  [[nodiscard]] double error(const SeenFormula& formula,
                             const std::array<Point, 3>& corners) const;
  [[nodiscard]] int worst_side(const SeenFormula& formula,
                               const std::array<Point, 3>& corners) const;

  ShadowMesh::Frame frame_;
  Eigen::Vector3d normal_;
  Options options_;
};

}  // namespace sightline::internal
