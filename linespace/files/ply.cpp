// Polygon File Format (Stanford PLY): ASCII and binary of both byte orders; polygons and
// triangle strips.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "linespace/files/mesh_io.h"

namespace sightline::internal {
namespace {

enum class Scalar : std::uint8_t { I8, U8, I16, U16, I32, U32, F32, F64 };

struct ScalarName {
  std::string_view name;
  Scalar type;
};
constexpr std::array<ScalarName, 16> kScalarNames{{{"char", Scalar::I8},
                                                   {"int8", Scalar::I8},
                                                   {"uchar", Scalar::U8},
                                                   {"uint8", Scalar::U8},
                                                   {"short", Scalar::I16},
                                                   {"int16", Scalar::I16},
                                                   {"ushort", Scalar::U16},
                                                   {"uint16", Scalar::U16},
                                                   {"int", Scalar::I32},
                                                   {"int32", Scalar::I32},
                                                   {"uint", Scalar::U32},
                                                   {"uint32", Scalar::U32},
                                                   {"float", Scalar::F32},
                                                   {"float32", Scalar::F32},
                                                   {"double", Scalar::F64},
                                                   {"float64", Scalar::F64}}};

std::size_t bytes_of(Scalar type) {
  constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Scalar type;
  bool is_list = false;
  Scalar size_type = Scalar::U8;
};

struct Element {
  std::string name;
  long long count;
  std::vector<Property> properties;
};

enum class Encoding { Ascii, LittleEndian, BigEndian };

struct Header {
  Encoding encoding = Encoding::Ascii;
  std::vector<Element> elements;
};

Scalar scalar_named(const LineReader& line, std::string_view name) {
  const auto* const found = std::find_if(kScalarNames.begin(), kScalarNames.end(),
                                         [&](const auto& s) { return s.name == name; });
  if (found == kScalarNames.end()) line.refuse("no type of PLY: " + quoted(name));
  return found->type;
}

void read_format(LineReader& line, Header& header) {
  const std::string_view name = line.token();
  if (name == "ascii") {
    header.encoding = Encoding::Ascii;
  } else if (name == "binary_little_endian") {
    header.encoding = Encoding::LittleEndian;
  } else if (name == "binary_big_endian") {
    header.encoding = Encoding::BigEndian;
  } else {
    line.refuse("no format of PLY: " + quoted(name));
  }
  if (line.token() != "1.0") line.refuse("only version 1.0 of PLY is read here");
}

void read_property(LineReader& line, Header& header) {
  if (header.elements.empty()) line.refuse("a property before any element");
  Property property;
  std::string_view type = line.token();
  if (type == "list") {
    property.is_list = true;
    property.size_type = scalar_named(line, line.token());
    if (property.size_type >= Scalar::F32) line.refuse("a list needs a whole size");
    type = line.token();
  }
  property.type = scalar_named(line, type);
  property.name = line.token();
  if (property.name.empty()) line.refuse("a property without name");
  header.elements.back().properties.push_back(std::move(property));
}

Header read_header(const std::string& path, LineReader& lines) {
  if (!lines.next() || lines.rest() != "ply") refuse(path, "no PLY header");
  Header header;
  bool has_format = false;
  while (lines.next()) {
    const std::string_view word = lines.token();
    if (word == "format") {
      read_format(lines, header);
      has_format = true;
    } else if (word == "element") {
      const std::string_view name = lines.token();
      const long long count = lines.integer("the number of elements");
      if (count < 0) lines.refuse("announces a negative number of elements");
      header.elements.push_back({std::string(name), count, {}});
    } else if (word == "property") {
      read_property(lines, header);
    } else if (word == "end_header") {
      if (!has_format) lines.refuse("a header without format");
      return header;
    } else if (word != "comment" && word != "obj_info" && !word.empty()) {
      lines.refuse("no PLY header line: " + quoted(word));
    }
  }
  refuse(path, "ends inside the PLY header");
}

// Delivers the values of one element after the other.  An element begins on a line of its
// own and may go on over the next lines; nothing else stands on its last one.
class AsciiValues {
 public:
  AsciiValues(const LineReader& lines) : lines_(lines) {}

