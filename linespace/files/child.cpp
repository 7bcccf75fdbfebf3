// Reading in a process of its own: fork, and the polygons back through a pipe.

#include "linespace/files/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace sightline::internal {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

/// Processor seconds that reading may take.
std::size_t seconds_for(std::size_t bytes) { return 10 + 10 * (bytes / kMegabyte); }

/// Bytes that reading may take.
std::size_t memory_for(std::size_t bytes) {
  return (std::size_t{1} << 30) + 1024 * bytes;
}

// What the child sends: a letter, then the polygons, or what is wrong.
enum : char { kSoup = 'S', kRefused = 'R', kNoMemory = 'M' };

// ---- Polygons as bytes.

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void put_list(const std::vector<T>& values) {
    put(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()),
                  sizeof(T) * values.size());
  }
  void put_text(const std::string& text) {
    put(text.size());
    bytes_.append(text);
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Trusts nothing: the child may have damaged its own memory.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  // Sizes of lists whose elements take at least `least` bytes each.
  std::size_t get_size(std::size_t least) {
    const auto size = get<std::size_t>();
    if (size > bytes_.size() / least) throw std::out_of_range("size");
    return size;
  }
  template <class T>
  std::vector<T> get_list() {
    std::vector<T> values(get_size(sizeof(T)));
    std::memcpy(values.data(), take(sizeof(T) * values.size()).data(),
                sizeof(T) * values.size());
    return values;
  }
  std::string get_text() { return std::string(take(get_size(1))); }

 private:
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) throw std::out_of_range("bytes");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  std::string_view bytes_;
};

std::string bytes_of(const PolygonSoup& soup) {
  Writer out;
  out.put(static_cast<char>(kSoup));
  out.put(soup.vertices.size());
  for (const Point& p : soup.vertices) {
    for (const double x : p) out.put(x);
  }
  out.put(soup.polygons.size());
  for (const auto& polygon : soup.polygons) out.put_list(polygon);
  out.put(soup.groups.size());
  for (const auto& group : soup.groups) {
    out.put_text(group.name);
    out.put_list(group.faces);
  }
  out.put(soup.defects.size());
  for (const Defect& defect : soup.defects) {
    out.put_text(defect.kind);
    out.put_text(defect.message);
  }
  return out.take();
}

PolygonSoup soup_from(Reader in) {
  PolygonSoup soup;
  soup.vertices.resize(in.get_size(3 * sizeof(double)));
  for (Point& p : soup.vertices) {
    for (double& x : p) x = in.get<double>();
  }
  soup.polygons.resize(in.get_size(sizeof(std::size_t)));
  for (auto& polygon : soup.polygons) polygon = in.get_list<int>();
  soup.groups.resize(in.get_size(2 * sizeof(std::size_t)));
  for (auto& group : soup.groups) {
    group.name = in.get_text();
    group.faces = in.get_list<int>();
  }
  soup.defects.resize(in.get_size(2 * sizeof(std::size_t)));
  for (Defect& defect : soup.defects) {
    defect.kind = in.get_text();
    defect.message = in.get_text();
  }
  return soup;
}

// ---- The child.

void limit(__rlimit_resource resource, std::size_t most) {
  const rlimit limits{most, most};
  setrlimit(resource, &limits);
}

/// What the process holds now of what RLIMIT_DATA counts: the sixth number of statm,
/// pages.
std::size_t data_bytes() {
  std::ifstream numbers("/proc/self/statm");
  std::size_t pages = 0;
  for (int i = 0; i < 6; ++i) numbers >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Silent, mortal, bounded in time and memory.
void prepare_child(pid_t parent, std::size_t bytes) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it died before the line above
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    dup2(nowhere, stream);
  }
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU}) {
    std::signal(signal, SIG_DFL);
  }
  std::signal(SIGPIPE, SIG_IGN);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, seconds_for(bytes));
  limit(RLIMIT_DATA, data_bytes() + memory_for(bytes));
}

bool write_all(int pipe, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(pipe, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void run_child(int pipe, const std::function<PolygonSoup()>& read) {
  std::string answer;
  try {
    answer = bytes_of(read());
  } catch (const InvalidInput& error) {
    answer = std::string(1, kRefused) + error.what();
  } catch (const std::bad_alloc&) {
    answer = std::string(1, kNoMemory);
  } catch (...) {
    _exit(1);
  }
  // Not exit: the parent's buffers are not ours to flush, its objects not ours to
  // destroy.
  _exit(write_all(pipe, answer) ? 0 : 1);
}

// ---- The parent.

class Child {
 public:
  Child(pid_t pid, int pipe) : pid_(pid), pipe_(pipe) {}
  ~Child() {
    close(pipe_);
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    (void)status();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// All that the child sends until it ends.  nullopt when it takes too long.
  std::optional<std::string> listen(const std::function<void()>& check,
                                    std::chrono::seconds longest) {
    constexpr int kPatience = 50;  // milliseconds between two checks
    const auto end = std::chrono::steady_clock::now() + longest;
    std::string answer;
    for (;;) {
      check();
      pollfd ready{pipe_, POLLIN, 0};
      if (poll(&ready, 1, kPatience) <= 0) {
        if (std::chrono::steady_clock::now() > end) return std::nullopt;
        continue;
      }
      const std::size_t size = answer.size();
      answer.resize(size + kMegabyte);
      const ssize_t got = read(pipe_, answer.data() + size, kMegabyte);
      answer.resize(size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
      if (got == 0 || (got < 0 && errno != EINTR)) return answer;
    }
  }

  /// Waits for the end of the child.  As waitpid gives it; -1 when there is none.
  int status() {
    int status = -1;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_;
  int pipe_;
};

[[noreturn]] void refuse_slow(const std::string& path, std::size_t bytes) {
  refuse(path, "cannot be read: the reader library did not end within " +
                   std::to_string(seconds_for(bytes)) + " s of processor time");
}

}  // namespace

PolygonSoup read_in_child(const std::string& path, std::size_t bytes,
                          const std::function<void()>& check,
                          const std::function<PolygonSoup()>& read) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "no pipe");
  }
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    prepare_child(parent, bytes);
    run_child(ends[1], read);
  }
  close(ends[1]);
  Child child(pid, ends[0]);
  if (pid < 0) throw std::system_error(errno, std::generic_category(), "no process");
  constexpr int kWaiting = 10;  // a child that waits for ever uses no processor time
  const auto answer =
      child.listen(check, std::chrono::seconds(kWaiting * seconds_for(bytes)));
  if (!answer) refuse_slow(path, bytes);
  const int status = child.status();
  const bool is_whole = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!is_whole || answer->empty()) {
    if (WIFSIGNALED(status) &&
        (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
      refuse_slow(path, bytes);
    }
    refuse(path,
           "cannot be read: the reader library crashed on it" +
               (WIFSIGNALED(status) ? " (signal " + std::to_string(WTERMSIG(status)) + ")"
                                    : std::string()));
  }
  const std::string_view rest = std::string_view(*answer).substr(1);
  if (answer->front() == kRefused) throw InvalidInput(std::string(rest));
  if (answer->front() == kNoMemory) {
    refuse(path, "cannot be read: the reader library needs more than " +
                     std::to_string(memory_for(bytes) / kMegabyte) + " MiB for it");
  }
  try {
    return soup_from(Reader(rest));
  } catch (const std::out_of_range&) {
    refuse(path, "cannot be read: the reader library gave no polygons");
  }
}

}  // namespace sightline::internal
