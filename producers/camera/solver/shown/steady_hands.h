// SteadyHands: wrists that do not tremble while a hand is still, and hardly lag while it moves. The
// place of each wrist in W goes through a low pass whose cutoff rises with its speed, and that
// opens where it is observed further away than the measurement's errors explain; errors along the
// view are several times those across it. The arm is solved again for it.
//
// Units/frames: metres in W; seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      a place out of the arm's reach is approached.
// Source:       Casiez, Roussel, Vogel: 1€ filter, CHI 2012.
#pragma once

#include <array>

#include "core/pose/kinematics.h"

namespace dance {

class SteadyHands {
 public:
  struct Measurement {
    Eigen::Vector3f eye_W_m;            // the camera
    float across_sd_m = 0.01f;          // of a well seen point
    std::array<float, 2> visibility{};  // 0…1, of each hand
  };

  void clear() { hands_.fill(Hand()); }
  void apply(const Skeleton& skeleton, const Measurement& measurement, double seconds, Pose& pose);

 private:
  struct Hand {
    bool is_known = false;
    bool is_held = false;     // hidden, and still before
    float seen_for_s = 1.0f;  // since it was hidden
    Eigen::Vector3f shown_W_m = Eigen::Vector3f::Zero();
    Eigen::Vector3f elbow_W_m = Eigen::Vector3f::Zero();
    Eigen::Quaternionf R_WHand = Eigen::Quaternionf::Identity();
    Eigen::Vector3f given_W_m = Eigen::Vector3f::Zero();  // the last one
    Eigen::Vector3f velocity_W_m_s = Eigen::Vector3f::Zero();
  };
  std::array<Hand, 2> hands_;
};

}  // namespace dance
