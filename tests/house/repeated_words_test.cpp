#include "house/program/repeated_words.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(RepeatedWords, OfStartAfterStartOnlyWhatIsNewIsShown) {
  RepeatedWords words;
  words.start();
  EXPECT_TRUE(words.is_new("dance voice: no sound server"));
  words.start();
  EXPECT_FALSE(words.is_new("dance voice: no sound server"));
  EXPECT_TRUE(words.is_new("dance voice: no microphone")) << "another trouble";
  words.start();
  EXPECT_TRUE(words.is_new("12:00:00.000 voice: alice is heard")) << "it works again";
  EXPECT_TRUE(words.is_new("12:00:05.000 voice: alice is muted"));
  EXPECT_TRUE(words.is_new("12:00:06.000 voice: alice is heard")) << "said twice in one start";
  words.start();
  EXPECT_FALSE(words.is_new("13:00:00.000 voice: alice is heard")) << "but for the time";
  words.forget();
  EXPECT_TRUE(words.is_new("dance voice: no sound server")) << "it had worked";
}

TEST(RepeatedWords, AreBoundedAndATimeIsOnlyAWholeOne) {
  RepeatedWords words;
  words.start();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(words.is_new("line " + std::to_string(i)));
  words.start();
  EXPECT_FALSE(words.is_new("line 15"));
  EXPECT_TRUE(words.is_new("line 99")) << "more than are kept";
  words.start();
  EXPECT_TRUE(words.is_new("12:34:5"));
  EXPECT_TRUE(words.is_new("12:34:56:789 x"));
  words.start();
  EXPECT_TRUE(words.is_new("12:34:57:789 x"));
}

}  // namespace
}  // namespace dance
