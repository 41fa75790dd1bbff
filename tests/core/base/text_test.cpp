#include <gtest/gtest.h>

#include <string>
#include <type_traits>

#include "core/base/fixed_string.h"
#include "core/base/guest_id.h"

namespace dance {
namespace {

TEST(FixedString, HoldsUpToItsCapacityAndEndsWithANul) {
  FixedString<4> text;
  EXPECT_TRUE(text.empty());
  EXPECT_TRUE(text.assign("four"));
  EXPECT_EQ(text.view(), "four");
  EXPECT_EQ(std::string(text.c_str()), "four");
  EXPECT_TRUE(text.assign("ab"));
  EXPECT_EQ(std::string(text.c_str()), "ab");
  EXPECT_EQ(text.size(), 2u);
}

TEST(FixedString, RefusesWhatIsTooLongAndStaysAsItWas) {
  FixedString<4> text;
  ASSERT_TRUE(text.assign("keep"));
  EXPECT_FALSE(text.assign("fiver"));
  EXPECT_EQ(text.view(), "keep");
}

TEST(FixedString, TakesAnEmptyViewWithoutAddress) {
  FixedString<4> text;
  ASSERT_TRUE(text.assign("keep"));
  EXPECT_TRUE(text.assign(std::string_view()));
  EXPECT_TRUE(text.empty());
}

TEST(FixedString, ComparesAsItsTextDoes) {
  FixedString<8> a, b;
  ASSERT_TRUE(a.assign("abc"));
  ASSERT_TRUE(b.assign("abcd"));
  EXPECT_LT(a, b);
  EXPECT_FALSE(a == b);
  ASSERT_TRUE(b.assign("abc"));  // what stood behind the end must not count
  EXPECT_TRUE(a == b);
  EXPECT_TRUE(a == "abc");
}

TEST(GuestId, TakesEveryAllowedCharacterAtEveryLength) {
  const std::string allowed = "abcdefghijklmnopqrstuvwxyz0123456789-";
  for (std::size_t length = 1; length <= kMaxGuestIdLength; ++length) {
    const std::string text = allowed.substr(length % 13, length);
    const auto id = GuestId::parse(text);
    ASSERT_TRUE(id.has_value()) << text;
    EXPECT_EQ(id->view(), text);
    EXPECT_TRUE(id->is_set());
  }
}

TEST(GuestId, RefusesEveryOtherByte) {
  const std::string allowed = "abcdefghijklmnopqrstuvwxyz0123456789-";
  int refused = 0;
  for (int byte = 0; byte < 256; ++byte) {
    const char c = static_cast<char>(byte);
    const bool is_allowed = allowed.find(c) != std::string::npos;
    EXPECT_EQ(GuestId::parse(std::string("a") + c + "b").has_value(), is_allowed) << byte;
    if (!is_allowed) ++refused;
  }
  EXPECT_EQ(refused, 256 - 37);
}

TEST(GuestId, RefusesEmptyAndTooLong) {
  EXPECT_FALSE(GuestId::parse(""));
  EXPECT_FALSE(GuestId::parse(std::string(kMaxGuestIdLength + 1, 'a')));
  EXPECT_FALSE(GuestId().is_set());
}

TEST(GuestId, OrdersAsText) {
  EXPECT_LT(*GuestId::parse("alice"), *GuestId::parse("bob"));
  EXPECT_EQ(*GuestId::parse("bob"), *GuestId::parse("bob"));
  EXPECT_TRUE(std::is_trivially_copyable_v<GuestId>);
}

}  // namespace
}  // namespace dance
