#include "core/codec/plain_codec.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/codec/packed_rotation.h"
#include "tests/core/codec/rotations.h"

namespace dance {
namespace {

using PlainPayload = std::array<std::uint8_t, kMaxPosePayload>;

Pose random_tagged_pose(Random& random) {
  Pose pose;
  for (auto& q : pose.R_PB) q = any_rotation(random);
  for (int axis = 0; axis < 3; ++axis)
    pose.p_WH_m[axis] = static_cast<float>(random.uniform(-1000.0, 1000.0));
  pose.presence = static_cast<std::uint32_t>(random.below(1u << kBoneCount));
  pose.confidence = static_cast<float>(random.uniform());
  if (random.uniform() < 0.5) pose.music_beats = random.uniform(-1e6, 1e6);
  return pose;
}

Pose round_trip(const Pose& pose) {
  PlainPayload payload;
  PlainEncoder encoder;
  PlainDecoder decoder;
  const std::size_t size = encoder.encode(pose, payload);
  EXPECT_GT(size, 0u);
  Pose out;
  EXPECT_EQ(decoder.decode(1, {payload.data(), size}, out), DecodeResult::kPose);
  EXPECT_TRUE(is_valid(out));
  return out;
}

TEST(PackedRotation, ErrorStaysWithinTheStatedBound) {
  Random random(1);
  double worst_deg = 0.0;
  for (int i = 0; i < 500'000; ++i) {
    const Eigen::Quaternionf q = any_rotation(random);
    worst_deg = std::max(worst_deg, angle_deg(q, *unpack_rotation(pack_rotation(q))));
  }
  // All four components the same is where a step weighs most.
  for (int i = 0; i < 100'000; ++i) {
    Eigen::Quaternionf q;
    q.coeffs() = (Eigen::Vector4d::Constant(0.5) +
                  1e-4 * Eigen::Vector4d(random.normal(), random.normal(), random.normal(), 0.0))
                     .normalized()
                     .cast<float>();
    worst_deg = std::max(worst_deg, angle_deg(q, *unpack_rotation(pack_rotation(q))));
  }
  EXPECT_LT(worst_deg, kPackedRotationError_deg);
  EXPECT_GT(worst_deg, 0.5 * kPackedRotationError_deg) << "the bound says something";
  RecordProperty("worst_deg", std::to_string(worst_deg));
}

TEST(PackedRotation, AntipodesPackAlike) {
  Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    const Eigen::Quaternionf q = any_rotation(random);
    Eigen::Quaternionf minus;
    minus.coeffs() = -q.coeffs();
    EXPECT_EQ(pack_rotation(q), pack_rotation(minus));
  }
}

TEST(PackedRotation, HalfTurnsWithWNearZeroKeepTheBound) {
  for (const float w : {0.0f, 1e-8f, -1e-8f, 1e-4f, -1e-4f}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Quaternionf q(w, 0.0f, 0.0f, 0.0f);
      q.coeffs()[axis] = std::sqrt(1.0f - w * w);
      EXPECT_LT(angle_deg(q, *unpack_rotation(pack_rotation(q))), kPackedRotationError_deg);
    }
  }
}

TEST(PackedRotation, RestIsExact) {
  const auto q = unpack_rotation(pack_rotation(Eigen::Quaternionf::Identity()));
  EXPECT_EQ(q->coeffs(), Eigen::Quaternionf::Identity().coeffs());
}

TEST(PackedRotation, RefusesWhatIsNeverPacked) {
  EXPECT_FALSE(unpack_rotation(std::uint64_t{1} << 47));
  EXPECT_FALSE(unpack_rotation(0)) << "three components of -1/√2 leave no room for the largest";
  EXPECT_FALSE(unpack_rotation(0x7fff)) << "a component beyond its range";
}

TEST(PlainCodec, RoundTripStaysWithinTheStatedBounds) {
  Random random(3);
  for (int i = 0; i < 20'000; ++i) {
    const Pose pose = random_tagged_pose(random);
    const Pose out = round_trip(pose);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      ASSERT_LT(angle_deg(pose.R_PB[b], out.R_PB[b]), 0.01);
    // Half a step, and what float32 leaves of a place 1 km away.
    ASSERT_LE((pose.p_WH_m - out.p_WH_m).cwiseAbs().maxCoeff(), 0.00005f + 0.00007f);
    ASSERT_EQ(pose.presence, out.presence);
    ASSERT_NEAR(pose.confidence, out.confidence, 0.5f / 255.0f + 1e-6f);
    ASSERT_EQ(std::isnan(pose.music_beats), std::isnan(out.music_beats));
    if (!std::isnan(pose.music_beats)) {
      ASSERT_EQ(pose.music_beats, out.music_beats);
    }
  }
}

