// Viewpoints to choose from, with what they show.

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "aspect/choice/patch_sides.h"
#include "aspect/choice/seen_parts.h"
#include "linespace/work/deadline.h"

namespace sightline::internal {

/// Views, and ways to come by better ones.  Keeps a reference to the index.
class Candidates {
 public:
  /// Takes the viewpoints of the certified aspect graph where there is one.  Else takes
  /// those the request begins with and samples; and for sides that none of these sees
  /// tries viewpoints in front of them, at most four times as many as samples.
  /// `regions`: SeenParts::regions are wanted.
  Candidates(const PointViewIndex& index, const ViewpointRequest& request,
             const std::vector<PatchSide>& sides, bool regions);
  Candidates(const Candidates&) = delete;
  Candidates& operator=(const Candidates&) = delete;

  [[nodiscard]] const std::vector<SeenParts>& views() const { return views_; }
  [[nodiscard]] std::size_t taken() const { return taken_; }
  [[nodiscard]] bool certified() const { return certified_; }
  /// False once time was over.
  [[nodiscard]] bool complete() const { return complete_; }

  using Worth = std::function<double(const SeenParts&)>;
  /// A view near view i that is worth more, if some hundred random steps find one, added
  /// behind the others; its number, or i.
  int improve(int i, const Worth& worth);
  /// Tries eyes in front of this place of a side until one passes; its number, else -1.
  int look_at(const PatchSide& side, const Point& place,
              const std::function<bool(const SeenParts&)>& passes);

 private:
  void take(const std::vector<Viewpoint>& at);
  void take_graph();
  void take_samples();
  [[nodiscard]] bool allowed(const Point& at) const;
  [[nodiscard]] bool time_is_over();
  [[nodiscard]] std::optional<SeenParts> see(const Point& at);

  const PointViewIndex* index_;
  const ViewpointRequest request_;
  const Scene* scene_;
  Deadline deadline_;
  bool regions_, certified_ = false, complete_ = true;
  double extent_;
  std::mt19937_64 random_;
  std::size_t taken_ = 0;
  std::vector<SeenParts> views_;
};

/// A point inside the side's first face.
[[nodiscard]] Point place_on(const Scene& scene, const PatchSide& side);

}  // namespace sightline::internal
