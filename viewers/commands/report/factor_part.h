// The part `formfactors` of a report: what groups exchange, and the files it is told in.

#pragma once

#include "shadows/form_factors.h"
#include "viewers/answer.h"
#include "viewers/commands/session.h"
#include "viewers/report_folder.h"

namespace sightline::viewers {

/// What has been found for a report.
struct FactorPart {
  FormFactors factors;  ///< without areas where there is no row
  double accuracy = 0;
  StageCounts predicates;
};

/// Between all objects.  Where the request ends it the part is not complete.
[[nodiscard]] FactorPart factor_part(const Scene& scene, const Request& request);

/// What `formfactors` answers, without the matrix where `with_matrix` is false; and
/// {"complete", "predicates"}.
[[nodiscard]] Json factor_part_json(const FactorPart& part, bool with_matrix);

/// Writes formfactors.csv, and formfactors.json, which is what `formfactors` answers.
/// `head`: the keys that all answers have.
void write_factor_part(Session& session, const FactorPart& part, Json head,
                       ReportFolder& folder);

}  // namespace sightline::viewers
