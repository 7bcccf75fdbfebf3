// The search for extremal stabbing lines.
//
// What makes pushing cheap (docs/portals.md proves it): a new extremal line lies, before
// the push, on a family of stabbing lines with some contacts, and that family's closure
// holds an old extremal line, which has these contacts and more.  So a new line is fixed
// by generators of the new portal together with contacts of ONE old extremal line.

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "linespace/portals_internal.h"

namespace sightline {
namespace internal {
namespace {

using Kind = PortalGenerator::Kind;
using Shape = Portal::Shape;
using State = PortalState;

template <class T>
void make_set(std::vector<T>& v) {
  std::ranges::sort(v);
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

class Search {
 public:
  explicit Search(State& state)
      : s_(state),
        latest_(static_cast<int>(state.portals.size()) - 1),
        portal_(state.portals.back()) {}

  void run();

 private:
  [[nodiscard]] const LineThrough& edge(int e) const { return s_.edges[e]; }
  int point_id(HomogeneousPoint p);

  void set_contacts(HeldLine& held);
  [[nodiscard]] bool crossing_edges(const PortalGenerator& a,
                                    const PortalGenerator& b) const;

  void consider(const ExactLine& line, std::initializer_list<int> touched_edges);
  void consider(int p, int q);
  void consider(int p, int e, int f);
  void keep(HeldLine held);

  void add_all_generators();
  void find_new_points();
  void through_new_points(const HeldLine& old);
  void on_new_edges(const HeldLine& old);
  void in_new_plane(const HeldLine& old);
  void in_old_planes(const HeldLine& old);
  [[nodiscard]] std::vector<int> points_in_plane(const HeldLine& old, int plane);
  [[nodiscard]] bool plane_can_hold(int plane) const;

  State& s_;
  int latest_;
  const Portal& portal_;
  std::vector<HeldLine> old_;
  std::vector<int> new_edges_, new_points_;
  std::set<std::array<int, 2>> point_pairs_;
  std::set<std::array<int, 3>> point_edges_;
  std::set<std::array<int, 4>> quadruples_;
  std::set<std::array<int, 2>> plane_pairs_;
  std::map<ContactKey, std::vector<std::size_t>> by_contacts_;
};

int Search::point_id(HomogeneousPoint p) {
  const auto [at, added] =
      s_.point_ids.try_emplace(p, static_cast<int>(s_.points.size()));
  if (added) s_.points.push_back(std::move(p));
  return at->second;
}

/// Two touched edges that meet in the touched point and are not of one line.
bool Search::crossing_edges(const PortalGenerator& a, const PortalGenerator& b) const {
  if (a.kind != Kind::Edge || b.kind != Kind::Edge) return false;
  const LineThrough& e = s_.portals[a.portal].edges[a.index];
  const LineThrough& f = s_.portals[b.portal].edges[b.index];
  return !collinear(e.from, e.to, f.from) || !collinear(e.from, e.to, f.to);
}

void Search::set_contacts(HeldLine& held) {
  const Ring& radicand = held.line.coordinates().radicand;
  std::vector<Touch> touches;
  held.contacts.clear();
  held.edges.clear();
  held.points.clear();
  held.planes.clear();
  for (std::size_t i = 0; i < held.meetings.size(); ++i) {
    const Meeting& m = held.meetings[i];
    touches.insert(touches.end(), m.touches.begin(), m.touches.end());
    if (m.in_plane) held.planes.push_back(static_cast<int>(i));
  }
  std::ranges::stable_sort(touches, [&](const Touch& a, const Touch& b) {
    return compare(a.at, b.at, radicand) == Sign::Negative;
  });
  for (Touch& t : touches) {
    if (held.contacts.empty() ||
        compare(held.contacts.back().at, t.at, radicand) != Sign::Zero) {
      held.contacts.push_back({t.at, {}});
    }
    held.contacts.back().generators.push_back(t.generator);
    const auto [kind, portal, index] = t.generator;
    const int n = static_cast<int>(s_.portals[portal].edges.size());
    const int first = s_.first_edges[portal];
    if (kind == Kind::Edge) {
      held.edges.push_back(first + index);
    } else if (n > 0) {
      held.edges.push_back(first + index % n);  // a slit has one edge and two corners
      held.edges.push_back(first + (index + n - 1) % n);
    }
  }
  for (Contact& c : held.contacts) {
    std::ranges::sort(c.generators);
    const PortalGenerator& g = c.generators.front();
    if (g.kind == Kind::Vertex) {
      c.fixed = true;
      held.points.push_back(point_id(homogeneous(s_.portals[g.portal].corners[g.index])));
      continue;
    }
    for (const PortalGenerator& h : c.generators) {
      if (!crossing_edges(g, h)) continue;
      c.fixed = true;
      held.points.push_back(point_id(*crossing(s_.portals[g.portal].edges[g.index],
                                               s_.portals[h.portal].edges[h.index])));
      break;
    }
  }
  make_set(held.edges);
  make_set(held.points);
}

void Search::keep(HeldLine held) {
  set_contacts(held);
  std::vector<std::size_t>& same = by_contacts_[contact_key(held)];
  for (const std::size_t i : same) {
    if (same_line(s_.held[i].line, held.line)) return;
  }
  same.push_back(s_.held.size());
  s_.held.push_back(std::move(held));
}

void Search::consider(const ExactLine& line, std::initializer_list<int> touched_edges) {
  ++s_.statistics.candidates;
  for (const int e : touched_edges) {
    if (line.meets(edge(e)) == SegmentContact::None) return;
  }
  for (int i = latest_; i >= 0; --i) {
    if (!meets(line, s_.portals[i])) return;
  }
  HeldLine held{line};
  for (int i = 0; i <= latest_; ++i) {
    if (!add_meeting(s_, held, i)) return;
  }
  keep(std::move(held));
}

void Search::consider(int p, int q) {
  if (p == q || !point_pairs_.insert({std::min(p, q), std::max(p, q)}).second) return;
  consider(line_through(s_.points[p], s_.points[q]), {});
}

void Search::consider(int p, int e, int f) {
  if (!point_edges_.insert({p, std::min(e, f), std::max(e, f)}).second) return;
  if (const auto line = line_through(s_.points[p], edge(e), edge(f))) {
    consider(*line, {e, f});
  }
}

/// The new portal's corners, and where its edges cross edges that are touched.
void Search::find_new_points() {
  for (const Eigen::Vector3d& v : portal_.corners) {
    new_points_.push_back(point_id(homogeneous(v)));
  }
  std::vector<int> touched;
  for (const HeldLine& old : old_) {
    touched.insert(touched.end(), old.edges.begin(), old.edges.end());
  }
  make_set(touched);
  for (const int e : touched) {
    for (const LineThrough& f : portal_.edges) {
      if (auto p = crossing(edge(e), f)) new_points_.push_back(point_id(*std::move(p)));
    }
  }
  make_set(new_points_);
}

void Search::through_new_points(const HeldLine& old) {
  for (const int p : new_points_) {
    for (const int q : old.points) consider(p, q);
    for (std::size_t i = 0; i < old.edges.size(); ++i) {
      for (std::size_t j = i + 1; j < old.edges.size(); ++j) {
        const int e = old.edges[i], f = old.edges[j];
        if (s_.edge_portals[e] != s_.edge_portals[f]) consider(p, e, f);
      }
    }
  }
}

void Search::on_new_edges(const HeldLine& old) {
  const std::vector<int>& e = old.edges;
  const auto same_portal = [&](int a, int b) {
    return s_.edge_portals[a] == s_.edge_portals[b];
  };
  for (const int n : new_edges_) {
    for (const int p : old.points) {
      for (const int a : e) consider(p, a, n);
    }
    for (std::size_t i = 0; i < e.size(); ++i) {
      for (std::size_t j = i + 1; j < e.size(); ++j) {
        if (same_portal(e[i], e[j])) continue;
        for (std::size_t k = j + 1; k < e.size(); ++k) {
          if (same_portal(e[i], e[k]) || same_portal(e[j], e[k])) continue;
          if (!quadruples_.insert({e[i], e[j], e[k], n}).second) continue;
          const LineTransversals found =
              transversals(edge(e[i]), edge(e[j]), edge(e[k]), edge(n));
          for (const ExactLine& line : found.lines) {
            consider(line, {e[i], e[j], e[k], n});
          }
        }
      }
    }
  }
}

/// Whether lines in a portal's plane can meet all portals.
bool Search::plane_can_hold(int plane) const {
  const Portal& p = s_.portals[plane];
  if (p.shape != Shape::Polygon || !p.planar) return false;
  return std::ranges::all_of(s_.portals,
                             [&p](const Portal& q) { return plane_meets(p, q); });
}

/// Points of a plane that lines in it may be held at by what `old` touches.
std::vector<int> Search::points_in_plane(const HeldLine& old, int plane) {
  const Portal& polygon = s_.portals[plane];
  std::vector<int> out;
  for (const int p : old.points) {
    if (side_of_plane(polygon, s_.points[p]) == Sign::Zero) out.push_back(p);
  }
  for (const int e : old.edges) {
    if (auto p = crossing(edge(e), polygon)) {
      out.push_back(point_id(*std::move(p)));
      continue;
    }
    for (const Eigen::Vector3d& v : {edge(e).from, edge(e).to}) {
      HomogeneousPoint p = homogeneous(v);
      if (side_of_plane(polygon, p) == Sign::Zero) out.push_back(point_id(std::move(p)));
    }
  }
  make_set(out);
  return out;
}

void Search::in_new_plane(const HeldLine& old) {
  const std::vector<int> points = points_in_plane(old, latest_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) consider(points[i], points[j]);
    for (const int p : new_points_) {
      if (side_of_plane(portal_, s_.points[p]) == Sign::Zero) consider(points[i], p);
    }
  }
}

void Search::in_old_planes(const HeldLine& old) {
  for (const int plane : old.planes) {
    const Portal& polygon = s_.portals[plane];
    if (!polygon.planar || !plane_meets(polygon, portal_)) continue;
    std::vector<int> points;
    for (const int p : new_points_) {
      if (side_of_plane(polygon, s_.points[p]) == Sign::Zero) points.push_back(p);
    }
    for (const LineThrough& e : portal_.edges) {
      if (auto p = crossing(e, polygon)) points.push_back(point_id(*std::move(p)));
    }
    for (const int p : points_in_plane(old, plane)) {
      for (const int q : points) consider(p, q);
    }
    if (portal_.shape != Shape::Polygon || !portal_.planar ||
        !plane_pairs_.insert({plane, latest_}).second) {
      continue;
    }
    if (const auto line = ExactLine::in_planes(polygon.plane(), portal_.plane())) {
      consider(*line, {});
    }
  }
}

/// Next to the plane of a polygon that is not quite planar no extremal line stands for
/// the families there.  While lines there can stab, every generator is tried.
void Search::add_all_generators() {
  for (int a = 0; a < latest_ && latest_ > 1; ++a) {
    const Portal& p = s_.portals[a];
    const auto met = [&p](const Portal& q) { return plane_meets(p, q); };
    if (p.planar || !std::ranges::all_of(s_.portals, met)) continue;
    HeldLine all{ExactLine::through({0, 0, 0}, {1, 0, 0})};
    for (int e = 0; e < s_.first_edges[latest_]; ++e) all.edges.push_back(e);
    for (int i = 0; i < latest_; ++i) {
      for (const Eigen::Vector3d& v : s_.portals[i].corners) {
        all.points.push_back(point_id(homogeneous(v)));
      }
    }
    make_set(all.points);
    old_.push_back(std::move(all));
    return;
  }
}

void Search::run() {
  s_.statistics = {};
  const bool first = latest_ == 0;
  const bool dead = !first && s_.held.empty() && !s_.only_a_point;
  const bool still_a_point =
      portal_.shape == Shape::Point &&
      (first || (s_.only_a_point && portal_.corners[0] == s_.portals[0].corners[0]));
  old_ = std::exchange(s_.held, {});
  for (int i = 0; i < static_cast<int>(portal_.edges.size()); ++i) {
    new_edges_.push_back(s_.first_edges[latest_] + i);
  }
  if (!first && s_.only_a_point) {
    // No line is extremal yet, but all are held at the point.
    HeldLine at_point{ExactLine::through({0, 0, 0}, {1, 0, 0})};
    at_point.points.push_back(point_id(homogeneous(s_.portals[0].corners[0])));
    old_.push_back(std::move(at_point));
  }
  s_.only_a_point = still_a_point;
  if (dead || still_a_point) return;
  add_all_generators();

  for (const HeldLine& old : old_) {
    if (old.meetings.empty() || !meets(old.line, portal_)) continue;
    HeldLine held = old;
    if (add_meeting(s_, held, latest_)) keep(std::move(held));
  }
  s_.statistics.kept = s_.held.size();

  find_new_points();
  for (std::size_t i = 0; i < new_points_.size(); ++i) {
    for (std::size_t j = i + 1; j < new_points_.size(); ++j) {
      consider(new_points_[i], new_points_[j]);
    }
  }
  const bool new_plane = plane_can_hold(latest_);
  for (const HeldLine& old : old_) {
    through_new_points(old);
    on_new_edges(old);
    if (new_plane) in_new_plane(old);
    in_old_planes(old);
  }
  s_.statistics.found = s_.held.size() - s_.statistics.kept;
}

// ---- what the public sees -------------------------------------------------------------

PortalGenerator as_named(const State& s, PortalGenerator g) {
  g.index = s.portals[g.portal].names[g.index];
  return g;
}

ExtremalStabbingLine as_public(const State& s, const HeldLine& held) {
  ExtremalStabbingLine out;
  out.kind = kind_of(held);
  out.planes = held.planes;
  for (const Contact& c : held.contacts) {
    StabbingContact contact{{}, c.fixed, rounded_place(held.line, c.at)};
    for (const PortalGenerator& g : c.generators) {
      contact.generators.push_back(as_named(s, g));
    }
    out.contacts.push_back(std::move(contact));
  }
  const Ring& radicand = held.line.coordinates().radicand;
  const Place* low = &held.meetings.front().first;
  const Place* high = &held.meetings.front().last;
  for (const Meeting& m : held.meetings) {
    if (compare(m.first, *low, radicand) == Sign::Negative) low = &m.first;
    if (compare(m.last, *high, radicand) == Sign::Positive) high = &m.last;
  }
  out.segment = {rounded_place(held.line, *low), rounded_place(held.line, *high)};
  if (!held.forward) {
    std::ranges::reverse(out.contacts);
    std::swap(out.segment[0], out.segment[1]);
  }
  return out;
}

/// Kinds in order, then contacts, then along an edge they share.
void sort_lines(State& s) {
  std::vector<std::pair<ContactKey, std::size_t>> order;
  for (std::size_t i = 0; i < s.held.size(); ++i) {
    order.emplace_back(contact_key(s.held[i]), i);
  }
  std::ranges::sort(order, [&s](const auto& a, const auto& b) {
    const HeldLine& x = s.held[a.second];
    const HeldLine& y = s.held[b.second];
    if (kind_of(x) != kind_of(y)) return kind_of(x) < kind_of(y);
    if (a.first != b.first || a.second == b.second) return a.first < b.first;
    // Only lines through four edges or more can have all contacts in common.
    const PortalGenerator& g = a.first.front();
    assert(g.kind == Kind::Edge);
    return compare_along(s.portals[g.portal].edges[g.index], x.line, y.line) ==
           Sign::Negative;
  });
  std::vector<HeldLine> sorted;
  for (const auto& [key, i] : order) sorted.push_back(std::move(s.held[i]));
  s.held = std::move(sorted);
  s.lines.clear();
  for (const HeldLine& held : s.held) s.lines.push_back(as_public(s, held));
}

}  // namespace

bool add_meeting(const PortalState& state, HeldLine& held, int portal) {
  Meeting now = meeting(held.line, state.portals[portal], portal);
  const Ring& radicand = held.line.coordinates().radicand;
  for (int i = 0; i < static_cast<int>(held.meetings.size()); ++i) {
    if (state.without_order.contains({i, portal})) continue;
    const Meeting& before = held.meetings[i];
    held.forward =
        held.forward && compare(before.first, now.last, radicand) != Sign::Positive;
    held.backward =
        held.backward && compare(now.first, before.last, radicand) != Sign::Positive;
    if (!held.forward && !held.backward) return false;
  }
  held.meetings.push_back(std::move(now));
  return true;
}

ContactKey contact_key(const HeldLine& held) {
  ContactKey key;
  for (const Contact& c : held.contacts) {
    key.insert(key.end(), c.generators.begin(), c.generators.end());
  }
  for (const int p : held.planes) key.push_back({Kind::Plane, p, 0});
  std::ranges::sort(key);
  return key;
}

StabbingKind kind_of(const HeldLine& held) {
  if (!held.planes.empty() ||
      std::ranges::any_of(held.meetings, [](const Meeting& m) { return m.along; })) {
    return StabbingKind::InPlane;
  }
  const auto fixed = std::ranges::count_if(held.contacts, &Contact::fixed);
  const auto sliding = static_cast<std::ptrdiff_t>(held.contacts.size()) - fixed;
  if (fixed == 2 && sliding == 0) return StabbingKind::VV;
  if (fixed == 0 && sliding == 4) return StabbingKind::EEEE;
  if (fixed == 1 && sliding == 2) {
    return held.contacts[1].fixed ? StabbingKind::EVE : StabbingKind::VEE;
  }
  return StabbingKind::Degenerate;
}

}  // namespace internal

std::string_view name(StabbingKind kind) {
  static constexpr std::array<std::string_view, kStabbingKinds> kNames = {
      "VV", "VEE", "EVE", "EEEE", "in_plane", "degenerate"};
  return kNames[static_cast<std::size_t>(kind)];
}

PortalSequence::PortalSequence() : state_(std::make_unique<internal::PortalState>()) {}
PortalSequence::~PortalSequence() = default;
PortalSequence::PortalSequence(const PortalSequence& other)
    : state_(std::make_unique<internal::PortalState>(*other.state_)) {}
PortalSequence& PortalSequence::operator=(const PortalSequence& other) {
  state_ = std::make_unique<internal::PortalState>(*other.state_);
  return *this;
}
PortalSequence::PortalSequence(PortalSequence&&) noexcept = default;
PortalSequence& PortalSequence::operator=(PortalSequence&&) noexcept = default;

void PortalSequence::push(std::span<const Eigen::Vector3d> corners) {
  internal::PortalState& s = *state_;
  const int index = static_cast<int>(s.portals.size());
  internal::Portal portal = internal::make_portal(corners, index);
  for (int i = 0; i < index; ++i) {
    if (internal::interiors_cross(s.portals[i], portal))
      s.without_order.insert({i, index});
  }
  s.first_edges.push_back(static_cast<int>(s.edges.size()));
  for (const LineThrough& e : portal.edges) {
    s.edges.push_back(e);
    s.edge_portals.push_back(index);
  }
  s.portals.push_back(std::move(portal));
  internal::Search(s).run();
  internal::sort_lines(s);
}

std::size_t PortalSequence::size() const { return state_->portals.size(); }

bool PortalSequence::stabbable() const {
  return state_->only_a_point || !state_->held.empty();
}

const std::vector<ExtremalStabbingLine>& PortalSequence::extremal_lines() const {
  return state_->lines;
}

std::vector<int> PortalSequence::out_of_plane() const {
  std::vector<int> out;
  for (std::size_t i = 0; i < state_->portals.size(); ++i) {
    if (!state_->portals[i].planar) out.push_back(static_cast<int>(i));
  }
  return out;
}

const PortalStatistics& PortalSequence::last_push() const { return state_->statistics; }

}  // namespace sightline
