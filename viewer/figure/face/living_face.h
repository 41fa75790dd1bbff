// LivingFace: the face of a figure whose dancer's face is not captured: it blinks, looks at the
// partner, smiles while the two dance well together, and moves its mouth with the guest's voice. A
// captured face is shown as it is; without a captured gaze its eyes look at the partner.
//
// Gaze, smile and mouth approach their targets from picture to picture, with time constants that do
// not depend on the frame rate. A single picture shows the targets, with open eyes.
//
// Units/frames: as core/pose/face.h.
#pragma once

#include <span>

#include "core/pose/face.h"
#include "viewer/figure/face/dancer_view.h"
#include "viewer/scene/scene.h"

namespace dance {

// The state of one face, kept from picture to picture.
struct FacePast {
  GuestId partner;  // not set: no partner in view
  Eigen::Vector2f gaze_rad = Eigen::Vector2f::Zero();
  float smile = 0.0f;
  float loudness = 0.0f;
  float passed_s = 0.0f;  // since the last picture
  bool is_known = false;
};

// The face of `guest`, who is views[self]. Its gaze turns eyes with nodes; its weights move morphs.
Face face_of(const SceneGuest& guest, std::span<const DancerView> views, std::size_t self,
             MonoTime time, FacePast& past);

// The weights of ARKit's eyeLook… expressions for a gaze.
void set_look(const Eigen::Vector2f& gaze_rad, Face& face);

}  // namespace dance
