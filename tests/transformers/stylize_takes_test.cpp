// Real dances, larger and smaller.
#include <gtest/gtest.h>

#include <filesystem>

#include "tools/stylize_eval.h"

namespace dance {
namespace {

TEST(StylizeTakes, HipsOfRealSalsaSwayAsMuchMoreAsWasAskedForOverFeetThatStand) {
  for (const char* name : {"cmu_60_03_salsa", "cmu_61_05_salsa"}) {
    const std::string path =
        DANCE_SOURCE_DIR "/../shared/data/mocap/" + std::string(name) + ".bvh.xz";
    if (!std::filesystem::exists(path))
      GTEST_SKIP() << path << " is missing: no real takes beside this tree";
    const auto loaded = load_codec_take(path, 60.0);
    ASSERT_TRUE(loaded);
    const StyleTake take = style_take_of(*loaded);
    for (const double gain : {0.5, 1.5, 2.0}) {
      for (const double mix : {0.0, kUsualMix, 1.0}) {
        StylizeEvalOptions options;
        options.gain = gain;
        options.mix = mix;
        const StylizeEval eval = evaluate_stylize(take, options);
        EXPECT_NEAR(eval.measured_gain, gain, 0.09 * gain) << name << ", mix " << mix;
        EXPECT_LT(eval.mean_pose_shift_deg, 0.5);
        EXPECT_EQ(eval.other_zones_change_deg, 0.0);
        EXPECT_LT(eval.bone_length_error_mm, 0.01);
        EXPECT_LT(eval.feet_moved_mm, 1.0);
        EXPECT_LT(eval.jerk_ratio, std::max(1.05, 1.1 * gain));
      }
    }
  }
}

}  // namespace
}  // namespace dance
