// The program as a process: its standard streams, its signals, and how it ends when it
// cannot go on.

#pragma once

#include <string>

namespace sightline::viewers {

/// To be called first in main.
/// - A closed standard stream is given to /dev/null, so that no file gets its number;
///   writing to standard output then fails, as it should.
/// - SIGPIPE and SIGXFSZ are ignored: the write that fails tells of it.
/// - An exception that nobody can catch ends the program with one line and status 1,
///   temporary files removed.
void prepare_process();

/// Why not all of standard output could be written, or an empty text.
[[nodiscard]] std::string standard_output_error();

/// One line on standard error, "sightline: MESSAGE", whatever the message holds.
void tell_error(std::string message);

}  // namespace sightline::viewers
