// Real takes from beside the tree; skipped where there are none.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "core/codec/lossless/lossless_codec.h"
#include "formats/bvh/clip_file.h"

namespace dance {
namespace {

struct Cost {
  double mean_bytes = 0.0;
  std::size_t wrong = 0;
};

Cost cost_of(const MotionClip& clip) {
  LosslessEncoder encoder;
  LosslessDecoder decoder;
  std::array<std::uint8_t, kMaxLosslessPayload> payload;
  Cost cost;
  for (const Pose& pose : clip.frames) {
    const std::size_t size = encoder.encode(pose, payload);
    cost.mean_bytes += static_cast<double>(size);
    Pose out;
    const bool is_same = decoder.decode({payload.data(), size}, out) == DecodeResult::kPose &&
                         std::memcmp(pose.R_PB.data(), out.R_PB.data(), sizeof pose.R_PB) == 0 &&
                         std::memcmp(pose.p_WH_m.data(), out.p_WH_m.data(), 3 * sizeof(float)) == 0;
    if (!is_same) ++cost.wrong;
  }
  cost.mean_bytes /= static_cast<double>(clip.frames.size());
  return cost;
}

// Measured: 116 to 125 bytes, 0.32 to 0.34 of raw.
TEST(LosslessTakes, RealDanceCostsAThirdOfRawAndComesBackToTheBit) {
  for (const char* name : {"cmu_60_01_salsa", "cmu_61_05_salsa"}) {
    const std::string path =
        DANCE_SOURCE_DIR "/../shared/data/mocap/" + std::string(name) + ".bvh.xz";
    if (!std::filesystem::exists(path))
      GTEST_SKIP() << path << " is missing: no real takes beside this tree";
    const auto take = load_clip(path);
    ASSERT_TRUE(take);
    ASSERT_EQ(take->clip.frame_hz, 60.0);
    const Cost cost = cost_of(take->clip);
    EXPECT_EQ(cost.wrong, 0u);
    EXPECT_LT(cost.mean_bytes / kRawPose_bytes, 0.36) << name;
    std::printf("%s: %.1f bytes a frame, %.3f of raw\n", name, cost.mean_bytes,
                cost.mean_bytes / kRawPose_bytes);
  }
}

}  // namespace
}  // namespace dance
