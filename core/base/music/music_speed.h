// How much slower or faster than recorded a piece of music can be played, as a factor.
//
// Ownership: constants.
#pragma once

#include <algorithm>
#include <cmath>

namespace dance {

constexpr double kLeastMusicSpeed = 0.5;
constexpr double kMostMusicSpeed = 1.1;
constexpr double kMusicSpeedStep = 0.05;

// The next whole step above (1) or below (-1).
inline double stepped_music_speed(double speed, int direction) {
  const double steps = std::round(speed / kMusicSpeedStep) + direction;
  // Rounding to hundredths makes full speed exactly 1.
  return std::clamp(std::round(100.0 * kMusicSpeedStep * steps) / 100.0, kLeastMusicSpeed,
                    kMostMusicSpeed);
}

}  // namespace dance
