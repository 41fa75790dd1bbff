// ViewPoints: what one camera saw of a body at one moment, as the placement of several cameras
// needs it: the rays of the joints, and the network's metres.
//
// Units/frames: rays x/z, y/z and metres in the camera's frame (producers/camera/pinhole.h); `time`
//               is the camera's own stamp.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      points that are hidden or outside of the picture have weight 0.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/base/time.h"
#include "producers/camera/solver/observation.h"

namespace dance {

// Points that networks place alike from all sides; the face and the fingers they do not.
constexpr std::array kViewLandmarks{
    Landmark::kNose,          Landmark::kLeftEar,       Landmark::kRightEar,
    Landmark::kLeftShoulder,  Landmark::kRightShoulder, Landmark::kLeftElbow,
    Landmark::kRightElbow,    Landmark::kLeftWrist,     Landmark::kRightWrist,
    Landmark::kLeftHip,       Landmark::kRightHip,      Landmark::kLeftKnee,
    Landmark::kRightKnee,     Landmark::kLeftAnkle,     Landmark::kRightAnkle,
    Landmark::kLeftHeel,      Landmark::kRightHeel,     Landmark::kLeftFootIndex,
    Landmark::kRightFootIndex};
constexpr std::size_t kViewPointCount = kViewLandmarks.size();
// kViewPointCount where it is none of them.
constexpr std::size_t view_point_of(Landmark l) {
  for (std::size_t i = 0; i < kViewPointCount; ++i)
    if (kViewLandmarks[i] == l) return i;
  return kViewPointCount;
}

struct ViewPoints {
  MonoTime time;
  float ray_sd = 0.0f;
  float distance_m = 0.0f;  // of the hips, by the network's metres; 0: not known
  Eigen::Vector3f hips_m = Eigen::Vector3f::Zero();  // by the network's metres
  std::array<Eigen::Vector2f, kViewPointCount> ray;
  std::array<Eigen::Vector3f, kViewPointCount> world_m;
  std::array<float, kViewPointCount> weight{};
};

ViewPoints view_points(const Observation& seen, MonoTime time);

// Mean way of the rays that both have, in standard deviations of one.
double way_between(const ViewPoints& a, const ViewPoints& b);

}  // namespace dance
