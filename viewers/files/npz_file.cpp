#include "viewers/files/npz_file.h"

#include <fmt/format.h>
#include <minizip/zip.h>

#include <algorithm>
#include <bit>

#include "viewers/output_file.h"

namespace sightline::viewers {

static_assert(std::endian::native == std::endian::little, "arrays are written as held");

struct NpzFile::Zip {
  zipFile file = nullptr;
};

NpzFile::NpzFile(const std::filesystem::path& path)
    : zip_(std::make_unique<Zip>()), path_(path.string()) {
  zip_->file = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
  if (zip_->file == nullptr)
    throw WriteError(fmt::format("{}: cannot be written", path_));
}

NpzFile::~NpzFile() {
  if (zip_->file != nullptr) zipClose(zip_->file, nullptr);
}

void NpzFile::begin(const std::string& name, const std::string& descr,
                    const std::size_t* count) {
  const zip_fileinfo info{};
  constexpr int kLarge = 1;  // entries may pass 4 GiB
  if (zipOpenNewFileInZip64(zip_->file, (name + ".npy").c_str(), &info, nullptr, 0,
                            nullptr, 0, nullptr, Z_DEFLATED, Z_BEST_SPEED,
                            kLarge) != ZIP_OK) {
    throw WriteError(fmt::format("{}: cannot be written", path_));
  }
  std::string head =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", descr,
                  count ? fmt::format("({},)", *count) : "()");
  // Magic, version and length are 10 bytes; the data begin at a multiple of 64.
  head.append(63 - (10 + head.size()) % 64, ' ');
  head += '\n';
  const auto length = static_cast<std::uint16_t>(head.size());
  std::string begin("\x93NUMPY\x01\x00", 8);
  begin += static_cast<char>(length & 255);
  begin += static_cast<char>(length >> 8);
  begin += head;
  write(begin.data(), begin.size());
}

void NpzFile::write(const void* bytes, std::size_t size) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const std::size_t part = std::min(size, kMost);
    if (zipWriteInFileInZip(zip_->file, at, static_cast<unsigned>(part)) != ZIP_OK)
      throw WriteError(fmt::format("{}: could not be written to its end", path_));
    at += part;
    size -= part;
  }
}

void NpzFile::end() {
  if (zipCloseFileInZip(zip_->file) != ZIP_OK)
    throw WriteError(fmt::format("{}: could not be written to its end", path_));
}

void NpzFile::add(const std::string& name, std::span<const double> values) {
  const std::size_t count = values.size();
  begin(name, "<f8", &count);
  write(values.data(), values.size_bytes());
  end();
}

void NpzFile::add(const std::string& name, std::span<const std::int64_t> values) {
  const std::size_t count = values.size();
  begin(name, "<i8", &count);
  write(values.data(), values.size_bytes());
  end();
}

void NpzFile::add(const std::string& name, std::span<const std::string> values) {
  std::size_t longest = 1;
  for (const std::string& value : values) longest = std::max(longest, value.size());
  const std::size_t count = values.size();
  begin(name, fmt::format("|S{}", longest), &count);
  for (std::string value : values) {
    value.resize(longest);
    write(value.data(), value.size());
  }
  end();
}

void NpzFile::add_text(const std::string& name, const std::string& value) {
  begin(name, fmt::format("|S{}", value.size()), nullptr);
  write(value.data(), value.size());
  end();
}

void NpzFile::close() {
  const int closed = zipClose(zip_->file, nullptr);
  zip_->file = nullptr;
  if (closed != ZIP_OK)
    throw WriteError(fmt::format("{}: could not be written to its end", path_));
}

}  // namespace sightline::viewers
