#include "shadows/planar/arcs/candidate_pairs.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "shadows/planar/arcs/arc_box.h"

namespace sightline::internal {
namespace {

// Cells of equal size over the box of all arcs.
struct Frame {
  PointRange box;
  int size = 1;

  [[nodiscard]] static int index(double x, const DoubleRange& r, int size) {
    const double share = (x - r.lo) / (r.hi - r.lo) * size;
    return std::clamp(static_cast<int>(share), 0, size - 1);
  }
  // The cells that a box may touch: the rounding of index() is monotone.
  [[nodiscard]] std::array<int, 4> cells(const PointRange& b) const {
    return {index(b.x.lo, box.x, size), index(b.x.hi, box.x, size),
            index(b.y.lo, box.y, size), index(b.y.hi, box.y, size)};
  }
};

// Appends the cells of a stretch of an arc.
void append_cells(const PlaneSupport& support, const DoubleRange& s, const Frame& frame,
                  int depth, std::vector<int>& out) {
  constexpr int kMostDepth = 12;
  const std::optional<PointRange> box = box_of(support, s);
  if (!box && depth < 2 * kMostDepth) {
    append_cells(support, {s.lo, s.middle()}, frame, depth + 1, out);
    append_cells(support, {s.middle(), s.hi}, frame, depth + 1, out);
    return;
  }
  const std::array<int, 4> c = frame.cells(box ? *box : frame.box);
  const int wide = c[1] - c[0], high = c[3] - c[2];
  const bool small = std::min(wide, high) == 0 || std::max(wide, high) == 1;
  if (!small && depth < kMostDepth) {
    append_cells(support, {s.lo, s.middle()}, frame, depth + 1, out);
    append_cells(support, {s.middle(), s.hi}, frame, depth + 1, out);
    return;
  }
  for (int y = c[2]; y <= c[3]; ++y) {
    for (int x = c[0]; x <= c[1]; ++x) out.push_back(y * frame.size + x);
  }
}

Frame frame_of(const PlaneArcs& all) {
  Frame frame;
  // Ends alone: what lies further out is counted to the cells at the rim.
  frame.box = {all.arcs[0].ends[0].box_x, all.arcs[0].ends[0].box_y};
  for (const PlaneArc& arc : all.arcs) {
    for (const ArcEnd& end : arc.ends) {
      frame.box.x = {std::min(frame.box.x.lo, end.box_x.lo),
                     std::max(frame.box.x.hi, end.box_x.hi)};
      frame.box.y = {std::min(frame.box.y.lo, end.box_y.lo),
                     std::max(frame.box.y.hi, end.box_y.hi)};
    }
  }
  constexpr double kCellsPerArc = 2;
  constexpr int kMostCells = 1024;
  const double count = kCellsPerArc * static_cast<double>(all.arcs.size());
  frame.size = std::clamp(static_cast<int>(std::sqrt(count)), 1, kMostCells);
  return frame;
}

}  // namespace

ArcGrid::ArcGrid(const PlaneArcs& all) : cells_of_arc_(all.arcs.size()) {
  const Frame frame = frame_of(all);
  oneapi::tbb::parallel_for(std::size_t{0}, all.arcs.size(), [&](std::size_t i) {
    const PlaneArc& arc = all.arcs[i];
    std::vector<int>& cells = cells_of_arc_[i];
    append_cells(all.supports[arc.support],
                 {arc.ends[0].at.range.lo, arc.ends[1].at.range.hi}, frame, 0, cells);
    std::ranges::sort(cells);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  });
  arcs_of_cell_.resize(static_cast<std::size_t>(frame.size) * frame.size);
  for (std::size_t i = 0; i < all.arcs.size(); ++i) {
    for (const int cell : cells_of_arc_[i]) {
      arcs_of_cell_[cell].push_back(static_cast<int>(i));
    }
  }
}

std::vector<int> ArcGrid::partners(int a) const {
  std::vector<int> found;
  for (const int cell : cells_of_arc_[a]) {
    const std::vector<int>& arcs = arcs_of_cell_[cell];
    found.insert(found.end(), std::ranges::upper_bound(arcs, a), arcs.end());
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace sightline::internal
