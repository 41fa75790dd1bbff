// BodySolver: turns the pose network's landmarks of a dancer into a pose on the dancer's own
// skeleton: bones that keep their length, knees and elbows that bend one way, feet that stand on
// the floor of the stage, and a place on it in metres.
//
// Units/frames: W of core/pose/pose.h, floor at y = 0. The dancer's first place is the origin; +z
//               goes from there to the camera, where the audience is.
// Ownership:    keeps the state of one dancer and one camera (about 150 KB); solve() never
//               allocates.
// Threads:      none inside; one owner.
// Failure:      solve() is false where nobody was detected for half a second, too little of a body,
//               or a picture that is not newer than the last; `out` is then not touched. Whatever
//               the landmarks hold, a pose that is handed out is valid.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/depth_hint.h"
#include "producers/camera/pinhole.h"
#include "producers/camera/solver/body_shape.h"
#include "producers/camera/solver/joint/other_view.h"

namespace dance {

struct SolverOptions {
  std::optional<double> height_m;  // of the dancer; none: from the network or the stereo depth
  bool is_mirrored = false;        // as in a mirror: left and right change sides
  double smooth = 1.0;             // 0 hardly smooths, 2 twice as much as tuned
  bool holds_feet = true;          // feet that stand are held in their place
  // What is shown is corrected last. Off to measure what each of them does.
  bool keeps_above_floor = true;  // no sole below the floor
  bool limits_facing = true;      // no flips between front and back, no turn faster than a body's
  bool steadies_hands = true;     // hands that are still do not tremble
};

struct CameraStand {
  double height_m = 0.0;   // over the floor
  double pitch_rad = 0.0;  // positive: it looks down
  bool is_settled = false;
  Eigen::Matrix3d R_WC = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();  // the camera's axes in W
  Eigen::Vector3d p_WC_m = Eigen::Vector3d::Zero();
};

struct SharedPlacement;
std::shared_ptr<SharedPlacement> make_shared_placement();

class BodySolver {
 public:
  // `shared`: of several dancers before one camera.
  BodySolver(const SolverOptions& options, const Pinhole& camera,
             std::shared_ptr<SharedPlacement> shared = nullptr);
  ~BodySolver();
  BodySolver(BodySolver&&) noexcept;
  BodySolver& operator=(BodySolver&&) noexcept;

  // Writes rotations, hips, presence, confidence and capture time of `out`; the rest of it stays.
  // `others`: what other cameras saw of the same dancer, kMostOtherViews at most.
  bool solve(const BodyLandmarks& landmarks, const std::optional<DepthHint>& depth, Pose& out,
             OtherViews others = {});
  // Bones that were measured otherwise, from several cameras; they are held.
  void take_lengths(const BodyLengths& lengths);

  // The dancer's bones as far as they are known. `version` changes with them.
  const Skeleton& skeleton() const;
  // Of this body, as body_shape.h's height_of() has it.
  double height_m() const;
  // True once bones are held and the floor is found.
  bool is_settled() const;
  CameraStand camera_stand() const;

  // Another dancer: bones are estimated again. The camera's placement is kept.
  void reset();

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace dance
