#include "linespace/contacts/motion.h"

#include <algorithm>
#include <array>
#include <utility>

#include "linespace/contacts/strict_inequalities.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal::contacts {

namespace {

// Decides whether some w passes, once no constant w does.
//
// The critical rays and their opposites cut the plane into cells.  A straight motion that
// misses the origin turns by less than a half turn in all, in one sense, so it is
// described by where it is at each instant, in a cell or on a ray; between two instants
// it crosses the rays between the two, and no ray may be one of a barrier that is up.
// Whether a sequence of such places is that of a motion is a question of linear
// inequalities in the four numbers of w. Only from a cell straight to the opposite one is
// the sense not given by the cells; then all cells before are the first and all after the
// second, and both senses are possible: in the coordinates of the cell's two sides both
// must change sign between the two instants, in any order.
//
// On a ray the second order decides (openings).  With the sense h = +-1, scaled from
// cross(w0, w1), a line near L passes a side of slope s, along the unit ray e, at the
// instant x on the side that is the sign of cross(e, W(x)) + s h, where W is the line's
// own w, as large as we like along a motion in first order that solves the system with
// all slopes zero.  So both orders together are exact: some line near L passes iff some
// motion has open places only and some W has its slopes in the openings.  W's values on
// up to three rays are independent; on more they are a second system.
//
// Which places can be followed by which is found first, without regard to straightness
// (passable_); only what can be completed so is tried, and asked of the inequalities.
class MotionSearch {
 public:
  // Sectors by instant, fins by direction; `rays` are those that matter.
  MotionSearch(std::vector<Rational> instants, std::span<const SectorAt> sectors,
               std::span<const std::vector<const Fin*>> fins,
               std::span<const Ray* const> rays, const CornerTimes& corner_time)
      : instants_(std::move(instants)), corner_time_(corner_time) {
    cut_into_cells(rays);
    const std::size_t count = instants_.size();
    sectors_at_.resize(count);
    for (std::size_t first = 0, last; first < sectors.size(); first = last) {
      const int i = sectors[first].instant;
      for (last = first; last < sectors.size() && sectors[last].instant == i;) ++last;
      sectors_at_[i] = sectors.subspan(first, last - first);
    }
    closed_.assign(count, std::vector<char>(2 * rays_.size(), 1));
    for (std::size_t i = 0; i < count; ++i) {
      for (int c = 0; c < ray_count(); ++c) {
        hear_stop();
        closed_[i][2 * c + 1] =
            std::any_of(sectors_at_[i].begin(), sectors_at_[i].end(),
                        [&](const SectorAt& s) { return contains_after(s, rays_[c]); });
      }
    }
    up_.assign(count - 1, std::vector<char>(rays_.size(), 0));
    fins_.resize(rays_.size());
    for (const std::vector<const Fin*>& direction : fins) {
      for (int r = 0; r < ray_count(); ++r) {
        if (!same_direction(*direction.front()->ray, rays_[r])) continue;
        fins_[r] = direction;
        for (std::size_t gap = 0; gap + 1 < count; ++gap) {
          hear_stop_now();
          up_[gap][r] =
              std::any_of(direction.begin(), direction.end(), [&](const Fin* f) {
                return f->from <= instants_[gap] && f->to > instants_[gap];
              });
        }
      }
    }
  }

