#include "shadows/factors/exchange_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "linespace/predicates.h"
#include "shadows/factors/separating_planes.h"

namespace sightline::internal {
namespace {

using Vector = Eigen::Vector3d;

/// In units of the frame, in which the whole configuration is about 1 wide.  What is so
/// near counts as touching when lines are sorted out; the exchange area depends on it by
/// no more than this.  It is some thousand times the rounding of a coordinate.
constexpr double kTouching = 1e-13;

// ---- the frame ------------------------------------------------------------------------

struct Frame {
  Point origin;
  std::array<Vector, 3> axes;
  double unit;

  [[nodiscard]] Vector local(const Point& p) const {
    const Vector d = (p - origin) / unit;
    return {axes[0].dot(d), axes[1].dot(d), axes[2].dot(d)};
  }
};

/// Planes across a coordinate axis get a frame of axes, so that nothing is rounded.
std::array<Vector, 3> axes_across(const Vector& normal) {
  int main = 0;
  normal.cwiseAbs().maxCoeff(&main);
  const Vector n = normal.normalized();
  if (std::abs(n[main]) == 1) {
    Vector x = Vector::Zero(), z = Vector::Zero();
    z[main] = n[main];
    x[(main + 1) % 3] = 1;
    return {x, z.cross(x), z};
  }
  const Vector x = n.unitOrthogonal();
  return {x, n.cross(x), n};
}

Frame frame_of(std::span<const Point> sender, std::span<const Point> target) {
  Eigen::AlignedBox3d box;
  for (const Point& p : sender) box.extend(p);
  for (const Point& p : target) box.extend(p);
  const std::array<Point, 3> c = spanning_corners(sender);
  Frame frame;
  frame.origin = c[0];
  frame.axes = axes_across((c[1] - c[0]).cross(c[2] - c[0]));
  frame.unit = std::exp2(std::ceil(std::log2(box.sizes().maxCoeff())));
  return frame;
}

// ---- clipping -------------------------------------------------------------------------

/// A corner with its heights over the sender's and the target's plane, whose signs are
/// exact.
struct Corner {
  Vector at;
  std::array<double, 2> heights;
};

double with_sign(double value, Sign sign) {
  constexpr double kLeast = 1e-300;
  if (sign == Sign::Zero) return 0;
  const double size = std::max(std::abs(value), kLeast);
  return sign == Sign::Positive ? size : -size;
}

/// A side that rounding has laid now on this, now on that side of a plane lies in it: cut
/// there, it would have a corner too many.
void settle(Corner& c) {
  for (double& height : c.heights) {
    if (std::abs(height) < kTouching) height = 0;
  }
  if (c.heights[0] == 0) c.at.z() = 0;
}

/// The part of a convex polygon with that height above 0; empty where there is none.
std::vector<Corner> above(const std::vector<Corner>& polygon, int which) {
  std::vector<Corner> part;
  if (std::ranges::none_of(polygon,
                           [&](const Corner& c) { return c.heights[which] > 0; }))
    return part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    const double ha = a.heights[which], hb = b.heights[which];
    if (ha >= 0) part.push_back(a);
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) {
      const double w = ha / (ha - hb);
      Corner cut{a.at + w * (b.at - a.at), {}};
      for (int k = 0; k < 2; ++k) {
        cut.heights[k] = a.heights[k] + w * (b.heights[k] - a.heights[k]);
      }
      cut.heights[which] = 0;
      // Where three planes share a line, a corner cut out of two lies in the third.
      settle(cut);
      part.push_back(cut);
    }
  }
  return part;
}

