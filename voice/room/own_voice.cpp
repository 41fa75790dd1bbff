#include "voice/room/own_voice.h"

#include <algorithm>

namespace dance {

Result<std::unique_ptr<OwnVoice>> OwnVoice::create(const VoiceCleanerOptions& cleaning,
                                                   const VoiceEncoderOptions& encoding,
                                                   std::uint64_t clock_id) {
  std::unique_ptr<OwnVoice> voice(new OwnVoice);
  DANCE_TRY(voice->cleaner_, VoiceCleaner::create(cleaning));
  DANCE_TRY(voice->encoder_, VoiceEncoder::create(encoding));
  voice->clock_id_ = clock_id;
  return voice;
}

std::optional<Voice> OwnVoice::take(std::span<float, kVoiceFrameSamples> frame, MonoTime captured,
                                    Duration echo_delay, bool sends) {
  cleaner_->clean(frame, echo_delay);
  level_dbfs_ = level_dbfs(frame);
  // The encoder goes on, so that the others are told of the silence.
  if (!sends) std::fill(frame.begin(), frame.end(), 0.0f);
  const std::uint32_t sequence = sequence_++;
  const auto packet = encoder_->encode(frame);
  Voice voice;
  if (!voice.set_packet(packet)) return std::nullopt;
  // By the encoder's look-ahead what is decoded sounds later.
  voice.capture_time = captured - encoder_->look_ahead();
  voice.clock_id = clock_id_;
  voice.sequence = sequence;
  voice.level_dbfs = sends ? level_dbfs_ : kSilence_dbfs;
  made_us_[sequence % kRemembered] = voice.capture_time.since_zero_us();
  ++sent_;
  return voice;
}

bool OwnVoice::has_made(const Voice& voice) const {
  return voice.clock_id == clock_id_ &&
         made_us_[voice.sequence % kRemembered] == voice.capture_time.since_zero_us();
}

}  // namespace dance
