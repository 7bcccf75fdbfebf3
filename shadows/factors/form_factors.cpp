#include "shadows/form_factors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "linespace/work/parallel.h"
#include "shadows/factors/exchange_geometry.h"
#include "shadows/factors/factor_sides.h"
#include "shadows/factors/pair_factor.h"

namespace sightline {
namespace {

using namespace internal;

/// What a part of a row finds: its entries from the diagonal on, and the rest.
struct RowPart {
  struct Entry {
    int to;
    double exchange;  ///< scene units squared
    double error;
  };
  std::vector<Entry> entries;
  double others = 0, outside = 0, backs = 0, sky = 0;  ///< exchange areas
  double error = 0, sky_error = 0;                     ///< of others, outside and backs
  PairCounts counts;
};

/// What one thread does at a time: a part of a side; all of a small one.
struct Task {
  int side;
  std::optional<SenderPart> part;
};

/// All that the rows share.
class Matrix {
 public:
  Matrix(const Scene& scene, std::span<const FormFactorSurface> surfaces,
         const FormFactorRequest& request)
      : accuracy_(request.accuracy / kMargin),
        up_(request.up),
        scene_(factor_scene(scene, surfaces)),
        blockers_(scene, scene_),
        parts_(blockers_.solids()) {
    for (const FactorSide& s : scene_.sides) sides_.emplace_back(s);
    for (const FactorSide& s : scene_.elsewhere) elsewhere_.emplace_back(s);
    for (const PreparedSide& s : sides_) {
      solid_of_.push_back(s.object < 0 ? -1 : blockers_.solids().of_object(s.object));
    }
    first_.assign(surfaces.size() + 1, 0);
    for (const PreparedSide& s : sides_) ++first_[s.of + 1];
    for (std::size_t i = 0; i < surfaces.size(); ++i) first_[i + 1] += first_[i];
  }

  [[nodiscard]] const FactorScene& scene() const { return scene_; }
  [[nodiscard]] const PairBlockers& blockers() const { return blockers_; }
  [[nodiscard]] int sides() const { return static_cast<int>(sides_.size()); }
  [[nodiscard]] int surface_of(int side) const { return sides_[side].of; }

  [[nodiscard]] bool is_large(int side) const { return parts_.is_large(sides_[side]); }
  [[nodiscard]] std::vector<SenderPart> parts(int side) const {
    return parts_.of(sides_[side]);
  }

  [[nodiscard]] RowPart row_part(PairFactor& pairs, const Task& task) const {
    RowPart part;
    if (task.part) {
      add(pairs, *task.part, task.side, part);
    } else {
      for (const SenderPart& p : parts_.of(sides_[task.side])) {
        add(pairs, p, task.side, part);
      }
    }
    part.counts = pairs.counts();
    return part;
  }

 private:
  /// Entries are asked for so much more exactly than told, so that the sums of rows are
  /// as exact as entries.
  static constexpr double kMargin = 8;

  void add(PairFactor& pairs, const SenderPart& from, int side, RowPart& part) const {
    const int i = sides_[side].of;
    for (int j = i; j + 1 < static_cast<int>(first_.size()); ++j) {
      add_entry(pairs, from, side, j, part);
    }
    add_elsewhere(pairs, from, part);
  }
  void add_entry(PairFactor& pairs, const SenderPart& from, int side, int j,
                 RowPart& part) const {
    const int i = from.side.of;
    std::vector<int> facing_sides;
    for (int t = i == j ? side + 1 : first_[j]; t < first_[j + 1]; ++t) {
      if (from.hides(solid_of_[t])) continue;
      if (facing(from.side, sides_[t])) facing_sides.push_back(t);
    }
    if (facing_sides.empty()) return;
    const double ways = i == j ? 2 : 1;
    const double tolerance = accuracy_ * std::min(scene_.areas[i], scene_.areas[j]) *
                             share_of(from) /
                             (ways * static_cast<double>(facing_sides.size()));
    RowPart::Entry entry{j, 0, 0};
    for (const int t : facing_sides) {
      hear_stop();
      const ExchangeArea e = pairs.of(from, sides_[t], tolerance);
      entry.exchange += ways * e.value;
      entry.error += ways * e.error;
    }
    if (entry.exchange != 0) part.entries.push_back(entry);
  }
  /// Of the surface's area.
  [[nodiscard]] double share_of(const SenderPart& from) const {
    return from.side.area / scene_.areas[from.side.of];
  }
  void add_elsewhere(PairFactor& pairs, const SenderPart& from, RowPart& part) const {
    for (const int what : {kOthers, kBacks, kOutside}) {
      std::vector<int> facing_sides;
      for (std::size_t t = 0; t < elsewhere_.size(); ++t) {
        if (elsewhere_[t].of == what && facing(from.side, elsewhere_[t])) {
          facing_sides.push_back(static_cast<int>(t));
        }
      }
      if (facing_sides.empty()) continue;
      const double tolerance =
          accuracy_ * from.side.area / static_cast<double>(facing_sides.size());
      double& sum = what == kOthers  ? part.others
                    : what == kBacks ? part.backs
                                     : part.outside;
      for (const int t : facing_sides) {
        hear_stop();
        const ExchangeArea e = pairs.of(from, elsewhere_[t], tolerance);
        sum += e.value;
        part.error += e.error;
        if (!up_ || what != kOutside) continue;
        const ExchangeArea sky = rising_part(pairs, from, elsewhere_[t], e, tolerance);
        part.sky += sky.value;
        part.sky_error += sky.error;
      }
    }
  }

