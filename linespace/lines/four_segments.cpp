// The components of the lines that meet four segments, exactly.
//
// Where two of the four are skew, a line that meets both is a point (x, y) of P1 x P1
// (lines/transversals.h), and T(Q) is cut out there by the other two: single points,
// arcs of x = const or y = const (pencils) or of a Moebius curve (a regulus), or a
// rectangle (a congruence).  An arc begins and ends at lines through end points of
// segments, so it is found by trying those lines and one between every two neighbours.
// Where every two of the four are coplanar, either all four concur or all lie in a plane,
// which is a question of lines in the plane.

#include <algorithm>
#include <cassert>
#include <functional>
#include <numeric>
#include <utility>

#include "linespace/lines/segment_transversals.h"
#include "linespace/lines/transversals.h"

namespace sightline::internal {
namespace {

using Parameter = std::array<Ring, 2>;  // homogeneous, real
using Elements = std::span<const Element>;
using Homogeneous = std::array<Ring, 4>;

std::array<Surd, 2> surds(const Parameter& p) { return {Surd{p[0], 0}, Surd{p[1], 0}}; }
bool is_null(const Parameter& p) { return is_zero(p[0]) && is_zero(p[1]); }

bool meets_all(const ExactLine& line, Elements elements) {
  return std::ranges::all_of(elements, [&](const Element& e) { return meets(line, e); });
}
// As a limit: contacts with unbounded elements may be at infinity.
bool closure_meets(const std::optional<ExactLine>& line, Elements elements) {
  return std::ranges::all_of(elements, [&](const Element& e) {
    if (!line) return !e.bounded;
    return e.bounded ? line->meets(e.line) != SegmentContact::None
                     : line->side(e.line) == Sign::Zero;
  });
}
// Whether every line like this one has finite contacts.
bool parallel_to_unbounded(const ExactLine& line, Elements elements) {
  return std::ranges::any_of(elements, [&](const Element& e) {
    return !e.bounded && line.is_parallel(e.line) &&
           line.meets(e.line) != SegmentContact::Along;
  });
}

void add_distinct(std::vector<ExactLine>& lines, const ExactLine& line) {
  for (const ExactLine& l : lines) {
    if (same_line(l, line)) return;
  }
  lines.push_back(line);
}

// ---- one parameter
// ----------------------------------------------------------------------

struct Arc {
  std::vector<ExactLine> ends;  // none: the whole circle; one: a single line
  std::vector<LineArc> parts;
  ExactLine sample;
  bool single = false;
  bool has_mark = false;
};

Sign order(const Parameter& p, const Parameter& q) {
  return sign_of(Ring(p[0] * q[1] - p[1] * q[0]));
}

// The arcs of a circle of lines that meet all elements.  `breaks`: where that can change,
// and perhaps elsewhere.  `mark`: a place whose arc is to be told.
std::vector<Arc> arcs_of(
    const std::function<std::optional<ExactLine>(const Parameter&)>& line,
    std::vector<Parameter> breaks, const Parameter* mark, Elements elements) {
  // 1. The breaks, with the mark as one more; where there are few, fixed places beside.
  // (0, 0) is no place.
  if (mark != nullptr) breaks.push_back(*mark);
  std::erase_if(breaks, is_null);
  if (breaks.size() < 3) breaks.insert(breaks.end(), {{1, 0}, {0, 1}, {1, 1}});
  // 2. A parameter p and -p are the same line: take those of the upper half-plane, where
  // the sign of a determinant orders them around the circle.
  for (Parameter& p : breaks) {
    const Sign s = sign_of(p[1]);
    if (s == Sign::Negative || (s == Sign::Zero && sign_of(p[0]) == Sign::Negative)) {
      p = {-p[0], -p[1]};
    }
  }
  std::ranges::sort(breaks, [](const Parameter& p, const Parameter& q) {
    return order(p, q) == Sign::Positive;
  });
  // Equal places are one break.
  const auto repeats =
      std::unique(breaks.begin(), breaks.end(),
                  [](const auto& p, const auto& q) { return order(p, q) == Sign::Zero; });
  breaks.erase(repeats, breaks.end());
  // 3. Cells: break 0, the gap behind it, break 1, ...  One line speaks for a cell: the
  // break's own, or in a gap the line of the sum of its two breaks, the last one of which
  // has its successor half a turn on, at -q.
  const std::size_t n = breaks.size();
  std::vector<std::optional<ExactLine>> cell(2 * n);
  std::vector<char> inside(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Parameter& p = breaks[i];
    const Parameter& q = breaks[(i + 1) % n];
    cell[2 * i] = line(p);
    cell[2 * i + 1] = n == 1       ? line({-p[1], p[0]})
                      : i + 1 == n ? line({p[0] - q[0], p[1] - q[1]})
                                   : line({p[0] + q[0], p[1] + q[1]});
  }
  // Between two breaks nothing changes: what its one line meets, all lines of a gap meet.
  for (std::size_t i = 0; i < 2 * n; ++i) inside[i] = closure_meets(cell[i], elements);
  // 4. A maximal run of cells inside is an arc: `collect` makes one of `count` cells.
  std::vector<Arc> arcs;
  // The mark is a break, so that it is a cell of its own.
  const auto is_mark = [&](std::size_t i) {
    return mark != nullptr && i % 2 == 0 && order(breaks[i / 2], *mark) == Sign::Zero;
  };
  const auto collect = [&](std::size_t from, std::size_t count) {
    const auto at = [&](std::size_t k) { return cell[(from + k) % (2 * n)]; };
    // A line in the middle is a better sample than one at an end; a cell has none where
    // its line is at infinity.
    const auto some = at(count / 2) ? at(count / 2) : at(0);
    if (!some) return;
    Arc arc{{}, {}, *some, count == 1, false};
    for (std::size_t k = 0; k < count; ++k) {
      arc.has_mark |= is_mark((from + k) % (2 * n));
      // A part runs from a break over the gap to the next break, by one line of each; the
      // whole circle closes on itself.
      if (k + 2 < count + (count == 2 * n ? 1 : 0) && k % 2 == 0 && at(k) && at(k + 1) &&
          at(k + 2)) {
        arc.parts.push_back({*at(k), *at(k + 1), *at(k + 2)});
      }
    }
    // The whole circle has no ends, a single line has one.
    if (count < 2 * n) {
      if (at(0)) add_distinct(arc.ends, *at(0));
      if (at(count - 1)) add_distinct(arc.ends, *at(count - 1));
    }
    arcs.push_back(std::move(arc));
  };
  // 5. Runs are counted from a cell outside, so that none is cut at the first break.
  const auto outside = std::ranges::find(inside, 0);
  if (outside == inside.end()) {
    collect(0, 2 * n);
    return arcs;
  }
  const auto start = static_cast<std::size_t>(outside - inside.begin());
  for (std::size_t k = 1; k < 2 * n; ++k) {
    if (!inside[(start + k) % (2 * n)]) continue;
    std::size_t count = 0;
    while (inside[(start + k + count) % (2 * n)]) ++count;
    collect((start + k) % (2 * n), count);
    k += count;
  }
  return arcs;
}

// ---- two skew elements
// ------------------------------------------------------------------

class OnSkewPair {
 public:
  OnSkewPair(const LineThrough& l, const LineThrough& m, Elements elements)
      : l_(l), m_(m), elements_(elements) {
    for (const Element& e : elements) {
      if (!e.bounded) continue;
      for (const Eigen::Vector3d* p : {&e.line.from, &e.line.to}) {
        x_breaks_.push_back(crossing(m, *p, l));
        y_breaks_.push_back(crossing(l, *p, m));
      }
    }
  }

