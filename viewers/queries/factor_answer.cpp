#include "viewers/queries/factor_answer.h"

#include <fmt/format.h>

#include <cstdint>

#include "viewers/files/npz_file.h"

namespace sightline::viewers {
namespace {

/// A text that may hold commas or quotes, as a field of a table.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

Json matrix_json(const FormFactors& factors) {
  const std::size_t n = factors.names.size();
  if (n > kLargestMatrix) return nullptr;
  Json matrix = Json::array();
  for (std::size_t i = 0; i < n; ++i) {
    if (i >= factors.rows.size()) {
      matrix.push_back(nullptr);
      continue;
    }
    std::vector<double> row(n, 0);
    const FormFactorRow& entries = factors.rows[i];
    for (std::size_t k = 0; k < entries.to.size(); ++k) {
      row[entries.to[k]] = entries.factor[k];
    }
    matrix.push_back(row);
  }
  return matrix;
}

/// A number for each row; null for rows that were not done.
template <class Number>
Json by_row(const FormFactors& factors, Number&& number) {
  Json list = Json::array();
  for (std::size_t i = 0; i < factors.names.size(); ++i) {
    list.push_back(i < factors.rows.size() ? Json(number(i)) : Json(nullptr));
  }
  return list;
}

}  // namespace

Json factors_json(const FormFactors& factors, bool sky) {
  const auto& rows = factors.rows;
  Json j;
  j["groups"] = factors.names;
  j["areas"] = factors.areas;
  j["matrix"] = matrix_json(factors);
  j["error_bound"] = factors.error_bound;
  j["others"] = by_row(factors, [&](std::size_t i) { return rows[i].others; });
  j["outside"] = by_row(factors, [&](std::size_t i) { return rows[i].outside; });
  j["backs"] = by_row(factors, [&](std::size_t i) { return rows[i].backs; });
  if (sky) j["sky"] = by_row(factors, [&](std::size_t i) { return rows[i].sky; });
  j["row_sums"] = by_row(
      factors, [&](std::size_t i) { return factors.row_sum(static_cast<int>(i)); });
  j["coincident_area"] = factors.coincident_area;
  return j;
}

Json matrix_answer(const FormFactors& factors, double accuracy, bool sky) {
  Json j = factors_json(factors, sky);
  j["accuracy"] = accuracy;
  j["pairs"] = {{"facing", factors.pairs},
                {"open", factors.open},
                {"partly_hidden", factors.partial}};
  return j;
}

Json factor_lines_json(const FormFactorLines& estimate, bool sky) {
  const FormFactors& factors = estimate.factors;
  Json j = factors_json(factors, sky);
  j.erase("error_bound");
  j["lines"] = estimate.lines;
  j["area_per_line"] = estimate.area_per_line;
  FormFactors errors;
  errors.names = factors.names;
  for (std::size_t i = 0; i < factors.rows.size(); ++i) {
    const FormFactorErrors& e = estimate.errors[i];
    errors.rows.push_back(
        {factors.rows[i].to, e.factor, e.others, e.outside, e.backs, e.sky});
  }
  const Json all = factors_json(errors, sky);
  for (const char* key : {"matrix", "others", "outside", "backs", "sky"}) {
    if (all.contains(key)) j["standard_errors"][key] = all[key];
  }
  return j;
}

void write_factor_csv(const FormFactors& factors, std::ostream& out,
                      const std::vector<FormFactorErrors>* errors) {
  out << (errors != nullptr ? std::string_view("from,to,factor,standard_error\n")
                            : kFactorCsvHead);
  for (std::size_t i = 0; i < factors.rows.size(); ++i) {
    const FormFactorRow& row = factors.rows[i];
    for (std::size_t k = 0; k < row.to.size(); ++k) {
      out << fmt::format("{},{},{:.17g}", csv_field(factors.names[i]),
                         csv_field(factors.names[row.to[k]]), row.factor[k]);
      if (errors != nullptr) out << fmt::format(",{:.17g}", (*errors)[i].factor[k]);
      out << '\n';
    }
  }
}

void write_factor_npz(const FormFactors& factors, const std::filesystem::path& file,
                      const std::vector<FormFactorErrors>* errors) {
  NpzFile npz(file);
  const auto n = static_cast<std::int64_t>(factors.rows.size());
  std::vector<std::int64_t> indptr{0};
  for (const FormFactorRow& row : factors.rows) {
    indptr.push_back(indptr.back() + static_cast<std::int64_t>(row.to.size()));
  }
  const auto entries = static_cast<std::size_t>(indptr.back());
  npz.begin("indices", "<i4", &entries);
  for (const FormFactorRow& row : factors.rows) {
    npz.write(row.to.data(), row.to.size() * sizeof(int));
  }
  npz.end();
  npz.begin("data", "<f8", &entries);
  for (const FormFactorRow& row : factors.rows) {
    npz.write(row.factor.data(), row.factor.size() * sizeof(double));
  }
  npz.end();
  if (errors != nullptr) {
    npz.begin("standard_errors", "<f8", &entries);
    for (const FormFactorErrors& row : *errors) {
      npz.write(row.factor.data(), row.factor.size() * sizeof(double));
    }
    npz.end();
  }
  npz.add("indptr", indptr);
  npz.add_text("format", "csr");
  npz.add("shape", std::vector<std::int64_t>{n, n});
  npz.add("areas", factors.areas);
  npz.add("names", factors.names);
  const auto column = [&](const char* name, double FormFactorRow::*member) {
    std::vector<double> values;
    for (const FormFactorRow& row : factors.rows) values.push_back(row.*member);
    npz.add(name, values);
  };
  column("others", &FormFactorRow::others);
  column("outside", &FormFactorRow::outside);
  column("backs", &FormFactorRow::backs);
  npz.close();
}

Json point_factors_json(const PointFactors& factors, bool sky) {
  Json j{{"factors", factors.factors},
         {"others", factors.others},
         {"outside", factors.outside},
         {"backs", factors.backs}};
  if (sky) j["sky"] = factors.sky;
  return j;
}

std::string point_factor_csv_head(const std::vector<FormFactorSurface>& surfaces,
                                  bool sky) {
  std::string head = "point";
  for (const FormFactorSurface& s : surfaces) {
    head += ',';
    head += csv_field(s.name);
  }
  head += sky ? ",others,outside,backs,sky\n" : ",others,outside,backs\n";
  return head;
}

std::string point_factor_csv(std::size_t number, const PointFactors& factors, bool sky) {
  std::string line = fmt::format("{}", number);
  for (const double f : factors.factors) line += fmt::format(",{:.17g}", f);
  line += fmt::format(",{:.17g},{:.17g},{:.17g}", factors.others, factors.outside,
                      factors.backs);
  if (sky) line += fmt::format(",{:.17g}", factors.sky);
  return line + "\n";
}

}  // namespace sightline::viewers
