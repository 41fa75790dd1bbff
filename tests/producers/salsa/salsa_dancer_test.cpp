#include "producers/salsa/salsa_dancer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/base/random.h"
#include "tests/allocation_guard.h"
#include "tests/producers/salsa/salsa_couple.h"

namespace dance {
namespace {

using Eigen::Vector3f;

bool same_bits(const Pose& a, const Pose& b) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (a.R_PB[i].coeffs() != b.R_PB[i].coeffs()) return false;
  return a.p_WH_m == b.p_WH_m && a.music_beats == b.music_beats && a.presence == b.presence;
}

TEST(SalsaDancer, GivesValidPosesForManySeedsAndTempos) {
  Random random(20);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const double tempo : {60.0, 150.0, 184.0, 220.0, 240.0}) {
      SalsaStyle style = salsa_style(seed, tempo);
      style.energy = random.uniform(0.0, 1.5);
      style.start_beat = random.uniform(-1000.0, 100000.0);
      SalsaCouple couple(style);
      for (int i = 0; i < 150; ++i) {
        couple.dance_at(Duration::seconds(random.uniform(0.0, 600.0)));
        for (const SalsaRole role : kSalsaRoles) {
          ASSERT_TRUE(is_valid(couple.pose(role))) << "seed " << seed << " tempo " << tempo;
          EXPECT_EQ(couple.pose(role).presence, kAllBones);
          for (const auto& q : couple.pose(role).R_PB) ASSERT_NEAR(q.norm(), 1.0f, 1e-4f);
        }
      }
    }
  }
}

TEST(SalsaDancer, IsAFunctionOfTimeAlone) {
  SalsaDancer forth(salsa_style(9));
  SalsaDancer back(salsa_style(9));
  std::vector<Pose> poses(600);
  for (int i = 0; i < 600; ++i)
    forth.dance_at(Duration::ms(33 * i), poses[static_cast<std::size_t>(i)]);
  for (int i = 599; i >= 0; --i) {
    Pose pose;
    back.dance_at(Duration::ms(33 * i), pose);
    ASSERT_TRUE(same_bits(pose, poses[static_cast<std::size_t>(i)])) << "frame " << i;
  }
}

TEST(SalsaDancer, DancesDifferentlyForAnotherSeed) {
  SalsaDancer one(salsa_style(1));
  SalsaDancer two(salsa_style(2));
  double largest_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    Pose a;
    Pose b;
    one.dance_at(Duration::ms(100 * i), a);
    two.dance_at(Duration::ms(100 * i), b);
    largest_m = std::max(largest_m, static_cast<double>((a.p_WH_m - b.p_WH_m).norm()));
  }
  EXPECT_GT(largest_m, 0.2);
}

TEST(SalsaDancer, CarriesTheMusicalTimeOfItsTempo) {
  SalsaStyle style = salsa_style(1, 180.0);
  style.start_beat = 12.5;
  SalsaDancer dancer(style);
  Pose pose;
  dancer.dance_at(Duration::s(10), pose);
  EXPECT_DOUBLE_EQ(pose.music_beats, 42.5);
}

TEST(SalsaDancer, DancesToWhatIsHeardAndGoesOnAloneWhereItEnds) {
  SalsaStyle style = salsa_style(1, 180.0);
  SalsaDancer deaf(style), dancer(style);
  const MonoTime start = MonoTime::from_us(5'000'000);
  BeatClock music;
  dancer.listen_to(music, start);
  Pose pose, other;
  dancer.dance_at(Duration::s(2), pose);
  EXPECT_DOUBLE_EQ(pose.music_beats, 6.0) << "nothing is heard yet";
  EXPECT_FALSE(dancer.is_moved_to_music(Duration::s(2)));
  Beat beat;
  beat.time = beat.beat_time = start + Duration::s(2);
  beat.beat = 20.0;
  beat.tempo_bpm = 200.0;
  beat.playing = true;
  music.hear(beat);
  dancer.dance_at(Duration::ms(2300), pose);
  EXPECT_NEAR(pose.music_beats, 21.0, 1e-9);
  EXPECT_TRUE(dancer.is_moved_to_music(Duration::ms(2300)));
  EXPECT_FALSE(deaf.is_moved_to_music(Duration::ms(2300)));
  deaf.dance_at(Duration::s(7), other);  // its beat 21
  EXPECT_NEAR((pose.p_WH_m - other.p_WH_m).norm(), 0.0f, 0.01f) << "the same step";
  dancer.dance_at(Duration::s(9), pose);
  EXPECT_DOUBLE_EQ(pose.music_beats, 27.0);
}

