// Faces of one object that meet beyond the corners and sides they share: of each face one
// partner.
//
// Pairs are found by boxes, and what has met somebody is asked no more: any number of
// copies of a face costs as much as it has faces.  What would stay quadratic are faces
// that lawfully meet where many do.  So two kinds of places are looked at on their own:
//   1. The star of a corner with many faces.  Both of its faces have the segment from
//      there to any common point, so that they meet beyond the corner iff the arcs they
//      fill in the sphere of directions do.  Pairs of arcs are found by boxes again.
//   2. The fan of a side with many faces, none of which has a further corner on the
//      side's line.  They meet beyond the side iff they lie in the same half-plane, and
//      half-planes are sorted around the side.
// Thin faces that run askew have boxes along directions of their own (tight_boxes.h).
// Elsewhere, two faces that both belong to such a place are passed over.

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

#include "linespace/scene/face_pair.h"
#include "linespace/scene/scene.h"
#include "linespace/scene/tight_boxes.h"
#include "linespace/space/bvh.h"
#include "linespace/work/stop_scope.h"

namespace sightline {
namespace internal {
namespace {

// More faces than this at a corner, or at a side in a star, make a place of its own.
constexpr int kMany = 16;

bool overlap(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k) {
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
  }
  return true;
}

// ---- boxes in places

// A face with its box, and the places it belongs to, which may be many.
struct Item {
  int face;
  Box box;
  std::vector<int> places;
};

bool contains(const std::vector<int>& places, int place) {
  return std::find(places.begin(), places.end(), place) != places.end();
}

// Trees of boxes: one for each place, and one for the items that belong to none.
class PlacedBoxes {
 public:
  explicit PlacedBoxes(std::span<const Item> items)
      : items_(items), top_(std::span<const Box>{}) {
    std::map<int, std::vector<int>> members;
    for (std::size_t i = 0; i < items.size(); ++i) {
      members[items[i].places.empty() ? kNone : items[i].places.front()].push_back(
          static_cast<int>(i));
    }
    std::vector<Box> roots;
    for (auto& [place, numbers] : members) {
      std::vector<Box> boxes;
      for (const int i : numbers) boxes.push_back(items[i].box);
      trees_.push_back({place, std::move(numbers), Bvh(boxes)});
      roots.push_back(trees_.back().tree.node(0).box);
    }
    top_ = Bvh(roots);
  }

  /// Calls visit(j) for items j that share no place with item i and whose boxes overlap
  /// its own and a box that `enter` lets in, until it returns true.
  template <class Enter, class Visit>
  void any(int i, const Enter& enter, const Visit& visit) const {
    const Item& item = items_[i];
    const auto let_in = [&](const Box& box) {
      return overlap(box, item.box) && enter(box);
    };
    bool found = false;
    top_.traverse([&](const Box& box) { return !found && let_in(box); },
                  [&](std::uint32_t t) {
                    const Tree& tree = trees_[t];
                    if (found || contains(item.places, tree.place)) return;
                    found = any(tree, item, let_in, visit);
                  });
  }

 private:
  static constexpr int kNone = -1;
  struct Tree {
    int place;
    std::vector<int> members;
    Bvh tree;
  };

  template <class Enter, class Visit>
  bool any(const Tree& tree, const Item& item, const Enter& let_in,
           const Visit& visit) const {
    return tree.tree.any_towards(Point::Zero(), let_in, [&](std::uint32_t member) {
      const int j = tree.members[member];
      const Item& other = items_[j];
      if (!let_in(other.box)) return false;
      for (const int place : other.places) {
        if (contains(item.places, place)) return false;
      }
      return visit(j);
    });
  }

  std::span<const Item> items_;
  std::vector<Tree> trees_;
  Bvh top_;
};

// ---- planes against boxes

// The plane of a face, rounded, to tell boxes that it certainly misses.
class FacePlane {
 public:
  FacePlane(const Scene& scene, int face) {
    const auto t = plane_corners(scene, face);
    const Point u = t[1] - t[0], v = t[2] - t[0];
    normal_ = u.cross(v);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      size_[k] = std::abs(u[i] * v[j]) + std::abs(u[j] * v[i]);
    }
    at_ = t[0];
  }

