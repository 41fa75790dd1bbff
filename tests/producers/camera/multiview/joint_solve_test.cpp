// One fit to what two cameras saw: depth, hidden limbs, a covered camera.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "tests/allocation_guard.h"
#include "tests/producers/camera/multiview/seen_twice.h"

namespace dance {
namespace {

Eigen::Vector3d joint_C_m(const BodySolver& solver, const Pose& pose, Bone bone) {
  BodyFrames frames;
  forward_kinematics(solver.skeleton(), pose, frames);
  const CameraStand stand = solver.camera_stand();
  return stand.R_WC.transpose() * (frames.position(bone).cast<double>() - stand.p_WC_m);
}

Eigen::Vector3d truth_C_m(const SeenTwice& seen, std::size_t f, Landmark landmark) {
  return seen.first.R_WC.transpose() *
         (seen.first.frames[f].truth_W_m[index_of(landmark)] - seen.first.p_WC_m);
}

void hide_left_arm(BodyLandmarks& body) {
  for (const Landmark l : {Landmark::kLeftElbow, Landmark::kLeftWrist, Landmark::kLeftPinky,
                           Landmark::kLeftIndex, Landmark::kLeftThumb})
    body.visibility[index_of(l)] = 0.1f;
}

struct JointRun {
  double hips_depth_m = 0.0, wrist_m = 0.0;  // mean errors before the first camera
  double most_step_m = 0.0;                  // the hips' own, beyond the true one
  int poses = 0;
};

// The other camera is placed from the first picture on. Judged from the third second on.
template <class Change>
JointRun run(const SeenTwice& seen, bool has_two, Change change) {
  SolverOptions options;
  options.height_m = seen.first.height_m;
  BodySolver solver(options, seen.first.camera.pinhole);
  Pose pose;
  JointRun result;
  std::size_t next = 0;
  int judged = 0;
  std::optional<Eigen::Vector3d> last_off;
  for (std::size_t f = 0; f < seen.first.frames.size(); ++f) {
    BodyLandmarks body = seen.first.frames[f].landmarks;
    const MonoTime now = body.capture_time;
    while (next + 1 < seen.other.moments.size() &&
           seen.other.moments[next + 1].time + Duration::ms(8) <= now)
      ++next;
    change(f, body);
    body.capture_time = now;
    const EyeScene::Moment& moment = seen.other.moments[next];
    const OtherView view = true_view(seen, moment.landmarks, (now - moment.time).as_seconds());
    const bool is_there =
        solver.solve(body, {}, pose, has_two && f > 0 ? OtherViews(&view, 1) : OtherViews());
    result.poses += is_there ? 1 : 0;
    if (!is_there || f < 90) continue;
    const Eigen::Vector3d off =
        joint_C_m(solver, pose, Bone::kLeftUpperLeg) - truth_C_m(seen, f, Landmark::kLeftHip);
    if (last_off) result.most_step_m = std::max(result.most_step_m, (off - *last_off).norm());
    last_off = off;
    result.hips_depth_m += std::abs(off.z());
    result.wrist_m +=
        (joint_C_m(solver, pose, Bone::kLeftHand) - truth_C_m(seen, f, Landmark::kLeftWrist))
            .norm();
    ++judged;
  }
  result.hips_depth_m /= judged;
  result.wrist_m /= judged;
  return result;
}

TEST(JointSolve, TwoCamerasKnowDepthSeveralTimesBetterThanOne) {
  const SeenTwice seen = seen_twice(8.0, SceneErrors());
  const auto nothing = [](std::size_t, BodyLandmarks&) {};
  const JointRun one = run(seen, false, nothing), two = run(seen, true, nothing);
  EXPECT_LT(two.hips_depth_m, 0.5 * one.hips_depth_m);
  EXPECT_LT(two.wrist_m, 0.6 * one.wrist_m);
  EXPECT_EQ(two.poses, 240);
}

TEST(JointSolve, ALimbThatIsHiddenFromTheFirstCameraIsTakenFromTheOther) {
  const SeenTwice seen = seen_twice(8.0, SceneErrors());
  const auto hide = [](std::size_t f, BodyLandmarks& body) {
    if (f > 60) hide_left_arm(body);
  };
  const JointRun one = run(seen, false, hide), two = run(seen, true, hide);
  EXPECT_LT(two.wrist_m, 0.12);
  EXPECT_GT(one.wrist_m, 2.0 * two.wrist_m);
}

TEST(JointSolve, GoesOnWithoutAJumpWhileTheFirstCameraIsCovered) {
  const SeenTwice seen = seen_twice(8.0, SceneErrors());
  const auto cover = [](std::size_t f, BodyLandmarks& body) {
    if (f >= 120 && f < 180) body = BodyLandmarks();
    if (f == 180) body.is_new = true;
  };
  const JointRun one = run(seen, false, cover), two = run(seen, true, cover);
  EXPECT_LT(one.poses, 230);
  EXPECT_EQ(two.poses, 240);
  EXPECT_LT(two.hips_depth_m, 0.06);
  EXPECT_LT(two.most_step_m, 0.08);
}

TEST(JointSolve, AViewOfGarbageIsLeftOut) {
  const SeenTwice seen = seen_twice(4.0, no_errors());
  BodySolver solver({}, seen.first.camera.pinhole), alone({}, seen.first.camera.pinhole);
  Pose pose, pose_alone;
  OtherView view = true_view(seen, seen.other.moments[0].landmarks, 0.0);
  view.older_s = std::numeric_limits<double>::quiet_NaN();
  for (const SceneFrame& frame : seen.first.frames) {
    ASSERT_TRUE(solver.solve(frame.landmarks, {}, pose, OtherViews(&view, 1)));
    ASSERT_TRUE(alone.solve(frame.landmarks, {}, pose_alone));
  }
  EXPECT_EQ((pose.p_WH_m - pose_alone.p_WH_m).norm(), 0.0f);
}

TEST(JointSolve, AllocatesNothing) {
  const SeenTwice seen = seen_twice(3.0, SceneErrors());
  BodySolver solver({}, seen.first.camera.pinhole);
  Pose pose;
  ASSERT_TRUE(solver.solve(seen.first.frames[0].landmarks, {}, pose));
  const AllocationGuard guard;
  for (std::size_t f = 1; f < seen.first.frames.size(); ++f) {
    const EyeScene::Moment& moment = seen.other.moments[f - 1];
    const OtherView view =
        true_view(seen, moment.landmarks,
                  (seen.first.frames[f].landmarks.capture_time - moment.time).as_seconds());
    EXPECT_TRUE(solver.solve(seen.first.frames[f].landmarks, {}, pose, OtherViews(&view, 1)));
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
