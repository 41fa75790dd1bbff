#include "core/codec/lattice/lattice_codec.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/allocation_guard.h"
#include "tests/core/codec/lattice_ends.h"

namespace dance {
namespace {

bool same_bits(const Pose& a, const Pose& b) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (a.R_PB[i].coeffs() != b.R_PB[i].coeffs()) return false;
  return a.p_WH_m == b.p_WH_m && a.presence == b.presence;
}

TEST(LatticeCodec, NoJointIsFurtherOffThanWasAskedFor) {
  for (const double error_m : {0.0005, 0.001, 0.002, 0.005}) {
    Ends ends(error_m);
    Random random(3);
    for (std::uint32_t i = 0; i < 400; ++i) ends.expect_crosses(dance_frame(i, random));
  }
}

TEST(LatticeCodec, FewerBytesForAGreaterErrorAndForANearerReference) {
  const auto bytes = [](double error_m, std::uint32_t age) {
    Ends ends(error_m);
    ends.encoder.refer_to_age(age);
    Random random(3);
    std::size_t sum = 0;
    for (std::uint32_t i = 0; i < 300; ++i) sum += ends.encode(dance_frame(i, random));
    return sum;
  };
  EXPECT_LT(bytes(0.005, 1), bytes(0.002, 1));
  EXPECT_LT(bytes(0.002, 1), bytes(0.001, 1));
  EXPECT_LT(bytes(0.001, 1), bytes(0.0005, 1));
  EXPECT_LT(bytes(0.001, 1), bytes(0.001, 4));
}

TEST(LatticeCodec, AnyRotationsCrossWithinTheError) {
  Ends ends;
  Random random(5);
  for (std::uint32_t i = 0; i < 2000; ++i) ends.expect_crosses(any_pose(i, random));
}

TEST(LatticeCodec, ThereIsNoCliffAtHalfTurnsAndUpsideDown) {
  // Every bone, turned by angles around half a turn and none, about every axis.
  Ends ends;
  std::uint32_t sequence = 0;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    for (const double angle :
         {0.0, 1e-7, 1e-3, M_PI / 2, M_PI - 1e-3, M_PI - 1e-6, M_PI, M_PI + 1e-6, 2 * M_PI - 1e-4})
      for (const Eigen::Vector3d& axis :
           {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d::UnitY().eval(),
            Eigen::Vector3d::UnitZ().eval(), Eigen::Vector3d(1, -1, 1).normalized().eval()}) {
        Pose pose;
        pose.R_PB[bone] = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)).cast<float>();
        pose.sequence = sequence++;
        ends.expect_crosses(pose);
        pose.R_PB[bone].coeffs() *= -1.0f;  // the same rotation
        pose.sequence = sequence++;
        ends.expect_crosses(pose);
      }
}

TEST(LatticeCodec, GlitchesOfTenThousandDegreesASecondCross) {
  Ends ends;
  Random random(7);
  for (std::uint32_t i = 0; i < 300; ++i) {
    Pose pose = dance_frame(i, random);
    if (i % 10 == 5)
      for (auto& q : pose.R_PB)
        q = q * Eigen::Quaterniond(
                    Eigen::AngleAxisd(9500.0 / 60.0 * M_PI / 180.0, Eigen::Vector3d::UnitX()))
                    .cast<float>();
    ends.expect_crosses(pose);
  }
}

TEST(LatticeCodec, BonesOfNoLengthAndGiantsCross) {
  Skeleton flat = average_skeleton();
  flat.offset_m[index_of(Bone::kSpine)].setZero();
  flat.offset_m[index_of(Bone::kNeck)].setZero();
  flat.offset_m[index_of(Bone::kLeftShoulder)].setZero();
  flat.tip_m[0].setZero();
  for (const Skeleton& skeleton : {flat, average_skeleton(0.6f), average_skeleton(3.0f)}) {
    Ends ends(0.001, skeleton);
    Random random(9);
    for (std::uint32_t i = 0; i < 200; ++i) ends.expect_crosses(dance_frame(i, random));
    for (std::uint32_t i = 200; i < 300; ++i) ends.expect_crosses(any_pose(i, random));
  }
}

