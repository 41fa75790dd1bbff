#include "producers/camera/solver/visibility_tracker.h"

namespace dance {
namespace {

constexpr double kSeenNow = 0.1;
// A part hidden for less than this needs no blending.
constexpr double kAway_s = 0.1;
// After so long it is reported as absent.
constexpr double kForgotten_s = 0.5;

}  // namespace

void VisibilityTracker::clear() {
  blend_.clear();
  hidden_s_.fill(0.0);
  reappeared_.fill(false);
}

void VisibilityTracker::follow(const PartVisibility& visibility, double seconds) {
  for (std::size_t p = 0; p < kPartCount; ++p) {
    reappeared_[p] = visibility[p] >= kSeenNow && hidden_s_[p] > kAway_s;
    hidden_s_[p] = visibility[p] >= kSeenNow ? 0.0 : hidden_s_[p] + seconds;
  }
}

void VisibilityTracker::blend(MonoTime now, const Pose& carried, Pose& pose) {
  Pose was = pose;
  bool is_any = false;
  for (std::size_t p = 0; p < kPartCount; ++p) {
    if (!reappeared_[p]) continue;
    is_any = true;
    const std::uint32_t bones = bones_of(static_cast<Part>(p));
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (bones >> b & 1u) was.R_PB[b] = carried.R_PB[b];
  }
  if (is_any) blend_.add(now, was, pose);
}

std::uint32_t VisibilityTracker::presence() const {
  std::uint32_t presence = kAllBones;
  for (std::size_t p = 0; p < kPartCount; ++p)
    if (hidden_s_[p] > kForgotten_s) presence &= ~bones_of(static_cast<Part>(p));
  return presence;
}

}  // namespace dance
