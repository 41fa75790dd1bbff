#include "voice/codec/voice_encoder.h"

#include <opus/opus.h>

#include "voice/codec/voice_packet.h"

namespace dance {
namespace {

// Of the packets that say that a silence begins, one arrives.
constexpr int kSilenceSaid_frames = 3;
// And then now and then, for those who came meanwhile.
constexpr int kSilenceAgain_frames = 40;

}  // namespace

Result<std::unique_ptr<VoiceEncoder>> VoiceEncoder::create(const VoiceEncoderOptions& options) {
  std::unique_ptr<VoiceEncoder> made(new VoiceEncoder);
  int error = OPUS_OK;
  const bool is_speech = options.mode == VoiceMode::kSpeech;
  made->encoder_ = opus_encoder_create(
      kVoiceRate_hz, 1, is_speech ? OPUS_APPLICATION_VOIP : OPUS_APPLICATION_RESTRICTED_LOWDELAY,
      &error);
  if (made->encoder_ == nullptr)
    return fail(std::string("Opus has no encoder for voices: ") + opus_strerror(error));
  OpusEncoder* encoder = made->encoder_;
  const bool is_set =
      opus_encoder_ctl(encoder, OPUS_SET_BITRATE(options.bits_per_second)) == OPUS_OK &&
      opus_encoder_ctl(encoder, OPUS_SET_VBR(1)) == OPUS_OK &&
      opus_encoder_ctl(encoder, OPUS_SET_COMPLEXITY(9)) == OPUS_OK &&
      opus_encoder_ctl(encoder, OPUS_SET_SIGNAL(OPUS_SIGNAL_VOICE)) == OPUS_OK &&
      opus_encoder_ctl(encoder, OPUS_SET_INBAND_FEC(options.has_error_correction ? 1 : 0)) ==
          OPUS_OK &&
      opus_encoder_ctl(encoder, OPUS_SET_PACKET_LOSS_PERC(options.expected_loss_percent)) ==
          OPUS_OK &&
      opus_encoder_ctl(encoder, OPUS_SET_DTX(options.leaves_out_silence ? 1 : 0)) == OPUS_OK;
  opus_int32 look_ahead = 0;
  if (!is_set || opus_encoder_ctl(encoder, OPUS_GET_LOOKAHEAD(&look_ahead)) != OPUS_OK)
    return fail("Opus refuses " + std::to_string(options.bits_per_second) +
                " bits a second; give 6000 to 128000");
  made->look_ahead_ = Duration::seconds(static_cast<double>(look_ahead) / kVoiceRate_hz);
  return made;
}

VoiceEncoder::~VoiceEncoder() {
  if (encoder_ != nullptr) opus_encoder_destroy(encoder_);
}

std::span<const std::uint8_t> VoiceEncoder::encode(
    std::span<const float, kVoiceFrameSamples> frame) {
  const opus_int32 bytes =
      opus_encode_float(encoder_, frame.data(), static_cast<int>(frame.size()), packet_.data(),
                        static_cast<opus_int32>(packet_.size()));
  if (bytes <= 0) return {};
  const auto packet = std::span<const std::uint8_t>(packet_).first(static_cast<std::size_t>(bytes));
  opus_int32 is_in_silence = 0;
  opus_encoder_ctl(encoder_, OPUS_GET_IN_DTX(&is_in_silence));
  if (!is_silence(packet)) {
    // What Opus says of the noise in a silence, again and again, is worth no packets.
    if (is_in_silence != 0 && silent_frames_ >= kSilenceSaid_frames) {
      ++silent_frames_;
      return {};
    }
    silent_frames_ = 0;
    return packet;
  }
  const int silent = silent_frames_++;
  if (silent < kSilenceSaid_frames || silent % kSilenceAgain_frames == 0) return packet;
  return {};
}

}  // namespace dance