TEST(LatticeCodec, WhatIsNoPoseIsRefused) {
  Ends ends;
  Random random(1);
  Pose pose = dance_frame(0, random);
  const auto refused = [&](auto&& spoil) {
    Pose bad = pose;
    spoil(bad);
    return ends.encoder.encode(bad, ends.payload) == 0;
  };
  EXPECT_TRUE(refused([](Pose& p) { p.R_PB[3].x() = NAN; }));
  EXPECT_TRUE(refused([](Pose& p) { p.R_PB[3].coeffs().setZero(); }));
  EXPECT_TRUE(refused([](Pose& p) { p.R_PB[3].coeffs() *= 1.5f; }));
  EXPECT_TRUE(refused([](Pose& p) { p.p_WH_m.x() = INFINITY; }));
  EXPECT_TRUE(refused([](Pose& p) { p.confidence = 2.0f; }));
  EXPECT_FALSE(refused([](Pose& p) { p.R_PB[3].coeffs() *= 1.005f; }));
}

TEST(LatticeCodec, PresenceConfidenceAndMusicCross) {
  Ends ends;
  Random random(11);
  double beats = 3.0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    Pose pose = dance_frame(i, random);
    if (i % 50 > 30) pose.presence = static_cast<std::uint32_t>(random.below(1u << kBoneCount));
    pose.confidence = i % 7 == 0 ? static_cast<float>(random.uniform()) : 1.0f;
    beats += i % 100 == 99 ? random.uniform(-1e6, 1e6) : 2.4 / 60.0;
    if (i > 100 && i % 200 < 150) pose.music_beats = beats;
    ends.expect_crosses(pose);
    EXPECT_EQ(ends.got.presence, pose.presence);
    EXPECT_NEAR(ends.got.confidence, pose.confidence, 0.5 / 63.0 + 1e-6);
    EXPECT_EQ(std::isfinite(ends.got.music_beats), std::isfinite(pose.music_beats));
    if (std::isfinite(pose.music_beats)) {
      EXPECT_NEAR(ends.got.music_beats, pose.music_beats, 0.5 / 1024.0);
    }
  }
}

TEST(LatticeCodec, MusicOfAnyLengthCrossesAndWhatIsNoneIsLeftOut) {
  Ends ends;
  Random random(12);
  std::uint32_t i = 0;
  for (const double beats : {0.0, -1e6, 1e10, 5.9e10, -5.9e10}) {
    for (int k = 0; k < 20; ++k) {
      Pose pose = dance_frame(i++, random);
      pose.music_beats = beats + 0.04 * k;
      ends.expect_crosses(pose);
      EXPECT_NEAR(ends.got.music_beats, pose.music_beats, 0.5 / 1024.0 + 1e-5);
    }
  }
  Pose pose = dance_frame(i, random);
  pose.music_beats = 1e300;
  ends.expect_crosses(pose);
  EXPECT_FALSE(std::isfinite(ends.got.music_beats));
}

TEST(LatticeCodec, AnAcknowledgementFromBeforeAnIntraFrameCountsNoMore) {
  Ends ends;
  ends.encoder.set_references(References::kAcknowledged);
  Random random(14);
  for (std::uint32_t i = 0; i < 5; ++i) ends.expect_crosses(dance_frame(i, random));
  ends.encoder.request_intra();
  for (std::uint32_t i = 0; i < 5; ++i) ends.encoder.acknowledged(i);
  // To one who has nothing at all.
  LatticeDecoder late(built_in_model());
  late.set_skeleton(ends.skeleton);
  for (std::uint32_t i = 5; i < 8; ++i) {
    ASSERT_GT(ends.encode(dance_frame(i, random)), 0u);
    Pose got;
    EXPECT_EQ(late.decode(i, {ends.payload.data(), ends.size}, got), DecodeResult::kPose) << i;
  }
}