  FourComponents components(const Element& third, const Element& fourth) {
    const BilinearForm<Ring> f = ring_form(l_, m_, third.line);
    const BilinearForm<Ring> g = ring_form(l_, m_, fourth.line);
    const CommonZeros common = common_zeros(f, g);
    const bool no_f = is_zero(f.f[0][0]) && is_zero(f.f[0][1]) && is_zero(f.f[1][0]) &&
                      is_zero(f.f[1][1]);
    switch (common.kind) {
      case TransversalClass::MeetingTwoLines:
        rectangle();
        break;
      case TransversalClass::Regulus:
        curve(no_f ? g : f);
        break;
      case TransversalClass::TwoPencils:
        two_pencils(no_f ? g : f);
        break;
      case TransversalClass::Pencil:
        one_pencil(f, g);
        break;
      default:
        for (const auto& [x, y] : common.zeros) {
          const auto line = joining(l_, x, m_, y, common.radicand);
          if (line && meets_all(*line, elements_)) out_.isolated.push_back(*line);
        }
    }
    return std::move(out_);
  }

 private:
  // Where the plane through `axis` and p crosses `line`; null when p is on the axis.
  static Parameter crossing(const LineThrough& axis, const Eigen::Vector3d& p,
                            const LineThrough& line) {
    return {ring_orient3d(axis.from, axis.to, p, line.to),
            -ring_orient3d(axis.from, axis.to, p, line.from)};
  }
  std::optional<ExactLine> line(const Parameter& x, const Parameter& y) const {
    return joining(l_, surds(x), m_, surds(y), 0);
  }

