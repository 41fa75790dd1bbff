// ScaledSteps: where feet are set down, and where the hips go over them, when the turns of the legs
// are scaled. A foot on its way goes to where its scaled leg reaches; one that stands keeps the
// place where it was set down; the hips go over the feet that stand as far as their legs' turns
// say. So steps are longer or shorter, and nothing slides. The balls of the feet are what stands: a
// heel may lift higher, and turns about its ball while it is up.
//
// Where steps alone would lead the dancer away from where they dance, the feet take it back as they
// swing.
//
// Units/frames: metres and radians in W, +Y up, against where the body was danced.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none: hips go 30 cm at most, feet 60 cm; no foot goes below the floor, or below
//               where it was danced.
#pragma once

#include <array>

#include "transformers/style/swing_feet.h"

namespace dance {

class ScaledSteps {
 public:
  // Where hips are moved by, and where each leg's ankle, foot and toes come to.
  struct Aim {
    Eigen::Vector3f hips_moved_m;
    std::array<Eigen::Vector3f, 2> p_WAnkle_m;
    std::array<Eigen::Quaternionf, 2> R_WFoot, R_WToes;
  };

  // `scaled` is the body with its legs scaled, its hips in the place where they were danced.
  Aim aim(const SwingFeet& feet, const BodyFrames& danced, const BodyFrames& scaled) const;
  // One pose after the other, `dt_s` after the one before. `goes_home`: legs are as danced again,
  // and each foot goes back to where it is danced with its next step.
  void follow(const SwingFeet& feet, const BodyFrames& danced, const BodyFrames& scaled, float dt_s,
              bool goes_home);
  // Feet and hips are where they are danced.
  bool is_home() const { return is_home_; }

 private:
  struct Foot {
    Eigen::Vector3f moved_m = Eigen::Vector3f::Zero();  // its ball, along the floor
    float turned_rad = 0.0f;                            // about +Y
  };
  Eigen::Vector3f hips_wanted_m(const SwingFeet& feet, const BodyFrames& danced,
                                const BodyFrames& scaled) const;

  std::array<Foot, 2> feet_;
  Eigen::Vector3f hips_moved_m_ = Eigen::Vector3f::Zero();
  bool is_home_ = true;
};

}  // namespace dance
