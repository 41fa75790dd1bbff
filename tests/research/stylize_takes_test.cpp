// Real dances, larger and smaller.
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "research/style/stylize_eval.h"

namespace dance {
namespace {

// None where there are no real takes beside this tree.
std::optional<StyleTake> real_take(const std::string& name) {
  const std::string path = DANCE_SOURCE_DIR "/../shared/data/mocap/" + name + ".bvh.xz";
  if (!std::filesystem::exists(path)) return std::nullopt;
  const auto loaded = load_codec_take(path, 60.0);
  EXPECT_TRUE(loaded);
  return style_take_of(*loaded);
}

TEST(StylizeTakes, HipsOfRealSalsaSwayAsMuchMoreAsWasAskedForOverFeetThatStand) {
  for (const char* name : {"cmu_60_03_salsa", "cmu_61_05_salsa"}) {
    const std::optional<StyleTake> take = real_take(name);
    if (!take) GTEST_SKIP() << name << ": no real takes beside this tree";
    for (const double gain : {0.5, 1.5, 2.0}) {
      for (const double mix : {0.0, kUsualMix, 1.0}) {
        StylizeEvalOptions options;
        options.gain = gain;
        options.mix = mix;
        const StylizeEval eval = evaluate_stylize(*take, options);
        EXPECT_NEAR(eval.measured_gain, gain, 0.06 * gain) << name << ", mix " << mix;
        EXPECT_LT(eval.mean_pose_shift_deg, 0.5);
        EXPECT_EQ(eval.other_zones_change_deg, 0.0);
        EXPECT_LT(eval.bone_length_error_mm, 0.01);
        EXPECT_LT(eval.feet_moved_mm, 1.0);
        EXPECT_LT(eval.jerk_ratio, std::max(1.05, 1.1 * gain));
      }
    }
  }
}

TEST(StylizeTakes, StepsOfRealSalsaAreLargerAndFeetThatStandDoNotSlide) {
  const std::optional<StyleTake> take = real_take("cmu_61_05_salsa");
  if (!take) GTEST_SKIP() << "no real takes beside this tree";
  StylizeEvalOptions options;
  options.zone = BodyZone::kLegs;
  const StylizeEval eval = evaluate_stylize(*take, options);
  EXPECT_NEAR(eval.measured_gain, 1.5, 0.09);
  EXPECT_LT(eval.slide_mm_s, 1.05 * eval.danced_slide_mm_s);
  EXPECT_LT(eval.jerk_ratio, 1.45);
  EXPECT_EQ(eval.other_zones_change_deg, 0.0);
}

TEST(StylizeTakes, InADanceAsLongAsASongArmsKeepTheirMeanPose) {
  std::vector<StyleTake> takes;
  for (const char* name : {"cmu_61_01_salsa", "cmu_61_03_salsa", "cmu_61_05_salsa",
                           "cmu_61_07_salsa", "cmu_61_14_salsa", "cmu_60_03_salsa"}) {
    const std::optional<StyleTake> take = real_take(name);
    if (!take) GTEST_SKIP() << name << ": no real takes beside this tree";
    takes.push_back(*take);
  }
  const std::vector<StyleTake> dances = joined(takes);
  ASSERT_EQ(dances.size(), 2u);  // the last is another dancer's
  EXPECT_EQ(dances[1].poses.size(), takes[5].poses.size());
  const StyleTake& dance = dances[0];
  for (std::size_t i = 1; i < dance.poses.size(); ++i) {
    const double step_s =
        (dance.poses[i].capture_time - dance.poses[i - 1].capture_time).as_seconds();
    ASSERT_NEAR(step_s, 1.0 / dance.hz, 1e-6) << i;
    ASSERT_GE(dance.poses[i].music_beats, dance.poses[i - 1].music_beats) << i;
  }
  for (const double mix : {0.0, 1.0}) {
    StylizeEvalOptions options;
    options.zone = BodyZone::kArms;
    options.mix = mix;
    const StylizeEval eval = evaluate_stylize(dance, options);
    EXPECT_NEAR(eval.measured_gain, 1.5, 0.09) << mix;
    EXPECT_LT(eval.mean_pose_shift_deg, 0.3) << mix;
  }
}

TEST(StylizeTakes, ArmsOfRealSalsaKeepTheirMeanPoseAtAllOfTheMotion) {
  const std::optional<StyleTake> take = real_take("cmu_60_03_salsa");
  if (!take) GTEST_SKIP() << "no real takes beside this tree";
  StylizeEvalOptions options;
  options.zone = BodyZone::kArms;
  options.mix = 1.0;
  const StylizeEval eval = evaluate_stylize(*take, options);
  EXPECT_NEAR(eval.measured_gain, 1.5, 0.09);
  EXPECT_LT(eval.mean_pose_shift_deg, 1.8);
}

}  // namespace
}  // namespace dance
