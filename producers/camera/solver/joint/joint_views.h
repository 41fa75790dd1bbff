// JointViews: what other cameras saw, made ready for a fit together with the first camera's
// picture: views whose network took a back for a front are mended or left out, points are moved to
// the first picture's moment by the predicted motion, and a part that is hidden from one camera
// counts as seen where another sees it.
//
// Units/frames: C is the first camera's frame, W the stage; metres, seconds.
// Ownership:    plain functions over values of the caller; nothing allocates.
// Threads:      any; pure.
// Failure:      views that are not usable, are older than kOldestView_s or face elsewhere than the
//               prediction and the first camera have it are left out.
#pragma once

#include "producers/camera/solver/body_fit.h"
#include "producers/camera/solver/motion_filter.h"
#include "producers/camera/solver/shown/steady_hands.h"

namespace dance {

constexpr double kOldestView_s = 0.35;

// The views that a picture may use; sets others and other_count of the problem.
void take_views(OtherViews views, FitProblem& problem);
// With a prediction: mends or drops views by where the body faces, and moves their points to this
// moment. `unseen_s` since the body was seen last. Places `model` at the prediction.
void align_views(const MotionFilter& motion, const Expectation& expected, const BodyShape& shape,
                 double unseen_s, BodyModel& model, FitProblem& problem);
// Directions in C and weights of all cameras together; rays are the first camera's.
Observation merged(const FitProblem& problem);
// As place_on_rays, with the rays of all cameras.
bool place_on_all_rays(const FitProblem& problem,
                       const std::array<Eigen::Vector3d, kLandmarkCount>& relative_C_m,
                       Eigen::Vector3d& place_C_m);
// How well each hand's place along the first camera's view is known at `hips_W_m`; `visibility` by
// all cameras.
SteadyHands::Measurement hand_measurement(const FitProblem& problem,
                                          const PartVisibility& visibility,
                                          const Eigen::Vector3d& hips_W_m);

}  // namespace dance
