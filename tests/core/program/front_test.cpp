// What `dance` and its programs say to a wrong word.
#include <gtest/gtest.h>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

TEST(Front, HelpOfACommandIsThatCommandsOwn) {
  const Finished asked = run(bin("dance help join"));
  EXPECT_EQ(asked.exit_code, 0) << asked.talk;
  EXPECT_EQ(asked.output, run(bin("dance join --help")).output);
  EXPECT_NE(asked.output.find("dance join [OPTIONS]"), std::string::npos) << asked.output;
  EXPECT_EQ(run(bin("dance help nonsense")).exit_code, 2);
}

TEST(Front, TheFirstOfTwoWordsNamesTheSecond) {
  const Finished refused = run(bin("dance bench"));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.talk.rfind("dance: 'bench' needs another word: dance bench path, ", 0), 0u)
      << refused.talk;
  const Finished unknown = run(bin("dance nonsense"));
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(unknown.talk, "dance: there is no command 'nonsense'; `dance help` lists them\n");
}

TEST(Front, ANumberOutOfRangeIsToldItsRangeWithoutIdleZeros) {
  for (const std::string seconds : {"-1", "1e9", "soon", "nan"}) {
    const Finished refused = run(bin("dance-listen --hz ") + seconds);
    EXPECT_EQ(refused.exit_code, 2) << refused.talk;
    EXPECT_EQ(refused.talk.rfind("dance listen: --hz: '" + seconds + "' is not 0 to 1000", 0), 0u)
        << refused.talk;
  }
}

TEST(Front, LargeRangesAreToldInDigits) {
  const Finished refused = run(bin("dance-listen --seconds -1"));
  EXPECT_NE(refused.talk.find("'-1' is not 0 to 10000000"), std::string::npos) << refused.talk;
}

TEST(Front, SaysWhichVersionItIs) {
  const Finished asked = run(bin("dance --version"));
  EXPECT_EQ(asked.exit_code, 0);
  EXPECT_EQ(asked.output.rfind("DanceGraph ", 0), 0u) << asked.output;
}

}  // namespace
}  // namespace dance
