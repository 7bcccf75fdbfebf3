// Closed objects turned inside out: from outside they are solids, their inside is air.

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "linespace/face_visibility.h"
#include "linespace/mesh_io.h"
#include "linespace/scene.h"
#include "skeleton/build.h"
#include "skeleton/skeleton_index.h"
#include "tests/support/ev_skeleton.h"
#include "tests/support/generators.h"
#include "tests/support/library_skeleton.h"

namespace sightline {
namespace {

using testing::AlignedBox;
using testing::CanonicalSkeleton;

Skeleton skeleton_of(const Scene& scene, EventMode events = EventMode::Solid) {
  SkeletonRequest request;
  request.events = events;
  return build_skeleton(scene, request);
}

CanonicalSkeleton canonical(const PolygonSoup& soup,
                            EventMode events = EventMode::Solid) {
  const Scene scene(soup);
  return testing::canonical(scene, skeleton_of(scene, events));
}

void turn(PolygonSoup& soup, const PolygonSoup::Group& group) {
  for (const int f : group.faces) std::ranges::reverse(soup.polygons[f]);
}
void turn(PolygonSoup& soup, const std::string& name) {
  for (const auto& group : soup.groups) {
    if (group.name == name) turn(soup, group);
  }
}

PolygonSoup boxes(const std::vector<AlignedBox>& all,
                  const std::vector<std::string>& names) {
  PolygonSoup soup = testing::boxes_soup(all);
  for (std::size_t i = 0; i < names.size(); ++i) soup.groups[i].name = names[i];
  return soup;
}

// Without the mark of two contacts on one object, in names of nodes and arcs.
std::vector<std::string> texts(const CanonicalSkeleton& skeleton) {
  std::vector<std::string> out;
  const auto generator_text = [](const testing::GeneratorKey& g) {
    std::string text(1, g.kind);
    for (const auto& p : g.points) {
      for (const double x : p) text += " " + std::to_string(x);
    }
    return text + ";";
  };
  const auto name = [](std::string kind) {
    if (const auto at = kind.find("_self"); at != std::string::npos) kind.erase(at, 5);
    return kind + ":";
  };
  for (const auto& node : skeleton.nodes) {
    out.push_back(name(node.kind));
    for (const auto& g : node.generators) out.back() += generator_text(g);
  }
  for (const auto& arc : skeleton.arcs) {
    out.push_back("arc " + name(arc.kind));
    for (const auto& g : arc.generators) out.back() += generator_text(g);
  }
  std::ranges::sort(out);
  return out;
}

// What one has and the other has not, at most three of each.
std::string difference(const std::vector<std::string>& a,
                       const std::vector<std::string>& b) {
  std::string out;
  const auto add = [&](const char* what, const auto& x, const auto& y) {
    std::vector<std::string> only;
    std::ranges::set_difference(x, y, std::back_inserter(only));
    if (!only.empty()) out += std::to_string(only.size()) + what;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, only.size()); ++i) {
      out += "\n  " + only[i];
    }
  };
  add(" only in the first", a, b);
  add("\nonly in the second", b, a);
  return out;
}

// What an object is does not matter but for the mark of self: a far triangle in its group
// makes a closed surface one of sheets.
void expect_same_as_sheets(PolygonSoup soup, const std::vector<std::string>& rooms,
                           const std::vector<EventMode>& modes = {EventMode::Solid,
                                                                  EventMode::Polygon}) {
  PolygonSoup sheets = soup;
  for (std::size_t k = 0; k < rooms.size(); ++k) {
    const double x = 1000 + 500 * static_cast<double>(k * k);
    const int far = static_cast<int>(soup.vertices.size());
    const int triangle = static_cast<int>(soup.polygons.size());
    for (PolygonSoup* to : {&soup, &sheets}) {
      to->vertices.emplace_back(x, 1001, 1003);
      to->vertices.emplace_back(x, 1002, 1009);
      to->vertices.emplace_back(x, 1005, 1004);
      to->polygons.push_back({far, far + 1, far + 2});
    }
    soup.groups.push_back({"far" + std::to_string(k), {triangle}});
    for (auto& group : sheets.groups) {
      if (group.name == rooms[k]) group.faces.push_back(triangle);
    }
  }
  ASSERT_EQ(Scene(sheets).defects().size() + rooms.size(), Scene(soup).defects().size());
  for (const EventMode mode : modes) {
    EXPECT_EQ(difference(texts(canonical(soup, mode)), texts(canonical(sheets, mode))),
              "")
        << (mode == EventMode::Solid ? "solid" : "polygon");
  }
}