TEST(SalsaDancer, DancesTheSameWhereverTheCoupleIsPlaced) {
  SalsaStyle placed = salsa_style(4);
  placed.x_m = 3.0;
  placed.z_m = -2.0;
  placed.heading_deg = 75.0;
  const Eigen::Quaternionf turn(
      Eigen::AngleAxisf(static_cast<float>(75.0 / kDegreesPerRadian), Vector3f::UnitY()));
  SalsaCouple here(salsa_style(4));
  SalsaCouple there(placed);
  for (int i = 0; i < 300; ++i) {
    here.dance_at(Duration::ms(70 * i));
    there.dance_at(Duration::ms(70 * i));
    for (const SalsaRole role : kSalsaRoles)
      for (std::size_t b = 0; b < kBoneCount; ++b) {
        const Vector3f expected = turn * here.frames(role).p_WB_m[b] + Vector3f(3.0f, 0.0f, -2.0f);
        ASSERT_LT((there.frames(role).p_WB_m[b] - expected).norm(), 0.002f) << kBones[b].name;
      }
  }
}

TEST(SalsaDancer, AllocatesNothingWhileItDances) {
  SalsaDancer dancer(salsa_style(1));
  Pose pose;
  Hands hands;
  const AllocationGuard guard;
  for (int i = 0; i < 500; ++i) {
    dancer.dance_at(Duration::ms(50 * i), pose);
    dancer.hands_at(Duration::ms(50 * i), hands);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(SalsaCouple, KeepsHoldingHands) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SalsaCouple couple(salsa_style(seed, 150.0 + 8.0 * static_cast<double>(seed)));
    int joined = 0;
    for (int i = 0; i < 1500; ++i) {
      couple.dance_at(Duration::ms(41 * i));
      const Vector3f his = couple.palm(SalsaRole::kLead, true);
      ASSERT_LT((his - couple.palm(SalsaRole::kFollow, false)).norm(), 0.01f)
          << "seed " << seed << " beat " << couple.pose(SalsaRole::kLead).music_beats;
      if (couple.hold().joined < 0.999) continue;
      ++joined;
      const Vector3f other = couple.palm(SalsaRole::kLead, false);
      ASSERT_LT((other - couple.palm(SalsaRole::kFollow, true)).norm(), 0.01f)
          << "seed " << seed << " beat " << couple.pose(SalsaRole::kLead).music_beats;
    }
    EXPECT_GT(joined, 150);
  }
}

TEST(SalsaCouple, RaisesTheHandsOverHerHeadInTheTurn) {
  SalsaCouple couple(salsa_style(1));
  std::int64_t eight = 0;
  while (couple.score().figure(eight) != SalsaFigure::kRightTurn) ++eight;
  couple.dance_at_beat(8.0 * static_cast<double>(eight) + 5.0);
  EXPECT_GT(couple.palm(SalsaRole::kFollow, false).y(),
            couple.frames(SalsaRole::kFollow).tip(Tip::kHead).y());
  couple.dance_at_beat(8.0 * static_cast<double>(eight) + 0.5);
  EXPECT_LT(couple.palm(SalsaRole::kFollow, false).y(),
            couple.frames(SalsaRole::kFollow).position(Bone::kHead).y());
}

TEST(SalsaCouple, EmbracesInClosedHold) {
  SalsaCouple couple(salsa_style(2));
  int embraced = 0;
  for (int i = 0; i < 3000; ++i) {
    couple.dance_at(Duration::ms(30 * i));
    if (couple.hold().embrace < 0.999) continue;
    ++embraced;
    // His right hand is at her left side, her left hand on his right shoulder.
    const Vector3f blade = couple.frames(SalsaRole::kFollow).position(Bone::kLeftUpperArm);
    const Vector3f deltoid = couple.frames(SalsaRole::kLead).position(Bone::kRightUpperArm);
    EXPECT_LT((couple.palm(SalsaRole::kLead, false) - blade).norm(), 0.25f);
    EXPECT_LT((couple.palm(SalsaRole::kFollow, true) - deltoid).norm(), 0.15f);
  }
  EXPECT_GT(embraced, 200);
}

