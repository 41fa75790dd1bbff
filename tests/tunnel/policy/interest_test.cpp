#include "tunnel/policy/interest.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dance {
namespace {

int divider_of(const Result<Interest>& interest, const char* name) {
  return interest ? interest->divider_of(*GuestId::parse(name)) : -1;
}

TEST(InterestRule, IsWrittenByName) {
  const auto some =
      parse_interest(std::vector<std::string>{"alice=1", "default=2", "bob=0", "c=255"});
  EXPECT_EQ(divider_of(some, "alice"), 1);
  EXPECT_EQ(divider_of(some, "bob"), 0);
  EXPECT_EQ(divider_of(some, "c"), 255);
  EXPECT_EQ(divider_of(some, "dora"), 2);
  EXPECT_EQ(divider_of(parse_interest({}), "dora"), 1) << "who says nothing wants all";
}

TEST(InterestRule, ErrorsQuoteTheWrongWordAndNoOption) {
  for (const char* wrong : {"", "alice", "alice=", "alice=-1", "alice=256", "alice=1x", "=1",
                            "Alice=1", "default=x", "alice = 1", "alice=99999999999"}) {
    const auto refused = parse_interest(std::vector<std::string>{wrong});
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().what.rfind("'" + std::string(wrong) + "': ", 0), 0u)
        << refused.error().what;
    EXPECT_EQ(refused.error().what.find("--"), std::string::npos) << refused.error().what;
  }
  EXPECT_FALSE(parse_interest(std::vector<std::string>{"a=1", "a=2"}));
  EXPECT_FALSE(parse_interest(std::vector<std::string>{"default=1", "default=1"}));
}

TEST(InterestRule, RefusesMoreGuestsThanItsBound) {
  std::vector<std::string> words{"default=0"};
  for (std::size_t i = 0; i < kMaxInterestGuests; ++i)
    words.push_back("g" + std::to_string(i) + "=1");
  EXPECT_EQ(divider_of(parse_interest(words), "g127"), 1);
  words.push_back("one-more=1");
  const auto refused = parse_interest(words);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what,
            "'one-more=1': at most 128 guests can be named; default=N is for all others");
}

}  // namespace
}  // namespace dance