  void add(const std::vector<Arc>& arcs, FamilyKind kind) {
    for (const Arc& arc : arcs) add(arc, kind);
  }
  void add(const Arc& arc, FamilyKind kind) {
    if (parallel_to_unbounded(arc.sample, elements_)) return;
    if (arc.single) {
      out_.isolated.push_back(arc.sample);
    } else {
      out_.families.push_back({kind, 1, arc.ends, {}, arc.parts, {arc.sample}, {}});
    }
  }

  void curve(const BilinearForm<Ring>& f) {
    const auto at = [&](const Parameter& x) {
      const Parameter y{x[0] * f.f[0][1] + x[1] * f.f[1][1],
                        -(x[0] * f.f[0][0] + x[1] * f.f[1][0])};
      return line(x, y);
    };
    // End points on m are at no x of their own, only at the curve's.
    std::vector<Parameter> breaks = x_breaks_;
    for (std::size_t i = 0; i < breaks.size(); ++i) {
      const Parameter& y = y_breaks_[i];
      if (!is_null(breaks[i])) continue;
      breaks[i] = {y[0] * f.f[1][0] + y[1] * f.f[1][1],
                   -(y[0] * f.f[0][0] + y[1] * f.f[0][1])};
    }
    add(arcs_of(at, breaks, nullptr, elements_), FamilyKind::Regulus);
  }

  // f = (a0 x0 + a1 x1)(b0 y0 + b1 y1).
  static std::pair<Parameter, Parameter> factors(const BilinearForm<Ring>& f) {
    const int column = is_zero(f.f[0][0]) && is_zero(f.f[1][0]) ? 1 : 0;
    const int row = is_zero(f.f[0][0]) && is_zero(f.f[0][1]) ? 1 : 0;
    return {{f.f[1][column], -f.f[0][column]}, {f.f[row][1], -f.f[row][0]}};
  }
  std::vector<Arc> through_x(const Parameter& x, const Parameter* mark) const {
    return arcs_of([&](const Parameter& y) { return line(x, y); }, y_breaks_, mark,
                   elements_);
  }
  std::vector<Arc> through_y(const Parameter& y, const Parameter* mark) const {
    return arcs_of([&](const Parameter& x) { return line(x, y); }, x_breaks_, mark,
                   elements_);
  }

  void one_pencil(const BilinearForm<Ring>& f, const BilinearForm<Ring>& g) {
    const auto [x, y] = factors(f);
    if (order(x, factors(g).first) == Sign::Zero) {
      add(through_x(x, nullptr), FamilyKind::Pencil);
    } else {
      add(through_y(y, nullptr), FamilyKind::Pencil);
    }
  }

  void two_pencils(const BilinearForm<Ring>& f) {
    const auto [x, y] = factors(f);
    std::vector<Arc> all = through_x(x, &y);
    const auto first = static_cast<std::ptrdiff_t>(all.size());
    std::ranges::move(through_y(y, &x), std::back_inserter(all));
    // Those that hold the common line are one component.
    const auto marked = [](const Arc& arc) { return arc.has_mark; };
    const auto a = std::find_if(all.begin(), all.begin() + first, marked);
    const auto b = std::find_if(all.begin() + first, all.end(), marked);
    if (a != all.begin() + first && b != all.end()) {
      if (a->single || b->single) {
        all.erase(a->single ? a : b);
      } else {
        join(*a, *b);
        all.erase(b);
        all.erase(a);
      }
    }
    add(all, FamilyKind::Pencil);
  }

  void join(const Arc& a, const Arc& b) {
    if (parallel_to_unbounded(a.sample, elements_)) return add(b, FamilyKind::Pencil);
    if (parallel_to_unbounded(b.sample, elements_)) return add(a, FamilyKind::Pencil);
    ExactFamily family{FamilyKind::JoinedPencils, 1, a.ends, {}, a.parts, {a.sample}, {}};
    for (const ExactLine& end : b.ends) add_distinct(family.corners, end);
    family.arcs.insert(family.arcs.end(), b.parts.begin(), b.parts.end());
    out_.families.push_back(std::move(family));
  }

