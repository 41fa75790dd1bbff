// Soles are on the floor, hands that meet still do, wrists are not wrung, and nothing jumps.
#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/viewer/figure/test_rigs.h"
#include "tests/viewer/test_scene.h"
#include "viewer/figure/driver_pose.h"

namespace dance {
namespace {

using Eigen::Vector3f;

// The middle of a hand: 40 % of the way to the tip of the middle finger.
Vector3f palm_of(const BodyFrames& frames, const AvatarModel& model, const PosedFigure& figure,
                 std::size_t side) {
  const Bone hand = side == 0 ? Bone::kLeftHand : Bone::kRightHand;
  const auto knuckle = static_cast<std::size_t>(model.fingers[side * kFingerBoneCount / 2 + 6]);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (model.joints[j].node == static_cast<int>(knuckle)) {
      const Vector3f in_mesh = model.joints[j].node_from_mesh.inverse().translation();
      const Vector3f at = figure.W_from_joint[j] * in_mesh.homogeneous();
      return frames.position(hand) + 0.8f * (at - frames.position(hand));
    }
  return frames.position(hand);
}

// A couple whose raised palms meet at a place, `apart_m` from each other.
SceneState couple_with_palms(const Vector3f& meeting, float apart_m) {
  SceneState scene;
  for (const float side : {1.0f, -1.0f}) {
    SceneGuest guest = guest_at_ease(side > 0 ? "alice" : "bob", Vector3f(0.42f * side, 0, 0),
                                     -side * 1.5707963f, side > 0 ? 1.66f : 1.8f);
    const Limb& arm = side > 0 ? kLeftArm : kRightArm;
    BodyFrames frames;
    forward_kinematics(guest.skeleton, guest.pose, frames);
    const Eigen::Quaternionf R_WHand = guest.pose.R_PB[0];
    const Tip tip = side > 0 ? Tip::kLeftHand : Tip::kRightHand;
    const Vector3f palm = meeting + Vector3f(0.5f * side * apart_m, 0, 0);
    const float missed_m =
        solve_two_bone(guest.skeleton, arm, palm - R_WHand * (0.4f * guest.skeleton.tip(tip)),
                       Vector3f(side, -1.0f, 0.3f), R_WHand, guest.pose, frames);
    EXPECT_LT(missed_m, 1e-3f);
    scene.guests.push_back(guest);
  }
  scene.time = MonoTime::from_us(1'000'000);
  return scene;
}

struct Bodies {
  const char* name;
  std::shared_ptr<const AvatarModel> first, second;
};

std::vector<Bodies> all_bodies() {
  Skeleton long_arms = average_skeleton(1.7f);
  for (const Bone bone :
       {Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kRightLowerArm, Bone::kRightHand})
    long_arms.offset_m[index_of(bone)] *= 1.3f;
  Skeleton short_arms = average_skeleton(1.7f);
  for (const Bone bone :
       {Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kRightLowerArm, Bone::kRightHand})
    short_arms.offset_m[index_of(bone)] *= 0.85f;
  const auto child = mannequin_of(average_skeleton(1.1f));
  return {{"child and giant", shared(child), shared(mannequin_of(average_skeleton(2.2f)))},
          {"long arms", shared(mannequin_of(long_arms)), shared(mannequin_of(long_arms))},
          {"short arms", shared(mannequin_of(short_arms)), shared(mannequin_of(short_arms))},
          {"A-pose", shared(with_other_axes(in_a_pose(child, 45.0f), 21, 0.01f)),
           shared(mannequin_of(average_skeleton(1.9f)))},
          {"few bones",
           shared(without(child, {Bone::kSpine, Bone::kUpperChest, Bone::kNeck, Bone::kLeftShoulder,
                                  Bone::kRightShoulder, Bone::kLeftToes, Bone::kRightToes})),
           shared(child)}};
}

TEST(FigureContact, PalmsThatMeetInTheDanceMeetOnAvatarsOfAnyProportions) {
  float plain_worst = 0.0f;
  for (const Bodies& bodies : all_bodies()) {
    FigurePoser poser, plain({false, false, false});
    for (float height = 1.15f; height < 1.6f; height += 0.1f) {
      SceneState scene = couple_with_palms(Vector3f(0.02f, height, 0.3f), 0.02f);
      scene.time += Duration::s(static_cast<std::int64_t>(height * 100.0f));
      scene.guests[0].avatar = bodies.first;
      scene.guests[1].avatar = bodies.second;
      const auto gap = [&](FigurePoser& by) {
        const auto figures = by.pose(scene);
        return (palm_of(figures[0].frames, *bodies.first, figures[0], 0) -
                palm_of(figures[1].frames, *bodies.second, figures[1], 1))
            .norm();
      };
      EXPECT_LT(gap(poser), 0.03f) << bodies.name << " at " << height;
      plain_worst = std::max(plain_worst, gap(plain));
    }
  }
  EXPECT_GT(plain_worst, 0.1f) << "nothing to fit";
}

TEST(FigureContact, PalmsComeTogetherAndPartWithoutAJump) {
  const auto bodies = all_bodies()[0];
  FigurePoser poser;
  std::vector<BodyFrames> before;
  for (int i = 0; i <= 240; ++i) {  // 0.8 m to nothing and back within 4 s
    const float apart = 0.8f * std::abs(static_cast<float>(i - 120)) / 120.0f;
    SceneState scene = couple_with_palms(Vector3f(0.0f, 1.3f, 0.35f), apart);
    scene.time += Duration::us(16'667 * i);
    scene.guests[0].avatar = bodies.first;
    scene.guests[1].avatar = bodies.second;
    const auto figures = poser.pose(scene);
    for (std::size_t g = 0; g < 2 && !before.empty(); ++g)
      for (std::size_t b = 0; b < kBoneCount; ++b)
        // Palms move 3.3 mm a picture.
        EXPECT_LT((figures[g].frames.p_WB_m[b] - before[g].p_WB_m[b]).norm(), 0.03f)
            << kBones[b].name << " at picture " << i;
    before = {figures[0].frames, figures[1].frames};
  }
}

TEST(FigureContact, AnotherPictureOfTheSameMomentIsTheSame) {
  const auto bodies = all_bodies()[0];
  FigurePoser poser;
  for (int i = 0; i < 60; ++i) {  // arms that are still on their way to each other too
    SceneState scene =
        couple_with_palms(Vector3f(0.01f, 1.3f, 0.35f), 0.4f - 0.007f * static_cast<float>(i));
    scene.time += Duration::us(16'667 * i);
    scene.guests[0].avatar = bodies.first;
    scene.guests[1].avatar = bodies.second;
    const auto matrices = [&] {
      std::vector<JointMatrix> all;
      for (const PosedFigure& figure : poser.pose(scene))
        all.insert(all.end(), figure.W_from_joint.begin(), figure.W_from_joint.end());
      return all;
    };
    const auto first = matrices();
    for (int again = 0; again < 3; ++again) ASSERT_EQ(matrices(), first) << "picture " << i;
  }
}

TEST(FigureContact, SolesAreOnTheFloorWhateverTheLegs) {
  for (const Bodies& bodies : all_bodies()) {
    FigurePoser poser;
    for (const FigureSize size : {FigureSize::kDancers, FigureSize::kOwn})
      for (float y = -0.06f; y < 0.021f; y += 0.02f) {
        SceneGuest guest = guest_at_ease("alice", Vector3f::Zero(), 0.7f);
        guest.pose.p_WH_m.y() += y;  // recorded through the floor, or above it
        guest.avatar = bodies.first;
        guest.figure_size = size;
        SceneState scene;
        scene.time = MonoTime::from_us(1'000'000);
        scene.guests = {guest};
        const float low = lowest_of(poser.pose(scene)[0]);
        EXPECT_GT(low, -0.002f) << bodies.name << " " << y;
        EXPECT_LT(low, 0.01f) << bodies.name << " " << y;
      }
  }
}

TEST(FigureContact, NoJointOfTheForearmIsWrung) {
  const auto avatar = shared(mannequin_of(average_skeleton(1.6f)));
  FigurePoser poser;
  for (int i = 0; i <= 400; ++i) {  // the hand turns about the forearm, on and on
    SceneGuest guest = guest_in(avatar);
    const float angle = 0.02f * static_cast<float>(i);
    guest.pose.R_PB[index_of(Bone::kLeftHand)] = exp_rotation(Vector3f(angle, 0, 0));
    SceneState scene;
    scene.time = MonoTime::from_us(1'000'000 + 16'667 * i);
    scene.guests = {guest};
    const BodyFrames& at = poser.pose(scene)[0].frames;
    const auto twist = [&](Bone a, Bone b) {
      return std::abs(
          twist_rad(at.R_WB[index_of(a)].conjugate() * at.R_WB[index_of(b)], Vector3f::UnitX()));
    };
    EXPECT_LT(twist(Bone::kLeftLowerArm, Bone::kLeftHand), 1.4f) << angle;
    EXPECT_LT(twist(Bone::kLeftUpperArm, Bone::kLeftLowerArm), 1.4f) << angle;
  }
}

TEST(FigureContact, AFullFloorAllocatesNothingAfterTheFirstPictures) {
  const auto avatar = shared(mannequin_of(average_skeleton(1.6f)));
  FigurePoser poser;
  SceneState scene = full_floor();
  for (SceneGuest& guest : scene.guests) guest.avatar = avatar;
  scene.time = MonoTime::from_us(1'000'000);
  poser.pose(scene);
  const AllocationGuard guard;
  for (int i = 0; i < 20; ++i) {
    scene.time += Duration::ms(16);
    for (SceneGuest& guest : scene.guests) guest.pose.p_WH_m.x() *= 0.95f;  // closer and closer
    poser.pose(scene);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(FigureContact, GuestsMayComeGoAndBeShownTwice) {
  const auto avatar = shared(mannequin_of(average_skeleton(1.6f)));
  FigurePoser poser;
  SceneState scene = full_floor();
  for (SceneGuest& guest : scene.guests) guest.avatar = avatar;
  EXPECT_EQ(poser.pose(scene).size(), 30u);
  scene.guests.erase(scene.guests.begin() + 3);
  scene.guests[5].opacity = 0.0f;
  scene.guests[7].avatar = nullptr;
  scene.guests.push_back(scene.guests[0]);
  scene.guests.back().is_compared = true;
  const auto figures = poser.pose(scene);
  ASSERT_EQ(figures.size(), 28u);
  EXPECT_EQ(figures[27].id, figures[0].id);
  EXPECT_EQ(figures[3].id, scene.guests[3].id);
  scene.guests.clear();
  EXPECT_TRUE(poser.pose(scene).empty());
}

}  // namespace
}  // namespace dance
