// Makes speech a little longer or shorter without a gap and at the same pitch: takes out or doubles
// one period of it, where two of them overlap best (WSOLA). Works on a few milliseconds, so that
// it adds no delay.
//
// Units/frames: samples at 48 kHz; periods of 2.5 to 15 ms.
// Ownership:    works in the caller's memory.
// Threads:      none inside; plain functions.
// Failure:      0 where no period is found and `must` is not set, or there are too few samples.
// Source:       W. Verhelst, M. Roelands: An overlap-add technique based on waveform similarity
//               (WSOLA), ICASSP 1993.
#pragma once

#include <cstddef>
#include <span>

namespace dance {

constexpr std::size_t kShortestPeriod = 120;
constexpr std::size_t kLongestPeriod = 720;

// Takes out one period at the begin: `samples` are what is to be played next. Returns how many
// samples have gone; those that remain are samples.subspan(gone).
std::size_t shorten(std::span<float> samples, bool must);

// The period to be played once more between `played` and `next`, of which `played` are the last
// samples that were. Written to `more`; returns its length.
std::size_t lengthen(std::span<const float> played, std::span<const float> next,
                     std::span<float> more, bool must);

}  // namespace dance