  // What the elements on one support have in common, as its parameters: nullopt when
  // nothing, two infinite ends when all are unbounded.
  std::optional<std::vector<Parameter>> common_part(const LineThrough& support,
                                                    const LineThrough& other) const {
    int axis = 0;
    while (support.to[axis] == support.from[axis]) ++axis;
    const Eigen::Vector3d* low = nullptr;
    const Eigen::Vector3d* high = nullptr;
    for (const Element& e : elements_) {
      if (!e.bounded || !collinear(support.from, support.to, e.line.from) ||
          !collinear(support.from, support.to, e.line.to)) {
        continue;
      }
      const bool up = e.line.from[axis] < e.line.to[axis];
      const Eigen::Vector3d& p = up ? e.line.from : e.line.to;
      const Eigen::Vector3d& q = up ? e.line.to : e.line.from;
      if (low == nullptr || p[axis] > (*low)[axis]) low = &p;
      if (high == nullptr || q[axis] < (*high)[axis]) high = &q;
    }
    if (low == nullptr) return std::vector<Parameter>{};
    if ((*low)[axis] > (*high)[axis]) return std::nullopt;
    std::vector<Parameter> ends{crossing(other, *low, support)};
    if ((*low)[axis] < (*high)[axis]) ends.push_back(crossing(other, *high, support));
    return ends;
  }

  // All elements lie on the two skew supports.
  void rectangle() {
    const auto a = common_part(l_, m_);
    const auto b = common_part(m_, l_);
    if (!a || !b) return;
    const auto some = [](const std::vector<Parameter>& ends) {
      return ends.empty() ? std::vector<Parameter>{{1, 0}, {0, 1}, {2, 1}} : ends;
    };
    const int dimension = (a->size() == 1 ? 0 : 1) + (b->size() == 1 ? 0 : 1);
    std::vector<ExactLine> corners;
    for (const Parameter& x : *a) {
      for (const Parameter& y : *b) corners.push_back(*line(x, y));
    }
    if (dimension == 0) {
      out_.isolated.push_back(corners.front());
      return;
    }
    std::vector<ExactLine> samples;
    for (const Parameter& x : some(*a)) {
      for (const Parameter& y : some(*b)) samples.push_back(*line(x, y));
    }
    ExactFamily family{FamilyKind::Congruence, 2, corners, {}, {}, samples, {}};
    if (dimension == 1) {
      family.kind = FamilyKind::Pencil;
      family.dimension = 1;
      if (corners.size() == 2) {
        const bool fan = a->size() == 1;  // from one point of l
        const Parameter x = fan ? a->front() : between(*a);
        const Parameter y = fan ? between(*b) : b->front();
        family.arcs.push_back({corners[0], *line(x, y), corners[1]});
      } else {
        family.arcs = {{samples[0], samples[1], samples[2]},
                       {samples[1], samples[2], samples[0]}};
      }
    }
    out_.families.push_back(std::move(family));
  }
  // Inside a part with two ends.
  static Parameter between(const std::vector<Parameter>& ends) {
    // Finite parameters of one line: their sum, once both have positive weight.
    const auto positive = [](const Parameter& p) {
      return sign_of(Ring(p[0] + p[1])) == Sign::Negative ? Parameter{-p[0], -p[1]} : p;
    };
    const Parameter p = positive(ends[0]);
    const Parameter q = positive(ends[1]);
    return {p[0] + q[0], p[1] + q[1]};
  }

