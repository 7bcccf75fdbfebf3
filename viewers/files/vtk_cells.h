// VTK files in the making: cells with arrays, written whole, and the index over them.

#pragma once

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "linespace/work/stage.h"
#include "viewers/output_file.h"
#include "viewers/picture.h"

namespace sightline::viewers {

/// Vertices, polygons, lines or strips with arrays of one tuple a cell, in the making.
class Cells {
 public:
  Cells() {
    points_->SetDataTypeToDouble();
    colours_->SetName("colour");
    colours_->SetNumberOfComponents(3);
  }

  vtkIdType add_point(const Point& p) {
    return points_->InsertNextPoint(p.x(), p.y(), p.z());
  }
  void add_polygon(std::initializer_list<Point> corners, const Colour& colour) {
    std::vector<vtkIdType> ids;
    for (const Point& p : corners) ids.push_back(add_point(p));
    add_polygon(ids, colour);
  }
  void add_polygon(const std::vector<vtkIdType>& ids, const Colour& colour) {
    polygons_->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
    add_colour(colour);
  }
  /// Room for so many strips with so many points in all.
  void reserve(vtkIdType strips, vtkIdType points) {
    points_->Allocate(points);
    strips_->AllocateExact(strips, points);
  }
  /// The triangles between neighbouring segments, as one cell.
  void add_strip(const std::vector<std::array<Point, 2>>& rungs, const Colour& colour) {
    strips_->InsertNextCell(static_cast<int>(2 * rungs.size()));
    for (const auto& [p, q] : rungs) {
      strips_->InsertCellPoint(add_point(p));
      strips_->InsertCellPoint(add_point(q));
    }
    add_colour(colour);
  }
  void add_vertex(const Point& p, const Colour& colour) {
    const vtkIdType id = add_point(p);
    vertices_->InsertNextCell(1, &id);
    add_colour(colour);
  }
  void add_line(const Point& a, const Point& b, const Colour& colour) {
    const vtkIdType ids[2] = {add_point(a), add_point(b)};
    lines_->InsertNextCell(2, ids);
    add_colour(colour);
  }

  /// Appends one tuple to the named cell array.
  void value(const char* name, std::initializer_list<int> tuple) {
    vtkSmartPointer<vtkIntArray>& array = integers_[name];
    if (!array) array = named<vtkIntArray>(name, static_cast<int>(tuple.size()));
    for (const int v : tuple) array->InsertNextValue(v);
  }
  void value(const char* name, std::initializer_list<double> tuple) {
    vtkSmartPointer<vtkDoubleArray>& array = reals_[name];
    if (!array) array = named<vtkDoubleArray>(name, static_cast<int>(tuple.size()));
    for (const double v : tuple) array->InsertNextValue(v);
  }
  void value(const char* name, const std::string& text) {
    vtkSmartPointer<vtkStringArray>& array = texts_[name];
    if (!array) array = named<vtkStringArray>(name, 1);
    array->InsertNextValue(text);
  }

  [[nodiscard]] bool empty() const { return colours_->GetNumberOfTuples() == 0; }

  [[nodiscard]] vtkSmartPointer<vtkPolyData> poly_data() const {
    vtkNew<vtkPolyData> data;
    data->SetPoints(points_);
    data->SetVerts(vertices_);
    data->SetPolys(polygons_);
    data->SetLines(lines_);
    data->SetStrips(strips_);
    for (const auto& [name, array] : integers_) data->GetCellData()->AddArray(array);
    for (const auto& [name, array] : reals_) data->GetCellData()->AddArray(array);
    for (const auto& [name, array] : texts_) data->GetCellData()->AddArray(array);
    data->GetCellData()->SetScalars(colours_);
    return data;
  }

 private:
  template <typename Array>
  static vtkSmartPointer<Array> named(const char* name, int components) {
    vtkNew<Array> array;
    array->SetName(name);
    array->SetNumberOfComponents(components);
    return array;
  }
  void add_colour(const Colour& colour) {
    for (const float c : {colour.red, colour.green, colour.blue}) {
      colours_->InsertNextValue(static_cast<unsigned char>(std::lround(255 * c)));
    }
  }

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> vertices_, polygons_, lines_, strips_;
  vtkNew<vtkUnsignedCharArray> colours_;
  std::map<std::string, vtkSmartPointer<vtkIntArray>> integers_;
  std::map<std::string, vtkSmartPointer<vtkDoubleArray>> reals_;
  std::map<std::string, vtkSmartPointer<vtkStringArray>> texts_;
};

/// While it lives, VTK logs nothing: errors are asked of its readers and writers.
class QuietVtk {
 public:
  QuietVtk() : before_(vtkObject::GetGlobalWarningDisplay()) {
    vtkObject::SetGlobalWarningDisplay(0);
  }
  ~QuietVtk() { vtkObject::SetGlobalWarningDisplay(before_); }
  QuietVtk(const QuietVtk&) = delete;
  QuietVtk& operator=(const QuietVtk&) = delete;

 private:
  int before_;
};

/// The whole of a file that waits for commit() to give it its name.  Throws WriteError
/// where it cannot be written to its end, and Stopped.
[[nodiscard]] std::unique_ptr<OutputFile> poly_data_file(
    const std::filesystem::path& path, vtkPolyData* data, internal::Stage& stage);
/// The same with its name.
void write_poly_data(const std::filesystem::path& path, vtkPolyData* data,
                     internal::Stage& stage);

/// The name of the index over the files of a folder.
inline constexpr const char* kVtkIndex = "sightline.vtm";

/// Makes the folder.  An earlier index goes first, so that none lists files of two runs.
void begin_vtk_folder(const std::filesystem::path& folder);

/// The text of an index of blocks, each in the file of its name and `.vtp`.
[[nodiscard]] std::string multi_block_text(const std::vector<std::string>& blocks);

}  // namespace sightline::viewers
