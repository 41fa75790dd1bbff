// Reads an avatar: a human figure in a .glb, a .vrm (0.x and 1.0) or a .gltf that holds its data
// itself. The file is a stranger's: every index, count and number is checked here, once.
//
// Units/frames: bytes as they are in the file; the figure comes out facing +Z with +Y up, whatever
//               way the file has it; its pose at rest (T or A) stays as it is.
// Ownership:    plain values; nothing refers to the bytes.
// Threads:      none inside; takes some tens of milliseconds, so that a display reads beside its
//               drawing.
// Failure:      says what is wrong, printable, with the cure; no other file is opened, nothing is
//               thrown on any bytes, time and memory are bounded by AvatarLimits. A picture that
//               cannot be decoded costs the picture, not the avatar, and a note. Reading that is
//               told to stop fails soon after.
// Source:       Khronos glTF 2.0 with KHR_mesh_quantization, KHR_texture_transform,
//               KHR_materials_unlit, KHR_materials_emissive_strength, EXT_texture_webp; VRM 1.0
//               (VRMC_vrm, VRMC_springBone, VRMC_materials_mtoon); VRM 0.x.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "formats/avatar/avatar_model.h"

namespace dance {

struct AvatarLimits {
  std::size_t file_bytes = std::size_t{1} << 26;
  std::size_t json_objects = 1u << 17;
  std::size_t nodes = 4096;
  std::size_t joints = 1024;
  std::size_t vertices = 300'000;
  std::size_t triangles = 600'000;
  std::size_t parts = 512;
  std::size_t materials = 256;
  std::size_t pictures = 64;
  int picture_side_px = 4096;
  int reduced_side_px = 1024;  // larger pictures are made smaller
  // Of all pictures together, while they are decoded: what costs time.
  std::size_t decoded_bytes = std::size_t{1} << 29;
  std::size_t morphs = 2048;
  std::size_t morph_moves = std::size_t{1} << 21;  // vertices that move, of all morphs together
  std::size_t expressions = 256;
  std::size_t springs = 512;
  std::size_t spring_joints = 4096;
  std::size_t colliders = 512;
  std::size_t numbers = std::size_t{1} << 26;  // read from accessors, over all: what costs time
  // Looked at: primitives, once for each node that has their mesh, with their attributes and morph
  // targets, and joints of skins. Of the file's own size, but for meshes that many nodes share.
  std::size_t looks = std::size_t{1} << 20;
  std::size_t bytes = std::size_t{1} << 27;  // of vertices, morphs and pictures in the result
};

// Asked often while an avatar is read; true when nobody wants it any more. May be empty.
using AvatarStop = std::function<bool()>;

struct ReadAvatar {
  AvatarModel model;
  std::vector<std::string> notes;  // what was left out and why, one printable line each
};

// `name` is what the file is called, for a model that tells no name of its own.
Result<ReadAvatar> read_avatar(std::span<const std::uint8_t> bytes, const AvatarLimits& limits = {},
                               std::string_view name = {}, const AvatarStop& stop = {});

}  // namespace dance
