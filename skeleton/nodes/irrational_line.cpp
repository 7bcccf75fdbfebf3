#include "skeleton/nodes/irrational_line.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>

#include "linespace/lines/transversals.h"
#include "linespace/sight/line_probe.h"

namespace sightline::internal {
namespace {

// A face met by the line: the point, as x / w with w > 0, and the side it lies on.
struct Meeting {
  SurdVector x;
  Surd w;
  int face;
  int side;  // -1 inside the face
};

class IrrationalScan {
 public:
  IrrationalScan(const Silhouettes& g, const ExactLine& line)
      : g_(g), scene_(g.scene()), line_(line), c_(line.coordinates()) {
    while (is_zero(c_.d[axis_], c_.radicand)) ++axis_;
  }

  void add(int face) {
    const auto corners = scene_.face_points(face);
    const auto n = static_cast<int>(corners.size());
    bool front = false;
    bool back = false;
    int zeros = 0;
    int side = -1;
    for (int k = 0; k < n; ++k) {
      const Sign s = side_of(corners[k], corners[(k + 1) % n]);
      front |= s == Sign::Positive;
      back |= s == Sign::Negative;
      if (front && back) return;
      if (s == Sign::Zero) {
        ++zeros;
        side = k;
      }
    }
    if (zeros > 1) side = side_among(face, front ? Sign::Positive : Sign::Negative);
    meetings_.push_back(meeting(face, side));
  }

  /// Contacts in order along the line, each the meetings in one point.
  void sort() {
    std::sort(meetings_.begin(), meetings_.end(), [&](const auto& a, const auto& b) {
      const Sign s = order(a, b);
      return s != Sign::Zero ? s == Sign::Negative : a.face < b.face;
    });
    for (std::size_t i = 0; i < meetings_.size(); ++i) {
      if (i == 0 || order(meetings_[i - 1], meetings_[i]) != Sign::Zero) {
        starts_.push_back(i);
      }
    }
    starts_.push_back(meetings_.size());
  }

  [[nodiscard]] int size() const { return static_cast<int>(starts_.size()) - 1; }

  [[nodiscard]] std::vector<Generator> generators(int contact) const {
    std::vector<Generator> found;
    for (std::size_t i = starts_[contact]; i < starts_[contact + 1]; ++i) {
      const Meeting& m = meetings_[i];
      const int edge = m.side < 0 ? -1 : scene_.edge_of_side(m.face, m.side);
      if (edge >= 0) found.push_back(g_.named(edge));
    }
    sort_unique(found);
    return found;
  }

  [[nodiscard]] bool blocked(int contact) const {
    // On which side of the plane of the line and the edges' common line the faces lie.
    const Meeting& first = meetings_[starts_[contact]];
    if (first.side < 0) return true;
    const int pivot = scene_.face_points(first.face)[first.side];
    bool front = false;
    bool back = false;
    for (std::size_t i = starts_[contact]; i < starts_[contact + 1]; ++i) {
      const Meeting& m = meetings_[i];
      if (m.side < 0 || scene_.edge_of_side(m.face, m.side) < 0) return true;
      for (const int corner : scene_.face_points(m.face)) {
        const Sign s = corner == pivot ? Sign::Zero : side_of(pivot, corner);
        front |= s == Sign::Positive;
        back |= s == Sign::Negative;
      }
    }
    return front && back;
  }

  /// The point, rounded: each coordinate is off by at most kQuotientError of itself.
  [[nodiscard]] Point point(int contact) const {
    const Meeting& m = meetings_[starts_[contact]];
    Point out;
    for (int i = 0; i < 3; ++i) out[i] = quotient(m.x[i], m.w, c_.radicand);
    return out;
  }

  /// By face id.
  [[nodiscard]] std::vector<Touch> touches(int contact) const {
    std::vector<Touch> out;
    for (std::size_t i = starts_[contact]; i < starts_[contact + 1]; ++i) {
      const Meeting& m = meetings_[i];
      const bool at_edge = m.side >= 0 && scene_.edge_of_side(m.face, m.side) >= 0;
      out.push_back({m.face, at_edge ? TouchKind::Edge : TouchKind::Interior,
                     at_edge ? m.side : -1});
    }
    return out;
  }

