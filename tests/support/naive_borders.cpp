#include "tests/support/naive_borders.h"

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

namespace sightline::testing {
namespace {

/// Of a line of the picture: intervals between all corners on it, each with its cells.
class LineOfPicture {
 public:
  struct Side {
    Ray from, to;  ///< counter-clockwise about the line's normal
    int cell;
    bool plus;
  };
  LineOfPicture(const Ray& line, const std::vector<Side>& sides) : line_(line) {
    for (const Side& s : sides) stops_.insert(stops_.end(), {s.from, s.to});
    origin_ = stops_[0];
    std::ranges::sort(stops_, [&](const Ray& a, const Ray& b) { return before(a, b); });
    stops_.erase(std::ranges::unique(stops_).begin(), stops_.end());
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      intervals_.push_back({line, stops_[i], stops_[(i + 1) % stops_.size()]});
    }
    for (const Side& s : sides) {
      const std::size_t last = index(s.to);
      for (std::size_t i = index(s.from); i != last; i = (i + 1) % stops_.size()) {
        int& cell = s.plus ? intervals_[i].plus : intervals_[i].minus;
        if (cell >= 0) throw std::logic_error("naive view: cells overlap");
        cell = s.cell;
      }
    }
  }
  [[nodiscard]] const std::vector<Border>& intervals() const { return intervals_; }

 private:
  /// Less than half a turn ahead of the first stop, or that stop itself.
  [[nodiscard]] bool ahead(const Ray& a) const {
    return a == *origin_ || orientation(line_, *origin_, a) > 0;
  }
  [[nodiscard]] bool before(const Ray& a, const Ray& b) const {
    if (ahead(a) != ahead(b)) return ahead(a);
    return orientation(line_, a, b) > 0;
  }
  [[nodiscard]] std::size_t index(const Ray& a) const {
    const auto at = std::ranges::lower_bound(
        stops_, a, [&](const Ray& x, const Ray& y) { return before(x, y); });
    return static_cast<std::size_t>(at - stops_.begin());
  }

  Ray line_;
  std::optional<Ray> origin_;
  std::vector<Ray> stops_;
  std::vector<Border> intervals_;
};

/// All borders between cells, each line by itself.
std::vector<Border> uncut_borders(const std::vector<PictureCell>& cells) {
  std::map<Ray, std::vector<LineOfPicture::Side>> lines;
  for (int c = 0; c < static_cast<int>(cells.size()); ++c) {
    const Cone& cone = cells[c].cone;
    for (std::size_t i = 0; i < cone.sides.size(); ++i) {
      const Ray& a = cone.corners[i];
      const Ray& b = cone.corners[(i + 1) % cone.corners.size()];
      if (reversed(cone.sides[i])) {
        lines[-cone.sides[i]].push_back({b, a, c, false});
      } else {
        lines[cone.sides[i]].push_back({a, b, c, true});
      }
    }
  }
  std::vector<Border> result;
  for (const auto& [line, sides] : lines) {
    const LineOfPicture whole(line, sides);
    for (const Border& i : whole.intervals()) {
      if (i.plus >= 0 || i.minus >= 0) result.push_back(i);
    }
  }
  return result;
}

/// Cuts a border in two where what is seen on one of its sides changes from the nearer to
/// the farther.
void cut_where_they_meet(const std::vector<PictureCell>& cells,
                         std::vector<Border>& borders) {
  const std::size_t n = borders.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Border i = borders[k];
    if (i.plus < 0 || i.minus < 0) continue;
    if (cells[i.plus].faces.empty() || cells[i.minus].faces.empty()) continue;
    const Vec3 difference = cells[i.plus].nearness - cells[i.minus].nearness;
    const Rational a = dot(difference, i.begin.rational());
    const Rational b = dot(difference, i.end.rational());
    if (a.sign() * b.sign() >= 0) continue;
    const Ray middle(abs(b) * i.begin.rational() + abs(a) * i.end.rational());
    borders[k].end = middle;
    borders.push_back({i.line, middle, i.end, i.plus, i.minus});
  }
}

}  // namespace

std::vector<Border> borders(const std::vector<PictureCell>& cells) {
  std::vector<Border> result = uncut_borders(cells);
  cut_where_they_meet(cells, result);
  return result;
}

}  // namespace sightline::testing
