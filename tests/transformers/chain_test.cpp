#include "transformers/chain.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(ParseDuration, TakesTheUnitsPeopleWrite) {
  EXPECT_EQ(parse_duration("20ms").value(), Duration::ms(20));
  EXPECT_EQ(parse_duration("1.5s").value(), Duration::ms(1500));
  EXPECT_EQ(parse_duration("800us").value(), Duration::us(800));
  EXPECT_EQ(parse_duration("0ms").value(), Duration());
}

TEST(ParseDuration, RefusesWhatIsNoLengthOfTime) {
  for (const char* text :
       {"", "20", "ms", "20 ms", "20m", "nanms", "infs", "1e9s", "--3ms", "20msx"})
    EXPECT_FALSE(parse_duration(text)) << text;
}

TEST(Chain, WithoutStationsPassesThrough) {
  const auto chain = Chain::make({});
  ASSERT_TRUE(chain);
  EXPECT_TRUE(chain->is_pass_through());
}

TEST(Chain, NamesTheWordItDoesNotKnowAndThoseItDoes) {
  const auto chain = Chain::make({"hodl 20ms"});
  ASSERT_FALSE(chain);
  EXPECT_NE(chain.error().what.find("hodl 20ms"), std::string::npos);
  EXPECT_NE(chain.error().what.find("hold"), std::string::npos);
}

TEST(Chain, RefusesArgumentsThatMakeNoSense) {
  for (const char* text : {"hold 20ms 30ms", "hold -5ms", "hold 3s", "", "   "})
    EXPECT_FALSE(Chain::make({text})) << text;
}

TEST(Chain, AHoldWithoutATimeFindsItsOwn) { EXPECT_TRUE(Chain::make({"hold"})); }

TEST(Chain, TakesManyBlanks) { EXPECT_TRUE(Chain::make({"  hold   20ms  "})); }

}  // namespace
}  // namespace dance
