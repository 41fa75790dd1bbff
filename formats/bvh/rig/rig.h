// Rig: which joints of a motion capture file are which bones of the canonical skeleton. From the
// joints' names, as many tools write them, where they give a human figure; else from its shape.
//
// Units/frames: indices into Bvh::joints; kNoJoint where the file has no such bone.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      find_rig() of a figure that is not human names the bones it could not find.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pose/bone.h"
#include "formats/bvh/bvh.h"

namespace dance {

constexpr int kNoJoint = -1;

struct Rig {
  std::array<int, kBoneCount> joint_of;
  std::array<int, kFingerBoneCount> finger_of;
  bool is_from_names = true;
  std::string assumption;  // one line where names or shape left a choice, else empty

  Rig() {
    joint_of.fill(kNoJoint);
    finger_of.fill(kNoJoint);
  }
  int joint(Bone bone) const { return joint_of[index_of(bone)]; }
  bool has(Bone bone) const { return joint(bone) != kNoJoint; }
  int& operator[](Bone bone) { return joint_of[index_of(bone)]; }
};

// Joint order, helper joints between the bones and missing chest, shoulders, hands, feet, toes,
// neck and head are all fine; hips, upper and lower arms and legs must be there.
Result<Rig> find_rig(const Bvh& bvh);

// The required bones that this rig lacks.
std::vector<std::string> missing_bones(const Rig& rig);

}  // namespace dance