  /// Sign of (parameter on the edge) - (that of the other line of the two); Zero when
  /// they meet it in one point.
  [[nodiscard]] Sign beyond_other(int contact, int edge) const {
    const Meeting& m = meetings_[starts_[contact]];
    const auto& ends = scene_.edges()[edge].points;
    const Point along = scene_.point(ends[1]) - scene_.point(ends[0]);
    int axis = 0;
    along.cwiseAbs().maxCoeff(&axis);
    // x / w = x w' / (w w') with w' the conjugate: its part with sqrt(D).
    const Surd& x = m.x[axis];
    const Sign part = internal::sign_of(x.b * m.w.a - x.a * m.w.b);
    const Sign norm = internal::sign_of(m.w.a * m.w.a - m.w.b * m.w.b * c_.radicand);
    return part * norm * internal::sign_of(along[axis]);
  }

 private:
  [[nodiscard]] Sign side_of(int p, int q) const {
    return line_.side({scene_.point(p), scene_.point(q)});
  }

  // Of several sides on one line, that with the point: it is not beyond the next corner,
  // as a line from there to a corner off that line tells.
  [[nodiscard]] int side_among(int face, Sign inside) const {
    const auto corners = scene_.face_points(face);
    const auto n = static_cast<int>(corners.size());
    int apex = 0;  // off the line of the sides that are met
    for (int k = 0; k < n; ++k) {
      if (side_of(corners[k], corners[(k + 1) % n]) != Sign::Zero &&
          side_of(corners[(k + 1) % n], corners[(k + 2) % n]) != Sign::Zero) {
        apex = (k + 1) % n;
      }
    }
    for (int k = 0; k < n; ++k) {
      const int next = (k + 1) % n;
      if (side_of(corners[k], corners[next]) != Sign::Zero) continue;
      const bool before = side_of(corners[next], corners[(next + 1) % n]) != Sign::Zero ||
                          side_of(corners[next], corners[apex]) == inside;
      const bool after = side_of(corners[(k + n - 1) % n], corners[k]) != Sign::Zero ||
                         side_of(corners[apex], corners[k]) == inside;
      if (before && after) return k;
    }
    assert(false);
    return -1;
  }

  // With plane N X = c and line X x d = m: X (N d) = N x m + c d.
  [[nodiscard]] Meeting meeting(int face, int side) const {
    const auto corners = scene_.face_points(face);
    const Point& a = scene_.point(corners[0]);
    const RingVector u = ring_difference(scene_.point(corners[1]), a);
    const RingVector v = ring_difference(scene_.point(corners[2]), a);
    const RingVector n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]};
    const RingVector at = ring_point(a);
    const Ring c = n[0] * at[0] + n[1] * at[1] + n[2] * at[2];
    Meeting out{{}, {}, face, side};
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      out.x[i] = c_.m[k] * n[j] - c_.m[j] * n[k] + c_.d[i] * c;
      out.w = out.w + c_.d[i] * n[i];
    }
    if (sign_of(out.w, c_.radicand) == Sign::Negative) {
      for (Surd& s : out.x) s = -s;
      out.w = -out.w;
    }
    return out;
  }

  [[nodiscard]] Sign order(const Meeting& a, const Meeting& b) const {
    const Ring& d = c_.radicand;
    const Surd ahead = product(a.x[axis_], b.w, d) - product(b.x[axis_], a.w, d);
    return sign_of(ahead, d) * sign_of(c_.d[axis_], d);
  }

  const Silhouettes& g_;
  const Scene& scene_;
  const ExactLine& line_;
  const ExactLine::Coordinates& c_;
  int axis_ = 0;
  std::vector<Meeting> meetings_;
  std::vector<std::size_t> starts_;
};

Point contact_of(const Silhouettes& g, const ExactLine& line, int edge) {
  const auto& p = g.scene().edges()[edge].points;
  return line.contact({g.scene().point(p[0]), g.scene().point(p[1])}).point;
}

IrrationalScan scan_of(const Silhouettes& g, const ExactLine& line,
                       const std::array<int, 2>& outer) {
  IrrationalScan scan(g, line);
  for (const int face :
       faces_near_line(g, contact_of(g, line, outer[0]), contact_of(g, line, outer[1]))) {
    scan.add(face);
  }
  scan.sort();
  return scan;
}

// The contact that has the edge, -1 for none.
int find_contact(const Silhouettes& g, const IrrationalScan& scan, int edge) {
  const Generator wanted = g.named(edge);
  for (int i = 0; i < scan.size(); ++i) {
    const auto here = scan.generators(i);
    if (std::find(here.begin(), here.end(), wanted) != here.end()) return i;
  }
  return -1;
}

// Of four edges: along the outer one with the smaller number of a ridge.
bool is_beyond_other(const Silhouettes& g, const IrrationalScan& scan,
                     const NodeContacts& node) {
  const std::array<int, 2> outer{node.generators.front().id, node.generators.back().id};
  const int e =
      g.ridge_of_edge(outer[0]) < g.ridge_of_edge(outer[1]) ? outer[0] : outer[1];
  return scan.beyond_other(find_contact(g, scan, e), e) == Sign::Positive;
}

}  // namespace

