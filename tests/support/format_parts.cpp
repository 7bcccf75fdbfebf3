#include "tests/support/format_parts.h"

#include <array>
#include <bit>
#include <cstdint>
#include <sstream>

namespace sightline::test {
namespace {

constexpr std::array<std::array<int, 4>, 6> kSquares{
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

std::string number(int n) { return std::to_string(n); }
int coordinate(int corner, int axis) { return corner >> axis & 1; }
std::string corner_text(int corner, const std::string& between) {
  return number(coordinate(corner, 0)) + between + number(coordinate(corner, 1)) +
         between + number(coordinate(corner, 2));
}

/// The last `bytes` bytes of a number, in this order of bytes.
std::string raw(std::uint32_t value, int bytes, bool big) {
  std::string text;
  for (int i = 0; i < bytes; ++i) {
    text += static_cast<char>(value >> 8 * (big ? bytes - 1 - i : i) & 255);
  }
  return text;
}
std::string raw_float(int value, bool big) {
  return raw(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4, big);
}

FilePart ac_parts() {
  FilePart cube{"OBJECT poly\n", {{"name \"cube\"\n"}}, "kids 0\n"};
  FilePart corners{"numvert 8\n"}, faces{"numsurf 6\n"};
  for (int v = 0; v < 8; ++v) corners.parts.push_back({corner_text(v, " ") + "\n"});
  for (const auto& square : kSquares) {
    FilePart face{"SURF 0x0\n", {{"mat 0\n"}, {"refs 4\n"}}};
    for (const int v : square) face.parts.back().parts.push_back({number(v) + " 0 0\n"});
    faces.parts.push_back(face);
  }
  cube.parts.push_back(corners);
  cube.parts.push_back(faces);
  return {"AC3Db\n",
          {{"MATERIAL \"m\" rgb 1 1 1  amb 0 0 0  emis 0 0 0  spec 0 0 0  shi 0  "
            "trans 0\n"},
           {"OBJECT world\nkids 1\n", {cube}}}};
}

FilePart dae_parts() {
  std::string floats, list, counts;
  for (int v = 0; v < 8; ++v) floats += corner_text(v, " ") + " ";
  for (const auto& square : kSquares) {
    counts += "4 ";
    for (const int v : square) list += number(v) + " ";
  }
  const FilePart source{
      "<source id=\"p\">",
      {{"<float_array id=\"a\" count=\"24\">" + floats + "</float_array>"},
       {"<technique_common>",
        {{"<accessor source=\"#a\" count=\"8\" stride=\"3\">",
          {{"<param name=\"X\" type=\"float\"/>"},
           {"<param name=\"Y\" type=\"float\"/>"},
           {"<param name=\"Z\" type=\"float\"/>"}},
          "</accessor>"}},
        "</technique_common>"}},
      "</source>"};
  const FilePart mesh{"<mesh>",
                      {source,
                       {"<vertices id=\"v\">",
                        {{"<input semantic=\"POSITION\" source=\"#p\"/>"}},
                        "</vertices>"},
                       {"<polylist count=\"6\">",
                        {{"<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"},
                         {"<vcount>" + counts + "</vcount>"},
                         {"<p>" + list + "</p>"}},
                        "</polylist>"}},
                      "</mesh>"};
  return {
      "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\">",
      {{"<asset>", {{"<unit meter=\"1\"/>"}, {"<up_axis>Y_UP</up_axis>"}}, "</asset>"},
       {"<library_geometries>",
        {{"<geometry id=\"g\" name=\"g\">", {mesh}, "</geometry>"}},
        "</library_geometries>"},
       {"<library_visual_scenes>",
        {{"<visual_scene id=\"s\">",
          {{"<node id=\"n\" name=\"cube\">",
            {{"<instance_geometry url=\"#g\"/>"}},
            "</node>"}},
          "</visual_scene>"}},
        "</library_visual_scenes>"},
       {"<scene>", {{"<instance_visual_scene url=\"#s\"/>"}}, "</scene>"}},
      "</COLLADA>"};
}

FilePart dxf_parts() {
  FilePart entities{"0\nSECTION\n2\nENTITIES\n", {}, "0\nENDSEC\n"};
  for (const auto& square : kSquares) {
    FilePart face{"0\n3DFACE\n8\ncube\n"};
    for (int k = 0; k < 4; ++k) {
      std::string corner;
      for (int axis = 0; axis < 3; ++axis) {
        corner += number(10 * (axis + 1) + k) + "\n" +
                  number(coordinate(square[static_cast<std::size_t>(k)], axis)) + ".0\n";
      }
      face.parts.push_back({corner});
    }
    entities.parts.push_back(face);
  }
  return {"", {{"0\nSECTION\n2\nHEADER\n", {}, "0\nENDSEC\n"}, entities}, "0\nEOF\n"};
}

FilePart fbx_parts() {
  std::string floats, list;
  for (int v = 0; v < 8; ++v) floats += (v > 0 ? "," : "") + corner_text(v, ",");
  for (const auto& square : kSquares) {
    for (int k = 0; k < 4; ++k) {
      const int v = square[static_cast<std::size_t>(k)];
      list += (list.empty() ? "" : ",") + number(k == 3 ? -v - 1 : v);
    }
  }
  const FilePart geometry{"Geometry: 1000, \"Geometry::cube\", \"Mesh\" {\n",
                          {{"Vertices: *24 {\na: " + floats + "\n}\n"},
                           {"PolygonVertexIndex: *24 {\na: " + list + "\n}\n"},
                           {"GeometryVersion: 124\n"}},
                          "}\n"};
  return {"; FBX 7.3.0 project file\n",
          {{"FBXHeaderExtension:  {\n",
            {{"FBXHeaderVersion: 1003\n"}, {"FBXVersion: 7300\n"}},
            "}\n"},
           {"GlobalSettings:  {\nVersion: 1000\n",
            {{"Properties70:  {\nP: \"UpAxis\", \"int\", \"Integer\", \"\",1\n}\n"}},
            "}\n"},
           {"Definitions:  {\nVersion: 100\nCount: 2\n", {}, "}\n"},
           {"Objects:  {\n",
            {geometry, {"Model: 2000, \"Model::cube\", \"Mesh\" {\nVersion: 232\n}\n"}},
            "}\n"},
           {"Connections:  {\n",
            {{"C: \"OO\",2000,0\n"}, {"C: \"OO\",1000,2000\n"}},
            "}\n"}}};
}

FilePart x_parts() {
  FilePart corners{"8;\n"}, faces{"6;\n"};
  for (int v = 0; v < 8; ++v) {
    corners.parts.push_back({corner_text(v, ";") + (v < 7 ? ";,\n" : ";;\n")});
  }
  for (std::size_t f = 0; f < 6; ++f) {
    std::string face = "4;";
    for (std::size_t k = 0; k < 4; ++k) {
      face += number(kSquares[f][k]) + (k < 3 ? "," : ";");
    }
    faces.parts.push_back({face + (f < 5 ? ",\n" : ";\n")});
  }
  return {"xof 0303txt 0032\n",
          {{"Frame root {\n", {{"Mesh cube {\n", {corners, faces}, "}\n"}}, "}\n"}}};
}

FilePart lwo_parts() {
  std::string points, polygons = "FACE";
  for (int v = 0; v < 8; ++v) {
    for (int axis = 0; axis < 3; ++axis) points += raw_float(coordinate(v, axis), true);
  }
  for (const auto& square : kSquares) {
    polygons += raw(4, 2, true);
    for (const int v : square) polygons += raw(static_cast<std::uint32_t>(v), 2, true);
  }
  std::string tags = "PTAGSURF";
  for (std::uint32_t f = 0; f < 6; ++f) tags += raw(f, 2, true) + raw(0, 2, true);
  return {"FORMLWO2",
          {{std::string("TAGSm\0", 6)},
           {"LAYR" + raw(0, 4, true) + std::string(12, '\0') + std::string("l\0", 2)},
           {"PNTS" + points},
           {"POLS" + polygons},
           {tags},
           {"SURF" + std::string("m\0\0\0", 4)}}};
}

FilePart tds_parts() {
  std::string points = raw(8, 2, false), faces = raw(12, 2, false);
  for (int v = 0; v < 8; ++v) {
    for (int axis = 0; axis < 3; ++axis) points += raw_float(coordinate(v, axis), false);
  }
  for (const auto& s : kSquares) {
    for (const auto& t : {std::array{s[0], s[1], s[2]}, std::array{s[0], s[2], s[3]}}) {
      for (const int v : t) faces += raw(static_cast<std::uint32_t>(v), 2, false);
      faces += raw(0, 2, false);
    }
  }
  const auto id = [](std::uint32_t n) { return raw(n, 2, false); };
  const FilePart mesh{id(0x4100), {{id(0x4110) + points}, {id(0x4120) + faces}}};
  return {id(0x4D4D),
          {{id(0x0002) + raw(3, 4, false)},
           {id(0x3D3D), {{id(0x4000) + std::string("cube\0", 5), {mesh}}}}}};
}

FilePart ifc_parts(const std::string& ifc) {
  FilePart file;
  std::istringstream lines(ifc);
  for (std::string line; std::getline(lines, line);) file.parts.push_back({line + "\n"});
  return file;
}

std::string written(const FilePart& part, PartStyle style) {
  std::string inner;
  for (const FilePart& p : part.parts) inner += written(p, style);
  if (style == PartStyle::Text) return part.head + inner + part.tail;
  const bool iff = style == PartStyle::ChunksIff;
  const std::size_t name = iff ? 4 : 2;
  const std::string body = part.head.substr(name) + inner;
  const auto size = static_cast<std::uint32_t>(body.size() + (iff ? 0 : 6));
  return part.head.substr(0, name) + raw(size, 4, iff) + body +
         (iff && body.size() % 2 == 1 ? std::string(1, '\0') : "");
}

int count_of(const FilePart& part) {
  int n = 0;
  for (const FilePart& p : part.parts) n += 1 + count_of(p);
  return n;
}

/// Whether it was found; otherwise `left` is less by the parts below.
bool remove_from(FilePart& part, int& left) {
  for (std::size_t i = 0; i < part.parts.size(); ++i) {
    if (left-- == 0) {
      part.parts.erase(part.parts.begin() + static_cast<std::ptrdiff_t>(i));
      return true;
    }
    if (remove_from(part.parts[i], left)) return true;
  }
  return false;
}

}  // namespace

std::string PartedFile::bytes() const { return written(root, style); }
int PartedFile::count() const { return count_of(root); }
void PartedFile::remove(int part) { (void)remove_from(root, part); }

std::vector<PartedFile> parted_files(const std::string& ifc) {
  return {{"ac", PartStyle::Text, ac_parts()},
          {"dae", PartStyle::Text, dae_parts()},
          {"dxf", PartStyle::Text, dxf_parts()},
          {"fbx", PartStyle::Text, fbx_parts()},
          {"ifc", PartStyle::Text, ifc_parts(ifc)},
          {"lwo", PartStyle::ChunksIff, lwo_parts()},
          {"x", PartStyle::Text, x_parts()},
          {"3ds", PartStyle::Chunks3ds, tds_parts()}};
}

}  // namespace sightline::test
