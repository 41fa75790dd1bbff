#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/assert.h"
#include "formats/body/hand_layout.h"
#include "formats/bvh/bvh.h"
#include "formats/bvh/euler_zxy.h"

namespace dance {
namespace {

constexpr int kDecimals = 6;
constexpr int kTimeDecimals = 9;

// std::to_chars, as printf depends on the locale.
void append(std::string& out, double value, int decimals = kDecimals) {
  char buffer[64];
  const auto [end, error] =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  if (error == std::errc()) out.append(buffer, end);
}

void append(std::string& out, const Eigen::Vector3f& v) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) out += ' ';
    append(out, static_cast<double>(v[axis]));
  }
}

void append_zxy(std::string& out, const Eigen::Quaternionf& rotation) {
  for (const double angle_deg : euler_zxy_deg(rotation.cast<double>())) {
    out += ' ';
    append(out, angle_deg);
  }
}

void append_line(std::string& out, std::size_t depth, std::string_view text) {
  out.append(depth, '\t');
  out += text;
  out += '\n';
}

void append_offset(std::string& out, std::size_t depth, const Eigen::Vector3f& offset_m) {
  out.append(depth, '\t');
  out += "OFFSET ";
  append(out, offset_m);
  out += '\n';
}

// A joint of the file. BVH nests, so joints are listed depth first; the order of kBones happens to
// be that order, and a hand's fingers come right after it.
struct Joint {
  std::string_view name;
  std::size_t depth;
  Eigen::Vector3f offset_m;
  std::optional<Eigen::Vector3f> end_m;
  std::size_t bone;  // of the body; of the fingers when is_finger
  bool is_finger;
};

std::size_t depth_of(std::size_t bone) {
  std::size_t depth = 0;
  for (int b = kBones[bone].parent; b >= 0; b = kBones[static_cast<std::size_t>(b)].parent) ++depth;
  return depth;
}

void add_fingers(const HandLayout& layout, Bone hand, std::vector<Joint>& joints) {
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    if (hand_of_finger_bone(f) != hand) continue;
    const std::size_t phalanx = f % kBonesOfAFinger;
    Joint joint{kFingerBones[f].name,
                depth_of(index_of(hand)) + 1 + phalanx,
                layout.offset_m[f],
                std::nullopt,
                f,
                true};
    if (phalanx + 1 == kBonesOfAFinger) joint.end_m = layout.tip_m[f / kBonesOfAFinger];
    joints.push_back(joint);
  }
}

std::vector<Joint> joints_of(const Skeleton& skeleton, bool has_hands) {
  const HandLayout layout = hand_layout(skeleton);
  std::vector<Joint> joints;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Bone bone = static_cast<Bone>(b);
    const bool has_fingers = has_hands && (bone == Bone::kLeftHand || bone == Bone::kRightHand);
    joints.push_back({kBones[b].name, depth_of(b), skeleton.offset_m[b], std::nullopt, b, false});
    for (std::size_t t = 0; t < kTipCount; ++t)
      if (kTipBones[t] == bone && !has_fingers) joints.back().end_m = skeleton.tip_m[t];
    if (has_fingers) add_fingers(layout, bone, joints);
  }
  return joints;
}

void append_hierarchy(std::string& out, const std::vector<Joint>& joints) {
  out += "HIERARCHY\n";
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Joint& joint = joints[j];
    const std::size_t depth = joint.depth;
    append_line(out, depth, (j == 0 ? "ROOT " : "JOINT ") + std::string(joint.name));
    append_line(out, depth, "{");
    append_offset(out, depth + 1, joint.offset_m);
    append_line(out, depth + 1,
                j == 0 ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
                       : "CHANNELS 3 Zrotation Xrotation Yrotation");
    if (joint.end_m) {
      append_line(out, depth + 1, "End Site");
      append_line(out, depth + 1, "{");
      append_offset(out, depth + 2, *joint.end_m);
      append_line(out, depth + 1, "}");
    }
    const std::size_t next_depth = j + 1 < joints.size() ? joints[j + 1].depth : 0;
    for (std::size_t open = depth + 1; open-- > next_depth;) append_line(out, open, "}");
  }
}

}  // namespace

std::string write_bvh(const MotionClip& clip) {
  const bool has_hands = !clip.hands.empty();
  DANCE_ASSERT(!has_hands || clip.hands.size() == clip.frames.size(), clip.hands.size(),
               clip.frames.size());
  const std::vector<Joint> joints = joints_of(clip.skeleton, has_hands);
  std::string out;
  out.reserve(8192 + clip.frames.size() * (joints.size() * 3 + 3) * 11);
  append_hierarchy(out, joints);
  out += "MOTION\nFrames: " + std::to_string(clip.frames.size()) + "\nFrame Time: ";
  append(out, 1.0 / clip.frame_hz, kTimeDecimals);
  out += '\n';
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    append(out, clip.frames[f].p_WH_m);
    for (const Joint& joint : joints)
      append_zxy(
          out, joint.is_finger ? clip.hands[f].R_PB[joint.bone] : clip.frames[f].R_PB[joint.bone]);
    out += '\n';
  }
  return out;
}

}  // namespace dance
