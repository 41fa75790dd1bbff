// SoundTrack: the sound of a range of a recording. It mixes the house band, played again from its
// songs, and the voices; the music is quieter while a guest speaks. Recordings do not hold other
// music: missing() names it.
//
// Units/frames: interleaved stereo at kSoundRate_hz, within -0.95 to 0.95. Frame 0 is at the start
//               of the range. The same range has the same samples each time.
// Ownership:    owns two readers of the log, and the sound of some seconds.
// Failure:      open() names the log; read() fails if the band's soundfont cannot be read.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "viewer/replay/sound/recorded_band.h"
#include "viewer/replay/sound/recorded_voices.h"
#include "viewer/replay/sound/sound_log.h"
#include "voice/mix/limiter.h"

namespace dance {

class SoundTrack {
 public:
  static constexpr int kSoundRate_hz = 48000;

  struct Range {
    MonoTime from, to;
  };
  // `band` plays the house band.
  static Result<std::unique_ptr<SoundTrack>> open(const std::string& log, const ReplayIndex& index,
                                                  const Range& range, BandSound band);

  enum class Search { kGoesOn, kSound, kNone };
  // Searches the range for a song or a voice, for some milliseconds in each call. Call it until it
  // no longer returns kGoesOn, and before read().
  Search search();
  // The next frames.
  Result<void> read(std::span<float> stereo);

  // Describes the sound that was read, for a message to the user: "house band (salsa), voices of
  // alice and bob"; empty if there was none.
  std::string description() const;
  // "the music 'song' is not recorded"; empty where nothing is missing.
  std::string missing() const;

 private:
  static constexpr std::size_t kBlock_frames = RecordedBand::kBlock_frames;

  SoundTrack(SoundLog scout, SoundLog log, const ReplayIndex& index, const Range& range,
             BandSound band);
  void handle(const SoundEvent& event);
  void handle_until(MonoTime moment);
  void begin();
  Result<void> make_block();
  void duck(std::span<float> stereo);

  SoundLog scout_, log_;
  Range range_;
  bool has_sound_ = false;
  std::optional<SoundEvent> first_song_;  // the room's, else a requested one
  RecordedBand band_;
  std::unique_ptr<RecordedVoices> voices_;
  std::string no_voices_;  // the reason
  bool has_voice_packets_ = false;
  bool has_begun_ = false;
  MonoTime at_;
  float music_gain_ = 1.0f;
  Limiter limiter_;
  std::array<float, 2 * kBlock_frames> block_{};
  std::size_t used_ = 2 * kBlock_frames;
};

}  // namespace dance
