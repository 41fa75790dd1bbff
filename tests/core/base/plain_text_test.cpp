// Tests which characters of a text from outside reach a terminal, a window or a log.
#include "core/base/text/plain_text.h"

#include <gtest/gtest.h>

#include <set>

namespace dance {
namespace {

std::string utf8(std::uint32_t code) {
  const auto tail = [&](int shift) { return static_cast<char>(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xc0 | code >> 6), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xe0 | code >> 12), tail(6), tail(0)};
  return {static_cast<char>(0xf0 | code >> 18), tail(12), tail(6), tail(0)};
}

// The characters of Unicode 15 with the property Bidi_Control.
constexpr std::array<std::uint32_t, 12> kBidiControls{
    0x061c, 0x200e, 0x200f, 0x202a, 0x202b, 0x202c, 0x202d, 0x202e, 0x2066, 0x2067, 0x2068, 0x2069};

// The category Cf of Unicode 15 without the visible signs (U+0600 to 0605, 06DD, 070F, 0890, 0891,
// 08E2, 110BD, 110CD) and the joiners U+200C and U+200D.
std::set<std::uint32_t> hidden_format_controls() {
  std::set<std::uint32_t> codes{0x00ad, 0x061c, 0x180e, 0x200b, 0x200e, 0x200f, 0xfeff, 0xe0001};
  const auto add = [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t code = first; code <= last; ++code) codes.insert(code);
  };
  add(0x202a, 0x202e);
  add(0x2060, 0x2064);
  add(0x2066, 0x206f);
  add(0xfff9, 0xfffb);
  add(0x13430, 0x1343f);
  add(0x1bca0, 0x1bca3);
  add(0x1d173, 0x1d17a);
  add(0xe0020, 0xe007f);
  return codes;
}

TEST(PlainText, RefusesAndReplacesEveryBidiControl) {
  for (const std::uint32_t code : kBidiControls) {
    EXPECT_FALSE(is_plain_text("a" + utf8(code) + "b")) << std::hex << code;
    EXPECT_EQ(plain_text("a" + utf8(code) + "b"), "a?b") << std::hex << code;
  }
}

TEST(PlainText, RefusesAndReplacesEveryControlAndFormatCharacter) {
  std::set<std::uint32_t> codes = hidden_format_controls();
  for (std::uint32_t code = 0; code < 0x20; ++code) codes.insert(code);
  for (std::uint32_t code = 0x7f; code < 0xa0; ++code) codes.insert(code);
  codes.insert({0x2028, 0x2029});
  for (const std::uint32_t code : codes) {
    EXPECT_FALSE(is_plain_text(utf8(code))) << std::hex << code;
    EXPECT_EQ(plain_text("a" + utf8(code) + "b"), "a?b") << std::hex << code;
  }
}

TEST(PlainText, KeepsEveryOtherCharacter) {
  const std::set<std::uint32_t> hidden = hidden_format_controls();
  std::size_t replaced = 0;
  for (std::uint32_t code = 0x20; code <= 0x10ffff; ++code) {
    if (code >= 0xd800 && code < 0xe000) continue;
    const std::string text = utf8(code);
    if (is_plain_text(text)) {
      EXPECT_EQ(plain_text(text), text);
      EXPECT_FALSE(hidden.contains(code)) << std::hex << code;
    } else {
      ++replaced;
    }
  }
  // DEL and C1, the two separators, unassigned neighbours of format controls, and those.
  EXPECT_LE(replaced, hidden.size() + 33 + 2 + 2 + 160);
  for (const char* text : {"Frühling in Havanna", "مرحبا", "שלום", "می\u200cخواهم", "क्\u200dष",
                           "👩\u200d🦰", "e\u0301", "日本"}) {
    EXPECT_TRUE(is_plain_text(text)) << text;
    EXPECT_EQ(plain_text(text), text);
  }
}

TEST(PlainText, ReplacesEachByteThatIsNoUtf8) {
  for (const auto& [text, plain] :
       std::vector<std::pair<std::string, std::string>>{{"\xff", "?"},
                                                        {"a\xc3", "a?"},
                                                        {"\xc0\x80", "??"},
                                                        {"\xed\xa0\x80", "???"},
                                                        {"\xf4\x90\x80\x80", "????"},
                                                        {"\xe2\x82 x", "?? x"},
                                                        {"\x1b[2J\nnext", "?[2J?next"}}) {
    EXPECT_FALSE(is_plain_text(text)) << plain;
    EXPECT_EQ(plain_text(text), plain);
    EXPECT_TRUE(is_plain_text(plain_text(text)));
  }
}

}  // namespace
}  // namespace dance
