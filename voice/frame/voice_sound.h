// Sizes of the sound of voices, the same everywhere: 10 ms frames of mono samples at 48 kHz.
//
// Units/frames: samples from -1 to 1 at kVoiceRate_hz.
// Ownership:    plain values.
// Threads:      none inside; constants and plain functions.
// Failure:      level_dbfs() of digital silence is kSilence_dbfs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/bus/voice.h"

namespace dance {

constexpr std::size_t kVoiceFrameSamples = 480;
using VoiceFrame = std::array<float, kVoiceFrameSamples>;

// Root mean square, in dB relative to full scale, as Voice has it.
inline int level_dbfs(std::span<const float> samples) {
  double sum = 0.0;
  for (const float sample : samples) sum += static_cast<double>(sample) * sample;
  const double mean = samples.empty() ? 0.0 : sum / static_cast<double>(samples.size());
  if (!(mean > 1e-12)) return kSilence_dbfs;
  return std::clamp(static_cast<int>(std::lround(10.0 * std::log10(mean))), kSilence_dbfs, 0);
}

}  // namespace dance
