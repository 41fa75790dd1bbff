// The synthetic dancer's motion as a body's: what stands does not slide, nothing moves faster than
// people do, and its rhythm can be measured from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/producers/salsa/salsa_couple.h"

namespace dance {
namespace {

using Eigen::Vector3f;

Bone ball(bool is_left) { return is_left ? Bone::kLeftToes : Bone::kRightToes; }

// What one foot did so far: where it stands, and how often and how long it has stood.
struct Stance {
  bool stands = false;
  Vector3f stood_m = Vector3f::Zero();
  int frames = 0;
  int stances = 0;
};

TEST(SalsaFeet, DoNotSlideWhileTheyStand) {
  constexpr float kStanding_m = 0.0005f;
  constexpr int kFrames = 6000;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SalsaCouple couple(salsa_style(seed, 170.0 + 15.0 * static_cast<double>(seed)));
    std::array<Stance, 4> feet;
    for (int i = 0; i < kFrames; ++i) {
      couple.dance_at(Duration::ms(8 * i));
      for (std::size_t k = 0; k < feet.size(); ++k) {
        const SalsaRole role = kSalsaRoles[k / 2];
        const bool is_left = k % 2 == 0;
        const Vector3f p = couple.frames(role).position(ball(is_left));
        const bool stood =
            std::exchange(feet[k].stands, couple.ball_lift_m(role, is_left) < kStanding_m);
        if (!feet[k].stands) continue;
        if (!stood) {
          feet[k].stood_m = p;
          ++feet[k].stances;
        }
        ++feet[k].frames;
        ASSERT_LT((p - feet[k].stood_m).norm(), 0.001f)
            << "seed " << seed << " beat " << couple.pose(role).music_beats;
      }
    }
    for (const Stance& foot : feet) {
      EXPECT_GT(foot.stances, 40);
      EXPECT_GT(foot.frames, kFrames / 2);
      EXPECT_LT(foot.frames, kFrames * 9 / 10) << "feet do leave the floor";
    }
  }
}

TEST(SalsaFeet, AreNeverBothInTheAirAndNeverUnderTheFloor) {
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    SalsaCouple couple(salsa_style(seed, 200.0));
    float highest_m = 0.0f;
    for (int i = 0; i < 4000; ++i) {
      couple.dance_at(Duration::ms(9 * i));
      for (const SalsaRole role : kSalsaRoles) {
        const float left = couple.ball_lift_m(role, true);
        const float right = couple.ball_lift_m(role, false);
        ASSERT_LT(std::min(left, right), 0.001f);
        ASSERT_GT(std::min(left, right), -0.001f);
        highest_m = std::max({highest_m, left, right});
        const BodyFrames& f = couple.frames(role);
        for (const Tip tip : {Tip::kLeftToes, Tip::kRightToes}) ASSERT_GT(f.tip(tip).y(), -0.001f);
        for (const Bone foot : {Bone::kLeftFoot, Bone::kRightFoot})
          ASSERT_GT(f.position(foot).y(), 0.06f);
      }
    }
    EXPECT_GT(highest_m, 0.03f);
    EXPECT_LT(highest_m, 0.12f);
  }
}

TEST(SalsaFeet, LandOnTheBeat) {
  // A foot that steps on a count is in the air a third of a beat before and stands right after.
  SalsaCouple couple(salsa_style(3));
  for (int beat = 8; beat < 136; ++beat) {
    const int count = beat % 8;
    if (count == 3 || count == 7) continue;
    const bool lead_left = count == 0 || count == 2 || count == 5;
    for (const SalsaRole role : kSalsaRoles) {
      const bool is_left = lead_left == (role == SalsaRole::kLead);
      couple.dance_at_beat(beat - 0.33);
      EXPECT_GT(couple.ball_lift_m(role, is_left), 0.01f) << "count " << count + 1;
      EXPECT_LT(couple.ball_lift_m(role, !is_left), 0.001f) << "count " << count + 1;
      couple.dance_at_beat(beat + 0.01);
      EXPECT_LT(couple.ball_lift_m(role, is_left), 0.001f) << "count " << count + 1;
    }
  }
}

