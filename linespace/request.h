// What every analysis is asked besides its question: how exact, how long, how large, on
// how many threads, whom to tell, when to stop; and what every answer tells of its cost.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>

namespace sightline {

/// Exact: filtered predicates that always give the sign of exact arithmetic.
/// Double: the first floating-point stage alone, its sign taken as it is; it exists to
/// measure what exactness costs and what it saves.
enum class Precision { Exact, Double };

/// The terms on which a question is asked.  All members have defaults: `Request{}` asks
/// for the whole exact answer on all cores.
struct Request {
  Precision precision = Precision::Exact;
  /// Number of threads; 0 means one per core.  The answer does not depend on it.
  int threads = 0;
  /// Seconds after which a partial answer is returned, marked incomplete.  They count
  /// from the call that is given the request.
  double budget_seconds = std::numeric_limits<double>::infinity();
  /// Bytes that the answer itself may hold before a partial one is returned, marked
  /// incomplete: of its arrays, counted as it grows, so that where it stops depends on
  /// nothing but the question.  The process needs some times as much.
  std::size_t budget_bytes = std::numeric_limits<std::size_t>::max();
  /// Called from time to time with the stage of the work, such as "EV arcs", and the
  /// share of that stage done, in [0, 1]; may be empty.  Calls are serialised but may
  /// come from any thread.
  std::function<void(std::string_view stage, double share)> progress;
  /// A stop that is requested ends the work soon, with a partial answer.
  std::stop_token stop;
};

/// What ended the work before it was done.
enum class StoppedBy : std::uint8_t { Nothing, Seconds, Bytes, Request };

/// The budget ended, or a stop was requested, before there was anything to answer: while
/// a file was read, a scene or an index was made.  what() says in which stage.
class Stopped : public std::runtime_error {
 public:
  Stopped(std::string stage, double share);

  [[nodiscard]] const std::string& stage() const { return stage_; }
  /// The share of that stage that was done by then, in [0, 1].
  [[nodiscard]] double share() const { return share_; }

 private:
  std::string stage_;
  double share_;
};

}  // namespace sightline
