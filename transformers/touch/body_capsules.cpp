#include "transformers/touch/body_capsules.h"

#include <algorithm>

namespace dance {

using Eigen::Vector3f;

namespace {

// Of an adult of this height, from tables of girths; bones of others are as thick as they are tall.
constexpr float kCapsuleHeight_m = 1.72f;
constexpr std::array<float, kBoneCount> kCapsuleRadii_m{
    0.13f,  0.125f, 0.125f, 0.12f,
    0.06f,                            // hips to neck
    0.095f,                           // head
    0.06f,  0.048f, 0.038f, 0.028f,   // left arm
    0.06f,  0.048f, 0.038f, 0.028f,   // right arm
    0.08f,  0.055f, 0.04f,  0.035f,   // left leg
    0.08f,  0.055f, 0.04f,  0.035f};  // right leg
// The bone that each ends at; -1: at a tip of the body.
constexpr std::array<int, kBoneCount> kCapsuleEnds{1,  2,  3,  4,  5,  -1, 7,  8,  9,  -1, 11,
                                                   12, 13, -1, 15, 16, 17, -1, 19, 20, 21, -1};
constexpr std::array<BodyPart, kBoneCount> kPartOfBone{
    BodyPart::kTrunk, BodyPart::kTrunk, BodyPart::kTrunk, BodyPart::kTrunk, BodyPart::kHead,
    BodyPart::kHead,  BodyPart::kTrunk, BodyPart::kArmL,  BodyPart::kArmL,  BodyPart::kHandL,
    BodyPart::kTrunk, BodyPart::kArmR,  BodyPart::kArmR,  BodyPart::kHandR, BodyPart::kLegL,
    BodyPart::kLegL,  BodyPart::kLegL,  BodyPart::kLegL,  BodyPart::kLegR,  BodyPart::kLegR,
    BodyPart::kLegR,  BodyPart::kLegR};

Vector3f capsule_tip(std::size_t bone, const BodyFrames& frames) {
  for (std::size_t tip = 0; tip < kTipCount; ++tip)
    if (index_of(kTipBones[tip]) == bone) return frames.p_WT_m[tip];
  return frames.p_WB_m[bone];
}

}  // namespace

BodyPart part_of(Bone bone) { return kPartOfBone[index_of(bone)]; }

// The nearest points of two segments p + s u and q + t v (Ericson, Real-Time Collision Detection,
// section 5.1.9).
Nearness nearness_of(const Capsule& a, const Capsule& b) {
  const Vector3f u = a.to - a.from, v = b.to - b.from, w = a.from - b.from;
  const float uu = u.squaredNorm(), vv = v.squaredNorm(), vw = v.dot(w);
  constexpr float kPoint = 1e-10f;
  float s = 0.0f, t = 0.0f;
  if (uu > kPoint) {
    const float uw = u.dot(w);
    if (vv <= kPoint) {
      s = std::clamp(-uw / uu, 0.0f, 1.0f);
    } else {
      const float uv = u.dot(v), parallel = uu * vv - uv * uv;
      if (parallel > 1e-6f * uu * vv) s = std::clamp((uv * vw - uw * vv) / parallel, 0.0f, 1.0f);
      t = (uv * s + vw) / vv;
      if (t < 0.0f || t > 1.0f) {
        t = std::clamp(t, 0.0f, 1.0f);
        s = std::clamp((uv * t - uw) / uu, 0.0f, 1.0f);
      }
    }
  } else if (vv > kPoint) {
    t = std::clamp(vw / vv, 0.0f, 1.0f);
  }
  const Vector3f on_a = a.from + s * u, on_b = b.from + t * v;
  return {(on_a - on_b).norm() - a.radius_m - b.radius_m, 0.5f * (on_a + on_b)};
}

BodyCapsules BodyCapsules::of(const Skeleton& skeleton, const BodyFrames& frames) {
  const float size = std::clamp(standing_height_m(skeleton) / kCapsuleHeight_m, 0.3f, 2.0f);
  BodyCapsules body;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    body.of_bone[b] = {frames.p_WB_m[b],
                       kCapsuleEnds[b] < 0
                           ? capsule_tip(b, frames)
                           : frames.p_WB_m[static_cast<std::size_t>(kCapsuleEnds[b])],
                       size * kCapsuleRadii_m[b]};
  return body;
}

}  // namespace dance
