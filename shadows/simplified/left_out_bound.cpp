// The largest of min(F, sum of b) over the receivers, by branch and bound: F is the form
// factor of the source with nothing in the way, b a bound of what a part can take.
//
// Proof, in docs/shadows.md, "Feature size".  Numbers are doubles; what their rounding
// may lose is added at each step.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "linespace/work/stage.h"
#include "shadows/point_form_factor.h"
#include "shadows/small_blockers.h"

namespace sightline {

using namespace internal;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The search ends where the bound is within this factor of a value that is reached, or
/// after so many pieces.
constexpr double kSlack = 1.05;
constexpr int kMostPieces = 20'000;
/// Some twenty operations on distances, each to 2^-53.
constexpr double kRounding = 1 + 0x1p-40;

struct SourceFace {
  std::vector<Point> corners;  ///< counter-clockwise seen from where it shines
  Eigen::Vector3d normal;
  double area;
  Ball ball;
};

Ball ball_around(const std::vector<Point>& points) {
  Point low = points.front(), high = low;
  for (const Point& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Ball ball{(low + high) / 2, 0};
  for (const Point& p : points)
    ball.radius = std::max(ball.radius, (p - ball.centre).norm() * kRounding);
  return ball;
}

std::vector<Point> corners_of(const Scene& scene, int face, bool reversed) {
  std::vector<Point> corners;
  for (const int p : scene.face_points(face)) corners.push_back(scene.point(p));
  if (reversed) std::ranges::reverse(corners);
  return corners;
}

// Twice the area times the normal.
Eigen::Vector3d area_vector(const std::vector<Point>& corners) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k)
    sum += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]);
  return sum;
}

// A triangle of a receiver.
struct Piece {
  std::array<Point, 3> corners;
  Eigen::Vector3d normal;
  std::vector<int> parts;  ///< that may be in the way
  double bound = 0;
  friend bool operator<(const Piece& a, const Piece& b) { return a.bound < b.bound; }
};

class BoundSearch {
 public:
  BoundSearch(const Scene& scene, const LightSource& source,
              const std::vector<SmallPart>& parts) {
    for (const Point& corner : scene.bounds())
      coordinate_ = std::max(coordinate_, corner.cwiseAbs().maxCoeff());
    std::vector<Point> all;
    for (const int f : source.faces) {
      const bool both = std::ranges::binary_search(source.both_sides, f);
      for (const bool back : {false, true}) {
        if (back == !scene.turned(f) && !both) continue;
        SourceFace& face = source_.emplace_back();
        face.corners = corners_of(scene, f, back);
        const Eigen::Vector3d twice = area_vector(face.corners);
        face.area = twice.norm() / 2 * kRounding;
        face.normal = twice.normalized();
        face.ball = ball_around(face.corners);
        all.insert(all.end(), face.corners.begin(), face.corners.end());
      }
    }
    source_ball_ = ball_around(all);
    for (const SmallPart& part : parts) {
      std::vector<Point> points;
      for (const int f : part.faces) {
        const auto corners = corners_of(scene, f, false);
        points.insert(points.end(), corners.begin(), corners.end());
      }
      balls_.push_back(ball_around(points));
    }
  }

  // The source shines into nothing of the part, which is behind all of its faces.
  [[nodiscard]] bool is_behind(std::size_t part) const {
    const Ball& ball = balls_[part];
    return std::ranges::all_of(source_, [&](const SourceFace& face) {
      return face.normal.dot(ball.centre - face.corners[0]) + ball.radius + slack() < 0;
    });
  }

  void bound(Piece& piece) {
    const Ball cell = ball_around({piece.corners.begin(), piece.corners.end()});
    double sum = 0;
    std::vector<int> near;
    for (const int i : piece.parts) {
      const double b = part_bound(cell, piece.normal, balls_[i]);
      if (b == 0) continue;
      near.push_back(i);
      sum += b;
    }
    piece.parts = std::move(near);
    piece.bound = piece.parts.empty()
                      ? 0
                      : std::min(sum, source_bound(cell, piece.normal)) * kRounding;
    // What is reached in the middle.
    if (piece.bound <= reached_) return;
    const Ball middle{cell.centre, 0};
    double there = 0;
    for (const int i : piece.parts) there += part_bound(middle, piece.normal, balls_[i]);
    reached_ =
        std::max(reached_, std::min(there, open_factor(cell.centre, piece.normal)));
  }

  [[nodiscard]] double reached() const { return reached_; }

 private:
  // Differences of coordinates may be off by that much.
  [[nodiscard]] double slack() const { return coordinate_ * 0x1p-48; }

  // Of the part within `ball`, from any point of the cell.
  [[nodiscard]] double part_bound(const Ball& cell, const Eigen::Vector3d& normal,
                                  const Ball& ball) const {
    const double height = normal.dot(ball.centre - cell.centre) + slack();
    if (height <= -ball.radius - slack()) return 0;
    if (misses_shaft(cell, ball)) return 0;
    const double distance = (ball.centre - cell.centre).norm() - cell.radius - slack();
    if (!(distance > ball.radius)) return kInfinity;
    const double sine = ball.radius / distance;
    return sine * sine * std::min(1.0, std::max(height / distance, sine)) * kRounding;
  }

