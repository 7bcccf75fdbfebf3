// Budgets on a city of 500,004 triangles: slow.

#include "tests/support/generators.h"
#include "tests/viewers/stop_support.h"

namespace sightline {
namespace {

class StopCity : public test::Stopping {
 protected:
  static void SetUpTestSuite() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "sightline-stop-XXXXXX").string();
    input_ = mkdtemp(pattern.data());
    const PolygonSoup city = testing::cut_into_triangles(testing::street_city(1, 250002));
    ASSERT_EQ(city.polygons.size(), 500004U);
    testing::write_obj(input_ / "city.obj", city);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(input_); }

  static inline std::filesystem::path input_;
};

// At whatever moment of its set-up and its search: the answer is written, or there was no
// scene yet.
TEST_F(StopCity, BudgetsHoldAtEveryMoment) {
  testing::Random random(11);
  for (int i = 0; i < 24; ++i) {
    const double budget = i + 1 < 24 ? random.uniform(0.05, 14) : 20;
    const Command command{
        "skeleton", input_ / "city.obj",  "--events", i % 3 == 2 ? "polygon" : "solid",
        "--json",   folder_ / "out.json", "--budget", std::to_string(budget)};
    const Run r = run_answered(command);
    expect_clean(r, text_of(command), "budget");
    EXPECT_EQ(r.status, 3);
    EXPECT_LT(r.seconds, budget + 1) << text_of(command);
  }
}

}  // namespace
}  // namespace sightline
