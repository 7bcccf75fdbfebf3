#include "viewers/vtk_export.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLReader.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "linespace/work/stage.h"
#include "viewers/files/shadow_vtk.h"
#include "viewers/files/vtk_cells.h"
#include "viewers/json_text.h"
#include "viewers/kinds.h"
#include "viewers/output_file.h"
#include "viewers/palette.h"

namespace sightline::viewers {
namespace {

using internal::Stage;

vtkSmartPointer<vtkPolyData> scene_cells(const Scene& scene, Stage& stage) {
  Cells cells;
  const PolygonSoup& soup = scene.soup();
  const std::vector<Colour> colours = object_colours(scene);
  for (const Point& p : soup.vertices) cells.add_point(p);
  std::vector<int> face_of(soup.polygons.size(), -1);
  for (int f = static_cast<int>(scene.faces().size()) - 1; f >= 0; --f) {
    face_of[scene.faces()[f].source] = f;
  }
  for (std::size_t i = 0; i < soup.polygons.size(); ++i) {
    stage.at(i, soup.polygons.size());
    const int f = face_of[i];
    const int object = f < 0 ? -1 : scene.faces()[f].object;
    cells.add_polygon({soup.polygons[i].begin(), soup.polygons[i].end()},
                      colours[std::max(object, 0)]);
    cells.value("polygon", {static_cast<int>(i)});
    cells.value("face", {f});
    cells.value("facet", {f < 0 ? -1 : scene.faces()[f].facet});
    cells.value("object", {object});
  }
  vtkSmartPointer<vtkPolyData> data = cells.poly_data();
  vtkNew<vtkStringArray> names;
  names->SetName("object_names");
  for (const Object& object : scene.objects())
    names->InsertNextValue(escaped_bytes(object.name));
  data->GetFieldData()->AddArray(names);
  return data;
}

vtkSmartPointer<vtkPolyData> edge_cells(const Scene& scene, Stage& stage) {
  static constexpr Colour kInks[] = {{0.17F, 0.18F, 0.22F},
                                     {0.55F, 0.57F, 0.62F},
                                     {0.8F, 0.8F, 0.8F},
                                     {0.16F, 0.47F, 0.55F},
                                     {0.84F, 0.15F, 0.24F}};
  Cells cells;
  for (std::size_t i = 0; i < scene.edges().size(); ++i) {
    stage.at(i, scene.edges().size());
    const Edge& edge = scene.edges()[i];
    const int kind = static_cast<int>(edge.kind);
    cells.add_line(scene.point(edge.points[0]), scene.point(edge.points[1]), kInks[kind]);
    cells.value("edge", {static_cast<int>(i)});
    cells.value("edge_kind", {kind});
    cells.value("object", {edge.object});
  }
  return cells.poly_data();
}

/// Blocks by name; a block may stay empty and is then left out.
using Blocks = std::map<std::string, Cells>;

/// Polygon mode: 1 where the first, the last contact is an end contact.
void add_contacts(Cells& cells, const Skeleton& skeleton,
                  const std::array<bool, 2>& ends) {
  if (skeleton.events != EventMode::Polygon) return;
  cells.value("first_ends", {ends[0] ? 1 : 0});
  cells.value("last_ends", {ends[1] ? 1 : 0});
}

void add_arc_blocks(Blocks& blocks, const Scene& scene, const Skeleton& skeleton,
                    Stage& stage) {
  const std::size_t count = skeleton.ev_count();
  for (std::size_t i = 0; i < count; ++i) {
    stage.at(i, count);
    const SkeletonArc& arc = skeleton.arcs[i];
    const Edge& edge = scene.edges()[arc.edge()];
    const std::string kind = kind_name(arc);
    Cells& cells = blocks["arcs_" + kind];
    cells.add_polygon(
        {scene.point(arc.vertex()), point_on_edge(scene, edge, arc.range[0]),
         point_on_edge(scene, edge, arc.range[1])},
        colour_of_kind(kind));
    cells.value("arc", {static_cast<int>(i)});
    cells.value("vertex", {arc.vertex()});
    cells.value("edge", {arc.edge()});
    cells.value("objects",
                {scene.edges()[scene.edges_at(arc.vertex())[0]].object, edge.object});
    cells.value("range", {arc.range[0], arc.range[1]});
    cells.value("nodes",
                {static_cast<int>(arc.nodes[0]), static_cast<int>(arc.nodes[1])});
    add_contacts(cells, skeleton, arc.ends);
    cells.value("kind", kind);
  }
}

void add_eee_blocks(Blocks& blocks, const Scene& scene, const Skeleton& skeleton,
                    Stage& stage) {
  // Counted first: an array that grows takes up to three times its room.
  std::map<std::string, std::pair<vtkIdType, vtkIdType>> sizes;
  const std::size_t first = skeleton.ev_count();
  const std::size_t count = skeleton.arcs.size() - first;
  for (const SkeletonArc& arc : skeleton.eee()) {
    stage.at(0, count);
    auto& [strips, points] = sizes["arcs_" + kind_name(arc)];
    ++strips;
    points += 2 * static_cast<vtkIdType>(rungs_of(scene, arc).size());
  }
  for (const auto& [name, size] : sizes) blocks[name].reserve(size.first, size.second);
  for (std::size_t i = 0; i < count; ++i) {
    stage.at(i, count);
    const SkeletonArc& arc = skeleton.arcs[first + i];
    const std::string kind = kind_name(arc);
    Cells& cells = blocks["arcs_" + kind];
    cells.add_strip(rungs_of(scene, arc), colour_of_kind(kind));
    cells.value("arc", {static_cast<int>(first + i)});
    const auto& [a, b, c] = arc.edges();
    cells.value("edges", {a, b, c});
    cells.value("objects", {scene.edges()[a].object, scene.edges()[b].object,
                            scene.edges()[c].object});
    cells.value("range", {arc.range[0], arc.range[1]});
    cells.value("nodes",
                {static_cast<int>(arc.nodes[0]), static_cast<int>(arc.nodes[1])});
    add_contacts(cells, skeleton, arc.ends);
    cells.value("kind", kind);
  }
}

void add_strip_blocks(Blocks& blocks, const Scene& scene, const Skeleton& skeleton,
                      const std::vector<RuledStrip>& strips) {
  for (const RuledStrip& strip : strips) {
    const SkeletonArc& arc = skeleton.arcs[strip.arc];
    const Point& v = scene.point(arc.vertex());
    Cells& cells = blocks["strips_" + kind_name(arc)];
    for (std::size_t i = 1; i < strip.rungs.size(); ++i) {
      const FarEnds& a = strip.rungs[i - 1];
      const FarEnds& b = strip.rungs[i];
      for (const int side : {0, 1}) {
        if (a.faces[side] != b.faces[side]) continue;
        cells.add_polygon({v, a.points[side], b.points[side]},
                          colour_of_kind(kind_name(arc)));
        cells.value("arc", {strip.arc});
        cells.value("side", {side});
        cells.value("far_polygon", {a.faces[side].empty() ? -1 : a.faces[side][0]});
      }
    }
  }
}

std::string generator_text(const Skeleton& skeleton, const SkeletonNode& node) {
  std::string text;
  for (const Generator& g : skeleton.generators(node)) {
    const char letter = "VEF"[static_cast<int>(g.kind)];
    text += fmt::format("{}{}{}", text.empty() ? "" : " ", letter, g.id);
  }
  return text;
}

void add_node_blocks(Blocks& blocks, const Skeleton& skeleton, Stage& stage) {
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    stage.at(i, skeleton.nodes.size());
    const SkeletonNode& node = skeleton.nodes[i];
    const std::string kind = kind_name(node);
    Cells& cells = blocks["nodes_" + kind];
    cells.add_line(node.segment[0], node.segment[1], colour_of_kind(kind));
    cells.value("node", {static_cast<int>(i)});
    cells.value("generators", generator_text(skeleton, node));
    cells.value("self", {node.self ? 1 : 0});
    cells.value("end", {node.end ? 1 : 0});
    add_contacts(cells, skeleton, node.ends);
    if (node.kind == NodeKind::EEEE) cells.value("second", {node.second ? 1 : 0});
    cells.value("kind", kind);
  }
}

/// How far the strips may be from the surfaces they stand for.
void add_deviation(vtkPolyData* data, const Scene& scene) {
  vtkNew<vtkDoubleArray> deviation;
  deviation->SetName("deviation");
  deviation->InsertNextValue(kEeeDeviation *
                             (scene.bounds()[1] - scene.bounds()[0]).norm());
  data->GetFieldData()->AddArray(deviation);
}

Colour cell_colour(vtkPolyData* data, vtkIdType cell) {
  auto* colours =
      vtkUnsignedCharArray::SafeDownCast(data->GetCellData()->GetArray("colour"));
  if (colours == nullptr || colours->GetNumberOfComponents() != 3)
    return {0.4F, 0.4F, 0.5F};
  const unsigned char* c = colours->GetPointer(3 * cell);
  return {static_cast<float>(c[0]) / 255, static_cast<float>(c[1]) / 255,
          static_cast<float>(c[2]) / 255};
}

Point point_of(vtkPolyData* data, vtkIdType id) {
  Point p;
  data->GetPoint(id, p.data());
  return p;
}

void read_scene(VtkPicture& picture, vtkPolyData* data) {
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    picture.soup.vertices.push_back(point_of(data, i));
  }
  auto* objects = vtkIntArray::SafeDownCast(data->GetCellData()->GetArray("object"));
  auto* names = vtkStringArray::SafeDownCast(
      data->GetFieldData()->GetAbstractArray("object_names"));
  if (objects != nullptr && names != nullptr) {
    for (vtkIdType i = 0; i < names->GetNumberOfValues(); ++i) {
      picture.soup.groups.push_back({names->GetValue(i), {}});
    }
  }
  const auto cells = vtk::TakeSmartPointer(data->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    picture.soup.polygons.emplace_back(ids, ids + count);
    if (picture.soup.groups.empty()) continue;
    const int object = objects->GetValue(cells->GetCurrentCellId());
    if (object >= 0 && object < static_cast<int>(picture.soup.groups.size())) {
      picture.soup.groups[object].faces.push_back(
          static_cast<int>(picture.soup.polygons.size()) - 1);
    }
  }
  std::erase_if(picture.soup.groups, [](const auto& g) { return g.faces.empty(); });
}