// Two boxes whose faces are listed clockwise had no arcs at all.
TEST(Rooms, BoxesListedClockwiseAreSolids) {
  const std::string data = std::string(SIGHTLINE_TEST_DATA) + "/skeleton/";
  const Scene inward(read_mesh(data + "inward.obj"));
  EXPECT_EQ(testing::build_ev_skeleton(inward).arcs.size(), 112U);
  for (const EventMode mode : {EventMode::Solid, EventMode::Polygon}) {
    EXPECT_EQ(canonical(read_mesh(data + "inward.obj"), mode),
              canonical(read_mesh(data + "outward.obj"), mode));
  }
  for (const Object& object : inward.objects()) {
    EXPECT_TRUE(object.closed && object.convex && object.inside_out);
  }
  ASSERT_EQ(inward.defects().size(), 2U);
  EXPECT_EQ(inward.defects()[1].kind, "inside-out");
  EXPECT_EQ(inward.defects()[1].faces, (std::vector<int>{6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(inward.mesh_edges().reflex, 24);  // with the fronts of the file
  EXPECT_EQ(inward.edges()[0].kind, EdgeKind::Convex);
  EXPECT_EQ(inward.solids(), 2);
}

// Any of the objects of a scene, listed clockwise, in which nothing stands.
TEST(Rooms, EmptyOnesHaveTheSkeletonOfSolids) {
  testing::Random random(1);
  int turned = 0;
  const auto check = [&](const char* name, const PolygonSoup& soup) {
    SCOPED_TRACE(name);
    PolygonSoup some = soup;
    for (const auto& group : soup.groups) {
      if (random.one_in(2)) continue;
      turn(some, group);
      ++turned;
    }
    for (const EventMode mode : {EventMode::Solid, EventMode::Polygon}) {
      EXPECT_EQ(canonical(some, mode), canonical(soup, mode));
    }
  };
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    check("polytopes", testing::random_polytopes(seed, 4, {.density = 0.3}));
    check("boxes", testing::random_boxes(seed, 4));
    check("touching", testing::random_boxes(seed, 4, {.grid = 4, .may_touch = true}));
  }
  for (const auto kind : testing::all_touching()) {
    check(testing::name(kind).c_str(), testing::touching_boxes(kind));
  }
  check("city", testing::city(3, 30));
  check("grid", testing::grid_city(3, 30));
  EXPECT_GT(turned, 60);
}

const AlignedBox kRoom{{0, 0, 0}, {8, 6, 4}};

// With things in them they are what sheets in the same places are.
TEST(Rooms, WithThingsInsideAreSheets) {
  const std::vector<std::vector<AlignedBox>> things{
      {{{1, 1, 1}, {2, 2, 2.5}}},                          // floating
      {{{1, 1, 0}, {2, 2, 1.5}}, {{4, 3, 0}, {5, 5, 2}}},  // on the floor
      {{{0, 1, 1}, {2, 2, 3}}, {{6, 4, 0}, {8, 6, 4}}},    // at walls, in a corner
      {{{1, 1, 1}, {2, 2, 2}}, {{9, 1, 1}, {10, 2, 2}}},   // one outside
      {{{-1, 2, 1}, {3, 3, 2}}},                           // through a wall
      {{{-1, 2, 1}, {9, 3, 2}}},                           // right through
  };
  for (std::size_t i = 0; i < things.size(); ++i) {
    SCOPED_TRACE(i);
    std::vector<AlignedBox> all{kRoom};
    all.insert(all.end(), things[i].begin(), things[i].end());
    PolygonSoup soup = boxes(all, {"room"});
    turn(soup, "room");
    EXPECT_TRUE(Scene(soup).objects()[0].inside_out);
    expect_same_as_sheets(soup, {"room"});
  }
  // A room that is not convex, empty too: past its inner corner walls hide each other.
  PolygonSoup ell;
  for (const double z : {0.0, 3.0}) {
    for (const auto& [x, y] : std::vector<std::pair<double, double>>{
             {0, 0}, {6, 0}, {6, 2}, {2, 2}, {2, 5}, {0, 5}}) {
      ell.vertices.emplace_back(x, y, z);
    }
  }
  ell.polygons = {{0, 1, 2, 3, 4, 5}, {11, 10, 9, 8, 7, 6}};
  for (int k = 0; k < 6; ++k) {
    const int next = (k + 1) % 6;
    ell.polygons.push_back({k, k + 6, next + 6, next});
  }
  ell.groups = {{"room", {0, 1, 2, 3, 4, 5, 6, 7}}};
  EXPECT_TRUE(Scene(ell).objects()[0].inside_out);
  expect_same_as_sheets(ell, {"room"});
}

// Rooms with up to three things on a grid: inside, at walls, through them, outside;
// alone, with a room within the room, or beside one.
TEST(Rooms, OfAnySeedAreSheets) {
  int rooms = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    testing::Random random(seed);
    std::vector<AlignedBox> all{kRoom};
    std::vector<std::string> names{"room"};
    if (seed % 3 == 1) {
      const double gap = random.integer(0, 2);
      all.push_back({{8 + gap, 0, 0}, {14 + gap, 6, 4}});
      names.emplace_back("next");
    }
    const auto free = [&](const AlignedBox& box, double margin) {
      return std::ranges::none_of(all, [&](const AlignedBox& other) {
        if (&other == &all.front() || (names.size() == 2 && &other == &all[1]))
          return false;
        for (int axis = 0; axis < 3; ++axis) {
          if (box.max[axis] + margin <= other.min[axis] ||
              other.max[axis] + margin <= box.min[axis]) {
            return false;
          }
        }
        return true;
      });
    };
    // What stands empty is a solid.
    for (std::size_t k = names.size(); k > 0; --k) {
      const double x = all[k - 1].min[0] + random.integer(1, 4);
      all.push_back({{x, 2, 1}, {x + 1, 4, 2}});
    }
    for (int tries = 0; tries < 1 + static_cast<int>(seed % 2); ++tries) {
      AlignedBox box;
      for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = random.integer(-2, 7);
        box.max[axis] = box.min[axis] + random.integer(1, 3);
      }
      if (free(box, 0.5)) all.push_back(box);
    }
    PolygonSoup soup = boxes(all, names);
    for (const std::string& name : names) turn(soup, name);
    rooms += static_cast<int>(names.size());
    expect_same_as_sheets(soup, names,
                          {seed % 2 == 0 ? EventMode::Solid : EventMode::Polygon});
  }
  EXPECT_GT(rooms, 100);
}

