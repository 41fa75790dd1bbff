// TrackerFrame: where the few tracked points of a dancer are at one moment: a headset, two
// controllers or hands, and trackers that are worn. Each point is a device, as it is held or
// strapped on, not a bone: calibration finds what lies between.
//
// Units/frames: metres in W (+Y up, the floor at 0, as OpenXR's stage space). Head: between the
//               eyes, -Z looks forward, +Y up. Hands: OpenXR's grip pose (origin in the palm, -Z
//               from the little finger to the thumb through a closed hand, +X out of the palm of
//               the left hand and out of the back of the right). Others: as the tracker is worn.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for a present point that is not finite, not a rotation within
//               1 %, or outside the stage.
// Source:       OpenXR 1.0, standard pose identifiers; XR_HTCX_vive_tracker_interaction for roles.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string_view>

#include "core/base/time.h"

namespace dance {

enum class TrackedPoint : std::uint8_t {
  kHead,
  kLeftHand,
  kRightHand,
  kHips,
  kLeftFoot,
  kRightFoot,
  kLeftElbow,
  kRightElbow,
  kLeftKnee,
  kRightKnee,
  kChest,
};
constexpr std::size_t kTrackedPointCount = 11;

constexpr std::size_t index_of(TrackedPoint point) { return static_cast<std::size_t>(point); }

constexpr std::array<std::string_view, kTrackedPointCount> kTrackedPointNames{
    "head",       "left-hand",   "right-hand", "hips",       "left-foot", "right-foot",
    "left-elbow", "right-elbow", "left-knee",  "right-knee", "chest"};

struct TrackerFrame {
  std::array<Eigen::Vector3f, kTrackedPointCount> p_WT_m;
  std::array<Eigen::Quaternionf, kTrackedPointCount> R_WT;
  std::uint32_t presence = 0;  // a bit for each point that is tracked now
  MonoTime time;

  TrackerFrame() {
    p_WT_m.fill(Eigen::Vector3f::Zero());
    R_WT.fill(Eigen::Quaternionf::Identity());
  }
  bool has(TrackedPoint point) const { return (presence >> index_of(point) & 1u) != 0; }
  void put(TrackedPoint point, const Eigen::Vector3f& p_m, const Eigen::Quaternionf& R) {
    p_WT_m[index_of(point)] = p_m;
    R_WT[index_of(point)] = R;
    presence |= 1u << index_of(point);
  }
  void remove(TrackedPoint point) { presence &= ~(1u << index_of(point)); }
  const Eigen::Vector3f& position(TrackedPoint point) const { return p_WT_m[index_of(point)]; }
  const Eigen::Quaternionf& rotation(TrackedPoint point) const { return R_WT[index_of(point)]; }
};

// What comes from a device is checked here, once.
bool is_valid(const TrackerFrame& frame);

}  // namespace dance
