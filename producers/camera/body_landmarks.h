// BodyLandmarks: the pose network's 33 landmarks of one person in one picture, in pixels and in
// metres.
//
// Units/frames: image points in pixels of the whole picture, (0, 0) the left upper corner of the
//               left upper pixel as the network's makers have it: half a pixel more than in a
//               Pinhole (z in the same scale, smaller is nearer, 0 at the hips); world points in
//               metres, axes of the camera (x right, y down, z away), origin midway between the
//               hips. Left and right are the dancer's own.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      `found` is false where no person was detected; the rest is then not valid.
// Source:       order and meaning of the points: MediaPipe Pose (BlazePose GHUM 3D model card).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/time.h"

namespace dance {

enum class Landmark : std::uint8_t {
  kNose,
  kLeftEyeInner,
  kLeftEye,
  kLeftEyeOuter,
  kRightEyeInner,
  kRightEye,
  kRightEyeOuter,
  kLeftEar,
  kRightEar,
  kMouthLeft,
  kMouthRight,
  kLeftShoulder,
  kRightShoulder,
  kLeftElbow,
  kRightElbow,
  kLeftWrist,
  kRightWrist,
  kLeftPinky,
  kRightPinky,
  kLeftIndex,
  kRightIndex,
  kLeftThumb,
  kRightThumb,
  kLeftHip,
  kRightHip,
  kLeftKnee,
  kRightKnee,
  kLeftAnkle,
  kRightAnkle,
  kLeftHeel,
  kRightHeel,
  kLeftFootIndex,
  kRightFootIndex,
};
constexpr std::size_t kLandmarkCount = 33;
constexpr std::size_t index_of(Landmark landmark) { return static_cast<std::size_t>(landmark); }

// As people write it: "left knee".
std::string_view name_of(Landmark landmark);

// The turned square of the picture that the network looked at.
struct BodyRegion {
  float centre_x_px = 0.0f;
  float centre_y_px = 0.0f;
  float side_px = 0.0f;
  float turn_rad = 0.0f;
};

struct BodyLandmarks {
  bool found = false;
  bool is_new = false;    // the detector found this person just now: nothing before belongs to it
  float presence = 0.0f;  // 0…1, of the whole person
  MonoTime capture_time;
  BodyRegion region;
  std::array<Eigen::Vector3f, kLandmarkCount> image_px;
  std::array<Eigen::Vector3f, kLandmarkCount> world_m;
  std::array<float, kLandmarkCount> visibility{};  // 0…1: in the picture and not hidden

  const Eigen::Vector3f& image(Landmark l) const { return image_px[index_of(l)]; }
  const Eigen::Vector3f& world(Landmark l) const { return world_m[index_of(l)]; }
  float visible(Landmark l) const { return visibility[index_of(l)]; }
};

}  // namespace dance