TEST(LatticeCodec, SequencesWrapAndPacesDiffer) {
  for (const int period_us : {8'333, 16'667, 33'333, 66'667}) {
    Ends ends;
    Random random(13);
    for (std::uint32_t i = 0; i < 200; ++i) {
      Pose pose = dance_frame(i, random);
      pose.sequence = i - 100;
      pose.capture_time = MonoTime::from_us(1'000'000 + static_cast<std::int64_t>(i) * period_us);
      ends.expect_crosses(pose);
    }
  }
}

TEST(LatticeCodec, WhoMissesAFrameAsksAndAnIntraFrameHeals) {
  Ends ends;
  Random random(17);
  for (std::uint32_t i = 0; i < 10; ++i) ends.expect_crosses(dance_frame(i, random));
  ends.encode(dance_frame(10, random));  // lost
  const Pose next = dance_frame(11, random);
  ends.encode(next);
  EXPECT_EQ(ends.decode(next), DecodeResult::kReferenceMissing);
  ends.encoder.request_intra();
  for (std::uint32_t i = 12; i < 20; ++i) ends.expect_crosses(dance_frame(i, random));
}

TEST(LatticeCodec, ANewcomerDecodesFromAnIntraFrameOnWhatAllOthersDo) {
  Ends ends;
  LatticeDecoder late(built_in_model());
  late.set_skeleton(ends.skeleton);
  Random random(19);
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Pose pose = dance_frame(i, random);
    if (i == 100) ends.encoder.request_intra();
    ends.expect_crosses(pose);
    Pose got;
    const DecodeResult result = late.decode(i, {ends.payload.data(), ends.size}, got);
    EXPECT_EQ(result == DecodeResult::kPose, i == 0 || i >= 1) << i;
    EXPECT_TRUE(same_bits(got, ends.got)) << i;
  }
}

TEST(LatticeCodec, AnotherSkeletonIsNamedAsMissing) {
  Ends ends;
  Random random(23);
  LatticeDecoder other(built_in_model());
  other.set_skeleton(as_sent(average_skeleton(1.9f)));
  const Pose pose = dance_frame(0, random);
  ends.encode(pose);
  Pose got;
  EXPECT_EQ(other.decode(0, {ends.payload.data(), ends.size}, got), DecodeResult::kSkeletonMissing);
  other.set_skeleton(ends.skeleton);
  EXPECT_EQ(other.decode(0, {ends.payload.data(), ends.size}, got), DecodeResult::kPose);
}

TEST(LatticeCodec, ThePreviousFrameTwiceBearsEveryOtherLoss) {
  Ends ends;
  ends.encoder.set_references(References::kPreviousTwice);
  Random random(29);
  for (std::uint32_t i = 0; i < 400; ++i) {
    const Pose pose = dance_frame(i, random);
    ASSERT_GT(ends.encode(pose), 0u);
    if (i % 2 == 1) continue;  // lost
    ASSERT_EQ(ends.decode(pose), DecodeResult::kPose) << i;
    ends.expect_near(pose);
    if (i > 1) {
      EXPECT_NE(ends.decoder.find(i - 1), nullptr) << "the lost one comes with the next";
    }
  }
}

TEST(LatticeCodec, DamagedBytesNeverLeadAstrayForLong) {
  Ends ends;
  Random random(41);
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const Pose pose = dance_frame(i, random);
    ASSERT_GT(ends.encode(pose), 0u);
    Payload bad = ends.payload;
    for (std::size_t k = 0; k <= i % 3; ++k)
      bad[random.below(ends.size)] ^= static_cast<std::uint8_t>(1u << random.below(8));
    Pose got;
    LatticeDecoder& decoder = ends.decoder;
    decoder.decode(pose.sequence + 1'000'000, {bad.data(), random.below(ends.size + 1)}, got);
    if (decoder.decode(pose.sequence + 2'000'000, {bad.data(), ends.size}, got) ==
        DecodeResult::kPose) {
      EXPECT_TRUE(is_valid(got));
    }
    ASSERT_EQ(ends.decode(pose), DecodeResult::kPose);
    ends.expect_near(pose);
  }
}

