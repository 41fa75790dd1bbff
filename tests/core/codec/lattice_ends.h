// An encoder and a decoder of the lattice codec with the same dancer, for tests.
//
// Units/frames: metres.
// Ownership:    owns both.
// Threads:      none.
// Failure:      expectations of the test that uses it.
#pragma once

#include <gtest/gtest.h>

#include "core/codec/lattice/lattice_codec.h"
#include "core/codec/plain_codec.h"
#include "tests/core/codec/lattice_poses.h"

namespace dance {

using Payload = std::array<std::uint8_t, kMaxPosePayload>;

inline Skeleton as_sent(const Skeleton& skeleton) {
  std::array<std::uint8_t, kSkeletonPayload> bytes{};
  Skeleton sent;
  EXPECT_GT(encode_skeleton(skeleton, bytes), 0u);
  EXPECT_TRUE(decode_skeleton(bytes, sent));
  return sent;
}

struct Ends {
  explicit Ends(double allowed_m = 0.001, const Skeleton& body = average_skeleton())
      : skeleton(as_sent(body)),
        encoder(built_in_model()),
        decoder(built_in_model()),
        lattice(skeleton, built_in_model()->rest),
        error_m(allowed_m) {
    encoder.set_skeleton(skeleton);
    decoder.set_skeleton(skeleton);
    encoder.set_quality(error_m);
  }
  std::size_t encode(const Pose& pose) { return size = encoder.encode(pose, payload); }
  DecodeResult decode(const Pose& pose) {
    return decoder.decode(pose.sequence, {payload.data(), size}, got);
  }
  void expect_near(const Pose& given) {
    Pose unit = given;
    normalize(unit);
    LatticeBodyState seen;
    const TrueBody body = true_body(lattice, got);
    seen.joint = body.joint;
    seen.global = body.global;
    const BodyError error = error_of(lattice, true_body(lattice, unit), seen);
    // Floats of hips a kilometre away are 0.06 mm apart.
    EXPECT_LE(error.joint_m, error_m + 1e-5 + 1e-7 * static_cast<double>(given.p_WH_m.norm()))
        << given.sequence;
    EXPECT_LE(error.angle_rad, angle_budget_rad(error_m) + 1e-4) << given.sequence;
  }
  void expect_crosses(const Pose& pose) {
    ASSERT_GT(encode(pose), 0u) << pose.sequence;
    ASSERT_EQ(decode(pose), DecodeResult::kPose) << pose.sequence;
    expect_near(pose);
  }

  Skeleton skeleton;
  LatticeEncoder encoder;
  LatticeDecoder decoder;
  BodyLattice lattice;
  double error_m;
  Payload payload{};
  std::size_t size = 0;
  Pose got;
};

}  // namespace dance
