#include "producers/music/tracker/beat_tracker.h"

#include <gtest/gtest.h>

#include <limits>

#include "testing/music/beat_score.h"
#include "tests/allocation_guard.h"
#include "tests/producers/music/drum_music.h"

namespace dance {
namespace {

constexpr double kRate_hz = 22050.0;

struct Tracked {
  std::vector<Beat> words;
  std::vector<double> beats_s;
};

Tracked track(std::span<const float> samples, double rate_hz = kRate_hz,
              const TempoHint& hint = {}) {
  BeatTracker tracker(rate_hz);
  tracker.set_tempo_hint(hint);
  PredictedBeats beats(static_cast<double>(tracker.hop_samples()) / rate_hz);
  Tracked tracked;
  for (; samples.size() >= tracker.hop_samples();
       samples = samples.subspan(tracker.hop_samples())) {
    EXPECT_EQ(tracker.push(samples.first(tracker.hop_samples())), 1);
    EXPECT_TRUE(is_valid(tracker.beat()));
    beats.hear(tracker.beat());
    tracked.words.push_back(tracker.beat());
  }
  tracked.beats_s = beats.times_s();
  return tracked;
}

BeatScore score(const std::vector<double>& truth_s, const Tracked& tracked, double from_s = 5.0) {
  return score_beats(truth_s, tracked.beats_s, from_s, truth_s.back());
}

bool says_the_same(const Beat& a, const Beat& b) {
  return a.time == b.time && a.beat_time == b.beat_time && a.beat == b.beat &&
         a.tempo_bpm == b.tempo_bpm && a.confidence == b.confidence && a.playing == b.playing;
}

TEST(BeatTracker, PredictsTheClicksOfAMetronome) {
  const auto beats = DrumMusic::steady(14.0, 126.0);
  const BeatScore s = score(beats, track(DrumMusic(kRate_hz).clicks(beats, 14.0)));
  EXPECT_GE(s.f_measure(), 0.97);
  EXPECT_LE(std::abs(s.mean_error_s), 0.015);
  EXPECT_LE(s.sd_error_s, 0.010);
}

TEST(BeatTracker, FindsEachTempoOfDancesAndNotItsHalf) {
  for (const double bpm : {104.0, 122.0, 143.0, 162.0, 184.0}) {
    const auto beats = DrumMusic::steady(14.0, bpm);
    const Tracked tracked = track(DrumMusic(kRate_hz).play(beats, 14.0));
    EXPECT_NEAR(tracked.words.back().tempo_bpm, bpm, 0.02 * bpm);
    const BeatScore s = score(beats, tracked);
    EXPECT_GE(s.f_measure(), 0.95) << bpm;
    EXPECT_LE(std::abs(s.mean_error_s), 0.015) << bpm;
    EXPECT_LE(s.sd_error_s, 0.015) << bpm;
  }
}

TEST(BeatTracker, TracksSalsaAtItsOwnTempoAndOnTheBeat) {
  for (const double bpm : {140.0, 166.0, 182.0, 200.0}) {
    const auto beats = DrumMusic::steady(14.0, bpm);
    const Tracked tracked = track(DrumMusic(kRate_hz).play_salsa(beats, 14.0));
    EXPECT_NEAR(tracked.words.back().tempo_bpm, bpm, 0.02 * bpm);
    EXPECT_GE(score(beats, tracked, 6.0).f_measure(), 0.95) << bpm;
  }
}

TEST(BeatTracker, TakesTheLevelAtWhichItsDancersStep) {
  // Clicks alone do not say which of them are beats.
  const auto clicks = DrumMusic::steady(20.0, 184.0);
  const std::vector<float> music = DrumMusic(kRate_hz).clicks(clicks, 20.0);
  for (const double bpm : {92.0, 184.0}) {
    const Tracked tracked = track(music, kRate_hz, {bpm, 1.0});
    EXPECT_NEAR(tracked.words.back().tempo_bpm, bpm, 0.03 * bpm);
  }
}

TEST(BeatTracker, TurnsToTheLevelOfDancersWhoBeginLater) {
  const auto clicks = DrumMusic::steady(40.0, 184.0);
  const std::vector<float> music = DrumMusic(kRate_hz).clicks(clicks, 40.0);
  BeatTracker tracker(kRate_hz);
  const std::size_t middle = music.size() / 2;
  for (const double bpm : {184.0, 92.0}) {
    tracker.set_tempo_hint({bpm, 1.0});
    tracker.push(bpm == 184.0 ? std::span(music).first(middle) : std::span(music).subspan(middle));
    EXPECT_NEAR(tracker.beat().tempo_bpm, bpm, 0.03 * bpm);
  }
}

TEST(BeatTracker, FollowsATempoThatDrifts) {
  const auto beats = DrumMusic::beats(30.0, [](double t) {
    return 160.0 * (1.0 + 0.05 * std::sin(2.0 * std::numbers::pi * t / 20.0));
  });
  const BeatScore s = score(beats, track(DrumMusic(kRate_hz).play(beats, 30.0)));
  EXPECT_GE(s.f_measure(), 0.95);
  EXPECT_LE(s.sd_error_s, 0.020);
}

TEST(BeatTracker, IsOnTheNewTempoFourSecondsAfterAStep) {
  const auto beats = DrumMusic::beats(24.0, [](double t) { return t < 12.0 ? 128.0 : 168.0; });
  const Tracked tracked = track(DrumMusic(kRate_hz).play(beats, 24.0));
  EXPECT_GE(score(beats, tracked, 16.0).f_measure(), 0.95);
  EXPECT_NEAR(tracked.words.back().tempo_bpm, 168.0, 4.0);
}

TEST(BeatTracker, CountsOnThroughABreak) {
  const double period_s = 60.0 / 132.0;
  const auto beats = DrumMusic::steady(24.0, 132.0);
  // Eight beats of nothing.
  const double from_s = 0.3 + 24 * period_s - 0.01;
  const Tracked tracked =
      track(DrumMusic(kRate_hz).play(beats, 24.0, from_s, from_s + 8 * period_s));
  EXPECT_GE(score(beats, tracked).f_measure(), 0.97);
  // A count from the fifth second on is right at the end.
  const auto at = [&](double t) {
    const MonoTime time = MonoTime{} + Duration::seconds(t);
    std::size_t k = 0;
    while (tracked.words[k].time < time) ++k;
    return tracked.words[k].beats_at(time);
  };
  EXPECT_NEAR(at(23.0) - at(6.0), 17.0 / period_s, 0.1);
}

TEST(BeatTracker, KeepsTheBeatThroughAVerseOnTheHalves) {
  // Seventeen seconds of rock, then a verse in which all the drums strike half a beat later, and
  // rock again.
  constexpr double kBpm = 140.0, kWhole_s = 30.0;
  const double period_s = 60.0 / kBpm;
  constexpr int kVerse_beats = 10;
  const double from_s = 0.3 + 40 * period_s - 0.01;
  const double to_s = from_s + kVerse_beats * period_s;
  const DrumMusic band(kRate_hz);
  const std::vector<double> beats = DrumMusic::steady(kWhole_s, kBpm);
  std::vector<float> music = band.play(beats, kWhole_s, from_s, to_s);
  std::vector<double> halves = beats;
  for (double& beat_s : halves) beat_s += 0.5 * period_s;
  const std::vector<float> late = band.play(halves, kWhole_s);
  const auto sample = [&](double t) {
    return static_cast<std::ptrdiff_t>(std::lround((t + 0.25 * period_s) * kRate_hz));
  };
  std::copy(late.begin() + sample(from_s), late.begin() + sample(to_s - 0.5 * period_s),
            music.begin() + sample(from_s));
  // Some beats of the verse may be told where its drums strike.
  EXPECT_GE(score(beats, track(music)).f_measure(), 0.93);
}

TEST(BeatTracker, FindsTheNextSongAfterAPause) {
  // The same tempo half a beat later: the hardest song to tell from the last. In five seconds of
  // nothing the tempo grows so uncertain that the beat may be anywhere.
  constexpr double kBpm = 136.0, kFirst_s = 16.0, kPause_s = 5.0, kSecond_s = 14.0;
  const double period_s = 60.0 / kBpm;
  const DrumMusic band(kRate_hz);
  std::vector<float> music = band.play(DrumMusic::steady(kFirst_s, kBpm), kFirst_s);
  const double again_s = std::ceil((kFirst_s + kPause_s) / period_s) * period_s + 0.5 * period_s;
  music.resize(static_cast<std::size_t>(again_s * kRate_hz), 0.0f);
  std::vector<double> beats = DrumMusic::steady(kSecond_s, kBpm);
  const std::vector<float> second = band.play(beats, kSecond_s);
  music.insert(music.end(), second.begin(), second.end());
  for (double& beat_s : beats) beat_s += again_s;
  EXPECT_GE(score(beats, track(music), again_s + 6.0).f_measure(), 0.95);
}

TEST(BeatTracker, NumbersEachBeatOnce) {
  const auto beats = DrumMusic::beats(24.0, [](double t) { return t < 12.0 ? 180.0 : 140.0; });
  const Tracked tracked = track(DrumMusic(kRate_hz).play(beats, 24.0));
  for (std::size_t k = 1; k < tracked.words.size(); ++k) {
    const double step = tracked.words[k].beat - tracked.words[k - 1].beat;
    EXPECT_TRUE(step == 0.0 || step == 1.0 || (step == 2.0 && k < 1600)) << k;
    EXPECT_GT(tracked.words[k].beat_time, tracked.words[k].time);
  }
}

TEST(BeatTracker, DoesNotHangOnLoudness) {
  const auto beats = DrumMusic::steady(14.0, 150.0);
  std::vector<float> music = DrumMusic(kRate_hz).play(beats, 14.0);
  const Tracked plain = track(music);
  for (const float gain : {0.03f, 20.0f}) {
    std::vector<float> louder(music);
    for (float& x : louder) x *= gain;
    const Tracked other = track(louder);
    ASSERT_EQ(other.beats_s.size(), plain.beats_s.size());
    for (std::size_t i = 0; i < plain.beats_s.size(); ++i)
      EXPECT_NEAR(other.beats_s[i], plain.beats_s[i], 0.003);
  }
}

TEST(BeatTracker, HearsThroughNoise) {
  const auto beats = DrumMusic::steady(14.0, 150.0);
  std::vector<float> music = DrumMusic(kRate_hz).play(beats, 14.0);
  Random random(3);
  for (float& x : music) x += static_cast<float>(random.uniform(-0.02, 0.02));
  EXPECT_GE(score(beats, track(music)).f_measure(), 0.95);
}

TEST(BeatTracker, IsSilentAboutSilence) {
  const std::vector<float> nothing(static_cast<std::size_t>(6.0 * kRate_hz), 0.0f);
  for (const Beat& word : track(nothing).words) {
    EXPECT_FALSE(word.playing);
    EXPECT_EQ(word.confidence, 0.0f);
  }
}

TEST(BeatTracker, SaysThatTheMusicIsOver) {
  const auto beats = DrumMusic::steady(8.0, 120.0);
  std::vector<float> music = DrumMusic(kRate_hz).play(beats, 8.0);
  music.resize(static_cast<std::size_t>(18.0 * kRate_hz), 0.0f);
  const Tracked tracked = track(music);
  EXPECT_TRUE(tracked.words[700].playing);
  EXPECT_FALSE(tracked.words.back().playing);
}

TEST(BeatTracker, TakesWhatIsNoNumberForSilence) {
  const auto beats = DrumMusic::steady(12.0, 140.0);
  std::vector<float> music = DrumMusic(kRate_hz).play(beats, 12.0);
  std::vector<float> silenced(music);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < music.size(); i += 997) {
    music[i] = i % 2 == 0 ? kNan : -kInfinity;
    silenced[i] = 0.0f;
  }
  const Tracked a = track(music);
  const Tracked b = track(silenced);
  for (std::size_t k = 0; k < a.words.size(); ++k)
    EXPECT_TRUE(says_the_same(a.words[k], b.words[k]));
}

TEST(BeatTracker, NeverUsesTheFuture) {
  const auto beats = DrumMusic::steady(12.0, 150.0);
  const std::vector<float> music = DrumMusic(kRate_hz).play(beats, 12.0);
  const Tracked plain = track(music);
  for (const double from_s : {3.0, 7.5}) {
    std::vector<float> poisoned(music);
    const auto from = static_cast<std::size_t>(from_s * kRate_hz);
    std::fill(poisoned.begin() + static_cast<std::ptrdiff_t>(from), poisoned.end(),
              std::numeric_limits<float>::quiet_NaN());
    const Tracked other = track(poisoned);
    for (std::size_t k = 0; plain.words[k].time <= MonoTime{} + Duration::seconds(from_s); ++k)
      ASSERT_TRUE(says_the_same(plain.words[k], other.words[k]));
  }
}

TEST(BeatTracker, DoesNotHangOnHowSamplesArePacked) {
  const auto beats = DrumMusic::steady(6.0, 150.0);
  const std::vector<float> music = DrumMusic(kRate_hz).play(beats, 6.0);
  const Tracked by_hop = track(music);
  BeatTracker tracker(kRate_hz);
  int hops = 0;
  for (std::size_t at = 0, n = 1; at < music.size(); at += n, n = n * 7 % 1031 + 1) {
    n = std::min(n, music.size() - at);
    hops += tracker.push(std::span(music).subspan(at, n));
    if (hops == 0) continue;
    ASSERT_TRUE(says_the_same(tracker.beat(), by_hop.words[static_cast<std::size_t>(hops - 1)]));
  }
  EXPECT_EQ(hops, static_cast<int>(by_hop.words.size()));
}

TEST(BeatTracker, WorksAtEachSampleRate) {
  for (const double rate_hz : {8000.0, 11025.0, 44100.0, 48000.0, 96000.0}) {
    const auto beats = DrumMusic::steady(12.0, 140.0);
    const Tracked tracked = track(DrumMusic(rate_hz).play(beats, 12.0), rate_hz);
    const BeatScore s = score(beats, tracked);
    EXPECT_GE(s.f_measure(), 0.95) << rate_hz;
    EXPECT_LE(std::abs(s.mean_error_s), 0.020) << rate_hz;
  }
}

TEST(BeatTracker, AllocatesNothing) {
  const auto beats = DrumMusic::steady(4.0, 140.0);
  const std::vector<float> music = DrumMusic(kRate_hz).play(beats, 4.0);
  BeatTracker tracker(kRate_hz);
  const AllocationGuard guard;
  tracker.set_tempo_hint({140.0, 0.5});
  tracker.push(music);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
