// Questions that come as a JSON file instead of a scene, read with errors of one line
// that name the file and the element.  Numbers are kept as the doubles written.

#pragma once

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "linespace/scene.h"

namespace sightline::viewers {

/// A value of a question's file that knows where it stands, as "segments[3][0]".  Cheap
/// to copy; all parts share the document.  What a member function does not accept it
/// refuses by throwing InvalidInput: "FILE: segments[3][0]: expected three finite
/// numbers".
class JsonInput {
 public:
  /// Reads and parses the whole file, or standard input for "-".  Throws InvalidInput
  /// when read_whole does, it is larger than kLargestFile, or no JSON (says where and
  /// why).
  explicit JsonInput(const std::string& file);
  static constexpr std::size_t kLargestFile = std::size_t{1} << 30;
  /// Parses the bytes of a file of that name.  Throws InvalidInput when they are no JSON.
  JsonInput(std::string file, std::string_view bytes);

  /// Whether this object has a member of that name.  Refuses what is no object.
  [[nodiscard]] bool has(std::string_view key) const;
  /// The member of that name.  Refuses what is no object or has none.
  [[nodiscard]] JsonInput at(std::string_view key) const;
  /// The items of an array.  Refuses anything else.
  [[nodiscard]] std::vector<JsonInput> items() const;
  /// Three numbers that is_admissible accepts.
  [[nodiscard]] Point point() const;
  /// Three coordinates, each a number or a string, as text; a number's text is the
  /// shortest that reads as the same double.  What the strings say is not checked.
  [[nodiscard]] std::array<std::string, 3> coordinates() const;
  /// An array of points, at least so many.
  [[nodiscard]] std::vector<Point> points(std::size_t least) const;
  /// An array of exactly two points, which differ.
  [[nodiscard]] std::array<Point, 2> two_points() const;

  [[nodiscard]] bool is_null() const;
  /// A whole number from 0 on that an int holds.
  [[nodiscard]] int whole_number() const;

  /// A string.
  [[nodiscard]] std::string text() const;

  /// "FILE: segments[3][0]".
  [[nodiscard]] std::string told() const;
  /// Throws InvalidInput with this message about this element.
  [[noreturn]] void refuse(std::string_view message) const;

 private:
  struct Document {
    std::string file;
    nlohmann::json root;
  };
  JsonInput(std::shared_ptr<const Document> document, const nlohmann::json& value,
            std::string where);

  std::shared_ptr<const Document> document_;
  const nlohmann::json* value_;
  std::string where_;
};

}  // namespace sightline::viewers
