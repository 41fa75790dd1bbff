// AvatarRig: what is worked out once for an avatar that a certain dancer wears: the avatar's own
// skeleton on the canonical bones, at the size it is shown in, and the turns from the avatar's
// stance at rest to the dancer's T-pose.
//
// A node of bone b is turned from rest by D_b = R_WB · C_b. C_b brings the avatar's bone at rest to
// the direction that the dancer's has in T-pose, by the shortest turn (an A-pose is one for arms
// and legs); trunk and head are taken as upright as they are, feet as flat as they are. With the
// offsets C_parent · (place − place of parent) the avatar is then a Skeleton like any other: bones
// lie parallel to the dancer's, whatever the axes of its nodes.
//
// Units/frames: metres as shown; places in a bone's axes are those of W in T-pose.
// Ownership:    shares the shape.
// Threads:      none inside; const use from any.
// Failure:      none.
#pragma once

#include <array>
#include <memory>

#include "core/pose/kinematics.h"
#include "viewer/figure/rig/avatar_shape.h"
#include "viewer/scene/scene.h"

namespace dance {

// What a foot stands on: points of the foot, from the ankle in the foot's axes, and of the toes,
// from the toes' joint in theirs.
struct FootPoints {
  SoleHull lowest;
  Eigen::Vector3f ball_m;  // of the foot
  Eigen::Vector3f tip_m;   // of the toes
};

inline std::size_t toes_of(std::size_t side) {
  return index_of(side == 0 ? Bone::kLeftToes : Bone::kRightToes);
}

struct AvatarRig {
  AvatarRig(std::shared_ptr<const AvatarShape> shape_of_model, const Skeleton& dancer,
            FigureSize size, float height_scale);

  // What `pose` is on the bones that the avatar has: a missing bone's turn goes to its neighbours.
  void fold(Pose& pose) const;

  std::shared_ptr<const AvatarShape> shape;
  Skeleton body;             // the avatar's
  float scale = 1.0f;        // from the model to what is shown
  float leg_ratio = 1.0f;    // the avatar's legs to the dancer's
  float girth_ratio = 1.0f;  // of the trunk
  bool is_own_body = false;  // the avatar is the dancer's own mannequin
  BoneRotations C = identity_rotations();
  std::array<Eigen::Quaternionf, kFingerBoneCount> C_finger;
  Eigen::Vector3f eyes_m = Eigen::Vector3f::Zero();  // from the head's joint, in its axes
  std::array<FootPoints, 2> dancer_feet, feet;
  std::array<Eigen::Vector3f, 2> dancer_palms_m, palms_m;      // from the wrist, in the hand's axes
  std::array<std::size_t, kFingerBoneCount> finger_leaders{};  // drivers
};

}  // namespace dance
