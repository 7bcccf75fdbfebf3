#include "viewers/report_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>

namespace sightline::viewers {

namespace fs = std::filesystem;

namespace {

// A name below the folder, and no way out of it.
bool is_inside(const std::string& name) {
  const fs::path path(name);
  return !name.empty() && path.is_relative() &&
         std::none_of(path.begin(), path.end(),
                      [](const fs::path& part) { return part == ".."; });
}

constexpr const char* kTitle =
    "# Written by `sightline analyse`; the next run removes these files.";

}  // namespace

ReportFolder::ReportFolder(const fs::path& path) : folder_(path) {
  std::ifstream list(path / kList, std::ios::binary);
  std::string line;
  if (!std::getline(list, line) || line != kTitle) return;  // not ours
  while (std::getline(list, line)) {
    if (is_inside(line)) earlier_.push_back(line);
  }
}

void ReportFolder::clear() {
  for (const std::string& name : earlier_) {
    if (std::ranges::find(files_, name) != files_.end()) continue;
    const fs::path file = path() / name;
    std::error_code error;
    if (fs::is_directory(fs::symlink_status(file, error))) continue;
    fs::remove(file, error);
    if (error) {
      throw OutputError(fmt::format("{}: an earlier report's file cannot be removed: {}",
                                    file.string(), std::strerror(error.value())));
    }
    // A folder that is not empty stays.
    if (file.parent_path() != path()) fs::remove(file.parent_path(), error);
  }
  earlier_.clear();
  write_list();
}

fs::path ReportFolder::announce(const std::string& name) {
  add({name});
  return path() / name;
}

void ReportFolder::add(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (std::ranges::find(files_, name) == files_.end()) files_.push_back(name);
  }
  write_list();
}

bool ReportFolder::takes(const std::string& name) const {
  return name == kList || name == "index.html" || name == "report.json" ||
         name == "skeleton.json" || name == "look.json" || name == "shadows.json" ||
         name == "shadows.csv" || name == "formfactors.json" ||
         name == "formfactors.csv" || name.ends_with(".png") ||
         (name.starts_with("look") && name.ends_with(".svg")) ||
         std::ranges::find(earlier_, name) != earlier_.end();
}

void ReportFolder::write_list() const {
  std::vector<std::string> all = files_;
  for (const std::string& name : earlier_) {
    if (std::ranges::find(all, name) == all.end()) all.push_back(name);
  }
  write_whole(path() / kList, fmt::format("{}\n{}\n", kTitle, fmt::join(all, "\n")));
}

}  // namespace sightline::viewers