  bool possible() {
    for (const int sense : {1, -1}) {
      if (possible(sense)) return true;
    }
    for (const int sense : {1, -1}) {
      if (open_rays(sense) && possible(sense)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] int ray_count() const { return static_cast<int>(rays_.size()); }
  // Places: 2 c is ray c, 2 c + 1 the cell from there to ray c + 1.
  [[nodiscard]] int size() const { return 2 * ray_count(); }
  [[nodiscard]] int half() const { return ray_count(); }
  [[nodiscard]] int wrapped(int place) const { return (place + 2 * size()) % size(); }
  static bool is_ray(int place) { return place % 2 == 0; }

  // rays_: all critical rays and their opposites by angle.
  void cut_into_cells(std::span<const Ray* const> rays) {
    std::vector<Ray> upper;
    for (const Ray* r : rays) {
      const int y = sign_of(r->y);
      upper.push_back(y > 0 || (y == 0 && sign_of(r->x) > 0) ? *r : -*r);
    }
    // A cell must be less than a half-plane: rays in two directions at least.
    upper.emplace_back(Ring(1), Ring(0));
    if (sign_of(upper.front().y) == 0) upper.emplace_back(Ring(0), Ring(1));
    std::sort(upper.begin(), upper.end(),
              [](const Ray& p, const Ray& q) { return cross(p, q) > 0; });
    upper.erase(std::unique(upper.begin(), upper.end(),
                            [](const Ray& p, const Ray& q) { return cross(p, q) == 0; }),
                upper.end());
    rays_ = upper;
    for (const Ray& r : upper) rays_.push_back(-r);
  }

  // Opens the places on rays where the second order allows to cross.  False when this
  // adds nothing: where a ray can as well be crossed a little earlier or later, a motion
  // on it can be moved off, unless it has no freedom left, being on four.
  bool open_rays(int sense) {
    const std::size_t count = instants_.size();
    bool adds = false;
    std::size_t bounded = 0;
    for (std::size_t i = 0; i < count; ++i) {
      bool bound_here = false;
      for (int r = 0; r < ray_count(); ++r) {
        hear_stop_now();
        const Openings open = openings(sense, rays_[r], instants_[i], sectors_at_[i],
                                       fins_[r], corner_time_, false);
        closed_[i][2 * r] = open.intervals.empty();
        if (open.intervals.empty()) continue;
        const int left = wrapped(2 * r - sense), entered = wrapped(2 * r + sense);
        const bool earlier = !closed_[i][entered] && (i == 0 || !up_[i - 1][r]);
        const bool later = !closed_[i][left] && (i + 1 == count || !up_[i][r]);
        adds |= !earlier && !later;
        bound_here |= open.bounded;
      }
      bounded += bound_here;
    }
    return adds || bounded >= 4;
  }

  bool possible(int sense) {
    find_passable(sense);
    for (int c = 0; c < size(); ++c) {
      if (!passable(0, c, 0)) continue;
      places_.assign(1, c);
      if (extend(sense, 0)) return true;
    }
    return false;
  }

  // From the place at instant i, having turned by `turned` places so far, free places
  // lead to the last instant.
  [[nodiscard]] char& passable(std::size_t i, int place, int turned) {
    return passable_[(i * static_cast<std::size_t>(size()) +
                      static_cast<std::size_t>(place)) *
                         static_cast<std::size_t>(half() + 1) +
                     static_cast<std::size_t>(turned)];
  }

  void find_passable(int sense) {
    const std::size_t count = instants_.size();
    passable_.assign(count * static_cast<std::size_t>(size() * (half() + 1)), 0);
    for (std::size_t i = count; i-- > 0;) {
      for (int c = 0; c < size(); ++c) {
        hear_stop();
        if (closed_[i][c]) continue;
        for (int turned = 0; turned <= half(); ++turned) {
          passable(i, c, turned) =
              i + 1 == count || any_step(sense, i, c, turned, [&](int next, int step) {
                return step == half() ? stays_free(next, i + 1)
                                      : passable(i + 1, next, turned + step) != 0;
              });
        }
      }
    }
  }

  // Some step from a place at instant i to a place at the next, past no barrier, is
  // accepted.
  template <class Accept>
  bool any_step(int sense, std::size_t i, int here, int turned, Accept&& accept) const {
    // No motion stays on a ray or gets to the opposite one.
    for (int step = is_ray(here) ? 1 : 0; turned + step <= half(); ++step) {
      if (step > 1) {
        const int crossed = wrapped(here + sense * (step - 1));
        if (is_ray(crossed) && up_[i][crossed / 2]) return false;
      }
      const int next = wrapped(here + sense * step);
      if (is_ray(next) && turned + step == half()) continue;
      if (accept(next, step)) return true;
    }
    return false;
  }

  // Continues the places found so far, having turned by `turned` in all.
  bool extend(int sense, int turned) {
    hear_stop();
    const std::size_t i = places_.size();
    if (i == instants_.size()) return slopes_fit(sense);
    return any_step(sense, i - 1, places_.back(), turned, [&](int next, int step) {
      if (step == half()) return stays_free(next, i);
      if (!passable(i, next, turned + step)) return false;
      places_.push_back(next);
      // A step to the same cell needs no look of its own unless it is the last.
      const bool look = step > 0 || i + 1 == instants_.size();
      if ((!look || is_a_motion()) && extend(sense, turned + step)) return true;
      places_.pop_back();
      return false;
    });
  }

  [[nodiscard]] bool stays_free(int cell, std::size_t from) const {
    for (std::size_t i = from; i < instants_.size(); ++i) {
      if (closed_[i][cell]) return false;
    }
    return true;
  }

  // The side of the line along a ray that a place is on.
  [[nodiscard]] int side(int ray, int place) const {
    const int turned = wrapped(place - 2 * ray);
    return turned % half() == 0 ? 0 : turned < half() ? 1 : -1;
  }

  // factor * (x w_y - y w_x) at an instant, times a positive number, for w = A + x B.
  [[nodiscard]] Row side_row(int ray, std::size_t i, int factor) const {
    const Ray& r = rays_[ray];
    const auto& [num, den] = elapsed_[i];
    const Ring x = factor > 0 ? r.x : Ring(-r.x), y = factor > 0 ? Ring(-r.y) : r.y;
    Row row;
    row.e = {Ring(y * den), Ring(x * den), Ring(y * num), Ring(x * num), Ring(0)};
    row.round(4);
    return row;
  }

  // Some motion is at these places at the first instants.  For each line through the
  // origin the side of w is the sign of an affine function of time, so that the instants
  // next to its change say all.
  [[nodiscard]] bool is_a_motion() {
    const std::size_t count = places_.size();
    if (count <= 2) return true;
    for (std::size_t i = elapsed_.size(); i < instants_.size(); ++i) {
      const Rational after(instants_[i] - instants_.front());
      elapsed_.emplace_back(ring(mpq_numref(after.backend().data())),
                            ring(mpq_denref(after.backend().data())));
    }
    std::vector<Row> rows, equalities;
    const auto require = [&](int ray, std::size_t i) {
      const int s = side(ray, places_[i]);
      if (s == 0) {
        equalities.push_back(side_row(ray, i, 1));
      } else {
        rows.push_back(side_row(ray, i, s));
      }
    };
    for (int ray = 0; ray < half() / 2; ++ray) {
      // Lines that bound none of the places say nothing that others do not.
      if (std::none_of(places_.begin(), places_.end(), [&](int place) {
            const int turned = wrapped(place - 2 * ray) % half();
            return turned <= 1 || turned + 1 == half() ||
                   (is_ray(place) && turned + 2 == half());
          })) {
        continue;
      }
      std::size_t required = count;  // the last one that is
      for (std::size_t i = 0; i + 1 < count; ++i) {
        if (side(ray, places_[i]) == side(ray, places_[i + 1])) continue;
        if (required != i) require(ray, i);
        require(ray, required = i + 1);
      }
      if (required == count) {
        require(ray, 0);
        require(ray, count - 1);
      }
    }
    return feasible(std::move(rows), std::move(equalities), 4);
  }

  // Some W crosses the rays that the motion is on within their openings.
  [[nodiscard]] bool slopes_fit(int sense) const {
    std::vector<std::size_t> on;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (is_ray(places_[i])) on.push_back(i);
    }
    if (on.size() <= 3) return true;
    // W and a last unknown z > 0, for homogeneity; the slope is -sense cross(e, W) / z.
    std::vector<Row> rows(1);
    rows[0].e[4] = Ring(1);
    rows[0].round(5);
    return slopes_fit(sense, on, rows);
  }

  bool slopes_fit(int sense, std::span<const std::size_t> on,
                  std::vector<Row>& rows) const {
    if (on.empty()) return feasible(rows, {}, 5);
    const std::size_t i = on.front();
    const int ray = places_[i] / 2;
    const Ring& c = coordinate(rays_[ray]);
    const Ring unit = Ring((sign_of(c) < 0 ? Ring(-c) : c) * elapsed_[i].second);
    // factor * (slope - bound) > 0
    const auto bound = [&](const Rational& slope, int factor) {
      const Ring num = ring(mpq_numref(slope.backend().data())),
                 den = ring(mpq_denref(slope.backend().data()));
      Row row = side_row(ray, i, -sense * factor);
      for (int j = 0; j < 4; ++j) row.e[j] = Ring(row.e[j] * den);
      row.e[4] = Ring(num * unit);
      if (factor > 0) row.e[4] = -row.e[4];
      row.round(5);
      rows.push_back(std::move(row));
    };
    const Openings open = openings(sense, rays_[ray], instants_[i], sectors_at_[i],
                                   fins_[ray], corner_time_, true);
    return std::any_of(open.intervals.begin(), open.intervals.end(),
                       [&](const Opening& o) {
                         const std::size_t before = rows.size();
                         if (o.low) bound(*o.low, 1);
                         if (o.high) bound(*o.high, -1);
                         const bool fits = slopes_fit(sense, on.subspan(1), rows);
                         rows.resize(before);
                         return fits;
                       });
  }

  std::vector<Rational> instants_;
  const CornerTimes& corner_time_;
  std::vector<std::pair<Ring, Ring>> elapsed_;  // since the first, num / den
  std::vector<Ray> rays_;
  std::vector<std::span<const SectorAt>> sectors_at_;
  std::vector<std::vector<const Fin*>> fins_;  // [ray]
  std::vector<std::vector<char>> closed_;      // [instant][place]
  std::vector<std::vector<char>> up_;          // [until the next][ray]
  std::vector<int> places_;                    // at the first instants
  std::vector<char> passable_;                 // see passable()
};

}  // namespace

bool some_motion_passes(std::vector<Rational> instants, std::span<const SectorAt> sectors,
                        std::span<const std::vector<const Fin*>> fins,
                        std::span<const Ray* const> rays,
                        const CornerTimes& corner_time) {
  return MotionSearch(std::move(instants), sectors, fins, rays, corner_time).possible();
}

}  // namespace sightline::internal::contacts
