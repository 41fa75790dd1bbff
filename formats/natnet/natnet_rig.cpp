#include "formats/natnet/natnet_rig.h"

#include <algorithm>
#include <bit>
#include <span>
#include <string_view>

namespace dance {
namespace {

struct Name {
  std::string_view name;
  Bone bone;
};

// Of the middle of the body, as they stand; those of the trunk are told apart by their order.
constexpr Name kMiddle[] = {
    {"Hip", Bone::kHips}, {"Hips", Bone::kHips}, {"Neck", Bone::kNeck}, {"Head", Bone::kHead}};
constexpr std::string_view kTrunk[] = {"Ab",     "Spine", "Spine1", "Spine2",
                                       "Spine3", "Chest", "Chest1", "Chest2"};
// Of a side, without what says which; in the conventions of Motive and FBX, then in that of BVH, in
// which a shoulder is where the upper arm begins.
constexpr Name kSide[] = {
    {"Shoulder", Bone::kLeftShoulder}, {"UArm", Bone::kLeftUpperArm},
    {"Arm", Bone::kLeftUpperArm},      {"FArm", Bone::kLeftLowerArm},
    {"ForeArm", Bone::kLeftLowerArm},  {"Hand", Bone::kLeftHand},
    {"Thigh", Bone::kLeftUpperLeg},    {"UpLeg", Bone::kLeftUpperLeg},
    {"Shin", Bone::kLeftLowerLeg},     {"Leg", Bone::kLeftLowerLeg},
    {"Foot", Bone::kLeftFoot},         {"Toe", Bone::kLeftToes},
    {"ToeBase", Bone::kLeftToes},
};
constexpr Name kBvhSide[] = {
    {"Collar", Bone::kLeftShoulder}, {"Shoulder", Bone::kLeftUpperArm},
    {"Elbow", Bone::kLeftLowerArm},  {"Wrist", Bone::kLeftHand},
    {"Hip", Bone::kLeftUpperLeg},    {"Knee", Bone::kLeftLowerLeg},
    {"Ankle", Bone::kLeftFoot},      {"Toe", Bone::kLeftToes},
};
constexpr std::string_view kFingers[] = {"Thumb", "Index", "Middle", "Ring", "Pinky"};

// Left bones stand four before right ones, on arms and legs alike.
Bone on_side(Bone left, bool is_left) {
  return is_left ? left : static_cast<Bone>(index_of(left) + 4);
}

// Joint 0 to 2 of finger 0 to 4.
std::int16_t finger_bone(std::size_t finger, std::size_t joint, bool is_left) {
  return static_cast<std::int16_t>((is_left ? 0 : kFingerBoneCount / 2) + 3 * finger + joint);
}

// "Thumb1", "HandThumb1"; in BVH "Finger0", "Finger01", "Finger02".
std::int16_t finger_of(std::string_view name, bool is_left) {
  if (name.starts_with("Finger") && name.size() <= 8) {
    name.remove_prefix(6);
    if (name.empty() || name[0] < '0' || name[0] > '4') return NatNetRig::kNone;
    const auto finger = static_cast<std::size_t>(name[0] - '0');
    if (name.size() == 1) return finger_bone(finger, 0, is_left);
    if (name[1] != '1' && name[1] != '2') return NatNetRig::kNone;
    return finger_bone(finger, static_cast<std::size_t>(name[1] - '0'), is_left);
  }
  if (name.starts_with("Hand")) name.remove_prefix(4);
  for (std::size_t f = 0; f < std::size(kFingers); ++f) {
    if (!name.starts_with(kFingers[f]) || name.size() != kFingers[f].size() + 1) continue;
    const char digit = name.back();
    if (digit >= '1' && digit <= '3')
      return finger_bone(f, static_cast<std::size_t>(digit - '1'), is_left);
  }
  return NatNetRig::kNone;
}

void name_part(std::string_view name, std::span<const Name> side_names, NatNetRig::Part& part) {
  for (const Name& middle : kMiddle)
    if (name == middle.name) part.bone = static_cast<std::int16_t>(index_of(middle.bone));
  for (const std::string_view prefix : {"Left", "Right", "L", "R"}) {
    if (!name.starts_with(prefix)) continue;
    const bool is_left = prefix[0] == 'L';
    const std::string_view rest = name.substr(prefix.size());
    for (const Name& side : side_names)
      if (rest == side.name)
        part.bone = static_cast<std::int16_t>(index_of(on_side(side.bone, is_left)));
    if (part.finger_bone == NatNetRig::kNone) part.finger_bone = finger_of(rest, is_left);
  }
}

// "Bob_Hip" and "Bob:Hip" of a skeleton Bob.
std::string_view without_subject(std::string_view name, std::string_view subject) {
  if (name.size() > subject.size() + 1 && name.starts_with(subject) &&
      (name[subject.size()] == '_' || name[subject.size()] == ':'))
    name.remove_prefix(subject.size() + 1);
  return name;
}

}  // namespace

std::int16_t NatNetRig::part_of(std::int32_t id) const {
  const auto found =
      std::find_if(parts.begin(), parts.end(), [&](const Part& part) { return part.id == id; });
  return found == parts.end() ? kNone : static_cast<std::int16_t>(found - parts.begin());
}

NatNetRig find_natnet_rig(const NatNetModel& model) {
  NatNetRig rig;
  const bool is_bvh = std::any_of(
      model.bones.begin(), model.bones.end(),
      [](const NatNetModelBone& bone) { return bone.name.view().ends_with("LeftCollar"); });
  const std::span<const Name> side_names = is_bvh ? std::span<const Name>(kBvhSide) : kSide;
  FixedList<std::size_t, std::size(kTrunk)> trunk;
  for (const NatNetModelBone& bone : model.bones) {
    NatNetRig::Part part;
    part.id = bone.id;
    part.offset_m = bone.offset_m;
    // Motive lists parents first; what it does not is nobody's child.
    if (bone.parent_id != 0) part.parent = rig.part_of(bone.parent_id);
    const std::string_view name = without_subject(bone.name.view(), model.name.view());
    name_part(name, side_names, part);
    const std::size_t place = rig.parts.size();
    if (std::find(std::begin(kTrunk), std::end(kTrunk), name) != std::end(kTrunk) &&
        !trunk.try_push(place))
      break;
    if (!rig.parts.try_push(part)) break;
  }
  const auto set = [&](std::size_t place, Bone bone) {
    rig.parts[place].bone = static_cast<std::int16_t>(index_of(bone));
  };
  if (trunk.size() > 0) set(trunk[0], Bone::kSpine);
  if (trunk.size() > 1) set(trunk[trunk.size() - 1], Bone::kUpperChest);
  if (trunk.size() > 2) set(trunk[trunk.size() - 2], Bone::kChest);
  // The first of a name counts.
  std::uint32_t taken = 0;
  for (NatNetRig::Part& part : rig.parts) {
    if (part.bone == NatNetRig::kNone) continue;
    if ((taken >> part.bone & 1u) != 0)
      part.bone = NatNetRig::kNone;
    else
      taken |= 1u << part.bone;
  }
  rig.bones_found = static_cast<std::size_t>(std::popcount(taken));
  return rig;
}

}  // namespace dance
