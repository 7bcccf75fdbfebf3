#include "viewers/commands/session.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>

#include "linespace/work/stage.h"
#include "viewers/output_file.h"

namespace sightline::viewers {
namespace {

sigset_t interrupts() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

bool terminal() {
  static const bool is = isatty(STDERR_FILENO) != 0;
  return is;
}

/// "a.json, b.vtp and 3 more".
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, names.size()); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

}  // namespace

Session::Session() : budget_(std::numeric_limits<double>::infinity()) {
  // Blocked here, so that threads made later leave them to the watcher.
  const sigset_t signals = interrupts();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([this](const std::stop_token& done) { watch(done); });
}

Session::~Session() {
  watcher_.request_stop();
  pthread_kill(watcher_.native_handle(), SIGTERM);  // wakes it: no interrupt any more
  watcher_.join();
}

double Session::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

bool Session::stopped() const { return interrupted_ || seconds() > budget_; }

void Session::limit(Request& request, int shares) {
  request.budget_seconds = (budget_ - seconds()) / shares;
  request.stop = stop_.get_token();
  request.progress = [this](std::string_view stage, double share) { tell(stage, share); };
}

Request Session::limited() {
  Request request;
  limit(request);
  return request;
}

Request Session::with_grace() {
  Request request;
  request.stop = give_up_.get_token();
  request.progress = [this](std::string_view stage, double share) { tell(stage, share); };
  return request;
}

void Session::read_with_grace(const std::function<void()>& read) {
  const Request request = with_grace();
  const internal::Stage stage(request, "reading");
  read();
}

void Session::tell(std::string_view stage, double share) {
  const std::scoped_lock lock(mutex_);
  if (stage_ != stage) {
    if (stopped() && stopped_in_.empty() && !stage_.empty()) {
      stopped_in_ = fmt::format("{}, {:.0f} % done", stage_, std::floor(100 * share_));
    }
    stage_ = stage;
    shown_at_ = {};
  }
  share_ = share;
  const auto now = Clock::now();
  if (!terminal() || now - shown_at_ < std::chrono::milliseconds(100)) return;
  shown_at_ = now;
  shown_ = true;
  std::fputs(fmt::format("\r\033[K{} {:3.0f} %", stage_, std::floor(100 * share)).c_str(),
             stderr);
  std::fflush(stderr);
}

void Session::clear_terminal_line() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

std::string Session::what_stopped() const {
  if (!stopped()) {
    return fmt::format("the share of {} in the budget of {:g} s ended",
                       listed(shares_ended_), +budget_);
  }
  std::string what =
      interrupted_ ? "interrupted" : fmt::format("the budget of {:g} s ended", +budget_);
  if (!stopped_in_.empty()) {
    what += " in stage: " + stopped_in_;
  } else if (!stage_.empty()) {
    what += fmt::format(" in stage: {}, {:.0f} % done", stage_, std::floor(100 * share_));
  }
  return what;
}

std::string Session::last_line() const {
  std::string line = "sightline: " + what_stopped();
  const std::vector<std::string> written = written_files();
  line += written.empty() ? "; nothing is written" : "; written: " + listed(written);
  if (!unwritten_.empty()) line += "; not written: " + listed(unwritten_);
  return line + "\n";
}

ExitStatus Session::end(bool complete) {
  std::cout.flush();  // end_now() flushes nothing
  std::fflush(stdout);
  const std::scoped_lock lock(mutex_);
  status_ = complete && unwritten_.empty() ? kAnswered : kPartial;
  clear_terminal_line();
  const bool ended = stopped() || !shares_ended_.empty();
  if (*status_ == kPartial && ended) std::fputs(last_line().c_str(), stderr);
  return *status_;
}

void Session::watch(const std::stop_token& done) {
  const sigset_t signals = interrupts();
  std::optional<double> stopped_at;
  while (!done.stop_requested()) {
    const timespec patience{0, 20'000'000};
    const bool signalled = sigtimedwait(&signals, nullptr, &patience) > 0;
    if (done.stop_requested()) return;
    if (signalled) {
      if (interrupted_.exchange(true)) end_now();
      stop_.request_stop();
    }
    if (!stopped_at && stopped()) stopped_at = seconds();
    if (!stopped_at) continue;
    const double overdue = seconds() - *stopped_at;
    if (overdue > kGrace) give_up_.request_stop();
    if (overdue > kPatience) end_now();
  }
}

void Session::end_now() {
  mutex_.lock();  // for good: nobody tells or writes a line any more
  remove_temporary_files();
  if (status_) std::_Exit(*status_);
  clear_terminal_line();
  const std::string line = last_line();
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
  std::_Exit(kPartial);
}

}  // namespace sightline::viewers
