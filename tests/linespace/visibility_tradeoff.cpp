// Time against accuracy of polygon-to-polygon visibility, as CSV on standard output:
// random segments from 10^2 to 10^6, the search in doubles alone, and exact, on the same
// questions: method, segments, wrong answers in percent (hidden for want of a free
// segment, or by rounding), mean and largest milliseconds.
// docs/pictures/visibility_tradeoff.gp draws it.
//
// usage: visibility_tradeoff [QUESTIONS]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "linespace/polygon_visibility.h"
#include "tests/support/visibility_cases.h"

namespace {

using namespace sightline;           // NOLINT(google-build-using-namespace)
using namespace sightline::testing;  // NOLINT(google-build-using-namespace)

void measure(const char* name, const std::vector<VisibilityQuestion>& questions,
             const std::vector<bool>& visible, const VisibilityRequest& request) {
  int wrong = 0;
  double sum = 0, largest = 0;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const auto start = std::chrono::steady_clock::now();
    const Verdict verdict = polygon_visibility(questions[i], request).verdict;
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - start;
    wrong += (verdict == Verdict::Visible) != visible[i];
    sum += spent.count();
    largest = std::max(largest, spent.count());
  }
  const auto count = static_cast<double>(questions.size());
  std::printf("%s,%d,%.3f,%.4f,%.3f\n", name, request.samples, 100 * wrong / count,
              sum / count, largest);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 400;
  std::vector<VisibilityQuestion> questions;
  std::vector<bool> visible;
  // About half of these are hidden, and many openings are small; a quarter are aligned.
  for (int seed = 0; seed < count; ++seed) {
    VisibilityInstance instance =
        seed % 4 == 3 ? grid_instance(seed, 10, 3) : slab_instance(seed, 100, 0.5);
    questions.push_back({instance.a, instance.b, std::move(instance.occluders)});
    visible.push_back(polygon_visibility(questions.back()).verdict == Verdict::Visible);
  }
  std::printf("method,segments,wrong_percent,mean_ms,max_ms\n");
  for (const int samples : {100, 1'000, 10'000, 100'000, 1'000'000}) {
    VisibilityRequest request;
    request.samples = samples;
    request.samples_only = true;
    measure("random", questions, visible, request);
  }
  VisibilityRequest in_doubles;
  in_doubles.precision = Precision::Double;
  measure("double", questions, visible, in_doubles);
  measure("exact", questions, visible, {});
}
