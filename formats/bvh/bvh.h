// Bvh: the content of a motion capture file: joints, their channels and every frame's numbers.
// Reads and writes the text; formats/bvh/rig/rig.h maps joints to bones, formats/bvh/retarget.h
// makes a dancer of it.
//
// Units/frames: the file's own units and axes; angles in degrees. R = R_c1 · R_c2 · R_c3 for
//               rotation channels in the order in which the file lists them.
// Ownership:    owns its numbers; read_bvh() keeps no reference to the text.
// Threads:      none inside; plain values.
// Failure:      read_bvh() of a broken file names the line, the word and the cure. Never throws on
//               any text, never recurses, and memory is bounded by BvhLimits.
// Source:       Biovision BVH as described by Lander, Working with Motion Capture File Formats,
//               Game Developer 1998; deviations of real files are tested one by one.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/pose/clip.h"

namespace dance {

enum class BvhChannel : std::uint8_t {
  kXPosition,
  kYPosition,
  kZPosition,
  kXRotation,
  kYRotation,
  kZRotation,
  kScale,  // some tools write it; ignored
};
constexpr bool is_position(BvhChannel c) { return c <= BvhChannel::kZPosition; }
constexpr bool is_rotation(BvhChannel c) {
  return c >= BvhChannel::kXRotation && c <= BvhChannel::kZRotation;
}
// 0, 1, 2 for X, Y, Z.
constexpr int axis_of(BvhChannel c) { return static_cast<int>(c) % 3; }

constexpr std::size_t kMaxBvhChannelsPerJoint = 9;

struct BvhJoint {
  std::string name;
  int parent = -1;  // index, smaller than the joint's own; -1 for the root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> end_site;
  std::array<BvhChannel, kMaxBvhChannelsPerJoint> channels{};
  std::size_t channel_count = 0;
  std::size_t first_channel = 0;  // where the joint's numbers begin in a frame
};

struct Bvh {
  std::vector<BvhJoint> joints;
  std::size_t channel_count = 0;
  double frame_hz = 0.0;
  std::size_t frame_count = 0;
  std::vector<float> values;       // frame after frame
  std::vector<std::string> notes;  // oddities and how they were read
  std::string lost;                // what of the file could not be read; "" if nothing
  // True for glTF, whose translations replace the rest. A BVH does not define which it is.
  bool positions_replace_offsets = false;

  const float* frame(std::size_t index) const { return values.data() + index * channel_count; }
};

struct BvhLimits {
  std::size_t joints = 512;
  std::size_t depth = 128;
  std::size_t frames = 432'000;               // an hour at 120 Hz
  std::size_t values = std::size_t{1} << 26;  // 256 MiB of numbers
};

Result<Bvh> read_bvh(std::string_view text, const BvhLimits& limits = {});

// A clip as BVH text: canonical names, metres, channels Zrotation Xrotation Yrotation, six
// decimals. Fingers are written where the clip has hands, as long as those of an average hand of
// that size.
std::string write_bvh(const MotionClip& clip);

}  // namespace dance
