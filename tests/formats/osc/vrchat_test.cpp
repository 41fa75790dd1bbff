#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "formats/osc/tracker_angles.h"
#include "formats/osc/unity_axes.h"
#include "formats/osc/vrchat_writer.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/formats/osc/decoded_osc.h"

namespace dance {
namespace {

TEST(TrackerAngles, AreThoseOfZThenXThenY) {
  // Unity's Quaternion.Euler(30, 40, 50), as its documentation's order makes it: y · x · z.
  const Eigen::Quaternionf R = rotation_of_angles({30.0f, 40.0f, 50.0f});
  TrackerAngles angles;
  const Eigen::Vector3f found = angles.follow(R);
  EXPECT_NEAR(found.x(), 30.0f, 1e-3f);
  EXPECT_NEAR(found.y(), 40.0f, 1e-3f);
  EXPECT_NEAR(found.z(), 50.0f, 1e-3f);
  // z alone turns x to y; then x alone turns y to z; then y alone turns z to x.
  const Eigen::Vector3f v = rotation_of_angles({90.0f, 90.0f, 90.0f}) * Eigen::Vector3f::UnitX();
  EXPECT_LT((v - Eigen::Vector3f::UnitX()).norm(), 1e-5f);
}

TEST(TrackerAngles, GiveTheSameRotationAgain) {
  Random random(3);
  TrackerAngles angles;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Quaternionf R = random_rotation(random);
    EXPECT_TRUE(is_same_rotation(rotation_of_angles(angles.follow(R)), R, 2e-3f)) << i;
  }
  for (const float x : {90.0f, -90.0f})
    for (const float y : {-170.0f, 0.0f, 35.0f})
      for (const float z : {0.0f, 80.0f, -120.0f}) {
        const Eigen::Quaternionf R = rotation_of_angles({x, y, z});
        EXPECT_TRUE(is_same_rotation(rotation_of_angles(angles.follow(R)), R, 2e-3f)) << x << y;
      }
}

TEST(TrackerAngles, RunOnWithoutJumpsThroughTurnsAndSomersaults) {
  for (int axis = 0; axis < 3; ++axis) {
    TrackerAngles angles;
    Eigen::Vector3f last = Eigen::Vector3f::Zero();
    // Eighteen turns in steps of two degrees, about each axis.
    for (int step = 0; step <= 18 * 180; ++step) {
      Eigen::Vector3f told = Eigen::Vector3f(10.0f, 20.0f, 5.0f);
      told[axis] += 2.0f * static_cast<float>(step);
      const Eigen::Vector3f found = angles.follow(rotation_of_angles(told));
      if (step > 0) {
        EXPECT_LT((found - last).norm(), 2.5f) << axis << " " << step;
      }
      last = found;
    }
    EXPECT_NEAR(std::abs(last[axis]), 18.0f * 360.0f, 30.0f);
  }
}

TEST(TrackerAngles, StayExactHoweverLongADancerSpins) {
  TrackerAngles angles;
  for (int step = 0; step < 100'000; ++step) {
    const float y_deg = std::fmod(10.0f * static_cast<float>(step), 360.0f);
    const Eigen::Quaternionf R = rotation_of_angles({0.0f, y_deg, 0.0f});
    const Eigen::Vector3f found = angles.follow(R);
    ASSERT_LE(std::abs(found.y()), 7200.0f + 10.0f);
    if (step % 1000 == 0) {
      EXPECT_TRUE(is_same_rotation(rotation_of_angles(found), R, 2e-3f)) << step;
    }
  }
}

std::map<std::string, Eigen::Vector3f> trackers_of(const KeptPackets& kept) {
  std::map<std::string, Eigen::Vector3f> trackers;
  for (const DecodedOsc& message : kept.decoded()) {
    EXPECT_EQ(message.types, "fff") << message.address;
    trackers[message.address] = {message.floats[0], message.floats[1], message.floats[2]};
  }
  return trackers;
}

TEST(VrchatWriter, PutsATrackerAtEachJointInOnePacket) {
  KeptPackets kept;
  VrchatWriter writer(kept);
  const Skeleton skeleton = average_skeleton(1.8f);
  writer.set_skeleton(skeleton);
  Pose pose;
  pose.p_WH_m = {1.0f, skeleton.hips_height_m(), 2.0f};
  writer.write_pose(pose);
  EXPECT_EQ(kept.packets.size(), 1u);
  EXPECT_EQ(kept.packets.at(0).size(), 1032u);
  const auto trackers = trackers_of(kept);
  ASSERT_EQ(trackers.size(), 18u);
  const auto at = [&](const std::string& name) {
    return trackers.at("/tracking/trackers/" + name + "/position");
  };
  for (const auto& [address, value] : trackers) {
    if (address.ends_with("rotation")) {
      EXPECT_LT(value.norm(), 1e-3f) << address;
    }
  }
  EXPECT_LT((at("1") - Eigen::Vector3f(-1.0f, skeleton.hips_height_m(), 2.0f)).norm(), 1e-5f);
  // Left is -X in Unity's axes, seen from the hips.
  EXPECT_LT(at("3").x(), at("1").x());
  EXPECT_GT(at("4").x(), at("1").x());
  EXPECT_LT(at("5").x(), at("6").x());
  EXPECT_LT(at("7").x(), at("8").x());
  EXPECT_LT(at("3").y(), at("5").y());
  EXPECT_LT(at("5").y(), at("1").y());
  EXPECT_LT(at("1").y(), at("2").y());
  EXPECT_LT(at("2").y(), at("head").y());
}

TEST(VrchatWriter, TurnsTrackersWithTheBonesThatTheyAreStrappedTo) {
  Random random(17);
  KeptPackets kept;
  VrchatWriter writer(kept);
  for (int i = 0; i < 50; ++i) {
    kept.packets.clear();
    const Pose pose = random_pose(random);
    writer.write_pose(pose);
    BodyFrames frames;
    forward_kinematics(average_skeleton(), pose, frames);
    const auto trackers = trackers_of(kept);
    for (const VrchatTracker& tracker : kVrchatTrackers) {
      const Eigen::Vector3f p = other_hand(trackers.at(tracker.position_address));
      EXPECT_LT((p - frames.position(tracker.joint)).norm(), 1e-5f) << tracker.position_address;
      const auto R = other_hand(rotation_of_angles(trackers.at(tracker.rotation_address)));
      EXPECT_TRUE(is_same_rotation(R, frames.R_WB[index_of(tracker.strap)], 2e-3f))
          << tracker.rotation_address;
    }
  }
}

TEST(VrchatWriter, AllocatesNothingPerPose) {
  class Bytes : public OscPacketSink {
   public:
    void on_packet(std::span<const std::uint8_t> packet) override { count += packet.size(); }
    std::size_t count = 0;
  } bytes;
  VrchatWriter writer(bytes);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) writer.write_pose(Pose());
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(bytes.count, 100u * 1032u);
}

}  // namespace
}  // namespace dance
