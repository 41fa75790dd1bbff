// What decode() lets through and what it does not: everything behind it trusts its values.
#include "core/bus/encode.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Where fields stand in an encoded pose_t: fingerprint, then the fields of the .lcm file.
constexpr std::size_t kPoseTimes = 8;
constexpr std::size_t kPoseHops = kPoseTimes + 16;
constexpr std::size_t kPoseRotations = kPoseHops + 8 * kHopCount + 8;
constexpr std::size_t kPoseHips = kPoseRotations + 16 * kBoneCount;
constexpr std::size_t kPoseConfidence = kPoseHips + 12;
constexpr std::size_t kPoseMusic = kPoseConfidence + 4;
constexpr std::size_t kPoseBytes = kPoseMusic + 8;

template <class T>
void put_big_endian(MessageBuffer& buffer, std::size_t at, T value) {
  std::uint64_t bits = 0;
  if constexpr (sizeof(T) == 4)
    bits = std::bit_cast<std::uint32_t>(value);
  else
    bits = std::bit_cast<std::uint64_t>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    buffer[at + i] = static_cast<std::uint8_t>(bits >> (8 * (sizeof(T) - 1 - i)));
}

Pose some_pose(std::uint64_t seed = 1) {
  Random random(seed);
  Pose pose = random_pose(random);
  pose.presence = 0x15a5a5;
  pose.sequence = 0xfffffffe;
  pose.clock_id = 0x8123456789abcdefULL;
  pose.capture_time = MonoTime::from_us(987'654'321'012);
  for (std::size_t i = 0; i < kHopCount; ++i)
    pose.hops[i] = MonoTime::from_us(987'654'322'000 + static_cast<std::int64_t>(i));
  pose.music_beats = -12.375;
  return pose;
}

// Encodes a fine pose, changes its bytes, and decodes.
template <class Change>
Decoded decode_changed(Change change) {
  MessageBuffer buffer;
  const std::size_t size = encode(some_pose(), buffer);
  EXPECT_EQ(size, kPoseBytes);
  change(buffer);
  Pose out;
  return decode(buffer.data(), size, out);
}

TEST(Encode, PoseRoundTripsExactly) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Pose in = some_pose(seed);
    MessageBuffer buffer;
    Pose out;
    ASSERT_EQ(decode(buffer.data(), encode(in, buffer), out), Decoded::kFine);
    EXPECT_EQ(out.p_WH_m, in.p_WH_m);
    EXPECT_EQ(out.presence, in.presence);
    EXPECT_EQ(out.confidence, in.confidence);
    EXPECT_EQ(out.sequence, in.sequence);
    EXPECT_EQ(out.clock_id, in.clock_id);
    EXPECT_EQ(out.capture_time, in.capture_time);
    EXPECT_EQ(out.hops, in.hops);
    EXPECT_EQ(out.music_beats, in.music_beats);
    for (std::size_t i = 0; i < kBoneCount; ++i)
      EXPECT_TRUE(out.R_PB[i].coeffs().isApprox(in.R_PB[i].coeffs(), 1e-6f)) << "bone " << i;
  }
}

TEST(Encode, HandsSkeletonStatusStatsAndStageTimeRoundTrip) {
  MessageBuffer buffer;
  Random random(7);
  Hands hands, hands_out;
  for (auto& rotation : hands.R_PB) rotation = random_rotation(random);
  hands.presence = 0x3fffffff;
  hands.sequence = 9;
  hands.capture_time = MonoTime::from_us(5);
  ASSERT_EQ(decode(buffer.data(), encode(hands, buffer), hands_out), Decoded::kFine);
  EXPECT_EQ(hands_out.presence, hands.presence);
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    EXPECT_TRUE(hands_out.R_PB[i].coeffs().isApprox(hands.R_PB[i].coeffs(), 1e-6f));

  TimedSkeleton skeleton{average_skeleton(1.9f), MonoTime::from_us(77), 3}, skeleton_out{};
  ASSERT_EQ(decode(buffer.data(), encode(skeleton, buffer), skeleton_out), Decoded::kFine);
  EXPECT_EQ(skeleton_out.skeleton, skeleton.skeleton);
  EXPECT_EQ(skeleton_out.capture_time, skeleton.capture_time);

  GuestStatus status, status_out;
  status.alive = true;
  status.arrival_hz = 59.9f;
  status.lost = 1LL << 40;
  ASSERT_EQ(decode(buffer.data(), encode(status, buffer), status_out), Decoded::kFine);
  EXPECT_TRUE(status_out.alive);
  EXPECT_FALSE(status_out.remote);
  EXPECT_EQ(status_out.arrival_hz, status.arrival_hz);
  EXPECT_EQ(status_out.lost, status.lost);

  Stats stats, stats_out;
  stats.clock_offset = Duration::us(-123456);
  stats.rejected_datagrams = 42;
  ASSERT_EQ(decode(buffer.data(), encode(stats, buffer), stats_out), Decoded::kFine);
  EXPECT_EQ(stats_out.clock_offset, stats.clock_offset);
  EXPECT_EQ(stats_out.rejected_datagrams, 42);

  StageTime time, time_out;
  time.sequence = 12;
  time.swap_time = MonoTime::from_us(999);
  ASSERT_EQ(decode(buffer.data(), encode(time, buffer), time_out), Decoded::kFine);
  EXPECT_EQ(time_out.sequence, 12u);
  EXPECT_EQ(time_out.swap_time, time.swap_time);
}

