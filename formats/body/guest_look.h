// GuestLook: the colours and clothes of a guest, made from the guest id alone, so that the same
// dancer looks the same on every screen without any agreement between them.
//
// Units/frames: colours are linear RGB in 0..1.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/guest_id.h"

namespace dance {

enum class Sleeves : std::uint8_t { kNone, kShort, kLong };
enum class Legwear : std::uint8_t { kTrousers, kFlared, kSkirt };
enum class Hair : std::uint8_t { kShort, kBob, kBun, kPonytail };

struct GuestLook {
  Eigen::Vector3f skin;
  Eigen::Vector3f top;
  Eigen::Vector3f legs;
  Eigen::Vector3f shoes;
  Eigen::Vector3f hair;
  Eigen::Vector3f tag;  // the guest's own colour, light enough for text
  Sleeves sleeves = Sleeves::kShort;
  Legwear legwear = Legwear::kTrousers;
  Hair hair_style = Hair::kShort;
};

GuestLook look_of(const GuestId& guest);

// 0xRRGGBB as a screen shows it → linear RGB, and back to 0..1 as a screen takes it.
Eigen::Vector3f linear_from_srgb(std::uint32_t rgb);
Eigen::Vector3f srgb_from_linear(const Eigen::Vector3f& linear);

}  // namespace dance
