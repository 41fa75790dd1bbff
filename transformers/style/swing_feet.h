// SwingFeet: which foot is on its way. A foot swings as much as both its ankle and its ball are
// fast: one that stands, or turns on its heel or ball, does not at all.
//
// Units/frames: metres in W, +Y up; metres a second.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. The floor is the lowest that a foot was lately, and rises by 2 cm a second:
//               after a stair it is known in nine.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/pose/kinematics.h"

namespace dance {

constexpr std::array<Limb, 2> kSwingLegs{kLeftLeg, kRightLeg};
constexpr std::size_t ankle_of(std::size_t side) { return index_of(kSwingLegs[side].end); }
constexpr std::size_t ball_of(std::size_t side) { return ankle_of(side) + 1; }

class SwingFeet {
 public:
  // One pose after the other; `begins`: it has none before it.
  void follow(const BodyFrames& frames, float dt_s, bool begins);
  // 0 stands … 1 swings.
  float swing(std::size_t side) const { return feet_[side].swing; }
  // How high a heel is above where it stands.
  float heel_m(std::size_t side, const BodyFrames& frames) const {
    return frames.p_WB_m[ankle_of(side)].y() - feet_[side].ankle.floor_m;
  }
  // How low an ankle, or a ball, may be: on the floor, or where it was danced if that is lower.
  float lowest_ankle_m(std::size_t side, const BodyFrames& danced) const;
  float lowest_ball_m(std::size_t side, const BodyFrames& danced) const;

 private:
  struct Point {
    Eigen::Vector3f p_W_m = Eigen::Vector3f::Zero();
    Eigen::Vector3f v_W_m_s = Eigen::Vector3f::Zero();
    float floor_m = 0.0f;

    void follow(const Eigen::Vector3f& now_W_m, float dt_s, bool begins);
  };
  struct Foot {
    Point ankle, ball;
    float swing = 0.0f;
  };
  std::array<Foot, 2> feet_;
};

}  // namespace dance
