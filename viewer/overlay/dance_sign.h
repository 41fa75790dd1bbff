// Signs above the heads of guests: hands that clap, a heart. Each pops up above the name, rises a
// little and shrinks away within two seconds.
//
// Units/frames: pixels from the top left; `em_px` is the height of a tag's letters.
// Ownership:    draws into the list that it is given.
// Threads:      the drawing thread.
#pragma once

#include <imgui.h>

#include <span>

#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"

namespace dance {

struct SignPicture {
  const SceneState& scene;
  const OrbitCamera& camera;
  // The same as in OverlayChoice.
  std::span<const Eigen::Vector3f> tag_anchors_W_m;
  float width_px = 0.0f;
  float height_px = 0.0f;
  float em_px = 0.0f;
};

void draw_signs(ImDrawList& list, const SignPicture& picture);

}  // namespace dance
