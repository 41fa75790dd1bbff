#include "producers/trackers/net/tracker_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "tests/producers/trackers/worn_points.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

std::vector<std::uint8_t> tracker_model_bytes() {
  return bytes_in(DANCE_SOURCE_DIR "/data/trackers/body.model");
}

TEST(TrackerModel, TheBuiltInOneIsTheFileOfTheTree) {
  const auto model = read_tracker_model(tracker_model_bytes());
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ((*model)->name, built_in_tracker_model()->name);
  EXPECT_LE(tracker_model_bytes().size(), 500'000u);
}

TEST(TrackerModel, WrittenAndReadAgainIsTheSame) {
  EXPECT_EQ(write_tracker_model(*built_in_tracker_model()), tracker_model_bytes());
}

TEST(TrackerModel, RefusesEveryPrefixAndWhatIsLonger) {
  const std::vector<std::uint8_t> whole = tracker_model_bytes();
  for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 4999)
    EXPECT_FALSE(read_tracker_model(std::span(whole).first(size))) << size;
  EXPECT_FALSE(read_tracker_model(std::span(whole).first(whole.size() - 1)));
  auto longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(read_tracker_model(longer));
}

TEST(TrackerModel, RefusesOtherKindsVersionsAndSizes) {
  const std::vector<std::uint8_t> whole = tracker_model_bytes();
  for (std::size_t byte = 0; byte < 14; ++byte)
    for (const std::uint8_t bit : {std::uint8_t{1}, std::uint8_t{0x80}}) {
      auto other = whole;
      other[byte] = static_cast<std::uint8_t>(other[byte] ^ bit);
      const auto model = read_tracker_model(other);
      ASSERT_FALSE(model) << byte;
      EXPECT_NE(model.error().what.find("dance trackers train"), std::string::npos);
    }
}

TEST(TrackerModel, RefusesScalesThatAreNoNumbers) {
  const std::vector<std::uint8_t> whole = tracker_model_bytes();
  constexpr std::size_t kFirstScale = 14;
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity(), -1.0f, 1e6f}) {
    auto other = whole;
    const auto bits = std::bit_cast<std::uint32_t>(wrong);
    for (std::size_t i = 0; i < 4; ++i)
      other[kFirstScale + i] = static_cast<std::uint8_t>(bits >> (8 * i));
    EXPECT_FALSE(read_tracker_model(other)) << wrong;
  }
}

TEST(TrackerModel, WhateverIsLetThroughSaysNumbers) {
  const std::vector<std::uint8_t> whole = tracker_model_bytes();
  Random random(5);
  int read = 0;
  for (int i = 0; i < 20; ++i) {
    auto other = whole;
    for (int k = 0; k < 50; ++k)
      other[14 + random.below(other.size() - 14)] = static_cast<std::uint8_t>(random.next_u64());
    const auto model = read_tracker_model(other);
    if (!model) continue;
    ++read;
    TrackerNet::State state;
    TrackerRow::Inputs inputs;
    inputs.fill(0.7f);
    for (int step = 0; step < 4; ++step) (*model)->net.step(inputs, state);
    for (const float x : state.outputs) ASSERT_TRUE(std::isfinite(x));
  }
  EXPECT_GT(read, 0);
}

TEST(TrackerFeatures, ABodyWrittenIntoARowIsReadBack) {
  SalsaDancer dancer = some_dancer();
  Pose pose;
  dancer.dance_at(Duration::seconds(3.3), pose);
  BodyFrames body;
  forward_kinematics(dancer.skeleton(), pose, body);
  const Place head{body.position(Bone::kHead), body.R_WB[index_of(Bone::kHead)]};
  const TrackerView view(head, 1.9f);
  TrackerRow::Outputs row;
  write_outputs(view, body, {4.0f, -4.0f}, row);
  BodyGuess guess;
  read_outputs(view, row, head.R_W, guess);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_LT(guess.R_WB[b].angularDistance(body.R_WB[b]), 2e-3f) << kBones[b].name;
  EXPECT_LT((guess.p_WH_m - body.p_WB_m[0]).norm(), 1e-4f);
  EXPECT_LT((guess.ankles_W_m[1] - body.position(Bone::kRightFoot)).norm(), 1e-4f);
  EXPECT_GT(guess.stands[0], 0.95f);
  EXPECT_LT(guess.stands[1], 0.05f);
}

TEST(TrackerFeatures, WhereADancerStandsAndFacesDoesNotMatter) {
  SalsaDancer dancer = some_dancer();
  const WornPoints worn(dancer.skeleton(), kSixPoints);
  TrackerCalibration calibration;
  Pose pose;
  std::array<TrackerRow::Inputs, 2> rows;
  for (std::size_t way = 0; way < 2; ++way) {
    std::array<BonePlaces, 2> bones;
    for (std::size_t k = 0; k < 2; ++k) {
      dancer.dance_at(Duration::seconds(2.0 + 0.02 * static_cast<double>(k)), pose);
      if (way == 1) {
        const Eigen::Quaternionf turn = about_up(2.1f);
        pose.R_PB[0] = turn * pose.R_PB[0];
        pose.p_WH_m = turn * pose.p_WH_m + Eigen::Vector3f(3.0f, 0.0f, -2.0f);
      }
      calibration.place_bones(worn.see(pose, at_seconds(0.02 * static_cast<double>(k))), bones[k]);
    }
    const TrackerView view(bones[1].of(TrackedPoint::kHead), 1.7f);
    write_inputs(view, bones[0], bones[1], 0.02f, rows[way]);
  }
  for (std::size_t i = 0; i < rows[0].size(); ++i) EXPECT_NEAR(rows[0][i], rows[1][i], 2e-3f) << i;
}

}  // namespace
}  // namespace dance
