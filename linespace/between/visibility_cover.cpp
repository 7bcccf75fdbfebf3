// The checker shares with the search the cutting of polygons and the names of forms, and
// nothing else: no tables, no doubles, no linear programs.

#include "linespace/visibility_cover.h"

#include <algorithm>
#include <map>

#include "linespace/between/visibility_cover.h"
#include "linespace/work/stop_scope.h"

namespace sightline {
namespace internal {
namespace {

using ExactTriangle = std::array<ExactPoint, 3>;
using Values = std::array<Rational, 9>;

ExactTriangle exact_triangle(const Triangle& t) {
  return {exact_point(t[0]), exact_point(t[1]), exact_point(t[2])};
}

bool is_zero(const Values& values) {
  return std::ranges::all_of(values, [](const Rational& v) { return v == 0; });
}

/// In the weights of p's three corners and of q's: powers of the six, and a coefficient.
using Powers = std::array<int, 6>;
using Polynomial = std::map<Powers, Rational>;

Powers power(int i) {
  Powers powers{};
  powers[i] = 1;
  return powers;
}

Polynomial times(const Polynomial& f, const Polynomial& g) {
  Polynomial product;
  for (const auto& [u, x] : f) {
    for (const auto& [v, y] : g) {
      Powers sum;
      for (int i = 0; i < 6; ++i) sum[i] = u[i] + v[i];
      product[sum] += x * y;
    }
  }
  return product;
}

// Times as many sums of weights, which are 1, as make it of degree 2 in both; all terms
// must have one degree.
Polynomial homogeneous(Polynomial f) {
  for (const int first : {0, 3}) {
    const Polynomial one{{power(first), 1}, {power(first + 1), 1}, {power(first + 2), 1}};
    const auto degree = [&] {
      const Powers& u = f.begin()->first;
      return u[first] + u[first + 1] + u[first + 2];
    };
    while (degree() < 2) f = times(f, one);
  }
  return f;
}

/// A form by its points; an edge by its line, whichever piece it is of.
struct Measure {
  FormKind kind;
  std::vector<Point> points;
  bool operator==(const Measure& other) const {
    if (kind != other.kind) return false;
    if (kind != FormKind::EdgeSide) return points == other.points;
    return collinear(points[0], points[1], other.points[0]) &&
           collinear(points[0], points[1], other.points[1]);
  }

  [[nodiscard]] Rational at(const ExactPoint& p, const ExactPoint& q) const {
    FormPoints x;
    x.fill(points[0]);
    std::ranges::copy(points, x.begin());
    return exact_form_value(kind, x, p, q);
  }
};

/// Walks the tree of one pair of triangles.
class Checker {
 public:
  Checker(const CutQuestion& question, const VisibilityCover::Data::PairCover& pair)
      : question_(question), pair_(pair), apex_(apex_off(pair.a)) {}

  std::optional<std::string> run() {
    const Point& a0 = pair_.a[0];
    if (orient3d(a0, pair_.a[1], pair_.a[2], apex_) == Sign::Zero) return "no apex";
    cell(exact_triangle(pair_.a), exact_triangle(pair_.b));
    if (!error_ && next_ != pair_.cover.nodes.size()) fail("nodes are left over");
    return error_;
  }

 private:
  struct Assumption {
    Measure measure;
    int sign;
  };

  void fail(const std::string& what) {
    if (!error_) error_ = "node " + std::to_string(next_) + ": " + what;
  }

  // Sides are measured from their lexicographically smaller end.
  Measure measure(const FormName& name, bool* reversed = nullptr) const {
    const std::vector<Point>& corners = question_.pieces[name.piece].corners;
    const Point& here = corners[name.corner];
    const Point& next = corners[(name.corner + 1) % corners.size()];
    switch (name.kind) {
      case FormKind::EdgeSide: {
        const bool swap = std::lexicographical_compare(next.data(), next.data() + 3,
                                                       here.data(), here.data() + 3);
        if (reversed != nullptr) *reversed = swap;
        return {name.kind, swap ? std::vector{next, here} : std::vector{here, next}};
      }
      case FormKind::CornerSide:
        return {name.kind, {here, apex_}};
      case FormKind::FromPlane:
      case FormKind::ToPlane:
        return {name.kind, {corners[0], corners[1], corners[2]}};
      default:
        return {name.kind, {here, next, apex_}};
    }
  }

  static Values values(const Measure& m, const ExactTriangle& a, const ExactTriangle& b) {
    Values out;
    for (int i = 0; i < 9; ++i) out[i] = m.at(a[i / 3], b[i % 3]);
    return out;
  }

  // sign * m >= 0 in all of the cell: assumed, or true at all corner pairs.
  bool holds(const Measure& m, int sign, const ExactTriangle& a, const ExactTriangle& b) {
    for (const Assumption& known : assumed_) {
      if (known.measure == m) return known.sign == sign;
    }
    return std::ranges::all_of(values(m, a, b),
                               [sign](const Rational& v) { return sign * v >= 0; });
  }

