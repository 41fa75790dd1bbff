#include "producers/engine/engine_receiver.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <limits>
#include <vector>

#include "consumers/engine/dance_adapter.h"
#include "core/net/local_address.h"
#include "core/net/mono_clock.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

// What the house would publish.
class Captured final : public CaptureSink {
 public:
  void capture(const GuestId&, Pose& pose, MonoTime) override {
    if (skeletons == 0) ++poses_without_skeleton;
    ++poses;
    pose_ = pose;
  }
  void capture(const GuestId&, const Hands& hands) override {
    ++fingers;
    hands_ = hands;
  }
  void capture(const GuestId&, const TimedSkeleton& timed) override {
    ++skeletons;
    skeleton_ = timed.skeleton;
  }
  int poses = 0, fingers = 0, skeletons = 0, poses_without_skeleton = 0;
  Pose pose_;
  Hands hands_;
  Skeleton skeleton_;
};

class EngineReceiverTest : public testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    poller_ = std::move(*Poller::create());
    open();
    pose_.struct_size = sizeof pose_;
    for (auto& q : pose_.rotation) q[3] = 1.0f;
    pose_.hips_position[1] = 0.9f;
    pose_.presence = kAllBones;
    pose_.confidence = 1.0f;
    producer_ = dance_producer_open(nullptr, DANCE_AXES_GLTF);
  }
  void TearDown() override { dance_producer_close(producer_); }

  void open() {
    auto receiver = EngineReceiver::open("", *GuestId::parse("alice"), captured_, *poller_);
    ASSERT_TRUE(receiver) << receiver.error().what;
    receiver_ = std::move(*receiver);
  }
  void turn() { poller_->run_once(Duration::ms(1)); }
  dance_status send(std::int64_t capture_ns = 0) {
    pose_.capture_ns = capture_ns;
    const dance_status status = dance_producer_pose(producer_, &pose_);
    turn();
    return status;
  }

  TestFolder folder_{"engine-receiver"};
  Captured captured_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<EngineReceiver> receiver_;
  dance_pose pose_{};
  dance_producer* producer_ = nullptr;
};

TEST_F(EngineReceiverTest, AnEnginesPoseIsACaptureInTheSameTurn) {
  Random random(1);
  const Eigen::Quaternionf turned = random_rotation(random);
  Eigen::Vector4f::Map(pose_.rotation[9]) = turned.coeffs();
  const std::int64_t captured_ns = dance_adapter_now_ns() - 4'000'000;
  ASSERT_EQ(send(captured_ns), DANCE_OK);
  ASSERT_EQ(captured_.poses, 1);
  EXPECT_EQ(captured_.poses_without_skeleton, 0);
  EXPECT_TRUE(is_same_rotation(captured_.pose_.R_PB[9], turned));
  EXPECT_EQ(captured_.pose_.capture_time.since_zero_ns(), captured_ns);
  EXPECT_EQ(captured_.pose_.clock_id, this_clock_id());
  const std::uint32_t first = captured_.pose_.sequence;
  ASSERT_EQ(send(), DANCE_OK);
  EXPECT_EQ(captured_.pose_.sequence, first + 1);
  EXPECT_EQ(receiver_->summary(), "2 poses of alice");
}

TEST_F(EngineReceiverTest, TheEnginesAxesBecomeOurs) {
  dance_producer* unreal = dance_producer_open(nullptr, DANCE_AXES_UNREAL);
  // A hundred centimetres forward, ninety up; a quarter turn to the left seen from above.
  pose_.hips_position[0] = 100.0f;
  pose_.hips_position[1] = 0.0f;
  pose_.hips_position[2] = 90.0f;
  const float half = std::sqrt(0.5f);
  const float to_the_right[4] = {0.0f, 0.0f, half, half};  // left-handed about up
  std::copy(std::begin(to_the_right), std::end(to_the_right), pose_.rotation[0]);
  ASSERT_EQ(dance_producer_pose(unreal, &pose_), DANCE_OK);
  turn();
  EXPECT_TRUE(captured_.pose_.p_WH_m.isApprox(Eigen::Vector3f(0.0f, 0.9f, 1.0f), 1e-5f));
  const Eigen::Vector3f faces = captured_.pose_.R_PB[0] * Eigen::Vector3f::UnitZ();
  EXPECT_TRUE(faces.isApprox(Eigen::Vector3f(-1, 0, 0), 1e-5f)) << "+Y of Unreal is the right";
  dance_producer_close(unreal);
}

