// dance music --tap: plays a steady click by the way that music takes, and takes the taps of a
// person, one for each line of standard input.
//
// Threads:      runs the poller in the caller's thread.
// Failure:      without sound, and where the taps scatter or end early: an Error with the cure.
#pragma once

#include <functional>
#include <memory>

#include "core/net/poller.h"
#include "producers/music/music_player.h"
#include "producers/music/music_source.h"
#include "producers/music/tap/tap_delay.h"

namespace dance {

// A click of 10 ms at each TapDelay::kPeriod_s, at 48 kHz.
class ClickSource : public MusicSource {
 public:
  double rate_hz() const override { return 48000.0; }
  Result<void> read(std::int64_t frame, std::span<float> interleaved) override;
};

// `player` plays a ClickSource. The taps are read from `input`, a file descriptor.
Result<TapDelay::Result> run_taps(MusicPlayer& player, int input, Poller& poller);

}  // namespace dance
