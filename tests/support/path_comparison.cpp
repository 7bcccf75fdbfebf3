#include "tests/support/path_comparison.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "linespace/numbers/exact_position.h"
#include "linespace/sight/face_crossings.h"
#include "tests/support/generators.h"
#include "tests/support/view_scenes.h"

namespace sightline::testing {
namespace {

using internal::along;
using internal::exact_position;
using internal::ExactPoint;

// Not one of the predicates' rationals: the numbers of the library.
using Number = internal::Rational;

bool crosses(const Scene& scene) {
  return !internal::FaceCrossings(internal::Silhouettes(scene, EventMode::Solid, {}))
              .empty();
}

ExactPoint some_place(Random& random, const Scene& scene) {
  const int way = random.integer(0, 2);
  ExactPoint p;
  for (int i = 0; i < 3; ++i) {
    const double low = scene.bounds()[0][i], high = scene.bounds()[1][i];
    const double margin = 0.5 * (high - low) + 1;
    const double x = random.uniform(low - margin, high + margin);
    p[i] = way == 0   ? Number(x)
           : way == 1 ? Number(std::round(x))
                      : Number(std::round(x * 12)) / 12;
  }
  return p;
}

ExactPoint some_way(Random& random) {
  const int way = random.integer(0, 2);
  ExactPoint d{};
  while (d == ExactPoint{}) {
    for (Number& x : d) {
      x = way == 0   ? Number(random.uniform(-1, 1))
          : way == 1 ? Number(random.integer(-3, 3))
                     : Number(random.integer(-9, 9)) / 7;
    }
  }
  return d;
}

class Comparison {
 public:
  Comparison(const Scene& scene, const PathRun& run, PathReport& report)
      : scene_(&scene), index_(scene), run_(&run), report_(&report) {}

  void compare(Viewpoint::Kind kind, const std::vector<ExactPoint>& places,
               Random& random) {
    std::vector<Viewpoint> path;
    for (const ExactPoint& p : places) path.push_back({kind, exact_position(p)});
    const ViewPath walk = view_path(index_, path);
    ++report_->paths;
    report_->changes += static_cast<int>(walk.changes.size());
    for (const PathChange& c : walk.changes) {
      report_->events += static_cast<int>(c.events.size());
      if (c.events.empty()) tell("no event at " + std::to_string(c.u));
      const ExactPoint eye = along(places[c.segment], places[c.segment + 1], Number(c.u));
      for (const PathEvent& event : c.events) {
        if (!lines_up(event, kind, internal::rounded(eye)))
          tell("nothing lines up at " + std::to_string(c.u));
      }
    }
    check_order(walk);
    check_changes(walk);
    check_beside_changes(walk, kind, places, random);
    check_division(walk, kind, places, random);
    for (int i = 0; i < run_->eyes; ++i) {
      const auto segment =
          static_cast<std::size_t>(random.integer(0, static_cast<int>(path.size()) - 2));
      const int below = random.one_in(2) ? 97 : 1 << 20;
      const Number u = Number(random.integer(1, below - 1)) / below;
      check_view(walk, static_cast<int>(segment), u,
                 {kind, exact_position(along(places[segment], places[segment + 1], u))});
    }
  }

 private:
  // In doubles: one line of sight meets all generators.
  [[nodiscard]] bool lines_up(const PathEvent& event, Viewpoint::Kind kind,
                              const Point& eye) const {
    constexpr double kNear = 1e-6;
    using Vector = Eigen::Vector3d;
    const auto sight = [&](const Point& x) {
      return kind == Viewpoint::Kind::Eye ? Vector(x - eye) : Vector(-eye);
    };
    std::optional<Point> on;  // some point of the line of sight
    for (const Generator& g : event.generators) {
      if (g.kind == GeneratorKind::Face) {
        const auto& facet = scene_->facets()[g.id];
        const auto c = scene_->face_points(facet.faces.front());
        const Point& p = scene_->point(c[0]);
        const Vector n =
            (scene_->point(c[1]) - p).cross(scene_->point(c[2]) - p).normalized();
        const double far = std::max(1.0, sight(p).norm());
        if (event.kind == PathEventKind::F && std::abs(n.dot(sight(p))) > kNear * far)
          return false;
      } else if (g.kind == GeneratorKind::Vertex && !on) {
        on = scene_->point(g.id);
      }
    }
    if (event.kind == PathEventKind::F || event.kind == PathEventKind::Through)
      return true;
    std::vector<std::array<Point, 2>> edges;
    for (const Generator& g : event.generators) {
      if (g.kind != GeneratorKind::Edge) continue;
      const auto& ends = scene_->edges()[g.id].points;
      edges.push_back({scene_->point(ends[0]), scene_->point(ends[1])});
    }
    // Where the first two edges that cross in the picture do so.
    for (std::size_t i = 0; !on && i < edges.size(); ++i) {
      for (std::size_t j = 0; !on && j < i; ++j) {
        const Vector n = sight(edges[j][0]).cross(edges[j][1] - edges[j][0]).normalized();
        const Vector along_i = edges[i][1] - edges[i][0];
        const double rise = n.dot(along_i);
        if (std::abs(rise) < 1e-3 * along_i.norm()) continue;
        on = edges[i][0] + n.dot(edges[j][0] - edges[i][0]) / rise * along_i;
      }
    }
    return !on || std::ranges::all_of(edges, [&](const auto& e) {
      const Vector n = sight(*on).cross(e[1] - e[0]);
      const double size = sight(*on).norm() * (e[1] - e[0]).norm();
      return std::abs(n.dot(e[0] - *on)) <=
             kNear * size * std::max(1.0, (e[0] - *on).norm());
    });
  }

