// What the library tells of a source's events; that they are complete and right is
// tested in tests/linespace/light_events_test.cpp.

#include "skeleton/source_events.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/add_box.h"

namespace sightline {
namespace {

void add_square(PolygonSoup& soup, const std::string& name, double half, double z,
                bool up) {
  const int v = static_cast<int>(soup.vertices.size());
  for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
    soup.vertices.emplace_back(x * half, y * half, z);
  }
  soup.polygons.push_back(up ? std::vector{v, v + 1, v + 2, v + 3}
                             : std::vector{v + 3, v + 2, v + 1, v});
  soup.groups.push_back({name, {static_cast<int>(soup.polygons.size()) - 1}});
}

SourceEvents events_of(const Scene& scene) {
  SourceEventsRequest request;
  request.source_faces = scene.faces_named("light");
  return source_events(scene, request);
}

TEST(SourceEvents, CountsOfASquareLightOverASquarePlate) {
  PolygonSoup soup;
  add_square(soup, "light", 1, 4, false);
  add_square(soup, "plate", 0.5, 2, true);
  add_square(soup, "floor", 8, 0, true);
  const SourceEvents events = events_of(Scene(soup));
  // A corner of either over each side of the other; each side over two parallel ones.
  EXPECT_EQ(events.counts().ev, 32U);
  EXPECT_EQ(events.counts().eee, 0U);
  EXPECT_EQ(events.counts().ee, 8U);
  EXPECT_EQ(events.counts().face, 0U);
  ASSERT_EQ(events.outlines.size(), 1U);
  EXPECT_EQ(events.outlines[0].sides.size(), 4U);
  EXPECT_EQ(events.outlines[0].corners.size(), 4U);
}

TEST(SourceEvents, InTheCeilingAsInMidAir) {
  PolygonSoup soup;
  add_square(soup, "light", 1, 4, false);
  add_square(soup, "plate", 0.5, 2, true);
  add_square(soup, "floor", 8, 0, true);
  const auto alone = events_of(Scene(soup)).counts();
  add_square(soup, "ceiling", 8, 4, false);
  const auto flush = events_of(Scene(soup)).counts();
  EXPECT_EQ(flush.ev, alone.ev);
  EXPECT_EQ(flush.ee, alone.ee);
}

// A wall of a box whose plane cuts the light: on the floor the trace of the wall's plane.
TEST(SourceEvents, FaceSeenEdgeOn) {
  PolygonSoup soup;
  add_square(soup, "light", 1, 4, false);
  testing::add_box(soup, "box", {-2, -3, 1}, {0.5, -2, 2});
  add_square(soup, "floor", 8, 0, true);
  const Scene scene(soup);
  const SourceEvents events = events_of(scene);
  const auto is_face = [](const SourceArc& a) { return a.kind == SourceArcKind::Face; };
  EXPECT_EQ(events.counts().face, 1U);
  for (const SourceArc& arc : events.arcs) {
    if (!is_face(arc)) continue;
    EXPECT_EQ(arc.facet, scene.faces()[scene.faces_named("#2-2")[0]].facet);
    for (const SourceArc::Piece& piece : arc.pieces) {
      for (const SourceCut& end : piece.ends) EXPECT_EQ(end.on_receiver.x(), 0.5);
    }
  }
}

// The shadow of a plate's edge on the floor ends where a box stands: told by polygon and
// edge, and exactly.
TEST(SourceEvents, EndsTellWhatCutsThem) {
  PolygonSoup soup;
  add_square(soup, "light", 1, 4, false);
  add_square(soup, "plate", 0.5, 3, true);
  testing::add_box(soup, "box", {0.25, -0.125, 0}, {0.75, 0.125, 1});
  add_square(soup, "floor", 8, 0, true);
  const Scene scene(soup);
  const SourceEvents events = events_of(scene);
  bool found = false;
  for (const SourceArc& arc : events.arcs) {
    for (const SourceArc::Piece& piece : arc.pieces) {
      EXPECT_LT(piece.ends[0].at, piece.ends[1].at);
      for (const SourceCut& end : piece.ends) {
        EXPECT_FALSE(end.exact.empty());
        found = found || (end.cause == SourceCut::Cause::FaceSide && end.id >= 2 &&
                          end.id < 8 && end.edge >= 0);
      }
    }
  }
  EXPECT_TRUE(found);
}

TEST(SourceEvents, SameOnOneThreadAndFour) {
  PolygonSoup soup;
  add_square(soup, "light", 1, 4, false);
  add_square(soup, "plate", 0.5, 3, true);
  testing::add_box(soup, "box", {0.25, -0.125, 0}, {0.75, 0.125, 1});
  add_square(soup, "floor", 8, 0, true);
  const Scene scene(soup);
  SourceEventsRequest request;
  request.source_faces = scene.faces_named("light");
  request.threads = 1;
  const SourceEvents one = source_events(scene, request);
  request.threads = 4;
  const SourceEvents four = source_events(scene, request);
  ASSERT_EQ(one.arcs.size(), four.arcs.size());
  for (std::size_t i = 0; i < one.arcs.size(); ++i) {
    EXPECT_EQ(one.arcs[i].generators, four.arcs[i].generators);
    EXPECT_EQ(one.arcs[i].pieces.size(), four.arcs[i].pieces.size());
  }
}

TEST(SourceEvents, RefusesNoSource) {
  PolygonSoup soup;
  add_square(soup, "floor", 8, 0, true);
  const Scene scene(soup);
  EXPECT_THROW((void)source_events(scene, {}), InvalidInput);
}

}  // namespace
}  // namespace sightline
