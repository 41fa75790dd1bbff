// Where the joints of a written dance are by our own kinematics, by the names that the files give
// them: to compare with what independent programs make of the files.
//
// Units/frames: metres in W.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <map>
#include <string>

#include "core/pose/clip.h"
#include "core/pose/kinematics.h"
#include "formats/body/hand_layout.h"

namespace dance::test {

inline std::map<std::string, Eigen::Vector3f> known_joints(const MotionClip& clip,
                                                           std::size_t frame) {
  BodyFrames body;
  forward_kinematics(clip.skeleton, clip.frames[frame], body);
  std::map<std::string, Eigen::Vector3f> joints;
  for (std::size_t b = 0; b < kBoneCount; ++b) joints[std::string(kBones[b].name)] = body.p_WB_m[b];
  for (std::size_t t = 0; t < kTipCount; ++t)
    joints[std::string(kBones[index_of(kTipBones[t])].name) + "End"] = body.p_WT_m[t];
  if (clip.hands.empty()) return joints;
  joints.erase("leftHandEnd");
  joints.erase("rightHandEnd");
  const HandLayout layout = hand_layout(clip.skeleton);
  std::array<Eigen::Vector3f, kFingerBoneCount> p_WF;
  std::array<Eigen::Quaternionf, kFingerBoneCount> R_WF;
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    const int parent = kFingerBones[f].parent;
    const std::size_t hand = index_of(hand_of_finger_bone(f));
    const auto above = static_cast<std::size_t>(parent);
    const Eigen::Quaternionf& R_WP = parent < 0 ? body.R_WB[hand] : R_WF[above];
    p_WF[f] = (parent < 0 ? body.p_WB_m[hand] : p_WF[above]) + R_WP * layout.offset_m[f];
    R_WF[f] = R_WP * clip.hands[frame].R_PB[f];
    const std::string name(kFingerBones[f].name);
    joints[name] = p_WF[f];
    if (f % kBonesOfAFinger + 1 == kBonesOfAFinger)
      joints[name + "End"] = p_WF[f] + R_WF[f] * layout.tip_m[f / kBonesOfAFinger];
  }
  return joints;
}

}  // namespace dance::test