void read_marks(VtkPicture& picture, vtkPolyData* data) {
  // VTK numbers the cells of lines before those of polygons, and these before strips.
  const vtkIdType lines = data->GetNumberOfLines();
  const auto line = vtk::TakeSmartPointer(data->GetLines()->NewIterator());
  for (line->GoToFirstCell(); !line->IsDoneWithTraversal(); line->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    line->GetCurrentCell(count, ids);
    for (vtkIdType i = 1; i < count; ++i) {
      picture.strokes.push_back({{point_of(data, ids[i - 1]), point_of(data, ids[i])},
                                 cell_colour(data, line->GetCurrentCellId()),
                                 1.4F,
                                 0.6F,
                                 0.08F});
    }
  }
  const auto add_veil = [&](vtkIdType a, vtkIdType b, vtkIdType c, vtkIdType of) {
    picture.veils.push_back({{point_of(data, a), point_of(data, b), point_of(data, c)},
                             cell_colour(data, of),
                             0.1F});
  };
  const auto cell = vtk::TakeSmartPointer(data->GetPolys()->NewIterator());
  for (cell->GoToFirstCell(); !cell->IsDoneWithTraversal(); cell->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cell->GetCurrentCell(count, ids);
    for (vtkIdType i = 2; i < count; ++i) {
      add_veil(ids[0], ids[i - 1], ids[i], lines + cell->GetCurrentCellId());
    }
  }
  const vtkIdType polygons = data->GetNumberOfPolys();
  const auto strip = vtk::TakeSmartPointer(data->GetStrips()->NewIterator());
  for (strip->GoToFirstCell(); !strip->IsDoneWithTraversal(); strip->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    strip->GetCurrentCell(count, ids);
    for (vtkIdType i = 2; i < count; ++i) {
      add_veil(ids[i - 2], ids[i - 1], ids[i],
               lines + polygons + strip->GetCurrentCellId());
    }
  }
}

