#include "viewers/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <streambuf>

namespace sightline::viewers {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_open(const fs::path& path, const std::string& reason) {
  throw OutputError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

[[noreturn]] void fail_to_write(const fs::path& path, int error) {
  throw WriteError(fmt::format("{}: could not be written to its end: {}",
                               path == "-" ? "standard output" : path.string(),
                               std::strerror(error == 0 ? EIO : error)));
}

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// The path without its links, also where the last one leads to nothing.
fs::path followed(fs::path path) {
  constexpr int kLongestChain = 40;
  for (int i = 0; i < kLongestChain; ++i) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
    const fs::path next = fs::read_symlink(path, error);
    if (error) fail_to_open(path, error.message());
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  fail_to_open(path, std::strerror(ELOOP));
}

int open_retrying(const char* path, int flags, mode_t mode = 0) {
  int fd = -1;
  do {
    fd = ::open(path, flags | O_CLOEXEC, mode);
  } while (fd < 0 && errno == EINTR);
  return fd;
}

constexpr const char* kTemporaryName = ".sightline-";

// Temporary files that exist, for remove_temporary_files: a slot holds the path of one
// or is null.  Files beyond the last slot are only cleaned up by their owners.
std::array<std::atomic<const char*>, 64> temporary_files;

struct {
  std::mutex mutex;
  std::vector<std::string> names;
} written;

void remember(const fs::path& path) {
  for (std::atomic<const char*>& slot : temporary_files) {
    const char* empty = nullptr;
    if (slot.compare_exchange_strong(empty, path.c_str())) return;
  }
}

void forget(const fs::path& path) {
  for (std::atomic<const char*>& slot : temporary_files) {
    const char* mine = path.c_str();
    if (slot.compare_exchange_strong(mine, nullptr)) return;
  }
}

/// Removes temporary files whose writers are gone: nobody holds their locks.  Once for
/// each folder.
void remove_abandoned(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> done;
  const std::scoped_lock lock(mutex);
  if (!done.insert(folder).second) return;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& file = entry->path();
    if (!file.filename().string().starts_with(kTemporaryName)) continue;
    const int fd = open_retrying(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) continue;
    struct stat status {};
    if (::fstat(fd, &status) == 0 && S_ISREG(status.st_mode) &&
        ::flock(fd, LOCK_EX | LOCK_NB) == 0) {
      ::unlink(file.c_str());
    }
    ::close(fd);
  }
}

/// Locks a temporary file for as long as a descriptor of it is open; false when
/// remove_abandoned was faster.  A file system without locks loses nothing but that.
bool lock_temporary(int fd) {
  struct stat status {};
  const bool lost = ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  return !lost && ::fstat(fd, &status) == 0 && status.st_nlink > 0;
}

/// A new file in the folder, hidden and of a name nobody else has, and its descriptor.
/// The extension stays last: some writers judge by it.
std::pair<fs::path, int> create_temporary(const fs::path& folder,
                                          const std::string& extension) {
  static std::atomic<int> count = 0;
  constexpr int kTries = 100;  // names left behind by a process of the same number
  remove_abandoned(folder.empty() ? "." : folder);
  for (int i = 0; i < kTries; ++i) {
    fs::path name = folder / fmt::format("{}{}-{}{}", kTemporaryName, getpid(), ++count,
                                         extension.size() < 20 ? extension : "");
    const int fd = open_retrying(name.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd < 0 && errno != EEXIST) return {std::move(name), fd};
    if (fd >= 0 && lock_temporary(fd)) return {std::move(name), fd};
    if (fd >= 0) ::close(fd);
  }
  return {{}, -1};
}

}  // namespace

