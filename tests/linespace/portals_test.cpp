#include "linespace/portals.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "linespace/scene.h"
#include "tests/support/naive_stabbing.h"
#include "tests/support/random_geometry.h"

namespace sightline {
namespace {

using testing::naive_extremal_lines;
using testing::NaivePortal;
using testing::RandomGeometry;
using testing::Terrain;
using Portals = std::vector<NaivePortal>;

PortalSequence sequence(const Portals& portals) {
  PortalSequence s;
  for (const NaivePortal& p : portals) s.push(p);
  return s;
}

std::map<std::string, int> counts(const PortalSequence& s) {
  std::map<std::string, int> out;
  for (const ExtremalStabbingLine& l : s.extremal_lines())
    ++out[std::string(name(l.kind))];
  return out;
}

std::string places(const ExtremalStabbingLine& l, bool turned) {
  std::vector<StabbingContact> contacts = l.contacts;
  if (turned) std::ranges::reverse(contacts);
  std::string out;
  for (const StabbingContact& c : contacts) {
    std::set<std::string> names;
    for (const PortalGenerator& g : c.generators) {
      names.insert((g.kind == PortalGenerator::Kind::Vertex ? "V" : "E") +
                   std::to_string(g.portal) + "." + std::to_string(g.index));
    }
    for (const std::string& n : names) out += " " + n;
    out += ";";
  }
  return out;
}

/// As naive_extremal_lines describes lines, but the direction is that of the sequence.
std::vector<std::string> described(const PortalSequence& s) {
  std::vector<std::string> out;
  for (const ExtremalStabbingLine& l : s.extremal_lines()) {
    std::string planes;
    for (const int p : l.planes) planes += " P" + std::to_string(p);
    out.push_back(std::string(name(l.kind)) + ":" + places(l, false) + planes);
  }
  std::ranges::sort(out);
  return out;
}

/// The same with the smaller of both directions.
std::string undirected(const std::string& line) {
  const std::size_t colon = line.find(':'), end = line.rfind(';');
  if (end == std::string::npos) return line;
  std::vector<std::string> parts;
  std::string part;
  for (std::size_t i = colon + 1; i <= end; ++i) {
    part += line[i];
    if (line[i] == ';') parts.push_back(std::exchange(part, {}));
  }
  std::string there, back;
  for (const std::string& p : parts) {
    there += p;
    back = p + back;
  }
  return line.substr(0, colon + 1) + std::min(there, back) + line.substr(end + 1);
}
std::vector<std::string> undirected(std::vector<std::string> lines) {
  for (std::string& l : lines) l = undirected(l);
  std::ranges::sort(lines);
  return lines;
}

std::string text(const Portals& portals) {
  std::string out;
  for (const NaivePortal& p : portals) {
    out += "[";
    for (const auto& v : p) {
      out += "(" + std::to_string(v.x()) + "," + std::to_string(v.y()) + "," +
             std::to_string(v.z()) + ")";
    }
    out += "]\n";
  }
  return out;
}

NaivePortal square(double z, double x0 = 0, double y0 = 0, double side = 1) {
  return {{x0, y0, z}, {x0 + side, y0, z}, {x0 + side, y0 + side, z}, {x0, y0 + side, z}};
}

/// A window of a building on a small grid: a rectangle across an axis, sometimes a slit
/// or a point.
NaivePortal window(RandomGeometry& random, int grid, bool degenerate) {
  const int axis = random.integer(0, 2), u = (axis + 1) % 3, v = (axis + 2) % 3;
  Eigen::Vector3d low, high;
  for (int k = 0; k < 3; ++k) {
    low[k] = random.integer(0, grid - 1);
    high[k] = random.integer(static_cast<int>(low[k]) + 1, grid);
  }
  high[axis] = low[axis];
  if (degenerate && random.one_in(3)) high[u] = low[u];
  if (degenerate && random.one_in(6)) high[v] = low[v];
  NaivePortal p{low, low, high, high};
  p[1][u] = high[u];
  p[3][u] = low[u];
  NaivePortal out;
  for (const auto& x : p) {
    if (std::ranges::find(out, x) == out.end()) out.push_back(x);
  }
  return out;
}

/// A triangle or a parallelogram about a place along the z axis; integers keep it planar.
NaivePortal facing(RandomGeometry& random, double z) {
  for (;;) {
    const auto vector = [&](int n) {
      return Eigen::Vector3d(random.integer(-n, n), random.integer(-n, n),
                             random.integer(-1, 1));
    };
    const Eigen::Vector3d at = vector(3) + Eigen::Vector3d(0, 0, z);
    const Eigen::Vector3d a = vector(9), b = vector(9);
    if (std::abs(a.cross(b).z()) < 20) continue;
    if (random.one_in(2)) return {at - a, at - b, at + a, at + b};
    return {at + a, at + b, at - a - b};
  }
}

TEST(PortalSequence, TwoParallelSquaresHaveSixteenVv) {
  const PortalSequence s = sequence({square(0), square(3)});
  EXPECT_TRUE(s.stabbable());
  EXPECT_EQ(counts(s), (std::map<std::string, int>{{"VV", 16}}));
}

// Between them a square of half the size.  A line meets z = 1 in the middle of its points
// at z = 0 and z = 2.  Through the small corner (1/4, 1/4) the point p at z = 0 goes with
// 1/2 - p at z = 2: p runs over [0, 1]^2 and its mirror image [-1/2, 1/2]^2, that is
// [0, 1/2]^2.  There p = (0, 0) is a corner below (VV), p = (1/2, 1/2) goes to the corner
// (0, 0) above (VV), p = (0, 1/2) touches an edge below and one above (EVE), and so does
// (1/2, 0).  Four small corners: 8 VV, 8 EVE.  Lines from corner to corner of the outer
// squares pass z = 1 in multiples of 1/2, and only (1/2, 1/2) is open: 4 VV.  Lines that
// touch the small square on an edge, x = 1/4 say, have x_0 + x_2 = 1/2, so four edges
// would be a corner (x_0 = 0, x_2 = 1/2) of a family in which y moves freely until it is
// held in two places: y_0 and y_2 in {0, 1} with (y_0 + y_2) / 2 in [1/4, 3/4] is (0, 1)
// or (1, 0). So x_0 = 0, y_0 = 0 or 1 is a corner below, the edge x = 1/4, the edge y = 1
// or 0 above: VEE.  Four edges, x_0 or x_2 = 0, two y: 16 VEE.
TEST(PortalSequence, SquareBetweenTwoSquaresByHand) {
  const PortalSequence s = sequence({square(0), square(1, 0.25, 0.25, 0.5), square(2)});
  EXPECT_EQ(counts(s), (std::map<std::string, int>{{"VV", 12}, {"VEE", 16}, {"EVE", 8}}));
}

TEST(PortalSequence, AgreesWithTheNaiveEnumerationOnWindows) {
  RandomGeometry random(20);
  int stabbable = 0;
  for (int i = 0; i < 400; ++i) {
    Portals portals(random.integer(2, 4));
    const bool degenerate = random.one_in(2);
    const int grid = random.integer(2, 4);
    for (NaivePortal& p : portals) p = window(random, grid, degenerate);
    const PortalSequence s = sequence(portals);
    const std::vector<std::string> naive = naive_extremal_lines(portals);
    ASSERT_EQ(undirected(described(s)), undirected(naive)) << i << "\n" << text(portals);
    stabbable += s.stabbable();
  }
  EXPECT_GT(stabbable, 100);
  EXPECT_LT(stabbable, 380);
}

TEST(PortalSequence, AgreesWithTheNaiveEnumerationOnFacingPolygons) {
  RandomGeometry random(21);
  std::map<std::string, int> seen;
  for (int i = 0; i < 150; ++i) {
    Portals portals(random.integer(2, 5));
    for (std::size_t k = 0; k < portals.size(); ++k) {
      portals[k] = facing(random, 4.0 * static_cast<double>(k));
    }
    const PortalSequence s = sequence(portals);
    ASSERT_EQ(undirected(described(s)), undirected(naive_extremal_lines(portals)))
        << i << "\n"
        << text(portals);
    for (const auto& [kind, n] : counts(s)) seen[kind] += n;
  }
  for (const char* kind : {"VV", "VEE", "EVE", "EEEE"}) EXPECT_GT(seen[kind], 20) << kind;
}

}  // namespace
}  // namespace sightline
