#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/pose/kinematics.h"
#include "formats/osc/vmc_writer.h"
#include "producers/vmc/vmc_receiver.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/formats/osc/decoded_osc.h"
#include "tests/producers/receive/kept_captures.h"

namespace dance {
namespace {

const GuestId kVmcAlice = *GuestId::parse("alice");

MonoTime vmc_time(double ms) { return MonoTime::from_us(9'000'000) + Duration::seconds(ms * 1e-3); }

// A performer of another make than ours: writes what a test wants, in the order that it wants.
class Performer : public OscPacketSink {
 public:
  explicit Performer(VmcIntake& intake) : intake_(intake) {}

  void on_packet(std::span<const std::uint8_t> packet) override { intake_.take(packet, now, now); }
  void bone(const char* name, float x, float y, float z, float qy = 0.0f, float qw = 1.0f) {
    bundle.add("/VMC/Ext/Bone/Pos", {name, x, y, z, 0.0f, qy, 0.0f, qw});
  }
  void root(float x, float y, float z, float qy = 0.0f, float qw = 1.0f) {
    bundle.add("/VMC/Ext/Root/Pos", {"root", x, y, z, 0.0f, qy, 0.0f, qw});
  }
  void time(float s) { bundle.add("/VMC/Ext/T", {s}); }
  void ok() { bundle.add("/VMC/Ext/OK", {std::int32_t{1}}); }
  void apply() { bundle.add("/VMC/Ext/Blend/Apply", {}); }
  void send() { bundle.flush(); }

  OscBundleWriter bundle{*this};
  MonoTime now = vmc_time(0);

