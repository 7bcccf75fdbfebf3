// A run of the program: its clock, its budget, interrupts, and the line on a terminal
// that shows how far it is.
//
// The promise: within a second of the end of the budget, or of an interrupt, the program
// has ended, whatever it was doing, and every file with a final name is whole.
//   at once        computing hears of it and hands back what it has; what is there is
//                  written
//   after kGrace   reading and writing hear of it: without a scene there is nothing to
//                  answer, and a file that cannot be finished is left out
//   after kPatience  the program ends from a thread of its own: something could not hear,
//                  such as a library's reader
// A second interrupt ends the program at once.

#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "linespace/request.h"

namespace sightline::viewers {

/// Exit statuses of CONTRACT.md.
enum ExitStatus : int { kAnswered = 0, kOurFailure = 1, kBadInput = 2, kPartial = 3 };

class Session {
 public:
  using Clock = std::chrono::steady_clock;
  /// Seconds after the end of the budget or the first interrupt.
  static constexpr double kGrace = 0.4, kPatience = 0.8;

  /// The clock begins.  From now on SIGINT and SIGTERM are heard.  One a process, made
  /// before other threads.
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The run is to end that many seconds after its beginning.
  void set_budget(double seconds) { budget_ = seconds; }
  /// Since the run began.
  [[nodiscard]] double seconds() const;
  /// By a signal; the budget may have ended without.
  [[nodiscard]] bool interrupted() const { return interrupted_; }
  /// Interrupted, or the budget has ended.
  [[nodiscard]] bool stopped() const;

  /// Work under this request ends with the budget or the interrupt and tells its progress
  /// here.  Of what is left of the budget it has one of so many equal shares.
  void limit(Request& request, int shares = 1);
  /// This part of the work used its share up and is not done.
  void share_ended(const std::string& part) { shares_ended_.push_back(part); }
  /// A request of that kind.
  [[nodiscard]] Request limited();

  /// This share of the stage, in [0, 1], is done.
  void tell(std::string_view stage, double share);
  /// For reading and writing: ends kGrace later.
  [[nodiscard]] Request with_grace();

  /// What read() returns, which hears a stop kGrace late
  /// (linespace/work/stop_scope.h).
  template <class Read>
  [[nodiscard]] auto read(Read&& read) {
    std::optional<decltype(read())> result;
    read_with_grace([&] { result.emplace(read()); });
    return *std::move(result);
  }

  /// Names what begins, for the terminal and for the last line.
  void begin(std::string_view stage) { tell(stage, 0); }

  /// Calls writer(with_grace()) to write what `name` tells.  False when it threw Stopped:
  /// the last line will say that this is missing.
  template <class Writer>
  bool write(const std::string& name, Writer&& writer) {
    begin("writing " + name);
    try {
      writer(with_grace());
      return true;
    } catch (const Stopped&) {
      unwritten_.push_back(name);
      return false;
    }
  }
  /// Names of what write() did not write.
  [[nodiscard]] const std::vector<std::string>& unwritten() const { return unwritten_; }

  /// The answer is out.  Returns the status that the program is to end with: kAnswered
  /// when `complete` and nothing is unwritten.  After a stop, and where a share ended, it
  /// says on standard error what stopped it and what is written, in one line.
  ExitStatus end(bool complete);
  /// The same where the work was stopped before there was an answer.
  ExitStatus end_without_answer() { return end(false); }

 private:
  void read_with_grace(const std::function<void()>& read);
  void watch(const std::stop_token& done);
  [[nodiscard]] std::string last_line() const;
  [[nodiscard]] std::string what_stopped() const;
  void clear_terminal_line();
  [[noreturn]] void end_now();

  const Clock::time_point start_ = Clock::now();
  std::atomic<double> budget_;
  std::atomic<bool> interrupted_{false};
  std::stop_source stop_, give_up_;
  std::vector<std::string> unwritten_, shares_ended_;

  mutable std::mutex mutex_;  // of what follows
  std::string stage_;
  double share_ = 0;
  Clock::time_point shown_at_{};
  bool shown_ = false;
  // What the work was at when it was stopped.
  std::string stopped_in_;
  std::optional<ExitStatus> status_;

  std::jthread watcher_;  // last: it uses all of the above
};

}  // namespace sightline::viewers