// Two rooms with a wall in common, each with a box in it, and a box in neither.
TEST(Rooms, ThatTouchAreSheets) {
  PolygonSoup soup = boxes({kRoom,
                            {{8, 0, 0}, {14, 6, 4}},
                            {{2, 2, 0}, {3, 3, 2}},
                            {{10, 2, 1}, {11, 4, 2}},
                            {{4, 8, 1}, {5, 9, 3}}},
                           {"room", "next"});
  turn(soup, "room");
  turn(soup, "next");
  expect_same_as_sheets(soup, {"room", "next"});
}

// Inside a room one sees what one sees between slabs.
TEST(Rooms, InsideIsWhatSlabsShow) {
  const std::vector<AlignedBox> inside{
      {{1, 1, 0.5}, {2, 2.5, 1.5}}, {{4, 3, 0}, {5, 5, 2}}, {{6, 1, 2}, {7, 2, 3.5}}};
  std::vector<AlignedBox> all{kRoom};
  all.insert(all.end(), inside.begin(), inside.end());
  PolygonSoup room = boxes(all, {"room", "a", "b", "c"});
  turn(room, "room");
  std::vector<AlignedBox> slabs;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      AlignedBox slab{{-1, -1, -1}, {9, 7, 5}};
      if (high) {
        slab.min[axis] = kRoom.max[axis];
      } else {
        slab.max[axis] = kRoom.min[axis];
      }
      slabs.push_back(slab);
    }
  }
  slabs.insert(slabs.end(), inside.begin(), inside.end());
  const PolygonSoup walls = boxes(slabs, {"w0", "w1", "w2", "w3", "w4", "w5"});
  const auto inner_arcs = [&](const PolygonSoup& soup) {
    CanonicalSkeleton all_of_it = canonical(soup);
    std::multiset<std::string> arcs;
    for (const auto& arc : all_of_it.arcs) {
      const bool inner = std::ranges::all_of(arc.generators, [](const auto& g) {
        return std::ranges::all_of(g.points, [](const auto& p) {
          return p[0] > 0 && p[0] < 8 && p[1] > 0 && p[1] < 6 && p[2] >= 0 && p[2] < 4;
        });
      });
      if (!inner) continue;
      CanonicalSkeleton one;
      one.arcs = {arc};
      arcs.insert(texts(one).front());
    }
    return arcs;
  };
  const auto found = inner_arcs(room);
  EXPECT_EQ(found, inner_arcs(walls));
  EXPECT_GT(found.size(), 100U);
}

