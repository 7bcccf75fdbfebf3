#include "linespace/face_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "linespace/visibility_cover.h"
#include "tests/support/add_box.h"
#include "tests/support/generators.h"
#include "tests/support/invariant_scenes.h"

namespace sightline::testing {
namespace {

std::vector<int> faces_of(const Scene& scene, const std::string& object) {
  return scene.faces_named(object);
}

Verdict between(const Scene& scene, const std::string& a, const std::string& b) {
  const FaceVisibility visibility(scene);
  return visibility.between(faces_of(scene, a), faces_of(scene, b), false).verdict;
}

// Two boxes, and a wall between them that may have a window.
Scene two_boxes(const std::vector<AlignedBox>& wall) {
  std::vector<AlignedBox> boxes{{{0, 0, 0}, {1, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}};
  boxes.insert(boxes.end(), wall.begin(), wall.end());
  return Scene(boxes_soup(boxes));
}

TEST(FaceVisibility, AWallHidesAndAWindowShows) {
  EXPECT_EQ(between(two_boxes({}), "box0", "box1"), Verdict::Visible);
  EXPECT_EQ(between(two_boxes({{{2, -9, -9}, {3, 9, 9}}}), "box0", "box1"),
            Verdict::Hidden);
  // Two walls that touch; then with a slit of 2^-30.
  EXPECT_EQ(between(two_boxes({{{2, -9, -9}, {3, 0.5, 9}}, {{2, 0.5, -9}, {3, 9, 9}}}),
                    "box0", "box1"),
            Verdict::Hidden);
  EXPECT_EQ(between(two_boxes({{{2, -9, -9}, {3, 0.5, 9}},
                               {{2, 0.5 + 0x1p-30, -9}, {3, 9, 9}}}),
                    "box0", "box1"),
            Verdict::Visible);
}

TEST(FaceVisibility, FacesOfABoxSeeEachOtherInside) {
  const Scene scene = two_boxes({});
  const FaceVisibility visibility(scene);
  // Faces are walls that see to both sides.
  const std::vector<int> faces = faces_of(scene, "box0");
  for (const int a : faces) {
    for (const int b : faces) {
      const Verdict expected = a == b ? Verdict::Hidden : Verdict::Visible;
      EXPECT_EQ(visibility.between(a, b).answer.verdict, expected) << a << " " << b;
    }
  }
}

// Three boxes in a row, glued together: what is between their faces is material.
TEST(FaceVisibility, GluedBoxesDoNotSeeThroughEachOther) {
  const AlignedBox first{{0, 0, 0}, {1, 1, 1}}, last{{2, 0, 0}, {3, 1, 1}};
  const auto in_row = [&](const AlignedBox& middle) {
    return Scene(boxes_soup({first, middle, last}));
  };
  // The middle one as large, larger: all pairs are hidden.
  for (const double more : {0.0, 0.5}) {
    const Scene scene = in_row({{1, -more, -more}, {2, 1 + more, 1 + more}});
    EXPECT_EQ(between(scene, "box0", "box2"), Verdict::Hidden) << more;
    EXPECT_EQ(between(scene, "box2", "box0"), Verdict::Hidden) << more;
  }
  const Scene row = in_row({{1, 0, 0}, {2, 1, 1}});
  EXPECT_EQ(between(row, "box0", "box1"), Verdict::Hidden);
  EXPECT_EQ(between(row, "box1", "box2"), Verdict::Hidden);
  // Around a lower one they see each other; an equal one a hair away hides nothing of the
  // first from itself.
  EXPECT_EQ(between(in_row({{1, 0, 0}, {2, 1, 0.5}}), "box0", "box2"), Verdict::Visible);
  EXPECT_EQ(between(in_row({{1 + 0x1p-30, 0, 0}, {2, 1, 1}}), "box0", "box1"),
            Verdict::Visible);
}

// A quad given by its corners, as an object.
void add_quad(PolygonSoup& soup, const std::string& name, const std::vector<Point>& at) {
  std::vector<int> quad;
  for (const Point& p : at) {
    quad.push_back(static_cast<int>(soup.vertices.size()));
    soup.vertices.push_back(p);
  }
  soup.groups.push_back({name, {static_cast<int>(soup.polygons.size())}});
  soup.polygons.push_back(quad);
}

// A sheet of which a part only lies on a box sees what touches another side of the box by
// its other part alone.
TEST(FaceVisibility, PartsGluedToABoxDoNotSeeThroughIt) {
  const auto verdict = [](double from, bool with_lid, double top) {
    PolygonSoup soup;
    add_box(soup, "box", {0, 0, 0}, {4, 4, 4});
    // Below the box, from x = `from` on; a wall against its side x = 0, up to `top`; and
    // a lid around all else that the wall shows.
    add_quad(soup, "sheet", {{from, 1, 0}, {3, 1, 0}, {3, 3, 0}, {from, 3, 0}});
    add_quad(soup, "wall", {{0, 1, -top}, {0, 1, 3}, {0, 3, 3}, {0, 3, -top}});
    if (with_lid) {
      add_quad(soup, "lid", {{-9, -9, -0.5}, {9, -9, -0.5}, {9, 9, -0.5}, {-9, 9, -0.5}});
      add_quad(soup, "skirt",
               {{0.5, -9, -0.5}, {0.5, 9, -0.5}, {0.5, 9, 0}, {0.5, -9, 0}});
    }
    return between(Scene(soup), "sheet", "wall");
  };
  // Glued as a whole; then reaching past the wall, of which it sees the outer side.
  EXPECT_EQ(verdict(1, false, 0), Verdict::Hidden);
  EXPECT_EQ(verdict(-1, false, 0), Verdict::Visible);
  // A wall that goes on below the sheet's plane is seen there, unless the skirt hides it.
  EXPECT_EQ(verdict(1, false, 1), Verdict::Visible);
  EXPECT_EQ(verdict(1, true, 0.25), Verdict::Hidden);
  EXPECT_EQ(verdict(1, true, 1), Verdict::Hidden);
}

// Sheet and wall cross, or the sheet ends at the wall, between four quarters of space:
// they see each other as long as one of the quarters that both reach into is open.
TEST(FaceVisibility, SheetAndWallMeetBetweenBoxes) {
  const std::array<AlignedBox, 4> quarters{{{{0, 0, 0}, {4, 4, 4}},
                                            {{-4, 0, 0}, {0, 4, 4}},
                                            {{-4, 0, -4}, {0, 4, 0}},
                                            {{0, 0, -4}, {4, 4, 0}}}};
  for (int filled = 0; filled < 16; ++filled) {
    std::vector<AlignedBox> boxes;
    for (int i = 0; i < 4; ++i) {
      if (filled >> i & 1) boxes.push_back(quarters[i]);
    }
    for (const double end : {3.0, 0.0}) {
      PolygonSoup soup = boxes_soup(boxes);
      add_quad(soup, "sheet", {{-3, 1, 0}, {end, 1, 0}, {end, 3, 0}, {-3, 3, 0}});
      add_quad(soup, "wall", {{0, 1, -3}, {0, 1, 3}, {0, 3, 3}, {0, 3, -3}});
      const int reached = end > 0 ? 0b1111 : 0b0110;
      EXPECT_EQ(between(Scene(soup), "sheet", "wall"),
                (filled & reached) == reached ? Verdict::Hidden : Verdict::Visible)
          << filled << ' ' << end;
    }
  }
}

TEST(FaceVisibility, CutsOfFacesChangeNothing) {
  int visible = 0, hidden = 0;
  for (const Crowd crowd : {Crowd::Touching, Crowd::RepeatedFaces, Crowd::Overlapping}) {
    for (std::uint64_t seed = 230; seed < 260; ++seed) {
      const PolygonSoup soup = crowded_scene(crowd, seed);
      const Scene scene(soup);
      std::vector<Scene> cut;
      for (const Variant& v : variants_of(soup, seed)) {
        if (v.name == "facets") cut.emplace_back(v.soup);
      }
      ASSERT_EQ(cut.size(), 1U);
      for (const PolygonSoup::Group& a : soup.groups) {
        for (const PolygonSoup::Group& b : soup.groups) {
          if (&b <= &a) continue;
          const Verdict verdict = between(scene, a.name, b.name);
          ++(verdict == Verdict::Visible ? visible : hidden);
          EXPECT_EQ(between(cut.front(), a.name, b.name), verdict)
              << name(crowd) << ' ' << seed << ": " << a.name << ' ' << b.name;
        }
      }
    }
  }
  EXPECT_GT(visible, 500);
  EXPECT_GT(hidden, 50);
}

// A room is a box turned inside out: its inside is air, and its walls see each other and
// what lies flush on them.
TEST(FaceVisibility, WallsOfARoomSeeEachOtherAndWhatLiesOnThem) {
  PolygonSoup soup;
  add_box(soup, "room", {0, 0, 0}, {4, 4, 3});
  for (auto& polygon : soup.polygons) std::ranges::reverse(polygon);
  for (const auto& [x, y] : {std::pair(1, 1), {2, 1}, {2, 2}, {1, 2}}) {
    soup.vertices.emplace_back(x, y, 0);
  }
  soup.polygons.push_back({8, 9, 10, 11});
  soup.groups.push_back({"rug", {6}});
  add_box(soup, "outside", {6, 1, 1}, {7, 2, 2});
  const Scene scene(soup);
  ASSERT_TRUE(scene.objects()[0].inside_out);
  const FaceVisibility visibility(scene);
  const std::vector<int> walls = faces_of(scene, "room");
  for (const int a : walls) {
    for (const int b : walls) {
      const Verdict expected = a == b ? Verdict::Hidden : Verdict::Visible;
      EXPECT_EQ(visibility.between({&a, 1}, {&b, 1}, false).verdict, expected)
          << a << " " << b;
    }
  }
  EXPECT_EQ(between(scene, "room", "rug"), Verdict::Visible);
  EXPECT_EQ(between(scene, "rug", "outside"), Verdict::Hidden);
  EXPECT_EQ(between(scene, "room", "outside"), Verdict::Visible);
}

TEST(FaceVisibility, AllPairsAgreeWithAskingWithAllFacesAsOccluders) {
  std::vector<AlignedBox> boxes;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double x = 2.0 * i, y = 2.0 * j;
      boxes.push_back({{x, y, 0}, {x + 1 + 0.5 * (i % 2), y + 1, 1.0 + j}});
    }
  }
  const Scene scene(boxes_soup(boxes));
  const FaceVisibility visibility(scene);
  const std::vector<int> as = faces_of(scene, scene.objects()[0].name);
  const std::vector<int> bs = faces_of(scene, scene.objects()[8].name);
  VisibilityRequest request;
  request.keep_cover = true;
  const GroupAnswer group = visibility.between(as, bs, true, request);
  ASSERT_EQ(group.pairs.size(), as.size() * bs.size());
  int hidden = 0;
  for (const FacePairAnswer& pair : group.pairs) {
    VisibilityQuestion whole = visibility.question_of(pair);
    const VisibilityQuestion used = whole;
    whole.occluders.clear();
    for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
      const auto in_plane_of = [&](int end) {
        const auto e = scene.face_points(end);
        for (const int p : scene.face_points(f)) {
          if (orient3d(scene.point(e[0]), scene.point(e[1]), scene.point(e[2]),
                       scene.point(p)) != Sign::Zero)
            return false;
        }
        return true;
      };
      if (in_plane_of(pair.a) || in_plane_of(pair.b)) continue;
      Polygon& polygon = whole.occluders.emplace_back();
      for (const int p : scene.face_points(f)) polygon.push_back(scene.point(p));
    }
    EXPECT_EQ(polygon_visibility(whole).verdict, pair.answer.verdict)
        << pair.a << " " << pair.b;
    if (pair.answer.cover) {
      ++hidden;
      EXPECT_EQ(check_cover(used, *pair.answer.cover), std::nullopt);
    }
  }
  EXPECT_GT(hidden, 0);
}

