#include "viewer/view/view_director.h"

#include <algorithm>
#include <cmath>

#include "viewer/words/shown_name.h"

namespace dance {
namespace {

constexpr float kSeenThrough = 0.2f;  // opacity in front of the dancer in the mirror
constexpr float kNearMirror_m = 0.3f;
constexpr float kBefore_m = 0.25f;  // a guest is in front if nearer than the dancer by this
constexpr float kAside_m = 1.0f, kFades_m = 0.45f;

}  // namespace

ViewDirector::ViewDirector(CameraPreset preset, ViewMode mode) : mode_(mode), rig_(preset) {}

void ViewDirector::show(ViewMode mode) {
  if (mode == mode_) return;
  mode_ = mode;
  // A mirror hangs where the dancer faces when it is asked for.
  if (mode == ViewMode::kMirror) mirror_.reset();
  if (mode == ViewMode::kFirstPerson) eyes_.reset();
}

void ViewDirector::show_next(int step) {
  const auto count = static_cast<int>(kViewNames.size());
  const int next = (static_cast<int>(mode_) + step % count + count) % count;
  show(kViewNames[static_cast<std::size_t>(next)].mode);
}

void ViewDirector::choose(const GuestId& guest) {
  chosen_ = guest;
  rig_.focus(guest);
}

void ViewDirector::choose_next(const SceneState& scene, int step) {
  const auto count = static_cast<int>(scene.guests.size());
  if (count == 0) return;
  const auto at = std::find_if(scene.guests.begin(), scene.guests.end(),
                               [&](const SceneGuest& guest) { return guest.id == chosen_; });
  int next = step > 0 ? 0 : count - 1;
  if (at != scene.guests.end())
    next = (static_cast<int>(at - scene.guests.begin()) + step % count + count) % count;
  else if (is_of_one(mode_))  // the first is shown already
    next = (step % count + count) % count;
  choose(scene.guests[static_cast<std::size_t>(next)].id);
}

void ViewDirector::drag_orbit(float right, float up) {
  switch (mode_) {
    case ViewMode::kFollow:
      return follow_.drag_orbit(right, up);
    case ViewMode::kMirror:
      return mirror_.drag_orbit(right, up);
    case ViewMode::kFirstPerson:
      return eyes_.drag_orbit(right, up);
    case ViewMode::kGrid:
      return grid_.drag_orbit(right, up);
    case ViewMode::kOrbit:
    case ViewMode::kCompare:
      return rig_.drag_orbit(right, up);
  }
}

void ViewDirector::drag_pan(float right, float up) {
  // The others keep their dancers in the middle.
  if (mode_ == ViewMode::kOrbit || mode_ == ViewMode::kCompare) return rig_.drag_pan(right, up);
  drag_orbit(right, up);
}

void ViewDirector::zoom(float notches) {
  switch (mode_) {
    case ViewMode::kFollow:
      return follow_.zoom(notches);
    case ViewMode::kMirror:
      return mirror_.zoom(notches);
    case ViewMode::kFirstPerson:
      return eyes_.zoom(notches);
    case ViewMode::kGrid:
      return grid_.zoom(notches);
    case ViewMode::kOrbit:
    case ViewMode::kCompare:
      return rig_.zoom(notches);
  }
}

void ViewDirector::start_over() {
  if (!is_of_one(mode_)) chosen_.reset();
  rig_.frame_all();
  follow_.reset();
  mirror_.reset();
  eyes_.reset();
  grid_.reset();
}

SceneGuest* ViewDirector::one_of(SceneState& scene) const {
  if (scene.guests.empty()) return nullptr;
  const auto at = std::find_if(scene.guests.begin(), scene.guests.end(),
                               [&](const SceneGuest& guest) { return guest.id == chosen_; });
  return at != scene.guests.end() ? &*at : &scene.guests.front();
}

void ViewDirector::update(SceneState& scene, const Size& size, Duration dt) {
  compose(scene, size, dt, false);
}

void ViewDirector::jump(SceneState& scene, const Size& size) {
  follow_.reset();
  mirror_.reset();
  eyes_.reset();
  grid_.reset();
  compose(scene, size, Duration(), true);
}

void ViewDirector::compose(SceneState& scene, const Size& size, Duration dt, bool jumps) {
  const bool compares = mode_ == ViewMode::kCompare && can_compare(scene);
  if (!compares) leave_out_twins(scene);
  is_comparing_ = compares;
  words_.clear();
  const PixelBox all{0, 0, size.width_px, size.height_px};
  const float covered =
      static_cast<float>(size.covered_px) / static_cast<float>(std::max(1, size.height_px));
  rig_.set_covered_below(covered);
  follow_.set_covered_below(covered);
  mirror_.set_covered_below(covered);
  only_ = {&scene, camera_, all};
  if (compares) {
    const PixelBox half{0, 0, std::max(1, size.width_px / 2),
                        std::max(1, size.height_px - size.beats_px)};
    compose_all(scene, half.aspect(), dt, jumps);
    compare(scene, comparison_);
  } else if (mode_ == ViewMode::kGrid && !scene.guests.empty()) {
    grid_.update(scene, chosen_, size.width_px, size.height_px, dt);
    cells_ = grid_.cells();
    return;
  } else if (is_of_one(mode_) && !scene.guests.empty()) {
    compose_one(scene, all, dt);
  } else {
    if (mode_ == ViewMode::kCompare) words_ = texts_[Text::kViewCompare];
    compose_all(scene, all.aspect(), dt, jumps);
  }
  only_.camera = camera_;
  only_.light_yaw_rad = rig_.stage_yaw_rad();
  cells_ = {&only_, 1};
}

void ViewDirector::compose_all(SceneState& scene, float aspect, Duration dt, bool jumps) {
  if (jumps)
    rig_.jump({&scene}, aspect);
  else
    rig_.update(scene, aspect, dt);
  camera_ = rig_.camera();
}

void ViewDirector::compose_one(SceneState& scene, const PixelBox& box, Duration dt) {
  rig_.update(scene, box.aspect(), dt);  // the light goes by it
  SceneGuest& guest = *one_of(scene);
  const Text words = mode_ == ViewMode::kFollow   ? Text::kViewFollow
                     : mode_ == ViewMode::kMirror ? Text::kViewMirror
                                                  : Text::kViewEyes;
  words_ = texts_.say(words, {shown_name(scene.names, guest.id, texts_)});
  if (mode_ == ViewMode::kFirstPerson) {
    eyes_.update(guest, dt);
    guest.hides_head = true;
    camera_ = eyes_.camera();
    return;
  }
  FollowCamera& camera = mode_ == ViewMode::kFollow ? follow_ : mirror_;
  camera.update(guest, box.aspect(), dt);
  camera_ = camera.camera();
  if (mode_ == ViewMode::kMirror) let_through(scene, guest);
}

// Draws dancers between the mirror and the shown dancer transparently.
void ViewDirector::let_through(SceneState& scene, const SceneGuest& shown) const {
  const Eigen::Vector3f eye = camera_.eye_W_m();
  const auto on_floor = [](const Eigen::Vector3f& p) { return Eigen::Vector2f(p.x(), p.z()); };
  const Eigen::Vector2f to_shown = on_floor(shown.pose.p_WH_m - eye);
  const float far_m = to_shown.norm();
  if (far_m < kNearMirror_m) return;
  const Eigen::Vector2f along = to_shown / far_m;
  for (SceneGuest& guest : scene.guests) {
    if (guest.id == shown.id) continue;
    const Eigen::Vector2f to_guest = on_floor(guest.pose.p_WH_m - eye);
    const float ahead_m = to_guest.dot(along);
    const float aside_m = std::abs(to_guest.x() * along.y() - to_guest.y() * along.x());
    const float before = std::clamp((far_m - ahead_m) / kBefore_m, 0.0f, 1.0f);
    const float between = std::clamp((kAside_m - aside_m) / kFades_m, 0.0f, 1.0f);
    guest.opacity *= 1.0f - (1.0f - kSeenThrough) * before * between;
  }
}

}  // namespace dance
