// What a face's 52 expressions are in the few that VRM has: vowels of the mouth, and the lids.
//
// Units/frames: weights 0…1.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
// Source:       names: VRM 1.0, VRMC_vrm expressions.
#pragma once

#include <algorithm>

#include "core/pose/face.h"

namespace dance {

struct VrmFace {
  float aa = 0.0f, ih = 0.0f, ou = 0.0f, ee = 0.0f, oh = 0.0f;
  // Of both eyes, and what one does beyond that.
  float blink = 0.0f, blink_left = 0.0f, blink_right = 0.0f;
};

inline VrmFace vrm_face(const Face& face) {
  using E = Expression;
  const float open = face[E::kJawOpen], round = face[E::kMouthFunnel];
  const float wide = 0.5f * (face[E::kMouthStretchLeft] + face[E::kMouthStretchRight]);
  const float left = face[E::kEyeBlinkLeft], right = face[E::kEyeBlinkRight];
  VrmFace vrm;
  vrm.aa = open * (1.0f - round);
  vrm.ih = wide * (1.0f - open);
  vrm.ou = face[E::kMouthPucker];
  vrm.ee = 0.5f * wide * open;
  vrm.oh = round;
  vrm.blink = std::min(left, right);
  vrm.blink_left = left - vrm.blink;
  vrm.blink_right = right - vrm.blink;
  return vrm;
}

}  // namespace dance