TEST(Decode, RotationsThatAreNotUnitAreInvalid) {
  for (const float bad : {kNotANumber, kInfinity, -kInfinity, 1e30f, 2.0f})
    for (std::size_t component = 0; component < 4 * kBoneCount; ++component)
      EXPECT_EQ(decode_changed([&](MessageBuffer& buffer) {
                  put_big_endian(buffer, kPoseRotations + 4 * component, bad);
                }),
                Decoded::kInvalid)
          << bad << " in component " << component;
  EXPECT_EQ(decode_changed(
                [](MessageBuffer& buffer) { std::memset(buffer.data() + kPoseRotations, 0, 16); }),
            Decoded::kInvalid);
}

TEST(Decode, RotationsWithinOnePercentOfUnitAreMadeUnit) {
  Pose in = some_pose();
  for (auto& rotation : in.R_PB) rotation.coeffs() *= 1.005f;
  MessageBuffer buffer;
  Pose out;
  ASSERT_EQ(decode(buffer.data(), encode(in, buffer), out), Decoded::kFine);
  for (const auto& rotation : out.R_PB) EXPECT_NEAR(rotation.norm(), 1.0f, 1e-6f);
}

TEST(Decode, PlacesOffTheStageAreInvalid) {
  for (const float bad : {kNotANumber, kInfinity, 1e9f, -1001.0f})
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(decode_changed([&](MessageBuffer& buffer) {
                  put_big_endian(buffer, kPoseHips + 4 * axis, bad);
                }),
                Decoded::kInvalid)
          << bad << " on axis " << axis;
}

TEST(Decode, ConfidenceOutsideItsRangeIsInvalid) {
  for (const float bad : {kNotANumber, -0.01f, 1.01f, kInfinity})
    EXPECT_EQ(decode_changed(
                  [&](MessageBuffer& buffer) { put_big_endian(buffer, kPoseConfidence, bad); }),
              Decoded::kInvalid)
        << bad;
}

TEST(Decode, NoMusicIsFineAndEndlessMusicIsNot) {
  EXPECT_EQ(decode_changed([](MessageBuffer& buffer) {
              put_big_endian(buffer, kPoseMusic, std::numeric_limits<double>::quiet_NaN());
            }),
            Decoded::kFine);
  EXPECT_EQ(decode_changed([](MessageBuffer& buffer) {
              put_big_endian(buffer, kPoseMusic, std::numeric_limits<double>::infinity());
            }),
            Decoded::kInvalid);
}

TEST(Decode, TimesThatWouldOverflowAreInvalid) {
  for (const std::int64_t bad :
       {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min(),
        std::numeric_limits<std::int64_t>::max() / 1000, -(std::int64_t{1} << 52)}) {
    EXPECT_EQ(decode_changed([&](MessageBuffer& b) { put_big_endian(b, kPoseTimes, bad); }),
              Decoded::kInvalid)
        << bad;
    for (std::size_t hop = 0; hop < kHopCount; ++hop)
      EXPECT_EQ(
          decode_changed([&](MessageBuffer& b) { put_big_endian(b, kPoseHops + 8 * hop, bad); }),
          Decoded::kInvalid)
          << bad << " at hop " << hop;
  }
}

TEST(Decode, BonesBeyondTheSkeletonAreNotPresent) {
  Pose in = some_pose();
  in.presence = 0xffffffff;
  MessageBuffer buffer;
  Pose out;
  ASSERT_EQ(decode(buffer.data(), encode(in, buffer), out), Decoded::kFine);
  EXPECT_EQ(out.presence, kAllBones);
}

template <class T>
void expect_only_its_own_bytes(const T& message) {
  MessageBuffer buffer;
  const std::size_t size = encode(message, buffer);
  T out = message;
  for (std::size_t prefix = 0; prefix < size; ++prefix)
    ASSERT_EQ(decode(buffer.data(), prefix, out), Decoded::kUndecodable) << prefix << " bytes";
  ASSERT_EQ(decode(buffer.data(), size + 1, out), Decoded::kUndecodable);
  for (std::size_t bit = 0; bit < 64; ++bit) {
    MessageBuffer other = buffer;
    other[bit / 8] = static_cast<std::uint8_t>(other[bit / 8] ^ (1u << (bit % 8)));
    ASSERT_EQ(decode(other.data(), size, out), Decoded::kUndecodable) << "fingerprint bit " << bit;
  }
}

TEST(Decode, OtherTypesSizesAndVersionsAreUndecodable) {
  expect_only_its_own_bytes(some_pose());
  expect_only_its_own_bytes(Hands());
  expect_only_its_own_bytes(TimedSkeleton{average_skeleton(), MonoTime(), 1});
  expect_only_its_own_bytes(GuestStatus());
  expect_only_its_own_bytes(Stats());
  expect_only_its_own_bytes(StageTime());
}

TEST(Decode, AnyBitFlipLeavesAValidPoseOrNone) {
  MessageBuffer buffer;
  const std::size_t size = encode(some_pose(), buffer);
  int fine = 0;
  for (std::size_t bit = 0; bit < 8 * size; ++bit) {
    MessageBuffer other = buffer;
    other[bit / 8] = static_cast<std::uint8_t>(other[bit / 8] ^ (1u << (bit % 8)));
    Pose out;
    if (decode(other.data(), size, out) != Decoded::kFine) continue;
    ++fine;
    ASSERT_TRUE(is_valid(out)) << "bit " << bit;
  }
  EXPECT_GT(fine, 100);  // low bits of numbers still make a pose
}

}  // namespace
}  // namespace dance
