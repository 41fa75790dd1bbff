// A dance that two cameras see which nobody placed: made, so that no data is needed.
//
// Units/frames: as testing/camera/capture_scene.h.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include "producers/camera/multiview/multi_view.h"
#include "tests/producers/camera/solver/seen_dance.h"

namespace dance {

struct SeenTwice {
  CaptureScene first;
  EyeScene other;
};

// The dancer goes to and fro meanwhile, as one who is told to move about.
inline SeenTwice seen_twice(double seconds, const SceneErrors& errors, double around_rad = 1.0,
                            double pitch_rad = 0.16) {
  SeenTwice seen;
  std::vector<Pose> poses = salsa_poses(seconds);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const float t_s = static_cast<float>(i) / static_cast<float>(kSeenHz);
    poses[i].p_WH_m.x() += 0.8f * std::sin(0.9f * t_s);
    poses[i].p_WH_m.z() += 0.6f * std::sin(1.3f * t_s);
  }
  SceneCamera camera;
  camera.distance_m = 3.0;
  seen.first = make_scene("salsa", salsa_skeleton(), poses, kSeenHz, camera, errors, 7);
  SceneEye eye;
  eye.camera = camera;
  eye.camera.height_m = 1.5;
  eye.camera.pitch_rad = pitch_rad;
  eye.around_rad = around_rad;
  seen.other = make_eye(seen.first, salsa_skeleton(), poses, kSeenHz, eye, errors, 8);
  return seen;
}

// The second camera's pictures up to this moment, a network's time before it.
inline void see_others(const SeenTwice& seen, MonoTime now, std::size_t& next, MultiView& views) {
  const auto& moments = seen.other.moments;
  for (; next < moments.size() && moments[next].time + Duration::ms(8) <= now; ++next)
    views.see_other(0, moments[next].landmarks);
}

// Where the second camera truly is, for a view that needs no placement.
inline OtherView true_view(const SeenTwice& seen, const BodyLandmarks& body, double older_s) {
  OtherView view;
  view.seen = observe(body, seen.other.eye.camera.pinhole);
  view.R_VC = seen.other.R_WC.transpose() * seen.first.R_WC;
  view.p_VC_m = seen.other.R_WC.transpose() * (seen.first.p_WC_m - seen.other.p_WC_m);
  view.older_s = older_s;
  return view;
}

}  // namespace dance
