#include "core/codec/lossless/lossless_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

using LosslessPayload = std::array<std::uint8_t, kMaxLosslessPayload>;
using Bytes = std::vector<std::uint8_t>;

void expect_same_bits(const Pose& a, const Pose& b) {
  EXPECT_EQ(std::memcmp(a.R_PB.data(), b.R_PB.data(), sizeof a.R_PB), 0);
  EXPECT_EQ(std::memcmp(a.p_WH_m.data(), b.p_WH_m.data(), 3 * sizeof(float)), 0);
  EXPECT_EQ(std::memcmp(&a.confidence, &b.confidence, sizeof a.confidence), 0);
  EXPECT_EQ(std::memcmp(&a.music_beats, &b.music_beats, sizeof a.music_beats), 0);
  EXPECT_EQ(a.presence, b.presence);
}

Bytes encode(LosslessEncoder& encoder, const Pose& pose) {
  LosslessPayload payload;
  const std::size_t size = encoder.encode(pose, payload);
  EXPECT_GT(size, 0u);
  return {payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(size)};
}

// Gives the bytes of every frame.
std::vector<Bytes> expect_round_trip(const std::vector<Pose>& poses) {
  LosslessEncoder encoder;
  LosslessDecoder decoder;
  std::vector<Bytes> frames;
  for (const Pose& pose : poses) {
    frames.push_back(encode(encoder, pose));
    Pose out;
    EXPECT_EQ(decoder.decode(frames.back(), out), DecodeResult::kPose);
    expect_same_bits(pose, out);
  }
  return frames;
}

double mean_bytes(const std::vector<Bytes>& frames) {
  double sum = 0.0;
  for (const Bytes& frame : frames) sum += static_cast<double>(frame.size());
  return sum / static_cast<double>(frames.size());
}

// Smooth and unit, made without libm, so that it is the same everywhere: springs that are pushed.
class Mover {
 public:
  explicit Mover(std::uint64_t seed) : random_(seed) {}
  Pose next() {
    Pose pose;
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      std::array<double, 4> q{};
      double n2 = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        q[i] = (i == 3 ? 1.0 : 0.0) + (b % 7 == 3 ? 0.0 : step(4 * b + i));
        n2 += q[i] * q[i];
      }
      for (std::size_t i = 0; i < 4; ++i)
        pose.R_PB[b].coeffs()[static_cast<Eigen::Index>(i)] =
            static_cast<float>(q[i] / std::sqrt(n2));
    }
    for (std::size_t i = 0; i < 3; ++i)
      pose.p_WH_m[static_cast<Eigen::Index>(i)] = static_cast<float>(step(4 * kBoneCount + i));
    pose.music_beats = static_cast<double>(frames_++) * (2.1 / 60.0);
    return pose;
  }

 private:
  double step(std::size_t i) {
    speed_[i] += 0.003 * random_.uniform(-1.0, 1.0) - 0.004 * place_[i] - 0.01 * speed_[i];
    return place_[i] += speed_[i];
  }
  Random random_;
  int frames_ = 0;
  std::array<double, 4 * kBoneCount + 3> place_{};
  std::array<double, 4 * kBoneCount + 3> speed_{};
};

std::vector<Pose> moves(std::size_t count, std::uint64_t seed = 1) {
  Mover mover(seed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) poses.push_back(mover.next());
  return poses;
}

float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }

// Every number of the pose, in the order of the stream.
template <class Change>
void for_each_float(Pose& pose, const Change& change) {
  for (auto& q : pose.R_PB)
    for (Eigen::Index i = 0; i < 4; ++i) change(q.coeffs()[i]);
  for (Eigen::Index i = 0; i < 3; ++i) change(pose.p_WH_m[i]);
  change(pose.confidence);
}

TEST(LosslessCodec, SmoothMovementComesBackToTheBit) {
  const auto frames = expect_round_trip(moves(600));
  EXPECT_LT(mean_bytes(frames), 0.6 * static_cast<double>(kRawPose_bytes));
}

TEST(LosslessCodec, WhatStandsStillCostsNearlyNothing) {
  std::vector<Pose> poses = moves(30);
  EXPECT_LE(expect_round_trip({Pose{}}).front().size(), 12u);  // the T-pose everybody knows
  const std::size_t moving = poses.size();
  poses.resize(moving + 100, poses.back());
  const auto frames = expect_round_trip(poses);
  EXPECT_LE(frames.back().size(), 3u + 5u);  // the music's clock had gone on, and stopped
}

