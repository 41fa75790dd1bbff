// BodyState: a dancer's posture as 44 degrees of freedom. A knee is one
// angle, an elbow two, a back is bent evenly over its three bones, a neck over its two. A posture
// in these numbers has its bones' lengths whatever they are.
//
// Units/frames: metres and radians; W and the bones of core/pose/pose.h. Angles of the right side
//               are those of the left seen in a mirror.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/pose/pose.h"

namespace dance {

// Index of each degree of freedom in the vector of all.
namespace dof {
constexpr int kPlace = 0;  // of the hips in W
constexpr int kHips = 3;   // a turn about the hips' own axes
constexpr int kSpine = 6;  // of spine, chest and upper chest together
constexpr int kHead = 9;   // of neck and head together
constexpr int kLeft = 12;  // the left arm and leg, then the right ones
constexpr int kOfSide = 16;
// Within a side.
constexpr int kShoulder = 0;  // up, forward
constexpr int kUpperArm = 2;
constexpr int kElbow = 5;
constexpr int kTurn = 6;  // of the forearm, shared with the hand
constexpr int kHand = 7;
constexpr int kUpperLeg = 9;
constexpr int kKnee = 12;
constexpr int kFoot = 13;
constexpr int kCount = 44;
constexpr int side(int s) { return kLeft + s * kOfSide; }
}  // namespace dof

using DofVector = Eigen::Matrix<double, dof::kCount, 1>;

struct BodyState {
  struct Side {
    double shoulder_up = 0.0;
    double shoulder_forward = 0.0;
    Eigen::Quaterniond upper_arm = Eigen::Quaterniond::Identity();
    double elbow = 0.0;  // 0 is straight
    double turn = 0.0;
    double hand_up = 0.0;
    double hand_forward = 0.0;
    Eigen::Quaterniond upper_leg = Eigen::Quaterniond::Identity();
    double knee = 0.0;  // 0 is straight
    Eigen::Quaterniond foot = Eigen::Quaterniond::Identity();
  };
  Eigen::Vector3d p_WH_m{0.0, 0.95, 0.0};
  Eigen::Quaterniond R_WH = Eigen::Quaterniond::Identity();
  Eigen::Vector3d spine = Eigen::Vector3d::Zero();  // a rotation vector
  Eigen::Vector3d head = Eigen::Vector3d::Zero();
  std::array<Side, 2> sides;
};

// How far elbows and knees bend.
constexpr double kMostElbow_rad = 2.7;
constexpr double kMostKnee_rad = 2.7;
// Bounds beyond what bodies do. Without them a fit to wrong points winds a back, a neck or a
// forearm up by whole turns, which no later picture unwinds. Back and neck: length of the rotation
// vector.
constexpr double kMostSpine_rad = 2.2;
constexpr double kMostHead_rad = 2.2;
constexpr double kMostShoulder_rad = 1.5;
constexpr double kMostTurn_rad = 3.2;
constexpr double kMostHand_rad = 2.2;

Eigen::Quaterniond turn_of(const Eigen::Vector3d& rotation_vector);
Eigen::Vector3d vector_of(const Eigen::Quaterniond& q);

// The state moved by `step`; joints stop at the bounds above.
void move(BodyState& state, const DofVector& step);
// The step that leads from `from` to `to`.
DofVector step_between(const BodyState& from, const BodyState& to);

// The bones' rotations and the hips' place; nothing else of the pose is touched.
void write_pose(const BodyState& state, Pose& pose);
// Left and right exchanged, as a mirror does.
void mirror(Pose& pose);

}  // namespace dance
