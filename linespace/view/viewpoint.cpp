// Viewpoints from numbers and from text.

#include <charconv>
#include <cmath>

#include "linespace/numbers/exact_position.h"
#include "linespace/visibility_map.h"

namespace sightline {

using namespace internal;

namespace {

// "-12" or "12": what a fraction is made of.
bool is_integer(std::string_view text) {
  if (!text.empty() && text.front() == '-') text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

Rational coordinate(const std::string& text) {
  const auto refuse = [&]() -> Rational {
    std::string message("'");
    throw InvalidInput(
        message.append(text).append("' is no coordinate: a number or a fraction p/q"));
  };
  if (const auto slash = text.find('/'); slash != std::string::npos) {
    const std::string p = text.substr(0, slash), q = text.substr(slash + 1);
    if (!is_integer(p) || !is_integer(q)) return refuse();
    const boost::multiprecision::mpz_int whole(q);
    if (whole == 0) return refuse();
    return Rational(boost::multiprecision::mpz_int(p)) / Rational(whole);
  }
  double x = 0;
  const char* end = text.data() + text.size();
  const char* begin =
      text.data() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0);
  const auto [stop, error] = std::from_chars(begin, end, x);
  if (error != std::errc{} || stop != end || !std::isfinite(x)) return refuse();
  return Rational(x);
}

}  // namespace

Viewpoint eye_at(const Point& eye) {
  return {Viewpoint::Kind::Eye, exact_position(exact_point(eye))};
}

Viewpoint eye_far_along(const Point& direction) {
  if (direction == Point::Zero()) throw InvalidInput("a direction must not be 0,0,0");
  return {Viewpoint::Kind::Direction, exact_position(exact_point(direction))};
}

Viewpoint viewpoint(Viewpoint::Kind kind, const std::array<std::string, 3>& coordinates) {
  ExactPoint p;
  for (int i = 0; i < 3; ++i) p[i] = coordinate(coordinates[i]);
  if (kind == Viewpoint::Kind::Direction && p == ExactPoint{}) {
    throw InvalidInput("a direction must not be 0,0,0");
  }
  return {kind, exact_position(p)};
}

}  // namespace sightline
