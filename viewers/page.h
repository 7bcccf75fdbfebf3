// The HTML page of `sightline analyse`: one file that needs nothing else.

#pragma once

#include <string>
#include <vector>

#include "viewers/answer.h"

namespace sightline::viewers {

/// A picture for the page.
struct PagePicture {
  std::string file;  ///< name beside the page, for the link
  std::string png;   ///< the file's bytes, inlined
  std::string title;
  std::string caption;  ///< HTML
};

/// The page for a report.json of `analyse`: pictures of the skeleton, the first of them
/// large, of views, and of the scene under its light.  All are inlined.
[[nodiscard]] std::string report_page(const Json& report,
                                      const std::vector<PagePicture>& pictures,
                                      const std::vector<PagePicture>& views = {},
                                      const std::vector<PagePicture>& light = {});

/// RFC 4648.
[[nodiscard]] std::string base64(const std::string& bytes);

/// With & < > " replaced, for text and attribute values; valid UTF-8 (escaped_bytes).
[[nodiscard]] std::string html_escaped(const std::string& text);

}  // namespace sightline::viewers
