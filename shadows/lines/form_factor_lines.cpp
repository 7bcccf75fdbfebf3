#include "shadows/form_factor_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "linespace/line_sampling.h"
#include "linespace/work/parallel.h"
#include "shadows/factors/factor_sides.h"
#include "shadows/lines/line_layers.h"
#include "shadows/lines/pair_tally.h"

namespace sightline {
namespace {

using namespace internal;

constexpr std::int64_t kBlock = 2048;  // lines
/// Beside Elsewhere: the part of kOutside that rises.
constexpr int kSky = kOutside - 1;

/// What sides of faces are to each other.
class LineMatrix {
 public:
  LineMatrix(const Scene& scene, std::span<const FormFactorSurface> surfaces,
             const FormFactorLinesRequest& request)
      : faces_(scene),
        body_(scene.bounds()[0], scene.bounds()[1]),
        surfaces_(2 * scene.faces().size()),
        request_(request) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      double area = 0;
      for (const int f : surfaces[i].faces) {
        surfaces_[2 * f + (surfaces[i].back ? 1 : 0)].push_back(static_cast<int>(i));
        area += area_of(listed_polygon(scene, f, surfaces[i].back));
      }
      areas_.push_back(area);
    }
  }

  [[nodiscard]] const LineFaces& faces() const { return faces_; }
  [[nodiscard]] const std::vector<double>& areas() const { return areas_; }
  /// Of all oriented lines drawn, over pi: scene units squared.
  [[nodiscard]] double drawn_area() const { return body_.surface(); }

  /// Of lines from ... to - 1.
  [[nodiscard]] std::vector<PairCount> block(LineWalker& walker, std::int64_t from,
                                             std::int64_t to) const {
    std::vector<PairCount> all, of_line;
    for (std::int64_t i = from; i < to; ++i) {
      hear_stop();
      SampleNumbers numbers(request_.seed, static_cast<std::uint64_t>(i));
      of_line.clear();
      count_line(walker, body_.line(numbers), of_line);
      add_up(of_line);
      for (PairCount& c : of_line) {
        c.squares = c.count * c.count;
        all.push_back(c);
      }
    }
    add_up(all);
    return all;
  }

 private:
  /// The sides of a layer that face the gap beyond it, or the one before it: surfaces,
  /// kOthers for the front of a face that is of none, kBacks for a back.
  void sides(const LineLayer& layer, bool beyond, std::vector<int>& of) const {
    of.clear();
    for (const LineHit& hit : layer.hits) {
      const bool front = hit.from_front != beyond;
      const bool listed = front != faces_.scene().turned(hit.face);
      const std::vector<int>& surfaces = surfaces_[2 * hit.face + (listed ? 0 : 1)];
      of.insert(of.end(), surfaces.begin(), surfaces.end());
      if (surfaces.empty()) of.push_back(listed ? kOthers : kBacks);
    }
  }
  /// What arrives from one layer at the next, or nowhere.
  static void count_way(const std::vector<int>& from, const std::vector<int>& to,
                        bool material, std::vector<PairCount>& counts) {
    for (const int i : from) {
      if (i < 0) continue;
      bool front = false;
      for (const int j : to) {
        if (material || j == kBacks) continue;
        counts.push_back({i, j, 1, 0});
        front = true;
      }
      if (!front) counts.push_back({i, kBacks, 1, 0});
    }
  }
  void count_leaving(const std::vector<int>& from, const Eigen::Vector3d& along,
                     std::vector<PairCount>& counts) const {
    for (const int i : from) {
      if (i < 0) continue;
      counts.push_back({i, kOutside, 1, 0});
      if (request_.up && along.dot(*request_.up) > 0) counts.push_back({i, kSky, 1, 0});
    }
  }
  /// Both ways along the line.
  void count_line(LineWalker& walker, const Chord& line,
                  std::vector<PairCount>& counts) const {
    const auto layers = walker.layers(line);
    if (layers.empty()) return;
    const Eigen::Vector3d along = line.to - line.from;
    std::vector<int> before, beyond, next;
    sides(layers.front(), false, before);
    count_leaving(before, -along, counts);
    for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
      sides(layers[k], true, beyond);
      sides(layers[k + 1], false, next);
      count_way(beyond, next, layers[k].material_beyond, counts);
      count_way(next, beyond, layers[k].material_beyond, counts);
    }
    sides(layers.back(), true, beyond);
    count_leaving(beyond, along, counts);
  }

  LineFaces faces_;
  ConvexBodyLines body_;
  std::vector<std::vector<int>> surfaces_;  // of both sides of each face
  std::vector<double> areas_;
  const FormFactorLinesRequest& request_;
};

