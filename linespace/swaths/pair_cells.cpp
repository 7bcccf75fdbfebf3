#include "linespace/swaths/pair_cells.h"

#include <algorithm>
#include <cmath>

namespace sightline::internal {
namespace {

// A cell is left whole after so many halvings, or when so few faces are left: speed only.
constexpr int kDeepest = 8;
constexpr std::size_t kFewFaces = 8;

// Certain signs at some positions; `neutral`: where the value is zero exactly, at an end
// of an edge.
template <std::size_t N>
struct Signs {
  std::array<Sign, N> at;
  unsigned neutral = 0;

  /// The sign of all that are not neutral, Zero when they differ or are not certain.
  [[nodiscard]] Sign common() const {
    Sign all = Sign::Zero;
    for (unsigned i = 0; i < N; ++i) {
      if ((neutral >> i & 1u) != 0) continue;
      if (at[i] == Sign::Zero || (all != Sign::Zero && at[i] != all)) return Sign::Zero;
      all = at[i];
    }
    return all;
  }
};

// Positions are exact, so each value is off by three roundings beside the error of the
// ends.
Signs<2> signs(const PairCells::Linear& l, double x0, double x1) {
  const double d = l.at1 - l.at0;
  const double error = l.error + 4 * kUnit * (std::abs(l.at0) + std::abs(l.at1));
  Signs<2> out{
      {certain_sign(l.at0 + d * x0, error), certain_sign(l.at0 + d * x1, error)}};
  if (l.zero0 && x0 == 0) out.neutral |= 1;
  if (l.zero1 && x1 == 1) out.neutral |= 2;
  return out;
}

// Zero exactly, as both or one of the values it is interpolated from.
bool vanishes(const BoundedForm& form, double s, double t) {
  const auto& z = form.zero;
  const auto between = [](double x, bool at0, bool at1) {
    return x == 0 ? at0 : x == 1 ? at1 : at0 && at1;
  };
  if (s == 0) return between(t, z[0][0], z[0][1]);
  if (s == 1) return between(t, z[1][0], z[1][1]);
  if (t == 0) return z[0][0] && z[1][0];
  return t == 1 && z[0][1] && z[1][1];
}

// A form at the corners (s0, t0), (s0, t1), (s1, t0), (s1, t1) of a cell.  Two rounds of
// interpolation, of three roundings each.
struct AtCorners {
  std::array<double, 4> value;
  double error;

  AtCorners(const BoundedForm& form, double s0, double s1, double t0, double t1)
      : error(form.error + 24 * kUnit * form.largest) {
    const auto& f = form.f;
    const double d0 = f[0][1] - f[0][0];
    const double d1 = f[1][1] - f[1][0];
    const double low0 = f[0][0] + d0 * t0;
    const double low1 = f[0][0] + d0 * t1;
    const double up0 = (f[1][0] + d1 * t0) - low0;
    const double up1 = (f[1][0] + d1 * t1) - low1;
    value = {low0 + up0 * s0, low1 + up1 * s0, low0 + up0 * s1, low1 + up1 * s1};
  }