  /// The box, around points, is certainly on one side of the plane.
  [[nodiscard]] bool misses(const Box& box) const { return misses(box, at_); }
  /// The same of a box around directions from a point of the plane.
  [[nodiscard]] bool misses_directions(const Box& box) const {
    return misses(box, Point::Zero());
  }

 private:
  // A corner of the box gives a sum of three products normal * (corner - at).  A normal's
  // component is off by at most 4 units in the last place of size_ (2 of the differences,
  // a product, a subtraction), the difference by one, the product by one, the sum by two:
  // 8 in all, of `size`.
  [[nodiscard]] bool misses(const Box& box, const Point& at) const {
    double low = 0, high = 0, size = 0;
    for (int k = 0; k < 3; ++k) {
      const double a = box.min[k] - at[k], b = box.max[k] - at[k];
      low += std::min(normal_[k] * a, normal_[k] * b);
      high += std::max(normal_[k] * a, normal_[k] * b);
      size += size_[k] * std::max(std::abs(a), std::abs(b));
    }
    const double error = 16 * std::numeric_limits<double>::epsilon() * size;
    return low > error || high < -error;
  }

  Point normal_, at_;
  std::array<double, 3> size_;
};

// ---- directions

constexpr Box kAllDirections{{-1, -1, -1}, {1, 1, 1}};

void include(Box& box, const Point& p) {
  // Directions and what is made of them here are off by a few units of the last place.
  constexpr double kMargin = 0x1p-40;
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], p[k] - kMargin);
    box.max[k] = std::max(box.max[k], p[k] + kMargin);
  }
}

// A box around the arc of directions from unit vector u to v, the short way.  The arc
// lies in the triangle of its ends and the point where its tangents there meet.
Box arc_box(const Point& u, const Point& v) {
  const double cosine = u.dot(v);
  if (cosine < -0.9) return kAllDirections;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  const Point middle = (u + v).normalized();
  for (const Point& end : {u, v}) {
    include(box, end);
    include(box, (end + middle) / (1 + end.dot(middle)));
  }
  return box;
}

// ---- half-planes

// The half-planes of faces with the side from p to q, in order around it, exactly.
class HalfPlanes {
 public:
  HalfPlanes(const Scene& scene, int p, int q)
      : scene_(scene), p_(scene.point(p)), q_(scene.point(q)), ids_{p, q} {
    int along = 0;  // an axis that the side is not across
    while (p_[along] == q_[along]) ++along;
    first_ = beside((along + 1) % 3);
    second_ = beside((along + 2) % 3);
  }

  struct Member {
    int face;
    int point;    ///< a corner off the side
    int quarter;  ///< 0 in the half-plane of first_, 2 opposite; 1 and 3 between them
  };
  [[nodiscard]] Member member(int face) const {
    const auto ids = scene_.face_points(face);
    const int point = *std::find_if(
        ids.begin(), ids.end(), [&](int id) { return id != ids_[0] && id != ids_[1]; });
    return {face, point, quarter(scene_.point(point))};
  }

  /// Negative, 0 or positive as a comes before b, is in the same one, comes behind it.
  [[nodiscard]] int compare(const Member& a, const Member& b) const {
    if (a.quarter != b.quarter) return a.quarter - b.quarter;
    if (a.quarter % 2 == 0 || a.point == b.point) return 0;
    return -static_cast<int>(
        orient3d(p_, q_, scene_.point(a.point), scene_.point(b.point)));
  }

 private:
  // A point off p in the direction of an axis, with coordinates that predicates take.
  [[nodiscard]] Point beside(int axis) const {
    Point r = p_;
    r[axis] = p_[axis] == 0 ? 1 : 0;
    return r;
  }
  [[nodiscard]] int quarter(const Point& a) const {
    switch (orient3d(p_, q_, first_, a)) {
      case Sign::Positive:
        return 1;
      case Sign::Negative:
        return 3;
      default:
        return orient3d(p_, q_, second_, a) == orient3d(p_, q_, second_, first_) ? 0 : 2;
    }
  }

