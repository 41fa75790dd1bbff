#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "core/base/random.h"
#include "core/pose/interpolate.h"
#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"
#include "tests/transformers/flows.h"

namespace dance {
namespace {

constexpr double kStageHz = 60.0;

MonoTime stage_time(double s) { return MonoTime::from_us(10'000'000) + Duration::seconds(s); }

// Two houses that hear the same song, the listener's a little faster or later.
struct TwoHouses {
  double sender_hz = 2.7;  // beats a second
  double listener_speed = 1.0, listener_late_s = 0.0;
  double delay_s = 0.18, jitter_s = 0.0;
  bool tagged = true;
  bool music = true;

  double sent_beats(double s) const { return sender_hz * s; }
  double heard_beats(double s) const { return sender_hz * listener_speed * (s - listener_late_s); }
  Beat heard(double s) const {
    Beat beat;
    beat.time = stage_time(s);
    beat.beat = std::ceil(heard_beats(s));
    beat.tempo_bpm = 60.0 * sender_hz * listener_speed;
    beat.beat_time = stage_time(beat.beat / (sender_hz * listener_speed) + listener_late_s);
    beat.confidence = 1.0f;
    beat.playing = music;
    return beat;
  }
};

// Dances `seconds` through the flow and calls look(s, shown pose) for each picture.
template <class Look>
void dance(Flow& flow, const TwoHouses& houses, double begin_s, double end_s, Look look,
           bool is_silent = false) {
  static SalsaDancer dancer{SalsaStyle()};
  static Random random(3);
  struct UnderWay {
    double at_s;
    Pose pose;
  };
  std::deque<UnderWay> line;
  double next_beat = begin_s;
  for (int i = static_cast<int>(begin_s * kStageHz); i < static_cast<int>(end_s * kStageHz); ++i) {
    const double s = i / kStageHz;
    if (!is_silent) {
      Pose pose;
      const double tempo_hz = SalsaStyle().tempo_bpm / 60.0;
      dancer.dance_at(Duration::seconds(houses.sent_beats(s) / tempo_hz), pose);
      pose.capture_time = stage_time(s);
      pose.clock_id = 1;
      pose.sequence = static_cast<std::uint32_t>(i);
      pose.music_beats = houses.tagged ? houses.sent_beats(s) : kNoMusic;
      line.push_back({s + houses.delay_s + random.uniform(0.0, houses.jitter_s), pose});
    }
    for (; next_beat <= s; next_beat += 0.1) flow.hear(houses.heard(next_beat));
    while (!line.empty() && line.front().at_s <= s) {
      flow.observe(line.front().pose, stage_time(line.front().at_s));
      line.pop_front();
    }
    Pose out;
    if (flow.sample(stage_time(s), out)) look(s, out);
  }
}

// How far a shown moment is off the beat that is heard, in beats.
double off_beat(const TwoHouses& houses, double s, const Pose& shown) {
  const double danced = houses.sent_beats((shown.capture_time - stage_time(0)).as_seconds());
  const double off = houses.heard_beats(s) - danced;
  return off - std::round(off);
}

TEST(Rhythm, ShowsNothingBeforeTheFirstPose) {
  Rhythm rhythm;
  Pose out;
  EXPECT_FALSE(rhythm.sample(stage_time(0), out));
}

TEST(Rhythm, PutsTheDanceOnTheListenersBeat) {
  for (const double beats : {1.0, 2.0, 4.0})
    for (const double speed : {0.99, 1.0, 1.01})
      for (const double late_s : {0.0, 0.1, 0.25}) {
        TwoHouses houses;
        houses.listener_speed = speed;
        houses.listener_late_s = late_s;
        houses.jitter_s = 0.03;
        RhythmOptions options;
        options.beats = beats;
        Rhythm rhythm(options);
        int looked = 0;
        double least_delay_s = 10.0;
        dance(rhythm, houses, 0.0, 20.0, [&](double s, const Pose& shown) {
          if (s < 6.0) return;
          EXPECT_NEAR(off_beat(houses, s, shown), 0.0, 0.02)
              << beats << " " << speed << " " << late_s << " at " << s;
          least_delay_s =
              std::min(least_delay_s, s - (shown.capture_time - stage_time(0)).as_seconds());
          ++looked;
        });
        EXPECT_GT(looked, 800);
        EXPECT_TRUE(rhythm.is_in_time());
        EXPECT_GT(least_delay_s, 0.0);
        EXPECT_NEAR(rhythm.offset_beats() - (houses.heard_beats(20) - houses.sent_beats(20)), beats,
                    1.1);
      }
}

TEST(Rhythm, ShowsTheDanceItselfWhereEverythingHasCome) {
  TwoHouses houses;
  RhythmOptions options;
  options.beats = 2.0;
  Rhythm rhythm(options);
  SalsaDancer dancer{SalsaStyle()};
  dance(rhythm, houses, 0.0, 10.0, [&](double s, const Pose& shown) {
    if (s < 6.0) return;
    Pose truth;
    const double moment_s = (shown.capture_time - stage_time(0)).as_seconds();
    dancer.dance_at(Duration::seconds(houses.sent_beats(moment_s) * 60.0 / SalsaStyle().tempo_bpm),
                    truth);
    EXPECT_LT(largest_angle_rad(shown, truth), 0.03f);
    EXPECT_LT((shown.p_WH_m - truth.p_WH_m).norm(), 0.005f);
    EXPECT_NEAR(shown.music_beats, houses.sent_beats(moment_s), 1e-3);
  });
}

TEST(Rhythm, LeavesADanceWithoutMusicAsItCame) {
  for (const bool tagged : {false, true}) {
    TwoHouses houses;
    houses.tagged = tagged;
    houses.music = !tagged;  // either house hears nothing
    houses.jitter_s = 0.02;
    RhythmOptions options;
    options.beats = 2.0;
    Rhythm rhythm(options);
    dance(rhythm, houses, 0.0, 3.0, [&](double s, const Pose& shown) {
      if (s < 2.0) return;
      const double delay_s = s - (shown.capture_time - stage_time(0)).as_seconds();
      EXPECT_NEAR(delay_s, houses.delay_s + 0.03, 0.03);
    });
    EXPECT_FALSE(rhythm.is_in_time());
  }
}

TEST(Rhythm, LetsGoWithoutAJumpWhenTheMusicStops) {
  TwoHouses houses;
  RhythmOptions options;
  options.beats = 2.0;
  Rhythm rhythm(options);
  dance(rhythm, houses, 0.0, 8.0, [](double, const Pose&) {});
  ASSERT_TRUE(rhythm.is_in_time());
  houses.music = false;
  MonoTime before;
  double last_delay_s = 0.0;
  dance(rhythm, houses, 8.0, 16.0, [&](double s, const Pose& shown) {
    if (before.is_set()) {
      const double rate = (shown.capture_time - before).as_seconds() * kStageHz;
      EXPECT_GE(rate, kSlowestPlay - 0.01) << s;
      EXPECT_LE(rate, kFastestPlay + 0.01) << s;
    }
    before = shown.capture_time;
    last_delay_s = s - (shown.capture_time - stage_time(0)).as_seconds();
  });
  EXPECT_FALSE(rhythm.is_in_time());
  EXPECT_LT(last_delay_s, 0.25);
}

TEST(Rhythm, PredictsNothingWhereABeatOfDelayIsWished) {
  for (const double speed : {0.98, 1.0, 1.02})
    for (const double sender_hz : {2.0, 3.3}) {
      TwoHouses houses;
      houses.jitter_s = 0.02;
      houses.listener_speed = speed;
      houses.sender_hz = sender_hz;
      RhythmOptions options;
      options.beats = 1.0;
      Rhythm rhythm(options);
      int predictions = 0;
      dance(rhythm, houses, 0.0, 30.0, [&](double s, const Pose& shown) {
        const double newest_s = s - houses.delay_s - houses.jitter_s - 1.0 / kStageHz;
        predictions +=
            s > 4.0 && shown.capture_time > stage_time(newest_s + 0.5 / kStageHz) ? 1 : 0;
      });
      // Until it is sure that the delay has to grow.
      EXPECT_LE(predictions, 45) << speed << " " << sender_hz;
    }
}

TEST(Rhythm, StaysOnTheBeatThroughAStall) {
  TwoHouses houses;
  RhythmOptions options;
  options.beats = 1.0;
  Rhythm rhythm(options);
  dance(rhythm, houses, 0.0, 8.0, [](double, const Pose&) {});
  int looked = 0;
  dance(
      rhythm, houses, 8.0, 8.5,
      [&](double s, const Pose& shown) {
        EXPECT_NEAR(off_beat(houses, s, shown), 0.0, 0.02);
        ++looked;
      },
      true);
  EXPECT_EQ(looked, 30);
}

TEST(Rhythm, KeepsBodiesWholeAndJumpsSoft) {
  TwoHouses houses;
  houses.jitter_s = 0.04;
  RhythmOptions options;
  options.beats = 0.0;
  options.count = 4.0;  // long jumps
  houses.listener_speed = 1.05;
  Rhythm rhythm(options);
  Pose before;
  bool has_before = false;
  dance(rhythm, houses, 0.0, 40.0, [&](double s, const Pose& shown) {
    ASSERT_TRUE(is_valid(shown)) << s;
    for (const auto& q : shown.R_PB) ASSERT_NEAR(q.norm(), 1.0f, 1e-4f);
    if (has_before && s > 1.0) {
      EXPECT_LT((shown.p_WH_m - before.p_WH_m).norm(), 0.25f) << "at " << s;
    }
    before = shown;
    has_before = true;
  });
}

TEST(Rhythm, AtStrengthZeroChangesNothing) {
  RhythmOptions options;
  options.strength = 0.0;
  auto untouched = Flow::make({"hold 40ms", "rhythm strength=0"});
  auto held = Flow::make({"hold 40ms"});
  ASSERT_TRUE(untouched.has_value() && held.has_value());
  SalsaDancer dancer{SalsaStyle()};
  TwoHouses houses;
  for (int i = 0; i < 600; ++i) {
    Pose pose;
    dancer.dance_at(Duration::seconds(i / kStageHz), pose);
    pose.capture_time = stage_time(i / kStageHz);
    pose.clock_id = 1;
    pose.music_beats = houses.sent_beats(i / kStageHz);
    const MonoTime now = stage_time(i / kStageHz + 0.05);
    untouched->hear(houses.heard(i / kStageHz));
    untouched->observe(pose, now);
    held->observe(pose, now);
    Pose a, b;
    ASSERT_EQ(untouched->sample(now, a), held->sample(now, b));
    for (std::size_t k = 0; k < kBoneCount; ++k) ASSERT_EQ(a.R_PB[k].coeffs(), b.R_PB[k].coeffs());
    ASSERT_EQ(a.capture_time, b.capture_time);
  }
}

TEST(Rhythm, BeginsAnewWithAnotherClockAndRefusesWhatIsOld) {
  TwoHouses houses;
  Rhythm rhythm;
  dance(rhythm, houses, 0.0, 3.0, [](double, const Pose&) {});
  Pose old;
  old.capture_time = stage_time(2.0);
  old.clock_id = 1;
  rhythm.observe(old, stage_time(3.0));
  EXPECT_EQ(rhythm.counters().refused, 1u);
  Pose other;
  other.capture_time = MonoTime::from_us(5);
  other.clock_id = 2;
  rhythm.observe(other, stage_time(3.1));
  EXPECT_EQ(rhythm.counters().restarts, 1u);
  Pose out;
  ASSERT_TRUE(rhythm.sample(stage_time(3.1), out));
  EXPECT_TRUE(is_valid(out));
}

TEST(Rhythm, SurvivesTimesThatMakeNoSense) {
  Rhythm rhythm;
  Random random(11);
  MonoTime now = stage_time(0);
  for (int i = 0; i < 5000; ++i) {
    now += Duration::us(static_cast<std::int64_t>(random.uniform(-2e4, 4e4)));
    Pose pose;
    pose.clock_id = 1;
    pose.capture_time = now + Duration::seconds(random.uniform(-3.0, 1.0));
    pose.music_beats = random.uniform() < 0.3   ? kNoMusic
                       : random.uniform() < 0.3 ? random.uniform(-1e300, 1e300)
                                                : random.uniform(-1e7, 1e7);
    rhythm.observe(pose, now);
    Beat beat;
    beat.time = now;
    beat.beat_time = now + Duration::seconds(random.uniform(-1.0, 2.0));
    beat.beat = random.uniform(-1e7, 1e7);
    beat.tempo_bpm = random.uniform(kLeastTempo_bpm, kMostTempo_bpm);
    beat.confidence = 1.0f;
    beat.playing = random.uniform() < 0.8;
    if (i % 7 == 0) rhythm.hear(beat);
    Pose out;
    if (rhythm.sample(now, out)) {
      ASSERT_TRUE(is_valid(out));
    }
  }
}

TEST(Rhythm, PutsSteadyStepsOnTheBeatWithoutTags) {
  TwoHouses houses;
  houses.tagged = false;
  RhythmOptions options;
  options.beats = 2.0;
  Rhythm rhythm(options);
  double sum = 0.0, square = 0.0, count = 0.0, in_time = 0.0;
  dance(rhythm, houses, 0.0, 40.0, [&](double s, const Pose& shown) {
    if (s < 12.0) return;
    const double off = off_beat(houses, s, shown);
    sum += off;
    square += off * off;
    count += 1.0;
    in_time += rhythm.is_in_time() ? 1.0 : 0.0;
  });
  EXPECT_GT(in_time, 0.9 * count);
  const double mean = sum / count, sd = std::sqrt(square / count - mean * mean);
  // The feet of this dancer come to stand a little before the beat.
  EXPECT_LT(std::abs(mean), 0.15);
  EXPECT_LT(sd / houses.sender_hz, 0.06) << "seconds";
}

TEST(Rhythm, AllocatesNothing) {
  TwoHouses houses;
  houses.tagged = false;
  Rhythm rhythm;
  dance(rhythm, houses, 0.0, 1.0, [](double, const Pose&) {});
  std::deque<int> warm(100);
  const Pose pose;
  Pose out;
  const AllocationGuard guard;
  for (int i = 60; i < 600; ++i) {
    Pose next = pose;
    next.capture_time = stage_time(i / kStageHz);
    next.clock_id = 1;
    rhythm.observe(next, stage_time(i / kStageHz + 0.05));
    rhythm.hear(houses.heard(i / kStageHz));
    rhythm.sample(stage_time(i / kStageHz + 0.05), out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Rhythm, ItsWordsAreChecked) {
  EXPECT_TRUE(Flow::make({"rhythm"}).has_value());
  EXPECT_TRUE(Flow::make({"rhythm beats=auto error=40"}).has_value());
  EXPECT_TRUE(Flow::make({"rhythm beats=2 count=4 strength=0.5"}).has_value());
  for (const char* wrong : {"rhythm beats=nine", "rhythm beats=-1", "rhythm beats=9", "rhythm 2",
                            "rhythm strength=2", "rhythm tempo=3", "rhythm count=0"}) {
    const auto flow = Flow::make({wrong});
    ASSERT_FALSE(flow.has_value()) << wrong;
    EXPECT_NE(flow.error().what.find("rhythm"), std::string::npos) << flow.error().what;
  }
}

}  // namespace
}  // namespace dance
