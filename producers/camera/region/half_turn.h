// π in single precision, and degrees in radians, for what sees hands and faces.
//
// Threads: constants only.
// Failure: none.
#pragma once

#include <numbers>

namespace dance {

constexpr float kHalfTurn_rad = std::numbers::pi_v<float>;
constexpr float radians(float degrees) { return degrees * kHalfTurn_rad / 180.0f; }

}  // namespace dance
