// Wavefront OBJ: vertices, polygons, and the names of `o` and `g` lines.

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_map>

#include "linespace/files/mesh_io.h"
#include "linespace/files/nodes.h"

namespace sightline::internal {
namespace {

// Statements that say nothing about polygons; any other unknown word is refused, because
// it means that the file is damaged or no OBJ.
constexpr std::array<std::string_view, 35> kIgnored{
    "bevel", "bmat",   "c_interp", "cdc",        "con", "cstype", "ctech",
    "curv",  "curv2",  "d_interp", "deg",        "end", "hole",   "l",
    "lod",   "maplib", "mg",       "mtllib",     "p",   "parm",   "res",
    "s",     "scrv",   "sh",       "shadow_obj", "sp",  "stech",  "step",
    "trim",  "usemap", "usemtl",   "trace_obj",  "vn",  "vp",     "vt"};

// Statements that make surfaces which are not read here: without them the scene has
// holes.
struct Unread {
  std::string_view word, what;
};
constexpr std::array<Unread, 6> kUnread{{{"surf", "free-form surfaces"},
                                         {"bsp", "B-spline patches"},
                                         {"bzp", "Bezier patches"},
                                         {"cdp", "Cardinal patches"},
                                         {"call", "statements of other files"},
                                         {"csh", "commands of the shell"}}};

// What names begin with; a '#' inside a name is the name's.
bool takes_names(std::string_view word) {
  return word == "o" || word == "g" || word == "usemtl" || word == "mtllib";
}

class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view text, Stage& stage)
      : path_(path), stage_(stage), lines_(path, without_byte_order_mark(text), stage) {}

  PolygonSoup read() {
    while (lines_.next_filled()) {
      cut_comment(lines_);
      // A backslash at the end continues the statement on the next line.
      if (lines_.rest().ends_with('\\')) {
        read_continued();
      } else if (!lines_.rest().empty()) {
        read_statement(lines_);
      }
    }
    if (late_index_ > static_cast<long long>(soup_.vertices.size())) {
      refuse_line(path_, late_line_,
                  "names vertex " + std::to_string(late_index_) + " of " +
                      std::to_string(soup_.vertices.size()));
    }
    list_faces();
    make_groups();
    return std::move(soup_);
  }

 private:
  // A comment is a line of its own or follows numbers.
  static void cut_comment(LineReader& line) {
    LineReader words = line;
    if (!takes_names(words.token())) line.cut_at('#');
  }

  void read_continued() {
    const std::size_t first = lines_.number();
    std::string joined;
    for (;;) {
      std::string_view part = lines_.rest();
      const bool more = part.ends_with('\\');
      if (more) part.remove_suffix(1);
      joined.append(part).push_back(' ');
      if (!more || !lines_.next()) break;
    }
    LineReader statement(path_, joined, stage_, first);
    if (!statement.next_filled()) return;
    cut_comment(statement);
    if (!statement.rest().empty()) read_statement(statement);
  }

  void read_statement(LineReader& line) {
    const std::string_view word = line.token();
    if (word == "v") {
      Point p;
      for (double& x : p) x = line.number("a coordinate");
      soup_.vertices.push_back(p);  // weight and colours may follow
    } else if (word == "f" || word == "fo") {
      read_face(line);
    } else if (word == "g") {
      read_groups(line);
    } else if (word == "o") {
      list_faces();
      groups_.clear();
      object_ = line.rest().empty() ? -1 : group_named(std::string(line.rest()));
    } else if (std::find(kIgnored.begin(), kIgnored.end(), word) == kIgnored.end()) {
      for (const Unread& unread : kUnread) {
        if (word != unread.word) continue;
        line.refuse(std::string(unread.what) + " are not read here: " + quoted(word));
      }
      line.refuse("no OBJ statement: " + quoted(word));
    }
  }

  // Names of groups, separated by blanks.  From the first one after a name that begins
  // with
  // '#' on, the line belongs to that name ("g Part #1" is one group).
  void read_groups(LineReader& line) {
    list_faces();
    groups_.clear();
    while (!line.rest().empty()) {
      const std::string_view all = line.rest();
      std::string_view name = line.token();
      if (line.rest().starts_with('#')) {
        name = all;
        while (!line.token().empty()) {
        }
      }
      groups_.push_back(group_named(std::string(name)));
      named_[groups_.back()].by_g = true;
    }
  }

