// VoiceEncoder: frames of a guest's own voice to Opus packets. In silence (DTX) it says so with a
// few packets of one or two bytes, and then with one every 400 ms; what is between them is not to
// be sent.
//
// Units/frames: 10 ms frames, mono, 48 kHz, samples -1 to 1; bits a second.
// Ownership:    owns Opus's encoder; encode() allocates nothing.
// Threads:      none inside; one owner.
// Failure:      create() says what Opus refused; a packet that Opus cannot make is empty.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "voice/frame/voice_sound.h"

struct OpusEncoder;

namespace dance {

// What Opus is made for: docs/voice.md has what each costs and bears.
enum class VoiceMode : std::uint8_t {
  kSpeech,    // VOIP: in-band error correction, 6.5 ms of look-ahead
  kLowDelay,  // RESTRICTED_LOWDELAY: 2.5 ms of look-ahead, no error correction
};

struct VoiceEncoderOptions {
  VoiceMode mode = VoiceMode::kSpeech;
  int bits_per_second = 32'000;
  bool has_error_correction = true;  // a copy of each frame, coarser, in the packet after it
  int expected_loss_percent = 10;    // how many bits error correction gets
  bool leaves_out_silence = true;    // DTX
};

class VoiceEncoder {
 public:
  static Result<std::unique_ptr<VoiceEncoder>> create(const VoiceEncoderOptions& options);
  ~VoiceEncoder();
  VoiceEncoder(const VoiceEncoder&) = delete;
  VoiceEncoder& operator=(const VoiceEncoder&) = delete;

  // The packet of the frame, in memory of the encoder until the next call. Empty: nothing is to be
  // sent of this frame.
  std::span<const std::uint8_t> encode(std::span<const float, kVoiceFrameSamples> frame);
  // By which the decoder's sound is later than the encoder's.
  Duration look_ahead() const { return look_ahead_; }

 private:
  VoiceEncoder() = default;

  OpusEncoder* encoder_ = nullptr;
  std::array<std::uint8_t, kMaxVoiceBytes> packet_{};
  Duration look_ahead_;
  int silent_frames_ = 0;
};

}  // namespace dance
