// A pose as floats, as a system without a codec sends it.
//
// Units/frames: as core/pose/pose.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      read_float_pose() is false for another length, or what is no pose.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "core/pose/pose.h"

namespace dance {

struct FloatPose {
  std::uint32_t sender = 0;
  std::uint32_t sequence = 0;
  std::array<float, 4 * kBoneCount + 3> floats{};
};

inline FloatPose float_pose(std::size_t sender, const Pose& pose) {
  FloatPose raw;
  raw.sender = static_cast<std::uint32_t>(sender);
  raw.sequence = pose.sequence;
  float* at = raw.floats.data();
  for (const auto& q : pose.R_PB) at = std::copy_n(q.coeffs().data(), 4, at);
  std::copy_n(pose.p_WH_m.data(), 3, at);
  return raw;
}

inline bool read_float_pose(std::span<const std::uint8_t> bytes, FloatPose& raw, Pose& pose) {
  if (bytes.size() != sizeof raw) return false;
  std::memcpy(&raw, bytes.data(), sizeof raw);
  const float* at = raw.floats.data();
  for (auto& q : pose.R_PB) {
    std::copy_n(at, 4, q.coeffs().data());
    at += 4;
  }
  std::copy_n(at, 3, pose.p_WH_m.data());
  pose.sequence = raw.sequence;
  return is_valid(pose);
}

}  // namespace dance
