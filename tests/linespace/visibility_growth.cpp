// How the time of polygon-to-polygon visibility grows with the number of occluders, as
// CSV on standard output.  What is held is the share of hidden questions: for each n the
// mean edge length s is sought at which a quarter of the questions is hidden; visible and
// hidden ones are then timed apart.  The last line has the exponents fitted to the means.
// Processor time of one thread, the median of three runs of each question.
//
// usage: visibility_growth [QUESTIONS [HIDDEN_SHARE]]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "linespace/polygon_visibility.h"
#include "tests/support/visibility_cases.h"

namespace {

using namespace sightline;           // NOLINT(google-build-using-namespace)
using namespace sightline::testing;  // NOLINT(google-build-using-namespace)

double milliseconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

VisibilityQuestion question(int seed, int n, double s) {
  VisibilityInstance instance = slab_instance(seed, n, s);
  return {instance.a, instance.b, std::move(instance.occluders)};
}

double hidden_share(int count, int n, double s) {
  int hidden = 0;
  for (int seed = 0; seed < count; ++seed) {
    hidden += polygon_visibility(question(seed, n, s)).verdict == Verdict::Hidden;
  }
  return static_cast<double>(hidden) / count;
}

double size_for_share(int count, int n, double share) {
  double low = 0.05, high = 3;
  for (int i = 0; i < 9; ++i) {
    const double middle = std::sqrt(low * high);
    (hidden_share(count, n, middle) < share ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

struct Times {
  std::vector<double> visible, hidden;
};

Times times(int count, int n, double s) {
  Times t;
  for (int seed = 0; seed < count; ++seed) {
    const VisibilityQuestion q = question(seed, n, s);
    std::array<double, 3> runs;
    Verdict verdict = Verdict::Undecided;
    for (double& run : runs) {
      const double start = milliseconds();
      verdict = polygon_visibility(q).verdict;
      run = milliseconds() - start;
    }
    std::ranges::sort(runs);
    (verdict == Verdict::Hidden ? t.hidden : t.visible).push_back(runs[1]);
  }
  std::ranges::sort(t.visible);
  std::ranges::sort(t.hidden);
  return t;
}

double mean(const std::vector<double>& t) {
  double sum = 0;
  for (const double x : t) sum += x;
  return t.empty() ? 0 : sum / static_cast<double>(t.size());
}

// Least squares of log y over log x.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double mx = 0, my = 0, xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += std::log(x[i]) / static_cast<double>(x.size());
    my += std::log(y[i]) / static_cast<double>(x.size());
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (std::log(x[i]) - mx) * (std::log(y[i]) - my);
    xx += (std::log(x[i]) - mx) * (std::log(x[i]) - mx);
  }
  return xy / xx;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const double share = argc > 2 ? std::atof(argv[2]) : 0.25;
  std::vector<double> ns, visible, hidden;
  std::printf(
      "n,s,hidden_percent,visible_mean_ms,visible_p99_ms,hidden_mean_ms,"
      "hidden_p99_ms\n");
  for (const int n : {25, 50, 100, 200, 400}) {
    const double s = size_for_share(count, n, share);
    const Times t = times(count, n, s);
    if (t.visible.empty() || t.hidden.empty()) continue;
    ns.push_back(n);
    visible.push_back(mean(t.visible));
    hidden.push_back(mean(t.hidden));
    std::printf("%d,%.3f,%.1f,%.3f,%.2f,%.3f,%.2f\n", n, s,
                100.0 * static_cast<double>(t.hidden.size()) / count, visible.back(),
                t.visible[t.visible.size() * 99 / 100], hidden.back(),
                t.hidden[t.hidden.size() * 99 / 100]);
    std::fflush(stdout);
  }
  std::printf("exponents,,,%.2f,,%.2f,\n", exponent(ns, visible), exponent(ns, hidden));
}