  void cell(const ExactTriangle& a, const ExactTriangle& b) {
    if (error_) return;
    if (next_ >= pair_.cover.nodes.size()) return fail("the tree ends early");
    const CoverNode node = pair_.cover.nodes[next_++];
    switch (node.kind) {
      case CoverNode::Kind::Split:
        return split(node, a, b);
      case CoverNode::Kind::HalveFrom:
      case CoverNode::Kind::HalveTo:
        return halve(node, a, b);
      case CoverNode::Kind::Blocked:
        if (!contradicted_ && !blocked(pair_.blockers[node.index], a, b))
          fail("not blocked");
        return;
      case CoverNode::Kind::Empty:
        if (!contradicted_ && !empty(node, a, b)) fail("not proved empty");
        return;
    }
  }

  void split(const CoverNode& node, const ExactTriangle& a, const ExactTriangle& b) {
    if (node.sign != 1 && node.sign != -1) return fail("a split without a sign");
    const Measure m = measure(pair_.forms[node.index]);
    const bool was_contradicted = contradicted_;
    for (const int sign : {int{node.sign}, -node.sign}) {
      // No segment has both signs: of such a cell nothing need be shown.
      contradicted_ = was_contradicted || assumed(m) == -sign;
      assumed_.push_back({m, sign});
      cell(a, b);
      assumed_.pop_back();
    }
    contradicted_ = was_contradicted;
  }

  void halve(const CoverNode& node, const ExactTriangle& a, const ExactTriangle& b) {
    const bool from = node.kind == CoverNode::Kind::HalveFrom;
    const ExactTriangle& whole = from ? a : b;
    const int i = node.index, next = (i + 1) % 3;
    ExactPoint middle;
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis] = (whole[i][axis] + whole[next][axis]) / 2;
    }
    for (const int moved : {i, next}) {
      ExactTriangle half = whole;
      half[moved] = middle;
      from ? cell(half, b) : cell(a, half);
    }
  }

  bool blocked(const Blocker& blocker, const ExactTriangle& a, const ExactTriangle& b) {
    if (blocker.patch >= 0) return blocked_by_patch(pair_.patches[blocker.patch], a, b);
    return blocked(blocker.piece, a, b);
  }

  // All lines of the cell have all of the outline on one hand: they turn around it at
  // least once, and so cross the patch at least once.  They cross it between p and q: no
  // piece of it is behind the plane of a or of b, or p and q are on two sides of its
  // plane.
  bool blocked_by_patch(const std::vector<FacingPiece>& patch, const ExactTriangle& a,
                        const ExactTriangle& b) {
    const auto corners_of = [&](int piece) {
      return std::span<const Point>(question_.pieces[piece].corners);
    };
    const std::vector<OutlineSide> sides = outline(patch, corners_of);
    for (const OutlineSide& side : sides) {
      const Measure m = measure({FormKind::EdgeSide, side.piece, side.corner});
      if (!holds(m, side.times > 0 ? -1 : 1, a, b)) return false;
    }
    return !sides.empty() && std::ranges::all_of(patch, [&](const FacingPiece& facing) {
      return is_between(facing.piece) || is_divided(facing, a, b);
    });
  }

  bool is_between(int piece) const {
    const auto ahead = [](const Triangle& plane, const Triangle& other,
                          std::span<const Point> corners) {
      const int side = side_of_plane(plane, other);
      return side != 0 && std::ranges::all_of(corners, [&](const Point& x) {
               return side *
                          static_cast<int>(orient3d(plane[0], plane[1], plane[2], x)) >=
                      0;
             });
    };
    const auto& corners = question_.pieces[piece].corners;
    return ahead(pair_.a, pair_.b, corners) && ahead(pair_.b, pair_.a, corners);
  }

  bool is_divided(const FacingPiece& facing, const ExactTriangle& a,
                  const ExactTriangle& b) {
    const Measure from = measure({FormKind::FromPlane, facing.piece, 0});
    const Measure to = measure({FormKind::ToPlane, facing.piece, 0});
    return holds(from, facing.front, a, b) && holds(to, -facing.front, a, b) &&
           !(is_zero(values(from, a, b)) && is_zero(values(to, a, b)));
  }

  // All segments of the cell meet the piece.
  bool blocked(int piece, const ExactTriangle& a, const ExactTriangle& b) {
    const Measure from = measure({FormKind::FromPlane, piece, 0});
    const Measure to = measure({FormKind::ToPlane, piece, 0});
    if (is_zero(values(from, a, b)) && is_zero(values(to, a, b))) {
      return blocked_in_plane(piece, a, b);
    }
    const int n = static_cast<int>(question_.pieces[piece].corners.size());
    for (const int front : {1, -1}) {
      bool all = holds(from, front, a, b) && holds(to, -front, a, b);
      for (int i = 0; i < n && all; ++i) {
        bool reversed = false;
        const Measure side = measure({FormKind::EdgeSide, piece, i}, &reversed);
        all = holds(side, reversed ? front : -front, a, b);
      }
      if (all) return true;
    }
    return false;
  }