/// Which way the polygon is long, and how wide it is in the two directions.
void find_spans(Plate& plate) {
  Vector longest = Vector::Zero();
  for (const Vector& c : plate.corners) {
    if ((c - plate.corners[0]).norm() > longest.norm()) longest = c - plate.corners[0];
  }
  const Vector along = longest.normalized(), across = plate.normal.cross(along);
  for (int k = 0; k < 2; ++k) {
    const Vector& u = k == 0 ? along : across;
    double low = 0, high = 0;
    for (const Vector& c : plate.corners) {
      low = std::min(low, u.dot(c - plate.corners[0]));
      high = std::max(high, u.dot(c - plate.corners[0]));
    }
    plate.spans[k] = u / std::max(high - low, kTouching);
  }
}

Plate plate_of(const std::vector<Corner>& polygon, const Vector& normal) {
  Plate plate;
  for (const Corner& c : polygon) plate.corners.push_back(c.at);
  plate.normal = normal;
  plate.middle = Vector::Zero();
  plate.offset = 0;
  if (plate.corners.empty()) return plate;
  for (const Vector& c : plate.corners) plate.middle += c;
  plate.middle /= static_cast<double>(plate.corners.size());
  plate.offset = -normal.dot(plate.middle);
  find_spans(plate);
  return plate;
}

/// The point lies in the plate's plane, as far as that is known.
bool on_plane(const Plate& plate, const Vector& x) {
  const double height = std::abs(plate.height(x));
  return height <= kTouching || height <= kTouching * plate.reach(x);
}

/// Brings polygons into the frame, with the signs of their heights.
class Importer {
 public:
  Importer(const Frame& frame, std::span<const Point> sender,
           std::span<const Point> target)
      : frame_(frame),
        sender_(spanning_corners(sender)),
        target_(spanning_corners(target)) {
    target_normal_ = normal_of(target);
    target_at_ = frame.local(target_[0]);
  }

  [[nodiscard]] std::vector<Corner> corners(std::span<const Point> polygon) const {
    std::vector<Corner> result;
    for (const Point& p : polygon) {
      Corner c{frame_.local(p), {}};
      c.heights[0] = with_sign(c.at.z(), orient3d(sender_[0], sender_[1], sender_[2], p));
      c.heights[1] = with_sign(target_normal_.dot(c.at - target_at_),
                               orient3d(target_[0], target_[1], target_[2], p));
      settle(c);
      result.push_back(c);
    }
    return result;
  }
  [[nodiscard]] Vector normal_of(std::span<const Point> polygon) const {
    const std::array<Point, 3> c = spanning_corners(polygon);
    const Vector a = frame_.local(c[0]);
    return (frame_.local(c[1]) - a).cross(frame_.local(c[2]) - a).normalized();
  }
  /// Above the sender's plane and before the target's front.
  [[nodiscard]] Plate clipped(std::span<const Point> polygon) const {
    return plate_of(above(above(corners(polygon), 0), 1), normal_of(polygon));
  }

 private:
  const Frame& frame_;
  std::array<Point, 3> sender_, target_;
  Vector target_normal_, target_at_;
};

// ---- contour pieces -------------------------------------------------------------------

/// How a blocker, or the target, lies along a stretch of a line in its plane.
struct Attachment {
  int plate;
  double from, to;          ///< where the stretch of the line lies in the plate
  bool positive, negative;  ///< the plate reaches to that side of the line
  Vector across;            ///< in the plate, across the line, to the positive side
};

/// Stretches shorter than kTouching are left out.
std::optional<Attachment> attachment(const ContourPiece& line, const Plate& plate,
                                     int number) {
  Attachment a{number, 0,     line.length,
               false,  false, plate.normal.cross(line.direction).normalized()};
  const std::size_t n = plate.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector& p = plate.corners[i];
    const Vector side = plate.corners[(i + 1) % n] - p;
    if (side.norm() < kTouching) continue;
    const Vector inward = plate.normal.cross(side).normalized();
    const double at = inward.dot(line.start - p) + kTouching;
    const double slope = inward.dot(line.direction);
    const double end = at + slope * line.length;
    if (at < 0 && end < 0) return std::nullopt;
    if (at < 0) a.from = std::max(a.from, -at / slope);
    if (end < 0) a.to = std::min(a.to, -at / slope);
  }
  if (!(a.to - a.from > 4 * kTouching)) return std::nullopt;
  for (const Vector& p : plate.corners) {
    const double h = a.across.dot(p - line.start);
    // Of a short stretch the direction is known less well: a corner that far along it is
    // beside it where its side leaves the stretch itself by as much.
    const double along = std::abs(line.direction.dot(p - line.start));
    const double beside = 2 * kTouching * (1 + along / line.length);
    a.positive = a.positive || h > beside;
    a.negative = a.negative || h < -beside;
  }
  return a;
}

