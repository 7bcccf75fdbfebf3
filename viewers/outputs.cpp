#include "viewers/outputs.h"

#include <fmt/format.h>

#include <filesystem>

#include "linespace/mesh_io.h"
#include "viewers/json_text.h"

namespace sightline::viewers {

Outputs::Outputs(const CommonOptions& options) {
  protect(options.scene);
  if (!options.json.empty()) json_ = &add("--json", options.json);
  if (!options.vtk.empty()) vtk_.emplace(options.vtk);
}

void Outputs::refuse_if_read(const Named& output, const std::string& input) {
  const auto refuse_if = [&](const std::string& file) {
    if (!output.file->would_replace(file)) return;
    throw OutputError(fmt::format("{}: {} is read; name another file", output.option,
                                  output.file->target().string()));
  };
  refuse_if(input);
  // The input is looked into only where there is something to replace.
  std::error_code error;
  if (!std::filesystem::is_regular_file(output.file->target(), error)) return;
  for (const std::string& file : files_beside(input)) refuse_if(file);
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

void Outputs::protect(const std::string& file) {
  if (file.empty()) return;
  for (const Named& output : files_) refuse_if_read(output, file);
  inputs_.push_back(file);
}

void Outputs::write_answer(const Json& answer) {
  if (json_ == nullptr) return;
  json_->stream() << json_text(answer, 1) << '\n';
  json_->commit();
}

}  // namespace sightline::viewers