  void tell(const std::string& text) { report_->differences.push_back(text); }

  void check_order(const ViewPath& walk) {
    for (std::size_t i = 1; i < walk.stretches.size(); ++i) {
      const PathStretch &a = walk.stretches[i - 1], &b = walk.stretches[i];
      const bool on = a.segment == b.segment && a.u_to == b.u_from;
      const bool next = a.segment + 1 == b.segment && a.u_to == 1 && b.u_from == 0;
      if (!on && !next) tell("stretches do not cover the path");
      if (on && a.view->general && b.view->general &&
          a.view->structure == b.view->structure) {
        tell("nothing changes at " + std::to_string(b.u_from));
      }
    }
  }

  // Each change is the difference of the views beside it.
  void check_changes(const ViewPath& walk) {
    for (const PathChange& c : walk.changes) {
      const auto before = std::ranges::find_if(walk.stretches, [&](const PathStretch& s) {
        return s.segment == c.segment && s.u_to == c.u;
      });
      if (before == walk.stretches.end() || before + 1 == walk.stretches.end()) {
        tell("a change at no end of a stretch");
        continue;
      }
      const PointView &x = *before->view, &y = *(before + 1)->view;
      MapCounts sum = map_counts(x);
      sum.edges += c.difference.edges;
      sum.regions += c.difference.regions;
      sum.t_vertices += c.difference.t_vertices;
      const MapCounts after = map_counts(y);
      if (sum.edges != after.edges || sum.regions != after.regions ||
          sum.t_vertices != after.t_vertices) {
        tell("the difference is another");
      }
      for (const int f : c.appears) {
        if (!sees(y, f)) tell("a facet that appears is not seen");
      }
      for (const int f : c.vanishes) {
        if (!sees(x, f)) tell("a facet that vanishes was not seen");
      }
      if (x.facets.size() + c.appears.size() != y.facets.size() + c.vanishes.size()) {
        tell("not all facets that appear or vanish are told");
      }
    }
  }

  // The views just before and just after some of the changes are those of the stretches
  // that they end and begin.
  void check_beside_changes(const ViewPath& walk, Viewpoint::Kind kind,
                            const std::vector<ExactPoint>& places, Random& random) {
    constexpr double kBeside = 0x1p-40;
    for (int i = 0; i < std::min(4, static_cast<int>(walk.changes.size())); ++i) {
      const PathChange& c =
          walk.changes[random.integer(0, static_cast<int>(walk.changes.size()) - 1)];
      for (const double u : {c.u - kBeside, c.u + kBeside}) {
        if (u <= 0 || u >= 1) continue;
        const Number exact(u);
        check_view(walk, c.segment, exact,
                   {kind, exact_position(
                              along(places[c.segment], places[c.segment + 1], exact))});
      }
    }
  }

  struct ToldEvent {
    double at;  // segment and u
    PathEvent event;
  };
  static std::vector<ToldEvent> told_events(const ViewPath& walk) {
    std::vector<ToldEvent> events;
    for (const PathChange& c : walk.changes) {
      for (const PathEvent& e : c.events) events.push_back({c.segment + c.u, e});
    }
    return events;
  }

