// The search for extremal stabbing lines.
//
// What makes pushing cheap (docs/portals.md proves it): a new extremal line lies, before
// the push, on a family of stabbing lines with some contacts, and that family's closure
// holds an old extremal line, which has these contacts and more.  So a new line is fixed
// by generators of the new portal together with contacts of ONE old extremal line; which
// of these contacts, portals/families.h tells.

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <utility>

#include "linespace/portals/families.h"

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
  Search(State& state, const Deadline& deadline)
      : s_(state),
        deadline_(deadline),
        latest_(static_cast<int>(state.portals.size()) - 1),
        portal_(state.portals.back()) {}

  /// Replaces the state's extremal lines.  Throws Stopped.
  void run(std::vector<HeldLine> old);

 private:
  [[nodiscard]] const LineThrough& edge(int e) const { return s_.edges[e]; }

  void set_contacts(HeldLine& held);
  [[nodiscard]] bool crossing_edges(const PortalGenerator& a,
                                    const PortalGenerator& b) const;

  void consider(const ExactLine& line);
  void consider(int p, int q);
  void consider(int p, int e, int f);
  void consider(std::array<int, 3> edges, int new_edge);
  void keep(HeldLine held);

  [[nodiscard]] bool all_needed() const;
  void find_new_points(const std::vector<HeldLine>& old);
  void try_families(const LineFamilies& families);
  void through_new_points(const LineFamilies& families);
  void on_new_edges(const LineFamilies& families);
  void in_new_plane(const LineFamilies& families);
  [[nodiscard]] bool plane_can_hold(int plane) const;

  State& s_;
  const Deadline& deadline_;
  int latest_;
  const Portal& portal_;
  bool new_plane_ = false;  // lines in the new portal's plane can meet all portals
  std::vector<int> new_edges_, new_points_;
  std::set<std::array<int, 2>> point_pairs_;
  std::set<std::array<int, 3>> point_edges_;
  std::set<std::array<int, 4>> quadruples_;
  std::map<ContactKey, std::vector<std::size_t>> by_contacts_;
};

/// Two touched edges that meet in the touched point and are not of one line.
bool Search::crossing_edges(const PortalGenerator& a, const PortalGenerator& b) const {
  if (a.kind != Kind::Edge || b.kind != Kind::Edge) return false;
  const LineThrough& e = s_.portals[a.portal].edges[a.index];
  const LineThrough& f = s_.portals[b.portal].edges[b.index];
  return !collinear(e.from, e.to, f.from) || !collinear(e.from, e.to, f.to);
}

