// Files that are written whole or not at all, and never over what the program reads.

#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sightline::viewers {

/// A file cannot be opened for writing where the user wants it; what() is one line that
/// names it.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that had been opened could not be written to its end; what() is one line that
/// names it and says why.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file to be written.  What kind of thing its name stands for decides how:
/// - nothing yet, or a regular file: the bytes go into a temporary file beside it, which
///   takes the name when it is whole.  Until then the name keeps what it had.
/// - a symbolic link: the file that the link leads to is treated so; the link stays.
/// - a device or a pipe: the bytes are written into it; it is never replaced.
/// - "-": standard output.
/// Destroyed without commit(), it leaves no temporary file behind.  One that a killed
/// process left in a folder is removed by the next that writes a file there.
class OutputFile {
 public:
  /// Opens it.  Throws OutputError when it cannot be opened, is a folder or a socket, or
  /// is the regular file that standard output goes to.
  explicit OutputFile(const std::filesystem::path& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Bytes written here show no error before commit().
  [[nodiscard]] std::ostream& stream() { return *stream_; }
  /// Where the bytes are now, for writers that want a name; not for "-".
  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_; }
  /// The name that the file will have, links followed; empty for "-".
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }
  /// Whether it would take the place of this regular file, under whatever other name of
  /// it; "-" is standard input.
  [[nodiscard]] bool would_replace(const std::filesystem::path& file) const;

  /// Whether both are to have the same name; two devices, or "-" twice, are not.
  [[nodiscard]] bool collides_with(const OutputFile& other) const;

  /// Ends writing and frees the buffer: of many files that wait for their names this one
  /// costs no more than a descriptor.
  void close();
  /// Gives the file its name.  Throws WriteError when some byte could not be written.
  void commit();

 private:
  class Buffer;

  std::filesystem::path path_, target_, temporary_;  // as named; links followed; now
  std::unique_ptr<Buffer> buffer_;
  std::unique_ptr<std::ostream> stream_;
  bool replaces_ = false;  // the temporary file takes the target's name
  bool committed_ = false;
};

/// Whether writing this name would change that regular file, under whatever other name of
/// it; "-" as the second is standard input.
[[nodiscard]] bool is_same_file(const std::filesystem::path& written,
                                const std::filesystem::path& read);

/// Creates or replaces a file with these bytes.  Throws OutputError or WriteError.
void write_whole(const std::filesystem::path& path, std::string_view bytes);

/// Creates a folder and those above it.  Throws OutputError.
void make_folder(const std::filesystem::path& path);

/// A folder that files will be written into: made if need be with those above it, and
/// tried by a file of no name that anybody looks for.  Destroyed, it removes those of the
/// folders it made that are still empty.
class OutputFolder {
 public:
  /// Throws OutputError when no file can be created there.
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void remove_made() noexcept;

  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  // outermost first
};

/// Names of the files that commit() has made whole so far, in that order; "standard
/// output" for "-".
[[nodiscard]] std::vector<std::string> written_files();

/// Removes the temporary files of all OutputFiles, for a program that must end at once.
/// Allocates nothing and takes no lock.
void remove_temporary_files() noexcept;

}  // namespace sightline::viewers
