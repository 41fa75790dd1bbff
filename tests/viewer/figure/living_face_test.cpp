// Faces without capture: gaze, blinks, smiles, and mouths that follow voices.
#include "viewer/figure/face/living_face.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/viewer/figure/test_rigs.h"
#include "viewer/figure/face/blink.h"
#include "viewer/figure/face/gaze.h"
#include "viewer/figure/face/smile.h"

namespace dance {
namespace {

using E = Expression;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kAbout_rad = std::numbers::pi_v<float>;

GuestId guest_id(const char* name) { return *GuestId::parse(name); }
MonoTime moment_at(double s) { return MonoTime() + Duration::seconds(s); }

// Stands at x, z on the floor and faces `yaw_rad` (0 is +Z); hands hang.
DancerView standing(const char* name, float x_m, float z_m, float yaw_rad) {
  DancerView view;
  view.id = guest_id(name);
  const Eigen::Quaternionf turned(Eigen::AngleAxisf(yaw_rad, Vector3f::UnitY()));
  view.R_WH = turned;
  view.eyes_W_m = Vector3f(x_m, 1.6f, z_m);
  view.hips_W_m = Vector3f(x_m, 0.9f, z_m);
  view.facing_W = turned * Vector3f::UnitZ();
  for (std::size_t side = 0; side < 2; ++side)
    view.palms_W_m[side] =
        view.hips_W_m + turned * Vector3f(side == 0 ? 0.25f : -0.25f, -0.1f, 0.0f);
  return view;
}

std::vector<DancerView> couple_apart(float apart_m) {
  return {standing("alice", 0.0f, 0.0f, 0.0f), standing("bob", 0.0f, apart_m, kAbout_rad)};
}

SceneGuest dancer_named(const char* name) {
  SceneGuest guest;
  guest.id = guest_id(name);
  return guest;
}

TEST(FigureGaze, AimsToTheLeftAndUpAtAPartnerThere) {
  const DancerView alice = standing("alice", 0.0f, 0.0f, 0.0f);
  const Vector2f left = aim_gaze(alice, alice.eyes_W_m + Vector3f(1.0f, 0.0f, 1.0f));
  EXPECT_NEAR(left.x(), kAbout_rad / 4.0f, 1e-4f);
  EXPECT_NEAR(left.y(), 0.0f, 1e-4f);
  const Vector2f up = aim_gaze(alice, alice.eyes_W_m + Vector3f(0.0f, 1.0f, 1.0f));
  EXPECT_NEAR(up.y(), kAbout_rad / 4.0f, 1e-4f);
}

TEST(FigureGaze, StaysWithinTheRangeOfEyesWhereverThePartnerIs) {
  for (float yaw = -kAbout_rad; yaw <= kAbout_rad; yaw += 0.05f)
    for (float pitch = -1.5f; pitch <= 1.5f; pitch += 0.05f) {
      const Vector2f gaze = limit_gaze({yaw, pitch});
      ASSERT_LE(std::abs(gaze.x()), kMostGazeAside_rad);
      ASSERT_LE(gaze.y(), kMostGazeUp_rad);
      ASSERT_GE(gaze.y(), -kMostGazeDown_rad);
    }
  EXPECT_EQ(limit_gaze({0.2f, -0.1f}), Vector2f(0.2f, -0.1f)) << "near the middle as aimed";
}

TEST(FigureGaze, MovesGraduallyFromAPartnerWhoGoesBehind) {
  Vector2f before = limit_gaze({0.0f, 0.0f});
  for (float yaw = 0.0f; yaw <= kAbout_rad; yaw += 0.01f) {
    const Vector2f gaze = limit_gaze({yaw, 0.0f});
    ASSERT_LT((gaze - before).norm(), 0.03f) << yaw;
    before = gaze;
  }
  EXPECT_EQ(before, Vector2f(0.0f, 0.0f)) << "eyes do not stay in their corners";
}

TEST(FigureGaze, ChoosesTheNearestDancerInFront) {
  std::vector<DancerView> views{
      standing("alice", 0.0f, 0.0f, 0.0f), standing("far", 0.0f, 2.0f, kAbout_rad),
      standing("near", 0.2f, 1.0f, kAbout_rad), standing("behind", 0.0f, -0.5f, 0.0f)};
  EXPECT_EQ(find_gaze_partner(views, 0, GuestId()), 2u);
  views.erase(views.begin() + 1, views.begin() + 3);
  EXPECT_EQ(find_gaze_partner(views, 0, GuestId()), views.size()) << "nobody is in front";
  views.push_back(standing("alice", 0.0f, 1.0f, kAbout_rad));
  EXPECT_EQ(find_gaze_partner(views, 0, GuestId()), views.size()) << "nobody looks at oneself";
}

TEST(FigureGaze, KeepsThePartnerWhileNoOtherIsClearlyNearer) {
  std::vector<DancerView> views{standing("alice", 0.0f, 0.0f, 0.0f),
                                standing("bob", 0.3f, 1.0f, kAbout_rad),
                                standing("eve", -0.3f, 0.9f, kAbout_rad)};
  EXPECT_EQ(find_gaze_partner(views, 0, guest_id("bob")), 1u);
  EXPECT_EQ(find_gaze_partner(views, 0, GuestId()), 2u);
  views[2] = standing("eve", -0.1f, 0.5f, kAbout_rad);
  EXPECT_EQ(find_gaze_partner(views, 0, guest_id("bob")), 2u);
}

TEST(Saccade, IsSmallRestsBetweenJumpsAndFollowsFromGuestAndTime) {
  int moving = 0;
  Vector2f before = saccade_at(guest_id("alice"), moment_at(0.0));
  for (int i = 1; i < 6000; ++i) {
    const Vector2f off = saccade_at(guest_id("alice"), moment_at(0.01 * i));
    ASSERT_LT(off.norm(), 0.08f);
    moving += off != before;
    before = off;
  }
  EXPECT_GT(moving, 60);
  EXPECT_LT(moving, 600) << "eyes rest on what they look at";
  EXPECT_EQ(saccade_at(guest_id("alice"), moment_at(7.3)),
            saccade_at(guest_id("alice"), moment_at(7.3)));
  EXPECT_NE(saccade_at(guest_id("alice"), moment_at(7.3)),
            saccade_at(guest_id("bob"), moment_at(7.3)));
}

TEST(Blink, ClosesTheEyesEveryFewSecondsTheSameOnEveryScreen) {
  int blinks = 0;
  bool is_shut = false;
  double same_as_bob = 0.0;
  for (int i = 0; i < 12'000; ++i) {
    const MonoTime time = moment_at(0.01 * i);
    const float blink = blink_at(guest_id("alice"), time);
    ASSERT_GE(blink, 0.0f);
    ASSERT_LE(blink, 1.0f);
    ASSERT_EQ(blink, blink_at(guest_id("alice"), time));
    blinks += blink > 0.5f && !is_shut;
    is_shut = blink > 0.5f;
    same_as_bob += static_cast<double>(std::min(blink, blink_at(guest_id("bob"), time)));
  }
  EXPECT_NEAR(blinks, 32, 2);
  EXPECT_LT(same_as_bob, 60.0) << "not both at once";
}

TEST(Smile, NeedsAPartnerWhoIsNear) {
  EXPECT_EQ(smile_towards(std::vector{standing("alice", 0, 0, 0)}, 0, moment_at(3)), 0.0f);
  EXPECT_EQ(smile_towards(couple_apart(3.0f), 0, moment_at(3)), 0.0f);
  EXPECT_GT(smile_towards(couple_apart(0.7f), 0, moment_at(3)), 0.15f);
}

TEST(Smile, GrowsWithFacingHeldHandsAndStepsOnTheBeat) {
  auto views = couple_apart(0.7f);
  const float facing = enjoyment_of(views[0], views[1]);
  auto turned = views;
  turned[1] = standing("bob", 0.0f, 0.7f, 0.0f);
  EXPECT_LT(enjoyment_of(turned[0], turned[1]), 0.5f * facing);
  views[0].palms_W_m[0] = views[1].palms_W_m[1] = Vector3f(0.2f, 1.2f, 0.35f);
  const float held = enjoyment_of(views[0], views[1]);
  EXPECT_GT(held, facing + 0.1f);
  views[0].on_beat = 1.0f;
  const float on_beat = enjoyment_of(views[0], views[1]);
  EXPECT_GT(on_beat, held + 0.1f);
  EXPECT_LE(on_beat, 1.0f);
  for (int i = 0; i < 100; ++i)
    EXPECT_LE(smile_towards(views, 0, moment_at(0.37 * i)), kMostSmile) << "it is no grin";
}

TEST(LivingFace, SmilesGraduallyWhenAPartnerApproaches) {
  const SceneGuest alice = dancer_named("alice");
  FacePast past;
  face_of(alice, couple_apart(3.0f), 0, moment_at(1), past);
  float before = 0.0f;
  for (int i = 1; i <= 240; ++i) {
    past.is_known = true;
    past.passed_s = 1.0f / 60.0f;
    const Face face =
        face_of(alice, couple_apart(0.7f), 0, moment_at(1.0 + static_cast<double>(i) / 60.0), past);
    const float smile = face[E::kMouthSmileLeft];
    ASSERT_LT(std::abs(smile - before), 0.02f) << i;
    ASSERT_EQ(smile, face[E::kMouthSmileRight]);
    before = smile;
  }
  EXPECT_GT(before, 0.15f);
}

TEST(LivingFace, MouthFollowsTheVoiceAndClosesAfterIt) {
  SceneGuest alice = dancer_named("alice");
  const auto views = couple_apart(2.5f);
  const auto most_open = [&](float voice, double from_s) {
    alice.voice = voice;
    FacePast past;
    float open = 0.0f;
    for (int i = 0; i < 60; ++i) {
      open =
          std::max(open, face_of(alice, views, 0, moment_at(from_s + i / 60.0), past)[E::kJawOpen]);
      past.is_known = true;
      past.passed_s = 1.0f / 60.0f;
    }
    alice.voice = 0.0f;
    for (int i = 60; i < 120; ++i)
      if (face_of(alice, views, 0, moment_at(from_s + i / 60.0), past)[E::kJawOpen] > 0.01f &&
          i > 90)
        ADD_FAILURE() << "still open at picture " << i;
    return open;
  };
  EXPECT_EQ(most_open(0.0f, 1.0), 0.0f);
  const float quiet = most_open(0.3f, 1.0), loud = most_open(1.0f, 1.0);
  EXPECT_GT(quiet, 0.05f);
  EXPECT_GT(loud, 2.0f * quiet);
  EXPECT_LE(loud, 1.0f);
}

TEST(LivingFace, CapturedFaceWins) {
  SceneGuest alice = dancer_named("alice");
  alice.voice = 1.0f;
  Face captured;
  captured.presence = kFaceSeen | kGazeSeen;
  captured[E::kMouthFrownLeft] = 0.5f;
  captured.gaze_rad = {-0.4f, 0.1f};
  alice.face = captured;
  auto views = couple_apart(0.6f);
  views[0].palms_W_m = views[1].palms_W_m;
  FacePast past;
  past.is_known = true;
  for (int i = 0; i < 300; ++i) {
    past.passed_s = 0.016f;
    const Face face = face_of(alice, views, 0, moment_at(0.016 * i), past);
    ASSERT_EQ(face.weight, captured.weight);
    ASSERT_EQ(face.gaze_rad, captured.gaze_rad);
  }
}

TEST(LivingFace, CapturedExpressionsKeepTheirOwnLookElseTheEyesFollowThePartner) {
  SceneGuest alice = dancer_named("alice");
  Face captured;
  captured.presence = kFaceSeen;
  alice.face = captured;
  std::vector<DancerView> views{standing("alice", 0, 0, 0),
                                standing("bob", 0.5f, 1.0f, kAbout_rad)};
  FacePast past;
  EXPECT_GT(face_of(alice, views, 0, moment_at(1), past).gaze_rad[0], 0.25f);
  captured[E::kEyeLookInLeft] = captured[E::kEyeLookOutRight] = 0.5f;
  alice.face = captured;
  const Face face = face_of(alice, views, 0, moment_at(1), past);
  EXPECT_LT(face.gaze_rad[0], -0.2f) << "to the right, as a headset has seen";
  EXPECT_EQ(face.weight, captured.weight);
}

// Input for the poser: two mannequins in front of each other.
SceneState facing_mannequins(double s) {
  SceneState scene;
  scene.time = moment_at(s);
  static const auto kModel = shared(mannequin_of(average_skeleton()));
  for (const bool is_first : {true, false}) {
    SceneGuest guest = guest_in(kModel, is_first ? "alice" : "bob");
    guest.pose.p_WH_m.z() = is_first ? -0.4f : 0.4f;
    guest.pose.p_WH_m.x() = is_first ? 0.0f : 0.25f;
    if (!is_first) guest.pose.R_PB[0] = Eigen::AngleAxisf(kAbout_rad, Vector3f::UnitY());
    guest.voice = 0.6f;
    scene.guests.push_back(guest);
  }
  return scene;
}

TEST(LivingFace, AnotherPictureOfTheSameMomentIsTheSame) {
  FigurePoser poser, other;
  for (const double s : {5.0, 5.02, 5.04}) {
    poser.pose(facing_mannequins(s));
    other.pose(facing_mannequins(s));
  }
  const auto once = poser.pose(facing_mannequins(5.06))[0].morph_weights;
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(poser.pose(facing_mannequins(5.06))[0].morph_weights, once) << "made again";
  EXPECT_EQ(other.pose(facing_mannequins(5.06))[0].morph_weights, once) << "by another viewer";
  EXPECT_GT(*std::ranges::max_element(once), 0.1f);
}

TEST(LivingFace, IsTheSameAtAnyFrameRate) {
  FigurePoser slow, fast;
  for (int i = 0; i <= 60; ++i) slow.pose(facing_mannequins(5.0 + i / 30.0));
  for (int i = 0; i <= 120; ++i) fast.pose(facing_mannequins(5.0 + i / 60.0));
  const auto a = slow.pose(facing_mannequins(7.0))[0].morph_weights;
  const auto b = fast.pose(facing_mannequins(7.0))[0].morph_weights;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t m = 0; m < a.size(); ++m) EXPECT_NEAR(a[m], b[m], 0.06f) << m;
}

TEST(LivingFace, TurnsTheMannequinsEyesToThePartnerAndNotTheHead) {
  FigurePoser poser;
  const SceneState scene = facing_mannequins(5.0);
  const PosedFigure alice = poser.pose(scene)[0];
  const Vector3f partner = poser.pose(scene)[1].frames.position(Bone::kHead);
  const Eigen::Quaternionf& R_WH = alice.frames.R_WB[index_of(Bone::kHead)];
  EXPECT_LT(R_WH.angularDistance(Eigen::Quaternionf::Identity()), 1e-4f) << "as captured";
  for (const int node : alice.model->eyes) {
    ASSERT_GE(node, 0);
    std::size_t joint = 0;
    while (alice.model->joints[joint].node != node) ++joint;
    const Vector3f forward = alice.W_from_joint[joint].leftCols<3>() * Vector3f::UnitZ();
    Vector3f to = partner - alice.frames.position(Bone::kHead);
    to.y() = 0.0f;
    EXPECT_GT(Vector3f(forward.x(), 0.0f, forward.z()).normalized().dot(to.normalized()),
              std::cos(0.12f));
    EXPECT_GT(forward.x(), 0.15f) << "to the left";
  }
}

TEST(LivingFace, FiguresWithoutAFaceKeepTheirMorphsAtRest) {
  AvatarModel plain = mannequin_of(average_skeleton());
  plain.expressions.clear();
  plain.morphs.resize(1);
  plain.morphs[0].name = "sleevesUp";
  plain.eyes = {-1, -1};
  SceneState scene = facing_mannequins(5.0);
  const auto model = shared(std::move(plain));
  for (SceneGuest& guest : scene.guests) guest.avatar = model;
  FigurePoser poser;
  const auto figures = poser.pose(scene);
  EXPECT_EQ(figures[0].morph_weights, std::vector<float>{0.0f});
}

}  // namespace
}  // namespace dance
