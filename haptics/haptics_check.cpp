#include "haptics/haptics_check.h"

#include <fmt/format.h>

#include <memory>

#include "core/base/random.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr double kOrders_hz = 100.0;
constexpr double kPictures_hz = 60.0;
// Longer than a device is late by itself.
constexpr Duration kSoonest = Duration::ms(600);

}  // namespace

Result<HapticCheck> check_haptics(const std::string& to, const HapticOptions& options,
                                  Poller& poller, Duration length) {
  DANCE_TRY(auto output, make_haptic_output(to, options));
  HapticCheck check;
  check.to = to;
  // What is looked for first.
  for (const MonoTime begin = mono_now(); mono_now() - begin < Duration::ms(500);)
    poller.run_once(Duration::ms(50));
  HapticPlayer player(std::move(output), options.player, poller);
  Random random(5);
  Histogram pictures;
  bool is_over = false;
  const MonoTime begin = mono_now(), end = begin + length;
  const Duration picture = Duration::period_of_hz(kPictures_hz);
  const auto timer = poller.add_timer(begin, [&](MonoTime now) {
    if (now >= end) {
      is_over = now >= end + kSoonest + Duration::ms(100);
      return now + Duration::ms(20);
    }
    Haptic haptic;
    haptic.time = now;
    haptic.clock_id = this_clock_id();
    haptic.play_time =
        now + kSoonest + Duration::us(static_cast<std::int64_t>(random.uniform() * 9e3));
    haptic.duration = Duration::ms(5);
    haptic.amplitude = 0.05f;
    haptic.frequency_hz = 150.0f;
    player.take(haptic, now);
    // The first picture that begins after it.
    const auto since_ns = (haptic.play_time - begin).count_ns();
    pictures.add(Duration::ns(picture.count_ns() - since_ns % picture.count_ns()));
    return now + Duration::period_of_hz(kOrders_hz);
  });
  while (!is_over && !poller.is_stopped()) poller.run_once(Duration::ms(100));
  poller.remove_timer(timer);
  check.device = player.summary();
  check.device = check.device.substr(0, check.device.find(':', check.device.rfind(" played")));
  check.played = player.counters().played;
  check.refused = player.counters().refused;
  check.p50_ms = player.lateness().percentile(0.5).as_ms();
  check.p99_ms = player.lateness().percentile(0.99).as_ms();
  check.most_ms = player.lateness().max().as_ms();
  check.picture_p50_ms = pictures.percentile(0.5).as_ms();
  check.picture_p99_ms = pictures.percentile(0.99).as_ms();
  return check;
}

std::string haptic_check_table(const std::vector<HapticCheck>& checks) {
  std::string text = fmt::format("{:<10}{:>8}{:>9}{:>9}{:>9}{:>20}{:>10}\n", "", "played", "p50 ms",
                                 "p99 ms", "most ms", "a picture: p50 ms", "p99 ms");
  for (const HapticCheck& check : checks) {
    if (check.played == 0) {
      text += fmt::format("{:<10}{}\n", check.to, check.device);
      continue;
    }
    text += fmt::format("{:<10}{:>8}{:>9.3f}{:>9.3f}{:>9.3f}{:>20.3f}{:>10.3f}\n", check.to,
                        check.played, check.p50_ms, check.p99_ms, check.most_ms,
                        check.picture_p50_ms, check.picture_p99_ms);
  }
  return text;
}

}  // namespace dance