  const Scene& scene_;
  const Point &p_, &q_;
  std::array<int, 2> ids_;
  Point first_, second_;
};

// ---- the search

class TouchingSearch {
 public:
  explicit TouchingSearch(const Scene& scene)
      : scene_(scene), pair_(scene), partner_(scene.soup().polygons.size(), -1) {}

  /// A partner of each polygon of the file, -1 for none.
  std::vector<int> run() {
    for (const Object& object : scene_.objects()) search(object.faces);
    return std::move(partner_);
  }

 private:
  [[nodiscard]] int source(int face) const { return scene_.faces()[face].source; }

  void note(int f, int g) {
    if (partner_[source(f)] < 0) partner_[source(f)] = source(g);
    if (partner_[source(g)] < 0) partner_[source(g)] = source(f);
  }

  // The faces of an object.
  void search(const std::vector<int>& faces) {
    if (faces.size() < 2) return;
    std::map<int, std::vector<int>> stars = crowded_corners(faces);
    std::vector<Item> items;
    items.reserve(faces.size());
    std::vector<Point> points;
    for (const int f : faces) {
      hear_stop();
      points.clear();
      for (const int p : scene_.face_points(f)) points.push_back(scene_.point(p));
      items.push_back({f, box_of(points), {}});
    }
    for (auto& [corner, members] : stars) {
      std::vector<int> star;
      for (const int i : members) {
        items[i].places.push_back(corner);
        star.push_back(faces[i]);
      }
      search_star(corner, star);
    }
    search_turned(items, TightBoxes(scene_, faces));
  }

  // The items, each among boxes along the directions in which its own is small.
  void search_turned(const std::vector<Item>& items, const TightBoxes& tight) {
    std::vector<char> held(items.size(), 0);
    std::vector<Item> turned = items;
    for (int set = 0; set < tight.count(); ++set) {
      if (set > 0) {
        for (Item& item : turned) item.box = tight.box(set, item.face);
      }
      const auto misses = [&](const FacePlane& plane, const Box& box) {
        return set == 0 && plane.misses(box);
      };
      const auto may_meet = [&](const FacePlane& plane, std::size_t i, std::size_t j) {
        return overlap(items[i].box, items[j].box) && !plane.misses(items[j].box);
      };
      search(
          set == 0 ? items : turned, held,
          [&](std::size_t i) { return tight.set_of(i) == set; }, misses, may_meet);
    }
  }

