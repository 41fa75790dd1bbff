// BodyTracking: the implementation of BodySolver: observe, predict, fit, estimate bones and floor,
// correct the filter, and write the pose.
//
// Units/frames, Ownership: as body_solver.h says.
// Threads:      none inside; one owner.
// Failure:      as body_solver.h says.
#pragma once

#include <memory>
#include <optional>

#include "producers/camera/solver/body_fit.h"
#include "producers/camera/solver/body_solver.h"
#include "producers/camera/solver/camera_placement.h"
#include "producers/camera/solver/motion_filter.h"
#include "producers/camera/solver/proportions.h"
#include "producers/camera/solver/shared_placement.h"
#include "producers/camera/solver/shown/facing.h"
#include "producers/camera/solver/shown/floor_feet.h"
#include "producers/camera/solver/shown/floor_lift.h"
#include "producers/camera/solver/shown/steady_hands.h"
#include "producers/camera/solver/sole_contacts.h"
#include "producers/camera/solver/visibility_tracker.h"

namespace dance {

class BodyTracking {
 public:
  BodyTracking(const SolverOptions& options, const Pinhole& camera,
               std::shared_ptr<SharedPlacement> shared);

  bool solve(const BodyLandmarks& landmarks, const std::optional<DepthHint>& depth, Pose& out,
             OtherViews others);
  void take_lengths(const BodyLengths& lengths);
  const Skeleton& skeleton() const { return shape_.skeleton; }
  double height_m() const { return height_of(lengths_); }
  bool is_settled() const { return proportions_.is_held() && placement_.is_settled(); }
  CameraStand camera_stand() const {
    return {placement_.height_m(), placement_.pitch_rad(), placement_.is_settled(),
            placement_.R_WC(), placement_.to_W(Eigen::Vector3d::Zero())};
  }
  void reset();

 private:
  bool begin(const Observation& seen, MonoTime now);
  void keep_depth(MonoTime now, BodyState& state);
  // False where the picture is refused: no body turns as the network has it.
  bool has_plausible_facing(Observation& seen, MonoTime now, double seconds);
  bool follow(const Observation& seen, MonoTime now, double seconds, bool is_plausible);
  void blend_all(MonoTime now, const BodyState& from, const BodyState& to);
  void carry(double seconds, MonoTime now);
  bool refit(BodyState& state);
  void learn_bones(const Observation& seen, const std::optional<DepthHint>& depth, MonoTime now);
  void learn_camera(const Observation& seen);
  bool sets_scale() const { return !shared_ || shared_->scaled_by == this; }
  // Until then the floor says how tall this dancer is, and must not bend the knees.
  bool is_of_scale() const { return sets_scale() || proportions_.is_held() || options_.height_m; }
  BodyLengths lengths_on_floor() const;
  // What other dancers before this camera have found since; and what this one has.
  void take_shared();
  void tell_shared();
  void claim_scale();
  void release_scale();
  // The state in W as it is since the placement was `was`.
  void rebase(const CameraPlacement& was, BodyState state);
  void grow_to(const BodyLengths& lengths, MonoTime now);
  void set_shape(const BodyLengths& lengths);
  Eigen::Vector3d middle_of_hips_C(const BodyState& state);
  double lowest_sole_m() const;  // of model_
  void forget_shown();
  void look_at_others(OtherViews others, MonoTime now, double seconds);
  bool write(const BodyState& state, MonoTime now, double seconds, Pose& out);

  SolverOptions options_;
  Pinhole camera_;
  BodyShape shape_;
  Proportions proportions_;
  CameraPlacement placement_;
  bool has_placement_ = false;
  std::shared_ptr<SharedPlacement> shared_;  // null: this dancer is alone
  std::uint64_t shared_version_ = 0;
  double scale_ = 1.0;       // of the shared placement, as this dancer has it
  BodyLengths lengths_;      // of the shape
  double growth_sum_ = 0.0;  // of a body that does not set the scale
  int growths_ = 0;
  std::size_t eyes_ = 0;          // cameras that saw the body in the last picture
  bool has_seen_others_ = false;  // depth was measured by several cameras
  BodyModel model_;               // for use outside a fit
  BodyFit fit_;
  FitProblem problem_;
  MotionFilter motion_;
  SoleContacts contacts_;
  VisibilityTracker visibility_;
  FloorFeet feet_;
  FloorLift lift_;
  FlipWatch flips_;
  FacingLimit facing_;
  SteadyHands hands_;
  bool is_tracking_ = false;
  bool is_turned_ = false;  // the body faces elsewhere than the prediction has it
  MonoTime seen_at_, time_;
  double usual_cost_ = 0.0;
  double since_suspect_s_ = 0.0;
};

}  // namespace dance
