// StereoDancer: a dancer's pose as the body that a StereoScene draws, and as the landmarks that a
// pose network with the errors of one would give of it.
//
// Units/frames: W and the scene's frame S (testing/camera/stereo_scene.h): the camera stands before
//               the dancer, who faces it in T-pose.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <vector>

#include "core/base/random.h"
#include "core/pose/kinematics.h"
#include "producers/camera/body_landmarks.h"
#include "testing/camera/stereo_scene.h"

namespace dance {

struct StageCamera {
  double distance_m = 3.0;  // from the middle of the stage
  double height_m = 1.1;
  double aside_m = 0.0;
  Eigen::Vector3d in_scene(const Eigen::Vector3f& p_W_m) const {
    return {p_W_m.x() + aside_m, height_m - p_W_m.y(), distance_m - p_W_m.z()};
  }
};

struct DancerLook {
  double girth = 1.0;      // over an average body's
  double contrast = 25.0;  // of the clothes' pattern, grey levels
};
std::vector<SceneLimb> body_of(const BodyFrames& frames, const StageCamera& camera,
                               const DancerLook& look);

// What is wrong with a network's landmarks: standard deviations, each joint for itself, and one
// size for all.
struct NetworkErrors {
  double image_px = 1.75;
  double across_m = 0.02;
  double depth_m = 0.04;
  double scale = 1.0;  // true metres over the network's
};

// Where joints truly are in S, in the order of Landmark.
std::array<Eigen::Vector3d, kLandmarkCount> joints_of(const BodyFrames& frames,
                                                      const StageCamera& camera);
BodyLandmarks landmarks_of(const std::array<Eigen::Vector3d, kLandmarkCount>& joints_S_m,
                           const StereoRig& rig, Side side, const NetworkErrors& errors,
                           Random& random);

}  // namespace dance
