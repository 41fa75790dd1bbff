// MotionChannels: what of a pose tells where in its step a dance is: each zone's places against the
// next zone inwards, as seen from the dancer's own heading, and how fast the feet go. Zones count
// alike, however far they reach.
//
// Units/frames: metres, and for the tilt of the pelvis and the feet's speed what comes out alike in
//               size; the dancer's frame is x to the left, y up, z where the hips face.
// Ownership:    plain values; never allocates.
// Threads:      none inside; one owner.
// Failure:      bones that are not present stay where they were seen last.
#pragma once

#include <array>

#include "core/pose/kinematics.h"
#include "transformers/style/body_zones.h"

namespace dance {

constexpr std::size_t kMotionChannels = 40;
constexpr std::size_t kMotionGroups = kBodyZones + 1;  // the zones, and the feet's speed
// Channels of group g are kMotionGroupBegin[g] .. kMotionGroupBegin[g + 1].
constexpr std::array<std::size_t, kMotionGroups + 1> kMotionGroupBegin{0,  5,  8,  14, 20,
                                                                       26, 35, 38, 40};
// The feet's speed, of both together: up in each step, whatever the figure.
constexpr std::size_t kStepChannel = 38;

struct MotionFrame {
  MonoTime time;
  double music_beats = kNoMusic;
  std::array<float, kMotionChannels> channel{};
  // For motion beats: the feet in W, and the hips to the left of the feet's middle.
  std::array<Eigen::Vector3f, 2> p_WFoot_m;
  float sway_m = 0.0f;
};

class MotionChannels {
 public:
  MotionChannels();
  void set_body(const Skeleton& skeleton) { skeleton_ = skeleton; }
  void forget() { has_last_ = false; }
  // Poses in the order of their capture.
  const MotionFrame& take(const Pose& pose);

 private:
  Skeleton skeleton_;
  Pose seen_;
  BodyFrames frames_;
  MotionFrame frame_;
  bool has_last_ = false;
};

}  // namespace dance
