// Fits a recurrent network to songs whose beats are known, by what each moment was and at which
// tempo it was danced.
//
// Units/frames: a row of features for each step of a song; classes are 0 on a beat, 1 on a half, 2
//               elsewhere.
// Ownership:    plain values; refers to the songs while it fits.
// Threads:      two while it fits. The same songs and seed give the same network.
// Failure:      none; wants at least one song.
// Source:       back-propagation through time (Werbos, 1990); Adam (Kingma and Ba, 2015); dropout
//               (Srivastava et al., 2014).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "producers/music/tracker/net/rhythm_net.h"

namespace dance {

// What a song teaches a network that hears it from the beginning.
struct RhythmSong {
  std::vector<float> features;        // rows of RhythmFeatures::kCount
  std::vector<std::uint8_t> classes;  // of each row
  std::vector<float> weights;         // 0: not to be judged
  std::vector<float> tempi;           // places among RhythmNet::kTempi
};

struct WeightedRhythm {
  const RhythmSong* song;
  float weight = 1.0f;  // how often it is heard
};

struct RhythmFit {
  int rounds = 1500;  // each of 32 sequences of 20 s
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> tell = [](const std::string&) {};
};

RhythmNet fit_rhythm_net(const std::vector<WeightedRhythm>& songs, const RhythmFit& fit);

}  // namespace dance
