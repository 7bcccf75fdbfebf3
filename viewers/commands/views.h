// Exact views as commands answer them: `look`, and the part of `analyse` of that name.

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "linespace/point_view.h"
#include "viewers/commands/command_line.h"
#include "viewers/commands/outputs.h"
#include "viewers/pictures/view_drawing.h"
#include "viewers/questions.h"

namespace sightline::viewers {

/// From where, in the words of the command line.
struct ViewpointOptions {
  const CLI::App* command = nullptr;  ///< knows in which order they were named
  std::vector<std::string> from, direction;
  std::vector<std::string> at;  ///< files with views; of `look` only

  [[nodiscard]] bool empty() const {
    return from.empty() && direction.empty() && at.empty();
  }
};

/// --from and --direction.
void add_viewpoint_options(CLI::App& command, ViewpointOptions& options);

/// In the order of the command line; the files of --at are protected.  Throws
/// InvalidInput that names the option or the element.
[[nodiscard]] std::vector<ViewQuestion> questions_of(Session& session,
                                                     const ViewpointOptions& options,
                                                     Outputs& outputs);

/// So many views of one run are drawn, since each has files of its own.
inline constexpr std::size_t kMostDrawnViews = 100;

/// NAME.svg for one view; of several NAME0.svg, NAME1.svg, ...
[[nodiscard]] std::string name_of_view(const std::string& file, std::size_t view,
                                       std::size_t views);

/// What is wanted of views besides their numbers.
struct ViewWish {
  bool map = false;                    ///< "map" in the JSON answer
  bool rows = false;                   ///< of the table of --csv
  bool seams = false, hidden = false;  ///< lines of the drawing
};

struct SeenView {
  std::size_t number = 0;  ///< of its question
  Json json;
  std::string rows;
  PointView view;
  std::vector<FurtherLine> further;
};

/// Calls use() with each view, one at a time, in order, soon after it has been seen, so
/// that views need not be held.  Several views share the request's threads; a single one
/// has them all.  Where the request ends it early, use() has had the first of them.
/// Returns how signs were decided.  Throws InvalidInput that names the question.
StageCounts see(const Scene& scene, const PointViewIndex& index,
                const std::vector<ViewQuestion>& questions, const ViewWish& wish,
                const Request& request, const std::function<void(SeenView)>& use);

/// Throws UsageError that names the question.
[[nodiscard]] ViewDrawing drawing_of(const Scene& scene, const ViewQuestion& question,
                                     const SeenView& seen, const PictureWish& wish);

/// Tells of the first views on standard output; a null is a view that was not done.
void print_views(const std::vector<ViewQuestion>& questions, const Json& views);

}  // namespace sightline::viewers
