#include "tunnel/policy/channel_rule.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

ChannelRule rule(std::string_view line) {
  auto parsed = ChannelRule::parse(line);
  EXPECT_TRUE(parsed) << line << ": " << parsed.error().what;
  return parsed ? *parsed : ChannelRule();
}

std::string rule_error_of(std::string_view line) {
  const auto parsed = ChannelRule::parse(line);
  EXPECT_FALSE(parsed) << line;
  return parsed ? "" : parsed.error().what;
}

TEST(ChannelRule, ReadsTheExamples) {
  const ChannelRule desk =
      rule("LIGHT/desk class=state size=400 rate=5 layout=n:i32,f32[n],string");
  EXPECT_TRUE(desk.pattern.matches("LIGHT/desk"));
  EXPECT_FALSE(desk.pattern.matches("LIGHT/desk2"));
  EXPECT_EQ(desk.kind, ChannelClass::kState);
  EXPECT_EQ(desk.max_bytes, 400u);
  EXPECT_EQ(desk.rate_hz, 5.0);
  EXPECT_TRUE(desk.is_in && desk.is_out);
  const ChannelRule arm = rule(
      "  ROBOT/arm   class=newest size=256 rate=60 layout=i64,f64[7] direction=out guest=bob ");
  EXPECT_EQ(arm.kind, ChannelClass::kNewest);
  EXPECT_EQ(arm.guest.view(), "bob");
  EXPECT_TRUE(arm.is_out);
  EXPECT_FALSE(arm.is_in);
  const std::vector<std::uint8_t> message(8 + 8 + 56);
  EXPECT_TRUE(arm.admits(message));
  EXPECT_FALSE(arm.admits(std::span(message).first(71)));
}

TEST(ChannelRule, SaysWhatIsWrongAndWhatToDo) {
  const auto expect_hint = [](std::string_view line, std::string_view hint) {
    const std::string error = rule_error_of(line);
    EXPECT_NE(error.find(hint), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  };
  expect_hint("", "say which channel");
  expect_hint("LIGHT/desk", "class=state");
  expect_hint("LIGHT/desk class=state", "say layout=");
  expect_hint("LIGHT/desk class=fast layout=i8", "state (the last one counts) or newest");
  expect_hint("LIGHT/desk class=state layout=i9", "i8 i16 i32 i64");
  expect_hint("LIGHT/desk class=state layout=any", "unchecked=yes");
  expect_hint("LIGHT/desk class=state layout=any direction=in", "unchecked=yes");
  expect_hint("LIGHT/desk class=state size=401 layout=i8", "up to 400");
  expect_hint("LIGHT/desk class=newest size=513 layout=i8", "up to 512");
  expect_hint("LIGHT/desk class=state size=-1 layout=i8", "a number of bytes");
  expect_hint("LIGHT/desk class=state size=0 layout=i8", "a number of bytes");
  expect_hint("LIGHT/desk class=state size=99999999999999999999999 layout=i8", "a number of bytes");
  expect_hint("LIGHT/desk class=state rate=nan layout=i8", "messages a second");
  expect_hint("LIGHT/desk class=state rate=1e9 layout=i8", "messages a second");
  expect_hint("LIGHT/desk class=state rate=21 layout=i8", "up to rate=20");
  expect_hint("LIGHT/desk class=state direction=up layout=i8", "out, in or both");
  expect_hint("LIGHT/desk class=state colour=red layout=i8", "\"colour\" is no word");
  expect_hint("LIGHT/desk class=state class=state layout=i8", "said twice");
  expect_hint("LIGHT/desk class=state layout", "key=value");
  expect_hint("LIGHT/desk class=state layout=i8 fingerprint=12", "16 hexadecimal digits");
  expect_hint("LIGHT/desk class=state layout=i8 unchecked=maybe", "yes or no");
  expect_hint("LIGHT/desk class=state layout=i8 guest=Bob", "a guest id is");
  expect_hint("POSE/capture/alice class=newest layout=i8", "own signals");
  expect_hint("BEAT/local class=newest layout=i8", "own signals");
  expect_hint("LIGHT//desk class=state layout=i8", "single slashes");
  expect_hint("LIGHT/.*/x class=state layout=i8", "* only at the end");
  expect_hint("L* class=state layout=i8", "whole first word");
  expect_hint("* class=state layout=i8", "say which channel");
  expect_hint("LIGHT/guest/bob class=state layout=i8", "no word \"guest\"");
  expect_hint("LIGHT/guest/* class=state layout=i8", "no word \"guest\"");
  expect_hint("LIGHT/guest class=state layout=i8", "no word \"guest\"");
  expect_hint("LIGHT/" + std::string(40, 'x') + " class=state layout=i8", "at most 32 characters");
}

TEST(ChannelRule, LetsUncheckedBytesInOnlyWhenToldSo) {
  EXPECT_TRUE(rule("LIGHT/desk class=state layout=any unchecked=yes").is_in);
  EXPECT_FALSE(rule("LIGHT/desk class=state layout=any direction=out").is_in);
}

TEST(ChannelRule, IsFoundByDirection) {
  const std::vector<ChannelRule> rules{rule("A/x class=state layout=i8 direction=in"),
                                       rule("A/* class=newest layout=i16 direction=out")};
  EXPECT_EQ(find_rule_in(rules, "A/x"), &rules[0]);
  EXPECT_EQ(find_rule_out(rules, "A/x"), &rules[1]);
  EXPECT_EQ(find_rule_in(rules, "A/y"), nullptr);
  EXPECT_TRUE(lets_any_in(rules));
  EXPECT_EQ(find_rule_out(rules, "B/y"), nullptr);
}

TEST(ChannelPattern, NeverMatchesWhatCameFromAnotherHouse) {
  const auto all = ChannelPattern::parse("LIGHT/*");
  ASSERT_TRUE(all);
  for (const char* name : {"LIGHT/desk", "LIGHT/a/b.c_d-e", "LIGHT/guests/x", "LIGHT/x/aguest"}) {
    EXPECT_TRUE(all->matches(name)) << name;
    const auto there = name_of_guest(name, *GuestId::parse("alice"));
    EXPECT_EQ(there.view(), std::string(name) + "/guest/alice");
    EXPECT_FALSE(all->matches(there.view())) << there.view();
    EXPECT_FALSE(is_foreign_name(there.view()));
  }
  for (const char* name : {"", "LIGHT", "LIGHT/", "LIGHT/guest", "LIGHT/a b", "LIGHTS/desk",
                           "LIGHT/\n", "POSE/stage/bob", "PACKED/POSE/stage/bob"})
    EXPECT_FALSE(all->matches(name)) << name;
  EXPECT_FALSE(all->matches(std::string(33, 'L')));
  const std::string longest(kMaxForeignName, 'x');
  EXPECT_EQ(name_of_guest(longest, *GuestId::parse(std::string(24, 'g'))).size(),
            kMaxChannelLength);
}

TEST(ChannelRule, AdmitsWithoutAllocation) {
  const ChannelRule arm = rule("ROBOT/* class=newest layout=n:i32,f64[n],string");
  const std::vector<std::uint8_t> message(64);
  const AllocationGuard guard;
  EXPECT_FALSE(arm.admits(message));
  EXPECT_TRUE(arm.pattern.matches("ROBOT/arm"));
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
