// Says which invariances fail on scenes from seeds, and on how few objects.
//
//   invariance_table FIRST LAST [CROWD]     counts of differences by crowd and variant
//   invariance_table show CROWD SEED VARIANT    the differences, and OBJ files: the
//   scene, its variant, and this with the map undone
//   invariance_table shrink CROWD SEED VARIANT  the same on as few objects as still
//   differ

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <mutex>
#include <thread>

#include "tests/support/answers.h"

namespace sightline::testing {
namespace {

void write_obj(const PolygonSoup& soup, const std::string& file) {
  std::ofstream out(file);
  out.precision(17);
  for (const Point& p : soup.vertices) {
    out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  }
  for (const PolygonSoup::Group& group : soup.groups) {
    out << "o " << group.name << '\n';
    for (const int f : group.faces) {
      out << 'f';
      for (const int v : soup.polygons[f]) out << ' ' << v + 1;
      out << '\n';
    }
  }
}

const std::array kCrowds = {Crowd::Overlapping, Crowd::Touching, Crowd::RepeatedFaces,
                            Crowd::NonManifold};

/// "solid EV" and the like, for a table.
std::map<std::string, int> kinds_of(const Answers& a, const Answers& b) {
  std::map<std::string, int> found;
  const auto skeletons = [&](const std::string& mode, const CanonicalSkeleton& x,
                             const CanonicalSkeleton& y) {
    if (x.nodes != y.nodes) ++found[mode + " nodes"];
    if (x.arcs != y.arcs) ++found[mode + " arcs"];
  };
  skeletons("solid", a.solid, b.solid);
  skeletons("polygon", a.polygon, b.polygon);
  if (a.segments != b.segments) ++found["segments"];
  if (a.events != b.events) ++found["events"];
  if (a.visible != b.visible) ++found["visible"];
  return found;
}

int table(std::uint64_t first, std::uint64_t last, const std::vector<Crowd>& crowds) {
  std::map<std::string, int> counts;
  std::map<std::string, std::string> samples;
  std::mutex lock;
  int scenes = 0, runs = 0, failed = 0;
  std::vector<std::pair<Crowd, std::uint64_t>> jobs;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    for (const Crowd crowd : crowds) jobs.emplace_back(crowd, seed);
  }
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t j; (j = next++) < jobs.size();) {
      const auto [crowd, seed] = jobs[j];
      const PolygonSoup soup = crowded_scene(crowd, seed);
      const Questions q = questions_for(soup, seed);
      const auto identity = [](const Point& p) -> Point { return p; };
      const Answers base = answers_of({"as it is", soup, identity, identity}, q, true);
      for (const Variant& v : variants_of(soup, seed)) {
        const Answers other = answers_of(v, q, true);
        const auto kinds = kinds_of(base, other);
        const std::lock_guard hold(lock);
        ++runs;
        failed += kinds.empty() ? 0 : 1;
        if (!kinds.empty()) {
          std::cerr << name(crowd) << ' ' << seed << ", " << v.name << ':';
          for (const auto& [kind, n] : kinds) std::cerr << ' ' << kind << ',';
          std::cerr << std::endl;
        }
        for (const auto& [kind, n] : kinds) {
          const std::string key = v.name + " | " + kind;
          ++counts[key];
          std::string& sample = samples[key];
          if (sample.size() < 120)
            sample += ", " + name(crowd) + " " + std::to_string(seed);
        }
      }
      const std::lock_guard hold(lock);
      ++scenes;
      if (scenes % 20 == 0) std::cerr << scenes << " scenes done" << std::endl;
    }
  };
  std::thread other(work);
  work();
  other.join();
  for (const auto& [key, n] : counts) {
    std::cout << n << "\t" << key << "\t" << samples[key].substr(2) << '\n';
  }
  std::cout << scenes << " scenes, " << runs << " variants, " << failed << " differ\n";
  return failed == 0 ? 0 : 1;
}

std::string failure_of(const PolygonSoup& soup, std::uint64_t seed,
                       const std::string& variant, bool write) {
  const Questions q = questions_for(soup, seed);
  const auto identity = [](const Point& p) -> Point { return p; };
  const Answers base = answers_of({"as it is", soup, identity, identity}, q, true);
  for (const Variant& v : variants_of(soup, seed)) {
    if (v.name != variant) continue;
    const std::string text = difference(base, answers_of(v, q, true), 3);
    if (write) {
      write_obj(soup, "scene.obj");
      write_obj(v.soup, "variant.obj");
      PolygonSoup back = v.soup;
      for (Point& p : back.vertices) p = v.undo(p);
      write_obj(back, "variant_in_place.obj");
    }
    if (!text.empty()) return text;
  }
  return "";
}

PolygonSoup without(const PolygonSoup& soup, std::size_t group) {
  PolygonSoup result = soup;
  result.groups.erase(result.groups.begin() + static_cast<std::ptrdiff_t>(group));
  std::vector<int> id(soup.polygons.size(), -1);
  result.polygons.clear();
  for (PolygonSoup::Group& g : result.groups) {
    for (int& f : g.faces) {
      id[f] = static_cast<int>(result.polygons.size());
      result.polygons.push_back(soup.polygons[f]);
      f = id[f];
    }
  }
  std::map<int, int> used;
  result.vertices.clear();
  for (auto& face : result.polygons) {
    for (int& v : face) {
      const auto [at, is_new] =
          used.try_emplace(v, static_cast<int>(result.vertices.size()));
      if (is_new) result.vertices.push_back(soup.vertices[v]);
      v = at->second;
    }
  }
  return result;
}

void shrink(PolygonSoup soup, std::uint64_t seed, const std::string& variant) {
  std::uint64_t found = seed;
  for (bool again = true; again && soup.groups.size() > 1;) {
    again = false;
    for (std::size_t g = 0; g < soup.groups.size() && !again; ++g) {
      const PolygonSoup smaller = without(soup, g);
      for (std::uint64_t s = 1; s <= 6 && !again; ++s) {
        if (failure_of(smaller, s, variant, false).empty()) continue;
        soup = smaller;
        found = s;
        again = true;
      }
    }
  }
  std::cout << soup.groups.size() << " objects:";
  for (const auto& g : soup.groups) std::cout << ' ' << g.name;
  std::cout << '\n' << failure_of(soup, found, variant, true);
}

Crowd crowd_named(const std::string& text) {
  for (const Crowd c : kCrowds) {
    if (name(c) == text) return c;
  }
  std::exit(2);
}

}  // namespace
}  // namespace sightline::testing

int main(int argc, char** argv) {
  using namespace sightline::testing;
  const std::vector<std::string> args(argv + 1, argv + argc);
  if (args.size() == 4) {
    const auto seed = std::strtoull(args[2].c_str(), nullptr, 10);
    const auto soup = crowded_scene(crowd_named(args[1]), seed);
    if (args[0] == "shrink") {
      shrink(soup, seed, args[3]);
    } else {
      std::cout << failure_of(soup, seed, args[3], true);
    }
    return 0;
  }
  if (args.size() < 2) return 2;
  std::vector<Crowd> crowds(kCrowds.begin(), kCrowds.end());
  if (args.size() == 3) crowds = {crowd_named(args[2])};
  return table(std::strtoull(args[0].c_str(), nullptr, 10),
               std::strtoull(args[1].c_str(), nullptr, 10), crowds);
}
