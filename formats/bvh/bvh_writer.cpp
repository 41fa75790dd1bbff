#include <charconv>

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

void append_end_site(std::string& out, std::size_t depth, const Eigen::Vector3f& tip_m) {
  append_line(out, depth, "End Site");
  append_line(out, depth, "{");
  out.append(depth + 1, '\t');
  out += "OFFSET ";
  append(out, tip_m);
  out += '\n';
  append_line(out, depth, "}");
}

std::size_t depth_of(std::size_t bone) {
  std::size_t depth = 0;
  for (int b = kBones[bone].parent; b >= 0; b = kBones[static_cast<std::size_t>(b)].parent) ++depth;
  return depth;
}

// Parents come before children in kBones, but a child need not follow its parent at once: BVH
// nests, so bones are written depth first. The order of kBones happens to be that order.
void append_hierarchy(std::string& out, const Skeleton& skeleton) {
  out += "HIERARCHY\n";
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const std::size_t depth = depth_of(b);
    append_line(out, depth, (b == 0 ? "ROOT " : "JOINT ") + std::string(kBones[b].name));
    append_line(out, depth, "{");
    out.append(depth + 1, '\t');
    out += "OFFSET ";
    append(out, skeleton.offset_m[b]);
    out += '\n';
    append_line(out, depth + 1,
                b == 0 ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
                       : "CHANNELS 3 Zrotation Xrotation Yrotation");
    for (std::size_t t = 0; t < kTipCount; ++t)
      if (index_of(kTipBones[t]) == b) append_end_site(out, depth + 1, skeleton.tip_m[t]);
    const std::size_t next_depth = b + 1 < kBoneCount ? depth_of(b + 1) : 0;
    for (std::size_t open = depth + 1; open-- > next_depth;) append_line(out, open, "}");
  }
}

}  // namespace

std::string write_bvh(const MotionClip& clip) {
  std::string out;
  out.reserve(4096 + clip.frames.size() * (kBoneCount * 3 + 3) * 11);
  append_hierarchy(out, clip.skeleton);
  out += "MOTION\nFrames: " + std::to_string(clip.frames.size()) + "\nFrame Time: ";
  append(out, 1.0 / clip.frame_hz, kTimeDecimals);
  out += '\n';
  for (const Pose& pose : clip.frames) {
    append(out, pose.p_WH_m);
    for (const auto& R_PB : pose.R_PB) append_zxy(out, R_PB);
    out += '\n';
  }
  return out;
}

}  // namespace dance
