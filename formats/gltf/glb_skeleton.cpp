#include "formats/gltf/glb_skeleton.h"

#include "formats/body/hand_layout.h"

namespace dance {
namespace {

class Joints {
 public:
  std::size_t add(std::string name, int parent, const Eigen::Vector3f& offset_m) {
    const Eigen::Vector3f place_m =
        parent < 0 ? offset_m
                   : Eigen::Vector3f(joints_[static_cast<std::size_t>(parent)].place_m + offset_m);
    joints_.push_back({std::move(name), parent, offset_m, place_m});
    return joints_.size() - 1;
  }
  void add_end(std::size_t of, const Eigen::Vector3f& offset_m) {
    add(joints_[of].name + "End", static_cast<int>(of), offset_m);
  }
  std::vector<GlbJoint> take() { return std::move(joints_); }

 private:
  std::vector<GlbJoint> joints_;
};

bool is_hand(Bone bone) { return bone == Bone::kLeftHand || bone == Bone::kRightHand; }

}  // namespace

std::vector<GlbJoint> glb_joints(const Skeleton& skeleton, bool has_hands) {
  Joints joints;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    joints.add(std::string(kBones[b].name), kBones[b].parent, skeleton.offset_m[b]);
  const HandLayout layout = hand_layout(skeleton);
  if (has_hands)
    for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
      const int parent = kFingerBones[f].parent;
      joints.add(std::string(kFingerBones[f].name),
                 parent < 0 ? static_cast<int>(index_of(hand_of_finger_bone(f)))
                            : static_cast<int>(kBoneCount) + parent,
                 layout.offset_m[f]);
    }
  for (std::size_t t = 0; t < kTipCount; ++t)
    if (!(has_hands && is_hand(kTipBones[t])))
      joints.add_end(index_of(kTipBones[t]), skeleton.tip_m[t]);
  if (has_hands)
    for (std::size_t finger = 0; finger < kFingerCount; ++finger)
      joints.add_end(kBoneCount + finger * kBonesOfAFinger + kBonesOfAFinger - 1,
                     layout.tip_m[finger]);
  return joints.take();
}

}  // namespace dance
