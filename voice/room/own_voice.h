// OwnVoice: frames of the microphone to packets for the others: cleaned, levelled, encoded, and
// silent while the dancer does not want to be heard.
//
// Units/frames: 10 ms frames, mono, 48 kHz; times of this house's clock; levels in dBFS.
// Ownership:    owns cleaner and encoder.
// Threads:      none inside; one owner.
// Failure:      create() passes on what the libraries refuse.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "core/bus/voice.h"
#include "voice/clean/voice_cleaner.h"
#include "voice/codec/voice_encoder.h"

namespace dance {

class OwnVoice {
 public:
  static Result<std::unique_ptr<OwnVoice>> create(const VoiceCleanerOptions& cleaning,
                                                  const VoiceEncoderOptions& encoding,
                                                  std::uint64_t clock_id);

  void hear_loudspeaker(std::span<const float, kVoiceFrameSamples> frame) {
    cleaner_->hear_loudspeaker(frame);
  }
  // Nothing where this frame is silence, which is left out.
  std::optional<Voice> take(std::span<float, kVoiceFrameSamples> frame, MonoTime captured,
                            Duration echo_delay, bool sends);
  // Whether it is what take() made in the last five seconds, as it comes back from the bus; what a
  // replay makes of the same guest is not.
  bool has_made(const Voice& voice) const;
  // Of the last frame, cleaned, sent or not.
  int level() const { return level_dbfs_; }
  std::uint64_t sent() const { return sent_; }

 private:
  static constexpr std::size_t kRemembered = 512;
  OwnVoice() = default;

  std::unique_ptr<VoiceCleaner> cleaner_;
  std::unique_ptr<VoiceEncoder> encoder_;
  std::uint64_t clock_id_ = 0;
  std::uint32_t sequence_ = 0;
  int level_dbfs_ = kSilence_dbfs;
  std::uint64_t sent_ = 0;
  std::array<std::int64_t, kRemembered> made_us_{};  // capture times, by sequence
};

}  // namespace dance
