#include "formats/engine/datagram.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "tests/core/pose/random_pose.h"

namespace dance::engine {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class Value>
Bytes encoded(const Value& value, std::uint64_t session = 5) {
  DatagramBuffer buffer;
  const auto bytes = encode(session, value, buffer);
  return {bytes.begin(), bytes.end()};
}

Pose some_pose() {
  Random random(3);
  Pose pose = random_pose(random);
  pose.capture_time = MonoTime::from_ns(123'456'789'012);
  return pose;
}

Hands some_hands() {
  Hands hands;
  Random random(4);
  for (auto& rotation : hands.R_PB) rotation = random_rotation(random);
  hands.presence = 0x3ff;
  hands.capture_time = MonoTime::from_ns(123'456'789'012);
  return hands;
}

bool is_used(const Received& received) { return !std::holds_alternative<Fault>(received.what); }

TEST(EngineDatagram, CarriesAPose) {
  const Pose sent = some_pose();
  const Received received = decode(encoded(sent));
  ASSERT_TRUE(std::holds_alternative<Pose>(received.what));
  const Pose& pose = std::get<Pose>(received.what);
  EXPECT_EQ(received.session, 5u);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_TRUE(is_same_rotation(pose.R_PB[b], sent.R_PB[b]));
  EXPECT_EQ(pose.p_WH_m, sent.p_WH_m);
  EXPECT_EQ(pose.capture_time, sent.capture_time);
  EXPECT_EQ(pose.presence, kAllBones);
  EXPECT_EQ(pose.confidence, sent.confidence);
}

TEST(EngineDatagram, CarriesHandsAndProportions) {
  const Hands sent = some_hands();
  const Received received = decode(encoded(sent));
  ASSERT_TRUE(std::holds_alternative<Hands>(received.what));
  const Hands& hands = std::get<Hands>(received.what);
  for (std::size_t b = 0; b < kFingerBoneCount; ++b)
    EXPECT_TRUE(is_same_rotation(hands.R_PB[b], sent.R_PB[b]));
  EXPECT_EQ(hands.presence, sent.presence);
  const Skeleton skeleton = average_skeleton(1.5f);
  const Received body = decode(encoded(skeleton));
  ASSERT_TRUE(std::holds_alternative<Skeleton>(body.what));
  EXPECT_EQ(std::get<Skeleton>(body.what).offset_m, skeleton.offset_m);
  EXPECT_EQ(std::get<Skeleton>(body.what).tip_m, skeleton.tip_m);
}

TEST(EngineDatagram, RefusesEachPrefixAndWhatIsLonger) {
  for (Bytes bytes : {encoded(some_pose()), encoded(some_hands()), encoded(average_skeleton())}) {
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_FALSE(is_used(decode({bytes.data(), size}))) << size;
    bytes.push_back(0);
    EXPECT_FALSE(is_used(decode(bytes)));
  }
}

TEST(EngineDatagram, WhatEachFlippedBitMakesIsRefusedOrValid) {
  for (const Bytes& bytes :
       {encoded(some_pose()), encoded(some_hands()), encoded(average_skeleton())})
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      Bytes damaged = bytes;
      damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
      const Received received = decode(damaged);
      if (const auto* pose = std::get_if<Pose>(&received.what)) {
        EXPECT_TRUE(is_valid(*pose));
        EXPECT_GT(pose->capture_time, MonoTime());
      } else if (const auto* hands = std::get_if<Hands>(&received.what)) {
        EXPECT_TRUE(is_valid(*hands));
      } else if (const auto* skeleton = std::get_if<Skeleton>(&received.what)) {
        EXPECT_TRUE(is_valid(*skeleton));
      }
      // Magic, version and kind are the first 16 bytes.
      EXPECT_TRUE(bit >= std::size_t{8} * 12 || !is_used(received)) << bit;
    }
}

TEST(EngineDatagram, SaysWhatIsWrong) {
  const auto fault = [](const Received& received) { return std::get<Fault>(received.what); };
  Bytes bytes = encoded(some_pose());
  EXPECT_EQ(fault(decode({})), Fault::kForeign);
  EXPECT_EQ(fault(decode(Bytes(bytes.size(), 0x41))), Fault::kForeign);
  EXPECT_EQ(fault(decode({bytes.data(), bytes.size() - 1})), Fault::kWrongSize);
  bytes[8] ^= 2;
  EXPECT_EQ(fault(decode(bytes)), Fault::kOtherVersion);
  Pose pose = some_pose();
  pose.p_WH_m.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(fault(decode(encoded(pose))), Fault::kInvalid);
  pose = some_pose();
  pose.R_PB[21].coeffs() *= 2.0f;
  EXPECT_EQ(fault(decode(encoded(pose))), Fault::kInvalid);
  pose = some_pose();
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::min(), std::int64_t{0},
                                  std::numeric_limits<std::int64_t>::max()}) {
    pose.capture_time = MonoTime::from_ns(time);
    EXPECT_EQ(fault(decode(encoded(pose))), Fault::kInvalid);
  }
  Skeleton skeleton = average_skeleton();
  skeleton.offset_m[3].y() = 3.0f;
  EXPECT_EQ(fault(decode(encoded(skeleton))), Fault::kInvalid);
}

}  // namespace
}  // namespace dance::engine
