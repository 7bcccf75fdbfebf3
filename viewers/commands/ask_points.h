// Points of a file, asked one by one on several threads.

#pragma once

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "linespace/work/parallel.h"
#include "viewers/commands/session.h"
#include "viewers/queries/shadow_questions.h"

namespace sightline::viewers {

/// Of all points in their order, or of as many of the first as the budget allowed.
template <class Answer>
struct AnsweredPoints {
  std::vector<Answer> points;
  StageCounts predicates;
};

/// answer(number, question) for each question; what it refuses (InvalidInput) is told
/// with the place of the question.  The request must be limited by the session.
template <class Ask>
auto ask_points(Session& session, const std::vector<ShadowQuestion>& questions,
                const Request& request, Ask&& answer) {
  using Answer = decltype(answer(std::size_t{0}, questions.front()));
  session.begin("points");
  AnsweredPoints<Answer> all;
  const auto step = [&](int&, std::size_t i) {
    try {
      return answer(i, questions[i]);
    } catch (const InvalidInput& refusal) {
      throw InvalidInput(fmt::format("{}: {}", questions[i].where, refusal.what()));
    }
  };
  // The workers need nothing of their own.
  internal::for_each_parallel(
      questions.size(), request, internal::Deadline(request), "points", all.predicates,
      [] { return std::optional<int>(0); }, step,
      [&](std::size_t, Answer point) {
        all.points.push_back(std::move(point));
        return true;
      });
  return all;
}

}  // namespace sightline::viewers
