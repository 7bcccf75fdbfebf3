#include "shadows/irradiance/element_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sightline::internal {

const ElementPiece& ElementTree::find(Barycentric& place) const {
  int at = 0;
  while (pieces[at].kind == PieceKind::Halved) {
    const ElementPiece& piece = pieces[at];
    double &a = place[piece.side], &b = place[(piece.side + 1) % 3];
    const bool first = a >= b;
    at = piece.next + (first ? 0 : 1);
    // The middle takes the place of the corner that the half does not have.
    if (first) {
      a -= b;
      b *= 2;
    } else {
      b -= a;
      a *= 2;
    }
  }
  return pieces[at];
}

double polynomial(const ElementTree::Nodes& v, const Barycentric& b, int order) {
  if (order == 1) return b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    sum += b[i] * (2 * b[i] - 1) * v[i];
    sum += 4 * b[i] * b[(i + 1) % 3] * v[3 + i];
  }
  return sum;
}

struct ElementCutter::Cut {
  const SeenFormula* formula;
  ElementTree tree;
};

ElementTree ElementCutter::cut(const SeenFormula& formula, const Corners& corners) const {
  Cut cut{&formula, {}};
  cut.tree.pieces.push_back({PieceKind::ClosedForm});
  if (formula.loops.empty()) {
    cut.tree.pieces[0].kind = PieceKind::Polynomial;
    cut.tree.values.push_back({});
    return std::move(cut.tree);
  }
  if (options_.order == 0) return std::move(cut.tree);
  ElementTree::Nodes values{};
  for (int i = 0; i < 3; ++i) {
    values[i] = formula.value(lift(corners[i]), normal_);
    if (options_.order == 2) {
      values[3 + i] =
          formula.value(lift(0.5 * (corners[i] + corners[(i + 1) % 3])), normal_);
    }
  }
  const Point a = lift(corners[0]);
  const double area = 0.5 * (lift(corners[1]) - a).cross(lift(corners[2]) - a).norm();
  refine(cut, 0, corners, values, area);
  return std::move(cut.tree);
}

// The largest error of a polynomial on a triangle: the triangle is brought to one of
// equal sides, its circle to the ellipse through the corners, around their middle.
double ElementCutter::error(const SeenFormula& formula,
                            const std::array<Point, 3>& x) const {
  const Point middle = (x[0] + x[1] + x[2]) / 3;
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = x[0] - middle;
  axes.col(1) = (x[1] - x[2]) / std::sqrt(3.0);
  const Majorant bound = formula.bound(middle, axes, normal_);
  return options_.order == 1 ? kLinearError * bound.a[2] : kQuadraticError * bound.a[3];
}

// The side to halve: along it the bound is largest.
int ElementCutter::worst_side(const SeenFormula& formula,
                              const std::array<Point, 3>& x) const {
  int worst = 0;
  double most = -1;
  for (int i = 0; i < 3; ++i) {
    const Point &p = x[i], &q = x[(i + 1) % 3];
    Eigen::Matrix<double, 3, 2> axes = Eigen::Matrix<double, 3, 2>::Zero();
    axes.col(0) = (q - p) / 2;
    const Majorant along = formula.bound((p + q) / 2, axes, normal_);
    double size = along.a[options_.order + 1];
    // Where nothing is known the longest.
    if (!(size < Majorant::kUnknown)) size = 1e100 * (1 + (q - p).norm());
    if (size > most) {
      most = size;
      worst = i;
    }
  }
  return worst;
}

void ElementCutter::refine(Cut& cut, int piece, const Corners& x,
                           const ElementTree::Nodes& v, double area) const {
  const std::array<Point, 3> at{lift(x[0]), lift(x[1]), lift(x[2])};
  const auto leaf = [&](PieceKind kind, double bound) {
    cut.tree.pieces[piece] = {kind, 0, static_cast<int>(cut.tree.values.size()), bound};
    if (kind == PieceKind::Polynomial) cut.tree.values.push_back(v);
  };
  const double bound = error(*cut.formula, at);
  if (bound <= options_.accuracy) {
    leaf(PieceKind::Polynomial, bound);
    return;
  }
  if (area <= options_.smallest) {
    leaf(PieceKind::ClosedForm, 0);
    return;
  }
  const int side = worst_side(*cut.formula, at);
  const int a = side, b = (side + 1) % 3, c = (side + 2) % 3;
  const Eigen::Vector2d middle = 0.5 * (x[a] + x[b]);
  const auto value = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return options_.order == 2 ? cut.formula->value(lift(0.5 * (p + q)), normal_) : 0;
  };
  const double in_the_middle =
      options_.order == 2 ? v[3 + side] : cut.formula->value(lift(middle), normal_);
  const double across = value(middle, x[c]);
  ElementTree::Nodes first = v, second = v;
  first[b] = second[a] = in_the_middle;
  first[3 + a] = value(x[a], middle);
  first[3 + b] = second[3 + c] = across;
  second[3 + a] = value(middle, x[b]);
  Corners of_first = x, of_second = x;
  of_first[b] = of_second[a] = middle;
  const int next = static_cast<int>(cut.tree.pieces.size());
  cut.tree.pieces[piece] = {PieceKind::Halved, static_cast<std::uint8_t>(side), next, 0};
  cut.tree.pieces.resize(next + 2, {PieceKind::ClosedForm});
  refine(cut, next, of_first, first, area / 2);
  refine(cut, next + 1, of_second, second, area / 2);
}

}  // namespace sightline::internal