TEST_F(EngineReceiverTest, ProportionsComeBeforePosesAndAreTold) {
  dance_skeleton body{};
  body.struct_size = sizeof body;
  const Skeleton small = average_skeleton(1.3f);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    Eigen::Vector3f::Map(body.offset[b]) = small.offset_m[b];
  for (std::size_t t = 0; t < kTipCount; ++t) Eigen::Vector3f::Map(body.tip[t]) = small.tip_m[t];
  ASSERT_EQ(dance_producer_skeleton(producer_, &body), DANCE_OK);
  ASSERT_EQ(send(), DANCE_OK);
  EXPECT_EQ(captured_.skeletons, 1);
  EXPECT_EQ(captured_.skeleton_.offset_m, small.offset_m);
  body.offset[4][1] = 5.0f;
  EXPECT_EQ(dance_producer_skeleton(producer_, &body), DANCE_INVALID);
}

TEST_F(EngineReceiverTest, FingersGoWithThePoseBeforeThem) {
  dance_hands hands{};
  hands.struct_size = sizeof hands;
  for (auto& q : hands.rotation) q[3] = 1.0f;
  hands.presence = 7;
  ASSERT_EQ(dance_producer_hands(producer_, &hands), DANCE_OK);
  turn();
  EXPECT_EQ(captured_.fingers, 0) << "nobody's";
  ASSERT_EQ(send(), DANCE_OK);
  ASSERT_EQ(dance_producer_hands(producer_, &hands), DANCE_OK);
  turn();
  ASSERT_EQ(captured_.fingers, 1);
  EXPECT_EQ(captured_.hands_.presence, 7u);
  EXPECT_EQ(captured_.hands_.sequence, captured_.pose_.sequence);
}

