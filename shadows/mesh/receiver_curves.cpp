#include "shadows/mesh/receiver_curves.h"

#include <algorithm>

namespace sightline::internal {
namespace {

ShadowEdgeKind kind_of(LightEventKind kind) {
  switch (kind) {
    case LightEventKind::Face:
      return ShadowEdgeKind::Face;
    case LightEventKind::EE:
      return ShadowEdgeKind::EE;
    case LightEventKind::EV:
      return ShadowEdgeKind::EV;
    case LightEventKind::EEE:
      break;
  }
  return ShadowEdgeKind::EEE;
}

std::string told(const LightFeature& feature, int patch) {
  const std::string id = std::to_string(feature.id);
  const std::string of_source = " of source face " + std::to_string(patch);
  switch (feature.kind) {
    case LightFeature::Kind::Vertex:
      return "vertex " + id;
    case LightFeature::Kind::Edge:
      return "edge " + id;
    case LightFeature::Kind::SourceCorner:
      return "corner " + id + of_source;
    case LightFeature::Kind::SourceSide:
      return "side " + id + of_source;
    case LightFeature::Kind::Touch:
      return "touch " + id;
    case LightFeature::Kind::Horizon:
      break;
  }
  return "horizon of facet " + id;
}

PlanePoint affine(const std::array<Ring, 3>& p) {
  const Rational w = rational(p[2]);
  return {rational(p[0]) / w, rational(p[1]) / w};
}

class CurveMaker {
 public:
  CurveMaker(const ReceiverPlane& plane, const SourcePatch& receiver)
      : plane_(&plane), receiver_(&receiver) {}

  void add_segment(const PlanePoint& a, const PlanePoint& b, ReceiverCurves::Name name) {
    if (a == b) return;
    out_.curves.push_back(plane_segment(static_cast<int>(out_.curves.size()), a, b));
    out_.names.push_back(std::move(name));
  }

  // The receiver's plane meets the line from X(s) to Y(s) in h(Y) X - h(X) Y, where h is
  // the plane's value: quadratic in s.
  void add_conic(const LightTrace& trace, const LightTrace::Piece& piece,
                 ReceiverCurves::Name name) {
    const auto& n = receiver_->plane.exact;
    std::array<Ring, 2> at_x, at_y;
    for (int i = 0; i < 2; ++i) {
      at_x[i] = value(n, trace.first[i]);
      at_y[i] = value(n, trace.last[i]);
    }
    const auto point = [&](int i, int j) {  // h(Y_i) X_j - h(X_i) Y_j
      return plane_->drop(combination(at_y[i], trace.first[j], at_x[i], trace.last[j]));
    };
    const auto h00 = point(0, 0), h01 = point(0, 1), h10 = point(1, 0), h11 = point(1, 1);
    PlaneCurve curve{.id = static_cast<int>(out_.curves.size()),
                     .from = curve_end_at(piece.range[0]),
                     .to = curve_end_at(piece.range[1])};
    const auto quadratic = [&](int i) {
      return rational_quadratic({h00[i], h01[i] + h10[i], h11[i]});
    };
    curve.x = quadratic(0);
    curve.y = quadratic(1);
    curve.w = quadratic(2);
    // The weight has one sign on the piece.
    const Rational middle((piece.rounded[0] + piece.rounded[1]) / 2);
    if (curve.w[0] + middle * (curve.w[1] + middle * curve.w[2]) < 0) {
      for (auto* q : {&curve.x, &curve.y, &curve.w}) {
        for (Rational& c : *q) c = -c;
      }
    }
    out_.curves.push_back(std::move(curve));
    out_.names.push_back(std::move(name));
  }

  [[nodiscard]] ReceiverCurves take() { return std::move(out_); }

 private:
  const ReceiverPlane* plane_;
  const SourcePatch* receiver_;
  ReceiverCurves out_;
};

}  // namespace

ReceiverCurves receiver_curves(const Scene& scene, const ReceiverPlane& plane,
                               const SourcePatch& receiver, const LightEvents& events,
                               std::span<const PieceOnFace> pieces) {
  CurveMaker maker(plane, receiver);
  const auto dropped = [&](const LightPoint& p) { return affine(plane.drop(p.exact)); };
  // Feet of blockers and sources.
  for (const SourcePatch::Side& side : receiver.sides) {
    if (side.foot_of < 0) continue;
    const int facet = scene.faces()[side.foot_of].facet;
    for (const auto& [a, b] : plane.clip(dropped(*side.ends[0]), dropped(*side.ends[1])))
      maker.add_segment(a, b,
                        {ShadowEdgeKind::Contact, {"facet " + std::to_string(facet)}});
  }
  // Planes of source faces.
  for (std::size_t k = 0; k < events.patches.size(); ++k) {
    const auto& p = events.patches[k].plane.exact;
    for (const auto& [a, b] :
         plane.cut_by({rational(p[0]), rational(p[1]), rational(p[2])}, rational(p[3])))
      maker.add_segment(a, b,
                        {ShadowEdgeKind::Plane, {"source face " + std::to_string(k)}});
  }
  // Traces.
  for (const auto& [t, i] : pieces) {
    const LightTrace& trace = events.traces[t];
    const LightTrace::Piece& piece = trace.pieces[i];
    ReceiverCurves::Name name{kind_of(trace.kind), {}};
    for (const LightFeature& g : trace.generators) {
      name.generators.push_back(told(g, trace.patch));
    }
    if (trace.straight) {
      maker.add_segment(affine(plane.drop(piece.ends[0])),
                        affine(plane.drop(piece.ends[1])), std::move(name));
    } else {
      maker.add_conic(trace, piece, std::move(name));
    }
  }
  return maker.take();
}

}  // namespace sightline::internal
