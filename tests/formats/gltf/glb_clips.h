// Dances for the tests of GLB files.
//
// Threads: none inside.
// Failure: none.
#pragma once

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/pose/kinematics.h"
#include "formats/gltf/glb.h"
#include "tests/core/pose/random_pose.h"

namespace dance::test {

// Random rotations of all bones, swept smoothly; with hands also of all finger bones.
inline NamedClip random_dance(const char* name, std::uint64_t seed, std::size_t frames,
                              bool has_hands) {
  Random random(seed);
  NamedClip named;
  named.name = name;
  MotionClip& clip = named.clip;
  clip.skeleton = average_skeleton(1.55f + 0.35f * static_cast<float>(random.uniform()));
  clip.frame_hz = 60.0;
  clip.frames.resize(frames);
  if (has_hands) clip.hands.resize(frames);
  for (std::size_t f = 1; f < frames; ++f) {
    for (auto& rotation : clip.frames[f].R_PB) rotation = random_rotation(random, 1.0f);
    clip.frames[f].p_WH_m += Eigen::Vector3f(static_cast<float>(random.uniform(-3.0, 3.0)),
                                             static_cast<float>(random.uniform(-0.2, 0.2)),
                                             static_cast<float>(random.uniform(-3.0, 3.0)));
    if (!has_hands) continue;
    for (auto& rotation : clip.hands[f].R_PB) rotation = random_rotation(random, 0.5f);
    clip.hands[f].presence = (1u << kFingerBoneCount) - 1;
  }
  return named;
}

inline void expect_same_places(const MotionClip& a, const MotionClip& b, float within_m = 1e-4f) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  BodyFrames in_a;
  BodyFrames in_b;
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    forward_kinematics(a.skeleton, a.frames[f], in_a);
    forward_kinematics(b.skeleton, b.frames[f], in_b);
    for (std::size_t bone = 0; bone < kBoneCount; ++bone)
      ASSERT_LT((in_a.p_WB_m[bone] - in_b.p_WB_m[bone]).norm(), within_m)
          << kBones[bone].name << " in frame " << f;
    for (std::size_t tip = 0; tip < kTipCount; ++tip)
      ASSERT_LT((in_a.p_WT_m[tip] - in_b.p_WT_m[tip]).norm(), within_m)
          << "tip " << tip << " in frame " << f;
  }
}

}  // namespace dance::test
