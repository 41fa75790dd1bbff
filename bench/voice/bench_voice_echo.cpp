#include <fmt/format.h>

#include <algorithm>

#include "bench/voice/bench_voice.h"
#include "core/program/figures.h"
#include "testing/voice/room_echo.h"
#include "voice/clean/voice_cleaner.h"

namespace dance {
namespace {

constexpr std::size_t kFrame = VoiceCleaner::kFrame;
constexpr std::size_t kLearnt = 48'000 * 5;

struct Cleaned {
  Speech sound;
  double frame_us = 0.0;
};

Result<Cleaned> clean(const Speech& microphone, const Speech& loudspeaker,
                      const VoiceCleanerOptions& options) {
  DANCE_TRY(auto cleaner, VoiceCleaner::create(options));
  Cleaned cleaned{microphone, 0.0};
  const double begin = cpu_us();
  std::size_t at = 0;
  for (; at + kFrame <= microphone.size(); at += kFrame) {
    cleaner->hear_loudspeaker(std::span(loudspeaker).subspan(at).first<kFrame>());
    cleaner->clean(std::span(cleaned.sound).subspan(at).first<kFrame>(), Duration::ms(35));
  }
  cleaned.frame_us = (cpu_us() - begin) / (static_cast<double>(at) / kFrame);
  return cleaned;
}

}  // namespace

Result<BenchReport> bench_voice_echo(const Speech& near, const Speech& far) {
  const std::size_t count = std::min(near.size(), far.size());
  Speech loudspeaker(far.begin(), far.begin() + static_cast<std::ptrdiff_t>(count));
  BenchReport report;
  report.text = fmt::format(
      "A loudspeaker plays a voice into the room of a microphone. left over: the echo against the "
      "same microphone\nwithout, after {} s; own voice: how much of the dancer's own voice is left "
      "while both speak\n{:<22} {:<16} {:>12} {:>11} {:>12}\n",
      kLearnt / 48'000, "room", "cancellation", "left over", "own voice", "a frame");
  for (const auto& [name, room] :
       {std::pair{"small, 150 ms", RoomEcho{Duration::ms(20), Duration::ms(150), 0.4, 1}},
        std::pair{"hall, 400 ms", RoomEcho{Duration::ms(45), Duration::ms(400), 0.5, 2}},
        std::pair{"radio loudspeaker", RoomEcho{Duration::ms(180), Duration::ms(250), 0.5, 3}}}) {
    const Speech echo = heard_in_room(loudspeaker, room);
    Speech both = echo;
    for (std::size_t i = 0; i < count; ++i) both[i] += near[i];
    for (const bool is_on : {false, true}) {
      VoiceCleanerOptions options;
      options.takes_out_echo = is_on;
      options.levels_loudness = false;
      options.takes_out_noise = false;
      DANCE_TRY(const Cleaned alone, clean(echo, loudspeaker, options));
      DANCE_TRY(const Cleaned together, clean(both, loudspeaker, options));
      const auto tail = [](const Speech& s) { return std::span(s).subspan(kLearnt); };
      const double left_db = -power_ratio_db(tail(echo), tail(alone.sound));
      const double own_db =
          -power_ratio_db(tail(near).first(count - kLearnt), tail(together.sound));
      report.text += fmt::format("{:<22} {:<16} {:>9.1f} dB {:>8.1f} dB {:>9.0f} µs\n", name,
                                 is_on ? "on" : "off", left_db, own_db, alone.frame_us);
      report.json.push_back({{"room", name},
                             {"cancellation", is_on},
                             {"echo_left_db", rounded(left_db, 10.0)},
                             {"own_voice_db", rounded(own_db, 10.0)},
                             {"frame_us", rounded(alone.frame_us, 1.0)}});
    }
  }
  return report;
}

}  // namespace dance