TEST(LosslessCodec, AnyBitsComeBack) {
  const std::array<std::uint32_t, 16> kOdd{
      0x00000000, 0x80000000,              // ±0
      0x00000001, 0x80000001, 0x007fffff,  // denormals
      0x00800000, 0x7f7fffff, 0xff7fffff,  // least and largest
      0x7f800000, 0xff800000,              // infinite
      0x7fc00000, 0x7f800001, 0xffffffff,  // not numbers, quiet and not
      0x3f800000, 0xbf800000, 0x3f800001};
  Random random(2);
  for (const double oddness : {0.01, 0.3, 1.0}) {
    std::vector<Pose> poses = moves(300);
    for (Pose& pose : poses) {
      for_each_float(pose, [&](float& x) {
        if (random.uniform() < oddness) x = float_of(kOdd[random.below(kOdd.size())]);
      });
      pose.presence = static_cast<std::uint32_t>(random.next_u64());
      pose.music_beats = std::bit_cast<double>(random.next_u64());
    }
    expect_round_trip(poses);
  }
}

TEST(LosslessCodec, NoiseOfBitsFitsTheBound) {
  Random random(3);
  std::vector<Pose> poses(400);
  std::size_t i = 0;
  for (Pose& pose : poses) {
    // Calm for a while, so that noise is as dear as it can be.
    if (i++ % 40 < 30) continue;
    for_each_float(pose,
                   [&](float& x) { x = float_of(static_cast<std::uint32_t>(random.next_u64())); });
    pose.music_beats = std::bit_cast<double>(random.next_u64());
  }
  expect_round_trip(poses);
}

TEST(LosslessCodec, EveryScaleComesBack) {
  Random random(4);
  std::vector<Pose> poses;
  for (int power = -149; power < 128; power += 3) {
    for (int i = 0; i < 4; ++i) {
      Pose pose;
      for_each_float(pose, [&](float& x) {
        x = static_cast<float>(std::ldexp(random.uniform(-1.0, 1.0), power));
      });
      poses.push_back(pose);
    }
  }
  expect_round_trip(poses);
}

TEST(LosslessCodec, TheOtherSignOfARotationCostsLittle) {
  std::vector<Pose> poses = moves(400);
  const double calm = mean_bytes(expect_round_trip(poses));
  Random random(5);
  std::size_t flips = 0;
  for (Pose& pose : poses)
    for (auto& q : pose.R_PB)
      if (random.uniform() < 0.02) {
        q.coeffs() = -q.coeffs();
        ++flips;
      }
  const double flipping = mean_bytes(expect_round_trip(poses));
  // Each there and back: two changes of a sign.
  EXPECT_LT((flipping - calm) * static_cast<double>(poses.size()),
            3.0 * static_cast<double>(flips));
}

TEST(LosslessCodec, RotationsThatAreNotUnitComeBack) {
  std::vector<Pose> poses = moves(200);
  Random random(6);
  for (Pose& pose : poses)
    for (auto& q : pose.R_PB) q.coeffs() *= static_cast<float>(random.uniform(0.5, 1.5));
  expect_round_trip(poses);
}

TEST(LosslessCodec, AGapIsSaidAndNeverGuessed) {
  const auto poses = moves(200);
  const auto frames = expect_round_trip(poses);
  for (const std::size_t gap : {1u, 2u, 63u, 127u, 128u}) {
    LosslessDecoder decoder;
    Pose out;
    for (std::size_t i = 0; i < 5; ++i)
      ASSERT_EQ(decoder.decode(frames[i], out), DecodeResult::kPose);
    for (std::size_t i = 5 + gap; i < frames.size(); ++i)
      EXPECT_EQ(decoder.decode(frames[i], out), DecodeResult::kReferenceMissing);
    EXPECT_EQ(decoder.decode(frames[4], out), DecodeResult::kReferenceMissing);
    // It has forgotten nothing over that.
    EXPECT_EQ(decoder.decode(frames[5], out), DecodeResult::kPose);
    expect_same_bits(out, poses[5]);
  }
  LosslessDecoder late;
  Pose out;
  EXPECT_EQ(late.decode(frames[1], out), DecodeResult::kReferenceMissing);
}

