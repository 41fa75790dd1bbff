#include "testing/voice/room_echo.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr double kRoom_hz = 48'000.0;
constexpr int kReflections = 300;

struct Reflection {
  std::size_t at;
  float gain;
};

}  // namespace

std::vector<float> heard_in_room(std::span<const float> played, const RoomEcho& room) {
  Random random(room.seed);
  std::vector<Reflection> reflections;
  const double direct = room.delay.as_seconds() * kRoom_hz;
  reflections.push_back({static_cast<std::size_t>(direct), 1.0f});
  double power = 1.0;
  for (int i = 1; i < kReflections; ++i) {
    const double after_s = random.uniform() * room.reverberation.as_seconds();
    const double level = std::pow(10.0, -3.0 * after_s / room.reverberation.as_seconds());
    const double gain = 0.25 * level * (random.uniform() < 0.5 ? -1.0 : 1.0);
    power += gain * gain;
    reflections.push_back({static_cast<std::size_t>(direct + (0.002 + after_s) * kRoom_hz),
                           static_cast<float>(gain)});
  }
  const auto scale = static_cast<float>(room.loudness / std::sqrt(power));
  std::vector<float> heard(played.size(), 0.0f);
  for (const Reflection& reflection : reflections)
    for (std::size_t i = reflection.at; i < heard.size(); ++i)
      heard[i] += scale * reflection.gain * played[i - reflection.at];
  return heard;
}

double power_ratio_db(std::span<const float> before, std::span<const float> after) {
  const auto power = [](std::span<const float> samples) {
    double sum = 1e-12;
    for (const float sample : samples) sum += static_cast<double>(sample) * sample;
    return sum / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
  };
  return 10.0 * std::log10(power(before) / power(after));
}

}  // namespace dance