  // The same path with further viewpoints on its segments has the same events.
  void check_division(const ViewPath& walk, Viewpoint::Kind kind,
                      const std::vector<ExactPoint>& places, Random& random) {
    std::vector<Viewpoint> path{{kind, exact_position(places[0])}};
    std::vector<double> at{0};
    for (std::size_t s = 0; s + 1 < places.size(); ++s) {
      std::vector<Number> seams{Number(1)};
      for (int i = random.integer(1, 3); i > 0; --i) {
        const int below = random.one_in(2) ? 12 : 997;
        Number seam = Number(random.integer(1, below - 1)) / below;
        // Where an event may be, exactly.
        if (random.one_in(2) && !walk.changes.empty()) {
          const auto c = random.integer(0, static_cast<int>(walk.changes.size()) - 1);
          if (walk.changes[c].u > 0 && walk.changes[c].u < 1)
            seam = Number(walk.changes[c].u);
        }
        seams.push_back(seam);
      }
      std::ranges::sort(seams);
      seams.erase(std::ranges::unique(seams).begin(), seams.end());
      for (const Number& seam : seams) {
        path.push_back({kind, exact_position(along(places[s], places[s + 1], seam))});
        at.push_back(static_cast<double>(s) + static_cast<double>(seam));
      }
    }
    ViewPath divided = view_path(index_, path);
    for (PathChange& c : divided.changes) {
      const double u = at[c.segment] + c.u * (at[c.segment + 1] - at[c.segment]);
      c.segment = 0;
      c.u = u;
    }
    const std::vector<ToldEvent> whole = told_events(walk), parts = told_events(divided);
    std::size_t i = 0;
    while (i < std::min(whole.size(), parts.size()) &&
           std::abs(whole[i].at - parts[i].at) < 0x1p-40 &&
           whole[i].event == parts[i].event) {
      ++i;
    }
    if (i == whole.size() && i == parts.size()) return;
    std::ostringstream out;
    out.precision(17);
    out << "divided it has " << parts.size() << " events for " << whole.size()
        << "; seams";
    for (const double seam : at) out << ' ' << seam;
    for (const auto* events : {&whole, &parts}) {
      out << "\n   ";
      for (std::size_t k = i > 0 ? i - 1 : 0; k < std::min(i + 3, events->size()); ++k) {
        out << ' ' << (*events)[k].at << " kind "
            << static_cast<int>((*events)[k].event.kind) << " of";
        for (const Generator& g : (*events)[k].event.generators)
          out << ' ' << static_cast<int>(g.kind) << ':' << g.id;
        out << ';';
      }
    }
    tell(out.str());
  }

  static bool sees(const PointView& view, int facet) {
    return std::ranges::find(view.facets, facet, &SeenFacet::facet) != view.facets.end();
  }

  void check_view(const ViewPath& walk, int segment, const Number& u,
                  const Viewpoint& eye) {
    const auto at = static_cast<double>(u);
    const auto stretch = std::ranges::find_if(walk.stretches, [&](const PathStretch& s) {
      return s.segment == segment && s.u_from <= at && at <= s.u_to;
    });
    if (stretch == walk.stretches.end()) return tell("no stretch");
    // On an event, or within rounding of one.
    if (at - stretch->u_from < 0x1p-48 || stretch->u_to - at < 0x1p-48) return;
    const PointView view = index_.view(eye);
    ++report_->views;
    // On a path in an event surface accidents come and go where the map stays.
    if (view.general && stretch->view->general &&
        view.structure != stretch->view->structure) {
      tell("another view at " + u.str());
    }
    if (map_counts(view) != map_counts(*stretch->view)) {
      tell("another map at " + u.str());
    }
  }

  const Scene* scene_;
  PointViewIndex index_;
  const PathRun* run_;
  PathReport* report_;
};

std::string told(const std::vector<ExactPoint>& places) {
  std::ostringstream out;
  for (const ExactPoint& p : places) {
    out << " (" << p[0].str() << ", " << p[1].str() << ", " << p[2].str() << ")";
  }
  return out.str();
}

}  // namespace

PathReport compare_paths(const PathRun& run) {
  PathReport report;
  std::uint64_t number = 0;
  for (const ViewScene& named : view_scenes()) {
    if (++number % static_cast<std::uint64_t>(run.every) != 0) continue;
    const Scene scene(named.soup);
    if (crosses(scene) != run.crossing) continue;
    Random random(1000 * run.seed + number);
    Comparison comparison(scene, run, report);
    for (int i = 0; i < run.paths; ++i) {
      const bool direction = random.one_in(2);
      std::vector<ExactPoint> places;
      const int count = random.one_in(4) ? 3 : 2;
      while (static_cast<int>(places.size()) < count) {
        ExactPoint p = direction ? some_way(random) : some_place(random, scene);
        if (!places.empty()) {
          if (p == places.back()) continue;
          const bool opposite = internal::exact_cross(p, places.back()) == ExactPoint{} &&
                                internal::exact_dot(p, places.back()) < 0;
          if (direction && opposite) continue;
        }
        places.push_back(p);
      }
      const std::size_t known = report.differences.size();
      const auto kind = direction ? Viewpoint::Kind::Direction : Viewpoint::Kind::Eye;
      try {
        comparison.compare(kind, places, random);
      } catch (const std::exception& e) {
        report.differences.emplace_back(std::string("exception: ") + e.what());
      }
      for (std::size_t d = known; d < report.differences.size(); ++d) {
        report.differences[d] = named.name + ", path " + std::to_string(i) +
                                (direction ? " of directions" : " of eyes") +
                                told(places) + ": " + report.differences[d];
      }
      if (static_cast<int>(report.differences.size()) >= run.most_reports) return report;
    }
  }
  return report;
}

}  // namespace sightline::testing