  LineThrough l_, m_;
  Elements elements_;
  std::vector<Parameter> x_breaks_, y_breaks_;
  FourComponents out_;
};

// ---- concurrent elements
// ----------------------------------------------------------------

// p / w on a closed segment of its line.
bool holds(const Element& e, const Homogeneous& p) {
  if (!e.bounded) return true;
  int axis = 0;
  while (e.line.from[axis] == e.line.to[axis]) ++axis;
  const Sign w = sign_of(p[3]);
  const Sign a = sign_of(Ring(p[axis] - p[3] * Ring(e.line.from[axis]))) * w;
  const Sign b = sign_of(Ring(p[axis] - p[3] * Ring(e.line.to[axis]))) * w;
  return a * b != Sign::Positive;
}

// The common point of two different coplanar supports; nullopt when they are parallel.
std::optional<Homogeneous> common_point(const LineThrough& l, const LineThrough& m) {
  const RingVector d = ring_difference(l.to, l.from);
  const RingVector e = ring_difference(m.to, m.from);
  const RingVector n = cross(d, e);
  const RingVector at = cross(ring_difference(m.from, l.from), e);
  for (int i = 0; i < 3; ++i) {
    if (is_zero(n[i])) continue;
    // l.from + (at / n) d
    const RingVector p = ring_point(l.from);
    return Homogeneous{p[0] * n[i] + at[i] * d[0], p[1] * n[i] + at[i] * d[1],
                       p[2] * n[i] + at[i] * d[2], n[i]};
  }
  return std::nullopt;
}

bool passes(const LineThrough& l, const Homogeneous& p) {
  const RingVector d = ring_difference(l.to, l.from);
  const RingVector at{p[0] - p[3] * Ring(l.from.x()), p[1] - p[3] * Ring(l.from.y()),
                      p[2] - p[3] * Ring(l.from.z())};
  const RingVector n = cross(d, at);
  return is_zero(n[0]) && is_zero(n[1]) && is_zero(n[2]);
}

bool same_support(const LineThrough& l, const LineThrough& m) {
  return collinear(l.from, l.to, m.from) && collinear(l.from, l.to, m.to);
}
ExactLine support_line(const Element& e) {
  return ExactLine::through(e.line.from, e.line.to);
}

// All elements on one line.
FourComponents collinear_components(Elements elements) {
  FourComponents out;
  const LineThrough& s = elements.front().line;
  int axis = 0;
  while (s.from[axis] == s.to[axis]) ++axis;
  std::optional<Eigen::Vector3d> low, high;
  for (const Element& e : elements) {
    if (!e.bounded) continue;
    const bool up = e.line.from[axis] < e.line.to[axis];
    const Eigen::Vector3d& p = up ? e.line.from : e.line.to;
    const Eigen::Vector3d& q = up ? e.line.to : e.line.from;
    if (!low || p[axis] > (*low)[axis]) low = p;
    if (!high || q[axis] < (*high)[axis]) high = q;
  }
  const auto point = [](const Eigen::Vector3d& p) {
    return Homogeneous{Ring(p.x()), Ring(p.y()), Ring(p.z()), 1};
  };
  const ExactLine line = support_line(elements.front());
  if (!low) {
    out.families.push_back({FamilyKind::Complex, 3, {line}, {}, {}, {line}, {}});
  } else if ((*low)[axis] > (*high)[axis]) {
    out.isolated.push_back(line);
  } else if ((*low)[axis] == (*high)[axis]) {
    out.families.push_back({FamilyKind::Star, 2, {}, {point(*low)}, {}, {line}, {}});
  } else {
    out.families.push_back(
        {FamilyKind::Complex, 3, {line}, {point(*low), point(*high)}, {}, {line}, {}});
  }
  return out;
}

// Two elements with different supports.
std::pair<const Element*, const Element*> different_supports(Elements elements) {
  for (const Element& e : elements) {
    if (!same_support(elements.front().line, e.line)) return {&elements.front(), &e};
  }
  return {nullptr, nullptr};
}

// The star through the elements' common point, or the one line along those that miss it.
FourComponents concurrent_components(Elements elements) {
  FourComponents out;
  const auto [e, f] = different_supports(elements);
  const auto p = common_point(e->line, f->line);
  if (!p) return out;
  const Element* missed = nullptr;
  for (const Element& x : elements) {
    if (holds(x, *p)) continue;
    if (missed != nullptr && !same_support(missed->line, x.line)) return out;
    missed = &x;
  }
  if (missed != nullptr) {
    out.isolated.push_back(support_line(*missed));
  } else {
    out.families.push_back({FamilyKind::Star, 2, {}, {*p}, {}, {support_line(*e)}, {}});
  }
  return out;
}

// ---- elements of one plane
// --------------------------------------------------------------

// Lines in a plane, seen along an axis that keeps it a plane.
class InPlane {
 public:
  explicit InPlane(Elements elements) : elements_(elements) {
    const auto [e, f] = different_supports(elements);
    first_ = e;
    second_ = f;
    RingVector n = cross(ring_difference(e->line.to, e->line.from),
                         ring_difference(f->line.to, e->line.from));
    if (is_zero(n[0]) && is_zero(n[1]) && is_zero(n[2])) {
      n = cross(ring_difference(e->line.to, e->line.from),
                ring_difference(f->line.from, e->line.from));
    }
    const int axis = !is_zero(n[0]) ? 0 : !is_zero(n[1]) ? 1 : 2;
    s_ = (axis + 1) % 3;
    t_ = (axis + 2) % 3;
    for (const Element& x : elements) {
      if (!x.bounded) continue;
      Segment segment{};
      for (int k = 0; k < 2; ++k) {
        segment.end[k] = point_index(k == 0 ? x.line.from : x.line.to);
      }
      segments_.push_back(segment);
    }
  }