  /// Of what leaves through a window.
  [[nodiscard]] ExchangeArea rising_part(PairFactor& pairs, const SenderPart& from,
                                         const PreparedSide& window,
                                         const ExchangeArea& all,
                                         double tolerance) const {
    const auto c = spanning_corners(from.side.polygon);
    const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    const Eigen::Vector3d up = up_->normalized();
    // A side that faces straight up or down has the same horizon.
    constexpr double kParallel = 1e-14;
    if (normal.cross(up).norm() > kParallel)
      return pairs.rising(from, window, up, tolerance);
    return normal.dot(up) > 0 ? all : ExchangeArea{};
  }

  double accuracy_;
  std::optional<Eigen::Vector3d> up_;
  FactorScene scene_;
  PairBlockers blockers_;
  SenderParts parts_;
  std::vector<PreparedSide> sides_, elsewhere_;
  std::vector<int> solid_of_;  // of each side of a surface; -1: none
  std::vector<int> first_;     // side of each surface
};

/// Adds up the parts of rows, one row after the other, in little memory.
class RowSums {
 public:
  RowSums(const FactorScene& scene, const std::optional<Eigen::Vector3d>& up,
          FormFactors& result)
      : scene_(scene), up_(up), result_(result), sums_(scene.areas.size()) {}

  void add(const RowPart& part) {
    for (const RowPart::Entry& e : part.entries) {
      Sum& sum = sums_[e.to];
      if (sum.exchange == 0) found_.push_back(e.to);
      sum.exchange += e.exchange;
      sum.error += e.error;
    }
    others_ += part.others;
    outside_ += part.outside;
    backs_ += part.backs;
    sky_ += part.sky;
    error_ += part.error;
    sky_error_ += part.sky_error;
    result_.pairs += part.counts.pairs;
    result_.open += part.counts.open;
    result_.partial += part.counts.partial;
  }
  /// All parts of the next row were added.
  void end_row() {
    const auto i = rows_.size();
    const double area = result_.areas[i];
    std::ranges::sort(found_);
    Row row;
    row.to = found_;
    row.exchange.reserve(found_.size());
    for (const int j : found_) {
      const double least = std::min(area, result_.areas[j]);
      row.exchange.push_back(sums_[j].exchange);
      result_.error_bound = std::max(result_.error_bound, sums_[j].error / least);
      sums_[j] = {};
    }
    rows_.push_back(std::move(row));
    FormFactorRow rest;
    rest.others = others_ / area;
    rest.outside = (outside_ + scene_.leaving[i]) / area;
    rest.backs = (backs_ + scene_.buried[i]) / area;
    const double leaving =
        up_ ? scene_.leaving_upwards(static_cast<int>(i), up_->normalized()) : 0;
    rest.sky = (sky_ + leaving) / area;
    result_.error_bound =
        std::max(result_.error_bound, std::max(error_, sky_error_) / area);
    result_.rows.push_back(std::move(rest));
    found_.clear();
    others_ = outside_ = backs_ = sky_ = error_ = sky_error_ = 0;
  }
  /// Both entries of each pair, for rows that ended.
  void fill_rows() {
    std::vector<std::size_t> sizes(rows_.size(), 0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (const int j : rows_[i].to) {
        ++sizes[i];
        const auto other = static_cast<std::size_t>(j);
        if (other != i && other < sizes.size()) ++sizes[other];
      }
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      result_.rows[i].to.reserve(sizes[i]);
      result_.rows[i].factor.reserve(sizes[i]);
    }
    // Entries to the left of the diagonal are added by the rows before.
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row row = std::move(rows_[i]);
      for (std::size_t k = 0; k < row.to.size(); ++k) {
        const auto j = static_cast<std::size_t>(row.to[k]);
        add_entry(i, j, row.exchange[k]);
        if (j != i && j < rows_.size()) add_entry(j, i, row.exchange[k]);
      }
    }
  }