/// Refuses a file that VTK could not read to its end.
void require_read(vtkXMLReader& reader, const std::filesystem::path& file) {
  if (reader.GetErrorCode() == vtkErrorCode::NoError) return;
  throw InvalidInput(
      fmt::format("{}: VTK cannot read it: {}", file.string(),
                  vtkErrorCode::GetStringFromErrorCode(reader.GetErrorCode())));
}

vtkSmartPointer<vtkPolyData> read_poly_data(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw InvalidInput(file.string() + ": no such file");
  }
  const QuietVtk quiet;
  vtkNew<vtkXMLPolyDataReader> reader;
  if (reader->CanReadFile(file.c_str()) == 0) {
    throw InvalidInput(file.string() + ": not a VTK PolyData file");
  }
  reader->SetFileName(file.c_str());
  reader->Update();
  require_read(*reader, file);
  return reader->GetOutput();
}

void require_content(const VtkPicture& picture) {
  if (picture.soup.polygons.empty() && picture.veils.empty() && picture.strokes.empty()) {
    throw InvalidInput(picture.soup.source + ": has nothing to show");
  }
}

}  // namespace

bool is_vtk_name(const std::string& name) {
  return name == kVtkIndex || name.ends_with(".vtp");
}

std::vector<std::string> write_vtk(const std::filesystem::path& folder,
                                   const Scene& scene, const VtkContents& contents,
                                   const Request& request) {
  Stage stage(request, "VTK files");
  begin_vtk_folder(folder);
  std::vector<std::string> names{"scene", "edges"};
  write_poly_data(folder / "scene.vtp", scene_cells(scene, stage), stage);
  write_poly_data(folder / "edges.vtp", edge_cells(scene, stage), stage);
  // One group of blocks at a time is held in memory.
  const auto write = [&](const auto& fill) {
    Blocks blocks;
    fill(blocks);
    for (const auto& [name, cells] : blocks) {
      if (cells.empty()) continue;
      const vtkSmartPointer<vtkPolyData> data = cells.poly_data();
      if (name.starts_with("arcs_EEE")) add_deviation(data, scene);
      write_poly_data(folder / (name + ".vtp"), data, stage);
      names.push_back(name);
    }
  };
  if (contents.skeleton != nullptr) {
    const Skeleton& skeleton = *contents.skeleton;
    write([&](Blocks& blocks) { add_arc_blocks(blocks, scene, skeleton, stage); });
    write([&](Blocks& blocks) { add_eee_blocks(blocks, scene, skeleton, stage); });
    write([&](Blocks& blocks) { add_node_blocks(blocks, skeleton, stage); });
    if (contents.strips != nullptr) {
      write([&](Blocks& blocks) {
        add_strip_blocks(blocks, scene, skeleton, *contents.strips);
      });
    }
  }
  if (contents.shadows != nullptr) {
    write([&](Blocks& blocks) { add_shadow_blocks(blocks, *contents.shadows, stage); });
  }
  if (contents.volumes != nullptr)
    write([&](Blocks& blocks) { add_volume_blocks(blocks, *contents.volumes); });
  write_whole(folder / kVtkIndex, multi_block_text(names));
  std::vector<std::string> files;
  for (const std::string& name : names) files.push_back(name + ".vtp");
  files.emplace_back(kVtkIndex);
  return files;
}