  FourComponents components() {
    FourComponents out;
    const auto common = common_to_all();
    if (points_.empty()) {  // unbounded lines only
      const auto& l = *first_;
      const auto& m = *second_;
      std::vector<ExactLine> samples{support_line(l), support_line(m)};
      if (common) {
        out.families.push_back(
            {FamilyKind::StarPlane, 2, {}, {*common}, {}, samples, {}});
      } else {
        out.families.push_back({FamilyKind::Plane, 2, {}, {}, {}, samples, {}});
      }
      return out;
    }
    find_vertices();
    find_arcs();
    collect(out);
    if (common) {
      // Every line of the plane that meets all can be moved parallel to itself into the
      // common point, so there is one component.
      assert(out.families.size() == 1 && out.isolated.empty());
      ExactFamily& family = out.families.front();
      const bool plane = family.dimension == 2;
      family.kind = plane ? FamilyKind::StarPlane : FamilyKind::Star;
      family.dimension = 2;
      family.points = {*common};
      if (!plane) family.corners.clear();
    }
    return out;
  }

 private:
  struct Segment {
    int end[2];
  };
  struct Direction {
    Parameter v;  // from the centre: sign times the way to a point
    int point, sign, vertex;
  };

  int point_index(const Eigen::Vector3d& p) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (points_[i] == p) return static_cast<int>(i);
    }
    points_.push_back(p);
    return static_cast<int>(points_.size()) - 1;
  }
  Parameter from_to(int i, int j) const {
    return {Ring(points_[j][s_]) - Ring(points_[i][s_]),
            Ring(points_[j][t_]) - Ring(points_[i][t_])};
  }
  // The side of the line through point i along v on which point j lies.
  Sign side_of(int i, const Parameter& v, int j) const { return order(v, from_to(i, j)); }
  bool in_transversals(int i, const Parameter& v) const {
    return std::ranges::all_of(segments_, [&](const Segment& s) {
      return side_of(i, v, s.end[0]) * side_of(i, v, s.end[1]) != Sign::Positive;
    });
  }

