#include "testing/voice/voice_stream.h"

#include <algorithm>

namespace dance {

Result<SentVoice> encode_voice(std::span<const float> samples, const VoiceEncoderOptions& options,
                               double drift) {
  DANCE_TRY(auto encoder, VoiceEncoder::create(options));
  SentVoice sent;
  sent.look_ahead = encoder->look_ahead();
  for (; (sent.frames + 1) * kVoiceFrameSamples <= samples.size(); ++sent.frames) {
    const auto frame =
        samples.subspan(sent.frames * kVoiceFrameSamples).first<kVoiceFrameSamples>();
    const auto packet = encoder->encode(frame);
    if (packet.empty()) continue;
    Voice voice;
    voice.sequence = static_cast<std::uint32_t>(sent.frames);
    voice.capture_time =
        kVoiceBegin + Duration::seconds(static_cast<double>(sent.frames) * 0.01 / (1.0 + drift));
    voice.clock_id = 1;
    voice.level_dbfs = level_dbfs(frame);
    if (!voice.set_packet(packet)) return fail("Opus made a packet that is too long");
    sent.bytes += packet.size();
    sent.packets.push_back(voice);
  }
  return sent;
}

std::vector<VoiceArrival> voice_arrivals(const SentVoice& sent, LossyModel& line) {
  std::vector<VoiceArrival> arrivals;
  constexpr std::size_t kHeaders_bytes = 80;
  line.begin(kVoiceBegin);
  for (std::size_t i = 0; i < sent.packets.size(); ++i) {
    const Voice& voice = sent.packets[i];
    // A frame is complete, and can be sent, at its end.
    const auto fate = line.offer(kHeaders_bytes + static_cast<std::size_t>(voice.size_bytes),
                                 voice.capture_time + kVoiceFrame);
    for (const MonoTime at : fate.deliveries()) arrivals.push_back({at, i});
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const VoiceArrival& a, const VoiceArrival& b) { return a.at < b.at; });
  return arrivals;
}

Result<HeardVoice> play_voice(const SentVoice& sent, const std::vector<VoiceArrival>& arrivals,
                              std::optional<Duration> picture) {
  DANCE_TRY(auto decoder, VoiceDecoder::create());
  VoicePlayout playout(std::move(decoder));
  playout.set_delay(picture);
  HeardVoice heard;
  std::vector<double> delays_ms;
  std::size_t next = 0;
  for (std::size_t i = 0; i < sent.frames; ++i) {
    const MonoTime now = kVoiceBegin + kVoiceFrame * static_cast<std::int64_t>(i);
    for (; next < arrivals.size() && arrivals[next].at <= now; ++next)
      playout.put(sent.packets[arrivals[next].index], arrivals[next].at);
    VoiceFrame frame;
    playout.pull(now, now, frame);
    heard.samples.insert(heard.samples.end(), frame.begin(), frame.end());
    if (playout.is_speaking() && playout.delay()) delays_ms.push_back(playout.delay()->as_ms());
  }
  heard.counters = playout.counters();
  if (delays_ms.empty()) return heard;
  for (const double delay_ms : delays_ms) heard.delay_mean_ms += delay_ms;
  heard.delay_mean_ms /= static_cast<double>(delays_ms.size());
  std::sort(delays_ms.begin(), delays_ms.end());
  heard.delay_p95_ms = delays_ms[delays_ms.size() * 95 / 100];
  return heard;
}

double missed_at_fixed_delay(const SentVoice& sent, const std::vector<VoiceArrival>& arrivals,
                             Duration delay) {
  std::vector<bool> is_in_time(sent.packets.size(), false);
  for (const VoiceArrival& arrival : arrivals)
    if (arrival.at <= sent.packets[arrival.index].capture_time + delay)
      is_in_time[arrival.index] = true;
  const auto in_time = std::count(is_in_time.begin(), is_in_time.end(), true);
  return sent.packets.empty()
             ? 0.0
             : 1.0 - static_cast<double>(in_time) / static_cast<double>(sent.packets.size());
}

}  // namespace dance