  // Most often they are of one sign without a doubt, Zero when not.
  [[nodiscard]] Sign common() const {
    const double least = std::min({value[0], value[1], value[2], value[3]});
    const double largest = std::max({value[0], value[1], value[2], value[3]});
    return least > error      ? Sign::Positive
           : largest < -error ? Sign::Negative
                              : Sign::Zero;
  }
};

Signs<4> signs(const AtCorners& v, const BoundedForm& form, double s0, double s1,
               double t0, double t1) {
  Signs<4> out{{certain_sign(v.value[0], v.error), certain_sign(v.value[1], v.error),
                certain_sign(v.value[2], v.error), certain_sign(v.value[3], v.error)}};
  for (unsigned c = 0; c < 4; ++c) {
    if (out.at[c] == Sign::Zero &&
        vanishes(form, (c & 2u) != 0 ? s1 : s0, (c & 1u) != 0 ? t1 : t0)) {
      out.neutral |= 1u << c;
    }
  }
  return out;
}

// No line from that part of the other edge touches this one.
bool never_touched(const PairCells::Edge& edge, double x0, double x1) {
  const Sign a = signs(edge.planes[0], x0, x1).common();
  return a != Sign::Zero && !edge.touched_on[a == Sign::Positive ? 1 : 0] &&
         a == signs(edge.planes[1], x0, x1).common();
}

}  // namespace

void PairCells::begin(const Edge& first, const Edge& last) {
  first_ = first;
  last_ = last;
  faces_.clear();
  sides_.clear();
  occluders_.clear();
  leaves_.clear();
  leaf_faces_.clear();
  middles_.clear();
}

void PairCells::add_face(int face, std::int64_t occluder, bool front_only,
                         const Linear& p, const Linear& q, std::span<const Side> sides) {
  // Of the last few: faces of one solid come near each other.
  auto at = std::find(occluders_.rbegin(), occluders_.rend(), occluder);
  if (at == occluders_.rend()) {
    occluders_.push_back(occluder);
    at = occluders_.rbegin();
  }
  const auto number = static_cast<std::int32_t>(occluders_.rend() - at - 1);
  faces_.push_back({face, number, front_only, p, q,
                    static_cast<std::uint32_t>(sides_.size()),
                    static_cast<std::uint32_t>(sides.size())});
  sides_.insert(sides_.end(), sides.begin(), sides.end());
}

int PairCells::divide(double s0, double s1, const std::function<bool(int)>& is_middle) {
  is_middle_ = &is_middle;
  masks_.resize(occluders_.size());
  list_.resize(faces_.size());
  for (std::size_t i = 0; i < list_.size(); ++i) list_[i] = static_cast<std::int32_t>(i);
  const int depth = -std::ilogb(s1 - s0);  // as if halved so often
  const Cell cell = visible({s0, s1, 0, 1});
  if (!(cell.s0 < cell.s1 && cell.t0 < cell.t1)) return -1;
  return visit(cell, depth, 0, list_.size());
}

// The part of the cell in which lines may be free.
PairCells::Cell PairCells::visible(const Cell& cell) const {
  return {std::max(cell.s0, first_.visible[0]), std::min(cell.s1, first_.visible[1]),
          std::max(cell.t0, last_.visible[0]), std::min(cell.t1, last_.visible[1])};
}

void PairCells::hide(double s0, double s1, std::int64_t occluder) {
  Leaf leaf{{s0, s1, 0, 1}, static_cast<std::uint32_t>(leaf_faces_.size()), 0, true};
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (occluders_[faces_[i].occluder] == occluder) {
      leaf_faces_.push_back(static_cast<std::int32_t>(i));
    }
  }
  leaf.count = static_cast<std::uint32_t>(leaf_faces_.size()) - leaf.first;
  leaves_.push_back(leaf);
}

void PairCells::finish() {
  std::sort(middles_.begin(), middles_.end());
  middles_.erase(std::unique(middles_.begin(), middles_.end()), middles_.end());
}

// nullopt: no segment inside the cell touches the face from the side it can be entered.
// Else the corners, and the face's sides that change sign are added to mixed_.
std::optional<PairCells::Corners> PairCells::passage(const Face& face, const Cell& cell) {
  const auto p = signs(face.p, cell.s0, cell.s1);
  const auto q = signs(face.q, cell.t0, cell.t1);
  const Sign p_all = p.common();
  const Sign q_all = q.common();
  if (p_all != Sign::Zero && p_all == q_all) return std::nullopt;
  Sign entry = p_all != Sign::Zero ? p_all : -q_all;
  if (face.front_only) {
    if (entry == Sign::Negative) return std::nullopt;
    entry = Sign::Positive;
  }
  Corners corners;
  for (unsigned c = 0; c < 4; ++c) {
    if (entry != Sign::Zero && p.at[c >> 1] == entry && q.at[c & 1] == -entry) {
      corners.inside |= 1u << c;
    }
  }
  corners.closed = corners.inside;
  const std::size_t mixed = mixed_.size();
  for (const Side& side : std::span(sides_).subspan(face.first_side, face.side_count)) {
    // As EdgePairs::block(): from front to back, sides have negative forms.
    const Sign wanted = side.forward ? -entry : entry;
    const AtCorners values(*side.form, cell.s0, cell.s1, cell.t0, cell.t1);
    const Sign certain = values.common();
    if (certain != Sign::Zero && (entry == Sign::Zero || certain == wanted)) continue;
    const auto s = signs(values, *side.form, cell.s0, cell.s1, cell.t0, cell.t1);
    const Sign all = s.common();
    if (all != Sign::Zero && entry != Sign::Zero && all != wanted) {
      mixed_.resize(mixed);
      return std::nullopt;
    }
    for (unsigned c = 0; c < 4; ++c) {
      if (s.at[c] == wanted) continue;
      corners.inside &= ~(1u << c);
      if ((s.neutral >> c & 1u) == 0) corners.closed &= ~(1u << c);
    }
    if (all == Sign::Zero && side.middle >= 0) mixed_.push_back(side.middle);
  }
  return corners;
}

