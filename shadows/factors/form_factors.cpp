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

/// What one row finds: its entries from the diagonal on, and the rest.
struct RowPart {
  struct Entry {
    int to;
    double exchange;  ///< scene units squared
    double error;
  };
  std::vector<Entry> entries;
  double others = 0, outside = 0, backs = 0, sky = 0;  ///< exchange areas
  double error = 0;                                    ///< of these
  PairCounts counts;
};

/// All that the rows share.
class Matrix {
 public:
  Matrix(const Scene& scene, std::span<const FormFactorSurface> surfaces,
         const FormFactorRequest& request)
      : accuracy_(request.accuracy / kMargin),
        up_(request.up),
        scene_(factor_scene(scene, surfaces)),
        blockers_(scene, scene_.blockers, scene_.solid_blockers) {
    for (const FactorSide& s : scene_.sides) sides_.emplace_back(s);
    for (const FactorSide& s : scene_.elsewhere) elsewhere_.emplace_back(s);
    first_.assign(surfaces.size() + 1, 0);
    for (const PreparedSide& s : sides_) ++first_[s.of + 1];
    for (std::size_t i = 0; i < surfaces.size(); ++i) first_[i + 1] += first_[i];
  }

  [[nodiscard]] const FactorScene& scene() const { return scene_; }
  [[nodiscard]] const PairBlockers& blockers() const { return blockers_; }

  [[nodiscard]] RowPart row(PairFactor& pairs, int i) const {
    RowPart part;
    for (std::size_t j = i; j + 1 < first_.size(); ++j) add_entry(pairs, i, j, part);
    add_elsewhere(pairs, i, part);
    part.counts = pairs.counts();
    return part;
  }

 private:
  /// Entries are asked for so much more exactly than told, so that the sums of rows are
  /// as exact as entries.
  static constexpr double kMargin = 8;

  void add_entry(PairFactor& pairs, int i, int j, RowPart& part) const {
    std::vector<std::pair<int, int>> facing_pairs;
    for (int s = first_[i]; s < first_[i + 1]; ++s) {
      for (int t = i == j ? s + 1 : first_[j]; t < first_[j + 1]; ++t) {
        if (facing(sides_[s], sides_[t])) facing_pairs.emplace_back(s, t);
      }
    }
    if (facing_pairs.empty()) return;
    const double ways = i == j ? 2 : 1;
    const double tolerance = accuracy_ * std::min(scene_.areas[i], scene_.areas[j]) /
                             (ways * static_cast<double>(facing_pairs.size()));
    RowPart::Entry entry{j, 0, 0};
    for (const auto& [s, t] : facing_pairs) {
      hear_stop();
      const ExchangeArea e = pairs.of(sides_[s], sides_[t], tolerance);
      entry.exchange += ways * e.value;
      entry.error += ways * e.error;
    }
    if (entry.exchange != 0) part.entries.push_back(entry);
  }
  void add_elsewhere(PairFactor& pairs, int i, RowPart& part) const {
    part.backs = scene_.buried[i];
    part.outside = scene_.leaving[i];
    part.sky = up_ ? scene_.leaving_upwards(i, up_->normalized()) : 0;
    for (const int what : {kOthers, kBacks, kOutside}) {
      std::vector<std::pair<int, int>> facing_pairs;
      for (int s = first_[i]; s < first_[i + 1]; ++s) {
        for (std::size_t t = 0; t < elsewhere_.size(); ++t) {
          if (elsewhere_[t].of == what && facing(sides_[s], elsewhere_[t])) {
            facing_pairs.emplace_back(s, t);
          }
        }
      }
      if (facing_pairs.empty()) continue;
      const double tolerance =
          accuracy_ * scene_.areas[i] / static_cast<double>(facing_pairs.size());
      double sum = 0, error = 0, sky_error = 0;
      for (const auto& [s, t] : facing_pairs) {
        hear_stop();
        const ExchangeArea e = pairs.of(sides_[s], elsewhere_[t], tolerance);
        sum += e.value;
        error += e.error;
        if (up_ && what == kOutside) {
          const ExchangeArea sky =
              rising_part(pairs, sides_[s], elsewhere_[t], e, tolerance);
          part.sky += sky.value;
          sky_error += sky.error;
        }
      }
      part.error = std::max(part.error, sky_error);
      (what == kOthers ? part.others : what == kBacks ? part.backs : part.outside) += sum;
      part.error = std::max(part.error, error);
    }
  }

  /// Of what leaves through a window.
  [[nodiscard]] ExchangeArea rising_part(PairFactor& pairs, const PreparedSide& side,
                                         const PreparedSide& window,
                                         const ExchangeArea& all,
                                         double tolerance) const {
    const auto c = spanning_corners(side.polygon);
    const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    const Eigen::Vector3d up = up_->normalized();
    // A side that faces straight up or down has the same horizon.
    constexpr double kParallel = 1e-14;
    if (normal.cross(up).norm() > kParallel)
      return pairs.rising(side, window, up, tolerance);
    return normal.dot(up) > 0 ? all : ExchangeArea{};
  }

  double accuracy_;
  std::optional<Eigen::Vector3d> up_;
  FactorScene scene_;
  PairBlockers blockers_;
  std::vector<PreparedSide> sides_, elsewhere_;
  std::vector<int> first_;  // side of each surface
};

void add_counts(const PairCounts& counts, FormFactors& result) {
  result.pairs += counts.pairs;
  result.open += counts.open;
  result.partial += counts.partial;
}

/// Both entries of each pair, for rows that were done.
void fill_rows(const std::vector<RowPart>& parts, FormFactors& result) {
  const std::vector<double>& areas = result.areas;
  result.rows.resize(parts.size());
  const auto add = [&](int from, int to, const RowPart::Entry& e) {
    FormFactorRow& row = result.rows[from];
    row.to.push_back(to);
    row.factor.push_back(e.exchange / areas[from]);
    result.error_bound = std::max(result.error_bound, e.error / areas[from]);
  };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const RowPart& part = parts[i];
    FormFactorRow& row = result.rows[i];
    const double area = areas[i];
    row.others = part.others / area;
    row.outside = part.outside / area;
    row.backs = part.backs / area;
    row.sky = part.sky / area;
    result.error_bound = std::max(result.error_bound, part.error / area);
    // Entries to the left of the diagonal were added by the rows before.
    for (const RowPart::Entry& e : part.entries) {
      add(static_cast<int>(i), e.to, e);
      const bool other = e.to != static_cast<int>(i);
      if (other && e.to < static_cast<int>(parts.size())) {
        add(e.to, static_cast<int>(i), e);
      }
    }
    add_counts(part.counts, result);
  }
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
  std::vector<RowPart> parts;
  const StoppedBy by = for_each_parallel(
      surfaces.size(), request, deadline, "form factors", result.predicates,
      [] { return std::optional<int>(0); },
      [&](int&, std::size_t i) {
        PairFactor pairs(matrix.blockers());
        return matrix.row(pairs, static_cast<int>(i));
      },
      [&](std::size_t, RowPart part) {
        parts.push_back(std::move(part));
        return true;
      });
  result.complete = by == StoppedBy::Nothing;
  fill_rows(parts, result);
  return result;
}

}  // namespace sightline
