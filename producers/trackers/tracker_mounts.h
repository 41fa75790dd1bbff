// Mounts: where a tracked device sits on the bone that it tells of, and the bone's place that
// follows from the device's.
//
// Units/frames: T is the device's frame, B the bone's: X_WB = X_WT * X_BT^-1. Metres.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none. A mount that is not known is of no use: its point counts as not tracked.
// Source:       OpenXR 1.0, grip pose, for what hands hold; eyes against the head bone after
//               Winter, Biomechanics and Motor Control of Human Movement (2009).
#pragma once

#include "core/pose/pose.h"
#include "producers/trackers/tracker_frame.h"

namespace dance {

// The bone that each point tells of. Trackers at elbows and knees are worn above the joint.
constexpr std::array<Bone, kTrackedPointCount> kPointBones{
    Bone::kHead,         Bone::kLeftHand,      Bone::kRightHand,    Bone::kHips,
    Bone::kLeftFoot,     Bone::kRightFoot,     Bone::kLeftUpperArm, Bone::kRightUpperArm,
    Bone::kLeftUpperLeg, Bone::kRightUpperLeg, Bone::kUpperChest};

// A bone's place, or a device's.
struct Place {
  Eigen::Vector3f p_W_m = Eigen::Vector3f::Zero();
  Eigen::Quaternionf R_W = Eigen::Quaternionf::Identity();
};

struct Mount {
  Eigen::Vector3f p_BT_m = Eigen::Vector3f::Zero();
  Eigen::Quaternionf R_BT = Eigen::Quaternionf::Identity();
  bool is_known = false;
};

// Of a body of this height, before any calibration: head and hands; other points have none.
Mount nominal_mount(TrackedPoint point, float height_m);

Place bone_place(const Mount& mount, const Place& device);
Place device_place(const Mount& mount, const Place& bone);
// The mount of a device that is here while its bone is there.
Mount mount_between(const Place& bone, const Place& device);

// Where the bones are that the present points with known mounts tell of.
struct BonePlaces {
  std::array<Place, kTrackedPointCount> places;
  std::uint32_t presence = 0;
  MonoTime time;

  bool has(TrackedPoint point) const { return (presence >> index_of(point) & 1u) != 0; }
  const Place& of(TrackedPoint point) const { return places[index_of(point)]; }
  void put(TrackedPoint point, const Place& place) {
    places[index_of(point)] = place;
    presence |= 1u << index_of(point);
  }
  void remove(TrackedPoint point) { presence &= ~(1u << index_of(point)); }
};

}  // namespace dance
