#include "linespace/view/piece_joiner.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "linespace/picture/picture_tree.h"

namespace sightline::internal {
namespace {

class Joiner {
 public:
  Joiner(const EyeSpace& eye, const std::vector<LinePiece>& pieces)
      : eye_(&eye), pieces_(&pieces) {}

  JoinedPieces join(Doubles doubles) {
    number_ends();
    split();
    if (doubles == Doubles::Drop) drop_doubles();
    return {std::move(points_), std::move(scene_points_), std::move(edges_)};
  }

 private:
  void number_ends();
  void split();
  void drop_doubles();
  [[nodiscard]] bool inside(int point, int piece) const;
  [[nodiscard]] bool on_line(const PicturePoint& p, int line) const;
  [[nodiscard]] int exact_order(int line, const PicturePoint& x,
                                const PicturePoint& y) const;
  [[nodiscard]] int order(int line, const PicturePoint& x, const PicturePoint& y,
                          const LongVector& along) const;

  const EyeSpace* eye_;
  const std::vector<LinePiece>* pieces_;
  std::vector<PicturePoint> points_;
  std::vector<std::vector<int>> scene_points_;
  std::vector<std::array<int, 2>> ends_;  // of pieces
  std::vector<JoinedEdge> edges_;
};

void Joiner::number_ends() {
  // Ends that are scene points are told by their numbers.
  std::vector<PicturePoint> found;
  std::unordered_map<int, int> of_point;
  for (const LinePiece& piece : *pieces_) {
    std::array<int, 2> ends;
    for (int i = 0; i < 2; ++i) {
      PicturePoint p(*eye_, piece.line, i == 0 ? piece.from : piece.to);
      ends[i] = static_cast<int>(found.size());
      if (p.point() >= 0) {
        const auto [it, is_new] = of_point.emplace(p.point(), ends[i]);
        ends[i] = it->second;
        if (!is_new) continue;
      }
      found.push_back(std::move(p));
    }
    ends_.push_back(ends);
  }
  // Others, where they are seen.
  const auto n = static_cast<int>(found.size());
  const std::vector<int> first = number_points(found);
  // The representative is a scene point where the class has one.
  std::vector<int> numbers(found.size(), -1), chosen(found.size(), -1);
  for (int i = 0; i < n; ++i) {
    int& best = chosen[first[i]];
    if (best < 0 || (found[best].point() < 0 && found[i].point() >= 0)) best = i;
  }
  for (int i = 0; i < n; ++i) {
    const int root = first[i];
    if (numbers[root] < 0) {
      numbers[root] = static_cast<int>(points_.size());
      points_.push_back(found[chosen[root]]);
      scene_points_.emplace_back();
    }
    numbers[i] = numbers[root];
    const int p = found[i].point();
    if (p >= 0 && !eye_->scene().is_constructed(p))
      scene_points_[numbers[i]].push_back(p);
  }
  for (auto& points : scene_points_) std::ranges::sort(points);
  for (auto& ends : ends_) ends = {numbers[ends[0]], numbers[ends[1]]};
}

bool Joiner::on_line(const PicturePoint& p, int line) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  if (p.point() >= 0) return eye_->orient(a, b, p.point()) == Sign::Zero;
  if (p.line() == line) return true;
  const LineCut& cut = p.cut();
  if (cut.kind == LineCut::Kind::Side &&
      ((cut.p == a && cut.q == b) || (cut.p == b && cut.q == a))) {
    return true;
  }
  return orient(PicturePoint(*eye_, a), PicturePoint(*eye_, b), p) == Sign::Zero;
}

// Of two points of a line's picture: negative when x comes first on the way from the
// line's first end to its second.
int Joiner::order(int line, const PicturePoint& x, const PicturePoint& y,
                  const LongVector& along) const {
  const LongVector &u = x.vector(), &v = y.vector();
  long double difference = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    difference += (u[i] - v[i]) * along[i];
    size += std::abs(along[i]);
  }
  const long double error = (2 * (x.error() + y.error()) + 0x1p-60L) * size;
  if (std::abs(difference) > error) return difference > 0 ? 1 : -1;
  return exact_order(line, x, y);
}

