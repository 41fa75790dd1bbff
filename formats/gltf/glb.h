// Dances as glTF 2.0 files, which Blender, three.js, Godot, Unity and Unreal open: a skinned figure
// for each dancer, and one animation in which all of them dance.
//
// Units/frames: as glTF has them, which are those of W: metres, right-handed, +Y up, +Z forward.
//               The nodes of a dancer are its bones by their VRM 1.0 names, unrotated in T-pose.
// Ownership:    plain values; nothing refers to the bytes that were read.
// Threads:      none inside.
// Failure:      write_glb() of nothing, or of more than a GLB can hold, says so. read_glb() of
//               damaged or hostile bytes says what is wrong and where; it opens no other file, and
//               size, counts, depth and memory are bounded by GlbLimits.
// Source:       Khronos glTF 2.0 specification; VRM 1.0 and VRMC_vrm_animation 1.0.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pose/clip.h"
#include "formats/bvh/retarget.h"

namespace dance {

struct NamedClip {
  std::string name;  // of the dancer
  MotionClip clip;
  std::vector<std::string> notes;  // of a reader: assumptions and oddities, one line each
  std::string lost = {};           // of a reader: what could not be read; "" if nothing
};

struct GlbOptions {
  bool has_bodies = true;  // else skeletons without a mesh
};

Result<std::vector<std::uint8_t>> write_glb(const std::vector<NamedClip>& clips,
                                            const GlbOptions& options = {});

struct GlbLimits {
  std::size_t file_bytes = std::size_t{1} << 28;
  std::size_t json_bytes = std::size_t{1} << 24;
  std::size_t json_objects = 1u << 16;
  std::size_t json_values = 1u << 20;  // numbers and texts, of which each takes far more memory
  std::size_t json_depth = 64;
  std::size_t nodes = 8192;
  std::size_t joints = 512;  // of one figure
  std::size_t depth = 128;   // of the tree of nodes
  std::size_t clips = 256;
  std::size_t frames = 432'000;               // of one clip: an hour at 120 Hz
  std::size_t values = std::size_t{1} << 26;  // of all clips: 256 MiB of numbers
};

// glTF is in metres with +Y up and has the floor at 0, so nothing is guessed.
inline RetargetOptions gltf_retarget_options() {
  RetargetOptions options;
  options.metres_per_unit = 1.0;
  options.up = UpAxis::kY;
  options.puts_feet_on_floor = false;
  return options;
}

// Every human figure of a .glb, .vrma or .gltf (with its data inside) with every animation that
// moves it, in the order of the file.
Result<std::vector<NamedClip>> read_glb(std::span<const std::uint8_t> bytes,
                                        const GlbLimits& limits = {},
                                        const RetargetOptions& options = gltf_retarget_options());

}  // namespace dance
