// Hands of recorded couples that meet: motion capture that was put onto other bodies than the
// dancers' holds hands at 20 cm.
//
// Units/frames: metres in W; of each dancer the left and the right palm.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace dance {

using PalmPlaces = std::array<Eigen::Vector3f, 2>;

// By how much palms of two dancers are to be moved: those within join_m of each other are brought
// together, nearer the nearer they are; together where half as far. Only the nearest pair of each
// two hands.
inline std::array<PalmPlaces, 2> joined_palm_shifts(const std::array<PalmPlaces, 2>& palms,
                                                    float join_m) {
  const auto ramp = [](float x) {
    const float t = std::clamp(x, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
  };
  std::array<PalmPlaces, 2> shifts;
  for (PalmPlaces& of_dancer : shifts) of_dancer.fill(Eigen::Vector3f::Zero());
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const Eigen::Vector3f apart = palms[1][b] - palms[0][a];
      const float distance = apart.norm();
      const float nearest =
          std::min((palms[1][1 - b] - palms[0][a]).norm(), (palms[1][b] - palms[0][1 - a]).norm());
      const float weight =
          ramp(2.0f * (1.0f - distance / join_m)) * ramp((nearest - distance) / (0.2f * join_m));
      shifts[0][a] += 0.5f * weight * apart;
      shifts[1][b] -= 0.5f * weight * apart;
    }
  return shifts;
}

}  // namespace dance