/// Sums of counts become shares, with their standard errors.
class LineRows {
 public:
  LineRows(std::int64_t lines, double drawn_area, FormFactorLines& result)
      : lines_(static_cast<double>(lines)), result_(result) {
    // Each line is followed both ways, which gives two estimates.
    result.area_per_line = drawn_area / (2 * lines_);
    result.lines = lines;
    result.factors.rows.resize(result.factors.areas.size());
    result.errors.resize(result.factors.areas.size());
  }
  void add(const PairCount& c) {
    const double unit = result_.area_per_line / result_.factors.areas[c.from];
    const auto n = static_cast<double>(c.count), squares = static_cast<double>(c.squares);
    const double value = unit * n;
    // The deviation of a sum of as many independent counts as there are lines.
    const double variance = lines_ / (lines_ - 1) * (squares - n * n / lines_);
    const double error = unit * std::sqrt(std::max(0.0, variance));
    FormFactorRow& row = result_.factors.rows[c.from];
    FormFactorErrors& errors = result_.errors[c.from];
    switch (c.to) {
      case kOthers:
        row.others = value, errors.others = error;
        break;
      case kBacks:
        row.backs = value, errors.backs = error;
        break;
      case kOutside:
        row.outside = value, errors.outside = error;
        break;
      case kSky:
        row.sky = value, errors.sky = error;
        break;
      default:
        row.to.push_back(c.to);
        row.factor.push_back(value);
        errors.factor.push_back(error);
    }
  }

 private:
  double lines_;
  FormFactorLines& result_;
};

}  // namespace

FormFactorLines form_factors_by_lines(const Scene& scene,
                                      std::span<const FormFactorSurface> surfaces,
                                      const FormFactorLinesRequest& request) {
  if (request.lines < 2) {
    throw InvalidInput("form factors by lines: at least two lines are needed");
  }
  const Deadline deadline(request);
  Stage stage(request, "surfaces", deadline);
  const LineMatrix matrix(scene, surfaces, request);
  FormFactorLines result;
  for (const FormFactorSurface& s : surfaces) result.factors.names.push_back(s.name);
  result.factors.areas = matrix.areas();
  result.factors.coincident_area = coincident_area(scene);
  stage.check(1);

  PairTally tally;
  std::int64_t drawn = 0;
  const std::int64_t blocks = (request.lines - 1) / kBlock + 1;
  const StoppedBy by = for_each_parallel(
      static_cast<std::size_t>(blocks), request, deadline, "lines",
      result.factors.predicates,
      [&] { return std::make_unique<LineWalker>(matrix.faces()); },
      [&](LineWalker& walker, std::size_t b) {
        const std::int64_t from = kBlock * static_cast<std::int64_t>(b);
        return matrix.block(walker, from, std::min(from + kBlock, request.lines));
      },
      [&](std::size_t b, const std::vector<PairCount>& counts) {
        tally.add(counts);
        drawn = std::min(kBlock * (static_cast<std::int64_t>(b) + 1), request.lines);
        return true;
      });
  if (drawn < 2) throw Stopped("lines", 0);
  result.factors.complete = by == StoppedBy::Nothing;
  LineRows rows(drawn, matrix.drawn_area(), result);
  for (const PairCount& c : tally.sums()) rows.add(c);
  return result;
}

}  // namespace sightline