TEST(SalsaCouple, StaysTogetherFaceToFaceButInTheTravellingFigures) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SalsaCouple couple(salsa_style(seed, 190.0));
    int faced = 0;
    for (double beat = 0.0; beat < 256.0; beat += 0.2) {
      couple.dance_at_beat(beat);
      const Vector3f d = couple.between();
      ASSERT_GT(d.norm(), 0.5f) << "seed " << seed << " beat " << beat;
      ASSERT_LT(d.norm(), 1.3f) << "seed " << seed << " beat " << beat;
      const auto eight = static_cast<std::int64_t>(beat / 8.0);
      const auto travels = [&](std::int64_t k) {
        const SalsaFigure f = couple.score().figure(k);
        return f == SalsaFigure::kCrossBodyLead || f == SalsaFigure::kRightTurn;
      };
      const double count = beat - 8.0 * static_cast<double>(eight);
      if (travels(eight) || (count < 1.5 && eight > 0 && travels(eight - 1))) continue;
      ++faced;
      const double to_her = kDegreesPerRadian * std::atan2(d.x(), d.z());
      ASSERT_LT(std::abs(std::remainder(couple.yaw_deg(SalsaRole::kLead) - to_her, 360.0)), 35.0);
      ASSERT_LT(
          std::abs(std::remainder(couple.yaw_deg(SalsaRole::kFollow) - to_her - 180.0, 360.0)),
          35.0);
    }
    EXPECT_GT(faced, 400);
  }
}

TEST(SalsaCouple, HasHerTurnOnceAroundToHerRight) {
  SalsaCouple couple(salsa_style(6));
  std::int64_t eight = 0;
  while (couple.score().figure(eight) != SalsaFigure::kRightTurn ||
         couple.score().figure(eight + 1) != SalsaFigure::kBasic)
    ++eight;
  // Her chest against the direction to him: facing him on 3, and again on 3 of the next eight.
  const auto chest_deg = [&] {
    const Vector3f ahead =
        couple.frames(SalsaRole::kFollow).R_WB[index_of(Bone::kUpperChest)] * Vector3f::UnitZ();
    const Vector3f to_him = -couple.between();
    return kDegreesPerRadian *
           (std::atan2(static_cast<double>(ahead.x()), static_cast<double>(ahead.z())) -
            std::atan2(static_cast<double>(to_him.x()), static_cast<double>(to_him.z())));
  };
  const double begin = 8.0 * static_cast<double>(eight) + 2.0;
  couple.dance_at_beat(begin);
  double previous = chest_deg();
  double turned = 0.0;
  for (double beat = begin; beat < begin + 8.0; beat += 0.02) {
    couple.dance_at_beat(beat);
    const double now = chest_deg();
    turned += std::remainder(now - previous, 360.0);
    previous = now;
  }
  EXPECT_NEAR(turned, -360.0, 15.0);
}

TEST(SalsaCouple, ChangesPlacesInTheCrossBodyLead) {
  SalsaCouple couple(salsa_style(8));
  std::int64_t eight = 0;
  while (couple.score().figure(eight) != SalsaFigure::kCrossBodyLead) ++eight;
  couple.dance_at_beat(8.0 * static_cast<double>(eight));
  const Vector3f before = couple.between().normalized();
  couple.dance_at_beat(8.0 * static_cast<double>(eight) + 8.5);
  EXPECT_LT(couple.between().normalized().dot(before), -0.9f);
}

TEST(SalsaDancer, CurlsItsFingersALittle) {
  SalsaDancer dancer(salsa_style(1));
  Hands hands;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(dancer.hands_at(Duration::ms(90 * i), hands));
    ASSERT_TRUE(is_valid(hands));
    EXPECT_EQ(hands.presence, (1u << kFingerBoneCount) - 1);
    for (const auto& q : hands.R_PB) {
      const double curl = kDegreesPerRadian * q.angularDistance(Eigen::Quaternionf::Identity());
      EXPECT_GT(curl, 2.0);
      EXPECT_LT(curl, 60.0);
    }
    // Fingers curl towards the palm, which looks down in T-pose.
    EXPECT_LT((hands.R_PB[3] * Vector3f::UnitX()).y(), 0.0f);
    EXPECT_LT((hands.R_PB[18] * -Vector3f::UnitX()).y(), 0.0f);
  }
}

}  // namespace
}  // namespace dance
