#include "producers/music/tap/tap_program.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kClickTurn = Duration::ms(10);
constexpr Duration kUntilFirstClick = Duration::ms(600);
constexpr double kClick_s = 0.010;
constexpr double kClick_hz = 1500.0;
constexpr float kClickLoudness = 0.5f;

}  // namespace

Result<void> ClickSource::read(std::int64_t frame, std::span<float> interleaved) {
  for (std::size_t i = 0; i < interleaved.size(); ++i) {
    const double s = static_cast<double>(frame + static_cast<std::int64_t>(i / 2)) / rate_hz();
    const double at_s = s < 0.0 ? kClick_s : std::fmod(s, TapDelay::kPeriod_s);
    const double fade = std::max(0.0, 1.0 - at_s / kClick_s);
    interleaved[i] = kClickLoudness *
                     static_cast<float>(fade * std::sin(2.0 * std::numbers::pi * kClick_hz * at_s));
  }
  return {};
}

Result<TapDelay::Result> run_taps(MusicPlayer& player, int input, Poller& poller) {
  TapDelay taps;
  Result<void> worked;
  bool has_ended = false;
  player.play_from(mono_now() + kUntilFirstClick, true);
  const auto timer = poller.add_timer(mono_now(), [&](MonoTime now) {
    worked = player.work(now);
    if (!worked) poller.stop();
    return now + kClickTurn;
  });
  poller.watch(input, [&](MonoTime now) {
    std::array<char, 64> keys{};
    const ssize_t read = ::read(input, keys.data(), keys.size());
    has_ended = read <= 0;
    if (has_ended) return poller.stop();
    const auto end = keys.begin() + read;
    const auto heard_s = player.heard_s(now);
    if (!heard_s || std::find(keys.begin(), end, '\n') == end) return;
    taps.tap(*heard_s);
    const TapDelay::Result result = taps.result();
    if (result.state != TapDelay::State::kNeedsMore) return poller.stop();
    talk::info("{} more", result.missing);
  });
  poller.run();
  poller.unwatch(input);
  poller.set_deadline(timer, MonoTime());
  player.pause();
  if (!worked) return tl::make_unexpected(worked.error());
  const TapDelay::Result result = taps.result();
  if (result.state == TapDelay::State::kScattered)
    return fail("the taps are " + std::to_string(std::lround(1e3 * result.spread_s)) +
                " ms apart from each other: press Enter with each click, as evenly as you can, and "
                "try again");
  if (result.state == TapDelay::State::kNeedsMore)
    return fail(std::to_string(result.missing) + " taps are missing" +
                (has_ended ? ": standard input has ended" : ""));
  return result;
}

}  // namespace dance
