// SteadyHands: wrists that do not tremble while a hand is still, and hardly lag while it moves. The
// place of each wrist beside the trunk goes through a low pass whose cutoff rises with its speed,
// and that opens where it is observed further away than the measurement's errors explain; errors
// along the view are several times those across it. The arm is solved again for it. A hand that was
// still stays beside the trunk while it is hidden, for a second at most.
//
// Units/frames: metres in W; seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      a place out of the arm's reach is approached.
// Source:       Casiez, Roussel, Vogel: 1€ filter, CHI 2012.
#pragma once

#include <array>

#include "core/motion/spring.h"
#include "core/pose/kinematics.h"

namespace dance {

class SteadyHands {
 public:
  static constexpr float kOneEyeAlongSd_m = 0.05f;
  struct Measurement {
    Eigen::Vector3f eye_W_m;    // the camera
    float across_sd_m = 0.01f;  // of a well seen point
    // Along the view, of each hand: of one camera alone.
    std::array<float, 2> along_sd_m{kOneEyeAlongSd_m, kOneEyeAlongSd_m};
    std::array<float, 2> visibility{};  // 0…1, of each hand
  };

  void clear() { *this = SteadyHands(); }
  void apply(const Skeleton& skeleton, const Measurement& measurement, double seconds, Pose& pose);

 private:
  // Where the trunk is and faces: B has its origin at the hips, is upright and turned
  // with the body. Itself filtered, so that hands do not tremble with it.
  struct Trunk {
    bool is_known = false;
    Eigen::Vector3f p_WB_m = Eigen::Vector3f::Zero();
    Eigen::Vector3f given_W_m = Eigen::Vector3f::Zero();  // the last one
    Eigen::Vector3f velocity_W_m_s = Eigen::Vector3f::Zero();
    float yaw_rad = 0.0f, given_yaw_rad = 0.0f, yaw_speed_rad_s = 0.0f;
    Eigen::Quaternionf R_WB = Eigen::Quaternionf::Identity();

    Eigen::Vector3f to_B(const Eigen::Vector3f& p_W_m) const {
      return R_WB.conjugate() * (p_W_m - p_WB_m);
    }
    Eigen::Vector3f to_W(const Eigen::Vector3f& p_B_m) const { return R_WB * p_B_m + p_WB_m; }
  };
  struct Arm {
    Eigen::Vector3f wrist_B_m = Eigen::Vector3f::Zero();
    Eigen::Vector3f elbow_B_m = Eigen::Vector3f::Zero();
    Eigen::Quaternionf R_BHand = Eigen::Quaternionf::Identity();

    // A part of the way to another.
    void approach(const Arm& other, float share);
  };
  struct Hand {
    bool is_known = false;
    bool is_lost = false;   // from when it is hidden until its arm has been seen again for a while
    bool is_held = false;   // was still before it was lost
    float hidden_s = 0.0f;  // of that time
    float seen_for_s = 0.0f;  // since it was lost; falls again while it is hidden
    Arm shown;
    Eigen::Vector3f given_B_m = Eigen::Vector3f::Zero();  // the last one
    Eigen::Vector3f velocity_B_m_s = Eigen::Vector3f::Zero();
    // A hand that is no longer held: the share of where it was held.
    Arm held;
    Spring blend;
  };
  void follow_trunk(const BodyFrames& frames, float step);
  // True where the hand is held.
  bool hold(Hand& hand, const Arm& given, float seen, float off, bool is_still, bool reaches,
            float step);

  Trunk trunk_;
  std::array<Hand, 2> hands_;
};

}  // namespace dance
