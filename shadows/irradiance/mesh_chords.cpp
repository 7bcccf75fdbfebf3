#include "shadows/irradiance/mesh_chords.h"

#include <cmath>

namespace sightline::internal {
namespace {

constexpr int kMostHalvings = 8;

// A conic of the mesh's frame.
class Conic {
 public:
  explicit Conic(const std::array<double, 6>& coefficients) : c_(coefficients) {
    double size = 0;
    for (const double c : c_) size = std::max(size, std::abs(c));
    for (double& c : c_) c /= size;
  }

  [[nodiscard]] bool curved() const { return c_[0] != 0 || c_[1] != 0 || c_[2] != 0; }

  // How far above the middle of a chord the curve is, along `way`, on the nearer side;
  // nullopt where the line misses the curve.
  [[nodiscard]] std::optional<double> above(const Eigen::Vector2d& at,
                                            const Eigen::Vector2d& way) const {
    const double a =
        c_[0] * way.x() * way.x() + c_[1] * way.x() * way.y() + c_[2] * way.y() * way.y();
    const double b = gradient(at).dot(way);
    const double c = value(at);
    const double squared = b * b - 4 * a * c;
    if (squared < 0) return std::nullopt;
    const double divisor = b + std::copysign(std::sqrt(squared), b);
    return divisor == 0 ? 0 : -2 * c / divisor;
  }

  // Both tangents run along the chord: a convex arc between them lies above the chord as
  // the graph of a concave function.
  [[nodiscard]] bool runs_along(const Eigen::Vector2d& from,
                                const Eigen::Vector2d& to) const {
    const Eigen::Vector2d chord = to - from;
    const auto along = [&](const Eigen::Vector2d& p) {
      const Eigen::Vector2d g = gradient(p);
      return g.x() * chord.y() - g.y() * chord.x();
    };
    return along(from) * along(to) > 0;
  }

 private:
  [[nodiscard]] double value(const Eigen::Vector2d& p) const {
    return p.x() * (c_[0] * p.x() + c_[1] * p.y() + c_[3]) +
           p.y() * (c_[2] * p.y() + c_[4]) + c_[5];
  }
  [[nodiscard]] Eigen::Vector2d gradient(const Eigen::Vector2d& p) const {
    return {2 * c_[0] * p.x() + c_[1] * p.y() + c_[3],
            c_[1] * p.x() + 2 * c_[2] * p.y() + c_[4]};
  }

  std::array<double, 6> c_;
};

class Chords {
 public:
  Chords(double wanted, const std::function<double(const MeshChord&)>& measure)
      : wanted_(wanted), measure_(&measure) {}

  void add(const ShadowMesh::Edge& edge) {
    const Conic conic(edge.conic);
    edge_ = &edge;
    const std::size_t n = edge.polyline.size();
    if (n > 2 && conic.curved()) {
      // A closed curve has no chord.
      const std::size_t half = edge.polyline.front() == edge.polyline.back() ? n / 2 : 0;
      if (half > 0) join(conic, 0, half);
      join(conic, half, n - 1);
      return;
    }
    for (std::size_t i = 1; i < n; ++i)
      keep(chord(edge.polyline[i - 1], edge.polyline[i]));
  }

  std::vector<MeshChord> take() { return std::move(chords_); }

 private:
  [[nodiscard]] MeshChord chord(const Eigen::Vector2d& from,
                                const Eigen::Vector2d& to) const {
    return {from, to, edge_->left, edge_->right, 0, edge_->order.value_or(0)};
  }

  void keep(const MeshChord& chord) {
    if (chord.from != chord.to) chords_.push_back(chord);
  }

  // One chord for a part of the polyline, if it is good enough.
  void join(const Conic& conic, std::size_t first, std::size_t last) {
    const MeshChord whole = chord(edge_->polyline[first], edge_->polyline[last]);
    if (last == first + 1) {
      halve(conic, whole, 0);
      return;
    }
    const Measured measured = measure(conic, whole);
    if (measured.known && measured.chord.error <= wanted_) {
      keep(measured.chord);
      return;
    }
    const std::size_t middle = (first + last) / 2;
    join(conic, first, middle);
    join(conic, middle, last);
  }

  struct Measured {
    MeshChord chord;
    Eigen::Vector2d middle;  // on the curve
    bool known;
  };
  [[nodiscard]] Measured measure(const Conic& conic, MeshChord chord) const {
    const Eigen::Vector2d way = chord.to - chord.from;
    const double length = way.norm();
    const Eigen::Vector2d left = Eigen::Vector2d(-way.y(), way.x()) / length;
    const Eigen::Vector2d middle = 0.5 * (chord.from + chord.to);
    const auto above = conic.above(middle, left);
    const bool known = above && std::abs(*above) < length;
    // Concave functions are at most twice as high as in the middle.
    chord.height =
        known && conic.runs_along(chord.from, chord.to) ? 2 * std::abs(*above) : length;
    chord.error = (*measure_)(chord);
    return {chord, middle + above.value_or(0) * left, known};
  }

  void halve(const Conic& conic, const MeshChord& whole, int depth) {
    if (whole.from == whole.to) return;
    const auto [measured, middle, known] = measure(conic, whole);
    const bool ends = middle == whole.from || middle == whole.to;
    if (measured.error <= wanted_ || depth == kMostHalvings || !known || ends) {
      keep(measured);
      return;
    }
    halve(conic, chord(whole.from, middle), depth + 1);
    halve(conic, chord(middle, whole.to), depth + 1);
  }

  const ShadowMesh::Edge* edge_ = nullptr;
  double wanted_;
  const std::function<double(const MeshChord&)>* measure_;
  std::vector<MeshChord> chords_;
};

}  // namespace

std::vector<MeshChord> mesh_chords(
    const ShadowMesh& mesh, double wanted,
    const std::function<double(const MeshChord&)>& measure) {
  Chords chords(wanted, measure);
  for (const ShadowMesh::Edge& edge : mesh.edges) chords.add(edge);
  return chords.take();
}

}  // namespace sightline::internal
