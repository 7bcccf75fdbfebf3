#include "viewers/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace sightline::viewers {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
  throw OutputError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  if (std::filesystem::is_directory(path_)) fail(path_, "it is a folder");
  temporary_ = path_;
  // The extension stays last: some writers judge by it.
  temporary_.replace_filename(fmt::format(".{}.{}{}", path_.stem().string(), getpid(),
                                          path_.extension().string()));
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail(path_, std::strerror(errno));
}

OutputFile::~OutputFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void OutputFile::commit() {
  stream_.close();
  if (!stream_) fail(path_, "the disk may be full");
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) fail(path_, error.message());
  committed_ = true;
}

void write_whole(const std::filesystem::path& path, std::string_view bytes) {
  OutputFile file(path);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) fail(path, error.message());
  if (!std::filesystem::is_directory(path)) fail(path, "it is not a folder");
}

}  // namespace sightline::viewers