  // p lies in the piece, or the segment crosses one of its sides.
  bool blocked_in_plane(int piece, const ExactTriangle& a, const ExactTriangle& b) {
    const std::vector<Point>& corners = question_.pieces[piece].corners;
    const int n = static_cast<int>(corners.size());
    const int inner =
        static_cast<int>(orient3d(corners[0], corners[1], apex_, corners[2]));
    bool inside = true;
    for (int i = 0; i < n && inside; ++i) {
      inside = holds(measure({FormKind::FromEdge, piece, i}), inner, a, b);
    }
    if (inside) return true;
    for (int i = 0; i < n; ++i) {
      for (const int side : {1, -1}) {
        if (!holds(measure({FormKind::FromEdge, piece, i}), side, a, b) ||
            !holds(measure({FormKind::ToEdge, piece, i}), -side, a, b))
          continue;
        for (const int turn : {1, -1}) {
          if (holds(measure({FormKind::CornerSide, piece, i}), turn, a, b) &&
              holds(measure({FormKind::CornerSide, piece, (i + 1) % n}), -turn, a, b))
            return true;
        }
      }
    }
    return false;
  }

  // sign * form, given by its corner values.
  static Polynomial polynomial(const FormName& name, const Values& at, int sign) {
    const bool of_p = name.kind == FormKind::FromPlane || name.kind == FormKind::FromEdge;
    const bool of_q = name.kind == FormKind::ToPlane || name.kind == FormKind::ToEdge;
    Polynomial f;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        Powers powers{};
        if (!of_q) powers[j] = 1;
        if (!of_p) powers[3 + k] = 1;
        f[powers] = sign * at[3 * j + k];
      }
    }
    return f;
  }

  // The sign that the path gives to a form; 0 for none.
  int assumed(const Measure& m) const {
    const auto known = std::ranges::find(assumed_, m, &Assumption::measure);
    return known == assumed_.end() ? 0 : known->sign;
  }

  static bool of_p(const FormName& name) {
    return name.kind == FormKind::FromPlane || name.kind == FormKind::FromEdge;
  }
  static bool of_q(const FormName& name) {
    return name.kind == FormKind::ToPlane || name.kind == FormKind::ToEdge;
  }

  // Each share is positive inside the cell, but their sum is nowhere.
  bool empty(const CoverNode& node, const ExactTriangle& a, const ExactTriangle& b) {
    Polynomial sum;
    bool any = false;
    for (int i = node.index; i < node.index + node.count; ++i) {
      hear_stop();
      const CoverShare& share = pair_.cover.shares[i];
      const Rational weight = share.exact >= 0 ? pair_.cover.exact_weights[share.exact]
                                               : Rational(share.weight);
      if (weight < 0) return false;
      any |= weight > 0;
      Polynomial product{{{}, weight}};
      for (const int form : {share.form, share.other}) {
        if (form < 0) continue;
        const Measure m = measure(pair_.forms[form]);
        const int sign = assumed(m);
        if (sign == 0) return false;
        product = times(product, polynomial(pair_.forms[form], values(m, a, b), sign));
      }
      for (const int corner : share.alpha) {
        if (corner >= 0) product = times(product, {{power(corner), 1}});
      }
      for (const int corner : share.beta) {
        if (corner >= 0) product = times(product, {{power(3 + corner), 1}});
      }
      for (const auto& [powers, x] : homogeneous(product)) sum[powers] += x;
    }
    return any &&
           std::ranges::all_of(sum, [](const auto& term) { return term.second <= 0; });
  }

  const CutQuestion& question_;
  const VisibilityCover::Data::PairCover& pair_;
  Point apex_;
  std::size_t next_ = 0;
  std::vector<Assumption> assumed_;
  bool contradicted_ = false;
  std::optional<std::string> error_;
};

}  // namespace
}  // namespace internal

std::size_t VisibilityCover::leaves() const {
  std::size_t count = 0;
  for (const Data::PairCover& pair : data_->pairs) {
    count += std::ranges::count_if(pair.cover.nodes, [](const internal::CoverNode& node) {
      return node.kind == internal::CoverNode::Kind::Blocked ||
             node.kind == internal::CoverNode::Kind::Empty;
    });
  }
  return count;
}

std::optional<std::string> check_cover(const VisibilityQuestion& question,
                                       const VisibilityCover& cover) {
  const internal::CutQuestion cut = internal::cut(question);
  const auto& pairs = cover.data().pairs;
  std::size_t next = 0;
  for (const internal::Triangle& a : cut.a) {
    for (const internal::Triangle& b : cut.b) {
      if (next >= pairs.size() || pairs[next].a != a || pairs[next].b != b) {
        return "the cover is of other triangles";
      }
      if (auto error = internal::Checker(cut, pairs[next]).run()) {
        return "pair " + std::to_string(next) + ", " + *error;
      }
      ++next;
    }
  }
  return std::nullopt;
}

}  // namespace sightline
