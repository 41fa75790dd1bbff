#include "producers/camera/solver/sight_memory.h"

namespace dance {
namespace {

constexpr double kSeenNow = 0.1;
// A part that was away for less than this is expected well enough.
constexpr double kAway_s = 0.1;
// After so long nothing is known of it.
constexpr double kForgotten_s = 0.5;

}  // namespace

void SightMemory::clear() {
  blend_.clear();
  unseen_s_.fill(0.0);
  is_back_.fill(false);
}

void SightMemory::follow(const PartSight& sight, double seconds) {
  for (std::size_t p = 0; p < kPartCount; ++p) {
    is_back_[p] = sight[p] >= kSeenNow && unseen_s_[p] > kAway_s;
    unseen_s_[p] = sight[p] >= kSeenNow ? 0.0 : unseen_s_[p] + seconds;
  }
}

void SightMemory::blend(MonoTime now, const Pose& carried, Pose& pose) {
  Pose was = pose;
  bool is_any = false;
  for (std::size_t p = 0; p < kPartCount; ++p) {
    if (!is_back_[p]) continue;
    is_any = true;
    const std::uint32_t bones = bones_of(static_cast<Part>(p));
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (bones >> b & 1u) was.R_PB[b] = carried.R_PB[b];
  }
  if (is_any) blend_.add(now, was, pose);
}

std::uint32_t SightMemory::presence() const {
  std::uint32_t presence = kAllBones;
  for (std::size_t p = 0; p < kPartCount; ++p)
    if (unseen_s_[p] > kForgotten_s) presence &= ~bones_of(static_cast<Part>(p));
  return presence;
}

}  // namespace dance