class PieceMaker {
 public:
  explicit PieceMaker(ExchangeGeometry& geometry)
      : g_(geometry), target_(static_cast<int>(geometry.blockers.size())) {
    for (const FlatPoint& p : g_.sender) sender_.emplace_back(p.x, p.y, 0);
  }

  void make() {
    for (int p = 0; p <= target_; ++p) {
      const Plate& plate = plate_at(p);
      for (std::size_t i = 0; i < plate.corners.size(); ++i) {
        add_side(p, plate.corners[i], plate.corners[(i + 1) % plate.corners.size()]);
      }
    }
  }

 private:
  [[nodiscard]] const Plate& plate_at(int p) const {
    return p == target_ ? g_.target : g_.blockers[p];
  }
  void add_side(int plate, Vector a, Vector b) {
    const auto part = g_.in_shaft(a, b);
    if (!part) return;
    const Vector whole = b - a, first = a;
    if ((*part)[1] < 1) b = first + (*part)[1] * whole;
    if ((*part)[0] > 0) a = first + (*part)[0] * whole;
    // Of what lies in the sender's plane only the target's own side bounds what is seen:
    // there the target ends at the horizon.
    on_ground_ = a.z() <= 0 && b.z() <= 0;
    if (on_ground_ && plate != target_) return;
    ContourPiece line;
    line.start = a;
    line.length = (b - a).norm();
    if (line.length <= 4 * kTouching) return;
    line.direction = (b - a) / line.length;
    find_attachments(line, b);
    std::vector<double> ends{0, line.length};
    for (const Attachment& at : attached_) {
      ends.push_back(at.from);
      ends.push_back(at.to);
    }
    std::ranges::sort(ends);
    for (std::size_t i = 1; i < ends.size(); ++i) {
      if (ends[i] - ends[i - 1] > 2 * kTouching) {
        add_piece(plate, line, ends[i - 1], ends[i]);
      }
    }
  }
  void find_attachments(ContourPiece& line, const Vector& end) {
    attached_.clear();
    for (int p = 0; p <= target_; ++p) {
      const Plate& plate = plate_at(p);
      const bool in_plane = on_plane(plate, line.start) && on_plane(plate, end);
      if (p == target_) {
        line.on_target = in_plane;
      } else if (!in_plane) {
        line.shading.push_back(p);
      }
      if (!in_plane) continue;
      if (const auto a = attachment(line, plate, p)) attached_.push_back(*a);
    }
  }
  /// The piece belongs to the first plate that has a side along it.
  void add_piece(int plate, const ContourPiece& line, double from, double to) {
    ContourPiece piece = line;
    piece.start += from * line.direction;
    piece.length = to - from;
    if (line.on_target) piece.shows_positive = piece.shows_negative = false;
    const double middle = 0.5 * (from + to);
    for (const Attachment& a : attached_) {
      if (middle < a.from || middle > a.to) continue;
      if (a.plate < plate && !on_ground_) return;
      if (a.plate == target_) {
        show_target(piece, a);
        continue;
      }
      if (a.positive && a.negative) return;
      const Vector d = a.positive ? a.across : Vector(-a.across);
      piece.attached.push_back(piece.direction.cross(d));
    }
    if (!piece.shows_positive && !piece.shows_negative) return;
    if (!may_contribute(piece)) return;
    leave_out_beside(piece);
    find_breaks(piece);
    g_.pieces.push_back(std::move(piece));
  }
  void show_target(ContourPiece& piece, const Attachment& a) const {
    // The sender lies before the target's front, so that direction x across, which is the
    // front's normal or its opposite, tells on which side its points see the target.
    const double side = piece.direction.cross(a.across).dot(g_.target.normal);
    const bool plus = side > 0 ? a.positive : a.negative;
    const bool minus = side > 0 ? a.negative : a.positive;
    piece.shows_positive = plus;
    piece.shows_negative = minus;
  }
  /// Some point of the sender has all attached blockers on one side of the piece.
  [[nodiscard]] bool may_contribute(const ContourPiece& piece) const {
    for (const double sign : {1.0, -1.0}) {
      if (sign > 0 ? !piece.shows_negative : !piece.shows_positive) continue;
      const bool all = std::ranges::all_of(piece.attached, [&](const Vector& n) {
        return std::ranges::any_of(g_.sender, [&](const FlatPoint& p) {
          return sign * n.dot(Vector{p.x, p.y, 0} - piece.start) > 0;
        });
      });
      if (all) return true;
    }
    return false;
  }
  /// Blockers that no line from sender to target meets that passes the piece.
  void leave_out_beside(ContourPiece& piece) const {
    const Vector end = piece.start + piece.length * piece.direction;
    const SeparatingPlanes below(piece.start, end, sender_);
    const SeparatingPlanes beyond(piece.start, end, g_.target.corners);
    std::erase_if(piece.shading, [&](int b) {
      const std::vector<Vector>& corners = g_.blockers[b].corners;
      return below.beside(corners) && (piece.on_target || beyond.beside(corners));
    });
  }
  void find_breaks(ContourPiece& piece) const {
    const Vector end = piece.start + piece.length * piece.direction;
    for (const int b : piece.shading) {
      const Plate& plate = g_.blockers[b];
      const double h0 = plate.height(piece.start), h1 = plate.height(end);
      if (!((h0 > 0 && h1 < 0) || (h0 < 0 && h1 > 0))) continue;
      const double s = piece.length * h0 / (h0 - h1);
      if (meets(plate, piece.start + s * piece.direction)) piece.breaks.push_back(s);
    }
    std::ranges::sort(piece.breaks);
  }
  static bool meets(const Plate& plate, const Vector& q) {
    const std::size_t n = plate.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vector& p = plate.corners[i];
      const Vector side = plate.corners[(i + 1) % n] - p;
      if (plate.normal.cross(side).dot(q - p) < -kTouching) return false;
    }
    return true;
  }

  ExchangeGeometry& g_;
  const int target_;
  std::vector<Vector> sender_;
  std::vector<Attachment> attached_;
  bool on_ground_ = false;
};

