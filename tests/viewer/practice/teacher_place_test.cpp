#include "viewer/practice/teacher_place.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "core/pose/kinematics.h"
#include "core/pose/mirror.h"
#include "tests/viewer/test_scene.h"

namespace dance {
namespace {

constexpr float kQuarter_rad = 0.5f * std::numbers::pi_v<float>;

Eigen::Vector3f place_of(const SceneGuest& guest, Bone bone) {
  BodyFrames frames;
  forward_kinematics(guest.skeleton, guest.pose, frames);
  return frames.position(bone);
}

// Stands off the middle, turned, with the left leg forwards.
SceneGuest stepping() {
  SceneGuest guest = guest_at_ease("lead", {2.0f, 0.0f, -1.0f}, 0.7f);
  guest.pose.R_PB[index_of(Bone::kLeftUpperLeg)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(-0.6f, Eigen::Vector3f::UnitX()));
  return guest;
}

// In the dancer's own frame: x to the left, z forwards.
Eigen::Vector3f seen_by(const SceneGuest& guest, Bone bone) {
  const Eigen::Vector3f forwards = facing_W(guest);
  const Eigen::Vector3f left = Eigen::Vector3f::UnitY().cross(forwards);
  const Eigen::Vector3f p = place_of(guest, bone) - guest.pose.p_WH_m;
  return {left.dot(p), p.y(), forwards.dot(p)};
}

TEST(MirrorFigure, LeftLimbsMoveAsRightOnesDid) {
  const SceneGuest before = stepping();
  SceneGuest after = before;
  mirror_figure(after);
  for (const auto& [left, right] :
       {std::pair{Bone::kLeftFoot, Bone::kRightFoot}, std::pair{Bone::kLeftHand, Bone::kRightHand},
        std::pair{Bone::kHead, Bone::kHead}}) {
    const Eigen::Vector3f expected = mirrored(place_of(before, left));
    EXPECT_LT((place_of(after, right) - expected).norm(), 1e-4f);
  }
  mirror_figure(after);
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    EXPECT_LT((place_of(after, static_cast<Bone>(bone)) - place_of(before, static_cast<Bone>(bone)))
                  .norm(),
              1e-4f);
}

TEST(MirrorFigure, FingersThatAreSeenChangeSides) {
  SceneGuest guest = stepping();
  guest.hands.emplace();
  guest.hands->presence = 1u << 3;  // the left index finger
  guest.hands->R_PB[3] = Eigen::Quaternionf(Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitZ()));
  mirror_figure(guest);
  EXPECT_EQ(guest.hands->presence, 1u << 18);
  EXPECT_LT(guest.hands->R_PB[18].angularDistance(
                Eigen::Quaternionf(Eigen::AngleAxisf(-0.5f, Eigen::Vector3f::UnitZ()))),
            1e-4f);
}

TEST(TeacherPlace, StandsAtThePupilsRightAndFacesTheSameWay) {
  const SceneGuest recorded = stepping();
  const SceneGuest pupil = guest_at_ease("pupil", {-1.0f, 0.0f, 3.0f}, kQuarter_rad);  // faces +X
  for (const bool is_mirrored : {false, true}) {
    TeacherPlace place;
    place.begin(recorded);
    place.put_beside(pupil, false);
    SceneGuest figure = recorded;
    place.apply(figure, is_mirrored);
    const Eigen::Vector3f away = figure.pose.p_WH_m - pupil.pose.p_WH_m;
    EXPECT_NEAR(away.x(), 0.0f, 1e-3f);
    EXPECT_NEAR(away.z(), TeacherPlace::kBeside_m, 1e-3f) << "to the right of who faces +X";
    EXPECT_NEAR(figure.pose.p_WH_m.y(), recorded.pose.p_WH_m.y(), 1e-4f) << "feet on the floor";
    EXPECT_GT(facing_W(figure).dot(facing_W(pupil)), 0.999f);
    const Bone forward_foot = is_mirrored ? Bone::kRightFoot : Bone::kLeftFoot;
    EXPECT_GT(seen_by(figure, forward_foot).z(), 0.3f);
  }
}

TEST(TeacherPlace, StaysInTheRoomAndRepeatsTheRecordedWay) {
  const SceneGuest recorded = stepping();
  SceneGuest pupil = guest_at_ease("pupil", Eigen::Vector3f::Zero(), 0.0f);
  TeacherPlace place;
  place.begin(recorded);
  SceneGuest alone = recorded;
  place.apply(alone, false);
  EXPECT_LT((alone.pose.p_WH_m - recorded.pose.p_WH_m).norm(), 1e-4f) << "without a pupil";
  place.put_beside(pupil, true);
  EXPECT_TRUE(place.has_pupil());
  // Half a metre forwards, as the teacher faced when the recording began.
  SceneGuest later = recorded;
  later.pose.p_WH_m += 0.5f * facing_W(recorded);
  place.apply(later, false);
  EXPECT_NEAR(later.pose.p_WH_m.x(), 0.0f, 1e-3f);
  EXPECT_NEAR(later.pose.p_WH_m.z(), 0.5f, 1e-3f) << "the pupil faces +Z";
}

TEST(TeacherChoices, SpeedStaysBetweenHalfAndFull) {
  EXPECT_DOUBLE_EQ(changed_speed(1.0, 1), 1.0);
  EXPECT_DOUBLE_EQ(changed_speed(1.0, -1), 0.9);
  EXPECT_DOUBLE_EQ(changed_speed(0.5, -1), 0.5);
  EXPECT_DOUBLE_EQ(changed_speed(0.75, -1), 0.7);
}

}  // namespace
}  // namespace dance
