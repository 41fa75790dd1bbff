// LobbyDancers: the poses of the lobby's dancers: a salsa couple on the page Dance, and one dancer
// who presents a figure.
//
// Units/frames: W; times since the lobby opened.
// Ownership:    plain values; never allocates after construction but for the scene's guests.
// Threads:      one owner.
#pragma once

#include "core/base/time.h"
#include "producers/salsa/salsa_dancer.h"
#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"

namespace dance {

class LobbyDancers {
 public:
  LobbyDancers();

  const Skeleton& skeleton(SalsaRole role) const { return dancer_of(role).skeleton(); }
  // Writes pose, hands and proportions of that moment to `out`.
  void dance_at(SalsaRole role, Duration since, SceneGuest& out);

 private:
  SalsaDancer& dancer_of(SalsaRole role) { return role == SalsaRole::kLead ? lead_ : follow_; }
  const SalsaDancer& dancer_of(SalsaRole role) const {
    return role == SalsaRole::kLead ? lead_ : follow_;
  }
  SalsaDancer lead_, follow_;
};

// The camera follows the couple and swings slowly from side to side.
OrbitCamera couple_camera(const SceneState& scene, Duration since);
// The whole figure fits into a portrait picture. `turn_rad` is 0 in front of the figure.
OrbitCamera figure_camera(const SceneGuest& guest, float turn_rad);

}  // namespace dance
