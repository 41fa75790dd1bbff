// Real couples, who hear the same music: each one's phase is found without the other.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "formats/bvh/clip_file.h"
#include "transformers/tempo/period.h"

namespace dance {
namespace {

struct Couple {
  const char* lead;
  const char* follow;
  double tempo_bpm;
};

TEST(PeriodTakes, PartnersWhoDanceTogetherAreFoundInPhaseFarWithinABeat) {
  for (const Couple& couple : {Couple{"cmu_60_03_salsa", "cmu_61_03_salsa", 164.0},
                               Couple{"cmu_60_07_salsa", "cmu_61_07_salsa", 176.0}}) {
    std::array<Period, 2> periods;
    std::array<MotionClip, 2> clips;
    for (std::size_t who = 0; who < 2; ++who) {
      const std::string path = DANCE_SOURCE_DIR "/../shared/data/mocap/" +
                               std::string(who == 0 ? couple.lead : couple.follow) + ".bvh.xz";
      if (!std::filesystem::exists(path))
        GTEST_SKIP() << path << " is missing: no real takes beside this tree";
      auto loaded = load_clip(path);
      ASSERT_TRUE(loaded);
      clips[who] = std::move(loaded->clip);
      periods[who].set_body(clips[who].skeleton);
      periods[who].set_tempo(couple.tempo_bpm);
    }
    double sum = 0.0, squares = 0.0;
    int trusted = 0;
    for (std::size_t i = 0; i < clips[0].frames.size(); ++i) {
      const double s = static_cast<double>(i) / clips[0].frame_hz;
      const MonoTime now = MonoTime::from_ns(static_cast<std::int64_t>(1e9 * (1.0 + s)));
      for (std::size_t who = 0; who < 2; ++who) {
        Pose pose = clips[who].frames[i];
        pose.capture_time = now;
        periods[who].observe(pose, now);
      }
      if (s < 10.0 || periods[0].coherence() < 0.5f || periods[1].coherence() < 0.5f) continue;
      const double apart = periods[0].beats(now) - periods[1].beats(now);
      sum += apart;
      squares += apart * apart;
      ++trusted;
    }
    ASSERT_GT(trusted, 200);
    const double mean = sum / trusted;
    EXPECT_LT(std::sqrt(squares / trusted - mean * mean), 0.2) << couple.lead << ", beats";
  }
}

}  // namespace
}  // namespace dance