  // Corners with many of these faces, and their positions in `faces`.
  std::map<int, std::vector<int>> crowded_corners(const std::vector<int>& faces) {
    std::map<int, std::vector<int>> stars;
    if (faces.size() <= kMany) return stars;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (const int p : scene_.face_points(faces[i])) {
        if (scene_.faces_at(p).size() <= kMany) continue;
        stars[p].push_back(static_cast<int>(i));
      }
    }
    std::erase_if(stars, [](const auto& star) { return star.second.size() <= kMany; });
    return stars;
  }

  // Of each of these items without a partner, another item that shares no place with it.
  // misses(plane, box) passes over boxes, may_meet(plane, i, j) over pairs; held: which
  // items were held against all.
  template <class Chosen, class Misses, class MayMeet>
  void search(const std::vector<Item>& items, std::vector<char>& held,
              const Chosen& chosen, const Misses& misses, const MayMeet& may_meet) {
    if (items.size() < 2) return;
    const PlacedBoxes boxes(items);
    for (std::size_t i = 0; i < items.size(); ++i) {
      hear_stop();
      if (!chosen(i)) continue;
      const int f = items[i].face;
      if (partner_[source(f)] >= 0) continue;
      held[i] = 1;
      const FacePlane plane(scene_, f);
      boxes.any(
          static_cast<int>(i), [&](const Box& box) { return !misses(plane, box); },
          [&](int j) {
            hear_stop();
            const int g = items[j].face;
            // One that was held against all and has no partner yet does not meet this
            // one.
            const bool done = held[j] != 0 && partner_[source(g)] < 0;
            if (done || source(g) == source(f) ||
                !may_meet(plane, i, static_cast<std::size_t>(j)) || !pair_.meet(f, g)) {
              return false;
            }
            note(f, g);
            return true;
          });
    }
  }

  [[nodiscard]] bool all_have_partners(const std::vector<int>& faces) const {
    return std::all_of(faces.begin(), faces.end(),
                       [&](int f) { return partner_[source(f)] >= 0; });
  }

  // Faces with a common corner.
  void search_star(int corner, const std::vector<int>& faces) {
    if (all_have_partners(faces)) return;
    std::map<int, std::vector<int>> fans;  // by the other end of a side
    std::vector<Item> items;
    items.reserve(faces.size());
    for (const int f : faces) {
      const auto [before, after] = neighbours(f, corner);
      items.push_back(
          {f, arc_box(direction(corner, before), direction(corner, after)), {}});
      for (const int other : {before, after}) {
        if (alone_on_line(f, corner, other)) {
          fans[other].push_back(static_cast<int>(items.size()) - 1);
        }
      }
    }
    for (const auto& [other, members] : fans) {
      if (members.size() <= kMany) continue;
      std::vector<int> fan;
      for (const int i : members) {
        items[i].places.push_back(other);
        fan.push_back(faces[i]);
      }
      search_fan(corner, other, fan);
    }
    std::vector<char> held(items.size(), 0);
    search(
        items, held, [](std::size_t) { return true; },
        [](const FacePlane& plane, const Box& box) {
          return plane.misses_directions(box);
        },
        [](const FacePlane&, std::size_t, std::size_t) { return true; });
  }

  [[nodiscard]] Point direction(int from, int to) const {
    return (scene_.point(to) - scene_.point(from)).normalized();
  }

  // The corners of the face before and after this one.
  [[nodiscard]] std::array<int, 2> neighbours(int face, int corner) const {
    const auto ids = scene_.face_points(face);
    const auto at =
        static_cast<std::size_t>(std::find(ids.begin(), ids.end(), corner) - ids.begin());
    return {ids[(at + ids.size() - 1) % ids.size()], ids[(at + 1) % ids.size()]};
  }

  // Of the face's corners only these two are on their line.
  [[nodiscard]] bool alone_on_line(int face, int p, int q) const {
    const auto ids = scene_.face_points(face);
    return ids.size() == 3 || std::all_of(ids.begin(), ids.end(), [&](int r) {
             return r == p || r == q ||
                    !collinear(scene_.point(p), scene_.point(q), scene_.point(r));
           });
  }

  // Faces with a common side and no other corner on its line: those in one half-plane
  // meet.
  void search_fan(int p, int q, const std::vector<int>& faces) {
    if (all_have_partners(faces)) return;
    const HalfPlanes around(scene_, p, q);
    std::vector<HalfPlanes::Member> fan;
    fan.reserve(faces.size());
    for (const int f : faces) fan.push_back(around.member(f));
    std::stable_sort(fan.begin(), fan.end(), [&](const auto& a, const auto& b) {
      return around.compare(a, b) < 0;
    });
    for (auto first = fan.begin(); first != fan.end();) {
      hear_stop();
      const auto end = std::find_if(first + 1, fan.end(), [&](const auto& member) {
        return around.compare(*first, member) != 0;
      });
      const int own = source(first->face);
      const auto other = std::find_if(
          first, end, [&](const auto& member) { return source(member.face) != own; });
      for (auto k = first; k != end && other != end; ++k) {
        note(k->face, source(k->face) != own ? first->face : other->face);
      }
      first = end;
    }
  }

  const Scene& scene_;
  FacePair pair_;
  std::vector<int> partner_;
};

}  // namespace
}  // namespace internal

std::vector<Defect> find_self_touching(const Scene& scene) {
  const std::vector<int> partner = internal::TouchingSearch(scene).run();
  std::vector<Defect> defects;
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] < 0) continue;
    const int face = static_cast<int>(i);
    defects.push_back({"self-touching",
                       "faces " + std::to_string(face) + " and " +
                           std::to_string(partner[i]) +
                           " meet beyond the corners and edges they share",
                       {face, partner[i]},
                       {}});
  }
  return defects;
}

}  // namespace sightline
