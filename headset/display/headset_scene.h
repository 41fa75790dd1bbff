// HeadsetScene: the scene of a headset's picture: the others brought to the moment at which it will
// be seen, and the dancer's own body from the own sensors, for that same moment.
//
// Units/frames: times of this house's clock.
// Ownership:    borrows the source; owns avatars and solver.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none: while the own body is not known, it is not shown.
#pragma once

#include "producers/xr/xr_dancer.h"
#include "viewer/avatar/avatar_library.h"
#include "viewer/feed/photon_predictor.h"
#include "viewer/feed/picture_source.h"

namespace dance {

class HeadsetScene {
 public:
  HeadsetScene(PictureSource& source, const GuestId& own, const TrackerBody::Options& body,
               AvatarLibraryOptions avatars);

  // What the capture found of the body.
  void set_body(const CalibrationValues& values);
  // Another session: nothing is known of how the dancer moved.
  void begin_session();
  // `sight` is of the moment `seen_at`; nullptr: the dancer is not seen.
  SceneState& take(MonoTime now, MonoTime seen_at, const XrSight* sight);
  // After the picture: which poses were new in it, and when they are seen.
  void report(MonoTime seen_at) { source_.report_shown(roster_.fresh(), seen_at); }

 private:
  void put_own(const XrSight& sight);

  PictureSource& source_;
  GuestId own_;
  TrackerBody::Options body_options_;
  std::optional<CalibrationValues> values_;
  XrDancer dancer_;
  ShortExtrapolator own_motion_;  // of a body that the headset sees some moments late
  AvatarLibrary avatars_;
  StageRoster roster_;
  PhotonPredictor predictor_;
  SceneState scene_;
};

}  // namespace dance