  [[nodiscard]] bool can_hold(const Element& element) const {
    std::size_t bytes = 0;  // a digit and a blank or line end a value
    for ([[maybe_unused]] const auto& p : element.properties) bytes += 2;
    return bytes == 0 ||
           static_cast<std::size_t>(element.count) <= (lines_.bytes_left() + 1) / bytes;
  }
  [[nodiscard]] std::size_t values_left(Scalar) const {
    return (lines_.rest().size() + lines_.bytes_left()) / 2 + 1;
  }
  void begin(const std::string& name) {
    if (!lines_.next_filled()) lines_.refuse("the file ends before " + name);
  }
  double real(Scalar, const std::string& name) {
    find_value(name);
    return lines_.number("a value");
  }
  long long whole(Scalar, const std::string& name) {
    find_value(name);
    return lines_.integer("a value");
  }
  void skip(Scalar, const std::string& name) {
    find_value(name);
    lines_.skip_number("a value");
  }
  void finish() { lines_.end_of_line(); }
  void finish_file() {
    if (lines_.next_filled()) lines_.refuse("more lines than the header announces");
  }

 private:
  void find_value(const std::string& name) {
    if (lines_.rest().empty() && !lines_.next_filled()) {
      lines_.refuse("the file ends inside " + name);
    }
  }

  LineReader lines_;
};

class BinaryValues {
 public:
  BinaryValues(const std::string& path, std::string_view bytes, bool swap)
      : path_(path), bytes_(bytes), swap_(swap) {}

  [[nodiscard]] bool can_hold(const Element& element) const {
    std::size_t bytes = 0;
    for (const auto& p : element.properties) {
      bytes += bytes_of(p.is_list ? p.size_type : p.type);
    }
    return bytes == 0 || static_cast<std::size_t>(element.count) <= bytes_.size() / bytes;
  }
  [[nodiscard]] std::size_t values_left(Scalar type) const {
    return bytes_.size() / bytes_of(type);
  }
  void begin(const std::string&) {}
  double real(Scalar type, const std::string& name) {
    if (type == Scalar::F32) return static_cast<double>(take<float>(name));
    if (type == Scalar::F64) return take<double>(name);
    return static_cast<double>(whole(type, name));
  }
  void skip(Scalar type, const std::string& name) { (void)real(type, name); }
  long long whole(Scalar type, const std::string& name) {
    switch (type) {
      case Scalar::I8:
        return take<std::int8_t>(name);
      case Scalar::U8:
        return take<std::uint8_t>(name);
      case Scalar::I16:
        return take<std::int16_t>(name);
      case Scalar::U16:
        return take<std::uint16_t>(name);
      case Scalar::I32:
        return take<std::int32_t>(name);
      case Scalar::U32:
        return take<std::uint32_t>(name);
      default:
        refuse(path_, name + " has a corner that is not a whole number");
    }
  }
  void finish() {}
  void finish_file() {}

 private:
  template <class T>
  T take(const std::string& name) {
    if (bytes_.size() < sizeof(T)) refuse(path_, "the file ends inside " + name);
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data(), sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    bytes_.remove_prefix(sizeof(T));
    return std::bit_cast<T>(raw);
  }

