// A lead and a follow of one seed for the tests, looked at from outside only: through their poses
// and skeletons.
//
// Units/frames: as producers/dancer.h; places in W.
// Ownership:    owns its dancers.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <cmath>

#include "core/pose/kinematics.h"
#include "producers/salsa/salsa_dancer.h"

namespace dance {

constexpr double kDegreesPerRadian = 57.29577951308232;

class SalsaCouple {
 public:
  explicit SalsaCouple(SalsaStyle style)
      : tempo_bpm_(style.tempo_bpm),
        dancers_{SalsaDancer(in_role(style, SalsaRole::kLead)),
                 SalsaDancer(in_role(style, SalsaRole::kFollow))} {}

  void dance_at_beat(double beats) { dance_at(Duration::seconds(beats * 60.0 / tempo_bpm_)); }
  void dance_at(Duration t) {
    for (std::size_t i = 0; i < 2; ++i) {
      dancers_[i].dance_at(t, poses_[i]);
      forward_kinematics(dancers_[i].skeleton(), poses_[i], frames_[i]);
    }
  }

  const SalsaScore& score() const { return dancers_[0].score(); }
  const Skeleton& skeleton(SalsaRole role) const { return dancers_[of(role)].skeleton(); }
  const Pose& pose(SalsaRole role) const { return poses_[of(role)]; }
  const BodyFrames& frames(SalsaRole role) const { return frames_[of(role)]; }
  const SalsaHold& hold() const { return dancers_[0].body().hold; }

  Eigen::Vector3f palm(SalsaRole role, bool is_left) const {
    const BodyFrames& f = frames(role);
    const Eigen::Vector3f& wrist = f.position(is_left ? Bone::kLeftHand : Bone::kRightHand);
    const Eigen::Vector3f& fingers = f.tip(is_left ? Tip::kLeftHand : Tip::kRightHand);
    return wrist + kPalmShare * (fingers - wrist);
  }
  // Where the hips face, seen from above.
  double yaw_deg(SalsaRole role) const {
    const Eigen::Vector3f ahead = pose(role).R_PB[0] * Eigen::Vector3f::UnitZ();
    return kDegreesPerRadian *
           std::atan2(static_cast<double>(ahead.x()), static_cast<double>(ahead.z()));
  }
  // From the lead's hips to the follow's, on the floor.
  Eigen::Vector3f between() const {
    const Eigen::Vector3f d = poses_[1].p_WH_m - poses_[0].p_WH_m;
    return {d.x(), 0.0f, d.z()};
  }
  // The ball of a foot above where it is when the foot stands, m.
  float ball_lift_m(SalsaRole role, bool is_left) const {
    const Skeleton& s = skeleton(role);
    const float standing = s.hips_height_m() + s.offset(Bone::kLeftUpperLeg).y() +
                           s.offset(Bone::kLeftLowerLeg).y() + s.offset(Bone::kLeftFoot).y() +
                           s.offset(Bone::kLeftToes).y();
    return frames(role).position(is_left ? Bone::kLeftToes : Bone::kRightToes).y() - standing;
  }

 private:
  static std::size_t of(SalsaRole role) { return role == SalsaRole::kLead ? 0 : 1; }
  static SalsaStyle in_role(SalsaStyle style, SalsaRole role) {
    style.role = role;
    return style;
  }

  double tempo_bpm_;
  std::array<SalsaDancer, 2> dancers_;
  std::array<Pose, 2> poses_;
  std::array<BodyFrames, 2> frames_;
};

constexpr std::array<SalsaRole, 2> kSalsaRoles{SalsaRole::kLead, SalsaRole::kFollow};

inline SalsaStyle salsa_style(std::uint64_t seed, double tempo_bpm = 184.0) {
  SalsaStyle style;
  style.seed = seed;
  style.tempo_bpm = tempo_bpm;
  return style;
}

}  // namespace dance