TEST(LatticeCodec, NeitherEndAllocates) {
  Ends ends;
  Random random(43);
  ends.expect_crosses(dance_frame(0, random));
  for (const References policy :
       {References::kPrevious, References::kPreviousTwice, References::kAcknowledged}) {
    ends.encoder.set_references(policy);
    std::vector<Pose> poses;
    static std::uint32_t next = 1;
    for (int i = 0; i < 50; ++i) poses.push_back(dance_frame(next++, random));
    const AllocationGuard guard;
    for (const Pose& pose : poses) {
      ends.encode(pose);
      ends.decode(pose);
      ends.encoder.acknowledged(pose.sequence);
    }
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

TEST(LatticeCodec, TheGenericModelSpeaksTheSameFormat) {
  const auto model = generic_model();
  LatticeEncoder encoder(model);
  LatticeDecoder decoder(model);
  EXPECT_EQ(encoder.name(), (CodecName{CodecId::kLattice, 0}));
  Random random(47);
  Payload payload{};
  Pose got;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const std::size_t size = encoder.encode(dance_frame(i, random), payload);
    ASSERT_GT(size, 0u);
    ASSERT_EQ(decoder.decode(i, {payload.data(), size}, got), DecodeResult::kPose);
  }
}

TEST(PoseModel, IsReadAsItWasWrittenAndRefusedWhenDamaged) {
  const std::vector<std::uint8_t> file = write_model(*built_in_model());
  const auto again = read_model(file);
  ASSERT_TRUE(again);
  EXPECT_EQ((*again)->name, built_in_model()->name);
  EXPECT_NE((*again)->name, generic_model()->name);
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, file.size() / 2, file.size() - 1})
    EXPECT_FALSE(read_model(std::span(file).first(size))) << size;
  std::vector<std::uint8_t> other = file;
  other[4] ^= 1;  // version
  ASSERT_FALSE(read_model(other));
  EXPECT_NE(read_model(other).error().what.find("version"), std::string::npos);
  other = file;
  // The first coordinate of an intra frame has none before it to look at.
  const std::size_t intra_begin = 6 + kBoneCount * 14 + 2 * 4 * (kTableSteps + 1);
  other[intra_begin] = 200;
  EXPECT_FALSE(read_model(other));
  other = file;
  other[6 + 1] ^= 0x7c;  // the first number is infinite or another
  const auto changed = read_model(other);
  if (changed) {
    EXPECT_NE((*changed)->name, built_in_model()->name) << "another model has another name";
  }
}

TEST(PoseModel, HalvesHoldNumbersWithinTheirPrecision) {
  for (const float x : {0.0f, 1.0f, -1.0f, 0.333333f, 6e-5f, 1e-6f, 1234.5f, -65000.0f})
    EXPECT_NEAR(from_half(to_half(x)), x, std::abs(x) / 2048.0f + 6e-8f) << x;
  for (std::uint32_t half = 0; half < 0x7c00; ++half)
    EXPECT_EQ(to_half(from_half(static_cast<std::uint16_t>(half))), half);
}

// A producer at half the rate counts by twos, and its frames must be checked as well.
TEST(LatticeFrame, IsCheckedOftenWhateverStepSequencesCountBy) {
  for (std::uint32_t stride = 1; stride <= 8; ++stride) {
    std::uint32_t longest = 0, since = 0, checked = 0;
    constexpr std::uint32_t kFrames = 32'000;
    for (std::uint32_t i = 0; i < kFrames; ++i, ++since) {
      if (!has_check(0xffff'0000u + i * stride)) continue;
      longest = std::max(longest, since);
      since = 0;
      ++checked;
    }
    EXPECT_NEAR(checked, kFrames / 32, 100) << stride;
    EXPECT_LT(longest, 200u) << stride;
  }
}

}  // namespace
}  // namespace dance
