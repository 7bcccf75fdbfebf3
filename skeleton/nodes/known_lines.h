// Contacts of lines that were listed before.  Where much is in line, one line is the end
// of many arcs, and is asked for by each.

#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "linespace/lines/line_name.h"
#include "linespace/numbers/rational.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {

/// Keeps the lines asked for lately, so one per thread; what is answered does not depend
/// on which they are.
class KnownLines {
 public:
  /// Asks about the line through two points: what was kept of it, if both points are on
  /// its free part; else null.
  [[nodiscard]] const NodeContacts* find(const std::array<ExactPoint, 2>& line);
  [[nodiscard]] const LineName& name() const { return name_; }  ///< last asked for
  /// Keeps contacts of the line last asked for that have a free part.
  void keep(const NodeContacts& contacts);

 private:
  struct Part {
    Rational from, to;  // by the coordinate axis_
    NodeContacts contacts;
  };
  std::unordered_map<LineName, std::vector<Part>> parts_;
  // The line last asked for; the first coordinate that changes along it.
  LineName name_;
  std::array<Rational, 2> at_;
  int axis_ = 0;
};

}  // namespace sightline::internal
