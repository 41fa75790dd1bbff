#include "formats/osc/vrchat_writer.h"

#include "formats/osc/unity_axes.h"

namespace dance {

// Trackers at knees and elbows are worn above the joint: they turn with thigh and upper arm.
const std::array<VrchatTracker, kVrchatTrackerCount> kVrchatTrackers{{
    {"/tracking/trackers/head/position", "/tracking/trackers/head/rotation", Bone::kHead,
     Bone::kHead},
    {"/tracking/trackers/1/position", "/tracking/trackers/1/rotation", Bone::kHips, Bone::kHips},
    {"/tracking/trackers/2/position", "/tracking/trackers/2/rotation", Bone::kUpperChest,
     Bone::kUpperChest},
    {"/tracking/trackers/3/position", "/tracking/trackers/3/rotation", Bone::kLeftFoot,
     Bone::kLeftFoot},
    {"/tracking/trackers/4/position", "/tracking/trackers/4/rotation", Bone::kRightFoot,
     Bone::kRightFoot},
    {"/tracking/trackers/5/position", "/tracking/trackers/5/rotation", Bone::kLeftLowerLeg,
     Bone::kLeftUpperLeg},
    {"/tracking/trackers/6/position", "/tracking/trackers/6/rotation", Bone::kRightLowerLeg,
     Bone::kRightUpperLeg},
    {"/tracking/trackers/7/position", "/tracking/trackers/7/rotation", Bone::kLeftLowerArm,
     Bone::kLeftUpperArm},
    {"/tracking/trackers/8/position", "/tracking/trackers/8/rotation", Bone::kRightLowerArm,
     Bone::kRightUpperArm},
}};

void VrchatWriter::write_pose(const Pose& pose) {
  forward_kinematics(skeleton_, pose, frames_);
  for (std::size_t i = 0; i < kVrchatTrackerCount; ++i) {
    const VrchatTracker& tracker = kVrchatTrackers[i];
    const Eigen::Vector3f p = other_hand(frames_.position(tracker.joint));
    const Eigen::Vector3f angles =
        angles_[i].follow(other_hand(frames_.R_WB[index_of(tracker.strap)]));
    bundles_.add(tracker.position_address, {p.x(), p.y(), p.z()});
    bundles_.add(tracker.rotation_address, {angles.x(), angles.y(), angles.z()});
  }
  bundles_.flush();
}

}  // namespace dance
