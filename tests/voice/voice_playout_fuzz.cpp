// Packets of a stranger, in any order and at any time, through play-out and decoder: eight bytes
// say what comes next, and then come the packet's bytes.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/fuzz_target.h"
#include "voice/playout/voice_playout.h"

namespace {

constexpr int kMostSteps = 200;

}  // namespace

DANCE_FUZZ_TARGET(voice_playout) {
  using namespace dance;
  VoicePlayout playout(std::move(*VoiceDecoder::create()));
  MonoTime now = MonoTime::from_us(1'000'000);
  std::size_t at = 0;
  for (int step = 0; step < kMostSteps && at + 8 <= size; ++step) {
    const std::uint8_t* head = data + at;
    at += 8;
    Voice voice;
    voice.sequence = static_cast<std::uint32_t>(head[0]) |
                     static_cast<std::uint32_t>(head[1]) << 8 |
                     static_cast<std::uint32_t>(head[2]) << 30;
    voice.capture_time = now + Duration::ms(static_cast<std::int8_t>(head[3]) * 10);
    const std::size_t length = std::min<std::size_t>({head[4], kMaxVoiceBytes, size - at});
    if (voice.set_packet({data + at, length})) playout.put(voice, now);
    at += length;
    if ((head[5] & 1) != 0) playout.set_delay(Duration::ms(head[6] * 40));
    if ((head[5] & 2) != 0) playout.set_delay(std::nullopt);
    now += Duration::ms(head[7] % 64);
    std::array<float, 960> samples;
    const auto part = std::span(samples).first(1 + (head[7] * 4) % samples.size());
    playout.pull(now, now + Duration::ms(20), part);
    for (const float sample : part)
      if (!std::isfinite(sample) || std::abs(sample) > 16.0f) std::abort();
  }
  return 0;
}
