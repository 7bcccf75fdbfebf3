// Files that are written whole or not at all.

#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace sightline::viewers {

/// A file cannot be written where the user wants it; what() is one line that names it.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file under a temporary name beside its own, until commit() gives it its own.
/// Destroyed without commit(), it leaves nothing behind.
class OutputFile {
 public:
  /// Throws OutputError when the file cannot be created.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] std::ostream& stream() { return stream_; }
  /// Where the bytes are now: for writers that want a name.
  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_; }
  /// Throws OutputError when some bytes could not be written.
  void commit();

 private:
  std::filesystem::path path_, temporary_;
  std::ofstream stream_;
  bool committed_ = false;
};

/// Creates or replaces a file with these bytes.  Throws OutputError.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

/// Creates a folder and those above it.  Throws OutputError.
void make_folder(const std::filesystem::path& path);

}  // namespace sightline::viewers
