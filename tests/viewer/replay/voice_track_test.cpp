// Tests voices in the sound of a recording, beside the house band.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "testing/voice/voice_stream.h"
#include "tests/test_folder.h"
#include "tests/viewer/replay/sound_recording.h"
#include "viewer/replay/sound/sound_track.h"

namespace dance {
namespace {

constexpr double kVoiceTrack_hz = SoundTrack::kSoundRate_hz;
// A packet reaches the recorder this long after its frame began.
constexpr double kArrival_s = 0.015;

std::vector<float> steady_tone(double seconds, float amplitude) {
  std::vector<float> samples(static_cast<std::size_t>(seconds * kVoiceTrack_hz));
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = amplitude * std::sin(static_cast<float>(2.0 * std::numbers::pi * 440.0 *
                                                         static_cast<double>(i) / kVoiceTrack_hz));
  return samples;
}

// Adds the voice packets of a guest, from that second on.
void add_voice(SoundRecording& recording, Where where, const char* guest, double begin_s,
               const std::vector<float>& samples, std::optional<int> level_dbfs = {}) {
  VoiceEncoderOptions options;
  options.leaves_out_silence = false;
  const auto sent = encode_voice(samples, options);
  ASSERT_TRUE(sent) << sent.error().what;
  for (Voice packet : sent->packets) {
    const double s = begin_s + (packet.capture_time - kVoiceBegin).as_seconds();
    packet.capture_time = SoundRecording::at(s);
    packet.clock_id = SoundRecording::kClock;
    if (level_dbfs) packet.level_dbfs = *level_dbfs;
    recording.add(s + kArrival_s, Channel::of(Signal::kVoice, where, *GuestId::parse(guest)),
                  packet);
  }
}

double rms_at(const std::vector<float>& stereo, double from_s, double to_s) {
  const auto begin = 2 * static_cast<std::size_t>(from_s * kVoiceTrack_hz);
  const auto end = 2 * static_cast<std::size_t>(to_s * kVoiceTrack_hz);
  double sum = 0.0;
  for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(stereo[i] * stereo[i]);
  return std::sqrt(sum / static_cast<double>(end - begin));
}

class VoiceTrackTest : public ::testing::Test {
 protected:
  std::unique_ptr<SoundTrack> track(SoundRecording& recording, double from_s, double to_s) {
    const auto index = recording.write(log_);
    auto made =
        SoundTrack::open(log_, *index, {SoundRecording::at(from_s), SoundRecording::at(to_s)}, {});
    EXPECT_TRUE(made) << made.error().what;
    return std::move(*made);
  }

  TestFolder folder_{"voice-track"};
  std::string log_ = folder_.path("night.lcm");
};

TEST_F(VoiceTrackTest, VoicesOfBothHousesAreHeardWhenTheySpoke) {
  SoundRecording recording(8.0);
  add_voice(recording, Where::kCapture, "alice", 2.0, steady_tone(1.0, 0.3f));
  add_voice(recording, Where::kGuest, "bob", 5.0, steady_tone(1.0, 0.3f));
  auto all = track(recording, 0.0, 7.0);
  const auto sound = read_track(*all, 7.0);
  for (const double begin_s : {2.0, 5.0}) {
    EXPECT_LT(rms_at(sound, begin_s - 0.5, begin_s), 1e-3) << begin_s;
    EXPECT_GT(rms_at(sound, begin_s + 0.1, begin_s + 0.9), 0.1) << begin_s;
    EXPECT_LT(rms_at(sound, begin_s + 1.2, begin_s + 1.5), 1e-3) << begin_s;
  }
  EXPECT_EQ(all->description(), "voices of alice and bob");
}

TEST_F(VoiceTrackTest, AVoiceIsHeardFromTheBeginOfARangeThatCutsIt) {
  SoundRecording recording(8.0);
  add_voice(recording, Where::kGuest, "bob", 2.0, steady_tone(3.0, 0.3f));
  auto middle = track(recording, 3.0, 4.0);
  EXPECT_GT(rms_at(read_track(*middle, 1.0), 0.0, 0.1), 0.1);
  EXPECT_EQ(middle->description(), "voice of bob");
}

TEST_F(VoiceTrackTest, MusicGivesWayWhileSomebodySpeaks) {
  const RoomSong song = room_song(BandStyle::kSalsa, 9, -5.0);
  SoundRecording recording(8.0);
  recording.add_song(0.0, 8.0, song);
  // Packets of silence that state a loud level: only the music is heard.
  add_voice(recording, Where::kGuest, "bob", 2.0, std::vector<float>(2 * 48'000), -20);
  const auto sound = read_track(*track(recording, 0.0, 7.0), 7.0);
  const auto score = score_sound(song, 0.0, 7.0);
  const auto share = [&](double from_s, double to_s) {
    return rms_at(sound, from_s, to_s) / rms_at(score, from_s, to_s);
  };
  EXPECT_EQ(share(1.0, 2.0), 1.0);
  EXPECT_NEAR(share(2.5, 4.5), 0.5, 0.01);
  EXPECT_EQ(share(6.0, 7.0), 1.0);
}

TEST_F(VoiceTrackTest, ManyLoudVoicesAndTheBandDoNotClip) {
  SoundRecording recording(5.0);
  recording.add_song(0.0, 5.0, room_song(BandStyle::kSalsa, 9, -5.0));
  for (const char* guest : {"bob", "carl", "dora"})
    add_voice(recording, Where::kGuest, guest, 1.0, steady_tone(2.0, 0.9f));
  const auto sound = read_track(*track(recording, 0.0, 4.0), 4.0);
  EXPECT_LE(*std::max_element(sound.begin(), sound.end()), 0.951f);
  EXPECT_GE(*std::min_element(sound.begin(), sound.end()), -0.951f);
  EXPECT_GT(rms_at(sound, 1.5, 2.5), 0.3);
}

}  // namespace
}  // namespace dance
