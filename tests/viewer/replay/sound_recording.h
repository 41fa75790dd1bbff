// SoundRecording: makes a recording for tests of sound. In it alice dances; a test adds songs,
// beats and voices.
//
// Units/frames: seconds since the start of the recording; times of the recorded house's clock.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/bus/encode.h"
#include "formats/replay/replay_index.h"
#include "viewer/replay/sound/sound_track.h"

namespace dance {

class SoundRecording {
 public:
  static constexpr std::uint64_t kClock = 7;
  static MonoTime at(double s) { return MonoTime() + Duration::seconds(500.0 + s); }

  explicit SoundRecording(double seconds);

  template <BusMessage Message>
  void add(double s, const Channel& channel, const Message& message) {
    MessageBuffer buffer;
    const std::size_t size = encode(message, buffer);
    events_.push_back({s, channel, {buffer.begin(), buffer.begin() + size}});
  }
  // Adds a song that is in force in the room, published once a second.
  void add_song(double from_s, double to_s, const RoomSong& song);
  // Adds the beats of a house that plays the song; `shift_beats` makes them those of other music.
  void add_beats(double from_s, double to_s, const RoomSong& song, double shift_beats = 0.0);

  // Writes the log and returns its index.
  std::shared_ptr<const ReplayIndex> write(const std::string& path);

 private:
  struct Event {
    double s;
    Channel channel;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Event> events_;
};

// Returns a playing song whose first bar begins at that second.
RoomSong room_song(BandStyle style, std::uint32_t seed, double begin_s);
// Returns the sound of the song's score from that second of the recording on, with the band's own
// instruments.
std::vector<float> score_sound(const RoomSong& song, double from_s, double seconds);
// Reads all of a track, `piece_frames` at a time.
std::vector<float> read_track(SoundTrack& track, double seconds, std::size_t piece_frames = 1000);

}  // namespace dance
