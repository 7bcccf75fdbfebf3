// A look at an IFC file's STEP syntax (ISO 10303-21) before assimp reads it: that reader
// follows references to records that are not there, and does not survive it; and it
// leaves records out whose name it does not know.

#include <algorithm>

#include "linespace/files/mesh_io.h"

namespace sightline::internal {
namespace {

constexpr std::string_view kFirstWord = "ISO-10303-21;";
constexpr std::string_view kLastWord = "END-ISO-10303-21;";

class StepChecker {
 public:
  StepChecker(const std::string& path, std::string_view text, Stage& stage)
      : path_(path), stage_(stage), text_(text) {}

  void run() {
    skip_blanks();
    if (!text_.substr(at_).starts_with(kFirstWord)) refuse_here("no STEP header");
    // Statements of the header and of the data alike end with a semicolon.
    while (!text_.substr(at_).starts_with(kLastWord)) {
      stage_.at(at_, text_.size());
      check_statement();
      skip_blanks();
      if (at_ >= text_.size()) refuse_here("ends before END-ISO-10303-21");
    }
    std::sort(defined_.begin(), defined_.end());
    for (const auto& [id, line] : used_) {
      if (!std::binary_search(defined_.begin(), defined_.end(), id)) {
        refuse_line(path_, line, "names #" + std::to_string(id) + ", which is not there");
      }
    }
  }

 private:
  // Up to the next semicolon outside strings; brackets must balance.
  void check_statement() {
    int depth = 0;
    const bool is_record = text_[at_] == '#';
    if (is_record) {
      defined_.push_back(reference());
      skip_blanks();
      if (at_ >= text_.size() || text_[at_] != '=') refuse_here("'=' expected");
      advance();
      skip_blanks();
      check_name();
    }
    for (; at_ < text_.size(); advance()) {
      const char c = text_[at_];
      if (c == ';') {
        if (depth != 0) refuse_here("a bracket is not closed");
        advance();
        return;
      }
      if (c == '(') ++depth;
      if (c == ')' && --depth < 0) refuse_here("a bracket too many");
      if (c == '\'') skip_string();
      if (c == '#') {
        const std::size_t line = line_;
        used_.emplace_back(reference(), line);
        --at_;  // the loop moves on
      }
      if (static_cast<unsigned char>(c) < ' ' && !is_blank(c)) {
        refuse_here("a character that is no text");
      }
    }
    refuse_here("ends inside a statement");
  }

  // The name of a record; a bracket instead begins a record of several names.
  void check_name() {
    std::size_t end = at_;
    while (end < text_.size() && text_[end] != '(' && !is_blank(text_[end])) ++end;
    const std::string_view name = text_.substr(at_, end - at_);
    if (!name.empty() && !is_ifc_name(name)) {
      refuse_here("no entity of IFC 2x3: " + quoted(name));
    }
  }

  long long reference() {
    std::size_t end = at_ + 1;
    while (end < text_.size() && text_[end] >= '0' && text_[end] <= '9') ++end;
    const auto id = parse_integer(text_.substr(at_ + 1, end - at_ - 1));
    if (!id) refuse_here("'#' without a number");
    at_ = end;
    return *id;
  }

  // From the opening to the closing quote; a doubled one reads as two strings.
  void skip_string() {
    advance();
    while (at_ < text_.size() && text_[at_] != '\'') advance();
    if (at_ >= text_.size()) refuse_here("ends inside a string");
  }

  void skip_blanks() {
    for (;;) {
      while (at_ < text_.size() && is_blank(text_[at_])) advance();
      if (!text_.substr(at_).starts_with("/*")) return;
      const std::size_t end = text_.find("*/", at_ + 2);
      if (end == std::string_view::npos) refuse_here("ends inside a comment");
      while (at_ < end + 2) advance();
    }
  }

  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  void advance() {
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }

  [[noreturn]] void refuse_here(const std::string& message) const {
    refuse_line(path_, line_, message);
  }

  const std::string& path_;
  Stage& stage_;
  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
  std::vector<long long> defined_;
  std::vector<std::pair<long long, std::size_t>> used_;  // number, line
};

}  // namespace

void check_step(const std::string& path, std::string_view text, Stage& stage) {
  StepChecker(path, text, stage).run();
}

}  // namespace sightline::internal
