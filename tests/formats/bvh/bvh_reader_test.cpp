#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "formats/bvh/bvh.h"
#include "tests/formats/bvh/bvh_sample.h"

namespace dance {
namespace {

using test::kTwoJoints;
using test::replaced;

std::string error_of(const std::string& text, const BvhLimits& limits = {}) {
  const auto bvh = read_bvh(text, limits);
  return bvh ? "no error" : bvh.error().what;
}

void expect_same_motion(const std::string& text, const std::string& what) {
  const auto plain = read_bvh(kTwoJoints);
  const auto bvh = read_bvh(text);
  ASSERT_TRUE(plain.has_value());
  ASSERT_TRUE(bvh.has_value()) << what << ": " << bvh.error().what;
  EXPECT_EQ(bvh->values, plain->values) << what;
  EXPECT_EQ(bvh->joints.size(), plain->joints.size()) << what;
  EXPECT_EQ(bvh->joints[1].name, "spine") << what;
  EXPECT_EQ(bvh->joints[1].end_site, plain->joints[1].end_site) << what;
}

TEST(BvhReader, ReadsJointsChannelsAndFrames) {
  const auto bvh = read_bvh(kTwoJoints);
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  ASSERT_EQ(bvh->joints.size(), 2u);
  EXPECT_EQ(bvh->joints[0].name, "hips");
  EXPECT_EQ(bvh->joints[0].parent, -1);
  EXPECT_EQ(bvh->joints[0].channel_count, 6u);
  EXPECT_EQ(bvh->joints[1].parent, 0);
  EXPECT_EQ(bvh->joints[1].first_channel, 6u);
  EXPECT_EQ(bvh->joints[1].channels[1], BvhChannel::kXRotation);
  EXPECT_EQ(bvh->joints[1].offset, Eigen::Vector3d(0, 10, 0));
  EXPECT_EQ(*bvh->joints[1].end_site, Eigen::Vector3d(0, 5, 0));
  EXPECT_EQ(bvh->frame_count, 2u);
  EXPECT_DOUBLE_EQ(bvh->frame_hz, 30.0);
  EXPECT_FLOAT_EQ(bvh->frame(1)[8], -9.0f);
  EXPECT_TRUE(bvh->notes.empty());
}

TEST(BvhReader, TakesTheSpacingOfAnyTool) {
  expect_same_motion(replaced(kTwoJoints, "\n", "\r\n"), "CRLF");
  expect_same_motion(replaced(kTwoJoints, "\n", "\r"), "old Mac line ends");
  expect_same_motion(replaced(kTwoJoints, "\n", "  \t\n"), "trailing blanks");
  expect_same_motion(replaced(kTwoJoints, "\n", "\n\n"), "empty lines");
  expect_same_motion(replaced(kTwoJoints, "spine\n\t{", "spine {"), "brace on the name's line");
  expect_same_motion(replaced(kTwoJoints, "spine\n\t{", "spine{"), "brace at the name");
  expect_same_motion("\xEF\xBB\xBF" + std::string(kTwoJoints), "byte order mark");
  expect_same_motion(replaced(kTwoJoints, "Frames: 2", "Frames:2"), "no blank after Frames");
  expect_same_motion(replaced(kTwoJoints, "Frames: 2", "FRAMES : 2"), "blank before the colon");
  expect_same_motion(replaced(kTwoJoints, "Frame Time: ", "Frame Time:"), "no blank after Time");
  expect_same_motion(replaced(kTwoJoints, "position", "POSITION"), "channels in capitals");
  expect_same_motion(replaced(kTwoJoints, "HIERARCHY", "Hierarchy"), "keywords in small letters");
  expect_same_motion(replaced(kTwoJoints, "\n-1 -2", "\n   -1\t-2"), "tabs between numbers");
  expect_same_motion(std::string(kTwoJoints) + "\n\n  \n", "blank end");
  expect_same_motion(replaced(kTwoJoints, "-9\n", "-9"), "no last line end");
}

TEST(BvhReader, TakesNumbersInAnyNotation) {
  expect_same_motion(replaced(kTwoJoints, "1 2 3 4 5", "+1.0 2. 3e0 .4E+1 50e-1"), "notations");
}

TEST(BvhReader, KeepsBlanksInsideJointNames) {
  const auto bvh = read_bvh(replaced(kTwoJoints, "JOINT spine", "JOINT  Bip01 L Thigh \t"));
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_EQ(bvh->joints[1].name, "Bip01 L Thigh");
}

TEST(BvhReader, DoesWithoutAnEndSite) {
  const auto bvh =
      read_bvh(replaced(kTwoJoints, "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 5 0\n\t\t}\n", ""));
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_FALSE(bvh->joints[1].end_site.has_value());
}

TEST(BvhReader, ReadsFrameTimesAsTheyWereMeant) {
  const std::pair<const char*, double> kTimes[] = {
      {".0083333", 120.0}, {"0.008333", 120.0}, {"0.016667", 60.0}, {"0.0333667", 29.97},
      {"0.04", 25.0},      {"1.0", 1.0},        {"30", 30.0},       {"8.3333e-03", 120.0}};
  for (const auto& [text, hz] : kTimes) {
    const auto bvh = read_bvh(replaced(kTwoJoints, "0.0333333", text));
    ASSERT_TRUE(bvh.has_value()) << text << ": " << bvh.error().what;
    EXPECT_NEAR(bvh->frame_hz, hz, 1e-4) << text;
    EXPECT_EQ(bvh->notes.size(), hz == 30.0 ? 1u : 0u) << "a rate in place of a time is said";
  }
}

TEST(BvhReader, SaysThatItLeavesOutWhatFollowsTheLastFrame) {
  const auto bvh = read_bvh(std::string(kTwoJoints) + "1 2 3 4 5 6 7 8 9\n");
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_EQ(bvh->frame_count, 2u);
  EXPECT_EQ(bvh->lost, "line 21: 1 frames beyond 'Frames: 2'");
  const auto words = read_bvh(std::string(kTwoJoints) + "END\n");
  ASSERT_TRUE(words.has_value()) << words.error().what;
  EXPECT_EQ(words->lost, "");
  ASSERT_EQ(words->notes.size(), 1u);
  EXPECT_EQ(words->notes[0], "line 21: what follows frame 2 is left out");
}

TEST(BvhReader, TakesFramesThatRunOverSeveralLines) {
  expect_same_motion(replaced(kTwoJoints, "3 4 5 6", "3\n4 5 6"), "one frame on two lines");
}

TEST(BvhReader, NamesTheLineOfABrokenChannel) {
  EXPECT_EQ(
      error_of(replaced(kTwoJoints, "CHANNELS 3 Zrotation", "CHANNELS 3 Zrotatio")),
      "line 9: 'Zrotatio' is no channel; use Xposition to Zposition and Xrotation to Zrotation");
  EXPECT_EQ(error_of(replaced(kTwoJoints, "CHANNELS 3", "CHANNELS -1")),
            "line 9: '-1' is no count of channels; it should be 0 to 9, mostly 3 or 6");
}

TEST(BvhReader, NamesTheLineAndTheWordOfWhatIsBroken) {
  const std::tuple<const char*, const char*, const char*> kCases[] = {
      {"HIERARCHY", "<html>", "line 1: '<html>' stands where HIERARCHY should: this is not a BVH"},
      {"OFFSET 0 10 0", "OFFSET 0 x 0", "line 8: 'x' is no number in an OFFSET"},
      {"OFFSET 0 10 0", "OFFSET 0 0,1 0", "write decimals with a point"},
      {"OFFSET 0 10 0", "OFSET 0 10 0", "line 8: 'OFSET' stands where OFFSET, CHANNELS, JOINT"},
      {"JOINT spine", "JOINT", "line 6: a joint without a name"},
      {"MOTION", "MOTON", "line 16: 'MOTON' stands where MOTION should"},
      {"Frames: 2", "Frames: -1", "line 17: '-1' is no count of frames"},
      {"Frames: 2", "Frames: 2.5", "line 17: '2.5' is no count of frames"},
      {"Frames: 2", "Frames: 99999999999999999999", "is no count of frames"},
      {"Frames: 2", "Frames: 9223372036854775807", "frames are too many"},
      {"0.0333333", "0", "line 18: '0' is no Frame Time; write seconds a frame"},
      {"0.0333333", "-0.03", "is no Frame Time"},
      {"0.0333333", "0,033", "is no Frame Time"},
      {"0.0333333", "nan", "is no Frame Time"},
      {"0.0333333", "1e-9", "is too short a Frame Time"},
      {"7 8 9\n-1", "7 8 nan\n-1", "line 19: 'nan' is out of range of a frame"},
      {"7 8 9\n-1", "7 8 -inf\n-1", "line 19: '-inf' is out of range of a frame"},
      {"7 8 9\n-1", "7 8 1e30\n-1", "line 19: '1e30' is out of range of a frame"},
      {"7 8 9\n-1", "7 8 -1.#IND\n-1", "line 19: '-1.#IND' is no number of a frame"},
      {"7 8 9\n-1", "7 8\n-1", "line 19: not 9 numbers in this frame's line"},
      {"7 8 9\n-1", "7 8 9 10\n-1", "line 19: not 9 numbers in this frame's line"},
      {"}\nMOTION", "}\nROOT two\n{\n}\nMOTION",
       "line 16: a second ROOT; one file holds one dancer"},
      {"\t\tCHANNELS 3", "\t\tCHANNELS 1 Xrotation\nCHANNELS 3",
       "a second CHANNELS of joint 'spine'"},
  };
  for (const auto& [from, to, expected] : kCases) {
    const std::string error = error_of(replaced(kTwoJoints, from, to));
    EXPECT_NE(error.find(expected), std::string::npos) << "for '" << to << "': " << error;
  }
}

TEST(BvhReader, SaysThatATextWasCutShort) {
  EXPECT_EQ(error_of(""), "line 1: the file ends too early; it was cut short");
  const std::string text = kTwoJoints;
  EXPECT_NE(error_of(text.substr(0, text.find("Frames"))).find("line 17: the file ends too early"),
            std::string::npos);
}

TEST(BvhReader, BoundsJointsNestingFramesAndNumbers) {
  BvhLimits limits;
  limits.joints = 1;
  EXPECT_NE(error_of(kTwoJoints, limits).find("more than 1 joints"), std::string::npos);
  limits = {};
  limits.depth = 1;
  EXPECT_NE(error_of(kTwoJoints, limits).find("nested deeper than 1"), std::string::npos);
  limits = {};
  limits.frames = 1;
  EXPECT_NE(error_of(kTwoJoints, limits).find("frames are too many"), std::string::npos);
  limits = {};
  limits.values = 17;
  EXPECT_NE(error_of(kTwoJoints, limits).find("too much to hold"), std::string::npos);
  limits.values = 18;
  EXPECT_EQ(error_of(kTwoJoints, limits), "no error");
}

TEST(BvhReader, ReservesNoMemoryForFramesThatAreNotThere) {
  const auto bvh = read_bvh(replaced(kTwoJoints, "Frames: 2", "Frames: 432000"));
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_EQ(bvh->frame_count, 2u);
  EXPECT_LT(bvh->values.capacity(), 1000u);
  EXPECT_NE(bvh->lost.find("the file ends in frame 3 of 432000; it was cut short"),
            std::string::npos);
}

TEST(BvhReader, PrintsStrangeBytesOfAWordAsQuestionMarks) {
  EXPECT_EQ(error_of("\x1b[31m\xff"),
            "line 1: '?[31m?' stands where HIERARCHY should: this is not a "
            "BVH file");
}

TEST(BvhReader, QuotesNamesInAnyScriptButNoCharactersThatActOnTheDisplay) {
  EXPECT_EQ(error_of("Hüfte右"),
            "line 1: 'Hüfte右' stands where HIERARCHY should: this is not a BVH file");
  EXPECT_EQ(error_of("a\u202eb\u200fc").substr(0, 16), "line 1: 'a?b?c' ");
  std::string longest(39, 'x');
  EXPECT_NE(error_of(longest + "ü").find(longest + "...'"), std::string::npos);
}

// The error of a prefix may be any, but there is one unless a whole frame is there.
TEST(BvhReader, RefusesEveryPrefixOfAFileWithoutAWholeFrame) {
  const std::string text = kTwoJoints;
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    const auto bvh = read_bvh(std::string_view(text).substr(0, size));
    const bool has_frame = size > text.find("7 8 9\n-1") + 5;
    EXPECT_EQ(bvh.has_value(), has_frame) << "first " << size << " bytes";
    if (bvh) {
      EXPECT_EQ(bvh->frame_count, 1u) << "first " << size << " bytes";
      EXPECT_NE(bvh->lost.find("it was cut short"), std::string::npos);
    } else {
      EXPECT_EQ(bvh.error().what.substr(0, 5), "line ") << bvh.error().what;
      EXPECT_EQ(bvh.error().what.find('\n'), std::string::npos);
    }
  }
}

TEST(BvhReader, KeepsItsPromisesUnderEverySingleBitFlip) {
  const std::string text = kTwoJoints;
  std::size_t refused = 0;
  for (std::size_t at = 0; at < text.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string flipped = text;
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << bit));
      const auto bvh = read_bvh(flipped);
      if (!bvh) {
        ++refused;
        EXPECT_EQ(bvh.error().what.find('\n'), std::string::npos);
        continue;
      }
      ASSERT_EQ(bvh->values.size(), bvh->frame_count * bvh->channel_count);
      for (const float value : bvh->values) ASSERT_TRUE(std::isfinite(value));
      for (std::size_t j = 0; j < bvh->joints.size(); ++j)
        ASSERT_LT(bvh->joints[j].parent, static_cast<int>(j));
    }
  EXPECT_GT(refused, text.size());
}

TEST(BvhReader, TakesADeepFileWithoutRecursion) {
  std::string text = "HIERARCHY\nROOT a\n{\n";
  for (int i = 0; i < 200'000; ++i) text += "JOINT a\n{\n";
  EXPECT_NE(error_of(text).find("nested deeper than 128"), std::string::npos);
  BvhLimits limits;
  limits.depth = limits.joints = 300'000;
  EXPECT_NE(error_of(text, limits).find("it was cut short"), std::string::npos);
}

}  // namespace
}  // namespace dance
