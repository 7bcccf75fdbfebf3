// Random pairs of surfaces with random blockers, for bounds on form factors.

#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "linespace/scene.h"

namespace sightline::testing {

using Corners = std::vector<Point>;

/// The six faces of an axis-aligned box.
inline std::vector<Corners> box_faces(const Point& low, const Point& high) {
  std::vector<Corners> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double at : {low[axis], high[axis]}) {
      Corners face(4, low);
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      face[1][u] = face[2][u] = high[u];
      face[2][v] = face[3][v] = high[v];
      for (Point& p : face) p[axis] = at;
      faces.push_back(face);
    }
  }
  return faces;
}

struct RandomPair {
  Corners from, to;
  std::vector<Corners> blockers;
};

/// Two unit squares, face to face or with a common side, or two triangles; among up to
/// four boxes on a grid or triangles.
inline RandomPair random_pair(int seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] { return Point{unit(random), unit(random), unit(random)}; };
  RandomPair pair{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                  {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}},
                  {}};
  if (seed % 3 == 1) {
    pair.to = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  } else if (seed % 3 == 2) {
    pair.from = {point(), point(), point()};
    pair.to = {point(), point(), point()};
    for (Point& p : pair.to) p.z() += 0.5;
  }
  const int count = 1 + static_cast<int>(4 * unit(random));
  for (int i = 0; i < count; ++i) {
    const Point at = point();
    if (seed % 4 == 0) {
      const Point low{std::round(8 * at.x()) / 8, std::round(8 * at.y()) / 8,
                      std::round(8 * at.z()) / 8};
      for (Corners& face : box_faces(low, low + Point{0.25, 0.125, 0.25})) {
        pair.blockers.push_back(std::move(face));
      }
    } else {
      const Point half = Point::Constant(0.25);
      pair.blockers.push_back({at + 0.5 * point() - half, at + 0.5 * point() - half,
                               at + 0.5 * point() - half});
    }
  }
  return pair;
}

}  // namespace sightline::testing
