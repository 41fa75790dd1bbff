// GeometricGuide: a whole body by rules. The trunk turns after head and hands, hips hang under the
// head, elbows follow the hands, and a foot steps when the hips have left it behind.
//
// Units/frames: W, metres.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include "producers/trackers/body/body_guide.h"

namespace dance {

class GeometricGuide : public BodyGuide {
 public:
  void reset() override { *this = GeometricGuide(); }
  void guess(const Skeleton& skeleton, const BonePlaces& bones, float seconds,
             BodyGuess& guess) override;

 private:
  struct Foot {
    Eigen::Vector3f ankle = Eigen::Vector3f::Zero();  // where it is now
    Eigen::Vector3f from = Eigen::Vector3f::Zero();   // where its step began
    float yaw_rad = 0.0f, from_yaw_rad = 0.0f;
    float step_s = -1.0f;  // since it left the floor; below 0: it stands
    float stood_s = 0.0f;
  };

  float wanted_yaw_rad(const BonePlaces& bones) const;
  void guess_trunk(const Skeleton& skeleton, const BonePlaces& bones, BodyGuess& guess) const;
  void guess_arm(const Skeleton& skeleton, const BonePlaces& bones, bool left, const Pose& pose,
                 BodyFrames& frames, BodyGuess& guess) const;
  void guess_legs(const Skeleton& skeleton, Pose& pose, BodyFrames& frames, BodyGuess& guess) const;
  void step_feet(const Skeleton& skeleton, const BonePlaces& bones, const BodyGuess& guess,
                 float seconds);
  void swing(Foot& foot, const Eigen::Vector3f& to, float seconds) const;
  Eigen::Vector3f rest_place(const Skeleton& skeleton, const BodyGuess& guess, bool left) const;

  float yaw_rad_ = 0.0f;
  std::array<Foot, 2> feet_;
  Eigen::Vector3f hips_before_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f hips_m_s_ = Eigen::Vector3f::Zero();
  bool began_ = false;
};

}  // namespace dance
