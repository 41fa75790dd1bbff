// The zones of a body in which a dance is spoken of: which bones turn in which zone, and what the
// zones are called.
//
// Units/frames: none.
// Threads:      constants only.
// Failure:      none.
#pragma once

#include <array>
#include <string_view>

#include "core/pose/bone.h"
#include "core/signal/style.h"

namespace dance {

constexpr std::array<std::string_view, kBodyZones> kZoneNames{"hips",  "torso", "shoulders", "arms",
                                                              "hands", "legs",  "head"};

// By the joint that a bone turns in: the upper arm turns in the shoulder, but it is the arm that
// one sees swing.
constexpr std::array<BodyZone, kBoneCount> kZoneOfBone = [] {
  using Z = BodyZone;
  return std::array<Z, kBoneCount>{
      Z::kHips, Z::kTorso, Z::kTorso,     Z::kTorso, Z::kHead, Z::kHead,  Z::kShoulders, Z::kArms,
      Z::kArms, Z::kHands, Z::kShoulders, Z::kArms,  Z::kArms, Z::kHands, Z::kLegs,      Z::kLegs,
      Z::kLegs, Z::kLegs,  Z::kLegs,      Z::kLegs,  Z::kLegs, Z::kLegs};
}();

constexpr std::size_t index_of(BodyZone zone) { return static_cast<std::size_t>(zone); }

}  // namespace dance
