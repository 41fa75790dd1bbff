// VoiceCleaner: takes out of a microphone's sound what the loudspeaker plays (the others' voices,
// and the music), noise that stays, and differences in loudness.
//
// Units/frames: 10 ms frames, mono, 48 kHz, samples -1 to 1.
// Ownership:    owns the library's processor.
// Threads:      none inside; one owner.
// Failure:      create() says what the library refused; a frame that it refuses stays as it is, and
//               is counted in refused().
// Source:       the audio processing module of WebRTC: Debian's libwebrtc-audio-processing,
//               version 0.3 (Debian 12) or 1.3 (Debian 13).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "core/base/time.h"
#include "voice/frame/voice_sound.h"

namespace webrtc {
class AudioProcessing;
}

namespace dance {

struct VoiceCleanerOptions {
  bool takes_out_echo = true;
  bool takes_out_noise = true;
  bool levels_loudness = true;
};

class VoiceCleaner {
 public:
  static constexpr std::size_t kFrame = kVoiceFrameSamples;

  static Result<std::unique_ptr<VoiceCleaner>> create(const VoiceCleanerOptions& options);
  ~VoiceCleaner();
  VoiceCleaner(const VoiceCleaner&) = delete;
  VoiceCleaner& operator=(const VoiceCleaner&) = delete;

  // What the loudspeaker plays, or has played: before the frame of the microphone that hears it.
  void hear_loudspeaker(std::span<const float, kFrame> frame);
  // `echo_delay`: from the call above until clean() gets what the microphone heard of that frame.
  void clean(std::span<float, kFrame> frame, Duration echo_delay);
  std::uint64_t refused() const { return refused_; }

 private:
  VoiceCleaner();

  std::unique_ptr<webrtc::AudioProcessing> processor_;
  std::uint64_t refused_ = 0;
};

}  // namespace dance