 private:
  VmcIntake& intake_;
};

class VmcIntakeTest : public testing::Test {
 protected:
  KeptCaptures kept;
  VmcIntake intake{kVmcAlice, kept};
  Performer performer{intake};
};

TEST_F(VmcIntakeTest, TakesWhatOurSenderSends) {
  Random random(23);
  const Skeleton skeleton = average_skeleton(1.63f);
  VmcWriter writer(performer, VmcDialect::kVrm0);
  writer.set_skeleton(skeleton);
  constexpr int kFrames = 60;
  std::vector<Pose> sent;
  Hands hands;
  for (auto& rotation : hands.R_PB) rotation = random_rotation(random, 1.0f);
  for (int i = 0; i < kFrames; ++i) {
    performer.now = vmc_time(20.0 * i);
    sent.push_back(random_pose(random));
    writer.write_pose(sent.back(), &hands, 0.02f * static_cast<float>(i));
  }
  // Each in the call that brought its last packet.
  ASSERT_EQ(kept.poses.size(), sent.size());
  ASSERT_EQ(kept.hands.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(kept.poses[i].presence, kAllBones);
    EXPECT_LT((kept.poses[i].p_WH_m - sent[i].p_WH_m).norm(), 1e-5f);
    BodyFrames theirs, ours;
    forward_kinematics(kept.skeletons[0].skeleton, kept.poses[i], theirs);
    forward_kinematics(skeleton, sent[i], ours);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_LT((theirs.p_WB_m[b] - ours.p_WB_m[b]).norm(), 1e-5f) << kBones[b].name;
    for (std::size_t t = 0; t < kTipCount; ++t)
      EXPECT_LT((theirs.p_WT_m[t] - ours.p_WT_m[t]).norm(), 1e-3f) << t;
    for (std::size_t f = 0; f < kFingerBoneCount; ++f)
      EXPECT_TRUE(is_same_rotation(kept.hands[i].R_PB[f], hands.R_PB[f])) << kFingerBones[f].name;
  }
  EXPECT_EQ(kept.hands[0].presence, (1u << kFingerBoneCount) - 1);
  EXPECT_NEAR(kept.skeletons[0].skeleton.hips_height_m(), skeleton.hips_height_m(), 1e-4f);
  EXPECT_EQ(intake.malformed(), 0u);
}

TEST_F(VmcIntakeTest, UsesTimesOfArrivalOfAPerformerWhoseClockStandsStill) {
  VmcWriter writer(performer, VmcDialect::kVrm0);
  Random random(2);
  for (int i = 0; i < 185; ++i) {
    performer.now = vmc_time(16.7 * i);
    writer.write_pose(random_pose(random), nullptr, 0.0f);
  }
  EXPECT_GE(kept.poses.size(), 184u);
  EXPECT_EQ(kept.poses.back().capture_time, performer.now);
  EXPECT_TRUE(intake.is_clock_unusable());
}

TEST_F(VmcIntakeTest, KeepsTheSendersRhythmWhateverTheNetworkDoes) {
  VmcWriter writer(performer, VmcDialect::kVrm0);
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    performer.now = vmc_time(20.0 * i + random.uniform(0.0, 12.0));
    writer.write_pose(Pose(), nullptr, 0.02f * static_cast<float>(i));
  }
  ASSERT_GT(kept.poses.size(), 290u);
  for (std::size_t i = 150; i < kept.poses.size(); ++i) {
    const Duration apart = kept.poses[i].capture_time - kept.poses[i - 1].capture_time;
    EXPECT_NEAR(apart.as_ms(), 20.0, 0.1) << i;
  }
}

// The orders of other performers, each twice: time first and nothing at the end, as SlimeVR; all
// marks at the end, as VirtualMotionCapture; no marks at all.
TEST_F(VmcIntakeTest, CompletesFramesWithoutWaitingWhateverTheirOrder) {
  for (int i = 0; i < 4; ++i) {
    performer.now = vmc_time(20.0 * i);
    performer.time(5.0f + 0.02f * static_cast<float>(i));
    performer.bone("Hips", 0, 1, 0);
    performer.bone("Head", 0, 0.2f, 0);
    performer.send();
    // The first is known to be complete when the second begins.
    EXPECT_EQ(kept.poses.size(), i == 0 ? 0u : static_cast<std::size_t>(i + 1));
  }
  EXPECT_NEAR((kept.poses[3].capture_time - kept.poses[2].capture_time).as_ms(), 20.0, 0.1);
  KeptCaptures of_second;
  VmcIntake second_intake(kVmcAlice, of_second);
  Performer second(second_intake);
  for (int i = 0; i < 4; ++i) {
    second.now = vmc_time(20.0 * i);
    second.bone("Hips", 0, 1, 0);
    second.send();
    second.bone("Head", 0, 0.2f, 0);
    second.send();
    second.apply();
    second.ok();
    second.time(5.0f + 0.02f * static_cast<float>(i));
    second.send();
    EXPECT_EQ(of_second.poses.size(), static_cast<std::size_t>(i + 1));
    EXPECT_EQ(of_second.poses.back().presence,
              1u << index_of(Bone::kHips) | 1u << index_of(Bone::kHead));
  }
  KeptCaptures of_third;
  VmcIntake third_intake(kVmcAlice, of_third);
  Performer third(third_intake);
  for (int i = 0; i < 4; ++i) {
    third.now = vmc_time(20.0 * i);
    third.bone("Hips", 0, 1, 0);
    third.bone("Head", 0, 0.2f, 0);
    third.send();
  }
  EXPECT_EQ(of_third.poses.size(), 4u);
}

TEST_F(VmcIntakeTest, ShowsALostPacketAsMissingBonesAndGoesOn) {
  for (int i = 0; i < 10; ++i) {
    performer.now = vmc_time(20.0 * i);
    performer.time(0.02f * static_cast<float>(i));
    performer.bone("Hips", 0, 1, 0);
    performer.bone("Spine", 0, 0.1f, 0);
    performer.send();
    if (i == 5) continue;  // lost
    performer.bone("Head", 0, 0.2f, 0);
    performer.apply();
    performer.send();
  }
  ASSERT_EQ(kept.poses.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_EQ((kept.poses[i].presence >> index_of(Bone::kHead)) & 1u, i == 5 ? 0u : 1u) << i;
}

TEST_F(VmcIntakeTest, PutsRootAndHipsTogether) {
  const float half = std::sqrt(0.5f);
  performer.root(3.0f, 0.0f, 0.0f, half, half);  // a quarter turn, in Unity's axes
  performer.bone("Hips", 0.0f, 0.9f, 1.0f);
  performer.apply();
  performer.send();
  ASSERT_EQ(kept.poses.size(), 1u);
  // In Unity +Z turns to +X by +90 degrees about Y: hips at x = 3 + 1; in W at -4.
  EXPECT_LT((kept.poses[0].p_WH_m - Eigen::Vector3f(-4.0f, 0.9f, 0.0f)).norm(), 1e-5f);
  const Eigen::Vector3f forward = kept.poses[0].R_PB[0] * Eigen::Vector3f::UnitZ();
  EXPECT_LT((forward - Eigen::Vector3f(-1, 0, 0)).norm(), 1e-5f);
}

TEST_F(VmcIntakeTest, StandsDancersOfSendersWithoutPositionsOnTheFloor) {
  performer.bone("Hips", 0, 0, 0);
  performer.bone("LeftUpperLeg", 0, 0, 0);
  performer.bone("LeftLowerLeg", 0, 0, 0);
  performer.apply();
  performer.send();
  ASSERT_EQ(kept.poses.size(), 1u);
  EXPECT_NEAR(kept.poses[0].p_WH_m.y(), average_skeleton().hips_height_m(), 1e-4f);
  EXPECT_EQ(kept.skeletons[0].skeleton.offset_m, average_skeleton().offset_m);
}

TEST_F(VmcIntakeTest, ScalesAnAverageBodyToTheHipsWhereOnlyTheseHaveAPlace) {
  for (int i = 0; i < 20; ++i) {
    performer.now = vmc_time(100.0 * i);
    performer.bone("Hips", 0, i < 5 ? 0.6f : 0.8f, 0);  // rises from a crouch
    performer.bone("Spine", 0, 0, 0);
    performer.apply();
    performer.send();
  }
  const Skeleton& last = intake.dancer().skeleton();
  EXPECT_NEAR(last.hips_height_m(), 0.8f, 1e-3f);
  EXPECT_NEAR(standing_height_m(last) / last.hips_height_m(),
              standing_height_m(average_skeleton()) / average_skeleton().hips_height_m(), 1e-3f);
}

TEST_F(VmcIntakeTest, KnowsTheFingersOfBothVrms) {
  const float half = std::sqrt(0.5f);
  performer.bone("hips", 0, 1, 0);
  performer.bone("leftThumbMetacarpal", 0, 0, 0, half, half);
  performer.bone("leftThumbProximal", 0, 0, 0);
  performer.apply();
  performer.send();
  performer.now = vmc_time(20);
  performer.bone("Hips", 0, 1, 0);
  performer.bone("LeftThumbIntermediate", 0, 0, 0);
  performer.bone("LeftThumbProximal", 0, 0, 0, half, half);
  performer.apply();
  performer.send();
  ASSERT_EQ(kept.hands.size(), 2u);
  for (const Hands& hands : kept.hands) {
    EXPECT_EQ(hands.presence, 0b11u);
    EXPECT_NEAR(hands.R_PB[0].w(), half, 1e-5f);
    EXPECT_NEAR(hands.R_PB[1].w(), 1.0f, 1e-5f);
  }
}

TEST_F(VmcIntakeTest, CountsWhatItCannotUse) {
  performer.bone("Tail", 0, 1, 0);
  performer.bone("LeftEye", 0, 1, 0);
  performer.bundle.add("/VMC/Ext/Bone/Pos", {"Hips", 0.0f});
  performer.bundle.add("/VMC/Ext/Cam", {"Camera", 0.0f});
  performer.apply();
  performer.send();
  intake.take({}, vmc_time(1), vmc_time(1));
  EXPECT_TRUE(kept.poses.empty());
  EXPECT_EQ(intake.malformed(), 1u);
  EXPECT_EQ(
      intake.summary(),
      "vmc: 0 poses of alice; 1 packets that are no Open Sound Control; 1 malformed messages; "
      "1 bones of unknown names");
}

TEST_F(VmcIntakeTest, SurvivesEveryPrefixAndEveryFlippedBit) {
  KeptPackets packets;
  VmcWriter writer(packets, VmcDialect::kVrm0);
  writer.write_pose(Pose(), nullptr, 1.0f);
  std::int64_t us = 0;
  const auto take = [&](const std::vector<std::uint8_t>& packet) {
    const MonoTime now = vmc_time(0) + Duration::us(++us * 100);
    intake.take(packet, now, now);
  };
  const std::vector<std::uint8_t>& whole = packets.packets[0];
  for (std::size_t n = 0; n <= whole.size(); ++n)
    take({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)});
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::vector<std::uint8_t> flipped = whole;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    take(flipped);
  }
  for (const Pose& pose : kept.poses) EXPECT_TRUE(is_valid(pose));
  for (const TimedSkeleton& timed : kept.skeletons) EXPECT_TRUE(is_valid(timed.skeleton));
  EXPECT_GT(intake.packets().damaged, 100u);
}

TEST(VmcIntakePath, AllocatesNothingPerPose) {
  LastCapture last;
  VmcIntake intake(kVmcAlice, last);
  Performer performer(intake);
  VmcWriter writer(performer, VmcDialect::kVrm0);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    performer.now = vmc_time(20.0 * i);
    writer.write_pose(Pose(), nullptr, 0.02f * static_cast<float>(i));
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(last.count, 100);
}

}  // namespace
}  // namespace dance