// A house with an inner and an outer shell, as one object or two: between them is no air.
TEST(Rooms, InsideASolidAreHollows) {
  const std::vector<AlignedBox> parts{{{-1, -1, -1}, {9, 7, 5}},
                                      kRoom,
                                      {{1, 1, 1}, {2, 2.5, 2}},
                                      {{4, 3, 0}, {5, 5, 2}},
                                      {{12, 1, 1}, {13, 2, 2}}};
  PolygonSoup two = boxes(parts, {"house", "room", "a", "b", "c"});
  turn(two, "room");
  PolygonSoup one = two;
  one.groups[0].faces.insert(one.groups[0].faces.end(), one.groups[1].faces.begin(),
                             one.groups[1].faces.end());
  one.groups.erase(one.groups.begin() + 1);
  EXPECT_EQ(Scene(two).defects().size(), 1U);
  EXPECT_TRUE(Scene(one).defects().empty());  // a cavity, as it should be
  for (const EventMode mode : {EventMode::Solid, EventMode::Polygon}) {
    EXPECT_EQ(difference(texts(canonical(two, mode)), texts(canonical(one, mode))), "");
  }
  // Outside: the house and the box beside it; inside: what slabs show.
  const PolygonSoup outer = boxes({parts[0], parts[4]}, {"house", "c"});
  const auto arcs = [](const PolygonSoup& soup, bool inside) {
    CanonicalSkeleton all = canonical(soup);
    all.nodes.clear();
    std::erase_if(all.arcs, [&](const testing::ArcKey& arc) {
      return std::ranges::any_of(arc.generators, [&](const testing::GeneratorKey& g) {
        return std::ranges::any_of(g.points, [&](const testing::Coordinates& p) {
          const bool in = p[0] >= 0 && p[0] <= 8 && p[1] >= 0 && p[1] <= 6;
          return in != inside;
        });
      });
    });
    return texts(all);
  };
  // Lines in the planes of a convex solid's own faces are told where it is hollow.
  std::vector<std::string> told = arcs(two, false);
  std::erase_if(told, [](const std::string& t) {
    return t.find(" 12.") == t.npos && t.find(" 13.") == t.npos;
  });
  EXPECT_EQ(difference(told, arcs(outer, false)), "");
  EXPECT_GT(told.size(), 50U);
  EXPECT_GT(arcs(two, true).size(), 50U);
}

// A solid in a room in a group of the same name; an object of which a part is turned.
TEST(Rooms, AreToldShellByShell) {
  PolygonSoup soup = boxes({kRoom, {{1, 1, 1}, {2, 2, 2}}, {{20, 0, 0}, {21, 1, 1}}},
                           {"room", "box", "other"});
  turn(soup, "room");
  turn(soup, "other");
  auto& faces = soup.groups[0].faces;
  for (const int k : {1, 2}) {
    faces.insert(faces.end(), soup.groups[k].faces.begin(), soup.groups[k].faces.end());
  }
  soup.groups.resize(1);
  const Scene scene(soup);
  ASSERT_EQ(scene.defects().size(), 2U);
  EXPECT_EQ(scene.defects()[0].faces, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(scene.defects()[1].faces, (std::vector<int>{12, 13, 14, 15, 16, 17}));
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    EXPECT_EQ(scene.solid_behind(static_cast<int>(f)), f / 6 == 1) << f;
    EXPECT_EQ(scene.turned(static_cast<int>(f)), f / 6 != 1) << f;
  }
  EXPECT_EQ(scene.solids(), 3);
}

// Faces of a room see each other through its air, and what stands in it.
TEST(Rooms, WallsSeeWhatIsInside) {
  PolygonSoup soup = boxes({kRoom, {{1, 1, 1}, {2, 2, 2}}, {{12, 1, 1}, {13, 2, 2}}},
                           {"room", "in", "out"});
  turn(soup, "room");
  const Scene scene(soup);
  const auto visible = [&](const char* a, const char* b) {
    const FaceVisibility faces(scene);
    return faces.between(scene.faces_named(a), scene.faces_named(b), false).verdict;
  };
  EXPECT_EQ(visible("room", "in"), Verdict::Visible);
  EXPECT_EQ(visible("room", "out"), Verdict::Visible);
  EXPECT_EQ(visible("in", "out"), Verdict::Hidden);
  EXPECT_EQ(visible("#0-0", "#1-5"), Verdict::Visible);
}

}  // namespace
}  // namespace sightline
