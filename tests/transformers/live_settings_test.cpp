// Settings of a flow that are changed while it is shown: they take effect, and no joint moves
// further from picture to picture than it would anyway.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "core/pose/kinematics.h"
#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"
#include "transformers/flow.h"

namespace dance {
namespace {

constexpr std::uint64_t kClock = 1;
constexpr double kSettingsHz = 60.0;
constexpr double kTempo_bpm = 180.0;
const MonoTime kBegin = MonoTime::from_us(5'000'000);

MonoTime at_s(double s) { return kBegin + Duration::seconds(s); }

struct Shown {
  float most_step_m = 0.0f;  // of a joint, from picture to picture, after the third second
  Duration behind;           // of the last picture
  Pose last;
  std::vector<Pose> poses;
};

using Change = std::function<void(FlowSetting&)>;

// Fourteen seconds of salsa behind a line of 120 ms; `change` at the seventh, back at the tenth.
Shown show(const std::vector<std::string>& through, const Change& change, bool goes_back = true) {
  SalsaDancer dancer{SalsaStyle()};
  Flow flow = *Flow::make(through);
  const FlowSetting usual = flow.setting();
  Beat beat;
  beat.tempo_bpm = kTempo_bpm;
  beat.confidence = 1.0f;
  beat.playing = true;
  beat.clock_id = kClock;
  const Skeleton body = average_skeleton();
  Shown shown;
  BodyFrames now_frames, before;
  constexpr int kFrames = 14 * 60;
  for (int i = 0; i < kFrames; ++i) {
    const double t_s = i / kSettingsHz;
    Pose pose;
    dancer.dance_at(Duration::seconds(t_s), pose);
    pose.sequence = static_cast<std::uint32_t>(i);
    pose.clock_id = kClock;
    pose.capture_time = at_s(t_s);
    pose.music_beats = t_s * kTempo_bpm / 60.0;
    const MonoTime now = pose.capture_time + Duration::ms(120);
    beat.time = beat.beat_time = now;
    beat.beat = (now - kBegin).as_seconds() * kTempo_bpm / 60.0;
    if (i % 6 == 0) flow.hear(beat);
    if (i == 7 * 60 && change) {
      FlowSetting setting = flow.setting();
      change(setting);
      flow.set(setting);
    }
    if (i == 10 * 60 && goes_back) flow.set(usual);
    flow.observe(pose, now);
    Pose out;
    EXPECT_TRUE(flow.sample(now, out));
    forward_kinematics(body, out, now_frames);
    for (std::size_t bone = 0; i > 3 * 60 && bone < kBoneCount; ++bone)
      shown.most_step_m =
          std::max(shown.most_step_m, (now_frames.p_WB_m[bone] - before.p_WB_m[bone]).norm());
    before = now_frames;
    shown.behind = now - out.capture_time;
    shown.last = out;
    shown.poses.push_back(out);
  }
  return shown;
}

const std::vector<std::string> kWholeRoute{"predict", "bridge", "rhythm beats=1", "stylize"};
const std::vector<std::string> kPredicted{"predict", "bridge", "stylize"};
const std::vector<std::string> kHeld{"hold", "bridge", "stylize"};

struct Case {
  const char* name;
  const std::vector<std::string>& through;
  Change change;
};

const std::vector<Case>& cases() {
  const auto off = [](FlowWord word) {
    return [word](FlowSetting& s) { s.on[index_of(word)] = false; };
  };
  static const std::vector<Case> kCases{
      {"predict off", kPredicted, off(FlowWord::kPredict)},
      {"lead", kPredicted, [](FlowSetting& s) { s.lead = 0.2f; }},
      {"lead beyond", kPredicted, [](FlowSetting& s) { s.lead = 1.5f; }},
      {"reach", kPredicted, [](FlowSetting& s) { s.reach_ms = 20.0f; }},
      {"bridge off", kPredicted, off(FlowWord::kBridge)},
      {"rhythm off", kWholeRoute, off(FlowWord::kRhythm)},
      {"rhythm half", kWholeRoute, [](FlowSetting& s) { s.rhythm_strength = 0.5f; }},
      {"predict off in rhythm", kWholeRoute, off(FlowWord::kPredict)},
      {"hold long", kHeld, [](FlowSetting& s) { s.hold_ms = 900.0f; }},
      {"hold off", kHeld, off(FlowWord::kHold)},
      {"stylize off", kHeld, off(FlowWord::kStylize)},
      {"calm", kHeld, [](FlowSetting& s) { s.gain.fill(0.6f); }},
  };
  return kCases;
}

TEST(LiveSettings, MoveNoJointFurtherThanItWouldAnyway) {
  for (const Case& it : cases()) {
    const Shown as_usual = show(it.through, {});
    const Shown changed = show(it.through, it.change);
    // The dance may be shown somewhat faster while it goes from one moment to another.
    EXPECT_LE(changed.most_step_m, 1.2f * as_usual.most_step_m) << it.name;
  }
}

// Larger gains are larger motion: the bound is that of a stage which had them from the begin.
TEST(LiveSettings, MoveNoJointFurtherThanTheLargerDanceDoes) {
  const Shown large = show({"hold", "bridge", "stylize hips=1.6 arms=1.6"}, {});
  const Shown changed = show(kHeld, [](FlowSetting& s) {
    s.gain[static_cast<std::size_t>(BodyZone::kHips)] = 1.6f;
    s.gain[static_cast<std::size_t>(BodyZone::kArms)] = 1.6f;
  });
  EXPECT_LE(changed.most_step_m, 1.2f * large.most_step_m);
}

TEST(LiveSettings, TakeEffect) {
  const auto behind_ms = [](const std::vector<std::string>& through, const Change& change) {
    return show(through, change, false).behind.as_ms();
  };
  EXPECT_NEAR(behind_ms(kPredicted, {}), 0.0, 3.0);
  const auto predict_off = [](FlowSetting& s) { s.on[index_of(FlowWord::kPredict)] = false; };
  EXPECT_NEAR(behind_ms(kPredicted, predict_off), 120.0, 3.0);
  EXPECT_NEAR(behind_ms(kPredicted, [](FlowSetting& s) { s.lead = 0.5f; }), 60.0, 3.0);
  EXPECT_NEAR(behind_ms(kHeld, [](FlowSetting& s) { s.hold_ms = 200.0f; }), 320.0, 20.0);
  // A beat is a third of a second.
  EXPECT_NEAR(behind_ms(kWholeRoute, {}), 333.3, 15.0);
  const auto rhythm_off = [](FlowSetting& s) { s.on[index_of(FlowWord::kRhythm)] = false; };
  EXPECT_NEAR(behind_ms(kWholeRoute, rhythm_off), 0.0, 10.0);
  EXPECT_NEAR(behind_ms(kWholeRoute, [](FlowSetting& s) { s.rhythm_strength = 0.5f; }), 166.7,
              15.0);
}

TEST(LiveSettings, OfPredictOffShowWhatCame) {
  const auto predict_off = [](FlowSetting& s) { s.on[index_of(FlowWord::kPredict)] = false; };
  const Shown off = show(kPredicted, predict_off, false);
  const Shown never = show({"predict lead=0 most=0ms", "bridge", "stylize"}, {});
  EXPECT_LT((off.last.p_WH_m - never.last.p_WH_m).norm(), 2e-3f);
}

TEST(LiveSettings, ThatAreTheSameChangeNoBit) {
  for (const auto* through : {&kWholeRoute, &kPredicted, &kHeld}) {
    const Shown a = show(*through, {}, false);
    const Shown b = show(
        *through, [](FlowSetting&) {}, true);
    ASSERT_EQ(a.poses.size(), b.poses.size());
    for (std::size_t i = 0; i < a.poses.size(); ++i) {
      ASSERT_EQ(a.poses[i].p_WH_m, b.poses[i].p_WH_m) << i;
      for (std::size_t bone = 0; bone < kBoneCount; ++bone)
        ASSERT_EQ(a.poses[i].R_PB[bone].coeffs(), b.poses[i].R_PB[bone].coeffs()) << i;
    }
  }
}

TEST(LiveSettings, SayWhatTheWordsOfTheRouteSay) {
  const Flow flow = *Flow::make({"hold 40ms", "predict lead=0.8 most=250ms on=0",
                                 "rhythm beats=2 count=4 strength=0.5 error=80",
                                 "stylize preset=cuban head=1.5 mix=0.25 bar=0.75"});
  const FlowSetting& s = flow.setting();
  EXPECT_TRUE(s.has_word(FlowWord::kHold));
  EXPECT_FALSE(s.has_word(FlowWord::kBridge));
  EXPECT_TRUE(s.has_word(FlowWord::kPredict));
  EXPECT_FALSE(s.is_on(FlowWord::kPredict));
  EXPECT_EQ(s.hold_ms, 40.0f);
  EXPECT_EQ(s.lead, 0.8f);
  EXPECT_EQ(s.reach_ms, 250.0f);
  EXPECT_EQ(s.rhythm_beats, 2.0f);
  EXPECT_EQ(s.rhythm_count, 4.0f);
  EXPECT_EQ(s.rhythm_strength, 0.5f);
  EXPECT_EQ(s.rhythm_error_mm, 80.0f);
  EXPECT_EQ(s.gain[0], 1.6f);
  EXPECT_EQ(s.gain[6], 1.5f);
  EXPECT_EQ(s.dynamic, 0.25f);
  EXPECT_EQ(s.periodic, 0.75f);
  EXPECT_FALSE(Flow().setting().has_word(FlowWord::kHold));
}

TEST(LiveSettings, ASwitchOfTheSessionIsWhatThePanelsIs) {
  const auto off = [](FlowSetting& s) { s.on[index_of(FlowWord::kRhythm)] = false; };
  const Shown from_begin = show({"predict", "bridge", "rhythm beats=1 on=0", "stylize"}, {});
  const Shown changed = show(kWholeRoute, off, false);
  EXPECT_NEAR((from_begin.behind - changed.behind).as_ms(), 0.0, 5.0);
  EXPECT_FALSE(Flow::make({"rhythm on=2"}));
  EXPECT_NE(Flow::make({"rhythm on=yes"}).error().what.find("on=0 or on=1"), std::string::npos);
}

TEST(LiveSettings, RefuseWhatIsOutOfRangeAndAllocateNothing) {
  Flow flow = *Flow::make(kWholeRoute);
  FlowSetting wrong = flow.setting();
  wrong.lead = 7.0f;
  flow.set(wrong);
  EXPECT_EQ(flow.setting().lead, 1.0f);
  FlowSetting right = flow.setting();
  right.lead = 0.5f;
  right.gain[0] = 1.5f;
  right.has.fill(false);  // what the route has, a request does not change
  const AllocationGuard guard;
  flow.set(right);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(flow.setting().lead, 0.5f);
  EXPECT_TRUE(flow.setting().has_word(FlowWord::kRhythm));
}

}  // namespace
}  // namespace dance
