// Bodies that the headset sees or infers, by each of the extensions.
#include "producers/xr/xr_body.h"

#include <gtest/gtest.h>

#include "core/pose/heading.h"
#include "producers/xr/xr_dancer.h"
#include "tests/producers/xr/xr_world.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr const char* kFull = "body on\nwithout XR_BD_body_tracking\n";
constexpr const char* kUpper =
    "body on\nwithout XR_BD_body_tracking\nwithout XR_META_body_tracking_full_body\n";
constexpr const char* kSmall = "body on\nwithout XR_FB_body_tracking\n";

bool is_of_arms_end(std::size_t bone) {
  return bone == index_of(Bone::kLeftHand) || bone == index_of(Bone::kRightHand);
}

class XrBodies : public XrWorld {
 protected:
  // Everybody is turned to the front: the placement of a dancer who stands at the origin.
  void open_body(const std::string& script) {
    open_focused(script);
    sensors_ = std::make_unique<XrSensors>(*session_, *input_);
    ASSERT_EQ(sensors_->note(), "");
    ASSERT_TRUE(sensors_->sees_body());
    ASSERT_TRUE(pump_until([&] { return look(); }));
  }
  bool look() {
    const MonoTime now = mono_now();
    const XrTime time = runtime_->xr_of(now);
    const auto head = input_->head(time);
    if (!head) return false;
    sensors_->look(time, now, placement_of(*head, {0.0f, 0.0f, heading_rad_}, 0.0f), sight_);
    return true;
  }
  void TearDown() override {
    sensors_.reset();
    XrWorld::TearDown();
  }

  std::unique_ptr<XrSensors> sensors_;
  XrSight sight_;
  float heading_rad_ = 0.0f;
};

TEST_F(XrBodies, AWholeBodyThatStandsUprightIsNotTurned) {
  for (const char* script : {kFull, kSmall}) {
    sensors_.reset();
    open_body(script);
    ASSERT_TRUE(sight_.has_figure) << script;
    EXPECT_EQ(sight_.figure.presence, kAllBones) << script;
    for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
      // The palms of this runtime hang, and SMPL's wrists have the axes of the room.
      if (script == kSmall && is_of_arms_end(bone)) continue;
      EXPECT_LT(sight_.figure.R_WB[bone].angularDistance(Quaternionf::Identity()), 2e-3f)
          << script << kBones[bone].name;
    }
    const auto at = [&](Bone bone) { return sight_.figure.p_WB_m[index_of(bone)]; };
    EXPECT_NEAR(at(Bone::kHead).y(), 1.65f, 1e-3f);
    EXPECT_NEAR(at(Bone::kHips).y(), 0.95f, 1e-3f);
    EXPECT_NEAR(at(Bone::kLeftUpperLeg).x(), 0.1f, 1e-3f) << "left is at +X of who faces +Z";
    EXPECT_NEAR(at(Bone::kRightLowerArm).x(), -0.22f, 1e-3f);
    EXPECT_LT(at(Bone::kLeftToes).y(), 0.1f);
    EXPECT_GT(at(Bone::kLeftToes).z(), at(Bone::kLeftFoot).z() + 0.05f) << "toes are in front";
  }
}

TEST_F(XrBodies, AWholeBodyTurnsWithItsDancerWhereverTheHouseHasHim) {
  for (const char* script : {kFull, kSmall})
    for (const float heading : {1.2f, -2.8f}) {
      sensors_.reset();
      heading_rad_ = heading;
      // In the runtime's room turned by a right angle.
      open_body(script + std::string("at 0 pose head 2 1.6 1 0 0.70710678 0 0.70710678\n"));
      for (const Bone bone : {Bone::kHips, Bone::kChest, Bone::kHead, Bone::kLeftUpperArm,
                              Bone::kRightLowerLeg, Bone::kLeftFoot})
        EXPECT_LT(sight_.figure.R_WB[index_of(bone)].angularDistance(about_up(heading)), 2e-3f)
            << script << kBones[index_of(bone)].name;
      EXPECT_LT((sight_.figure.p_WB_m[0] - Vector3f(0.0f, 0.95f * 1.6f / 1.65f, 0.0f)).norm(),
                1e-3f);
    }
}

