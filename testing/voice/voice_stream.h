// A voice through codec, an emulated line and play-out in simulated time: what is heard, and what
// it took.
//
// Units/frames: samples at 48 kHz; the sender's sound card runs at (1 + drift) of its rate.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      passes on what Opus refuses.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "testing/line/lossy_model.h"
#include "voice/codec/voice_encoder.h"
#include "voice/playout/voice_playout.h"

namespace dance {

struct SentVoice {
  std::vector<Voice> packets;  // those that are sent, stamped from `begin` on
  std::size_t frames = 0;
  std::size_t bytes = 0;
  Duration look_ahead;
};
constexpr MonoTime kVoiceBegin = MonoTime::from_us(10'000'000);

Result<SentVoice> encode_voice(std::span<const float> samples, const VoiceEncoderOptions& options,
                               double drift = 0.0);

struct VoiceArrival {
  MonoTime at;
  std::size_t index;
};
// In the order of arrival.
std::vector<VoiceArrival> voice_arrivals(const SentVoice& sent, LossyModel& line);

struct HeardVoice {
  std::vector<float> samples;  // from kVoiceBegin on
  VoicePlayout::Counters counters;
  double delay_mean_ms = 0.0;  // of what is heard, from capture; the encoder's look-ahead excluded
  double delay_p95_ms = 0.0;
};
// Played by a sound card that asks for 10 ms each 10 ms. `picture`: as VoicePlayout::set_delay().
Result<HeardVoice> play_voice(const SentVoice& sent, const std::vector<VoiceArrival>& arrivals,
                              std::optional<Duration> picture = std::nullopt);

// Of the frames sent, the share that a buffer of a fixed delay from capture would not have in time.
double missed_at_fixed_delay(const SentVoice& sent, const std::vector<VoiceArrival>& arrivals,
                             Duration delay);

}  // namespace dance
