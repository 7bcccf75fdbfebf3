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

void print(std::ostream& out, const ArcKey& key) {
  print(out << (key.self ? "EV_self " : "EV "), key.vertex);
  print(out << ' ', key.edge);
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

}  // namespace

void CanonicalSkeleton::sort() {
  std::ranges::sort(nodes);
  std::ranges::sort(arcs);
}

std::map<std::string, int> CanonicalSkeleton::counts() const {
  std::map<std::string, int> result;
  for (const NodeKey& node : nodes) ++result[node.kind];
  for (const ArcKey& arc : arcs) ++result[arc.self ? "EV_self" : "EV"];
  return result;
}

NodeKey node_key(std::string kind, std::vector<GeneratorKey> along_line) {
  if (kind.starts_with("VV") || kind.starts_with("VEE") || kind.starts_with("EVE")) {
    std::vector<GeneratorKey> reversed(along_line.rbegin(), along_line.rend());
    if (reversed < along_line) along_line = std::move(reversed);
  } else {
    std::ranges::sort(along_line);
  }
  return {std::move(kind), std::move(along_line)};
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
