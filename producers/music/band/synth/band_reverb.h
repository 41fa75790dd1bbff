// The small hall in which the house band plays: four delay lines that feed each other.
//
// Units/frames: one instance at kBandRate_hz; rings about a second. At rest when made.
// Source:       Jot, Chaigne: Digital delay networks for designing artificial reverberators,
//               AES 1991.
#pragma once

#include <array>
#include <vector>

#include "producers/music/band/synth/band_synth.h"

namespace dance {

class BandReverb {
 public:
  BandReverb();

  // Adds the hall to the block.
  void process(BandBlock& block);

 private:
  static constexpr std::size_t kLines = 4;

  std::array<std::vector<float>, kLines> lines_;
  std::array<std::size_t, kLines> at_{};
  std::array<float, kLines> dull_{};  // the low-passed output of each line
  float low_ = 0.0f;                  // low frequencies, which do not reach the hall
};

}  // namespace dance
