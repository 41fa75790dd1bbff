#include "producers/music/band/synth/band_reverb.h"

namespace dance {
namespace {

// Delays of 23 to 44 ms, all primes, and their gains for a decay of 60 dB in 1.1 s.
constexpr std::array<std::size_t, 4> kLengths{1103, 1361, 1693, 2113};
constexpr std::array<float, 4> kFeedback{0.866f, 0.837f, 0.801f, 0.758f};
constexpr float kDamping = 0.32f;
// Below some 300 Hz the hall makes mud.
constexpr float kLowPart = 0.039f;
constexpr float kSend = 0.5f;
constexpr float kReturn = 0.16f;

}  // namespace

BandReverb::BandReverb() {
  for (std::size_t i = 0; i < kLines; ++i) lines_[i].assign(kLengths[i], 0.0f);
}

void BandReverb::process(BandBlock& block) {
  for (std::size_t n = 0; n < block.left.size(); ++n) {
    const float mono = kSend * (block.left[n] + block.right[n]);
    low_ += kLowPart * (mono - low_);
    const float in = mono - low_;
    std::array<float, kLines> out;
    float sum = 0.0f;
    for (std::size_t i = 0; i < kLines; ++i) {
      const float read = lines_[i][at_[i]];
      dull_[i] += (1.0f - kDamping) * (read - dull_[i]);
      out[i] = kFeedback[i] * dull_[i];
      sum += out[i];
    }
    // Householder's reflection keeps the energy and mixes the lines.
    for (std::size_t i = 0; i < kLines; ++i) {
      lines_[i][at_[i]] = in + out[i] - 0.5f * sum;
      if (++at_[i] == kLengths[i]) at_[i] = 0;
    }
    block.left[n] += kReturn * (out[0] - out[2] + out[3]);
    block.right[n] += kReturn * (out[1] - out[3] + out[2]);
  }
}

}  // namespace dance