TEST(LosslessCodec, RestartMakesAnIntraFrame) {
  const auto poses = moves(100);
  LosslessEncoder encoder;
  for (std::size_t i = 0; i < 50; ++i) encode(encoder, poses[i]);
  encoder.restart();
  LosslessDecoder decoder;
  Pose out;
  for (std::size_t i = 50; i < 100; ++i) {
    ASSERT_EQ(decoder.decode(encode(encoder, poses[i]), out), DecodeResult::kPose);
    expect_same_bits(out, poses[i]);
  }
  decoder.restart();
  EXPECT_EQ(decoder.decode(encode(encoder, poses[0]), out), DecodeResult::kReferenceMissing);
}

TEST(LosslessCodec, BeginsAnewBehindWhatDidNotFit) {
  const auto poses = moves(20);
  LosslessEncoder encoder;
  encode(encoder, poses[0]);
  LosslessPayload payload;
  for (const std::size_t room : {0u, 1u, 2u, 20u}) {
    EXPECT_EQ(encoder.encode(poses[1], {payload.data(), room}), 0u) << room;
    LosslessDecoder decoder;
    Pose out;
    const Bytes next = encode(encoder, poses[2]);
    if (room >= 2)
      EXPECT_EQ(decoder.decode(next, out), DecodeResult::kPose) << room;
    else
      EXPECT_EQ(decoder.decode(next, out), DecodeResult::kReferenceMissing) << room;
  }
}

TEST(LosslessCodec, DamageEndsAtTheNextIntraFrame) {
  const auto poses = moves(60);
  const auto frames = expect_round_trip(poses);
  Random random(7);
  std::size_t silent = 0;
  for (int round = 0; round < 1500; ++round) {
    const std::size_t broken = random.below(20);
    LosslessDecoder decoder;
    Pose out;
    for (std::size_t i = 0; i < 25; ++i) {
      Bytes frame = frames[i];
      if (i == broken) {
        if (random.uniform() < 0.5)
          frame.resize(random.below(frame.size()));
        else
          frame[2 + random.below(frame.size() - 2)] ^=
              static_cast<std::uint8_t>(1 + random.below(255));
      }
      const DecodeResult result = decoder.decode(frame, out);
      if (i > broken && result == DecodeResult::kPose) ++silent;
    }
    ASSERT_EQ(decoder.decode(frames[0], out), DecodeResult::kPose);
    expect_same_bits(out, poses[0]);
  }
  // One in 256 frames behind damage has the digest by chance; what it then decodes has not.
  EXPECT_LT(silent, 60u);
}

TEST(LosslessCodec, RefusesForeignBytes) {
  LosslessDecoder decoder;
  Pose out;
  EXPECT_EQ(decoder.decode({}, out), DecodeResult::kMalformed);
  EXPECT_EQ(decoder.decode(Bytes{0x80}, out), DecodeResult::kMalformed);
  EXPECT_EQ(decoder.decode(Bytes{0x81, 0, 1}, out), DecodeResult::kMalformed);
  EXPECT_EQ(decoder.decode(Bytes{0x80, 1, 1}, out), DecodeResult::kMalformed);
  EXPECT_EQ(decoder.decode(Bytes(kMaxLosslessPayload + 1, 0x80), out), DecodeResult::kMalformed);
  Bytes longer = expect_round_trip(moves(1)).front();
  longer.push_back(1);
  EXPECT_EQ(decoder.decode(longer, out), DecodeResult::kMalformed);
}

TEST(LosslessCodec, AllocatesNothing) {
  const auto poses = moves(20);
  LosslessEncoder encoder;
  LosslessDecoder decoder;
  LosslessPayload payload;
  Pose out;
  const AllocationGuard guard;
  for (const Pose& pose : poses)
    ASSERT_EQ(decoder.decode({payload.data(), encoder.encode(pose, payload)}, out),
              DecodeResult::kPose);
  EXPECT_EQ(guard.allocations(), 0u);
}

// Recordings are read years later, on other machines.
TEST(LosslessCodec, GoldenBytesStay) {
  const auto frames = expect_round_trip(moves(300, 8));
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  std::size_t bytes = 0;
  for (const Bytes& frame : frames) {
    bytes += frame.size();
    for (const std::uint8_t b : frame) hash = (hash ^ b) * 0x100000001b3ULL;
  }
  EXPECT_EQ(bytes, 47090u);
  EXPECT_EQ(hash, 0xc7f6082da0599b0ULL);
}

}  // namespace
}  // namespace dance
