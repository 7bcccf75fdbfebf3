#include <algorithm>
#include <map>

#include "linespace/light/light_events.h"
#include "linespace/work/deadline.h"
#include "linespace/work/stage.h"
#include "shadows/backprojection.h"
#include "shadows/mesh/mesh_maker.h"
#include "shadows/shadow_mesh.h"

namespace sightline {

using namespace internal;

namespace {

// The traces of a light on each face.
std::vector<std::vector<PieceOnFace>> by_face(const Scene& scene,
                                              const LightEvents& events, bool front) {
  std::vector<std::vector<PieceOnFace>> pieces(scene.faces().size());
  for (std::size_t t = 0; t < events.traces.size(); ++t) {
    for (std::size_t i = 0; i < events.traces[t].pieces.size(); ++i) {
      const LightTrace::Piece& piece = events.traces[t].pieces[i];
      if (piece.front == front)
        pieces[piece.face].push_back({static_cast<int>(t), static_cast<int>(i)});
    }
  }
  return pieces;
}

// The side of the scene's face that receives, for a file that may list it turned.
bool scene_front(const Scene& scene, int face, bool front) {
  return scene.turned(face) != front;
}

class ShadowFinder {
 public:
  ShadowFinder(const Scene& scene, const LightSource& source,
               const std::vector<Receiver>& receivers, const Request& request)
      : scene_(&scene),
        request_(request),
        deadline_(request),
        light_(scene, source, request),
        space_(scene, deadline_.what_is_left(request)) {
    LightEventsRequest wanted;
    static_cast<Request&>(wanted) = deadline_.what_is_left(request);
    for (const int f : source.faces) {
      const bool both = std::ranges::binary_search(source.both_sides, f);
      if (both || !scene.turned(f)) wanted.source_faces.push_back(f);
      if (both || scene.turned(f)) wanted.source_backs.push_back(f);
    }
    for (const Receiver& r : receivers) {
      for (const int f : r.faces) {
        (scene_front(scene, f, r.front) ? wanted.receivers : wanted.receive_behind)
            .push_back(f);
      }
    }
    events_ = light_events(space_, wanted);
    if (!events_.complete) throw Stopped("events of the source", 0);
    front_ = by_face(scene, events_, true);
    back_ = by_face(scene, events_, false);
  }

  ReceiverShadows of(const Receiver& receiver) {
    ReceiverShadows out;
    out.name = receiver.name;
    std::map<std::pair<int, bool>, std::vector<int>> facets;
    for (const int f : receiver.faces) {
      facets[{scene_->faces()[f].facet, scene_front(*scene_, f, receiver.front)}]
          .push_back(f);
    }
    for (const auto& [key, faces] : facets) {
      const FaceSide side = key.second ? FaceSide::Front : FaceSide::Back;
      for (const SourcePatch& patch : source_patches(*scene_, faces, side))
        add_patch(patch, key.first, out);
    }
    return out;
  }

  StructureTable& structures() { return structures_; }

 private:
  void add_patch(const SourcePatch& patch, int facet, ReceiverShadows& out) {
    const ReceiverPlane plane(patch);
    const bool front = patch.side == FaceSide::Front;
    std::vector<PieceOnFace> pieces;
    for (const int f : patch.faces) {
      const auto& of_face = (front ? front_ : back_)[f];
      pieces.insert(pieces.end(), of_face.begin(), of_face.end());
    }
    MeshAndAreas made =
        make_mesh(plane, receiver_curves(*scene_, plane, patch, events_, pieces), facet,
                  events_, light_, structures_, deadline_.what_is_left(request_));
    out.area += plane.area();
    out.umbra_area += made.areas[static_cast<int>(ShadowClass::Umbra)];
    out.penumbra_area += made.areas[static_cast<int>(ShadowClass::Penumbra)];
    out.lit_area += made.areas[static_cast<int>(ShadowClass::Lit)];
    out.away_area += made.away_area;
    out.area_error_bound += made.error_bound;
    out.umbra_components += made.umbra_components;
    out.meshes.push_back(std::move(made.mesh));
  }

  const Scene* scene_;
  Request request_;
  Deadline deadline_;
  BackprojectionIndex light_;
  LightSpace space_;
  LightEvents events_;
  std::vector<std::vector<PieceOnFace>> front_, back_;  // by face
  StructureTable structures_;
};

}  // namespace

Shadows find_shadows(const Scene& scene, const LightSource& source,
                     const std::vector<Receiver>& receivers, const Request& request) {
  const PrecisionScope precision(request.precision);
  ShadowFinder finder(scene, source, receivers, request);
  Shadows out;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    try {
      out.receivers.push_back(finder.of(receivers[i]));
    } catch (const Stopped&) {
      if (i == 0) throw;
      for (; i < receivers.size(); ++i) out.missing.push_back(receivers[i].name);
    }
  }
  out.structures = finder.structures().take();
  return out;
}

}  // namespace sightline
