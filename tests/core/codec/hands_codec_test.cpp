#include "core/codec/hands_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/codec/coding/adaptive_bits.h"
#include "tests/allocation_guard.h"
#include "tests/core/codec/rotations.h"

namespace dance {
namespace {

using HandsPayload = std::array<std::uint8_t, kMaxHandsPayload>;
constexpr std::uint32_t kAllFingers = (1u << kFingerBoneCount) - 1;
constexpr double kRadPerDeg = M_PI / 180.0;

std::size_t expect_round_trip(const Hands& hands) {
  HandsPayload payload;
  const std::size_t size = encode_hands(hands, payload);
  EXPECT_GT(size, 0u);
  Hands out;
  for (auto& q : out.R_PB) q.coeffs().setConstant(9.0f);  // must all be filled
  EXPECT_TRUE(decode_hands({payload.data(), size}, out));
  EXPECT_TRUE(is_valid(out));
  EXPECT_EQ(out.presence, hands.presence & kAllFingers);
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    EXPECT_LT(angle_deg(hands.R_PB[i], out.R_PB[i]), kHandsError_deg) << kFingerBones[i].name;
  return size;
}

Eigen::Quaternionf turn_deg(double x, double y, double z) {
  const Eigen::Vector3d v = Eigen::Vector3d(x, y, z) * kRadPerDeg;
  if (v.norm() == 0.0) return Eigen::Quaternionf::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(v.norm(), v.normalized())).cast<float>();
}

// Hands as people hold them: each more or less closed, fingers fanned, joints that are no perfect
// hinges, and a sensor's noise.
Hands natural_hands(Random& random, double most_grip_deg, double noise_deg) {
  Hands hands;
  hands.presence = kAllFingers;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const double side = hand == 0 ? 1.0 : -1.0;
    const double grip = random.uniform(0.0, most_grip_deg);
    for (std::size_t finger = 0; finger < 5; ++finger) {
      const bool is_thumb = finger == 0;
      const double closed = is_thumb ? 0.5 * grip : grip + 5.0 * random.normal();
      const double fan = is_thumb ? 20.0 + 8.0 * random.normal()
                                  : 8.0 - 4.0 * static_cast<double>(finger) + 3.0 * random.normal();
      for (std::size_t bone = 0; bone < 3; ++bone) {
        constexpr std::array<double, 3> kShare{0.8, 1.1, 0.7};
        const double curl = closed * kShare[bone] + (3.0 + noise_deg) * random.normal();
        const double spread = (bone == 0 ? fan : 0.0) + noise_deg * random.normal();
        const double twist = noise_deg * random.normal();
        hands.R_PB[15 * hand + 3 * finger + bone] = turn_deg(twist, side * spread, -side * curl);
      }
    }
  }
  return hands;
}

TEST(HandsCodec, AnyRotationSurvivesWithinHalfADegree) {
  Random random(1);
  std::size_t largest = 0;
  for (int round = 0; round < 2000; ++round) {
    Hands hands;
    for (auto& q : hands.R_PB) q = any_rotation(random);
    hands.presence = static_cast<std::uint32_t>(random.below(kAllFingers + 1u));
    largest = std::max(largest, expect_round_trip(hands));
  }
  EXPECT_LE(largest, 160u);
}

TEST(HandsCodec, HalfTurnsAndBothSignsSurvive) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {179.9999, 180.0, 180.0001, -180.0, 359.9, 1e-5, 90.0}) {
      Hands hands;
      hands.presence = kAllFingers;
      for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
        Eigen::Vector3d v = Eigen::Vector3d::Zero();
        v[axis] = i % 2 == 0 ? angle : -angle;
        hands.R_PB[i] = turn_deg(v.x(), v.y(), v.z());
        if (i % 3 == 0) hands.R_PB[i].coeffs() *= -1.0f;
        if (i % 5 == 0) hands.R_PB[i].coeffs() *= 1.005f;  // unit within what is forgiven
      }
      expect_round_trip(hands);
    }
}

// The dearest: every number as far as can be from what is expected of it.
TEST(HandsCodec, NothingIsLargerThanThePayload) {
  Random random(2);
  std::size_t largest = 0;
  for (int round = 0; round < 5000; ++round) {
    Hands hands;
    const double often = random.uniform();
    for (auto& q : hands.R_PB) {
      std::array<double, 3> v{};
      for (double& x : v)
        if (random.uniform() < often) x = random.uniform() < 0.5 ? 103.0 : -103.0;
      q = turn_deg(v[0], v[1], v[2]);
    }
    hands.presence = static_cast<std::uint32_t>(random.below(kAllFingers + 1u));
    largest = std::max(largest, expect_round_trip(hands));
  }
  EXPECT_LE(largest, kMaxHandsPayload);
}

TEST(HandsCodec, CostsLittleForWhatHandsDo) {
  Hands hands;
  EXPECT_EQ(expect_round_trip(hands), 1u);
  hands.presence = kAllFingers;
  EXPECT_LE(expect_round_trip(hands), 12u);
  hands.presence = kAllFingers & 0x7fff;  // the left one only
  EXPECT_LE(expect_round_trip(hands), 12u);
  Random random(3);
  for (const double grip : {25.0, 70.0}) {
    double sum = 0.0;
    constexpr int kPoses = 300;
    for (int i = 0; i < kPoses; ++i)
      sum += static_cast<double>(expect_round_trip(natural_hands(random, grip, 0.5)));
    EXPECT_LE(sum / kPoses, 55.0) << grip;
  }
}

