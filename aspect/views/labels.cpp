#include "aspect/views/labels.h"

#include <algorithm>
#include <set>

#include "aspect/shape/map_shape.h"
#include "linespace/checksum.h"
#include "linespace/picture/view_scene.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {
namespace {

class Labeller {
 public:
  Labeller(const PointView& view, const AspectRequest& request)
      : view_(&view), of_(request.of) {}

  // Regions in which the wanted faces are seen.
  [[nodiscard]] bool counts(int region, const Scene& scene) const {
    if (of_.empty()) return true;
    return region >= 0 && counts_of(view_->regions[region], scene, of_);
  }

  [[nodiscard]] std::string faces(const Scene& scene) const {
    std::set<int> patches;
    for (std::size_t r = 0; r < view_->regions.size(); ++r) {
      if (!counts(static_cast<int>(r), scene)) continue;
      patches.insert(view_->regions[r].patches.begin(), view_->regions[r].patches.end());
    }
    Checksum sum;
    for (const int p : patches) sum.add(static_cast<std::uint64_t>(p));
    return sum.text();
  }

  // Of the wanted faces: their regions' boundaries, by names.
  [[nodiscard]] std::string structure_of_part(const Scene& scene) const {
    std::vector<std::vector<std::uint64_t>> parts;
    for (std::size_t r = 0; r < view_->regions.size(); ++r) {
      if (!counts(static_cast<int>(r), scene)) continue;
      for (const auto& walk : view_->regions[r].boundary) {
        std::vector<std::vector<std::uint64_t>> cycle;
        for (const int dart : walk) cycle.push_back(named(dart));
        std::ranges::rotate(cycle, std::ranges::min_element(cycle));
        std::vector<std::uint64_t> part;
        for (const int patch : view_->regions[r].patches)
          part.push_back(static_cast<std::uint64_t>(patch));
        for (const auto& c : cycle) part.insert(part.end(), c.begin(), c.end());
        parts.push_back(std::move(part));
      }
    }
    std::ranges::sort(parts);
    Checksum sum;
    for (const auto& part : parts) {
      sum.add(static_cast<std::uint64_t>(part.size()));
      for (const std::uint64_t x : part) sum.add(x);
    }
    return sum.text();
  }

 private:
  static void add(std::vector<std::uint64_t>& to, const MapLine& line) {
    for (const int id : {line.edge, line.facets[0], line.facets[1]})
      to.push_back(static_cast<std::uint64_t>(id));
  }
  // An edge as a region's walk passes it, with the vertex that it leaves from.
  [[nodiscard]] std::vector<std::uint64_t> named(int dart) const {
    const MapEdge& e = view_->edges[dart / 2];
    const MapVertex& v = view_->vertices[e.ends[dart % 2]];
    std::vector<std::uint64_t> out{static_cast<std::uint64_t>(e.kind),
                                   static_cast<std::uint64_t>(v.kind),
                                   static_cast<std::uint64_t>(v.corner)};
    add(out, e.line);
    add(out, v.near);
    add(out, v.far);
    const int beyond = dart % 2 == 0 ? e.right : e.left;
    if (beyond >= 0) {
      for (const int patch : view_->regions[beyond].patches)
        out.push_back(static_cast<std::uint64_t>(patch));
    }
    return out;
  }

  const PointView* view_;
  const std::vector<int>& of_;
};

}  // namespace

bool counts_of(const MapRegion& region, const Scene& scene, const std::vector<int>& of) {
  if (of.empty()) return true;
  return std::ranges::any_of(region.facets, [&](int facet) {
    return std::ranges::any_of(scene.facets()[facet].faces,
                               [&](int f) { return std::ranges::binary_search(of, f); });
  });
}

std::string label_of(const PointView& view, const Scene& scene,
                     const AspectRequest& request) {
  const Labeller labeller(view, request);
  if (request.label == AspectLabel::Faces) return labeller.faces(scene);
  return request.of.empty() ? view.structure : labeller.structure_of_part(scene);
}

ViewLabels labels_of(const PointView& view, const Scene& scene,
                     const AspectRequest& request) {
  ViewLabels out;
  const Labeller labeller(view, request);
  out.faces = labeller.faces(scene);
  out.structure = view.structure;
  out.shape = shape_of(shape_map(view));
  for (const SeenFacet& f : view.facets) {
    if (out.facets.empty() || out.facets.back() != f.facet) out.facets.push_back(f.facet);
  }
  out.label = label_of(view, scene, request);
  return out;
}

std::optional<ViewLabels> labels_of(const PointViewIndex& index, const Viewpoint& at,
                                    const AspectRequest& request) {
  const PointView view = index.view(at);
  if (view.place != EyePlace::Free || !view.general) return std::nullopt;
  return labels_of(view, index.shared().scene(), request);
}

Viewpoint viewpoint_at(const Point& at, Projection projection) {
  return projection == Projection::Orthographic ? eye_far_along(at) : eye_at(at);
}

TakenViews take_views(const PointViewIndex& index, const std::vector<Point>& at,
                      const AspectRequest& request, const Request& left) {
  TakenViews out;
  out.labels.resize(at.size());
  std::vector<std::uint8_t> done(at.size(), 0);
  try {
    Stage stage(left, "views");
    for_each_of(0, at.size(), at.size(), left, stage, [&](std::size_t i) {
      out.labels[i] = labels_of(index, viewpoint_at(at[i], request.projection), request);
      done[i] = 1;
    });
  } catch (const Stopped&) {
    out.complete = false;
  }
  out.views = static_cast<std::size_t>(std::ranges::count(done, 1));
  return out;
}

}  // namespace sightline::internal
