// BodySamples: places on a dancer's body for stereo matching: joints, limbs between them, a grid on
// the torso; with the depth of the joint under the skin that the cameras see.
//
// Units/frames: pixels of the raw left picture; metres of the pose network, axes of the camera,
//               origin midway between the hips.
// Ownership:    plain values of fixed size.
// Threads:      none inside.
// Failure:      none; landmarks that are marked as hidden are left out.
#pragma once

#include <Eigen/Core>

#include "core/base/fixed_list.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/pinhole.h"

namespace dance {

struct BodySample {
  Eigen::Vector2d raw_px;
  Eigen::Vector2d straight;  // normalised, without the lens's distortion
  Eigen::Vector3d p_m;       // of the point inside the body
  double skin_m = 0.0;       // how much nearer than that the camera sees skin
  double weight = 0.0;       // 0…1
};
constexpr std::size_t kMostBodySamples = 28;
using BodySamples = FixedList<BodySample, kMostBodySamples>;

void take_body_samples(const Pinhole& camera, const BodyLandmarks& body, BodySamples& out);

}  // namespace dance