  const std::string& path_;
  std::string_view bytes_;
  bool swap_;
};

bool is_list_of_vertices(const Property& property) {
  return property.is_list &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool is_corner_list(const Element& element, const Property& property) {
  return element.name == "face" && is_list_of_vertices(property);
}

bool is_strip(const Element& element, const Property& property) {
  return element.name == "tristrips" && is_list_of_vertices(property);
}

template <class Values>
class BodyReader {
 public:
  BodyReader(const std::string& path, const Header& header, Values values, Stage& stage)
      : path_(path), header_(header), values_(std::move(values)), stage_(stage) {}

  PolygonSoup read() {
    for (const Element& element : header_.elements) {
      if (!values_.can_hold(element)) {
        refuse(path_, "announces " + std::to_string(element.count) + " " +
                          quoted(element.name) + ", more than the file can hold");
      }
      if (element.properties.empty()) continue;
      for (long long i = 0; i < element.count; ++i) {
        stage_.at(static_cast<std::size_t>(i), static_cast<std::size_t>(element.count));
        read_element(element, i);
      }
    }
    values_.finish_file();
    for (std::size_t f = 0; f < soup_.polygons.size(); ++f) {
      for (const int v : soup_.polygons[f]) {
        if (v < 0 || static_cast<std::size_t>(v) >= soup_.vertices.size()) {
          refuse(path_, "face " + std::to_string(f) + " names vertex " +
                            std::to_string(v) + " of " +
                            std::to_string(soup_.vertices.size()));
        }
      }
    }
    return std::move(soup_);
  }

 private:
  void read_element(const Element& element, long long number) {
    name_ = element.name;
    name_.append(" ").append(std::to_string(number));
    const bool is_vertex = element.name == "vertex";
    Point p = Point::Zero();
    values_.begin(name_);
    for (const Property& property : element.properties) {
      if (is_corner_list(element, property)) {
        soup_.polygons.push_back(read_corners(property));
      } else if (is_strip(element, property)) {
        read_strip(property);
      } else if (property.is_list) {
        for (long long n = list_size(property); n > 0; --n) {
          values_.skip(property.type, name_);
        }
      } else if (is_vertex && property.name.size() == 1 && property.name[0] >= 'x' &&
                 property.name[0] <= 'z') {
        const double x = values_.real(property.type, name_);
        if (!std::isfinite(x)) {
          refuse(path_, name_ + " has a coordinate that is not finite");
        }
        p[property.name[0] - 'x'] = x;
      } else {
        values_.skip(property.type, name_);
      }
    }
    values_.finish();
    if (is_vertex) soup_.vertices.push_back(p);
  }

  long long list_size(const Property& property) {
    const long long size = values_.whole(property.size_type, name_);
    if (size < 0 || static_cast<std::size_t>(size) > values_.values_left(property.type)) {
      refuse(path_, name_ + " announces a list of " + std::to_string(size) +
                        " values, more than the file can hold");
    }
    return size;
  }

  int read_corner(const Property& property, long long least) {
    const long long index = values_.whole(property.type, name_);
    if (index < least || index > std::numeric_limits<int>::max()) {
      refuse(path_, name_ + " names vertex " + std::to_string(index));
    }
    return static_cast<int>(index);
  }

  std::vector<int> read_corners(const Property& property) {
    std::vector<int> polygon(static_cast<std::size_t>(list_size(property)));
    for (int& corner : polygon) corner = read_corner(property, 0);
    return polygon;
  }

  // Each corner makes a triangle with the two before it, every other one turned over, so
  // that all have the front of the first.  A -1 ends the strip; the next one begins.
  void read_strip(const Property& property) {
    constexpr int kNextStrip = -1;
    std::vector<int> strip;
    for (long long n = list_size(property); n > 0; --n) {
      const int corner = read_corner(property, kNextStrip);
      if (corner == kNextStrip) {
        strip.clear();
        continue;
      }
      strip.push_back(corner);
      append_strip_triangle(soup_.polygons, strip);
    }
  }

  const std::string& path_;
  const Header& header_;
  Values values_;
  Stage& stage_;
  PolygonSoup soup_;
  std::string name_;
};

void check_elements(const std::string& path, const Header& header) {
  bool has_corners = false;
  int coordinates = 0;
  for (const Element& element : header.elements) {
    for (const Property& property : element.properties) {
      has_corners =
          has_corners || is_corner_list(element, property) || is_strip(element, property);
      for (const char* const axis : {"x", "y", "z"}) {
        if (element.name == "vertex" && !property.is_list && property.name == axis) {
          ++coordinates;
        }
      }
    }
  }
  if (coordinates != 3) refuse(path, "the header gives vertices no x, y, z");
  if (!has_corners) refuse(path, "no faces");
}

}  // namespace

PolygonSoup read_ply(const std::string& path, std::string_view bytes, Stage& stage) {
  bytes = without_byte_order_mark(bytes);
  LineReader lines(path, bytes, stage);
  const Header header = read_header(path, lines);
  check_elements(path, header);
  if (header.encoding == Encoding::Ascii) {
    return BodyReader(path, header, AsciiValues(lines), stage).read();
  }
  const bool swap = (header.encoding == Encoding::BigEndian) !=
                    (std::endian::native == std::endian::big);
  const std::string_view body = bytes.substr(bytes.size() - lines.bytes_left());
  return BodyReader(path, header, BinaryValues(path, body, swap), stage).read();
}

}  // namespace sightline::internal
