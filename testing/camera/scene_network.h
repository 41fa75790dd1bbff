// SceneNetwork: what a pose network would say of a body whose points are known, with errors like
// those of a real one: points that are off as much as they usually are, limbs that go out of sight,
// backs that are taken for fronts.
//
// Units/frames: pixels, and metres in the camera's frame (producers/camera/pinhole.h).
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; the same seed gives the same errors.
// Source:       sizes of the errors: measured of BlazePose full against its reference and against
//               motion capture (docs/capture-solver.md).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "core/base/random.h"
#include "core/pose/kinematics.h"
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

// An error that lasts: x(t+dt) = k x(t) + √(1−k²) n, standard deviation 1.
struct LastingError {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  void start(Random& random) { value = {random.normal(), random.normal(), random.normal()}; }
  void go_on(Random& random, double keep) {
    const double fresh = std::sqrt(1.0 - keep * keep);
    value =
        keep * value + fresh * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  }
};

class SceneNetwork {
 public:
  SceneNetwork(const SceneErrors& errors, double hz, std::uint64_t seed)
      : errors_(errors), hz_(hz), random_(seed) {
    for (LastingError& l : image_) l.start(random_);
    for (LastingError& l : world_) l.start(random_);
    for (LastingError& l : length_) l.start(random_);
    for (Eigen::Vector3d& p : place_m_)
      p = errors.place_sd_m * Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
  }
  const Eigen::Vector3d& place_m(std::size_t i) const { return place_m_[i]; }
  bool is_flipped() const { return flipped_s_ > 0.0; }

  BodyLandmarks see(const std::array<Eigen::Vector3d, kLandmarkCount>& p_C_m, const Pinhole& camera,
                    MonoTime t);

 private:
  void hide();
  void draw_flip(const std::array<Eigen::Vector3d, kLandmarkCount>& p_C_m);
  void flip(BodyLandmarks& out) const;
  void write_world(const std::array<Eigen::Vector3d, kLandmarkCount>& p_C_m,
                   BodyLandmarks& out) const;

  SceneErrors errors_;
  double hz_;
  Random random_;
  std::array<Eigen::Vector3d, kLandmarkCount> place_m_;
  std::array<LastingError, kLandmarkCount> image_, world_, length_;
  std::array<double, 4> hidden_s_{};
  std::array<bool, kLandmarkCount> is_hidden_{};
  double flipped_s_ = 0.0;
  bool is_depth_reversed_ = false;
  bool began_ = false;
};

// Where a network has its points on a body of this height.
std::array<Eigen::Vector3d, kLandmarkCount> points_of(const BodyFrames& frames, double height_m,
                                                      const SceneNetwork& network);

}  // namespace dance