std::vector<std::string> write_vtk_lines(const std::filesystem::path& folder,
                                         const std::vector<LineBlock>& blocks,
                                         const Request& request) {
  Stage stage(request, "VTK files");
  begin_vtk_folder(folder);
  std::vector<std::string> names;
  std::vector<std::string> files;
  for (const LineBlock& block : blocks) {
    Cells cells;
    int id = 0;
    for (const LineBlock::Piece& piece : block.pieces) {
      cells.add_line(piece.from, piece.to, colour_of_kind(block.kind));
      cells.value("id", {id++});
      cells.value("note", piece.note);
      cells.value("kind", block.kind);
    }
    for (const LineBlock::Polygon& polygon : block.polygons) {
      std::vector<vtkIdType> ids;
      for (const Point& p : polygon.corners) ids.push_back(cells.add_point(p));
      cells.add_polygon(ids, colour_of_kind(block.kind));
      cells.value("id", {id++});
      cells.value("note", polygon.note);
      cells.value("kind", block.kind);
    }
    if (cells.empty()) continue;
    write_poly_data(folder / (block.name + ".vtp"), cells.poly_data(), stage);
    names.push_back(block.name);
    files.push_back(block.name + ".vtp");
  }
  write_whole(folder / kVtkIndex, multi_block_text(names));
  files.emplace_back(kVtkIndex);
  return files;
}

VtkPicture read_vtk(const std::filesystem::path& file) {
  VtkPicture picture;
  picture.soup.source = file.string();
  if (file.extension() == ".vtp") {
    const std::filesystem::path scene = file.parent_path() / "scene.vtp";
    if (std::filesystem::exists(scene)) read_scene(picture, read_poly_data(scene));
    if (file.filename() != "scene.vtp") read_marks(picture, read_poly_data(file));
    require_content(picture);
    return picture;
  }
  if (!std::filesystem::is_regular_file(file)) {
    throw InvalidInput(file.string() + ": no such file");
  }
  const QuietVtk quiet;
  vtkNew<vtkXMLMultiBlockDataReader> reader;
  if (reader->CanReadFile(file.c_str()) == 0) {
    throw InvalidInput(file.string() + ": not a VTK multi-block file");
  }
  reader->SetFileName(file.c_str());
  reader->Update();
  require_read(*reader, file);
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  for (unsigned i = 0; blocks != nullptr && i < blocks->GetNumberOfBlocks(); ++i) {
    auto* data = vtkPolyData::SafeDownCast(blocks->GetBlock(i));
    if (data == nullptr) continue;
    const char* key = blocks->GetMetaData(i)->Get(vtkCompositeDataSet::NAME());
    const std::string name = key == nullptr ? "" : key;
    if (name == "scene") {
      read_scene(picture, data);
    } else if (name != "edges") {
      read_marks(picture, data);
    }
  }
  require_content(picture);
  return picture;
}

}  // namespace sightline::viewers