TEST_F(EngineReceiverTest, WhatCannotBeIsRefusedWhereItIsSent) {
  pose_.rotation[3][3] = 2.0f;
  EXPECT_EQ(send(), DANCE_INVALID);
  pose_.rotation[3][3] = 1.0f;
  pose_.hips_position[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(send(), DANCE_INVALID);
  pose_.hips_position[0] = 0.0f;
  EXPECT_EQ(send(-5), DANCE_INVALID);
  EXPECT_EQ(dance_producer_pose(nullptr, &pose_), DANCE_BAD_ARGUMENT);
  pose_.struct_size = 8;
  EXPECT_EQ(send(), DANCE_BAD_ARGUMENT);
  EXPECT_EQ(dance_producer_open("No Name", DANCE_AXES_GLTF), nullptr);
  EXPECT_EQ(captured_.poses, 0);
}

TEST_F(EngineReceiverTest, PosesOfAnotherTimeAreLeftOutAndCounted) {
  const std::int64_t now_ns = dance_adapter_now_ns();
  EXPECT_EQ(send(now_ns + 10'000'000'000), DANCE_OK);
  EXPECT_EQ(send(now_ns - 10'000'000'000), DANCE_OK);
  EXPECT_EQ(captured_.poses, 0);
  EXPECT_EQ(receiver_->counters().time, 2u);
  EXPECT_EQ(send(now_ns + 20'000'000), DANCE_OK) << "a predicted display time";
  EXPECT_EQ(captured_.poses, 1);
  EXPECT_EQ(send(now_ns), DANCE_OK);
  EXPECT_EQ(receiver_->dancer().counters().not_newer, 1u);
  EXPECT_NE(receiver_->summary().find("2 captured too far from now"), std::string::npos);
}

TEST_F(EngineReceiverTest, ASecondEngineDoesNotPullTheDancerToAndFro) {
  ASSERT_EQ(send(), DANCE_OK);
  dance_producer* other = dance_producer_open(nullptr, DANCE_AXES_GLTF);
  for (int i = 0; i < 5; ++i) {
    pose_.capture_ns = 0;
    ASSERT_EQ(dance_producer_pose(other, &pose_), DANCE_OK);
    turn();
  }
  EXPECT_EQ(captured_.poses, 1);
  EXPECT_EQ(receiver_->counters().other_engine, 5u);
  dance_producer_close(other);
}

TEST_F(EngineReceiverTest, AnEngineWithAWrongClockKeepsNoGoodOneOut) {
  dance_producer* wrong = dance_producer_open(nullptr, DANCE_AXES_GLTF);
  dance_skeleton body{};
  body.struct_size = sizeof body;
  const Skeleton small = average_skeleton(1.3f);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    Eigen::Vector3f::Map(body.offset[b]) = small.offset_m[b];
  for (std::size_t t = 0; t < kTipCount; ++t) Eigen::Vector3f::Map(body.tip[t]) = small.tip_m[t];
  for (int i = 0; i < 5; ++i) {
    pose_.capture_ns = dance_adapter_now_ns() - 60'000'000'000;
    ASSERT_EQ(dance_producer_skeleton(wrong, &body), DANCE_OK);
    ASSERT_EQ(dance_producer_pose(wrong, &pose_), DANCE_OK);
    turn();
    ASSERT_EQ(send(), DANCE_OK);
    EXPECT_EQ(captured_.poses, i + 1);
  }
  EXPECT_EQ(receiver_->counters().time, 5u);
  EXPECT_EQ(receiver_->counters().other_engine, 4u) << "proportions of the wrong one";
  dance_producer_close(wrong);
}

TEST_F(EngineReceiverTest, OneThatEndsLeavesTheSocketOfTheNextOne) {
  const std::string path = local_socket_folder() + "/engine-stage";
  ASSERT_EQ(unlink(path.c_str()), 0);
  auto next = EngineReceiver::open("", *GuestId::parse("bob"), captured_, *poller_);
  ASSERT_TRUE(next) << next.error().what;
  receiver_.reset();
  EXPECT_EQ(access(path.c_str(), F_OK), 0);
  next->reset();
  EXPECT_NE(access(path.c_str(), F_OK), 0);
}

TEST_F(EngineReceiverTest, AnEngineFindsTheHouseWhenItComesAndWhenItComesBack) {
  receiver_.reset();
  EXPECT_EQ(send(), DANCE_NO_HOUSE);
  open();
  while (send() == DANCE_NO_HOUSE) usleep(10'000);
  EXPECT_EQ(captured_.poses, 1);
  receiver_.reset();
  EXPECT_EQ(send(), DANCE_NO_HOUSE);
  open();
  while (send() == DANCE_NO_HOUSE) usleep(10'000);
  EXPECT_EQ(captured_.poses, 2);
}

TEST_F(EngineReceiverTest, NobodyWaitsForAHouseThatDoesNotRead) {
  int sent = 0;
  dance_status status = DANCE_OK;
  for (; sent < 100'000 && status == DANCE_OK; ++sent) {
    pose_.capture_ns = 0;
    status = dance_producer_pose(producer_, &pose_);
  }
  EXPECT_EQ(status, DANCE_BUSY) << "after " << sent;
}

TEST_F(EngineReceiverTest, ForeignDatagramsAreCountedByCause) {
  auto sender = LocalDatagramSender::open(local_socket_folder() + "/engine-stage");
  ASSERT_TRUE(sender);
  engine::DatagramBuffer buffer;
  const auto valid = engine::encode(1, Pose(), buffer);
  const auto put = [&](std::vector<std::uint8_t> bytes) {
    EXPECT_EQ((*sender)->send(bytes, mono_now()), LocalDatagramSender::Sent::kSent);
    turn();
  };
  put({});
  put(std::vector<std::uint8_t>(60'000, 0xff));
  put({valid.begin(), valid.end() - 1});
  std::vector<std::uint8_t> longer(valid.begin(), valid.end());
  longer.resize(40'000);
  put(longer);
  put({valid.begin(), valid.end()});  // captured at no time
  EXPECT_EQ(receiver_->counters().foreign, 2u);
  EXPECT_EQ(receiver_->counters().size, 2u);
  EXPECT_EQ(receiver_->counters().invalid, 1u);
  EXPECT_EQ(captured_.poses, 0);
}

TEST_F(EngineReceiverTest, ANameThatAnotherHouseHearsIsToldWithTheCure) {
  Captured other;
  const auto second = EngineReceiver::open("stage", *GuestId::parse("bob"), other, *poller_);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("another name"), std::string::npos);
  EXPECT_FALSE(EngineReceiver::open("../stage", *GuestId::parse("bob"), other, *poller_));
}

TEST_F(EngineReceiverTest, NeitherEndAllocates) {
  ASSERT_EQ(send(), DANCE_OK);
  AllocationGuard guard;
  for (int i = 0; i < 50; ++i) ASSERT_EQ(send(), DANCE_OK);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(captured_.poses, 51);
}

}  // namespace
}  // namespace dance