void Search::set_contacts(HeldLine& held) {
  const Ring& radicand = held.line.coordinates().radicand;
  std::vector<PortalTouch> touches;
  held.contacts.clear();
  held.edges.clear();
  held.points.clear();
  held.planes.clear();
  for (std::size_t i = 0; i < held.meetings.size(); ++i) {
    const Meeting& m = held.meetings[i];
    touches.insert(touches.end(), m.touches.begin(), m.touches.end());
    if (m.in_plane) held.planes.push_back(static_cast<int>(i));
  }
  std::ranges::stable_sort(touches, [&](const PortalTouch& a, const PortalTouch& b) {
    return compare(a.at, b.at, radicand) == Sign::Negative;
  });
  for (PortalTouch& t : touches) {
    if (held.contacts.empty() ||
        compare(held.contacts.back().at, t.at, radicand) != Sign::Zero) {
      held.contacts.push_back({t.at, {}});
    }
    held.contacts.back().generators.push_back(t.generator);
    for (const int e : s_.edges_at(t.generator)) held.edges.push_back(e);
  }
  for (PortalContact& c : held.contacts) {
    std::ranges::sort(c.generators);
    const PortalGenerator& g = c.generators.front();
    if (g.kind == Kind::Vertex) {
      c.point = s_.point_id(homogeneous(s_.portals[g.portal].corners[g.index]));
    } else {
      for (const PortalGenerator& h : c.generators) {
        if (!crossing_edges(g, h)) continue;
        c.point = s_.point_id(*crossing(s_.portals[g.portal].edges[g.index],
                                        s_.portals[h.portal].edges[h.index]));
        break;
      }
    }
    c.fixed = c.point >= 0;
    if (c.fixed) held.points.push_back(c.point);
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
  if (!is_extremal(s_, held)) return;
  same.push_back(s_.held.size());
  s_.held.push_back(std::move(held));
}

/// Keeps a line if it stabs and is extremal.
void Search::consider(const ExactLine& line) {
  deadline_.check("stabbing lines");
  ++s_.statistics.candidates;
  // On a regulus most lines are found many times, and to tell how one meets all portals
  // costs far more than to know it again.
  if (std::ranges::any_of(
          s_.held, [&](const HeldLine& known) { return same_line(known.line, line); })) {
    ++s_.statistics.repeated;
    return;
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
  consider(line_through(s_.points[p], s_.points[q]));
}

void Search::consider(int p, int e, int f) {
  if (!point_edges_.insert({p, std::min(e, f), std::max(e, f)}).second) return;
  if (const auto line = line_through(s_.points[p], edge(e), edge(f))) consider(*line);
}

void Search::consider(std::array<int, 3> edges, int new_edge) {
  std::ranges::sort(edges);
  const auto [e, f, g] = edges;
  if (!quadruples_.insert({e, f, g, new_edge}).second) return;
  deadline_.check("stabbing lines");
  const LineTransversals found = transversals(edge(e), edge(f), edge(g), edge(new_edge));
  for (const ExactLine& line : found.lines) consider(line);
}

/// The new portal's corners, and where its edges cross edges that are touched.
void Search::find_new_points(const std::vector<HeldLine>& old) {
  for (const Eigen::Vector3d& v : portal_.corners) {
    new_points_.push_back(s_.point_id(homogeneous(v)));
  }
  std::vector<int> touched;
  for (const HeldLine& line : old) {
    touched.insert(touched.end(), line.edges.begin(), line.edges.end());
  }
  make_set(touched);
  if (all_needed()) {
    touched.resize(static_cast<std::size_t>(s_.first_edges[latest_]));
    std::iota(touched.begin(), touched.end(), 0);
  }
  for (const int e : touched) {
    for (const LineThrough& f : portal_.edges) {
      if (auto p = crossing(edge(e), f))
        new_points_.push_back(s_.point_id(*std::move(p)));
    }
  }
  make_set(new_points_);
}

void Search::through_new_points(const LineFamilies& families) {
  for (const int p : new_points_) {
    for (const int q : families.stars) consider(p, q);
    for (const auto& [e, f] : families.pairs) consider(p, e, f);
    for (const Pencil& pencil : families.pencils) {
      if (in_plane_of(s_.points[p], s_.points[pencil.point], edge(pencil.edge))) {
        consider(p, pencil.point);
      }
    }
  }
}

void Search::on_new_edges(const LineFamilies& families) {
  const auto apart = [&](int a, int b) {
    return s_.edge_portals[a] != s_.edge_portals[b];
  };
  const std::vector<int>& any = families.any_three;
  for (const int n : new_edges_) {
    for (const Pencil& pencil : families.pencils) consider(pencil.point, pencil.edge, n);
    for (const std::array<int, 3>& triple : families.triples) consider(triple, n);
    for (std::size_t i = 0; i < any.size(); ++i) {
      for (std::size_t j = i + 1; j < any.size(); ++j) {
        if (!apart(any[i], any[j])) continue;
        for (std::size_t k = j + 1; k < any.size(); ++k) {
          if (!apart(any[i], any[k]) || !apart(any[j], any[k])) continue;
          consider({any[i], any[j], any[k]}, n);
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

/// Lines in the new portal's plane: that plane leaves a point of an edge's line, a line
/// of another plane.
void Search::in_new_plane(const LineFamilies& families) {
  const PlaneThrough plane = portal_.plane();
  std::map<int, int> points;  // where the lines of edges cross it
  for (const int e : families.edges) {
    if (auto p = line_crossing(edge(e), plane)) {
      points[e] = s_.point_id(*std::move(p));
    }
  }
  for (const auto& [e, f] : families.pairs) {
    if (points.contains(e) && points.contains(f)) consider(points[e], points[f]);
  }
  for (const int p : new_points_) {
    if (side_of_plane(portal_, s_.points[p]) != Sign::Zero) continue;
    for (const auto& [e, q] : points) consider(p, q);
  }
  for (const Pencil& pencil : families.pencils) {
    const auto line = line_in_plane(s_.points[pencil.point], edge(pencil.edge), portal_);
    if (line) consider(*line);
  }
  for (const PlaneThrough& other : families.planes) {
    if (const auto line = ExactLine::in_planes(other, plane)) consider(*line);
  }
}

void Search::try_families(const LineFamilies& families) {
  through_new_points(families);
  on_new_edges(families);
  if (new_plane_) in_new_plane(families);
}

/// Next to the plane of a polygon that is not quite planar no extremal line stands for
/// the families there.  While lines there can stab, every generator is tried.
bool Search::all_needed() const {
  for (int a = 0; a < latest_ && latest_ > 1; ++a) {
    const Portal& p = s_.portals[a];
    const auto met = [&p](const Portal& q) { return plane_meets(p, q); };
    if (!p.planar && std::ranges::all_of(s_.portals, met)) return true;
  }
  return false;
}

void Search::run(std::vector<HeldLine> old) {
  s_.statistics = {};
  s_.held.clear();
  const bool first = latest_ == 0;
  const bool dead = !first && old.empty() && !s_.only_a_point;
  const bool was_a_point = !first && s_.only_a_point;
  s_.only_a_point =
      portal_.shape == Shape::Point &&
      (first || (was_a_point && portal_.corners[0] == s_.portals[0].corners[0]));
  if (dead || s_.only_a_point) return;
  for (int i = 0; i < static_cast<int>(portal_.edges.size()); ++i) {
    new_edges_.push_back(s_.first_edges[latest_] + i);
  }
  for (const HeldLine& line : old) {
    deadline_.check("stabbing lines");
    if (!meets(line.line, portal_)) continue;
    HeldLine held = line;
    if (add_meeting(s_, held, latest_)) keep(std::move(held));
  }
  s_.statistics.kept = s_.held.size();

  find_new_points(old);
  for (std::size_t i = 0; i < new_points_.size(); ++i) {
    for (std::size_t j = i + 1; j < new_points_.size(); ++j) {
      consider(new_points_[i], new_points_[j]);
    }
  }
  new_plane_ = plane_can_hold(latest_);
  if (was_a_point) {
    // No line is extremal yet, but all are held at the point.
    LineFamilies at_point;
    at_point.stars.push_back(s_.point_id(homogeneous(s_.portals[0].corners[0])));
    try_families(at_point);
  }
  if (all_needed()) try_families(all_families(s_, latest_));
  for (const HeldLine& line : old) try_families(families_at(s_, line));
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
  for (const PortalContact& c : held.contacts) {
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

/// The first edge of the state on the same line as this one, or its own number.
int carrier_of(const State& s, const LineThrough& e) {
  for (std::size_t i = 0; i < s.edges.size(); ++i) {
    const LineThrough& f = s.edges[i];
    if (s.carriers[i] == static_cast<int>(i) && collinear(f.from, f.to, e.from) &&
        collinear(f.from, f.to, e.to)) {
      return static_cast<int>(i);
    }
  }
  return static_cast<int>(s.edges.size());
}

void append(State& s, Portal portal) {
  s.first_edges.push_back(static_cast<int>(s.edges.size()));
  for (const LineThrough& e : portal.edges) {
    s.carriers.push_back(carrier_of(s, e));
    s.edges.push_back(e);
    s.edge_portals.push_back(static_cast<int>(s.portals.size()));
  }
  s.portals.push_back(std::move(portal));
}

/// Undoes append().
void remove_last(State& s) {
  const int latest = static_cast<int>(s.portals.size()) - 1;
  const auto edges = static_cast<std::size_t>(s.first_edges.back());
  s.edges.resize(edges);
  s.edge_portals.resize(edges);
  s.carriers.resize(edges);
  s.first_edges.pop_back();
  s.portals.pop_back();
  std::erase_if(s.without_order,
                [latest](const auto& pair) { return pair.second == latest; });
}

}  // namespace

int PortalState::point_id(HomogeneousPoint p) {
  const auto [at, added] = point_ids.try_emplace(p, static_cast<int>(points.size()));
  if (added) points.push_back(std::move(p));
  return at->second;
}

std::vector<int> PortalState::edges_at(const PortalGenerator& generator) const {
  const auto [kind, portal, index] = generator;
  const int n = static_cast<int>(portals[portal].edges.size());
  const int first = first_edges[portal];
  if (kind == Kind::Edge) return {first + index};
  if (n == 0) return {};
  if (n == 1) return {first};  // a slit has one edge and two corners
  return {first + index, first + (index + n - 1) % n};
}

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
  for (const PortalContact& c : held.contacts) {
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
  const auto fixed = std::ranges::count_if(held.contacts, &PortalContact::fixed);
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

bool PortalSequence::push(std::span<const Eigen::Vector3d> corners,
                          const Request& request) {
  const internal::Deadline deadline(request);
  internal::PortalState& s = *state_;
  const int index = static_cast<int>(s.portals.size());
  internal::Portal portal = internal::make_portal(corners, index);
  for (int i = 0; i < index; ++i) {
    if (internal::interiors_cross(s.portals[i], portal)) {
      s.without_order.insert({i, index});
    }
  }
  internal::append(s, std::move(portal));
  const bool was_a_point = s.only_a_point;
  std::vector<internal::HeldLine> old = std::exchange(s.held, {});
  try {
    internal::Search(s, deadline).run(old);
  } catch (const Stopped&) {
    internal::remove_last(s);
    s.held = std::move(old);
    s.only_a_point = was_a_point;
    return false;
  }
  internal::sort_lines(s);
  return true;
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
