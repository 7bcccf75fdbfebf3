#include "skeleton/source_events.h"

#include <CGAL/Gmpq.h>

#include <algorithm>
#include <set>

#include "linespace/light/light_events.h"
#include "linespace/numbers/exact_position.h"

namespace sightline {
namespace {

using internal::CutCause;
using internal::Four;
using internal::LightFeature;
using internal::LightTrace;
using internal::Rational;
using internal::Ring;

Rational rational(const Ring& x) { return Rational(CGAL::Gmpq(x).mpq()); }

ExactPosition position(const Four<Ring>& p) {
  const Rational w = rational(p[3]);
  return internal::exact_position(
      {rational(p[0]) / w, rational(p[1]) / w, rational(p[2]) / w});
}

std::string text_of(const internal::QuadraticRoot& s) {
  const Rational c = rational(s.c);
  const Rational a = rational(s.a) / c;
  const Rational b = rational(s.b) / c;
  if (b == 0 || internal::is_zero(s.d)) return a.str();
  return "(" + a.str() + ") + (" + b.str() + ") * sqrt(" + rational(s.d).str() + ")";
}

SourceGenerator generator(const LightFeature& f) {
  return {static_cast<SourceGenerator::Kind>(f.kind), f.id};
}

// Where the line at a rounded position meets the face's plane.
Point end_on(const LightTrace& trace, const internal::LightPlane& plane, double s) {
  const auto at = [&](const std::array<Four<Ring>, 2>& p) {
    return internal::combination(Ring(Ring(1) - Ring(s)), p[0], Ring(-Ring(s)), p[1]);
  };
  const Four<Ring> x = at(trace.first);
  const Four<Ring> y = at(trace.last);
  const Four<Ring> p = internal::combination(internal::value(plane.exact, y), x,
                                             internal::value(plane.exact, x), y);
  if (internal::is_zero(p[3])) return Point::Zero();
  return internal::light_point(p).rounded;
}

SourceCut cut(const Scene& scene, const CutCause& cause) {
  SourceCut out{};
  switch (cause.kind) {
    case CutCause::Kind::Limit:
    case CutCause::Kind::Generator:
      out.cause = SourceCut::Cause::GeneratorEnd;
      break;
    case CutCause::Kind::FaceSide:
      out.cause = SourceCut::Cause::FaceSide;
      out.id = scene.faces()[cause.id].source;
      out.edge = scene.edge_of_side(cause.id, cause.index);
      break;
    case CutCause::Kind::SourceSide:
      out.cause = SourceCut::Cause::SourceSide;
      out.id = cause.id;
      break;
    case CutCause::Kind::Pierce:
      out.cause = SourceCut::Cause::Pierce;
      out.id = scene.faces()[cause.id].source;
      break;
    case CutCause::Kind::Crossing:
      out.cause = SourceCut::Cause::Crossing;
      break;
  }
  return out;
}

SourceArc arc_of(const internal::LightSpace& space, const LightTrace& trace) {
  const Scene& scene = space.scene();
  SourceArc arc{static_cast<SourceArcKind>(trace.kind),
                trace.patch,
                {},
                {},
                trace.kind == internal::LightEventKind::Face ? trace.facet : -1,
                !trace.straight,
                {}};
  for (const LightFeature& f : trace.generators) arc.generators.push_back(generator(f));
  if (trace.in_line) {
    arc.in_line = {generator((*trace.in_line)[0]), generator((*trace.in_line)[1])};
  }
  for (const LightTrace::Piece& piece : trace.pieces) {
    SourceArc::Piece out{scene.faces()[piece.face].source, piece.front, {}};
    for (int i = 0; i < 2; ++i) {
      SourceCut& end = out.ends[i];
      end = cut(scene, piece.causes[i]);
      end.at = piece.rounded[i];
      end.exact = text_of(piece.range[i]);
      end.on_receiver = trace.straight ? internal::light_point(piece.ends[i]).rounded
                                       : end_on(trace, space.faces()[piece.face].plane,
                                                piece.rounded[i]);
    }
    arc.pieces.push_back(std::move(out));
  }
  return arc;
}

SourceOutline outline_of(const Scene& scene, const internal::SourcePatch& patch) {
  SourceOutline out;
  for (const int f : patch.faces) out.polygons.push_back(scene.faces()[f].source);
  std::ranges::sort(out.polygons);
  const auto [end, last] = std::ranges::unique(out.polygons);
  out.polygons.erase(end, last);
  for (const internal::SourcePatch::Side& side : patch.sides) {
    out.sides.push_back({{position(side.ends[0]->exact), position(side.ends[1]->exact)},
                         side.foot_of < 0 ? -1 : scene.faces()[side.foot_of].source});
  }
  for (const internal::LightPoint* c : patch.corners) {
    out.corners.push_back(position(c->exact));
  }
  return out;
}

bool is_point(const SourceGenerator& g) {
  return g.kind == SourceGenerator::Kind::Vertex ||
         g.kind == SourceGenerator::Kind::SourceCorner ||
         g.kind == SourceGenerator::Kind::Touch;
}

// Pieces that follow each other are one part.
std::size_t parts_of(const SourceArc& arc) {
  std::size_t parts = 0;
  double reach = -1;
  for (const SourceArc::Piece& piece : arc.pieces) {
    if (piece.ends[0].at > reach) ++parts;
    reach = std::max(reach, piece.ends[1].at);
  }
  return parts;
}

}  // namespace

SourceEvents::Counts SourceEvents::counts() const {
  Counts out;
  std::set<std::pair<int, std::array<SourceGenerator, 2>>> pairs;
  std::set<std::pair<int, int>> facets;
  for (const SourceArc& arc : arcs) {
    if (arc.in_line) {
      std::array<SourceGenerator, 2> pair = *arc.in_line;
      std::ranges::sort(pair);
      if (arc.kind == SourceArcKind::Face) facets.insert({arc.outline, arc.facet});
      if (arc.kind == SourceArcKind::EE) pairs.insert({arc.outline, pair});
    }
    if (arc.curved) out.eee += parts_of(arc);
    if (arc.generators.size() == 2 && is_point(arc.generators[0])) {
      out.ev += parts_of(arc);
    }
  }
  out.ee = pairs.size();
  out.face = facets.size();
  return out;
}

SourceEvents source_events(const Scene& scene, const SourceEventsRequest& request) {
  if (request.source_faces.empty()) throw InvalidInput("a source needs a face at least");
  const internal::LightSpace space(scene, request);
  internal::LightEventsRequest asked;
  static_cast<Request&>(asked) = request;
  asked.source_faces = request.source_faces;
  asked.receivers = request.receivers;
  asked.receive_behind = request.receivers_behind;
  const internal::LightEvents found = internal::light_events(space, asked);
  SourceEvents out;
  out.complete = found.complete;
  for (const internal::SourcePatch& patch : found.patches) {
    out.outlines.push_back(outline_of(scene, patch));
  }
  for (const internal::EdgeTouch& touch : space.touches()) {
    out.touches.push_back(
        {{space.edges()[touch.edges[0]].edge, space.edges()[touch.edges[1]].edge},
         position(touch.point.exact)});
  }
  out.arcs.reserve(found.traces.size());
  for (const LightTrace& trace : found.traces) {
    out.arcs.push_back(arc_of(space, trace));
  }
  return out;
}

}  // namespace sightline