TEST(SalsaLegs, BendAtTheKneeAndReachTheFeet) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SalsaCouple couple(salsa_style(seed, 210.0));
    for (int i = 0; i < 3000; ++i) {
      couple.dance_at(Duration::ms(13 * i));
      for (const SalsaRole role : kSalsaRoles) {
        const BodyFrames& f = couple.frames(role);
        for (const Limb& leg : {kLeftLeg, kRightLeg}) {
          const Vector3f thigh = f.position(leg.lower) - f.position(leg.upper);
          const Vector3f shin = f.position(leg.end) - f.position(leg.lower);
          // The knee is a hinge that bends backward: the shin hangs behind the thigh's line.
          const Vector3f ahead = f.R_WB[index_of(leg.lower)] * Vector3f::UnitZ();
          const double bend =
              kDegreesPerRadian *
              std::acos(std::clamp(thigh.normalized().dot(shin.normalized()), -1.0f, 1.0f));
          ASSERT_GT(bend, 5.0) << "seed " << seed << " beat " << couple.pose(role).music_beats;
          ASSERT_LT(bend, 110.0) << "seed " << seed << " beat " << couple.pose(role).music_beats;
          ASSERT_GT(thigh.normalized().dot(ahead), 0.0f);
        }
      }
    }
  }
}

struct Extremes {
  std::array<double, kBoneCount> turning_deg_per_s{};
  std::array<double, kBoneCount> speed_m_per_s{};
  std::array<double, kBoneCount> acceleration_m_per_s2{};
};

// The fastest of each bone of lead and follow in twenty seconds, between frames 4 ms apart.
std::array<Extremes, 2> extremes_of(const SalsaStyle& style) {
  constexpr double kStep_s = 0.004;
  const auto most = [](double& value, double candidate) { value = std::max(value, candidate); };
  SalsaCouple couple(style);
  std::array<Extremes, 2> extremes;
  std::array<std::array<BodyFrames, 3>, 2> frames;
  std::array<Pose, 2> before;
  for (int i = 0; i < 5000; ++i) {
    couple.dance_at(Duration::seconds(kStep_s * i));
    for (std::size_t k = 0; k < 2; ++k) {
      std::rotate(frames[k].begin(), frames[k].begin() + 1, frames[k].end());
      frames[k][2] = couple.frames(kSalsaRoles[k]);
      const Pose last = std::exchange(before[k], couple.pose(kSalsaRoles[k]));
      if (i < 2) continue;
      for (std::size_t b = 0; b < kBoneCount; ++b) {
        most(extremes[k].turning_deg_per_s[b],
             kDegreesPerRadian * before[k].R_PB[b].angularDistance(last.R_PB[b]) / kStep_s);
        const Vector3f step = frames[k][2].p_WB_m[b] - frames[k][1].p_WB_m[b];
        const Vector3f step_before = frames[k][1].p_WB_m[b] - frames[k][0].p_WB_m[b];
        most(extremes[k].speed_m_per_s[b], static_cast<double>(step.norm()) / kStep_s);
        most(extremes[k].acceleration_m_per_s2[b],
             static_cast<double>((step - step_before).norm()) / (kStep_s * kStep_s));
      }
    }
  }
  return extremes;
}

bool is_leg(std::size_t bone) {
  return bone >= index_of(Bone::kLeftLowerLeg) && bone != index_of(Bone::kRightUpperLeg);
}

TEST(SalsaMotion, IsNoFasterThanPeopleAre) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    for (const double tempo : {150.0, 184.0, 220.0}) {
      for (const Extremes& extremes : extremes_of(salsa_style(seed, tempo))) {
        for (std::size_t b = 0; b < kBoneCount; ++b) {
          const auto where = [&] {
            return std::string(kBones[b].name) + " seed " + std::to_string(seed) + " tempo " +
                   std::to_string(tempo);
          };
          EXPECT_LT(extremes.turning_deg_per_s[b], 900.0) << where();
          EXPECT_LT(extremes.speed_m_per_s[b], 6.0) << where();
          // Knees, ankles and toes swing; the rest of the body flows.
          EXPECT_LT(extremes.acceleration_m_per_s2[b], is_leg(b) ? 150.0 : 60.0) << where();
        }
        EXPECT_GT(extremes.speed_m_per_s[0], 0.2) << "it does dance";
      }
    }
  }
}

// How much higher the left hip joint is than the right one, rad: Cuban motion.
std::vector<double> hip_roll(SalsaRole role, double tempo_bpm, double hz, int count) {
  SalsaCouple couple(salsa_style(21, tempo_bpm));
  std::vector<double> roll;
  for (int i = 0; i < count; ++i) {
    couple.dance_at(Duration::seconds(i / hz));
    const Vector3f left = couple.pose(role).R_PB[0] * Vector3f::UnitX();
    roll.push_back(std::asin(static_cast<double>(left.y())));
  }
  return roll;
}