 private:
  struct Sum {
    double exchange = 0, error = 0;
  };
  /// From the diagonal on.
  struct Row {
    std::vector<int> to;
    std::vector<double> exchange;
  };
  void add_entry(std::size_t from, std::size_t to, double exchange) {
    result_.rows[from].to.push_back(static_cast<int>(to));
    result_.rows[from].factor.push_back(exchange / result_.areas[from]);
  }

  const FactorScene& scene_;
  const std::optional<Eigen::Vector3d>& up_;
  FormFactors& result_;
  std::vector<Sum> sums_;
  std::vector<int> found_;
  double others_ = 0, outside_ = 0, backs_ = 0, sky_ = 0, error_ = 0, sky_error_ = 0;
  std::vector<Row> rows_;
};

/// In the order of rows.  Throws Stopped.
std::vector<Task> all_tasks(const Matrix& matrix, const FormFactorRequest& request,
                            const Deadline& deadline, StageCounts& counts) {
  std::vector<Task> tasks;
  std::vector<int> large;
  for (int side = 0; side < matrix.sides(); ++side) {
    if (matrix.is_large(side)) large.push_back(side);
  }
  int next = 0;
  const auto add_small_before = [&](int side) {
    for (; next < side; ++next) tasks.push_back({next, std::nullopt});
  };
  const StoppedBy by = for_each_parallel(
      large.size(), request, deadline, "parts of surfaces", counts,
      [] { return std::optional<int>(0); },
      [&](int&, std::size_t k) { return matrix.parts(large[k]); },
      [&](std::size_t k, std::vector<SenderPart> parts) {
        add_small_before(large[k]);
        for (SenderPart& part : parts) tasks.push_back({large[k], std::move(part)});
        ++next;
        return true;
      });
  if (by != StoppedBy::Nothing) throw Stopped("parts of surfaces", 0);
  add_small_before(matrix.sides());
  return tasks;
}

}  // namespace

double FormFactors::at(int from, int to) const {
  const FormFactorRow& row = rows.at(from);
  const auto it = std::ranges::lower_bound(row.to, to);
  return it != row.to.end() && *it == to ? row.factor[it - row.to.begin()] : 0;
}

double FormFactors::row_sum(int from) const {
  double sum = 0;
  for (const double f : rows.at(from).factor) sum += f;
  return sum;
}

FormFactors form_factors(const Scene& scene, std::span<const FormFactorSurface> surfaces,
                         const FormFactorRequest& request) {
  const Deadline deadline(request);
  Stage stage(request, "surfaces", deadline);
  const Matrix matrix(scene, surfaces, request);
  stage.check(1);

  FormFactors result;
  for (const FormFactorSurface& s : surfaces) result.names.push_back(s.name);
  result.areas = matrix.scene().areas;
  result.coincident_area = matrix.scene().coincident_area;
  const std::vector<Task> tasks = all_tasks(matrix, request, deadline, result.predicates);
  RowSums sums(matrix.scene(), request.up, result);
  int next_row = 0;
  const auto end_rows_before = [&](int row) {
    for (; next_row < row; ++next_row) sums.end_row();
  };
  // Parts of a large surface take long, and rows after it must not wait for them.
  constexpr std::size_t kWaiting = 1 << 15;
  const StoppedBy by = for_each_parallel(
      tasks.size(), request, deadline, "form factors", result.predicates,
      [] { return std::optional<int>(0); },
      [&](int&, std::size_t i) {
        PairFactor pairs(matrix.blockers());
        return matrix.row_part(pairs, tasks[i]);
      },
      [&](std::size_t i, const RowPart& part) {
        end_rows_before(matrix.surface_of(tasks[i].side));
        sums.add(part);
        return true;
      },
      kWaiting);
  result.complete = by == StoppedBy::Nothing;
  if (result.complete) end_rows_before(static_cast<int>(surfaces.size()));
  sums.fill_rows();
  return result;
}

}  // namespace sightline