TEST(PlainCodec, BonesAtRestThatWereNotMeasuredCostNothing) {
  Pose pose;
  pose.presence = 1;
  PlainPayload payload;
  PlainEncoder encoder;
  const std::size_t lean = encoder.encode(pose, payload);
  EXPECT_EQ(lean, 1u + 3 + 3 + 1 + 12 + 6);
  pose.R_PB[5] = Eigen::Quaternionf(Eigen::AngleAxisf(0.3f, Eigen::Vector3f::UnitX()));
  EXPECT_EQ(encoder.encode(pose, payload), lean + 6) << "filled in with something, it travels";
  const Pose out = round_trip(pose);
  EXPECT_EQ(out.presence, 1u);
  EXPECT_LT(angle_deg(pose.R_PB[5], out.R_PB[5]), 0.01);
  EXPECT_EQ(out.R_PB[6].coeffs(), Eigen::Quaternionf::Identity().coeffs());
}

TEST(PlainCodec, AWholeBodyWithMusicTakes154Bytes) {
  Pose pose;
  pose.music_beats = 12.5;
  PlainPayload payload;
  PlainEncoder encoder;
  EXPECT_EQ(encoder.encode(pose, payload), 1u + 1 + 12 + 8 + 22 * 6);
}

TEST(PlainCodec, RefusesPosesThatAreNotValid) {
  PlainEncoder encoder;
  PlainPayload payload;
  Pose pose;
  pose.R_PB[3].coeffs() *= 1.1f;
  EXPECT_EQ(encoder.encode(pose, payload), 0u);
  pose = Pose();
  pose.R_PB[3].x() = NAN;
  EXPECT_EQ(encoder.encode(pose, payload), 0u);
  pose = Pose();
  pose.p_WH_m.x() = 1001.0f;
  EXPECT_EQ(encoder.encode(pose, payload), 0u);
  pose = Pose();
  pose.confidence = NAN;
  EXPECT_EQ(encoder.encode(pose, payload), 0u);
  EXPECT_EQ(encoder.encode(Pose(), std::span(payload).first(50)), 0u) << "does not fit";
}

TEST(PlainCodec, AQuaternionOnePerCentOffIsMadeUnit) {
  Pose pose;
  Random random(4);
  pose.R_PB[8] = any_rotation(random);
  Pose off = pose;
  off.R_PB[8].coeffs() *= 1.009f;
  const Pose out = round_trip(off);
  EXPECT_LT(angle_deg(pose.R_PB[8], out.R_PB[8]), 0.01);
  EXPECT_NEAR(out.R_PB[8].norm(), 1.0f, 1e-6f);
}

TEST(PlainCodec, EveryPrefixIsRefusedAndEveryFlippedBitGivesAValidPoseOrNone) {
  Random random(5);
  PlainEncoder encoder;
  PlainDecoder decoder;
  for (int round = 0; round < 20; ++round) {
    PlainPayload payload;
    const std::size_t size = encoder.encode(random_tagged_pose(random), payload);
    Pose out;
    for (std::size_t n = 0; n < size; ++n)
      EXPECT_EQ(decoder.decode(1, std::span(payload).first(n), out), DecodeResult::kMalformed);
    EXPECT_EQ(decoder.decode(1, std::span(payload).first(size + 1), out), DecodeResult::kMalformed);
    for (std::size_t bit = 0; bit < size * 8; ++bit) {
      payload[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
      if (decoder.decode(1, std::span(payload).first(size), out) == DecodeResult::kPose) {
        ASSERT_TRUE(is_valid(out));
      }
      payload[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    }
  }
}

TEST(PlainCodec, SkeletonsComeBackWithinATwentiethOfAMillimetre) {
  Skeleton skeleton = average_skeleton(1.9f);
  skeleton.version = 0xfedcba98;
  std::array<std::uint8_t, kSkeletonPayload> payload;
  ASSERT_EQ(encode_skeleton(skeleton, payload), kSkeletonPayload);
  Skeleton out;
  ASSERT_TRUE(decode_skeleton(payload, out));
  EXPECT_EQ(out.version, skeleton.version);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_LE((out.offset_m[b] - skeleton.offset_m[b]).cwiseAbs().maxCoeff(), 0.0000501f);
  for (std::size_t n = 0; n < kSkeletonPayload; ++n)
    EXPECT_FALSE(decode_skeleton({payload.data(), n}, out));
  payload[5] = 0x7f;  // an offset of 3.2 m is no body
  EXPECT_FALSE(decode_skeleton(payload, out));
}

TEST(PoseCodec, KnowsItsCodecsByTheirNames) {
  ASSERT_FALSE(known_codecs().empty());
  for (const CodecName name : known_codecs()) {
    EXPECT_TRUE(is_known(name));
    EXPECT_EQ(make_pose_encoder(name)->name(), name);
    EXPECT_EQ(make_pose_decoder(name)->name(), name);
  }
  EXPECT_FALSE(is_known({CodecId::kNone, 0}));
  EXPECT_FALSE(is_known({CodecId::kPlain, 1}));
  EXPECT_EQ(make_pose_decoder({static_cast<CodecId>(200), 0}), nullptr);
}

}  // namespace
}  // namespace dance
