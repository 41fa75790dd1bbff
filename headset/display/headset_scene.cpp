#include "headset/display/headset_scene.h"

#include <algorithm>

namespace dance {
namespace {

// What is found anew changes the height or a mount.
bool is_same(const CalibrationValues& a, const CalibrationValues& b) {
  if (a.state != b.state || a.height_m != b.height_m || a.arm_ratio != b.arm_ratio) return false;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i)
    if (a.mounts[i].is_known != b.mounts[i].is_known || a.mounts[i].p_BT_m != b.mounts[i].p_BT_m)
      return false;
  return true;
}

}  // namespace

HeadsetScene::HeadsetScene(PictureSource& source, const GuestId& own,
                           const TrackerBody::Options& body, AvatarLibraryOptions avatars)
    : source_(source),
      own_(own),
      body_options_(body),
      dancer_(body),
      avatars_(std::move(avatars)),
      roster_(source.board()) {}

void HeadsetScene::set_body(const CalibrationValues& values) {
  if (values.state == CalibrationState::kNeedsTPose || (values_ && is_same(*values_, values)))
    return;
  values_ = values;
  dancer_.body().restore(values);
}

void HeadsetScene::begin_session() {
  dancer_ = XrDancer(body_options_);
  own_motion_.clear();
  if (values_) dancer_.body().restore(*values_);
}

SceneState& HeadsetScene::take(MonoTime now, MonoTime seen_at, const XrSight* sight) {
  scene_.notes.clear();
  roster_.update(now, scene_);
  predictor_.observe(roster_.fresh());
  predictor_.predict(seen_at, scene_);
  if (sight != nullptr)
    put_own(*sight);
  else
    std::erase_if(scene_.guests, [&](const SceneGuest& guest) { return guest.id == own_; });
  avatars_.dress(scene_);
  scene_.notes.clear();  // there is nowhere to read them
  return scene_;
}

void HeadsetScene::put_own(const XrSight& sight) {
  auto own = std::find_if(scene_.guests.begin(), scene_.guests.end(),
                          [&](const SceneGuest& guest) { return guest.id == own_; });
  Pose pose;
  if (!dancer_.solve(sight, pose)) return;
  if (own == scene_.guests.end()) {
    SceneGuest guest;
    guest.id = own_;
    own = scene_.guests.insert(scene_.guests.end(), guest);
  }
  pose.confidence = 1.0f;
  own->skeleton = dancer_.skeleton();
  // What the solver makes of points is of the moment asked for already.
  if (sight.has_figure) {
    own_motion_.observe(pose, pose.capture_time);
    pose = own_motion_.at(sight.points.time, own->skeleton);
  }
  own->pose = pose;
  own->opacity = 1.0f;
  if (sight.hands.presence != 0) own->hands = sight.hands;
}

}  // namespace dance
