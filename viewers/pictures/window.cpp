#include "viewers/window.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <cstdlib>
#include <string>

namespace sightline::viewers {
namespace {

void add_actor(vtkRenderer* renderer, vtkPolyData* data, const std::string& name) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkProperty* look = actor->GetProperty();
  if (name == "scene") {
    // Seen from inside a closed room, its near walls are in the way.
    look->BackfaceCullingOn();
    look->SetAmbient(0.35);
    look->SetDiffuse(0.7);
  } else if (name.starts_with("arcs") || name.starts_with("strips")) {
    look->SetOpacity(0.12);
    look->LightingOff();
  } else {
    look->SetLineWidth(name == "edges" ? 1.0F : 1.6F);
    look->LightingOff();
  }
  renderer->AddActor(actor);
}

}  // namespace

bool has_display() {
  const char* display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

void show_window(const std::filesystem::path& file, bool once) {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0.85, 0.87, 0.9);
  renderer->SetBackground2(0.97, 0.97, 0.98);
  renderer->GradientBackgroundOn();
  renderer->SetUseDepthPeeling(1);
  if (file.extension() == ".vtm") {
    vtkNew<vtkXMLMultiBlockDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
    for (unsigned i = 0; blocks != nullptr && i < blocks->GetNumberOfBlocks(); ++i) {
      auto* data = vtkPolyData::SafeDownCast(blocks->GetBlock(i));
      const char* name = blocks->GetMetaData(i)->Get(vtkCompositeDataSet::NAME());
      if (data != nullptr) add_actor(renderer, data, name == nullptr ? "" : name);
    }
  } else {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    add_actor(renderer, reader->GetOutput(), file.stem().string());
  }
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  window->SetSize(1280, 900);
  window->SetWindowName(("sightline: " + file.string()).c_str());
  window->AddRenderer(renderer);
  vtkNew<vtkRenderWindowInteractor> interactor;
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  interactor->SetInteractorStyle(style);
  interactor->SetRenderWindow(window);
  renderer->GetActiveCamera()->Azimuth(25);
  renderer->GetActiveCamera()->Elevation(25);
  renderer->ResetCamera();
  window->Render();
  if (!once) interactor->Start();
}

}  // namespace sightline::viewers