  // The ball meets no segment from the cell to the source: it is apart from all balls
  // between the two around them.
  [[nodiscard]] bool misses_shaft(const Ball& cell, const Ball& ball) const {
    const Eigen::Vector3d way = source_ball_.centre - cell.centre;
    const Eigen::Vector3d to = ball.centre - cell.centre;
    const double length = way.norm(), grows = source_ball_.radius - cell.radius;
    const auto gap = [&](double t) {
      return (to - t * way).norm() - (cell.radius + t * grows);
    };
    double least = std::min(gap(0), gap(1));
    if (length > std::abs(grows)) {
      const double t0 = to.dot(way) / (length * length);
      const double beside = (to - t0 * way).norm();
      const double root = std::sqrt(length * length - grows * grows);
      least = std::min(least,
                       gap(std::clamp(t0 + grows * beside / (length * root), 0.0, 1.0)));
    }
    return least > ball.radius + slack();
  }

  [[nodiscard]] double open_factor(const Point& p, const Eigen::Vector3d& normal) const {
    double sum = 0;
    for (const SourceFace& face : source_) {
      if (face.normal.dot(p - face.corners[0]) > 0)
        sum += point_form_factor(p, normal, face.corners);
    }
    return sum;
  }

  // Of the source with nothing in the way, from any point of the cell: by the largest
  // cosines and the least distance; or by the middle and the largest gradient.
  [[nodiscard]] double source_bound(const Ball& cell,
                                    const Eigen::Vector3d& normal) const {
    double by_cosines = 0, by_gradient = open_factor(cell.centre, normal) + 1e-14;
    for (const SourceFace& face : source_) {
      const double before =
          face.normal.dot(cell.centre - face.corners[0]) + cell.radius + slack();
      if (before <= 0) continue;
      double above = 0;
      for (const Point& s : face.corners)
        above = std::max(above, normal.dot(s - cell.centre) + slack());
      const double distance = (face.ball.centre - cell.centre).norm() - face.ball.radius -
                              cell.radius - slack();
      if (!(distance > 0)) return 1;
      const double share = face.area / (std::numbers::pi * distance * distance);
      by_cosines +=
          share * std::min(1.0, above / distance) * std::min(1.0, before / distance);
      by_gradient += share * 6 * cell.radius / distance;
    }
    return std::min({1.0, by_cosines, by_gradient});
  }

  std::vector<SourceFace> source_;
  Ball source_ball_{};
  std::vector<Ball> balls_;  // of parts
  double coordinate_ = 0, reached_ = 0;
};

std::array<Piece, 2> halves(const Piece& piece) {
  int longest = 0;
  double most = -1;
  for (int k = 0; k < 3; ++k) {
    const double length = (piece.corners[(k + 1) % 3] - piece.corners[k]).norm();
    if (length > most) {
      most = length;
      longest = k;
    }
  }
  const Point &a = piece.corners[longest], &b = piece.corners[(longest + 1) % 3],
              &c = piece.corners[(longest + 2) % 3];
  const Point middle = (a + b) / 2;
  return {Piece{{a, middle, c}, piece.normal, piece.parts},
          Piece{{middle, b, c}, piece.normal, piece.parts}};
}

}  // namespace

double left_out_bound(const Scene& scene, const LightSource& source,
                      const std::vector<Receiver>& receivers,
                      const std::vector<SmallPart>& parts, const Request& request) {
  Stage stage(request, "bound of what is left out");
  BoundSearch search(scene, source, parts);
  std::vector<int> before;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!search.is_behind(i)) before.push_back(static_cast<int>(i));
  }
  // 1. The faces of the receivers, in triangles.
  std::priority_queue<Piece> pieces;
  for (const Receiver& receiver : receivers) {
    for (const int f : receiver.faces) {
      stage.check(0.1);
      const auto corners = corners_of(scene, f, scene.turned(f) == receiver.front);
      const Eigen::Vector3d normal = area_vector(corners).normalized();
      for (std::size_t k = 2; k < corners.size(); ++k) {
        Piece piece{{corners[0], corners[k - 1], corners[k]}, normal, before};
        search.bound(piece);
        if (piece.bound > 0) pieces.push(std::move(piece));
      }
    }
  }
  // 2. The piece with the largest bound is halved.
  for (int n = 0; n < kMostPieces && !pieces.empty(); ++n) {
    if (pieces.top().bound <= kSlack * search.reached()) break;
    stage.check(0.1 + 0.9 * n / kMostPieces);
    const auto both = halves(pieces.top());
    pieces.pop();
    for (Piece piece : both) {
      search.bound(piece);
      if (piece.bound > 0) pieces.push(std::move(piece));
    }
  }
  return pieces.empty() ? 0 : pieces.top().bound;
}

}  // namespace sightline
