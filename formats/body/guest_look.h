// GuestLook: the colours and clothes of a guest, made from the guest id alone, so that the same
// dancer looks the same on every screen without any agreement between them.
//
// Units/frames: colours are linear RGB in 0..1.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <array>
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

// 0xRRGGBB, as a screen shows them: chosen by eye on the stage's light, apart from each other, and
// from floor and backdrop. Skin goes from light to dark, hair from black to grey.
constexpr std::array<std::uint32_t, 6> kSkinColours{0xf0c8a8, 0xe2ab82, 0xc98a5e,
                                                    0xa66a43, 0x7d4c30, 0x5b3825};
constexpr std::array<std::uint32_t, 12> kTopColours{0xd8343f, 0x2f7fd1, 0xf2b632, 0x2ba18a,
                                                    0x8e4fc0, 0xf07a3a, 0xe0568f, 0x5aa83c,
                                                    0x37b6d9, 0xf3efe6, 0x4a58b8, 0xb9d24a};
constexpr std::array<std::uint32_t, 6> kHairColours{0x1d1613, 0x3a251a, 0x6b4226,
                                                    0xb98a4e, 0x8a3b22, 0x8f8a86};

// 0xRRGGBB as a screen shows it → linear RGB, and back to 0..1 as a screen takes it.
Eigen::Vector3f linear_from_srgb(std::uint32_t rgb);
Eigen::Vector3f srgb_from_linear(const Eigen::Vector3f& linear);

}  // namespace dance
