// NumPy's .npz: a zip archive of arrays.  The format of an array is NumPy's own
// specification, "NPY format", version 1.0.

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sightline::viewers {

/// Arrays are written one after the other, none is held.  Throws WriteError.
class NpzFile {
 public:
  /// Creates or replaces the file.
  explicit NpzFile(const std::filesystem::path& path);
  ~NpzFile();
  NpzFile(const NpzFile&) = delete;
  NpzFile& operator=(const NpzFile&) = delete;

  /// Begins an array: descr as "<f8"; of one dimension, or of none for count nullptr.
  void begin(const std::string& name, const std::string& descr, const std::size_t* count);
  void write(const void* bytes, std::size_t size);
  void end();

  void add(const std::string& name, std::span<const double> values);
  void add(const std::string& name, std::span<const std::int64_t> values);
  /// Bytes, padded with 0 to the longest.
  void add(const std::string& name, std::span<const std::string> values);
  /// A single string.
  void add_text(const std::string& name, const std::string& value);

  void close();

 private:
  struct Zip;
  std::unique_ptr<Zip> zip_;
  std::string path_;
};

}  // namespace sightline::viewers
