// BodyFit: the posture that fits the landmarks, the prediction, a body's priors and the floor best:
// damped Gauss-Newton over the 44 degrees of freedom, with bones whose lengths cannot change.
//
// Units/frames: rays in C, body in W; the floor is y = 0.
// Ownership:    keeps its numbers (about 80 KB); never allocates.
// Threads:      none inside; one owner.
// Failure:      solve() is false when numbers are not finite, or when most of the seen points would
//               be behind the camera; the state is then as it was.
// Source:       Nocedal and Wright, Numerical Optimization, 2006, chapter 10. Each term of the sum
//               is a squared difference over its variance: rays of landmarks (with Cauchy's weight,
//               against outliers), directions of body vectors from the network, the expectation, a
//               rest posture, soles on the floor, the depth from a stereo camera.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "producers/camera/depth_hint.h"
#include "producers/camera/solver/body_model.h"
#include "producers/camera/solver/camera_placement.h"
#include "producers/camera/solver/joint/other_view.h"
#include "producers/camera/solver/observation.h"

namespace dance {

// What is known of a sole.
struct SoleTouch {
  bool stands = false;
  double stands_for_s = 0.0;
  Eigen::Vector3d held_W_m = Eigen::Vector3d::Zero();
};

struct Expectation {
  BodyState state;
  DofVector precision = DofVector::Zero();  // 1/variance; 0: no prediction
  DofVector ease = DofVector::Zero();       // 1/variance about the rest posture
};

// Another camera's picture, as the fit needs it.
struct FitView {
  OtherView view;
  // How far each point moved in W since that picture, by the prediction.
  std::array<Eigen::Vector3d, kLandmarkCount> moved_W_m;
};

struct FitProblem {
  const Observation* seen = nullptr;
  const CameraPlacement* camera = nullptr;
  const BodyShape* shape = nullptr;
  Expectation expected;
  std::array<SoleTouch, kSoleCount> soles;
  bool has_floor = false;
  std::optional<DepthHint> depth;
  std::array<FitView, kMostOtherViews> others;
  std::size_t other_count = 0;
};

// The rest posture: arms hang, knees a little bent. Place and heading are not part of it.
BodyState state_at_ease();

class BodyFit {
 public:
  // Improves `state`. Outliers are down-weighted in all but the first `trusting` iterations.
  bool solve(const FitProblem& problem, int rounds, int trusting, BodyState& state);
  // Half the sum of squares at the end of the last solve().
  double cost() const { return cost_; }
  // The share of it that comes from the picture.
  double picture_cost() const { return picture_cost_; }
  const BodyModel& model() const { return model_; }

 private:
  using Normal = Eigen::Matrix<double, dof::kCount, dof::kCount>;

  void build(const FitProblem& problem, bool trusting, const BodyState& state);
  // A camera of the frame V; C is the first one's.
  struct Eye {
    const Observation* seen;
    Eigen::Matrix3d R_VW;
    Eigen::Vector3d p_WV_m;
    double variance;  // of a ray's coordinate
    double trust;
    const std::array<Eigen::Vector3d, kLandmarkCount>* moved_W_m;  // null: of this moment
  };
  void add_eyes(const FitProblem& problem, bool trusting);
  void add_rays(const Eye& eye, bool trusting);
  void add_vectors(const Eye& eye);
  void add_expectation(const FitProblem& problem, const BodyState& state);
  void add_soles(const FitProblem& problem);
  void add_depth(const FitProblem& problem);
  // One row of the Jacobian, of which only the columns in `moved` are not 0.
  void add_row(const Eigen::Matrix<double, 1, dof::kCount>& row, std::uint64_t moved,
               double residual, double weight);
  void hold_ends(const BodyState& state);

  BodyModel model_;
  Normal normal_;
  DofVector gradient_;
  double cost_ = 0.0;
  double picture_cost_ = 0.0;
  // Weights of seen points in front of their cameras, and of all seen points.
  double weight_in_front_ = 0.0, weight_seen_ = 0.0;
};

}  // namespace dance
