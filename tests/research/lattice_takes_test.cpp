// Real takes that the built-in model was not trained on; skipped where there are none beside the
// tree.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/codec/lossless/lossless_codec.h"
#include "research/codec/codec_eval.h"

namespace dance {
namespace {

constexpr double kBytesAtAge1 = 14.5, kBytesAtAge2 = 19.5, kBytesAtAge4 = 26.0, kBytesIntra = 50.0;

// 5 % above what `dance codec eval` measured when the model was made.
TEST(LatticeTakes, DancesNotTrainedOnCostWhatTheyDidAndStayWithinTheError) {
  std::vector<CodecTake> takes;
  for (const char* name : {"cmu_60_05_salsa", "cmu_61_12_salsa"}) {
    const std::string path =
        DANCE_SOURCE_DIR "/../shared/data/mocap/" + std::string(name) + ".bvh.xz";
    if (!std::filesystem::exists(path))
      GTEST_SKIP() << path << " is missing: no real takes beside this tree";
    auto take = load_codec_take(path, 60.0);
    ASSERT_TRUE(take);
    take->poses.resize(700);
    takes.push_back(std::move(*take));
  }
  CodecEvalOptions options;
  options.model = built_in_model();
  options.loss_percent = 5.0;
  const CodecEval eval = evaluate_codec(takes, options);
  ASSERT_EQ(eval.ages.size(), 5u);
  EXPECT_LE(eval.ages[0].mean_bytes, kBytesAtAge1);
  EXPECT_LE(eval.ages[1].mean_bytes, kBytesAtAge2);
  EXPECT_LE(eval.ages[2].mean_bytes, kBytesAtAge4);
  EXPECT_LE(eval.ages[4].mean_bytes, kBytesIntra);
  EXPECT_LE(eval.errors.max_position_m, 0.001 + 1e-6);
  EXPECT_EQ(eval.refused, 0u);
  EXPECT_LE(eval.lossless_bytes, 0.5 * kRawPose_bytes);
  EXPECT_EQ(eval.losses.back().policy, "acknowledged");
  EXPECT_EQ(eval.losses.back().decoded_fraction, 1.0);
}

}  // namespace
}  // namespace dance
