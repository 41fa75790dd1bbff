// StageCell: one stage in its place in a picture that shows several.
//
// Units/frames: pixels from the top left of the picture.
// Ownership:    borrows the scene.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"

namespace dance {

struct PixelBox {
  int left_px = 0;
  int top_px = 0;
  int width_px = 0;
  int height_px = 0;

  float aspect() const { return static_cast<float>(width_px) / static_cast<float>(height_px); }
  bool operator==(const PixelBox&) const = default;
};

struct StageCell {
  const SceneState* scene;
  OrbitCamera camera;
  PixelBox box;
  float light_yaw_rad = 0.0f;  // the view that the light is placed by
  bool is_chosen = false;      // has a frame round it
};

}  // namespace dance
