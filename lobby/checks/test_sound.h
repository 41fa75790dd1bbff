// The sounds that a loudspeaker is tested with: "5, 6, 7, 8", four tones that climb, as a count-in;
// and a short sweep, which a microphone finds again in noise and echoes.
//
// Units/frames: samples at 48 kHz, -1 to 1.
// Ownership:    the sweep is one constant for all.
// Threads:      any; pure.
// Failure:      before the begin and after the end there is silence.
#pragma once

#include <cstdint>
#include <span>

namespace dance {

constexpr std::int64_t kCountInSamples = 4 * 24'000;  // half a second a beat
float count_in_sample(std::int64_t index);

constexpr std::size_t kSweepSamples = 2400;
std::span<const float, kSweepSamples> test_sweep();

}  // namespace dance
