#include "transformers/predict/dance_predictor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/pose/kinematics.h"
#include "tests/allocation_guard.h"
#include "tests/transformers/predicted_dances.h"

namespace dance {
namespace {

constexpr double kHalfDegree_rad = 0.0087;

bool is_equal(const Pose& a, const Pose& b) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (a.R_PB[i].coeffs() != b.R_PB[i].coeffs()) return false;
  return a.p_WH_m == b.p_WH_m;
}

TEST(DancePredictor, AtTheNewestMomentShowsTheNewestPose) {
  DancePredictor predictor(built_in_predict_model());
  for (const Pose& pose : shaken(salsa(300), kHalfDegree_rad)) {
    predictor.observe(pose);
    Pose out;
    predictor.predict(pose.capture_time, out);
    ASSERT_LT(mean_angle_rad(out, pose), 2e-3);
    ASSERT_LT((out.p_WH_m - pose.p_WH_m).norm(), 1e-4f);
  }
}

// What comes later has no part in what is said now: two dances that part after a moment are
// predicted alike up to it.
TEST(DancePredictor, KnowsNothingOfTheFuture) {
  const auto dance = salsa(400);
  auto other = dance;
  for (std::size_t i = 300; i < other.size(); ++i) other[i].R_PB[9] = other[0].R_PB[3];
  DancePredictor a(built_in_predict_model()), b(built_in_predict_model());
  for (std::size_t i = 0; i < dance.size(); ++i) {
    a.observe(dance[i]);
    b.observe(other[i]);
    Pose from_a, from_b;
    a.predict(dance[i].capture_time + Duration::ms(200), from_a);
    b.predict(dance[i].capture_time + Duration::ms(200), from_b);
    if (i < 300) {
      ASSERT_TRUE(is_equal(from_a, from_b)) << i;
    }
    if (i == 301) {
      EXPECT_FALSE(is_equal(from_a, from_b));
    }
  }
}

TEST(DancePredictor, GivesUnitRotationsAndBonesOfTheirLengthWhateverItHears) {
  DancePredictor predictor(built_in_predict_model());
  const Skeleton skeleton = average_skeleton();
  Random random(3);
  BodyFrames frames;
  for (const Pose& pose : shaken(salsa(900), 0.4)) {
    predictor.observe(pose);
    Pose out;
    predictor.predict(
        pose.capture_time + Duration::ms(static_cast<std::int64_t>(random.below(1500))), out);
    ASSERT_TRUE(is_valid(out));
    for (const auto& q : out.R_PB) ASSERT_NEAR(q.norm(), 1.0f, 1e-5f);
    forward_kinematics(skeleton, out, frames);
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const auto parent = static_cast<std::size_t>(kBones[b].parent);
      ASSERT_NEAR((frames.p_WB_m[b] - frames.p_WB_m[parent]).norm(), skeleton.offset_m[b].norm(),
                  1e-5f);
    }
  }
  EXPECT_EQ(predictor.dropped(), 0u);
}

// A sensor throws a foot round within some frames.
TEST(DancePredictor, TurnsNoJointFasterThanBodiesDo) {
  auto dance = salsa(400);
  const std::size_t foot = index_of(Bone::kLeftFoot);
  for (std::size_t i = 392; i < 400; ++i)
    dance[i].R_PB[foot] =
        dance[391].R_PB[foot] *
        exp_rotation(Eigen::Vector3f(0.0f, 0.7f * static_cast<float>(i - 391), 0.0f));
  DancePredictor predictor(built_in_predict_model());
  for (const Pose& pose : dance) predictor.observe(pose);
  Pose before = dance.back(), out;
  for (int ms = 10; ms <= 250; ms += 10) {
    predictor.predict(dance.back().capture_time + Duration::ms(ms), out);
    EXPECT_LT(out.R_PB[foot].angularDistance(before.R_PB[foot]), 0.3f) << ms;
    before = out;
  }
}

