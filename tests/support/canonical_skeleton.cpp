#include "tests/support/canonical_skeleton.h"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace sightline::testing {
namespace {

void print(std::ostream& out, const GeneratorKey& key) {
  out << key.kind;
  for (const Coordinates& p : key.points) {
    out << '(' << p[0] << ' ' << p[1] << ' ' << p[2] << ')';
  }
}

void print(std::ostream& out, const NodeKey& key) {
  out << key.kind << '[';
  for (const GeneratorKey& g : key.generators) print(out << ' ', g);
  out << " ]";
}

std::string name(const ArcKey& key) {
  const bool end = std::ranges::any_of(key.generators, [](const GeneratorKey& g) {
    return g.kind == 'v' || g.kind == 'e';
  });
  return key.kind + (key.self ? "_self" : "") + (end ? "_end" : "");
}

void print(std::ostream& out, const ArcKey& key) {
  out << name(key) << '[';
  for (const GeneratorKey& g : key.generators) print(out << ' ', g);
  out << " ]";
  print(out << "\n      from ", key.nodes[0]);
  print(out << "\n      to ", key.nodes[1]);
}

template <class Key>
void print_missing(std::ostream& out, const std::vector<Key>& has,
                   const std::vector<Key>& lacks, const std::string& heading, int limit) {
  std::vector<Key> missing;
  std::ranges::set_difference(has, lacks, std::back_inserter(missing));
  if (missing.empty()) return;
  out << missing.size() << ' ' << heading << ":\n";
  for (std::size_t i = 0; i < missing.size() && static_cast<int>(i) < limit; ++i) {
    print(out << "    ", missing[i]);
    out << '\n';
  }
}

/// Into the direction that comes first lexicographically.
void turn(std::vector<GeneratorKey>& along_line) {
  std::vector<GeneratorKey> reversed(along_line.rbegin(), along_line.rend());
  if (reversed < along_line) along_line = std::move(reversed);
}

}  // namespace

void CanonicalSkeleton::sort() {
  std::ranges::sort(nodes);
  std::ranges::sort(arcs);
}

std::map<std::string, int> CanonicalSkeleton::counts() const {
  std::map<std::string, int> result;
  for (const NodeKey& node : nodes) ++result[node.kind];
  for (const ArcKey& arc : arcs) ++result[name(arc)];
  return result;
}

NodeKey node_key(std::string kind, std::vector<GeneratorKey> along_line) {
  const bool ordered =
      std::ranges::any_of(std::array{"VV", "VEE", "EVE", "EEEE", "FEE"},
                          [&](const char* prefix) { return kind.starts_with(prefix); });
  if (ordered) {
    turn(along_line);
  } else {
    std::ranges::sort(along_line);
  }
  return {std::move(kind), std::move(along_line)};
}

ArcKey arc_key(std::string kind, std::vector<GeneratorKey> along_line, bool self,
               std::array<NodeKey, 2> nodes) {
  turn(along_line);
  if (kind == "EEE") std::ranges::sort(nodes);
  return {std::move(kind), std::move(along_line), self, std::move(nodes)};
}

std::string difference(const CanonicalSkeleton& a, const std::string& a_name,
                       const CanonicalSkeleton& b, const std::string& b_name, int limit) {
  std::ostringstream out;
  out.precision(17);
  print_missing(out, a.nodes, b.nodes, "nodes only in " + a_name, limit);
  print_missing(out, b.nodes, a.nodes, "nodes only in " + b_name, limit);
  print_missing(out, a.arcs, b.arcs, "arcs only in " + a_name, limit);
  print_missing(out, b.arcs, a.arcs, "arcs only in " + b_name, limit);
  return out.str();
}

}  // namespace sightline::testing
