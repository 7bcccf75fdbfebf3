// What the readers share: a file in memory, and strict scanning of text.

#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "linespace/mesh_io.h"
#include "linespace/work/stage.h"

namespace sightline::internal {

/// One line that names file and line.
[[noreturn]] void refuse(const std::string& path, const std::string& message);
[[noreturn]] void refuse_line(const std::string& path, std::size_t line,
                              const std::string& message);

/// The bytes of a file that is not empty.
[[nodiscard]] std::string load_file(const std::string& path, Stage& stage);

/// The text without the UTF-8 byte order mark that editors of Windows put before it.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// Walks over the lines of a text; `\r\n` and `\r` end a line as `\n` does.
class LineReader {
 public:
  LineReader(const std::string& path, std::string_view text, Stage& stage,
             std::size_t first_line = 1)
      : path_(path),
        stage_(stage),
        rest_(text),
        size_(text.size()),
        next_number_(first_line) {}

  /// Moves on to the next line; false at the end of the text.
  bool next();
  /// Moves on to the next line that has a token when everything from `comment` on is
  /// left out; false at the end of the text.
  bool next_filled(char comment = '\n');

  /// Number of the current line.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// The rest of the current line, surrounding blanks removed.
  [[nodiscard]] std::string_view rest() const;
  /// Bytes after the current line.
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }

  /// Leaves out the rest of the current line from the first `comment` on.
  void cut_at(char comment) { line_ = line_.substr(0, line_.find(comment)); }

  /// Passes over the next characters of the line that are no surrounding blanks.
  void pass(std::size_t characters);
  /// The next token of the line, empty at its end.
  std::string_view token();
  /// A finite number; refuses anything else, naming `what`.
  double number(const char* what);
  /// Passes over any number, one that is not finite or does not fit included; refuses
  /// anything else, naming `what`.
  void skip_number(const char* what);
  /// A whole number that fits; refuses anything else, naming `what`.
  long long integer(const char* what);
  /// Requires that the line has no further token.
  void end_of_line();

  [[noreturn]] void refuse(const std::string& message) const {
    refuse_line(path_, number_, message);
  }

 private:
  const std::string& path_;
  Stage& stage_;
  std::string_view rest_, line_;
  std::size_t size_;  // of the whole text
  std::size_t next_number_, number_ = 0;
};

/// The whole token as a finite double; nullopt otherwise.
[[nodiscard]] std::optional<double> parse_double(std::string_view token);
[[nodiscard]] std::optional<long long> parse_integer(std::string_view token);

/// Whether the token is a number in any spelling that is met: "1e999", "inf", "-nan(ind)"
/// and what Microsoft's library wrote for these ("-1.#IND", "1.#QNAN", "1.#INF").
[[nodiscard]] bool is_number(std::string_view token);

/// A message of a library as one line of at most 200 characters.
[[nodiscard]] std::string one_line(std::string text);

/// A token or line as it may stand in a message: printable, shortened.
[[nodiscard]] std::string quoted(std::string_view text);

/// The triangle that the last corner of a strip adds, if it adds any: corners that are
/// repeated to join strips make none.
void append_strip_triangle(std::vector<std::vector<int>>& polygons,
                           std::span<const int> strip);

[[nodiscard]] PolygonSoup read_obj(const std::string& path, std::string_view text,
                                   Stage& stage);
[[nodiscard]] PolygonSoup read_off(const std::string& path, std::string_view text,
                                   Stage& stage);
[[nodiscard]] PolygonSoup read_ply(const std::string& path, std::string_view bytes,
                                   Stage& stage);
[[nodiscard]] MeshFile read_gltf(const std::string& path, std::string_view bytes,
                                 Stage& stage);
[[nodiscard]] PolygonSoup read_stl(const std::string& path, std::string_view bytes,
                                   Stage& stage);

/// Whether IFC 2x3 has an entity or a type of that name, in capital letters.
[[nodiscard]] bool is_ifc_name(std::string_view name);

/// Refuses an IFC file that ends early, is no text, names records that it lacks, or has
/// records of a name that IFC 2x3 does not have: assimp would leave those out.
void check_step(const std::string& path, std::string_view text, Stage& stage);

/// Refuses a Collada file whose positions have columns for some of x, y and z only.
void check_collada(const std::string& path, std::string_view text, Stage& stage);

/// A file that assimp is to read.
struct AssimpFile {
  const std::string& path;  ///< or its name in messages
  const std::string& bytes;
  const std::string& format;  ///< of assimp_extensions
  bool by_name;               ///< assimp opens it itself, and what it refers to
};
[[nodiscard]] PolygonSoup read_with_assimp(const AssimpFile& file, Stage& stage);
[[nodiscard]] std::vector<std::string> assimp_extensions();

}  // namespace sightline::internal