  // The point common to all elements, if any.
  std::optional<Homogeneous> common_to_all() const {
    // Elements with two different supports share at most their common point.
    const auto p = common_point(first_->line, second_->line);
    if (!p) return std::nullopt;
    for (const Element& e : elements_) {
      if (!passes(e.line, *p) || !holds(e, *p)) return std::nullopt;
    }
    return p;
  }
  // A vertex is a line through two end points that meets all; each is found once.
  void find_vertices() {
    const int n = static_cast<int>(points_.size());
    vertex_of_.assign(static_cast<std::size_t>(n * n), -1);
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        if (vertex_of_[i * n + j] >= 0) continue;
        const Parameter v = from_to(i, j);
        const int id = static_cast<int>(vertices_.size());
        vertices_.push_back({i, j, in_transversals(i, v)});
        std::vector<int> on{i, j};
        for (int k = j + 1; k < n; ++k) {
          if (side_of(i, v, k) == Sign::Zero) on.push_back(k);
        }
        for (const int a : on) {
          for (const int b : on) vertex_of_[a * n + b] = id;
        }
      }
    }
    parent_.resize(vertices_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    corner_.assign(vertices_.size(), 0);
  }
  int root(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }

  // Along the pencil of each end point, from vertex to vertex.
  void find_arcs() {
    const int n = static_cast<int>(points_.size());
    for (int i = 0; i < n; ++i) {
      std::vector<Direction> around;
      for (int j = 0; j < n; ++j) {
        if (j == i) continue;
        Parameter v = from_to(i, j);
        const Sign s = sign_of(v[1]);
        const bool back =
            s == Sign::Negative || (s == Sign::Zero && sign_of(v[0]) == Sign::Negative);
        if (back) v = {-v[0], -v[1]};
        around.push_back({v, j, back ? -1 : 1, vertex_of_[i * n + j]});
      }
      std::ranges::sort(around, [](const Direction& a, const Direction& b) {
        return order(a.v, b.v) == Sign::Positive;
      });
      const auto repeats = std::unique(
          around.begin(), around.end(),
          [](const Direction& a, const Direction& b) { return a.vertex == b.vertex; });
      around.erase(repeats, around.end());
      arcs_at(i, around);
    }
  }
  void arcs_at(int centre, const std::vector<Direction>& around) {
    const std::size_t n = around.size();
    std::vector<char> inside(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Direction& a = around[k];
      const Direction& b = around[(k + 1) % n];
      const int turned = k + 1 == n ? -1 : 1;  // round to the first again
      const Parameter between =
          n == 1 ? elsewhere(centre)
                 : Parameter{a.v[0] + b.v[0] * turned, a.v[1] + b.v[1] * turned};
      inside[k] = in_transversals(centre, between);
      if (!inside[k]) continue;
      parent_[root(a.vertex)] = root(b.vertex);
      const ExactLine middle =
          n == 1 ? line_elsewhere(centre)
                 : line_between(centre, a.point, a.sign, b.point, b.sign * turned);
      arcs_.push_back({centre,
                       a.vertex,
                       widens(centre, between),
                       {line_of(a.vertex), middle, line_of(b.vertex)}});
    }
    for (std::size_t k = 0; k < n; ++k) {
      if (inside[k] != inside[(k + n - 1) % n]) corner_[around[k].vertex] = 1;
    }
  }
  // Whether the line can leave the centre to a side and still meet the segments that end
  // there: they all lie on one side.
  bool widens(int centre, const Parameter& v) const {
    bool left = false;
    bool right = false;
    for (const Segment& s : segments_) {
      for (int k = 0; k < 2; ++k) {
        if (s.end[k] != centre) continue;
        const Sign side = side_of(centre, v, s.end[1 - k]);
        left |= side == Sign::Positive;
        right |= side == Sign::Negative;
      }
    }
    return !(left && right);
  }

  // The line through the centre along s (p - centre) + t (q - centre).
  ExactLine line_between(int centre, int p, int s, int q, int t) const {
    const LineThrough from{points_[centre], points_[p]};
    return *joining(from, surds({1, 0}), {points_[p], points_[q]}, surds({s, t}), 0);
  }
  // A point off the line that holds all end points.
  const Eigen::Vector3d& point_elsewhere() const {
    for (const Element* e : {first_, second_}) {
      for (const Eigen::Vector3d* p : {&e->line.from, &e->line.to}) {
        if (!collinear(points_[0], points_[1], *p)) return *p;
      }
    }
    return points_[0];
  }
  Parameter elsewhere(int centre) const {
    const Eigen::Vector3d& p = point_elsewhere();
    return {Ring(p[s_]) - Ring(points_[centre][s_]),
            Ring(p[t_]) - Ring(points_[centre][t_])};
  }
  ExactLine line_elsewhere(int centre) const {
    return ExactLine::through(points_[centre], point_elsewhere());
  }

  ExactLine line_of(int vertex) const {
    return ExactLine::through(points_[vertices_[vertex].i], points_[vertices_[vertex].j]);
  }

  void collect(FourComponents& out) {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      if (!vertices_[v].inside || root(static_cast<int>(v)) != static_cast<int>(v)) {
        continue;
      }
      const int component = static_cast<int>(v);
      ExactFamily family{FamilyKind::Pencil, 0, {}, {}, {}, {}, {}};
      int centre = -1;
      for (const PlaneArc& arc : arcs_) {
        if (root(arc.vertex) != component) continue;
        family.dimension = std::max(family.dimension, arc.wide ? 2 : 1);
        family.arcs.push_back(arc.part);
        if (centre >= 0 && centre != arc.centre) family.kind = FamilyKind::JoinedPencils;
        centre = arc.centre;
      }
      const ExactLine line = line_of(component);
      if (family.dimension == 0) {
        if (meets_all(line, elements_)) out.isolated.push_back(line);
        continue;
      }
      if (family.dimension == 2) family.kind = FamilyKind::Plane;
      family.samples.push_back(family.arcs.front()[1]);
      for (std::size_t w = 0; w < vertices_.size(); ++w) {
        if (!vertices_[w].inside || root(static_cast<int>(w)) != component) continue;
        if (corner_[w]) family.corners.push_back(line_of(static_cast<int>(w)));
      }
      out.families.push_back(std::move(family));
    }
  }

  struct Vertex {
    int i, j;
    bool inside;
  };
  struct PlaneArc {
    int centre, vertex;
    bool wide;
    LineArc part;
  };

  Elements elements_;
  const Element* first_;
  const Element* second_;
  int s_ = 0, t_ = 1;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Segment> segments_;
  std::vector<int> vertex_of_;
  std::vector<Vertex> vertices_;
  std::vector<int> parent_;
  std::vector<char> corner_;
  std::vector<PlaneArc> arcs_;
};

bool all_coplanar(Elements elements) {
  const auto [e, f] = different_supports(elements);
  const Eigen::Vector3d& off =
      collinear(e->line.from, e->line.to, f->line.from) ? f->line.to : f->line.from;
  return std::ranges::all_of(elements, [&, l = e->line](const Element& x) {
    return orient3d(l.from, l.to, off, x.line.from) == Sign::Zero &&
           orient3d(l.from, l.to, off, x.line.to) == Sign::Zero;
  });
}

