// Two salsa dancers who change places before the camera, one behind the other for a moment.
//
// Units/frames: as testing/camera/couple_scene.h.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include "producers/salsa/salsa_dancer.h"
#include "testing/camera/couple_scene.h"

namespace dance {

constexpr double kCoupleHz = 30.0;
inline const PictureColour kRed(0.35f, 0.45f, 0.75f), kBlue(0.3f, 0.65f, 0.45f),
    kWhite(0.9f, 0.5f, 0.5f), kSkin(0.6f, 0.42f, 0.6f);

// The second walks behind the first: 2.4 m to one side and back, in `seconds`.
inline std::array<CoupleDancer, 2> crossing_couple(double seconds, bool is_dressed_alike = false) {
  std::array<CoupleDancer, 2> dancers;
  for (std::size_t i = 0; i < 2; ++i) {
    SalsaStyle style;
    style.seed = 3 + i;
    SalsaDancer dancer(style);
    dancers[i].skeleton = dancer.skeleton();
    dancers[i].poses.resize(static_cast<std::size_t>(seconds * kCoupleHz));
    for (std::size_t f = 0; f < dancers[i].poses.size(); ++f) {
      const double t = static_cast<double>(f) / kCoupleHz;
      Pose& pose = dancers[i].poses[f];
      dancer.dance_at(Duration::seconds(t), pose);
      // From -1.2 m to 1.2 m, in a cosine; the second the other way round, half a metre behind.
      const double across = -1.2 * std::cos(6.2831853 * t / seconds);
      pose.p_WH_m.x() += static_cast<float>(i == 0 ? across : -across);
      pose.p_WH_m.z() += i == 0 ? 0.25f : -0.35f;
    }
  }
  dancers[0].clothes = {kWhite, kBlue, kBlue, kSkin};
  dancers[1].clothes = {kRed, kRed, kSkin, kSkin};
  if (is_dressed_alike) dancers[1].clothes = dancers[0].clothes;
  return dancers;
}

}  // namespace dance
