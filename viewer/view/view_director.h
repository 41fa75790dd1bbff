// ViewDirector: from a scene to what is drawn of it: which cameras, how many stages in one picture,
// and which dancer is meant. Windows and pictures in files use it alike.
//
// Units/frames: pixels; drags are shares of the picture's height.
// Ownership:    owns cameras and what it composes; cells() and comparison() borrow the scene of the
//               last update() or jump().
// Threads:      none inside; the drawing thread owns it.
// Failure:      none: a dancer who is not there is replaced by the first who is; where there is
//               nothing to compare the whole stage is shown, and words() says so.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "viewer/scene/comparison.h"
#include "viewer/scene/stage_picture.h"
#include "viewer/view/camera_rig.h"
#include "viewer/view/eye_camera.h"
#include "viewer/view/follow_camera.h"
#include "viewer/view/grid_view.h"
#include "viewer/view/view_mode.h"
#include "viewer/words/texts.h"

namespace dance {

class ViewDirector {
 public:
  struct Size {
    int width_px;
    int height_px;
    int beats_px;        // under the halves of a comparison
    int covered_px = 0;  // by a panel at the bottom
  };

  explicit ViewDirector(CameraPreset preset, ViewMode mode = ViewMode::kOrbit);

  ViewMode mode() const { return mode_; }
  void show(ViewMode mode);
  void show_next(int step);

  const std::optional<GuestId>& chosen() const { return chosen_; }
  void choose(const GuestId& guest);
  // Round and round, by name.
  void choose_next(const SceneState& scene, int step);

  // Of the view that is shown.
  void drag_orbit(float right, float up);
  void drag_pan(float right, float up);
  void zoom(float notches);
  void start_over();  // everybody in the picture, each camera where it began
  void toggle_turning() { rig_.toggle_turning(); }
  CameraRig& rig() { return rig_; }

  // Moves the cameras on by dt. Leaves raw twins out of the scene unless they are compared, and
  // marks the head that is not to be drawn.
  void update(SceneState& scene, const Size& size, Duration dt);
  // Without a transition, for single pictures.
  void jump(SceneState& scene, const Size& size);

  // What to draw: either two halves from one camera, or, where comparison() is null, cells.
  const Comparison* comparison() const { return is_comparing_ ? &comparison_ : nullptr; }
  std::span<const StageCell> cells() const { return cells_; }
  const OrbitCamera& camera() const { return camera_; }  // of the halves, or of the only cell
  float light_yaw_rad() const { return rig_.stage_yaw_rad(); }
  // "following alice"; empty for the whole stage.
  const std::string& words() const { return words_; }
  void set_language(Language language) { texts_ = Texts(language); }

 private:
  SceneGuest* one_of(SceneState& scene) const;
  void compose(SceneState& scene, const Size& size, Duration dt, bool jumps);
  void compose_one(SceneState& scene, const PixelBox& box, Duration dt);
  void let_through(SceneState& scene, const SceneGuest& shown) const;
  void compose_all(SceneState& scene, float aspect, Duration dt, bool jumps);

  ViewMode mode_;
  std::optional<GuestId> chosen_;
  CameraRig rig_;
  FollowCamera follow_{FollowCamera::Keeps::kSideOfDancer};
  FollowCamera mirror_{FollowCamera::Keeps::kPlaceInRoom};
  EyeCamera eyes_;
  GridView grid_;
  OrbitCamera camera_;
  Comparison comparison_;  // kept from picture to picture
  bool is_comparing_ = false;
  std::span<const StageCell> cells_;
  StageCell only_{};
  std::string words_;
  Texts texts_{Language::kEnglish};
};

}  // namespace dance
