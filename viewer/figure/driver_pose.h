// From a fitted figure to how each driver of its model (viewer/figure/rig/avatar_shape.h) stands:
// the bones, the fingers, and the nodes that share a limb's twist.
//
// The twist between the upper arm and the hand is shared in equal steps by elbow, helper nodes and
// wrist, and is 150° at most in all, so that no joint is wrung: 75° where a model has no helpers.
//
// Units/frames: metres in W; a driver's turn is D, from the model at rest to W.
// Ownership:    writes into what it is given; no allocation.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <span>

#include "viewer/figure/figure_fit.h"

namespace dance {

struct DriverPose {
  Eigen::Quaternionf D = Eigen::Quaternionf::Identity();
  Eigen::Vector3f place_W_m = Eigen::Vector3f::Zero();
};

constexpr float kMostForearmTwist_rad = 2.6f;

// The twist of both forearms, kept from picture to picture so that it may pass half a turn.
struct ForearmTwists {
  std::array<float, 2> danced_rad{};
  std::array<float, 2> shown_rad{};
  bool is_known = false;
};

// Turns hands back that are twisted further than kMostForearmTwist_rad: before contacts, as palms
// move with it.
void limit_hand_twist(FigureFit& fit, ForearmTwists& twists);
// Bones, with the forearms of `fit.frames` brought to what is shown.
void drive_bones(FigureFit& fit, const ForearmTwists& twists, bool shares_twist,
                 std::span<DriverPose> drivers);
// Fingers as danced; those of which nothing is known are slightly curled, as hands at rest.
void drive_fingers(const AvatarRig& rig, const Hands* hands, const BodyFrames& frames,
                   std::span<DriverPose> drivers);
void drive_twists(const AvatarRig& rig, std::span<DriverPose> drivers);
// Turns the eyes that have nodes of their own; radians to the dancer's left and up.
void drive_eyes(const AvatarRig& rig, const std::array<float, 2>& gaze_rad,
                std::span<DriverPose> drivers);

// A driver that only follows its leader.
DriverPose following(const AvatarRig& rig, std::size_t driver, std::size_t leader,
                     const DriverPose& leader_pose);

// How far q turns about `axis`, which has length 1: −π … π.
float twist_rad(const Eigen::Quaternionf& q, const Eigen::Vector3f& axis);

}  // namespace dance