TEST(HandsCodec, FillsInWhatWasNotMeasured) {
  Random random(4);
  for (int round = 0; round < 500; ++round) {
    Hands hands;
    for (auto& q : hands.R_PB)
      if (random.uniform() < 0.3) q = any_rotation(random);
    hands.presence = static_cast<std::uint32_t>(random.below(kAllFingers + 1u)) & 0x3f00ff00;
    expect_round_trip(hands);
  }
}

TEST(HandsCodec, RefusesWhatIsNotValidOrDoesNotFit) {
  Random random(5);
  Hands hands = natural_hands(random, 70.0, 1.0);
  HandsPayload payload;
  const std::size_t size = encode_hands(hands, payload);
  for (std::size_t room = 0; room < size; ++room)
    EXPECT_EQ(encode_hands(hands, {payload.data(), room}), 0u);
  EXPECT_EQ(encode_hands(hands, {payload.data(), size}), size);
  hands.R_PB[7].w() = NAN;
  EXPECT_EQ(encode_hands(hands, payload), 0u);
}

TEST(HandsCodec, NeitherPrefixesNorDamageGetPastAsInvalid) {
  Random random(6);
  Hands hands = natural_hands(random, 70.0, 1.0);
  hands.presence = 0x3fff7fff;  // masks in one hand
  HandsPayload payload;
  const std::size_t size = encode_hands(hands, payload);
  Hands out;
  EXPECT_FALSE(decode_hands({}, out));
  for (std::size_t n = 0; n < size; ++n)
    EXPECT_TRUE(!decode_hands({payload.data(), n}, out) || is_valid(out));
  for (int round = 0; round < 50'000; ++round) {
    HandsPayload damaged = payload;
    for (std::uint64_t i = 0; i <= random.below(4); ++i)
      damaged[random.below(size)] = static_cast<std::uint8_t>(random.below(256));
    EXPECT_TRUE(!decode_hands({damaged.data(), size}, out) || is_valid(out));
  }
  payload[size] = 1;
  EXPECT_FALSE(decode_hands({payload.data(), size + 1}, out));
  for (const unsigned form : {0x03u, 0x0cu, 0x10u, 0x80u, 0xffu})
    EXPECT_FALSE(decode_hands(std::array{static_cast<std::uint8_t>(form)}, out));
}

TEST(HandsCodec, RefusesWhatIsMeasuredButNotCarried) {
  HandsPayload payload{2};  // masks of the left hand, nothing of the right
  BitEncoder coder({payload.data() + 1, payload.size() - 1});
  coder.raw(0x0001, 15);
  coder.raw(0x0000, 15);
  const std::size_t size = 1 + coder.finish();
  Hands out;
  EXPECT_FALSE(decode_hands({payload.data(), size}, out));
}

TEST(HandsCodec, AllocatesNothing) {
  Random random(7);
  const Hands hands = natural_hands(random, 70.0, 1.0);
  HandsPayload payload;
  Hands out;
  const AllocationGuard guard;
  const std::size_t size = encode_hands(hands, payload);
  EXPECT_TRUE(decode_hands({payload.data(), size}, out));
  EXPECT_EQ(guard.allocations(), 0u);
}

// The bytes are a format, and what they mean is the same to the last bit everywhere.
TEST(HandsCodec, GoldenBytesStay) {
  Hands hands;
  hands.presence = 0x1fff7fff;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
    const auto n = static_cast<float>(i);
    const Eigen::Vector4f v(0.01f * n, i % 4 == 0 ? -0.05f : 0.03f, i < 15 ? -0.3f : 0.35f, 1.0f);
    hands.R_PB[i].coeffs() = v / std::sqrt(v.squaredNorm());
  }
  HandsPayload payload;
  const std::size_t size = encode_hands(hands, payload);
  EXPECT_EQ(
      std::vector<std::uint8_t>(payload.begin(), payload.begin() + size),
      (std::vector<std::uint8_t>{
          0x09, 0x00, 0x51, 0x60, 0x85, 0x63, 0x6f, 0x39, 0xf1, 0x45, 0x98, 0xbe, 0x60, 0xa1, 0xab,
          0x28, 0x01, 0x5d, 0x9e, 0x7a, 0xd9, 0xf2, 0x73, 0x11, 0x39, 0x13, 0xc8, 0x31, 0xec, 0x10,
          0xf4, 0xf5, 0x17, 0x0c, 0xb1, 0xb3, 0x7d, 0x32, 0xa5, 0x6d, 0x9e, 0x84, 0xc8, 0x61, 0x85,
          0x44, 0x35, 0xc8, 0x8c, 0xe6, 0xae, 0x0a, 0x97, 0x15, 0x9d, 0x02, 0xa1, 0xe9, 0xbd, 0xe9,
          0x85, 0x5c, 0xa2, 0x23, 0x64, 0xfe, 0x96, 0x1b, 0xe3, 0x95, 0x8e}));
  Hands out;
  ASSERT_TRUE(decode_hands({payload.data(), size}, out));
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const auto& q : out.R_PB)
    for (int i = 0; i < 4; ++i)
      hash = (hash ^ std::bit_cast<std::uint32_t>(q.coeffs()[i])) * 0x100000001b3ULL;
  EXPECT_EQ(hash, 0xccf9f0224bdda452ULL);
}

}  // namespace
}  // namespace dance