bool same_lines(const std::vector<ExactLine>& a, const std::vector<ExactLine>& b) {
  return a.size() == b.size() && std::ranges::all_of(a, [&b](const ExactLine& x) {
           return std::ranges::any_of(
               b, [&x](const ExactLine& y) { return same_line(x, y); });
         });
}

bool same_point(const Homogeneous& p, const Homogeneous& q) {
  for (int i = 0; i < 3; ++i) {
    if (!is_zero(p[i] * q[3] - q[i] * p[3])) return false;
  }
  return true;
}

}  // namespace

bool meets(const ExactLine& line, const Element& e) {
  if (e.bounded) return line.meets(e.line) != SegmentContact::None;
  return line.side(e.line) == Sign::Zero &&
         (!line.is_parallel(e.line) || line.meets(e.line) == SegmentContact::Along);
}

namespace {

FourComponents components_of(Elements elements) {
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      if (side(elements[i].line, elements[j].line) == Sign::Zero) continue;
      std::array<int, 2> rest{};
      int k = 0;
      for (int r = 0; r < 4; ++r) {
        if (r != i && r != j) rest[k++] = r;
      }
      return OnSkewPair(elements[i].line, elements[j].line, elements)
          .components(elements[rest[0]], elements[rest[1]]);
    }
  }
  if (different_supports(elements).first == nullptr)
    return collinear_components(elements);
  if (!all_coplanar(elements)) return concurrent_components(elements);
  return InPlane(elements).components();
}

// One line of the arc runs along the element, so the arc is part of a pencil and the
// others meet the element in its centre, all in one point.
bool along_element(const LineArc& arc, const Element& e) {
  std::vector<const ExactLine*> across;
  for (const ExactLine& line : arc) {
    if (line.meets(e.line) != SegmentContact::Along) across.push_back(&line);
  }
  for (std::size_t i = 1; i < across.size(); ++i) {
    if (compare_along(e.line, *across[0], *across[i]) != Sign::Zero) return false;
  }
  return true;
}

// Along an arc the place of the contact on an element's line is a projective function, so
// the places on the arc are those from the first to the last over that of the middle.
bool all_meet(const LineArc& arc, const Element& e) {
  if (!std::ranges::all_of(arc, [&e](const ExactLine& line) {
        return closure_meets(line, {&e, 1});
      })) {
    return false;
  }
  if (!e.bounded) return true;
  if (std::ranges::any_of(arc, [&e](const ExactLine& line) {
        return line.meets(e.line) == SegmentContact::Along;
      })) {
    return along_element(arc, e);
  }
  return compare_along(e.line, arc[0], arc[1]) == compare_along(e.line, arc[1], arc[2]);
}

}  // namespace

FourComponents components_of(const FourElements& elements) {
  FourComponents out = components_of(Elements(elements));
  for (ExactFamily& family : out.families) {
    family.elements.assign(elements.begin(), elements.end());
  }
  return out;
}

bool all_meet(const ExactFamily& family, const Element& e) {
  for (const Homogeneous& p : family.points) {
    if (!passes(e.line, p) || !holds(e, p)) return false;
  }
  const auto meets_it = [&e](const ExactLine& line) { return meets(line, e); };
  switch (family.kind) {
    case FamilyKind::Star:
      return true;
    case FamilyKind::Complex:
      return (!family.points.empty() || !e.bounded) &&
             family.samples[0].meets(e.line) == SegmentContact::Along;
    case FamilyKind::Congruence:
      return std::ranges::all_of(family.corners, meets_it) &&
             std::ranges::all_of(family.samples, meets_it);
    default:
      break;
  }
  if (family.arcs.empty()) return std::ranges::all_of(family.samples, meets_it);
  return std::ranges::all_of(family.arcs,
                             [&e](const LineArc& arc) { return all_meet(arc, e); });
}

bool same_family(const ExactFamily& a, const ExactFamily& b) {
  if (a.kind != b.kind || a.dimension != b.dimension ||
      a.points.size() != b.points.size()) {
    return false;
  }
  for (const Homogeneous& p : a.points) {
    if (std::ranges::none_of(b.points,
                             [&p](const Homogeneous& q) { return same_point(p, q); })) {
      return false;
    }
  }
  // Different circles of lines can share their ends, and so can two arcs of one circle.
  const auto within = [](const ExactFamily& x, const ExactFamily& y) {
    return std::ranges::all_of(x.arcs, [&y](const LineArc& arc) {
      return std::ranges::all_of(
          arc, [&y](const ExactLine& l) { return closure_meets(l, y.elements); });
    });
  };
  return same_lines(a.corners, b.corners) && within(a, b) && within(b, a);
}

}  // namespace sightline::internal
