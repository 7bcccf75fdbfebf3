#include "viewers/commands/report/factor_part.h"

#include "viewers/commands/command_line.h"
#include "viewers/json_text.h"
#include "viewers/queries/factor_answer.h"

namespace sightline::viewers {
namespace {

/// Of an entry.  The command's own default takes half as long again.
constexpr double kAccuracy = 1e-6;

}  // namespace

FactorPart factor_part(const Scene& scene, const Request& given) {
  const Meter meter;
  FormFactorRequest request;
  static_cast<Request&>(request) = given;
  request.accuracy = kAccuracy;
  const std::vector<FormFactorSurface> surfaces = surfaces_of(scene, {});
  FactorPart part;
  part.accuracy = request.accuracy;
  try {
    part.factors = form_factors(scene, surfaces, request);
  } catch (const Stopped&) {
    part.factors.complete = false;
    for (const FormFactorSurface& s : surfaces) part.factors.names.push_back(s.name);
  }
  part.predicates = meter.predicates() + part.factors.predicates;
  return part;
}

Json factor_part_json(const FactorPart& part, bool with_matrix) {
  Json answer = matrix_answer(part.factors, part.accuracy, /*sky=*/false);
  if (!with_matrix) answer.erase("matrix");
  answer["complete"] = part.factors.complete;
  answer["predicates"] = stage_counts(part.predicates);
  return answer;
}

void write_factor_part(Session& session, const FactorPart& part, Json head,
                       ReportFolder& folder) {
  session.write("formfactors.csv", [&](const Request&) {
    OutputFile file(folder.announce("formfactors.csv"));
    write_factor_csv(part.factors, file.stream());
    file.commit();
  });
  session.write("formfactors.json", [&](const Request&) {
    head.update(matrix_answer(part.factors, part.accuracy, /*sky=*/false));
    write_whole(folder.announce("formfactors.json"), json_text(head) + "\n");
  });
}

}  // namespace sightline::viewers