std::optional<FreeSegment> free_segment(const Silhouettes& g, const ExactLine& line,
                                        const std::array<int, 2>& outer) {
  const IrrationalScan scan = scan_of(g, line, outer);
  const int first = find_contact(g, scan, outer[0]);
  const int last = find_contact(g, scan, outer[1]);
  if (first < 0 || last < 0 || first == last) return std::nullopt;
  const int step = first < last ? 1 : -1;
  for (int i = first + step; i != last; i += step) {
    if (scan.blocked(i)) return std::nullopt;
  }
  const Point start = scan.point(first);
  const Point way = scan.point(last) - start;
  const auto position = [&](int i) {
    if (i == first || i == last) return i == first ? 0.0 : 1.0;
    return (scan.point(i) - start).dot(way) / way.squaredNorm();
  };
  const auto faces = [&](int i) {
    std::vector<int> out;
    for (const Touch& t : scan.touches(i)) out.push_back(t.face);
    return out;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FreeSegment out{-kInfinity, kInfinity, {}, {}, {}};
  // From the outer contacts on, away from each other, to what blocks.
  const auto end_of = [&](int from, int towards, double& at, std::vector<int>& ended_by) {
    int reached = from;
    for (int i = from; i >= 0 && i < scan.size(); i += towards) {
      if (scan.blocked(i)) {
        at = position(i);
        ended_by = faces(i);
        break;
      }
      reached = i;
    }
    return reached;
  };
  const int low = end_of(first, -step, out.from, out.from_faces);
  const int high = end_of(last, step, out.to, out.to_faces);
  for (int i = low; i != high + step; i += step) {
    const double at = position(i);
    out.contacts.push_back({at, at, scan.blocked(i), scan.touches(i)});
  }
  return out;
}

NodeContacts contacts_along(const Silhouettes& g, const ExactLine& line,
                            const std::array<int, 2>& outer, bool grazes) {
  const auto contact_with = [&](int edge) { return contact_of(g, line, edge); };
  const IrrationalScan scan = scan_of(g, line, outer);
  std::vector<std::vector<Generator>> contacts;
  std::array<int, 2> at{-1, -1};
  for (int i = 0; i < scan.size(); ++i) {
    contacts.push_back(scan.generators(i));
    for (int k = 0; k < 2; ++k) {
      const Generator wanted{GeneratorKind::Edge, outer[k]};
      if (std::find(contacts[i].begin(), contacts[i].end(), wanted) !=
          contacts[i].end()) {
        at[k] = i;
      }
    }
  }
  int from = std::min(at[0], at[1]);
  int to = std::max(at[0], at[1]);
  if (from < 0) return {};
  bool end = false;
  for (int i = from; i <= to; ++i) end |= scan.blocked(i);
  const bool with_ends = g.polygon() && !grazes;
  const auto go_on = [&](int contact, int step) {
    while (!scan.blocked(contact)) {
      const int next = contact + step;
      if (next < 0 || next >= scan.size()) break;
      if (scan.blocked(next) && (!with_ends || contacts[next].empty())) break;
      contact = next;
    }
    return contact;
  };
  if (!end || with_ends) {
    from = go_on(from, -1);
    to = go_on(to, 1);
  }
  NodeContacts node = node_along(g, {contacts.begin() + from, contacts.begin() + to + 1});
  node.end = end;
  if (with_ends || (g.polygon() && end)) {
    node.ends = {scan.blocked(node.turned ? to : from),
                 scan.blocked(node.turned ? from : to)};
    node.end = node.end || node.ends[0] || node.ends[1];
  }
  // In the order in which they are listed.
  for (int k = 0; k <= to - from; ++k) {
    const int i = node.turned ? to - k : from + k;
    if (contacts[i].empty()) continue;
    const Sign s = scan.beyond_other(i, contacts[i].front().id);
    if (s == Sign::Zero) continue;
    node.second = s == Sign::Positive;
    break;
  }
  if (node.kind == NodeKind::EEEE) node.second = is_beyond_other(g, scan, node);
  const auto outermost = [&](const std::vector<Generator>& c, int otherwise) {
    return contact_with(c.empty() ? otherwise : c.front().id);
  };
  node.segment = {outermost(contacts[from], outer[0]), outermost(contacts[to], outer[1])};
  if (node.turned) std::swap(node.segment[0], node.segment[1]);
  return node;
}

}  // namespace sightline::internal