TEST_F(XrBodies, AWholeBodyIsTheDancersPose) {
  for (const char* script : {kFull, kSmall}) {
    sensors_.reset();
    open_body(script);
    XrDancer dancer({});
    Pose pose;
    ASSERT_TRUE(dancer.solve(sight_, pose));
    EXPECT_TRUE(is_valid(pose));
    EXPECT_EQ(pose.capture_time, sight_.points.time);
    EXPECT_NEAR(pose.p_WH_m.y(), 0.95f, 2e-2f);
    EXPECT_NEAR(heading_rad(pose.R_PB[0]), 0.0f, 1e-2f);
    BodyFrames frames;
    forward_kinematics(dancer.skeleton(), pose, frames);
    EXPECT_NEAR(frames.position(Bone::kLeftFoot).y(), 0.08f, 3e-2f);
    EXPECT_NEAR(frames.position(Bone::kHead).y(), 1.65f, 5e-2f);
  }
}

TEST_F(XrBodies, ABodyWithoutLegsIsPointsForTheSolver) {
  open_body(kUpper);
  EXPECT_FALSE(sight_.has_figure);
  struct Wanted {
    TrackedPoint point;
    Vector3f p_m;
  };
  for (const Wanted& it : {Wanted{TrackedPoint::kHips, {0.0f, 0.95f, 0.0f}},
                           Wanted{TrackedPoint::kChest, {0.0f, 1.35f, 0.0f}},
                           Wanted{TrackedPoint::kLeftElbow, {0.22f, 1.1f, -0.02f}},
                           Wanted{TrackedPoint::kRightElbow, {-0.22f, 1.1f, -0.02f}}}) {
    ASSERT_TRUE(sight_.points.has(it.point)) << kTrackedPointNames[index_of(it.point)];
    EXPECT_LT((sight_.points.position(it.point) - it.p_m).norm(), 2e-3f)
        << kTrackedPointNames[index_of(it.point)];
  }
  EXPECT_FALSE(sight_.points.has(TrackedPoint::kLeftFoot));
  EXPECT_FALSE(sight_.points.has(TrackedPoint::kLeftKnee));
  EXPECT_TRUE(is_valid(sight_.points));
  XrDancer dancer({});
  Pose pose;
  EXPECT_TRUE(dancer.solve(sight_, pose));
}

TEST_F(XrBodies, ATrackerThatIsWornCountsMoreThanWhatTheHeadsetInfers) {
  open_body(kUpper + std::string("at 0 pose hips 0 0.8 -0.3 0 0 0 1\nat 0.5 lose hips\n"));
  ASSERT_TRUE(pump_until([&] { return look() && sight_.points.has(TrackedPoint::kHips); }));
  EXPECT_LT((sight_.points.position(TrackedPoint::kHips) - Vector3f(0.0f, 0.8f, 0.3f)).norm(),
            2e-3f);
}

TEST_F(XrBodies, WithoutABodyTheDancerIsSolvedFromThePoints) {
  open_body(kFull + std::string("at 0.4 lose head\nat 3 find head\n"));
  ASSERT_TRUE(pump_until([&] {
    const MonoTime now = mono_now();
    sensors_->look(runtime_->xr_of(now), now, {}, sight_);
    return !sight_.has_figure;
  }));
  EXPECT_FALSE(sight_.points.has(TrackedPoint::kHead));
  XrDancer dancer({});
  Pose pose;
  EXPECT_FALSE(dancer.solve(sight_, pose)) << "without a head nothing is known";
  ASSERT_TRUE(pump_until([&] { return look() && sight_.has_figure; })) << "and it is found again";
  EXPECT_TRUE(dancer.solve(sight_, pose));
  sight_.has_figure = false;
  sight_.points.time = sight_.points.time + Duration::ms(10);
  EXPECT_FALSE(dancer.solve(sight_, pose)) << "a body is waited for";
  const Pose seen = pose;
  sight_.points.time = sight_.points.time + Duration::ms(400);
  EXPECT_TRUE(dancer.solve(sight_, pose)) << "from head and hands";
  EXPECT_LT((pose.p_WH_m - seen.p_WH_m).norm(), 0.02f) << "without a jump";
  EXPECT_TRUE(is_valid(pose));
}

TEST_F(XrBodies, AHeadsetThatSeesNoBodyHasNone) {
  open_focused("");
  const auto body = XrBody::create(*session_);
  ASSERT_TRUE(body) << body.error().what;
  EXPECT_EQ(*body, nullptr);
}

}  // namespace
}  // namespace dance
