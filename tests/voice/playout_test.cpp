#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "testing/line/lossy_line.h"
#include "testing/voice/sound_match.h"
#include "testing/voice/voice_stream.h"
#include "tests/allocation_guard.h"
#include "tests/voice/voices.h"
#include "voice/playout/voice_playout.h"

namespace dance {
namespace {

// Encoded once.
const SentVoice& sent_of(double seconds, double drift = 0.0, bool has_pauses = true) {
  static std::map<std::tuple<double, double, bool>, SentVoice> made;
  const auto found = made.find({seconds, drift, has_pauses});
  if (found != made.end()) return found->second;
  VoiceEncoderOptions options;
  if (drift != 0.0) options.mode = VoiceMode::kLowDelay;  // a quarter of the work
  auto sent = encode_voice(hummed(seconds, has_pauses), options, drift);
  EXPECT_TRUE(sent) << sent.error().what;
  return made[{seconds, drift, has_pauses}] = *sent;
}

LossyModel line_of(const std::string& words) {
  auto spec = LossySpec::parse(words);
  EXPECT_TRUE(spec) << spec.error().what;
  return LossyModel({*spec}, 0);
}

HeardVoice heard_over(const SentVoice& sent, LossyModel line,
                      std::optional<Duration> picture = std::nullopt) {
  auto heard = play_voice(sent, voice_arrivals(sent, line), picture);
  EXPECT_TRUE(heard) << heard.error().what;
  return *heard;
}

double concealed_share(const HeardVoice& heard) {
  return static_cast<double>(heard.counters.concealed) / static_cast<double>(heard.counters.played);
}

TEST(VoicePlayout, APerfectLineIsPlayedAsItWasSpoken) {
  const auto sound = hummed(9.0, true);
  const SentVoice& sent = sent_of(9.0);
  const HeardVoice heard = heard_over(sent, line_of("delay=30ms"));
  EXPECT_EQ(heard.counters.concealed, 0u);
  EXPECT_EQ(heard.counters.late, 0u);
  EXPECT_GT(heard.counters.played, 550u) << "two seconds of three are speech";
  // 30 ms of the line, 10 of the frame, and the least that is waited.
  EXPECT_LT(heard.delay_mean_ms, 70.0);
  const MatchFigures figures = figures_of(match_sound(sound, heard.samples, 0.0, 200.0));
  EXPECT_GE(figures.fitting * 10, figures.pieces * 9);
  EXPECT_NEAR(figures.median_ms, heard.delay_mean_ms + sent.look_ahead.as_ms(), 12.0);
}

TEST(VoicePlayout, LossIsMadeGoodFromCopiesAndTheRestMadeUp) {
  const SentVoice& sent = sent_of(20.0);
  const HeardVoice heard = heard_over(sent, line_of("delay=40ms loss=3%"));
  const double lost = 0.03 * static_cast<double>(heard.counters.played);
  EXPECT_GT(static_cast<double>(heard.counters.recovered), 0.5 * lost);
  EXPECT_LT(concealed_share(heard), 0.02);
  EXPECT_GT(heard.counters.recovered + heard.counters.concealed, 15u);
}

// As behind a queue that is full: the two packets after a lost one are late. No others are, so that
// nothing else makes play-out wait.
TEST(VoicePlayout, WaitsForTheCopyOfALostFrameWhereFramesAreLost) {
  const SentVoice& sent = sent_of(20.0, 0.0, false);
  const auto heard_with = [&](bool is_lossy) {
    std::vector<VoiceArrival> arrivals;
    for (std::size_t i = 0; i < sent.packets.size(); ++i) {
      if (is_lossy && i % 100 == 50) continue;
      const Duration late = Duration::ms(i % 100 == 51 ? 12 : i % 100 == 52 ? 6 : 0);
      arrivals.push_back({sent.packets[i].capture_time + kVoiceFrame + Duration::ms(20) + late, i});
    }
    std::stable_sort(arrivals.begin(), arrivals.end(),
                     [](const VoiceArrival& a, const VoiceArrival& b) { return a.at < b.at; });
    auto heard = play_voice(sent, arrivals);
    EXPECT_TRUE(heard) << heard.error().what;
    return *heard;
  };
  const HeardVoice lossy = heard_with(true), whole = heard_with(false);
  // Of 20; without waiting none, and 31 frames are made up.
  EXPECT_GE(lossy.counters.recovered, 9u);
  EXPECT_LE(lossy.counters.concealed, 15u);
  EXPECT_GT(lossy.delay_mean_ms, whole.delay_mean_ms + 3.0);
  EXPECT_LT(whole.delay_mean_ms, 55.0) << "without loss there is no copy to wait for";
}

TEST(VoicePlayout, WaitsLongerWhereTheLineHasJitterAndNoLongerThanThat) {
  const SentVoice& sent = sent_of(20.0);
  const HeardVoice calm = heard_over(sent, line_of("delay=40ms jitter=1ms"));
  const HeardVoice rough = heard_over(sent, line_of("delay=80ms jitter=40ms"));
  EXPECT_LT(concealed_share(calm), 0.01);
  EXPECT_LT(concealed_share(rough), 0.02);
  EXPECT_LT(calm.delay_mean_ms, 80.0);
  EXPECT_GT(rough.delay_mean_ms, calm.delay_mean_ms + 40.0);
  EXPECT_LT(rough.delay_p95_ms, 190.0);
}

TEST(VoicePlayout, FollowsAnotherHousesSoundCardWithoutAGap) {
  for (const double drift : {400e-6, -400e-6}) {
    // 16 ms apart at the end, without a pause in which to put it right.
    const SentVoice& sent = sent_of(40.0, drift, false);
    const HeardVoice heard = heard_over(sent, line_of("delay=30ms"));
    std::printf("%.0f ppm: %llu samples shorter, %llu longer, %llu concealed\n", drift * 1e6,
                static_cast<unsigned long long>(heard.counters.shortened_samples),
                static_cast<unsigned long long>(heard.counters.lengthened_samples),
                static_cast<unsigned long long>(heard.counters.concealed));
    EXPECT_EQ(heard.counters.late, 0u) << drift;
    EXPECT_EQ(heard.counters.skipped, 0u) << drift;
    EXPECT_LT(concealed_share(heard), 0.001) << drift;
    EXPECT_LT(heard.delay_p95_ms, 75.0) << drift;
    const auto stretched = static_cast<double>(drift > 0.0 ? heard.counters.shortened_samples
                                                           : heard.counters.lengthened_samples);
    EXPECT_NEAR(stretched / 48.0, 16.0, 14.0) << "milliseconds, for " << drift;
  }
}

TEST(VoicePlayout, OverRecordedLinesLittleIsMadeUp) {
  const std::filesystem::path folder = DANCE_SOURCE_DIR "/../shared/data/traces";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recorded lines at " << folder;
  const SentVoice& sent = sent_of(20.0);
  int lines = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    LineWords words;
    words.traces = {file.path().string()};
    const auto line = load_line(words);
    ASSERT_TRUE(line) << line.error().what;
    LossyModel model(line->up, 0);
    const auto arrivals = voice_arrivals(sent, model);
    const auto heard = play_voice(sent, arrivals);
    ASSERT_TRUE(heard);
    const double never =
        static_cast<double>(model.counters().lost + model.counters().queue_dropped) /
        static_cast<double>(model.counters().offered);
    EXPECT_LT(concealed_share(*heard), 0.02 + never) << file.path().filename();
    // As good as a buffer of the same mean delay that was told it beforehand.
    const double fixed =
        missed_at_fixed_delay(sent, arrivals, Duration::seconds(heard->delay_mean_ms * 1e-3));
    EXPECT_LT(concealed_share(*heard), fixed + 0.01) << file.path().filename();
    ++lines;
  }
  EXPECT_GT(lines, 3);
}

TEST(VoicePlayout, IsAsLateAsThePictureWhereThatIsWanted) {
  const SentVoice& sent = sent_of(9.0);
  const HeardVoice heard = heard_over(sent, line_of("delay=30ms"), Duration::ms(480));
  EXPECT_NEAR(heard.delay_mean_ms, 480.0, 12.0);
  EXPECT_EQ(heard.counters.concealed, 0u);
  // Never earlier than the line allows.
  EXPECT_GT(heard_over(sent, line_of("delay=90ms"), Duration::ms(20)).delay_mean_ms, 90.0);
}

Voice packet_of(const SentVoice& sent, std::size_t i, std::uint32_t begin) {
  Voice voice = sent.packets[i];
  voice.sequence += begin;
  return voice;
}

class PlayoutByHand : public ::testing::Test {
 protected:
  PlayoutByHand() : playout_(std::move(*VoiceDecoder::create())) {}
  // One frame's time: what came, and then what is played.
  void turn() {
    VoiceFrame frame;
    playout_.pull(now_, now_, frame);
    now_ += kVoiceFrame;
  }
  void say(std::size_t first, std::size_t count, std::uint32_t begin) {
    for (std::size_t i = first; i < first + count; ++i) {
      Voice voice = packet_of(sent_, i, begin);
      voice.capture_time = now_ - Duration::ms(30);
      playout_.put(voice, now_);
      turn();
    }
  }
  const SentVoice& sent_ = sent_of(6.0, 0.0, false);
  VoicePlayout playout_;
  VoicePlayout::Counters before_;
  MonoTime now_ = kVoiceBegin;
};

// A sound server with a large buffer asks seldom and for much.
TEST_F(PlayoutByHand, SoundThatIsAskedForInBurstsHasNoGaps) {
  std::array<float, 4 * kVoiceFrameSamples> samples;
  for (std::size_t i = 0; i < 500; ++i) {
    Voice voice = packet_of(sent_, i, 0);
    voice.capture_time = now_ - Duration::ms(30);
    playout_.put(voice, now_);
    if (i == 100) before_ = playout_.counters();
    if (i % 4 == 3) playout_.pull(now_, now_ + Duration::ms(80), samples);
    now_ += kVoiceFrame;
  }
  EXPECT_GT(playout_.counters().played, 450u);
  EXPECT_EQ(playout_.counters().concealed, before_.concealed) << "once the bursts are known";
}

TEST_F(PlayoutByHand, SequencesWrap) {
  say(0, 200, 0xffffffffu - 100u);
  EXPECT_EQ(playout_.counters().concealed, 0u);
  EXPECT_EQ(playout_.counters().late, 0u);
  EXPECT_GT(playout_.counters().played, 190u);
}

TEST_F(PlayoutByHand, ASenderThatWasStartedAgainIsHeardAgain) {
  say(0, 200, 1'000'000);
  const auto before = playout_.counters().played;
  say(0, 300, 5);
  EXPECT_GT(playout_.counters().played, before + 250);
  say(0, 200, 0x7fffffffu);
  EXPECT_GT(playout_.counters().played, before + 250 + 150);
}

TEST_F(PlayoutByHand, AStallIsNotCaughtUpWithForever) {
  say(0, 200, 0);
  for (int i = 0; i < 100; ++i) turn();  // a second in which nothing comes
  EXPECT_FALSE(playout_.is_speaking());
  const auto made_up = playout_.counters().concealed;
  EXPECT_LT(made_up, 20u) << "after a moment there is nothing left to make up";
  for (std::size_t i = 200; i < 300; ++i) {
    Voice voice = packet_of(sent_, i, 0);
    voice.capture_time =
        kVoiceBegin + kVoiceFrame * static_cast<std::int64_t>(i) - Duration::ms(30);
    playout_.put(voice, now_);
  }
  say(300, 200, 0);
  EXPECT_GT(playout_.counters().skipped, 40u);
  ASSERT_TRUE(playout_.delay());
  EXPECT_LT(*playout_.delay(), Duration::ms(700)) << "and less and less";
}

TEST_F(PlayoutByHand, DoubleAndLatePacketsChangeNothing) {
  for (std::size_t i = 0; i < 100; ++i) {
    Voice voice = packet_of(sent_, i, 0);
    voice.capture_time = now_ - Duration::ms(30);
    playout_.put(voice, now_);
    playout_.put(voice, now_);
    if (i > 20) playout_.put(packet_of(sent_, i - 20, 0), now_);
    turn();
  }
  EXPECT_EQ(playout_.counters().duplicate, 179u);
  EXPECT_EQ(playout_.counters().late, 0u) << "those played already are double, not late";
  EXPECT_EQ(playout_.counters().concealed, 0u);
}

TEST_F(PlayoutByHand, AllocatesNothing) {
  const AllocationGuard guard;
  say(0, 100, 0);
  for (int i = 0; i < 30; ++i) turn();
  say(130, 100, 0);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
