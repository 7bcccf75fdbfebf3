#include "viewers/commands/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmp.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <string_view>

#include "viewers/commands/command_line.h"
#include "viewers/output_file.h"

namespace sightline::viewers {
namespace {

/// Ends the program from any thread, whatever the others do; allocates nothing.
[[noreturn]] void give_up(std::string_view line) noexcept {
  remove_temporary_files();
  (void)!::write(STDERR_FILENO, line.data(), line.size());
  std::_Exit(kOurFailure);
}

constexpr std::string_view kOutOfMemory = "sightline: out of memory\n";

/// An exception that left a thread, or met another one on its way.
[[noreturn]] void on_terminate() noexcept {
  try {
    if (const std::exception_ptr error = std::current_exception()) {
      std::rethrow_exception(error);
    }
  } catch (const std::bad_alloc&) {
    give_up(kOutOfMemory);
  } catch (...) {
  }
  give_up("sightline: internal error: an exception that could not be caught\n");
}

// GMP, which holds the exact numbers, would abort where there is no memory.
void* allocate(std::size_t bytes) {
  void* const block = std::malloc(bytes);
  if (block == nullptr) give_up(kOutOfMemory);
  return block;
}
void* reallocate(void* old, std::size_t /*old_bytes*/, std::size_t bytes) {
  void* const block = std::realloc(old, bytes);
  if (block == nullptr) give_up(kOutOfMemory);
  return block;
}
void release(void* block, std::size_t /*bytes*/) { std::free(block); }

void occupy(int stream, int flags) {
  if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) return;
  // The lowest free number is the stream's: the ones below are taken by now.
  (void)!::open("/dev/null", flags);
}

}  // namespace

void prepare_process() {
  occupy(STDIN_FILENO, O_RDONLY);
  occupy(STDOUT_FILENO, O_RDONLY);  // so that writing fails
  occupy(STDERR_FILENO, O_WRONLY);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(on_terminate);
  mp_set_memory_functions(allocate, reallocate, release);
}

std::string standard_output_error() {
  errno = 0;
  std::cout.flush();
  if (std::cout) return {};
  return fmt::format("standard output: could not be written to its end: {}",
                     std::strerror(errno == 0 ? EIO : errno));
}

void tell_error(std::string message) {
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::fputs(fmt::format("sightline: {}\n", message).c_str(), stderr);
}

}  // namespace sightline::viewers
