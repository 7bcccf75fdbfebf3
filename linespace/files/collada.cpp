// A look at where a Collada file says that its coordinates are, before assimp reads it:
// without one of x, y and z that reader takes another for it, and says nothing.

#include <algorithm>
#include <map>
#include <vector>

#include "linespace/files/mesh_io.h"

namespace sightline::internal {
namespace {

/// The value of an attribute of a tag, both without their quotes; empty without it.
std::string attribute(std::string_view tag, const std::string& name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos;
       at = tag.find(name, at + 1)) {
    const std::size_t quote = at + name.size() + 1;
    if (at == 0 || std::string_view(" \t\r\n").find(tag[at - 1]) == tag.npos) continue;
    if (quote >= tag.size() || tag[quote - 1] != '=') continue;
    const std::size_t end = tag.find(tag[quote], quote + 1);
    if (end == tag.npos) continue;
    return std::string(tag.substr(quote + 1, end - quote - 1));
  }
  return {};
}

struct Columns {
  bool any = false;             // of x, y and z
  std::string missing = "XYZ";  // of these
};

}  // namespace

void check_collada(const std::string& path, std::string_view text, Stage& stage) {
  std::map<std::string, Columns> sources;
  std::vector<std::string> positions;
  std::string source;
  std::size_t end = 0;
  for (std::size_t at = text.find('<'); at != text.npos; at = text.find('<', end)) {
    stage.at(at, text.size());
    const bool comment = text.substr(at).starts_with("<!--");
    end = std::min(text.find(comment ? "-->" : ">", at), text.size());
    if (comment) continue;
    const std::string_view tag = text.substr(at + 1, end - at - 1);
    if (tag.starts_with("source ")) source = attribute(tag, "id");
    if (tag.starts_with("param ")) {
      const std::string name = attribute(tag, "name");
      Columns& columns = sources[source];
      if (const auto k = columns.missing.find(name); name.size() == 1 && k != name.npos) {
        columns.any = true;
        columns.missing.erase(k, 1);
      }
    }
    if (tag.starts_with("input ") && attribute(tag, "semantic") == "POSITION") {
      positions.push_back(attribute(tag, "source"));
    }
  }
  for (const std::string& name : positions) {
    const auto at = name.empty() ? sources.end() : sources.find(name.substr(1));  // '#'
    if (at == sources.end() || !at->second.any || at->second.missing.empty()) continue;
    refuse(path, "the positions " + quoted(at->first) + " have no param " +
                     at->second.missing.substr(0, 1));
  }
}

}  // namespace sightline::internal
