#include "linespace/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "linespace/scene.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& why) {
  throw InvalidInput(told_name(file) + ": " + why);
}

/// A file descriptor, closed at the end; standard input stays open.
class Descriptor {
 public:
  explicit Descriptor(const std::string& file)
      : fd_(file == kStandardInput ? STDIN_FILENO
                                   : ::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (fd_ > STDIN_FILENO) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

std::string told_name(const std::string& file) {
  return file == kStandardInput ? "standard input" : file;
}

std::string read_whole(const std::string& file, std::size_t most) {
  const Descriptor descriptor(file);
  struct stat status {};
  if (descriptor.number() < 0 || ::fstat(descriptor.number(), &status) != 0) {
    fail(file, errno == ENOENT ? std::string("no such file")
                               : std::string("cannot be read: ") + std::strerror(errno));
  }
  if (S_ISDIR(status.st_mode)) fail(file, "is a folder");
  std::string bytes;
  for (;;) {
    constexpr std::size_t kBlock = 1 << 20;
    hear_stop_now();
    const std::size_t size = bytes.size();
    // One block more than the file says it has, so that its end is seen.
    bytes.resize(std::max<std::size_t>(
        size + kBlock, S_ISREG(status.st_mode) && size == 0 ? status.st_size + 1 : 0));
    const ssize_t n = ::read(descriptor.number(), bytes.data() + size,
                             std::min(bytes.size() - size, std::size_t{1} << 30));
    bytes.resize(size + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(file, std::string("cannot be read: ") + std::strerror(errno));
    if (bytes.size() > most) {
      fail(file, "is larger than " + std::to_string(most >> 20) + " MiB");
    }
    if (n == 0) return bytes;
  }
}

}  // namespace sightline::internal
