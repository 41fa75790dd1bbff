// Real couples, who hear the same music: each one's phase is found without the other.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "formats/bvh/clip_file.h"
#include "transformers/rhythm/own_beat.h"
#include "transformers/tempo/period.h"

namespace dance {
namespace {

struct Couple {
  const char* lead;
  const char* follow;
  double tempo_bpm;
};

constexpr std::array<Couple, 2> kCouples{
    {{"cmu_60_03_salsa", "cmu_61_03_salsa", 164.0}, {"cmu_60_07_salsa", "cmu_61_07_salsa", 176.0}}};

// Both partners' clips, or none where they are missing.
std::vector<MotionClip> clips_of(const Couple& couple) {
  std::vector<MotionClip> clips;
  for (const char* name : {couple.lead, couple.follow}) {
    const std::string path =
        DANCE_SOURCE_DIR "/../shared/data/mocap/" + std::string(name) + ".bvh.xz";
    if (!std::filesystem::exists(path)) return {};
    auto loaded = load_clip(path);
    if (!loaded) return {};
    clips.push_back(std::move(loaded->clip));
  }
  return clips;
}

TEST(PeriodTakes, PartnersWhoDanceTogetherAreFoundInPhaseFarWithinABeat) {
  for (const Couple& couple : kCouples) {
    std::array<Period, 2> periods;
    const std::vector<MotionClip> clips = clips_of(couple);
    if (clips.empty()) GTEST_SKIP() << couple.lead << ": no real takes beside this tree";
    for (std::size_t who = 0; who < 2; ++who) {
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

// Their poses come without music: both are told the same place in the bar, each by their own steps.
TEST(PeriodTakes, PartnersWithoutMusicAreToldTheSamePlaceInTheBar) {
  for (const Couple& couple : kCouples) {
    std::array<OwnBeat, 2> own;
    const std::vector<MotionClip> clips = clips_of(couple);
    if (clips.empty()) GTEST_SKIP() << couple.lead << ": no real takes beside this tree";
    for (std::size_t who = 0; who < 2; ++who) own[who].set_body(clips[who].skeleton);
    double squares = 0.0;
    int known = 0, of_both = 0, same = 0;
    for (std::size_t i = 0; i < clips[0].frames.size(); ++i) {
      std::array<std::optional<double>, 2> told;
      for (std::size_t who = 0; who < 2; ++who) {
        Pose pose = clips[who].frames[i];
        pose.capture_time =
            MonoTime() + Duration::seconds(1.0 + static_cast<double>(i) / clips[0].frame_hz);
        told[who] = own[who].observe(pose, pose.capture_time, couple.tempo_bpm);
        known += told[who] ? 1 : 0;
      }
      if (!told[0] || !told[1]) continue;
      double apart = *told[0] - *told[1];
      apart -= 4.0 * std::round(apart / 4.0);
      ++of_both;
      same += std::abs(apart) < 0.5 ? 1 : 0;
      squares += apart * apart;
    }
    EXPECT_GT(known, static_cast<int>(clips[0].frames.size())) << "half of both partners' poses";
    ASSERT_GT(of_both, 600);
    EXPECT_GT(same, of_both * 19 / 20) << couple.lead;
    EXPECT_LT(std::sqrt(squares / of_both), 0.35) << couple.lead << ", beats";
  }
}

// Dancing of another kind, and salsa whose seconds are in another order, are not taken for it.
TEST(PeriodTakes, WhatIsNoSalsaToTheMusicIsNotPutOnItsBeat) {
  const std::vector<MotionClip> clips = clips_of({"cmu_131_02_mj_style", "cmu_60_03_salsa", 164.0});
  if (clips.empty()) GTEST_SKIP() << "no real takes beside this tree";
  for (const MotionClip& clip : clips) {
    const bool in_pieces = &clip != &clips[0];
    const auto second = static_cast<std::size_t>(std::lround(clip.frame_hz));
    const std::size_t seconds = clip.frames.size() / second;
    OwnBeat own;
    own.set_body(clip.skeleton);
    int told = 0;
    for (std::size_t i = 0; i < seconds * second; ++i) {
      // Steps of seven through a number of seconds that is no multiple of it come by each once.
      const std::size_t from = in_pieces ? i / second * 7 % seconds : i / second;
      Pose pose = clip.frames[from * second + i % second];
      pose.capture_time =
          MonoTime() + Duration::seconds(1.0 + static_cast<double>(i) / clip.frame_hz);
      told += own.observe(pose, pose.capture_time, 164.0) ? 1 : 0;
    }
    EXPECT_LT(told, static_cast<int>(clip.frames.size() / 20)) << in_pieces;
  }
}

}  // namespace
}  // namespace dance
