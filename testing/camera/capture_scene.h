// CaptureScene: a recorded dance in front of a simulated camera, and what a pose network would say
// of it: 33 points in pixels and in metres, with errors like those of a real network. For measuring
// the solver only: here the truth is known.
//
// Units/frames: truth in W as the solver has it: floor at y = 0, origin under the dancer's first
//               place, +z towards the camera.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; the same seed gives the same errors.
// Source:       sizes of the errors: measured of BlazePose full against its reference and against
//               motion capture (docs/capture-solver.md).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/pose/kinematics.h"
#include "core/pose/pose.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/pinhole.h"

namespace dance {

struct SceneErrors {
  double image_sd = 0.003;      // of a point's coordinate, as a share of the region's side
  double image_memory_s = 0.1;  // how long an error lasts
  double length_sd = 0.06;      // of a bone's length in the network's metres
  double depth_sd = 0.15;       // of a bone's direction along the view, as a share of its length
  double aside_sd = 0.05;       // across the view
  double world_memory_s = 0.3;
  double place_sd_m = 0.006;     // where the network has a joint on this body, for good
  double scale = 0.97;           // of the network's metres, for good
  double hidden_per_s = 0.12;    // how often an arm or a leg goes out of sight
  double hidden_for_s = 0.4;     // for how long, in the mean
  double hidden_image_sd = 8.0;  // errors are so much larger then
  // A back that the network takes for a front, while it is turned to the camera: how often, for how
  // long in the mean, and at most. Left and right change sides, and in every second burst depth is
  // reversed too: a body that is seen from behind, 25 degrees aside, turns by 130 degrees so.
  double flips_per_s = 0.0;
  double flip_for_s = 0.1;
  double flip_most_s = 0.25;
  bool hides_outside = false;  // points outside the picture are guessed, as hidden ones are
};
constexpr SceneErrors no_errors() {
  return {0.0, 0.1, 0.0, 0.0, 0.0, 0.3, 0.0, 1.0, 0.0, 0.4, 1.0};
}

struct SceneCamera {
  Pinhole pinhole = assumed_pinhole(1280, 720);
  double height_m = 1.2;
  double pitch_rad = 0.09;  // looks down
  double roll_rad = 0.015;
  double distance_m = 3.6;  // from the middle of the dance
};

struct SceneFrame {
  BodyLandmarks landmarks;
  std::array<Eigen::Vector3d, kLandmarkCount> truth_W_m;  // of the landmarks
  std::array<Eigen::Vector3d, 2> ball_W_m;                // the toes' joints
  double lowest_sole_m = 0.0;                             // heels, balls and toes of both feet
  bool is_flipped = false;                                // the network took a back for a front
};

struct CaptureScene {
  std::string name;
  double hz = 30.0;
  SceneCamera camera;
  Eigen::Matrix3d R_WC;
  Eigen::Vector3d p_WC_m;
  double height_m = 0.0;  // of the dancer
  std::vector<SceneFrame> frames;

  Eigen::Vector3d to_W(const Eigen::Vector3d& p_C_m) const { return R_WC * p_C_m + p_WC_m; }
};

// Heels, balls and toes.
double lowest_sole_m(const Skeleton& skeleton, const BodyFrames& frames);

// `poses` are 1/hz apart.
CaptureScene make_scene(const std::string& name, const Skeleton& skeleton,
                        const std::vector<Pose>& poses, double hz, const SceneCamera& camera,
                        const SceneErrors& errors, std::uint64_t seed);

}  // namespace dance
