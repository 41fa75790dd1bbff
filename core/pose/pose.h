// Pose: one dancer at one moment, on the canonical skeleton; Hands: its fingers. The data that all
// parts exchange.
//
// Units/frames: R_PB is each bone's rotation in its parent (hips: in W), identity in T-pose facing
//               +Z; p_WH_m is the hips in W, metres, +Y up; times are of the clock that clock_id
//               names.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      is_valid() says whether a pose may be used; check it once where bytes come in.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>

#include "core/base/time.h"
#include "core/pose/bone.h"

namespace dance {

// Steps of a pose's journey that leave a stamp; order of hop_time_us in pose_t.
enum class Hop : std::uint8_t {
  kPublished,     // published by the producer
  kLinkSent,      // sent by the sender's link
  kServer,        // received by the server (mapped onto the receiver's clock)
  kLinkReceived,  // received by the receiver's link
  kStageTaken,    // received by the manager
  kStaged,        // published on the stage by the manager
};
constexpr std::size_t kHopCount = 6;

constexpr std::uint32_t kAllBones = (1u << kBoneCount) - 1;
constexpr double kNoMusic = std::numeric_limits<double>::quiet_NaN();

using BoneRotations = std::array<Eigen::Quaternionf, kBoneCount>;

// The rotations of a T-pose: std::array does not do this by itself, as Eigen's quaternions start
// uninitialised.
inline BoneRotations identity_rotations() {
  BoneRotations rotations;
  rotations.fill(Eigen::Quaternionf::Identity());
  return rotations;
}

struct Pose {
  BoneRotations R_PB = identity_rotations();
  Eigen::Vector3f p_WH_m = Eigen::Vector3f(0.0f, 0.95f, 0.0f);
  std::uint32_t presence = kAllBones;
  float confidence = 1.0f;
  std::uint32_t sequence = 0;
  std::uint64_t clock_id = 0;
  MonoTime capture_time;
  double music_beats = kNoMusic;
  std::array<MonoTime, kHopCount> hops{};

  void stamp(Hop hop, MonoTime t) { hops[static_cast<std::size_t>(hop)] = t; }
  MonoTime stamped(Hop hop) const { return hops[static_cast<std::size_t>(hop)]; }
};

struct Hands {
  std::array<Eigen::Quaternionf, kFingerBoneCount> R_PB = [] {
    std::array<Eigen::Quaternionf, kFingerBoneCount> rotations;
    rotations.fill(Eigen::Quaternionf::Identity());
    return rotations;
  }();
  std::uint32_t presence = 0;
  std::uint32_t sequence = 0;
  std::uint64_t clock_id = 0;
  MonoTime capture_time;
};

// Bound of a stage: furthest place of hips from its middle.
constexpr float kMaxStageDistance_m = 1000.0f;

// Finite, unit rotations (within 1 %), hips within the stage, confidence in 0..1, music finite or
// absent.
bool is_valid(const Pose& pose);
bool is_valid(const Hands& hands);

// Normalises rotations. Call after is_valid(), which tolerates 1 %.
void normalize(Pose& pose);
void normalize(Hands& hands);

}  // namespace dance
