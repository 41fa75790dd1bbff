// VoiceDecoder: the packets of one guest to frames of sound, and frames for packets that did not
// come. What packets hold is a stranger's: the only place that looks into it.
//
// Units/frames: 10 ms frames, mono, 48 kHz. Finite samples; louder than full scale is limited to
//               kLoudest.
// Ownership:    owns Opus's decoder, 20 kB; decodes without allocating.
// Threads:      none inside; one owner.
// Failure:      create() says what Opus refused. A packet that is no frame of 10 ms is concealed,
//               and counted in bad_packets().
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/result.h"
#include "voice/frame/voice_sound.h"

struct OpusDecoder;

namespace dance {

class VoiceDecoder {
 public:
  static constexpr float kLoudest = 2.0f;

  static Result<std::unique_ptr<VoiceDecoder>> create();
  ~VoiceDecoder();
  VoiceDecoder(const VoiceDecoder&) = delete;
  VoiceDecoder& operator=(const VoiceDecoder&) = delete;

  // False: the frame is concealed.
  bool decode(std::span<const std::uint8_t> packet, std::span<float, kVoiceFrameSamples> frame);
  // The frame before that packet, which did not come: from the copy that the packet has of it.
  bool decode_lost(std::span<const std::uint8_t> next, std::span<float, kVoiceFrameSamples> frame);
  // A frame that goes on as the sound was, and fades.
  void conceal(std::span<float, kVoiceFrameSamples> frame);
  // What comes next is another stream.
  void reset();
  std::uint64_t bad_packets() const { return bad_packets_; }

 private:
  VoiceDecoder() = default;
  bool decode_with(std::span<const std::uint8_t> packet, int from_next,
                   std::span<float, kVoiceFrameSamples> frame);

  OpusDecoder* decoder_ = nullptr;
  std::uint64_t bad_packets_ = 0;
};

}  // namespace dance
