#include "tests/viewer/replay/sound_recording.h"

#include <algorithm>
#include <cmath>

#include "formats/log/log_file.h"
#include "viewer/replay/index_builder.h"

namespace dance {
namespace {

constexpr std::int64_t kWallAhead_us = 1'700'000'000'000'000;
constexpr double kPoses_hz = 30.0;
constexpr double kBeats_hz = 10.0;

GuestId guest(const char* name) { return *GuestId::parse(name); }

}  // namespace

SoundRecording::SoundRecording(double seconds) {
  for (int i = 0; i <= static_cast<int>(seconds * kPoses_hz); ++i) {
    const double s = i / kPoses_hz;
    Pose pose;
    pose.R_PB = identity_rotations();
    pose.p_WH_m = {0.0f, 1.0f, 0.0f};
    pose.clock_id = kClock;
    pose.sequence = static_cast<std::uint32_t>(i);
    pose.capture_time = at(s - 0.03);
    pose.stamp(Hop::kStaged, at(s));
    add(s, Channel::of(Signal::kPose, Where::kStage, guest("alice")), pose);
  }
}

void SoundRecording::add_song(double from_s, double to_s, const RoomSong& song) {
  for (double s = from_s; s < to_s; s += 1.0)
    add(s, Channel::of(Signal::kSong, Where::kRoom, guest("bob")), song);
}

void SoundRecording::add_beats(double from_s, double to_s, const RoomSong& song,
                               double shift_beats) {
  BandSet set;
  ASSERT_TRUE(set.set(song));
  for (int i = 0; from_s + i / kBeats_hz < to_s; ++i) {
    const double s = from_s + i / kBeats_hz;
    const double set_s = (at(s) - song.start_time).as_seconds();
    const Song::NextBeat next = set.next_beat(set_s);
    Beat beat;
    beat.time = at(s);
    beat.clock_id = kClock;
    beat.beat = next.beat + shift_beats;
    beat.beat_time = at(s) + Duration::seconds(next.song_s - set_s);
    beat.tempo_bpm = next.tempo_bpm;
    beat.beats_per_bar = 4;
    beat.confidence = 1.0f;
    beat.playing = true;
    add(s, Channel::of_house(Signal::kBeat), beat);
  }
}

std::shared_ptr<const ReplayIndex> SoundRecording::write(const std::string& path) {
  std::stable_sort(events_.begin(), events_.end(),
                   [](const Event& a, const Event& b) { return a.s < b.s; });
  auto writer = LogWriter::create(path);
  EXPECT_TRUE(writer) << writer.error().what;
  for (const Event& event : events_)
    EXPECT_TRUE(writer->append(at(event.s).since_zero_us() + kWallAhead_us, event.channel.view(),
                               event.bytes));
  EXPECT_TRUE(writer->flush());
  auto index = build_index(path, false, {});
  EXPECT_TRUE(index) << index.error().what;
  return std::make_shared<const ReplayIndex>(std::move(*index));
}

RoomSong room_song(BandStyle style, std::uint32_t seed, double begin_s) {
  RoomSong song;
  song.time = song.start_time = SoundRecording::at(begin_s);
  song.clock_id = SoundRecording::kClock;
  song.style = static_cast<int>(style);
  song.seed = seed;
  song.playing = true;
  song.tempo_centi_bpm[0] = 100 * usual_tempo_bpm(style);
  return song;
}

std::vector<float> score_sound(const RoomSong& song, double from_s, double seconds) {
  auto set = std::make_shared<BandSet>();
  EXPECT_TRUE(set->set(song));
  auto source = BandSource::make(set, {});
  EXPECT_TRUE(source) << source.error().what;
  const double song_s = (SoundRecording::at(from_s) - song.start_time).as_seconds();
  std::vector<float> stereo(2 * static_cast<std::size_t>(std::llround(seconds * kBandRate_hz)));
  EXPECT_TRUE((*source)->read(std::llround(song_s * kBandRate_hz), stereo));
  return stereo;
}

std::vector<float> read_track(SoundTrack& track, double seconds, std::size_t piece_frames) {
  while (track.search() == SoundTrack::Search::kGoesOn) {
  }
  std::vector<float> all(
      2 * static_cast<std::size_t>(std::llround(seconds * SoundTrack::kSoundRate_hz)));
  for (std::size_t i = 0; i < all.size(); i += 2 * piece_frames)
    EXPECT_TRUE(track.read(std::span(all).subspan(i, std::min(2 * piece_frames, all.size() - i))));
  return all;
}

}  // namespace dance