// ---- the shaft ------------------------------------------------------------------------

void add_shaft_planes(const std::vector<Vector>& a, const std::vector<Vector>& b,
                      std::vector<Eigen::Vector4d>& planes) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector side = a[(i + 1) % a.size()] - a[i];
    for (const Vector& q : b) {
      Vector n = side.cross(q - a[i]);
      const double length = n.norm();
      if (length <= kTouching) continue;
      n /= length;
      double low = 0, high = 0;
      for (const std::vector<Vector>* points : {&a, &b}) {
        for (const Vector& x : *points) {
          const double h = n.dot(x - a[i]);
          low = std::min(low, h);
          high = std::max(high, h);
        }
      }
      if (low >= -kTouching) n = -n;
      if (low >= -kTouching || high <= kTouching) {
        planes.emplace_back(n.x(), n.y(), n.z(), -n.dot(a[i]));
      }
    }
  }
}

void find_shaft(ExchangeGeometry& g) {
  std::vector<Vector> sender;
  for (const FlatPoint& p : g.sender) sender.emplace_back(p.x, p.y, 0);
  add_shaft_planes(sender, g.target.corners, g.shaft);
  add_shaft_planes(g.target.corners, sender, g.shaft);
}

}  // namespace

std::optional<std::array<double, 2>> ExchangeGeometry::in_shaft(const Vector& a,
                                                                const Vector& b) const {
  double from = 0, to = 1;
  for (const Eigen::Vector4d& plane : shaft) {
    const double ha = plane.head<3>().dot(a) + plane[3] - kShaftSlack;
    const double hb = plane.head<3>().dot(b) + plane[3] - kShaftSlack;
    if (ha >= 0 && hb >= 0) return std::nullopt;
    if (ha > 0) from = std::max(from, ha / (ha - hb));
    if (hb > 0) to = std::min(to, ha / (ha - hb));
  }
  if (!(from < to)) return std::nullopt;
  return std::array{from, to};
}

