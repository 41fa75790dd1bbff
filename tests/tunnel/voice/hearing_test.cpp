// Whose voices a house wants, as it is written.
#include <gtest/gtest.h>

#include "tests/tunnel/voice/voices.h"
#include "tunnel/policy/hearing_wishes.h"

namespace dance {
namespace {

TEST(Hearing, IsEverybodyUnlessSaidOtherwise) {
  EXPECT_TRUE(hearing({}).hears(guest("bob")));
  EXPECT_FALSE(hearing({"bob=0"}).hears(guest("bob")));
  EXPECT_TRUE(hearing({"bob=0"}).hears(guest("ann")));
  EXPECT_FALSE(hearing({"default=0", "ann=1"}).hears(guest("bob")));
  EXPECT_TRUE(hearing({"ann=1", "default=0"}).hears(guest("ann")));
  EXPECT_TRUE(hearing({"ann=1"}).exceptions.empty()) << "nothing that is not so anyway";
  EXPECT_TRUE(hearing({"default=0", "bob=0"}).exceptions.empty());
}

TEST(Hearing, OfTwoIsWhatBothWantOrOneOfThem) {
  const std::vector<std::vector<std::string>> all{{},
                                                  {"ann=0"},
                                                  {"ann=0", "bob=0"},
                                                  {"default=0"},
                                                  {"default=0", "ann=1"},
                                                  {"default=0", "bob=1", "carla=1"}};
  for (const auto& one : all)
    for (const auto& other : all)
      for (const char* name : {"ann", "bob", "carla", "dora"}) {
        const bool is_first = hearing(one).hears(guest(name));
        const bool is_second = hearing(other).hears(guest(name));
        EXPECT_EQ(both_of(hearing(one), hearing(other)).hears(guest(name)), is_first && is_second)
            << name;
        EXPECT_EQ(either_of(hearing(one), hearing(other)).hears(guest(name)), is_first || is_second)
            << name;
      }
}

HearingWish wish_of(const std::string& name, bool hears_others,
                    const std::vector<std::string>& names = {}) {
  HearingWish wish;
  wish.listener = guest(name);
  wish.hears_others = hears_others;
  for (std::size_t i = 0; i < names.size(); ++i) wish.guests[i] = guest(names[i]);
  return wish;
}

TEST(HearingWishes, OfTwoGuestsInOneHouseDoNotReplaceEachOther) {
  HearingWishes wishes;
  const Hearing everybody, no_eve = hearing({"eve=0"});
  const MonoTime begin = MonoTime::from_us(1'000'000);
  EXPECT_FALSE(wishes.within(no_eve).hears(guest("eve"))) << "before anybody says so";
  EXPECT_TRUE(wishes.within(everybody).hears(guest("bob")));
  for (int second = 0; second < 10; ++second) {
    const MonoTime now = begin + Duration::s(second);
    // ann mutes bob and carla, dan mutes bob and is the one who hears carla.
    for (const auto& wish :
         {wish_of("ann", true, {"bob", "carla"}), wish_of("dan", false, {"carla", "eve"})}) {
      wishes.hear(wish, now);
      if (second == 0) continue;
      EXPECT_FALSE(wishes.within(everybody).hears(guest("bob"))) << "neither wants it";
      EXPECT_TRUE(wishes.within(everybody).hears(guest("carla"))) << "dan wants it";
      EXPECT_TRUE(wishes.within(everybody).hears(guest("fay"))) << "ann wants it";
      EXPECT_FALSE(wishes.within(no_eve).hears(guest("eve"))) << "the house lets her not in";
    }
  }
}

TEST(HearingWishes, HoldWhileTheyAreSaidAndEndOneByOne) {
  HearingWishes wishes;
  const Hearing everybody;
  const MonoTime begin = MonoTime::from_us(1'000'000);
  wishes.hear(wish_of("ann", true, {"bob"}), begin);
  wishes.hear(wish_of("dan", false), begin + Duration::s(2));
  EXPECT_FALSE(wishes.expire(begin + HearingWishes::kHolds));
  EXPECT_TRUE(wishes.within(everybody).hears(guest("eve")));
  EXPECT_TRUE(wishes.expire(begin + HearingWishes::kHolds + Duration::ms(1))) << "ann's";
  EXPECT_FALSE(wishes.within(everybody).hears(guest("eve"))) << "dan is deafened";
  EXPECT_TRUE(wishes.expire(begin + HearingWishes::kHolds + Duration::s(3)));
  EXPECT_TRUE(wishes.within(everybody).hears(guest("bob")));
  EXPECT_FALSE(wishes.expire(begin + Duration::s(60)));
}

TEST(HearingWishes, KeepABoundedNumberAndTakeMoreOnceThereIsRoom) {
  HearingWishes wishes;
  const Hearing everybody;
  MonoTime now = MonoTime::from_us(1'000'000);
  for (std::size_t i = 0; i < HearingWishes::kMostGuests; ++i)
    wishes.hear(wish_of("g" + std::to_string(i), false), now);
  wishes.hear(wish_of("ann", false, {"bob"}), now);
  EXPECT_FALSE(wishes.within(everybody).hears(guest("bob")));
  now = now + HearingWishes::kHolds + Duration::ms(1);
  wishes.hear(wish_of("ann", false, {"bob"}), now);
  EXPECT_TRUE(wishes.within(everybody).hears(guest("bob")));
  EXPECT_FALSE(wishes.within(everybody).hears(guest("eve")));
}

TEST(Hearing, SaysWhichWordIsWrongAndHowToWriteIt) {
  const auto error_of = [](const std::vector<std::string>& words) {
    const auto parsed = parse_hearing(words);
    return parsed ? std::string("none") : parsed.error().what;
  };
  for (const char* word : {"bob", "bob=", "bob=2", "bob=yes", "=", "default"})
    EXPECT_NE(error_of({word}).find("'" + std::string(word) + "': write NAME=1"), std::string::npos)
        << error_of({word});
  EXPECT_NE(error_of({"Bob=1"}).find("'Bob=1'"), std::string::npos);
  EXPECT_NE(error_of({"bob=1", "bob=0"}).find("bob is given twice"), std::string::npos);
  EXPECT_NE(error_of({"default=1", "default=1"}).find("default is given twice"), std::string::npos);
  std::vector<std::string> many;
  for (std::size_t i = 0; i <= kMaxInterestGuests; ++i)
    many.push_back("g" + std::to_string(i) + "=0");
  EXPECT_NE(error_of(many).find("at most 128 guests"), std::string::npos);
}

}  // namespace
}  // namespace dance
