// Reading in a process of its own, for reader libraries that may crash or never end.

#pragma once

#include <functional>
#include <string>

#include "linespace/files/mesh_io.h"

namespace sightline::internal {

/// What `read` gives, called in a child process (fork).  Throws what `read` throws of
/// InvalidInput; InvalidInput that names `path` when the child crashes, takes more than
/// 10 s of processor time and 10 s for each megabyte of `bytes`, or needs more than 1 GiB
/// and 1 KiB for each of `bytes`.  Calls `check` every 50 ms: what it throws ends the
/// child and goes on to the caller.  The child is gone afterwards, whatever happened.
///
/// The child has this thread only.  A lock that another thread holds stays locked in it
/// for ever: such a child waits, and counts as one that does not end after ten times as
/// many seconds of the clock.  So call this before other threads work.
[[nodiscard]] PolygonSoup read_in_child(const std::string& path, std::size_t bytes,
                                        const std::function<void()>& check,
                                        const std::function<PolygonSoup()>& read);

}  // namespace sightline::internal
