#include "viewers/outputs.h"

#include <fmt/format.h>

#include "viewers/json_text.h"

namespace sightline::viewers {

Outputs::Outputs(const CommonOptions& options) {
  protect(options.scene);
  if (!options.json.empty()) json_ = &add("--json", options.json);
  if (!options.vtk.empty()) vtk_.emplace(options.vtk);
}

void Outputs::refuse_input(const Named& output) {
  throw OutputError(fmt::format("{}: {} is read; name another file", output.option,
                                output.file->target().string()));
}

OutputFile& Outputs::add(const std::string& option, const std::string& file) {
  Named output{option, std::make_unique<OutputFile>(file)};
  for (const std::string& input : inputs_) {
    if (output.file->would_replace(input)) refuse_input(output);
  }
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
  for (const Named& output : files_) {
    if (output.file->would_replace(file)) refuse_input(output);
  }
  inputs_.push_back(file);
}

void Outputs::write_answer(const Json& answer) {
  if (json_ == nullptr) return;
  json_->stream() << json_text(answer, 1) << '\n';
  json_->commit();
}

}  // namespace sightline::viewers