int Joiner::exact_order(int line, const PicturePoint& x, const PicturePoint& y) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const ExactPoint normal = exact_cross(eye_->exact_vector(a), eye_->exact_vector(b));
  return -exact_dot(normal, exact_cross(x.exact(), y.exact())).sign();
}

bool Joiner::inside(int point, int piece) const {
  const auto [from, to] = ends_[piece];
  if (point == from || point == to) return false;
  const PicturePoint& p = points_[point];
  const int line = (*pieces_)[piece].line;
  if (!on_line(p, line)) return false;
  const LongVector &u = points_[from].vector(), &v = points_[to].vector();
  LongVector along, middle;
  for (int i = 0; i < 3; ++i) {
    along[i] = v[i] - u[i];
    middle[i] = v[i] + u[i];
  }
  // Of a piece that spans nearly half a turn doubles do not know the side of the sphere.
  const bool wide = !eye_->is_direction() && dot(middle, middle) < 0x1p-8L;
  if (wide) {
    return exact_order(line, points_[from], p) < 0 &&
           exact_order(line, p, points_[to]) < 0;
  }
  if (!eye_->is_direction() && dot(middle, p.vector()) < 0) return false;
  return order(line, points_[from], p, along) < 0 &&
         order(line, p, points_[to], along) < 0;
}

void Joiner::split() {
  std::vector<PictureTree::Piece> spans;
  for (const auto& [from, to] : ends_) spans.push_back({&points_[from], &points_[to]});
  const PictureTree tree(spans, eye_->is_direction());
  std::vector<std::vector<int>> between(ends_.size());
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    tree.at(points_[p], [&](int piece) {
      if (inside(p, piece)) between[piece].push_back(p);
    });
  }
  for (int piece = 0; piece < static_cast<int>(ends_.size()); ++piece) {
    const int line = (*pieces_)[piece].line;
    const auto [from, to] = ends_[piece];
    LongVector along;
    for (int i = 0; i < 3; ++i)
      along[i] = points_[to].vector()[i] - points_[from].vector()[i];
    std::ranges::sort(between[piece], [&](int x, int y) {
      return order(line, points_[x], points_[y], along) < 0;
    });
    int last = from;
    for (const int p : between[piece]) {
      edges_.push_back({line, {last, p}, piece});
      last = p;
    }
    edges_.push_back({line, {last, to}, piece});
  }
}

// Lines that coincide in space, sides of objects that touch, show the same piece twice: a
// crossing of facets stays, else the smallest line number.  From an eye on a facet sides
// of it may be seen in one: the nearest stays.
void Joiner::drop_doubles() {
  const auto ends = [](const JoinedEdge& e) { return std::minmax(e.ends[0], e.ends[1]); };
  const auto crosses = [&](const JoinedEdge& e) {
    return eye_->scene().lines()[e.line].crossing[0] >= 0;
  };
  const auto nearness = [&](const JoinedEdge& e) {
    const ExactPoint &u = points_[e.ends[0]].exact(), &v = points_[e.ends[1]].exact();
    return LineCuts(*eye_, e.line).nearness({u[0] + v[0], u[1] + v[1], u[2] + v[2]});
  };
  std::ranges::stable_sort(edges_, [&](const JoinedEdge& x, const JoinedEdge& y) {
    if (ends(x) != ends(y)) return ends(x) < ends(y);
    if (!eye_->scene().on_one_line(x.line, y.line)) return nearness(y) < nearness(x);
    return crosses(x) != crosses(y) ? crosses(x) : x.line < y.line;
  });
  const auto doubles = std::ranges::unique(
      edges_,
      [&](const JoinedEdge& x, const JoinedEdge& y) { return ends(x) == ends(y); });
  edges_.erase(doubles.begin(), doubles.end());
  std::ranges::sort(edges_, [](const JoinedEdge& x, const JoinedEdge& y) {
    return x.piece != y.piece ? x.piece < y.piece : x.ends < y.ends;
  });
}

}  // namespace

JoinedPieces join_ends(const EyeSpace& eye, const std::vector<LinePiece>& pieces,
                       Doubles doubles) {
  return Joiner(eye, pieces).join(doubles);
}

}  // namespace sightline::internal