TEST(FaceVisibility, AnswerDoesNotDependOnThreads) {
  std::vector<AlignedBox> boxes;
  for (int i = 0; i < 20; ++i) {
    const double x = 1.5 * (i % 5), y = 1.5 * (i / 5);
    boxes.push_back({{x, y, 0}, {x + 1, y + 1, 1.0 + i % 3}});
  }
  const Scene scene(boxes_soup(boxes));
  const FaceVisibility visibility(scene);
  const std::vector<int> as = faces_of(scene, "box0");
  const std::vector<int> bs = faces_of(scene, "box19");
  VisibilityRequest one;
  one.threads = 1;
  VisibilityRequest two;
  two.threads = 2;
  for (const bool all : {false, true}) {
    const GroupAnswer x = visibility.between(as, bs, all, one);
    const GroupAnswer y = visibility.between(as, bs, all, two);
    EXPECT_EQ(x.verdict, y.verdict);
    EXPECT_EQ(x.pairs_hidden, y.pairs_hidden);
    EXPECT_EQ(x.cost.cells, y.cost.cells);
    ASSERT_EQ(x.visible.has_value(), y.visible.has_value());
    if (x.visible) {
      EXPECT_EQ(x.visible->a, y.visible->a);
      EXPECT_EQ((*x.visible->answer.witness)[0].exact,
                (*y.visible->answer.witness)[0].exact);
    }
  }
}

TEST(FaceVisibility, RefusesFacesThatAreNotThere) {
  const Scene scene = two_boxes({});
  const FaceVisibility visibility(scene);
  EXPECT_THROW((void)visibility.between(0, 99), InvalidInput);
  EXPECT_THROW((void)visibility.between(-1, 0), InvalidInput);
}

}  // namespace
}  // namespace sightline::testing
