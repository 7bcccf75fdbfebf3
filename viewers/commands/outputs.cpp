#include "viewers/commands/outputs.h"

#include <fmt/format.h>

#include <filesystem>

#include "linespace/mesh_io.h"
#include "viewers/json_text.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {

namespace fs = std::filesystem;

namespace {

/// The file that would be changed by writing this name, if a command reads it for its
/// input: the input itself, or one of files_beside() it.
std::optional<std::string> file_read(const fs::path& written, const std::string& input) {
  std::error_code error;
  if (!fs::is_regular_file(written, error)) return std::nullopt;
  if (is_same_file(written, input)) return written.string();
  // The input is looked into only where there is something to replace.
  for (const std::string& file : files_beside(input)) {
    if (is_same_file(written, file)) return written.string();
  }
  return std::nullopt;
}

}  // namespace

Outputs::Outputs(const CommonOptions& options) {
  protect(options.scene);
  if (!options.json.empty()) json_ = &add("--json", options.json);
  if (!options.vtk.empty()) {
    vtk_.emplace(options.vtk);
    add_folder("--vtk", options.vtk, is_vtk_name);
  }
}

void Outputs::refuse_if_read(const Named& output, const std::string& input) {
  if (const auto file = file_read(output.file->target(), input)) {
    throw OutputError(
        fmt::format("{}: {} is read; name another file", output.option, *file));
  }
}

void Outputs::refuse_if_read(const Folder& folder, const std::string& input) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.path, error)) {
    if (!folder.takes(entry.path().filename().string())) continue;
    if (const auto file = file_read(entry.path(), input)) {
      throw OutputError(
          fmt::format("{}: {} is read; name another folder", folder.option, *file));
    }
  }
}

OutputFile& Outputs::add(const std::string& option, const std::string& file) {
  Named output{option, std::make_unique<OutputFile>(file)};
  for (const std::string& input : inputs_) refuse_if_read(output, input);
  for (const Named& other : files_) {
    if (output.file->collides_with(*other.file)) {
      throw OutputError(
          fmt::format("{} and {} name the same file, {}", other.option, option, file));
    }
  }
  files_.push_back(std::move(output));
  return *files_.back().file;
}

void Outputs::add_folder(const std::string& option, const fs::path& folder,
                         std::function<bool(const std::string&)> takes) {
  folders_.push_back({option, folder, std::move(takes)});
  for (const std::string& input : inputs_) refuse_if_read(folders_.back(), input);
}

void Outputs::protect(const std::string& file) {
  if (file.empty()) return;
  for (const Named& output : files_) refuse_if_read(output, file);
  for (const Folder& folder : folders_) refuse_if_read(folder, file);
  inputs_.push_back(file);
}

void Outputs::write_answer(const Json& answer) {
  if (json_ == nullptr) return;
  json_->stream() << json_text(answer, 1) << '\n';
  json_->commit();
}

}  // namespace sightline::viewers
