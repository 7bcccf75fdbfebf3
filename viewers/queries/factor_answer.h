// Form factors as JSON, as rows of a table, and as a sparse matrix for SciPy.

#pragma once

#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "shadows/form_factor_lines.h"
#include "viewers/answer.h"

namespace sightline::viewers {

/// More surfaces than this have no "matrix" in the JSON answer: it would be larger than
/// what readers take.
inline constexpr std::size_t kLargestMatrix = 5000;

/// "groups", "areas", "matrix", "others", "outside", "backs", "row_sums", "sky" with up,
/// "error_bound" and "coincident_area"; null for rows that were not done.
[[nodiscard]] Json factors_json(const FormFactors& factors, bool sky);

/// The same with "accuracy" as it was asked for, and "pairs": how many were looked at,
/// and of them how many have nothing in between, or something.
[[nodiscard]] Json matrix_answer(const FormFactors& factors, double accuracy, bool sky);

/// The same of an estimate by lines; instead of a bound "lines", "area_per_line", and
/// "standard_errors": an object with "matrix", "others", "outside", "backs" and "sky".
[[nodiscard]] Json factor_lines_json(const FormFactorLines& estimate, bool sky);

inline constexpr std::string_view kFactorCsvHead = "from,to,factor\n";
/// A line for every entry that is not 0: from, to, factor, and the standard error of an
/// estimate (null: none).
void write_factor_csv(const FormFactors& factors, std::ostream& out,
                      const std::vector<FormFactorErrors>* errors = nullptr);
/// What scipy.sparse.load_npz opens, and "areas", "names", "others", "outside", "backs",
/// and "standard_errors" of an estimate, in the order of "data".  Requires all rows.
void write_factor_npz(const FormFactors& factors, const std::filesystem::path& file,
                      const std::vector<FormFactorErrors>* errors = nullptr);

/// One of "points".
[[nodiscard]] Json point_factors_json(const PointFactors& factors, bool sky);
/// The names of the surfaces, then what else there is.
[[nodiscard]] std::string point_factor_csv_head(
    const std::vector<FormFactorSurface>& surfaces, bool sky);
[[nodiscard]] std::string point_factor_csv(std::size_t number,
                                           const PointFactors& factors, bool sky);

}  // namespace sightline::viewers
