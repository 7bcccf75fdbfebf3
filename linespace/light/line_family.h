// The lines of a one-parameter set, as an event of a source asks for them: through a
// point and an edge, or through three edges that are skew to each other.
//
// The line at s, 0 <= s <= 1, joins X(s) to Y(s), points with weights that are linear in
// s (linespace/swath.h has the notation).  Its side to a fixed line is a polynomial of
// degree 1 (point and edge: X does not move) or 2, written
//   h0 (1-s) + h2 s,   h0 (1-s)^2 + h1 s (1-s) + h2 s^2.

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "linespace/light/homogeneous.h"
#include "linespace/swaths/quadratic_root.h"

namespace sightline::internal {

/// Coefficients of a form; h1 is not used where the degree is 1.
template <class T>
using FormOf = std::array<T, 3>;

/// What makes a cut: where something can change along the lines of a family.
struct CutCause {
  enum class Kind : std::uint8_t {
    Limit,       ///< an end of the first edge
    Generator,   ///< an end of another generator edge: `id` is 0 or 1, of edge `index`
    FaceSide,    ///< a side of a face: `id` the face, `index` its corner
    SourceSide,  ///< of the source's outline or a foot: `id` its number
    Pierce,      ///< a generator edge passes through face `id`
    Crossing     ///< two faces cross each other, crossing number `id`
  };
  Kind kind = Kind::Limit;
  int id = -1, index = -1;
};

/// A position s in [0, 1], exact when it is asked for.
struct FamilyCut {
  double lo = 0, hi = 0;  ///< encloses s
  CutCause cause;
  /// The form whose root it is, or a value at X or Y; and which root.
  enum class Of : std::uint8_t { Start, End, Line, PlaneAtFirst, PlaneAtLast, Given };
  Of of = Of::Start;
  const LightLine* line = nullptr;
  const LightPlane* plane = nullptr;
  bool rising = false;
  std::shared_ptr<const QuadraticRoot> given;
};

class LineFamily;

/// The line at a position.
class FamilyLine {
 public:
  FamilyLine(const LineFamily& family, const Ring& s);

  [[nodiscard]] Sign side_to(const LightLine& line) const;
  [[nodiscard]] const Four<Approx>& first() const { return x_; }
  [[nodiscard]] const Four<Approx>& last() const { return y_; }
  [[nodiscard]] const Four<Ring>& exact_first() const { return exact().x; }
  [[nodiscard]] const Four<Ring>& exact_last() const { return exact().y; }
  [[nodiscard]] const Six<Approx>& line() const { return l_; }
  [[nodiscard]] const Six<Ring>& exact_line() const { return exact().l; }

 private:
  struct Exact {
    Four<Ring> x, y;
    Six<Ring> l;
  };
  [[nodiscard]] const Exact& exact() const;

  const LineFamily& family_;
  Ring s_;
  Four<Approx> x_, y_;
  Six<Approx> l_;
  mutable std::optional<Exact> exact_;
};

/// Keeps references to its points; scratch of one computation.
class LineFamily {
 public:
  /// Requires that v is not on the line of the edge.
  LineFamily(const LightPoint& v, const LightPoint& e0, const LightPoint& e1);
  /// Requires edges that are skew to each other.
  LineFamily(const LightLine& first, const LightLine& middle, const LightLine& last);

  [[nodiscard]] bool is_pencil() const { return middle_ == nullptr; }
  [[nodiscard]] FormOf<Approx> form(const LightLine& line) const;
  [[nodiscard]] FormOf<Ring> exact_form(const LightLine& line) const;

  /// The sign that a form has all along, 0 < s < 1; nullopt where it may change.
  [[nodiscard]] std::optional<Sign> constant_sign(const FormOf<Approx>& form) const;

  /// Appends the roots of a line's form strictly inside (0, 1).  A form that is zero all
  /// along has none.
  void add_roots(const LightLine& line, const FormOf<Approx>& form, const CutCause& cause,
                 std::vector<FamilyCut>& out) const;
  /// Appends the root of a plane's value at the first, or the last point, inside (0, 1).
  void add_plane_root(const LightPlane& plane, bool at_first, const CutCause& cause,
                      std::vector<FamilyCut>& out) const;

  [[nodiscard]] static FamilyCut start();
  [[nodiscard]] static FamilyCut end();
  [[nodiscard]] QuadraticRoot exact(const FamilyCut& cut) const;
  /// Encloses the cut to 2^-47 of itself.
  void refine(FamilyCut& cut) const;
  /// Sign of a - b.
  [[nodiscard]] Sign compare(const FamilyCut& a, const FamilyCut& b) const;

  struct Ends {
    std::array<Four<Ring>, 2> x, y;
  };
  [[nodiscard]] const Ends& exact_ends() const;
  [[nodiscard]] const std::array<Four<Approx>, 2>& first() const { return x_; }
  [[nodiscard]] const std::array<Four<Approx>, 2>& last() const { return y_; }

 private:
  void find_lines();
  void add_linear_root(const Approx& at0, const Approx& at1, FamilyCut cut,
                       std::vector<FamilyCut>& out) const;
  void add_exact_roots(const LightLine& line, const CutCause& cause,
                       std::vector<FamilyCut>& out) const;
  void add_root(const FormOf<Approx>& form, double s, FamilyCut cut,
                std::vector<FamilyCut>& out) const;
  [[nodiscard]] std::array<Ring, 2> exact_values(const FamilyCut& cut) const;

  const LightPoint* v_ = nullptr;  // of a pencil
  std::array<const LightPoint*, 2> e_{};
  const LightLine* first_ = nullptr;
  const LightLine* middle_ = nullptr;
  const LightLine* last_ = nullptr;
  std::array<Four<Approx>, 2> x_, y_;
  std::array<Six<Approx>, 3> l_;
  mutable std::optional<Ends> ends_;
  mutable std::optional<std::array<Six<Ring>, 3>> exact_l_;
  friend class FamilyLine;
};

}  // namespace sightline::internal
