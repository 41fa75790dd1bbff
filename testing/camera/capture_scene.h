// CaptureScene: a recorded dance in front of a simulated camera, and what a pose network would say
// of it: 33 points in pixels and in metres, with errors like those of a real network. For measuring
// the solver only: here the truth is known.
//
// Units/frames: truth in W as the solver has it: floor at y = 0, origin under the dancer's first
//               place, +z towards the camera.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; the same seed gives the same errors.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/pose/kinematics.h"
#include "core/pose/pose.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/pinhole.h"
#include "testing/camera/scene_network.h"

namespace dance {

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
  double height_m = 0.0;                                 // of the dancer
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();    // W's, in the stage of the poses
  Eigen::Vector3d middle_W_m = Eigen::Vector3d::Zero();  // of the dance
  std::vector<SceneFrame> frames;

  Eigen::Vector3d to_W(const Eigen::Vector3d& p_C_m) const { return R_WC * p_C_m + p_WC_m; }
};

// Heels, balls and toes.
double lowest_sole_m(const Skeleton& skeleton, const BodyFrames& frames);

// `poses` are 1/hz apart.
CaptureScene make_scene(const std::string& name, const Skeleton& skeleton,
                        const std::vector<Pose>& poses, double hz, const SceneCamera& camera,
                        const SceneErrors& errors, std::uint64_t seed);

// A second camera before the same dance: not synchronised, its stamps late by something that nobody
// knows, with a network of its own, whose errors are others.
struct SceneEye {
  SceneCamera camera;
  double around_rad = 1.0;  // about the vertical through the middle of the dance; to the right
  double hz = 30.0;
  double phase_s = 0.011;  // of its pictures, after the first camera's
  double later_s = 0.02;   // its stamps of a moment, less the first camera's
  double drift = 0.0;      // of its stamps, seconds a second
};

struct EyeScene {
  struct Moment {
    MonoTime time;            // by the first camera's stamps
    BodyLandmarks landmarks;  // with its own
  };
  SceneEye eye;
  Eigen::Matrix3d R_WC;
  Eigen::Vector3d p_WC_m;
  std::vector<Moment> moments;

  double later_s(double since_start_s) const { return eye.later_s + eye.drift * since_start_s; }
};

// `poses` of the dance of `first`, `poses_hz` a second from the same beginning.
EyeScene make_eye(const CaptureScene& first, const Skeleton& skeleton,
                  const std::vector<Pose>& poses, double poses_hz, const SceneEye& eye,
                  const SceneErrors& errors, std::uint64_t seed);

}  // namespace dance
