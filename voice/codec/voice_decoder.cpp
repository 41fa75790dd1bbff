#include "voice/codec/voice_decoder.h"

#include <opus/opus.h>

#include <algorithm>
#include <cmath>

#include "voice/codec/voice_packet.h"

namespace dance {
namespace {

constexpr int kFrame = static_cast<int>(kVoiceFrameSamples);

void make_safe(std::span<float> samples) {
  for (float& sample : samples)
    sample = std::isfinite(sample)
                 ? std::clamp(sample, -VoiceDecoder::kLoudest, VoiceDecoder::kLoudest)
                 : 0.0f;
}

}  // namespace

Result<std::unique_ptr<VoiceDecoder>> VoiceDecoder::create() {
  std::unique_ptr<VoiceDecoder> made(new VoiceDecoder);
  int error = OPUS_OK;
  made->decoder_ = opus_decoder_create(kVoiceRate_hz, 1, &error);
  if (made->decoder_ == nullptr)
    return fail(std::string("Opus has no decoder for voices: ") + opus_strerror(error));
  return made;
}

VoiceDecoder::~VoiceDecoder() {
  if (decoder_ != nullptr) opus_decoder_destroy(decoder_);
}

bool VoiceDecoder::decode(std::span<const std::uint8_t> packet,
                          std::span<float, kVoiceFrameSamples> frame) {
  return decode_with(packet, 0, frame);
}

bool VoiceDecoder::decode_lost(std::span<const std::uint8_t> next,
                               std::span<float, kVoiceFrameSamples> frame) {
  if (has_error_correction(next)) return decode_with(next, 1, frame);
  conceal(frame);
  return false;
}

void VoiceDecoder::conceal(std::span<float, kVoiceFrameSamples> frame) {
  if (opus_decode_float(decoder_, nullptr, 0, frame.data(), kFrame, 0) != kFrame)
    std::fill(frame.begin(), frame.end(), 0.0f);
  make_safe(frame);
}

void VoiceDecoder::reset() { opus_decoder_ctl(decoder_, OPUS_RESET_STATE); }

bool VoiceDecoder::decode_with(std::span<const std::uint8_t> packet, int from_next,
                               std::span<float, kVoiceFrameSamples> frame) {
  const auto size = static_cast<opus_int32>(packet.size());
  // A packet may hold up to 120 ms: of another length than ours it is none of ours.
  const bool is_ours = size > 0 && size <= static_cast<opus_int32>(kMaxVoiceBytes) &&
                       opus_packet_get_nb_samples(packet.data(), size, kVoiceRate_hz) == kFrame;
  if (!is_ours ||
      opus_decode_float(decoder_, packet.data(), size, frame.data(), kFrame, from_next) != kFrame) {
    ++bad_packets_;
    conceal(frame);
    return false;
  }
  make_safe(frame);
  return true;
}

}  // namespace dance
