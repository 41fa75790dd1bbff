// Tests which texts are valid shown names, and which are refused.
#include "core/base/text/shown_name.h"

#include <gtest/gtest.h>

#include <string>

namespace dance {
namespace {

TEST(ShownName, AcceptsCapitalsSpacesUmlautsAndOtherScripts) {
  for (const char* text : {"Ana", "Zo\u00eb d\u2019\u00c5ngstr\u00f6m", "J\u00fcrgen M\u00fcller",
                           "Ana Luc\u00eda (2)", "\u821e\u8e48", "\u0410\u043b\u0451\u043d\u0430",
                           "\U0001f483 Bob", "\u0646\u06cc\u06a9\u200c\u06cc"})
    EXPECT_EQ(parse_shown_name(text)->view(), text);
}

TEST(ShownName, LeavesOutBlanksAtItsEnds) {
  EXPECT_EQ(parse_shown_name("  Ana Luc\u00eda\u00a0\u3000")->view(), "Ana Luc\u00eda");
  EXPECT_EQ(parse_shown_name("\u200dAna")->view(), "Ana");
}

TEST(ShownName, AcceptsFortyBytesAndNoMore) {
  EXPECT_EQ(parse_shown_name(std::string(40, 'x'))->size(), 40u);
  EXPECT_FALSE(parse_shown_name(std::string(41, 'x')));
  EXPECT_FALSE(parse_shown_name("\u00eb" + std::string(39, 'x')));
  EXPECT_EQ(parse_shown_name(std::string(60, ' ') + "Ana")->view(), "Ana");
}

TEST(ShownName, RefusesInvisibleAndControlCharacters) {
  for (const std::string text :
       {"", " ", "\u3164", "\u2800\u200b", "\u115f \u00a0", "Ana\nBob", "\x1b[2J", "A\u202enA",
        "a\u2066b", "Ana\u200f", "\xff", "\xc3", "\xed\xa0\x80", "\xc0\x80", "\x7f"})
    EXPECT_FALSE(parse_shown_name(text)) << text;
  EXPECT_FALSE(parse_shown_name(std::string_view("Ana\0Bob", 7)));
}

// Each prefix of a name, and the name with any single bit flipped, is either refused or valid.
TEST(ShownName, ParsesDamagedNamesOnlyToValidOnes) {
  const std::string name = "Zo\u00eb d\u2019\u00c5ngstr\u00f6m \u821e";
  const auto check = [](std::string_view text) {
    const auto parsed = parse_shown_name(text);
    if (!parsed) return;
    EXPECT_TRUE(is_plain_text(parsed->view()));
    EXPECT_EQ(parse_shown_name(parsed->view()), parsed);
  };
  for (std::size_t end = 0; end <= name.size(); ++end) check(name.substr(0, end));
  for (std::size_t bit = 0; bit < name.size() * 8; ++bit) {
    std::string damaged = name;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    check(damaged);
  }
}

}  // namespace
}  // namespace dance
