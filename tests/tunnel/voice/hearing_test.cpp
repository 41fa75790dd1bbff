// Whose voices a house wants, as it is written.
#include <gtest/gtest.h>

#include "tests/tunnel/voice/voices.h"

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

TEST(Hearing, OfTwoIsWhatBothWant) {
  const std::vector<std::vector<std::string>> all{{},
                                                  {"ann=0"},
                                                  {"ann=0", "bob=0"},
                                                  {"default=0"},
                                                  {"default=0", "ann=1"},
                                                  {"default=0", "bob=1", "carla=1"}};
  for (const auto& one : all)
    for (const auto& other : all)
      for (const char* name : {"ann", "bob", "carla", "dora"})
        EXPECT_EQ(both_of(hearing(one), hearing(other)).hears(guest(name)),
                  hearing(one).hears(guest(name)) && hearing(other).hears(guest(name)))
            << name;
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
