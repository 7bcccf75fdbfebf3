#include "shadows/shadow_volumes.h"

#include <algorithm>
#include <span>

#include "linespace/numbers/exact_position.h"
#include "linespace/predicates.h"
#include "shadows/volumes/shadow_planes.h"

namespace sightline {

using namespace internal;

std::string_view name(ShadowSideKind kind) {
  switch (kind) {
    case ShadowSideKind::Facet:
      return "facet";
    case ShadowSideKind::SourceCorner:
      return "source corner";
    case ShadowSideKind::SourceEdge:
      return "source edge";
    case ShadowSideKind::SourcePlane:
      return "source plane";
    case ShadowSideKind::Box:
      break;
  }
  return "box";
}

namespace {

// Where the source shines from: the side of its faces in scene terms.
FaceSide shining_side(const Scene& scene, const LightSource& source) {
  if (!source.both_sides.empty()) {
    const auto both = std::ranges::find_if(source.both_sides, [&](int f) {
      return std::ranges::binary_search(source.faces, f);
    });
    if (both != source.both_sides.end()) {
      throw InvalidInput("the source: polygon " +
                         std::to_string(scene.faces()[*both].source) +
                         " shines from both sides; volumes are there for one");
    }
  }
  const bool turned = scene.turned(source.faces.front());
  for (const int f : source.faces) {
    if (scene.turned(f) != turned)
      throw InvalidInput("the source: some of its faces are listed inside out");
  }
  return turned ? FaceSide::Back : FaceSide::Front;
}

// In the box.  `half_spaces` are cut one after the other; planes[i] is of number i + 6.
CutPolyhedron cut_out(const Scene& scene, const std::vector<ShadowPlane>& planes) {
  CutPolyhedron body(exact_point(scene.bounds()[0]), exact_point(scene.bounds()[1]));
  for (std::size_t i = 0; i < planes.size(); ++i)
    body.cut(planes[i].inside, static_cast<int>(i) + 6);
  return body;
}

ShadowVolume volume_of(const CutPolyhedron& body,
                       const std::vector<ShadowPlane>& planes) {
  constexpr std::array kBoxSides = {"box x min", "box x max", "box y min",
                                    "box y max", "box z min", "box z max"};
  ShadowVolume out;
  for (const ExactPoint& p : body.points()) out.vertices.push_back(exact_position(p));
  for (const CutPolyhedron::Facet& facet : body.facets()) {
    ShadowVolume::Side& side = out.sides.emplace_back();
    side.corners = facet.corners;
    side.kind = ShadowSideKind::Box;
    for (const int number : facet.planes) {
      if (number < 6) {
        side.generators.emplace_back(kBoxSides[number]);
        continue;
      }
      const ShadowPlane& plane = planes[number - 6];
      side.kind = std::min(side.kind, plane.kind);
      side.generators.insert(side.generators.end(), plane.generators.begin(),
                             plane.generators.end());
    }
  }
  out.volume = nearest_double(body.volume());
  return out;
}

std::vector<ShadowPlane> joined(std::vector<ShadowPlane> a,
                                const std::vector<ShadowPlane>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

struct ShadowVolumes::Impl {
  Impl(const Scene& scene, const LightSource& light, const std::vector<int>& faces) {
    const PrecisionScope exact(Precision::Exact);
    // 1. The two bodies.
    const FaceSide side = shining_side(scene, light);
    const ConvexBody source = convex_body(scene, light.faces, side, "the source");
    const ConvexBody solid = convex_body(scene, faces, FaceSide::Front, "the solid");
    if (!source.flat && side == FaceSide::Back)
      throw InvalidInput("the source: a closed object that shines inwards");
    flat_source = source.flat;
    flat_solid = solid.flat;
    source_facets = body_planes(source, ShadowSideKind::SourcePlane);
    solid_facets = body_planes(solid, ShadowSideKind::Facet);

    // 2. What bounds the two volumes.
    all_umbra = umbra_planes(source, solid);
    all_shadow = shadow_planes(source, solid);
    if (all_shadow.empty())
      throw InvalidInput("the solid cuts the source: the volumes would not be convex");

    // 3. Cut off at the box, and at the plane of a flat source.
    std::vector<ShadowPlane> front;
    if (flat_source) {
      front.push_back(source_facets[1]);
      front.back().generators = {"source plane"};
    }
    const auto umbra_cuts = joined(front, all_umbra);
    const auto shadow_cuts = joined(front, all_shadow);
    const CutPolyhedron in_umbra = cut_out(scene, umbra_cuts);
    const CutPolyhedron in_shadow = cut_out(scene, shadow_cuts);
    umbra = volume_of(in_umbra, umbra_cuts);
    shadow = volume_of(in_shadow, shadow_cuts);
    const Rational hidden = in_shadow.volume(), box = cut_out(scene, {}).volume();
    const Rational away = flat_source ? Rational(box - cut_out(scene, front).volume())
                                      : cut_out(scene, source_facets).volume();
    penumbra_volume = nearest_double(hidden - in_umbra.volume());
    away_volume = nearest_double(away);
    lit_volume = nearest_double(box - away - hidden);
    solid_volume = nearest_double(cut_out(scene, joined(front, solid_facets)).volume());
  }

  // No face of the source shows the point its front.
  [[nodiscard]] bool away(const ExactPoint& p) const {
    if (flat_source) return source_facets[0].inside.sign(p) <= 0;
    return std::ranges::all_of(
        source_facets, [&](const ShadowPlane& s) { return s.inside.sign(p) <= 0; });
  }

  [[nodiscard]] ShadowClass at(const ExactPoint& p) const {
    if (away(p)) return ShadowClass::Umbra;
    // The inside of a solid first: a closed lamp in its hollow is refused.
    const auto certainly_in = [&](const ShadowPlane& s) { return s.inside.sign(p) < 0; };
    if (!flat_solid && std::ranges::all_of(solid_facets, certainly_in))
      return ShadowClass::Umbra;
    // A sheet is seen edge-on from its plane.
    if (flat_solid && solid_facets[0].inside.sign(p) == 0) return ShadowClass::Lit;
    if (!std::ranges::all_of(all_shadow, certainly_in)) return ShadowClass::Lit;
    const bool in_umbra = std::ranges::all_of(all_umbra, [&](const ShadowPlane& s) {
      const int sign = s.inside.sign(p);
      return sign < 0 || (sign == 0 && !s.open);
    });
    return in_umbra ? ShadowClass::Umbra : ShadowClass::Penumbra;
  }

  bool flat_source = false, flat_solid = false;
  std::vector<ShadowPlane> source_facets, solid_facets, all_umbra, all_shadow;
  ShadowVolume umbra, shadow;
  double penumbra_volume = 0, lit_volume = 0, away_volume = 0, solid_volume = 0;
};

ShadowVolumes::ShadowVolumes(const Scene& scene, const LightSource& source,
                             const std::vector<int>& solid)
    : impl_(std::make_unique<Impl>(scene, source, solid)) {}
ShadowVolumes::~ShadowVolumes() = default;
ShadowVolumes::ShadowVolumes(ShadowVolumes&&) noexcept = default;

const ShadowVolume& ShadowVolumes::umbra() const { return impl_->umbra; }
const ShadowVolume& ShadowVolumes::shadow() const { return impl_->shadow; }
double ShadowVolumes::penumbra_volume() const { return impl_->penumbra_volume; }
double ShadowVolumes::lit_volume() const { return impl_->lit_volume; }
double ShadowVolumes::away_volume() const { return impl_->away_volume; }
double ShadowVolumes::solid_volume() const { return impl_->solid_volume; }

ShadowClass ShadowVolumes::at(const ExactPosition& point) const {
  return impl_->at(exact_point(point));
}

}  // namespace sightline
