// The loudness of a piece of music, weighted as people perceive it.
//
// Units/frames: LUFS; interleaved stereo samples at 48 kHz.
// Failure:      silence is -70 LUFS.
// Source:       ITU-R BS.1770-4, integrated loudness with both gates.
#pragma once

#include <span>

namespace dance {

double loudness_lufs(std::span<const float> stereo);

}  // namespace dance
