// A backprojection beside the naive answer, for the tests of backprojection.h.

#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shadows/backprojection.h"
#include "tests/support/naive_shadow.h"
#include "tests/support/shadow_scenes.h"

namespace sightline::testing {

/// What to look at besides class, fraction and form factor.
struct ComparedParts {
  bool gradient = false;
  bool structure = false;
};

struct ComparisonCounts {
  int points = 0, umbra = 0, penumbra = 0, lit = 0;
  int gradients = 0, structures = 0;
  int sides = 0;    ///< whose names were compared
  int in_line = 0;  ///< others: of several things in line
  double fraction = 0, form_factor = 0, gradient = 0;  ///< largest differences
};

/// All points of one scene.  Keeps no reference to what it is made of.
class BackprojectionComparison {
 public:
  explicit BackprojectionComparison(const ShadowScene& lit);

  /// What differs at the point, as a message; nullopt where nothing does.
  [[nodiscard]] std::optional<std::string> difference(const AskedPoint& p,
                                                      const ComparedParts& parts);
  [[nodiscard]] const ComparisonCounts& counts() const { return counts_; }
  [[nodiscard]] const Scene& scene() const { return scene_; }

 private:
  [[nodiscard]] std::string gradient_difference(const AskedPoint& p,
                                                const Backprojection& seen);
  [[nodiscard]] std::string structure_difference(const AskedPoint& p,
                                                 const Backprojection& seen);
  [[nodiscard]] std::string boundary_difference(const SeenBoundary& seen,
                                                const NaiveSeenSource& expected,
                                                std::size_t number, double size);

  std::string name_;
  Scene scene_;
  BackprojectionIndex index_;
  NaiveShadow naive_;
  ComparisonCounts counts_;
  // Names that the two gave to one side so far, by source faces.
  std::map<std::pair<int, SeenSide>, NaiveSideName> naive_names_;
  std::map<std::pair<int, NaiveSideName>, SeenSide> names_;
  std::map<int, std::vector<int>> polygons_;  // of source faces
};

}  // namespace sightline::testing
