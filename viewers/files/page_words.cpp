#include "viewers/files/page_words.h"

#include <fmt/format.h>

namespace sightline::viewers {

std::string grouped(std::int64_t n) {
  const std::string digits = std::to_string(n);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const bool between_digits = i > 0 && digits[i - 1] != '-';
    if (between_digits && (digits.size() - i) % 3 == 0) out += "&#8239;";
    out += digits[i];
  }
  return out;
}

std::string card(const std::string& number, const std::string& what) {
  return fmt::format("<div class=card><b>{}</b>{}</div>\n", number, what);
}

std::string bar(double fraction, const std::string& colour) {
  return fmt::format("<td class=bar><i style=\"width:{:.1f}%;background:{}\"></i></td>",
                     100 * fraction, colour);
}

std::string figure(const PagePicture& picture) {
  return fmt::format(
      "<figure><a href=\"{}\"><img alt=\"{}\" src=\"data:image/png;base64,{}\"></a>"
      "<figcaption><b>{}</b><br>{}</figcaption></figure>\n",
      html_escaped(picture.file), html_escaped(picture.title), base64(picture.png),
      html_escaped(picture.title), picture.caption);
}

}  // namespace sightline::viewers
