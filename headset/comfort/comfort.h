// Comfort in a headset: others who come too near fade away, and the picture is dark for a moment
// where the dancer is put elsewhere.
//
// Units/frames: metres in W; opacities 0 to 1.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <span>

#include "core/base/time.h"
#include "viewer/scene/scene.h"

namespace dance {

struct ComfortSettings {
  float personal_space_m = 0.25f;  // 0: none; couples dance near
  float floor_m = 8.0f;            // where the floor has faded out, from the dancer
};

// From fully there at the edge of the personal space to gone at a third of it.
float opacity_at(float distance_m, float personal_space_m);

// How near the eyes are to a guest: to the axis of the trunk and head.
float distance_to_guest_m(const Eigen::Vector3f& eyes_W_m, const SceneGuest& guest);

// Fades all but the one whose eyes they are.
void keep_personal_space(const ComfortSettings& settings, const Eigen::Vector3f& eyes_W_m,
                         const GuestId& own, std::span<SceneGuest> guests);

// Darkness after a jump: 1 at first, then less.
class JumpFade {
 public:
  void jump(MonoTime now) { jumped_ = now; }
  float darkness(MonoTime now) const;

 private:
  MonoTime jumped_;
};

}  // namespace dance
