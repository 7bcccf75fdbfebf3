#include "viewers/json_text.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace sightline::viewers {
namespace {

// A second opinion: nlohmann's own writer throws on what is not UTF-8.
bool is_utf8(const std::string& text) {
  try {
    (void)Json(text).dump();
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

std::string random_name(std::mt19937& random) {
  const std::array pieces{"\xFC",
                          "\xC3\xBC",
                          "\\",
                          "\\x",
                          "x",
                          "FC",
                          "C3",
                          "\\xFC",
                          "\\x5C",
                          "\\xfc",
                          "\xED\xA0\x80",
                          "\xC0\xAF",
                          "\xF4\x90\x80\x80",
                          "\xE2\x82\xAC",
                          "\xF0\x9F\x9A\xAA",
                          "\xE2\x82",
                          "\x80",
                          "a",
                          "\x01"};
  std::string name;
  for (std::size_t n = random() % 6; n > 0; --n) {
    if (random() % 4 == 0) {
      name += static_cast<char>(random() % 256);
    } else {
      name += pieces[random() % pieces.size()];
    }
  }
  return name;
}

TEST(JsonText, EscapesOnlyBytesThatAreNoUtf8) {
  EXPECT_EQ(escaped_bytes("T\xFCr"), "T\\xFCr");
  EXPECT_EQ(escaped_bytes("T\xC3\xBCr"), "T\xC3\xBCr");
  EXPECT_EQ(escaped_bytes("C:\\walls"), "C:\\walls");
  EXPECT_EQ(escaped_bytes("T\\xFCr"), "T\\x5CxFCr");
  EXPECT_EQ(json_text({{"name", "T\xFCr"}}), R"({"name":"T\\xFCr"})");
  EXPECT_EQ(json_text({{"T\xFCr", {1, 2}}}), R"({"T\\xFCr":[1,2]})");
}

TEST(JsonText, IsUtf8AndDifferentNamesStayDifferent) {
  std::mt19937 random(1);
  std::map<std::string, std::string> name_of;
  for (int i = 0; i < 20000; ++i) {
    const std::string name = random_name(random);
    const std::string text = escaped_bytes(name);
    EXPECT_TRUE(is_utf8(text)) << text;
    EXPECT_EQ(unescaped_bytes(text), name) << text;
    const auto [entry, is_new] = name_of.emplace(text, name);
    EXPECT_EQ(entry->second, name) << text;
    const Json read = Json::parse(json_text({name, {{name, 1}}}, i % 3 - 1));
    EXPECT_EQ(read[0], text);
    EXPECT_TRUE(read[1].contains(text));
    if (is_utf8(name) && name.find("\\x") == std::string::npos) EXPECT_EQ(text, name);
  }
}

}  // namespace
}  // namespace sightline::viewers
