// Mastering: a song as another studio would have sent it out: bass and treble turned up or down,
// compressed, driven into its limit, with some hiss. Beats stay where they are; what a stroke
// sounds like does not. A model trained on one song in several studios learns the strokes, and not
// the studio.
//
// Units/frames: mono samples at rate_hz, of any loudness; what comes out stays within ±1.1.
// Ownership:    takes the samples, gives them back changed.
// Threads:      none inside.
// Failure:      none; silence becomes hiss. The same seed gives the same sound.
// Source:       waveshaping and feed-forward compression as in Zölzer (ed.), DAFX, 2011.
#pragma once

#include <cstdint>
#include <vector>

namespace dance {

std::vector<float> mastered(std::vector<float> samples, double rate_hz, std::uint64_t seed);

}  // namespace dance