/// Bytes on their way into a file descriptor; keeps the first error.
class OutputFile::Buffer : public std::streambuf {
 public:
  // The lock of a temporary file outlives close().
  Buffer(int fd, bool owned, bool temporary)
      : fd_(fd), lock_(temporary ? ::fcntl(fd, F_DUPFD_CLOEXEC, 0) : -1), owned_(owned) {
    setp(bytes_.data(), bytes_.data() + bytes_.size());
  }
  ~Buffer() override {
    if (owned_ && fd_ >= 0) ::close(fd_);
    if (lock_ >= 0) ::close(lock_);
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  [[nodiscard]] int error() const { return error_; }
  [[nodiscard]] int descriptor() const { return fd_; }

  /// Writes what is left and closes the file.
  void close() {
    sync();
    if (owned_ && fd_ >= 0 && ::close(fd_) != 0 && errno != EINTR && error_ == 0) {
      error_ = errno;
    }
    fd_ = -1;
    bytes_ = {};
    setp(nullptr, nullptr);
  }

 protected:
  int sync() override {
    const char* next = pbase();
    while (next != pptr() && error_ == 0) {
      const ssize_t n = ::write(fd_, next, static_cast<std::size_t>(pptr() - next));
      if (n > 0) {
        next += n;
      } else if (n == 0 || errno != EINTR) {
        error_ = n == 0 ? EIO : errno;
      }
    }
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    return error_ == 0 ? 0 : -1;
  }
  int_type overflow(int_type c) override {
    if (fd_ < 0 || sync() != 0) return traits_type::eof();
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    *pptr() = traits_type::to_char_type(c);
    pbump(1);
    return c;
  }

 private:
  int fd_;
  int lock_;  // another descriptor of the same file
  bool owned_;
  int error_ = 0;
  std::vector<char> bytes_ = std::vector<char>(1 << 16);
};

OutputFile::OutputFile(const fs::path& path) : path_(path) {
  if (path == "-") {
    buffer_ = std::make_unique<Buffer>(STDOUT_FILENO, false, false);
    stream_ = std::make_unique<std::ostream>(buffer_.get());
    return;
  }
  if (!path.has_filename()) fail_to_open(path_, "the name is that of a folder");
  struct stat there {};
  const bool exists = ::stat(path.c_str(), &there) == 0;
  if (!exists && errno != ENOENT) fail_to_open(path_, std::strerror(errno));
  if (S_ISDIR(there.st_mode)) fail_to_open(path_, "it is a folder");
  int fd = -1;
  if (!exists || S_ISREG(there.st_mode)) {
    target_ = followed(path);
    replaces_ = true;
  } else {
    target_ = temporary_ = path;
    fd = open_retrying(path.c_str(), O_WRONLY);
  }
  if (exists && replaces_) {
    struct stat standard_output {};
    if (::fstat(STDOUT_FILENO, &standard_output) == 0 &&
        same_file(there, standard_output)) {
      fail_to_open(path_, "standard output goes there too; '-' names it");
    }
    if (::access(path.c_str(), W_OK) != 0) fail_to_open(path_, std::strerror(errno));
  }
  if (replaces_) {
    std::tie(temporary_, fd) =
        create_temporary(target_.parent_path(), target_.extension().string());
  }
  if (fd < 0) fail_to_open(path_, std::strerror(errno));
  // A file that is replaced keeps its permissions, as far as we may give them.
  if (replaces_ && there.st_mode != 0) (void)::fchmod(fd, there.st_mode & 07777);
  if (replaces_) remember(temporary_);
  buffer_ = std::make_unique<Buffer>(fd, true, replaces_);
  stream_ = std::make_unique<std::ostream>(buffer_.get());
}

OutputFile::~OutputFile() {
  if (committed_ || !replaces_) return;
  ::unlink(temporary_.c_str());
  forget(temporary_);
}

bool OutputFile::would_replace(const fs::path& file) const {
  return is_same_file(target_, file);
}

bool OutputFile::collides_with(const OutputFile& other) const {
  std::error_code error;
  if (!replaces_ || !other.replaces_) return false;
  const auto folder = [&](const OutputFile& file) {
    return fs::canonical(fs::absolute(file.target_).parent_path(), error);
  };
  return target_.filename() == other.target_.filename() && folder(*this) == folder(other);
}

void OutputFile::close() { buffer_->close(); }

void OutputFile::commit() {
  buffer_->close();
  if (buffer_->error() != 0) fail_to_write(path_, buffer_->error());
  if (replaces_) {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail_to_write(path_, errno);
    forget(temporary_);
  }
  committed_ = true;
  const std::scoped_lock lock(written.mutex);
  written.names.push_back(path_ == "-" ? "standard output" : path_.string());
}

std::vector<std::string> written_files() {
  const std::scoped_lock lock(written.mutex);
  return written.names;
}

bool is_same_file(const fs::path& written, const fs::path& read) {
  struct stat mine {};
  struct stat other {};
  return ::stat(written.c_str(), &mine) == 0 && S_ISREG(mine.st_mode) &&
         (read == "-" ? ::fstat(STDIN_FILENO, &other) : ::stat(read.c_str(), &other)) ==
             0 &&
         same_file(mine, other);
}

void write_whole(const fs::path& path, std::string_view bytes) {
  OutputFile file(path);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) fail_to_open(path, error.message());
  if (!fs::is_directory(path)) fail_to_open(path, "it is not a folder");
}

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
  if (path_.empty()) fail_to_open("''", "the name is empty");
  for (fs::path p = fs::absolute(path_).lexically_normal(); !fs::exists(p);
       p = p.parent_path()) {
    if (!p.filename().empty()) made_.insert(made_.begin(), p);
  }
  try {
    make_folder(path_);
    const auto [probe, fd] = create_temporary(path_, "");
    if (fd < 0) fail_to_open(path_, std::strerror(errno));
    ::close(fd);
    ::unlink(probe.c_str());
  } catch (...) {
    remove_made();
    throw;
  }
}

OutputFolder::~OutputFolder() { remove_made(); }

void OutputFolder::remove_made() noexcept {
  // rmdir refuses a folder that is not empty.
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) {
    ::rmdir(folder->c_str());
  }
}

void remove_temporary_files() noexcept {
  for (const std::atomic<const char*>& slot : temporary_files) {
    if (const char* path = slot.load()) ::unlink(path);
  }
}

}  // namespace sightline::viewers