double correlation(const std::vector<double>& x, std::size_t lag) {
  double sum = 0.0;
  double power = 0.0;
  for (std::size_t i = 0; i + lag < x.size(); ++i) {
    sum += x[i] * x[i + lag];
    power += 0.5 * (x[i] * x[i] + x[i + lag] * x[i + lag]);
  }
  return sum / power;
}

TEST(SalsaMotion, HasHipsThatRepeatEveryEightBeatsOfTheTempo) {
  constexpr double kRate_hz = 100.0;
  for (const double tempo : {150.0, 184.0, 205.0}) {
    for (const SalsaRole role : kSalsaRoles) {
      const std::vector<double> roll = hip_roll(role, tempo, kRate_hz, 9000);
      const double beat = kRate_hz * 60.0 / tempo;  // in samples
      std::size_t best = 0;
      double best_correlation = -1.0;
      for (auto lag = static_cast<std::size_t>(5.0 * beat);
           lag < static_cast<std::size_t>(11.0 * beat); ++lag) {
        const double candidate = correlation(roll, lag);
        if (candidate <= best_correlation) continue;
        best = lag;
        best_correlation = candidate;
      }
      EXPECT_NEAR(static_cast<double>(best) / beat, 8.0, 0.08) << tempo;
      EXPECT_GT(best_correlation, 0.8);
      // Right and left change over in the second half of each eight.
      EXPECT_LT(correlation(roll, static_cast<std::size_t>(4.0 * beat)), -0.6);
    }
  }
}

TEST(SalsaMotion, LiftsTheHipOfTheStandingLeg) {
  SalsaCouple couple(salsa_style(2));
  for (int eight = 0; eight < 16; ++eight) {
    // On "3 and" he has stood on his left foot for half a beat, she on her right.
    couple.dance_at_beat(8.0 * eight + 2.9);
    const auto lift_m = [&](SalsaRole role) {
      const BodyFrames& f = couple.frames(role);
      return f.position(Bone::kLeftUpperLeg).y() - f.position(Bone::kRightUpperLeg).y();
    };
    EXPECT_GT(lift_m(SalsaRole::kLead), 0.01f);
    EXPECT_LT(lift_m(SalsaRole::kFollow), -0.01f);
    couple.dance_at_beat(8.0 * eight + 6.9);
    EXPECT_LT(lift_m(SalsaRole::kLead), -0.005f);
    EXPECT_GT(lift_m(SalsaRole::kFollow), 0.005f);
  }
}

TEST(SalsaMotion, GrowsWithItsEnergy) {
  const auto largest_roll = [](double energy) {
    SalsaStyle style = salsa_style(5);
    style.energy = energy;
    SalsaCouple couple(style);
    float largest = 0.0f;
    for (int i = 0; i < 500; ++i) {
      couple.dance_at(Duration::ms(20 * i));
      largest = std::max(largest,
                         std::abs((couple.pose(SalsaRole::kLead).R_PB[0] * Vector3f::UnitX()).y()));
    }
    return largest;
  };
  EXPECT_LT(largest_roll(0.3), 0.6f * largest_roll(1.0));
  EXPECT_LT(largest_roll(1.0), 0.8f * largest_roll(1.5));
}

TEST(SalsaMotion, LooksAtThePartner) {
  SalsaCouple couple(salsa_style(12));
  for (int i = 0; i < 64; ++i) {
    const double beat = 8.0 * (i / 4) + 1.0 + 0.5 * (i % 4);  // the first half of each eight
    couple.dance_at_beat(beat);
    for (const SalsaRole role : kSalsaRoles) {
      const SalsaRole other = role == SalsaRole::kLead ? SalsaRole::kFollow : SalsaRole::kLead;
      const BodyFrames& f = couple.frames(role);
      const Vector3f gaze = f.R_WB[index_of(Bone::kHead)] * Vector3f::UnitZ();
      const Vector3f to =
          (couple.frames(other).position(Bone::kHead) - f.position(Bone::kHead)).normalized();
      EXPECT_GT(gaze.dot(to), 0.85f) << "beat " << beat;
    }
  }
}

}  // namespace
}  // namespace dance
