// What a command writes: opened before it reads or computes anything.

#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewers/commands/command_line.h"
#include "viewers/output_file.h"

namespace sightline::viewers {

/// The files and folders that the command line names for output.  Where the command ends
/// without writing them, their names hold what they held before.
class Outputs {
 public:
  Outputs() = default;
  /// Opens --json's file and --vtk's folder, and protects options.scene.  Throws
  /// OutputError.
  explicit Outputs(const CommonOptions& options);

  /// Opens the file that this option names.  Throws OutputError, also when another option
  /// names the same file, or when it is a protected one.
  OutputFile& add(const std::string& option, const std::string& file);
  /// Files will be written into this folder, or removed there, all of names that `takes`
  /// accepts.  Throws OutputError when a protected one is among them.
  void add_folder(const std::string& option, const std::filesystem::path& folder,
                  std::function<bool(const std::string&)> takes);
  /// The file is read, and files_beside() it: throws OutputError when an output would
  /// replace one of them, under whatever name.
  void protect(const std::string& file);

  /// --json's file; null when there is none.
  [[nodiscard]] OutputFile* json() { return json_; }
  /// Writes the answer where --json says, if anywhere.  Throws WriteError.
  void write_answer(const Json& answer);

 private:
  struct Named {
    std::string option;
    std::unique_ptr<OutputFile> file;
  };
  struct Folder {
    std::string option;
    std::filesystem::path path;
    std::function<bool(const std::string&)> takes;
  };
  static void refuse_if_read(const Named& output, const std::string& input);
  static void refuse_if_read(const Folder& folder, const std::string& input);

  std::optional<OutputFolder> vtk_;
  std::vector<Named> files_;
  std::vector<Folder> folders_;
  std::vector<std::string> inputs_;
  OutputFile* json_ = nullptr;
};

}  // namespace sightline::viewers
