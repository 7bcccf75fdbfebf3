#include "viewers/files/vtk_cells.h"

#include <fmt/format.h>
#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkErrorCode.h>
#include <vtkXMLPolyDataWriter.h>

#include <exception>

namespace sightline::viewers {
namespace {

/// Lets VTK's writer ask whether to go on: exceptions may not pass through it.
struct StopQuestion {
  internal::Stage* stage;
  std::exception_ptr stopped;
};

void abort_when_stopped(vtkObject* writer, unsigned long, void* data, void*) {
  auto& question = *static_cast<StopQuestion*>(data);
  auto* algorithm = vtkAlgorithm::SafeDownCast(writer);
  try {
    question.stage->check(algorithm->GetProgress());
  } catch (const Stopped&) {
    question.stopped = std::current_exception();
    algorithm->AbortExecuteOn();
  }
}

}  // namespace

std::unique_ptr<OutputFile> poly_data_file(const std::filesystem::path& path,
                                           vtkPolyData* data, internal::Stage& stage) {
  auto file = std::make_unique<OutputFile>(path);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(file->temporary_path().c_str());
  writer->SetInputData(data);
  writer->SetEncodeAppendedData(0);
  const vtkNew<vtkCallbackCommand> ask;
  StopQuestion question{&stage, {}};
  ask->SetClientData(&question);
  ask->SetCallback(abort_when_stopped);
  writer->AddObserver(vtkCommand::ProgressEvent, ask);
  const QuietVtk quiet;
  const int written = writer->Write();  // not 0 on a full disk
  if (question.stopped) std::rethrow_exception(question.stopped);
  if (written == 0 || writer->GetErrorCode() != vtkErrorCode::NoError) {
    throw WriteError(
        fmt::format("{}: could not be written to its end: {}", path.string(),
                    vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode())));
  }
  file->close();
  return file;
}

void write_poly_data(const std::filesystem::path& path, vtkPolyData* data,
                     internal::Stage& stage) {
  poly_data_file(path, data, stage)->commit();
}

void begin_vtk_folder(const std::filesystem::path& folder) {
  make_folder(folder);
  std::error_code error;
  const bool ours = is_regular_file(symlink_status(folder / kVtkIndex, error));
  if (ours && !std::filesystem::remove(folder / kVtkIndex, error) && error)
    throw WriteError((folder / kVtkIndex).string() + ": " + error.message());
}

// Written by hand because VTK's own writer would put the pieces into a folder under
// numbers instead of names.
std::string multi_block_text(const std::vector<std::string>& blocks) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
      "  <vtkMultiBlockDataSet>\n";
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    text += fmt::format("    <DataSet index=\"{}\" name=\"{}\" file=\"{}.vtp\"/>\n", i,
                        blocks[i], blocks[i]);
  }
  return text + "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
}

}  // namespace sightline::viewers
