// Rhythm on real takes over a bad line; skipped where there are none beside the tree. What it can
// do is said by docs/rhythm.md.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "research/rhythm/rhythm_eval.h"

namespace dance {
namespace {

TEST(RhythmTakes, ABeatOfDelayIsExactThroughLossAndAStall) {
  std::vector<GridBeat> beats;
  for (int i = 0; i < 400; ++i) beats.push_back({0.1 + i / 3.0, 1 + i % 4});
  const BeatGrid music = *BeatGrid::make(beats);
  std::vector<BeatDance> dances;
  // A stall finds the second of them where little but a prediction is left of the beat.
  for (const char* name : {"cmu_60_03_salsa", "cmu_61_03_salsa", "cmu_60_12_salsa"}) {
    const std::string path =
        DANCE_SOURCE_DIR "/../shared/data/mocap/" + std::string(name) + ".bvh.xz";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real takes beside this tree";
    const auto take = load_codec_take(path, 60.0);
    ASSERT_TRUE(take) << take.error().what;
    dances.push_back(lay_onto_beats(*take, music, 60.0));
  }
  RhythmEvalOptions options;
  options.delay = Duration::ms(180);
  options.jitter = Duration::ms(20);
  options.loss_percent = 2.0;
  options.stall = Duration::ms(400);
  for (const double offset : {-1.0, 1.0}) {
    options.tempo_offset_percent = offset;
    const auto run =
        evaluate_rhythm(dances, music, {"ours", {"predict", "bridge", "rhythm beats=1"}}, options);
    ASSERT_TRUE(run);
    EXPECT_LT(std::abs(run->mean.phase_mean_ms), 5.0) << offset;
    EXPECT_LT(run->phase_sd_ms_worst, 10.0) << offset;
    EXPECT_GT(run->mean.phase_told, 0.85) << offset;
    EXPECT_LT(run->mean.jerk_ratio, 1.15) << offset;
    EXPECT_LT(run->mean.foot_slide_ratio, 1.2) << offset;
    EXPECT_GE(run->mean.least_rate, 0.85) << offset;
    EXPECT_LE(run->mean.most_rate, 1.18) << offset;
    EXPECT_LT(run->mean.bone_length_error_mm, 0.01) << offset;
  }
}

}  // namespace
}  // namespace dance