  void read_face(LineReader& line) {
    std::vector<int> polygon;
    polygon.reserve(4);
    for (auto corner = line.token(); !corner.empty(); corner = line.token()) {
      const std::size_t slash = corner.find('/');
      const auto index = parse_integer(corner.substr(0, slash));
      const bool rest_is_fine =
          slash == std::string_view::npos ||
          corner.find_first_not_of("0123456789/-", slash) == std::string_view::npos;
      if (!index || !rest_is_fine) line.refuse("no corner of a face: " + quoted(corner));
      polygon.push_back(vertex_at(line, *index));
    }
    if (polygon.empty()) line.refuse("a face without corners");
    soup_.polygons.push_back(std::move(polygon));
  }

  // Counted from 1, or backwards from the latest vertex as -1.  A vertex may come later
  // in the file: checked at the end.
  int vertex_at(const LineReader& line, long long index) {
    const auto count = static_cast<long long>(soup_.vertices.size());
    if (index < 0 && index >= -count) return static_cast<int>(count + index);
    if (index <= 0 || index > std::numeric_limits<int>::max()) {
      line.refuse("names vertex " + std::to_string(index) + " of " +
                  std::to_string(count));
    }
    if (index > count && index > late_index_) {
      late_index_ = index;
      late_line_ = line.number();
    }
    return static_cast<int>(index - 1);
  }

  // The faces from one to another, both included.
  using Range = std::pair<int, int>;
  struct Named {
    std::string name;
    bool by_g;  // some `g` line has it
    std::vector<Range> faces;
  };

  int group_named(const std::string& name) {
    const auto [entry, is_new] = numbers_.emplace(name, static_cast<int>(named_.size()));
    if (is_new) named_.push_back({name, false, {}});
    return entry->second;
  }

  // The faces since the names changed last get those names.
  void list_faces() {
    const Range range{first_face_, static_cast<int>(soup_.polygons.size()) - 1};
    first_face_ = range.second + 1;
    if (range.second < range.first) return;
    for (const int g : groups_) add(g, range);
    if (object_ >= 0) add(object_, range);
  }

  void add(int group, const Range& range) {
    auto& faces = named_[group].faces;
    if (!faces.empty() && faces.back().second >= range.first) return;  // named twice
    if (!faces.empty() && faces.back().second + 1 == range.first) {
      faces.back().second = range.second;
    } else {
      faces.push_back(range);
    }
  }

  // Names of the same faces make one group.  A face under an `o` and a `g` belongs to the
  // object of the latter, the finer name.
  void make_groups() {
    std::stable_partition(named_.begin(), named_.end(),
                          [](const Named& named) { return named.by_g; });
    std::map<std::vector<Range>, std::size_t> known;
    std::size_t listed = 0;
    for (Named& named : named_) {
      const auto [entry, is_new] = known.emplace(named.faces, soup_.groups.size());
      if (!is_new) {
        soup_.groups[entry->second].aliases.push_back(std::move(named.name));
        continue;
      }
      auto& group = soup_.groups.emplace_back();
      group.name = std::move(named.name);
      for (const auto& [first, last] : named.faces) {
        listed += static_cast<std::size_t>(last - first) + 1;
        if (lists_too_many(listed, soup_.polygons.size())) {
          throw InvalidInput(path_ + ": its groups list the same faces too often");
        }
        for (int f = first; f <= last; ++f) group.faces.push_back(f);
      }
    }
  }

  const std::string& path_;
  Stage& stage_;
  LineReader lines_;
  PolygonSoup soup_;
  std::unordered_map<std::string, int> numbers_;
  std::vector<Named> named_;
  std::vector<int> groups_;  // of the last `g`
  int object_ = -1;          // of the last `o`
  int first_face_ = 0;       // that list_faces has not seen
  long long late_index_ = 0;
  std::size_t late_line_ = 0;
};

}  // namespace

PolygonSoup read_obj(const std::string& path, std::string_view text, Stage& stage) {
  return ObjReader(path, text, stage).read();
}

}  // namespace sightline::internal
