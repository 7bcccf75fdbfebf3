// The folder of a report, which an earlier run may have filled.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "viewers/output_file.h"

namespace sightline::viewers {

/// A folder whose files are listed in it, in files.txt, so that the next run can remove
/// what this one wrote and nothing else.
class ReportFolder {
 public:
  static constexpr const char* kList = "files.txt";

  /// Opens the folder and reads the list that is there, if any.  Throws OutputError.
  explicit ReportFolder(const std::filesystem::path& path);

  /// Removes what an earlier run wrote, with folders that this empties.  To be called
  /// when there is something new to write.  Throws OutputError.
  void clear();

  /// The file of this name in the folder is about to be written: it is listed first, so
  /// that it is known even if this run is killed.  Throws OutputError or WriteError.
  std::filesystem::path announce(const std::string& name);
  /// These were written.
  void add(const std::vector<std::string>& names);

  /// Whether a report may write a file of this name into the folder, or remove it there;
  /// not of those in folders below it.
  [[nodiscard]] bool takes(const std::string& name) const;

  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  /// Of this run, in order; without the list itself.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

 private:
  void write_list() const;

  OutputFolder folder_;
  std::vector<std::string> earlier_, files_;
};

}  // namespace sightline::viewers