std::array<Point, 3> spanning_corners(std::span<const Point> polygon) {
  // From the first corner, the largest triangle of a fan, its third corner then moved.
  const std::size_t n = polygon.size();
  std::size_t far = 1;
  for (std::size_t i = 2; i < n; ++i) {
    if ((polygon[i] - polygon[0]).squaredNorm() >
        (polygon[far] - polygon[0]).squaredNorm()) {
      far = i;
    }
  }
  std::size_t third = far == 1 ? 2 : 1;
  double largest = -1;
  for (std::size_t i = 1; i < n; ++i) {
    const double size =
        (polygon[far] - polygon[0]).cross(polygon[i] - polygon[0]).squaredNorm();
    if (i != far && size > largest) {
      largest = size;
      third = i;
    }
  }
  return {polygon[0], polygon[std::min(far, third)], polygon[std::max(far, third)]};
}

namespace {

ExchangeGeometry geometry_between(const Frame& frame, const Importer& importer,
                                  std::span<const Point> sender,
                                  std::span<const Point> target) {
  ExchangeGeometry g;
  g.unit = frame.unit;
  for (const Corner& c : above(importer.corners(sender), 1)) {
    g.sender.push_back({c.at.x(), c.at.y()});
  }
  g.target = plate_of(above(importer.corners(target), 0), importer.normal_of(target));
  return g;
}

/// Sides of the target alone.
void add_open_pieces(ExchangeGeometry& g) {
  const std::vector<Vector>& corners = g.target.corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector side = corners[(i + 1) % corners.size()] - corners[i];
    const double length = side.norm();
    if (length == 0) continue;
    ContourPiece piece;
    piece.start = corners[i];
    piece.direction = side / length;
    piece.length = length;
    piece.on_target = true;
    piece.shows_negative = false;
    g.pieces.push_back(std::move(piece));
  }
}

}  // namespace

ExchangeGeometry open_geometry(std::span<const Point> sender,
                               std::span<const Point> target) {
  const Frame frame = frame_of(sender, target);
  const Importer importer(frame, sender, target);
  ExchangeGeometry g = geometry_between(frame, importer, sender, target);
  if (!g.nothing()) add_open_pieces(g);
  return g;
}

ExchangeGeometry exchange_geometry(std::span<const Point> sender,
                                   std::span<const Point> target,
                                   std::span<const std::span<const Point>> blockers,
                                   const std::optional<Eigen::Vector3d>& up) {
  const Frame frame = frame_of(sender, target);
  const Importer importer(frame, sender, target);
  ExchangeGeometry g = geometry_between(frame, importer, sender, target);
  if (g.nothing()) return g;
  if (up) {
    g.up = Vector{frame.axes[0].dot(*up), frame.axes[1].dot(*up), frame.axes[2].dot(*up)};
    g.up->normalize();
  }
  for (const auto& blocker : blockers) {
    Plate plate = importer.clipped(blocker);
    if (plate.corners.size() >= 3) g.blockers.push_back(std::move(plate));
  }
  if (g.blockers.empty()) {
    add_open_pieces(g);
    return g;
  }
  find_shaft(g);
  PieceMaker(g).make();
  return g;
}

}  // namespace sightline::internal