void PairCells::add_leaf(const Cell& cell, std::size_t begin, int occluder) {
  Leaf leaf{cell, static_cast<std::uint32_t>(leaf_faces_.size()), 0, occluder >= 0};
  for (std::size_t k = begin; k < list_.size(); ++k) {
    if (occluder < 0 || faces_[list_[k]].occluder == occluder) {
      leaf_faces_.push_back(list_[k]);
    }
  }
  leaf.count = static_cast<std::uint32_t>(leaf_faces_.size()) - leaf.first;
  leaves_.push_back(leaf);
}

// A face of the occluder that hides all of the cell, or -1.
int PairCells::visit(const Cell& cell, int depth, std::size_t begin, std::size_t end) {
  if (never_touched(first_, cell.t0, cell.t1) || never_touched(last_, cell.s0, cell.s1)) {
    return -1;
  }
  const std::size_t kept = list_.size();
  mixed_.clear();
  for (std::size_t k = begin; k < end; ++k) masks_[faces_[list_[k]].occluder] = {};
  for (std::size_t k = begin; k < end; ++k) {
    const std::int32_t i = list_[k];
    const Face& face = faces_[i];
    const auto corners = passage(face, cell);
    if (!corners) continue;
    list_.push_back(i);
    masks_[face.occluder].closed |= corners->closed;
    masks_[face.occluder].inside |= corners->inside;
  }
  for (std::size_t k = kept; k < list_.size(); ++k) {
    const Face& face = faces_[list_[k]];
    const Corners& corners = masks_[face.occluder];
    if (corners.closed != 15 || corners.inside == 0) continue;
    add_leaf(cell, kept, face.occluder);
    list_.resize(kept);
    return face.id;
  }
  std::sort(mixed_.begin(), mixed_.end());
  mixed_.erase(std::unique(mixed_.begin(), mixed_.end()), mixed_.end());
  std::erase_if(mixed_, [&](int m) { return !(*is_middle_)(m); });
  if (!mixed_.empty()) {
    if (depth >= kDeepest || list_.size() - kept <= kFewFaces) {
      middles_.insert(middles_.end(), mixed_.begin(), mixed_.end());
      add_leaf(cell, kept, -1);
    } else {
      // Across the longer part of the two edges.
      const std::size_t last = list_.size();
      if ((cell.s1 - cell.s0) * first_.length > (cell.t1 - cell.t0) * last_.length) {
        const double s = 0.5 * (cell.s0 + cell.s1);
        visit({cell.s0, s, cell.t0, cell.t1}, depth + 1, kept, last);
        visit({s, cell.s1, cell.t0, cell.t1}, depth + 1, kept, last);
      } else {
        const double t = 0.5 * (cell.t0 + cell.t1);
        visit({cell.s0, cell.s1, cell.t0, t}, depth + 1, kept, last);
        visit({cell.s0, cell.s1, t, cell.t1}, depth + 1, kept, last);
      }
    }
  }
  list_.resize(kept);
  return -1;
}

bool PairCells::faces_along(const BoundedForm& form, bool turned, double from, double to,
                            std::vector<std::int32_t>& faces) {
  faces.clear();
  if (stamps_.size() < faces_.size()) stamps_.resize(faces_.size(), 0);
  ++stamp_;
  bool open = false;
  for (const Leaf& leaf : leaves_) {
    const Cell c =
        turned ? Cell{leaf.cell.t0, leaf.cell.t1, leaf.cell.s0, leaf.cell.s1} : leaf.cell;
    if (to < c.s0 || from > c.s1) continue;
    const AtCorners values(form, c.s0, c.s1, c.t0, c.t1);
    if (values.common() != Sign::Zero ||
        signs(values, form, c.s0, c.s1, c.t0, c.t1).common() != Sign::Zero) {
      continue;
    }
    open |= !leaf.hidden;
    for (std::uint32_t k = 0; k < leaf.count; ++k) {
      const std::int32_t i = leaf_faces_[leaf.first + k];
      if (stamps_[i] == stamp_) continue;
      stamps_[i] = stamp_;
      faces.push_back(faces_[i].id);
    }
  }
  return open;
}

}  // namespace sightline::internal