TEST(DancePredictor, AllocatesNothing) {
  DancePredictor predictor(built_in_predict_model());
  const auto dance = shaken(salsa(1400), kHalfDegree_rad);
  for (std::size_t i = 0; i < 700; ++i) {
    predictor.observe(dance[i]);
    predictor.personal()->learn();
  }
  const AllocationGuard guard;
  Pose out;
  for (std::size_t i = 700; i < dance.size(); ++i) {
    predictor.observe(dance[i]);
    predictor.predict(dance[i].capture_time + Duration::ms(180), out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(DancePredictor, SaysTheSameTwice) {
  const auto dance = shaken(salsa(700), kHalfDegree_rad);
  std::array<Pose, 2> last;
  for (Pose& out : last) {
    DancePredictor predictor(built_in_predict_model());
    for (std::size_t i = 0; i < dance.size(); ++i) {
      predictor.observe(dance[i]);
      if (i % 15 == 0) predictor.personal()->learn();
    }
    predictor.predict(dance.back().capture_time + Duration::ms(300), out);
  }
  EXPECT_TRUE(is_equal(last[0], last[1]));
}

// Errors of ours and of the plain predictions at a horizon, over each 10 s.
void expect_never_much_worse(const std::vector<Pose>& danced, const std::vector<Pose>& heard,
                             double most_ratio, const char* what) {
  DancePredictor predictor(built_in_predict_model());
  constexpr std::array<std::size_t, 4> kAhead{6, 12, 24, 60};
  constexpr std::size_t kTenSeconds = 600;
  std::array<std::array<double, 4>, 4> sums{};
  for (std::size_t i = 0; i + 60 < danced.size(); ++i) {
    predictor.observe(heard[i]);
    if (i % 15 == 0) predictor.personal()->learn();
    if (i < 240 || i % 4 != 0) continue;
    for (std::size_t h = 0; h < kAhead.size(); ++h) {
      const Pose& truth = danced[i + kAhead[h]];
      const auto frames = static_cast<float>(kAhead[h]);
      Pose ours, constant = heard[i], damped = heard[i];
      predictor.predict(heard[i].capture_time +
                            Duration::ns(kDanceStep_ns * static_cast<std::int64_t>(kAhead[h])),
                        ours);
      for (std::size_t b = 0; b < kBoneCount; ++b) {
        const Eigen::Vector3f last =
            rotation_vector(heard[i - 1].R_PB[b].conjugate() * heard[i].R_PB[b]);
        const Eigen::Vector3f lately =
            rotation_vector(heard[i - 6].R_PB[b].conjugate() * heard[i].R_PB[b]) / 6.0f;
        constant.R_PB[b] = heard[i].R_PB[b] * exp_rotation(frames * last);
        damped.R_PB[b] =
            heard[i].R_PB[b] * exp_rotation(6.0f * (1.0f - std::exp(-frames / 6.0f)) * lately);
      }
      const std::array<const Pose*, 4> said{&ours, &heard[i], &constant, &damped};
      for (std::size_t f = 0; f < said.size(); ++f) sums[h][f] += mean_angle_rad(*said[f], truth);
    }
    if (i % kTenSeconds >= 4) continue;
    for (std::size_t h = 0; h < kAhead.size(); ++h) {
      const double best = std::min({sums[h][1], sums[h][2], sums[h][3]});
      // An angle of single precision is not told from none.
      EXPECT_LE(sums[h][0], most_ratio * best + 2e-3 * kTenSeconds / 4)
          << what << " at frame " << i << ", " << kAhead[h] << " frames ahead";
      sums[h] = {};
    }
  }
}

TEST(DancePredictor, IsNeverMuchWorseThanPlainPredictionsWhileSomebodyStands) {
  const auto dance = standing(3000);
  expect_never_much_worse(dance, dance, 1.05, "standing");
  expect_never_much_worse(dance, shaken(dance, kHalfDegree_rad), 1.05, "standing, trembling");
}

TEST(DancePredictor, IsNeverMuchWorseThanPlainPredictionsWhileSomebodyStopsAgainAndAgain) {
  const auto dance = stopping(3600);
  expect_never_much_worse(dance, dance, 1.05, "stopping");
  expect_never_much_worse(dance, shaken(dance, kHalfDegree_rad), 1.05, "stopping, trembling");
}

TEST(DancePredictor, IsBetterThanPlainPredictionsOnADance) {
  const auto dance = salsa(3000);
  expect_never_much_worse(dance, shaken(dance, kHalfDegree_rad), 0.95, "salsa, trembling");
}

// Who glides through the room in one pose: joints that only tremble best stand still, and the hips
// do not.
TEST(DancePredictor, LetsHipsGoOnWhoseBodyHoldsItsPose) {
  auto danced = standing(1800);
  for (std::size_t i = 0; i < danced.size(); ++i) {
    const float angle = static_cast<float>(i) / 60.0f;  // a metre a second round a circle
    danced[i].p_WH_m += Eigen::Vector3f(std::cos(angle), 0.0f, std::sin(angle));
  }
  const auto heard = shaken(danced, kHalfDegree_rad);
  DancePredictor predictor(built_in_predict_model());
  constexpr std::array<std::size_t, 3> kAhead{3, 12, 24};
  std::array<double, 3> ours{}, going_on{};
  for (std::size_t i = 0; i + 24 < danced.size(); ++i) {
    predictor.observe(heard[i]);
    if (i < 600) continue;
    for (std::size_t h = 0; h < kAhead.size(); ++h) {
      Pose out;
      predictor.predict(heard[i].capture_time +
                            Duration::ns(kDanceStep_ns * static_cast<std::int64_t>(kAhead[h])),
                        out);
      const Eigen::Vector3f truth = danced[i + kAhead[h]].p_WH_m;
      const Eigen::Vector3f step = heard[i].p_WH_m - heard[i - 1].p_WH_m;
      ours[h] += (out.p_WH_m - truth).norm();
      going_on[h] += (heard[i].p_WH_m + static_cast<float>(kAhead[h]) * step - truth).norm();
    }
  }
  for (std::size_t h = 0; h < kAhead.size(); ++h)
    EXPECT_LE(ours[h], 1.05 * going_on[h]) << kAhead[h] << " frames ahead";
}

TEST(DancePredictor, GoesOnThroughOtherRatesAndUnevenTimes) {
  for (const double hz : {25.0, 30.0, 50.0, 60.1, 90.0, 120.0}) {
    SalsaDancer dancer{SalsaStyle()};
    DancePredictor predictor(built_in_predict_model());
    Random random(9);
    double ours = 0.0, still = 0.0;
    for (int i = 0; i < static_cast<int>(12.0 * hz); ++i) {
      const Duration t = Duration::seconds((i + random.uniform(-0.1, 0.1)) / hz + 0.1);
      Pose pose, truth, out;
      dancer.dance_at(t, pose);
      pose.capture_time = MonoTime::from_us(1'000'000) + t;
      pose.clock_id = 1;
      predictor.observe(pose);
      if (i < static_cast<int>(6.0 * hz)) continue;
      dancer.dance_at(t + Duration::ms(150), truth);
      predictor.predict(pose.capture_time + Duration::ms(150), out);
      ours += mean_angle_rad(out, truth);
      still += mean_angle_rad(pose, truth);
    }
    EXPECT_LT(ours, 0.75 * still) << hz;
  }
}

TEST(DancePredictor, BonesThatAreNotSeenStayWhereTheyWere) {
  DancePredictor predictor(built_in_predict_model());
  auto dance = salsa(400);
  const auto hand = index_of(Bone::kLeftHand), arm = index_of(Bone::kLeftLowerArm);
  for (std::size_t i = 0; i < dance.size(); ++i) {
    if (i >= 300) dance[i].presence = kAllBones & ~(1u << hand) & ~(1u << arm);
    predictor.observe(dance[i]);
  }
  Pose out;
  predictor.predict(dance.back().capture_time + Duration::ms(300), out);
  EXPECT_LT(out.R_PB[hand].angularDistance(dance[299].R_PB[hand]), 1e-2f);
  EXPECT_LT(out.R_PB[arm].angularDistance(dance[299].R_PB[arm]), 1e-2f);
  EXPECT_EQ(out.presence, dance.back().presence);
}

TEST(DancePredictor, StartsAnewAfterAGapAndRefusesWhatIsNotNewer) {
  DancePredictor predictor(built_in_predict_model());
  auto dance = salsa(200);
  for (const Pose& pose : dance) predictor.observe(pose);
  EXPECT_EQ(predictor.observe(dance[150]), SteadyRows::Heard::kRefused);
  Pose later = dance[0];
  later.capture_time = dance.back().capture_time + Duration::s(7);
  EXPECT_EQ(predictor.observe(later), SteadyRows::Heard::kRestarted);
  Pose out;
  predictor.predict(later.capture_time + Duration::ms(200), out);
  EXPECT_LT(mean_angle_rad(out, later), 0.05);
}

// One who was proved to repeat their dance for half a minute; then comes something else.
TEST(DancePredictor, OnAnotherClockOrAnotherDancerBeginsAnewAndAfterAGapGoesOn) {
  const auto dance = salsa(1800);
  const auto other = stopping(400);
  enum Change { kClock, kDancer, kGap };
  // Mean difference to one who never saw the dance before.
  const auto difference_rad = [&](Change change) {
    DancePredictor predictor(built_in_predict_model()), fresh(built_in_predict_model());
    for (const Pose& pose : dance) predictor.observe(pose);
    if (change == kDancer) predictor.forget_dancer();
    double sum = 0.0;
    for (std::size_t i = 0; i < other.size(); ++i) {
      Pose pose = other[i], ours, expected;
      pose.capture_time = dance.back().capture_time + Duration::s(3) +
                          (other[i].capture_time - other[0].capture_time);
      if (change == kClock) pose.clock_id = 2;
      predictor.observe(pose);
      fresh.observe(pose);
      predictor.predict(pose.capture_time + Duration::ms(200), ours);
      fresh.predict(pose.capture_time + Duration::ms(200), expected);
      sum += mean_angle_rad(ours, expected);
    }
    return sum / static_cast<double>(other.size());
  };
  const double clock = difference_rad(kClock), dancer = difference_rad(kDancer),
               gap = difference_rad(kGap);
  EXPECT_LT(clock, 0.25 * gap);
  EXPECT_LT(dancer, 0.25 * gap);
}

TEST(DancePredictor, TheLearnerTakesNothingOfTheDancerBefore) {
  const auto dance = shaken(salsa(900), kHalfDegree_rad);
  DancePredictor predictor(built_in_predict_model());
  bool is_new = false;
  for (const Pose& pose : dance) {
    predictor.observe(pose);
    predictor.personal()->learn();
  }
  predictor.forget_dancer();
  predictor.personal()->learn();
  EXPECT_EQ(predictor.personal()->weights(is_new), nullptr);
  for (std::size_t i = 0; i < 120; ++i) {
    Pose pose = dance[i];
    pose.capture_time = dance.back().capture_time + Duration::s(2) +
                        (dance[i].capture_time - dance[0].capture_time);
    predictor.observe(pose);
    predictor.personal()->learn();
  }
  EXPECT_LT(predictor.personal()->moments(), 60u);
  EXPECT_EQ(predictor.personal()->weights(is_new), nullptr);
}

}  // namespace
}  // namespace dance
