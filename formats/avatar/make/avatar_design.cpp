#include "formats/avatar/make/avatar_design.h"

#include <array>

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::array<std::string_view, 2> kNames{"marisol", "teo"};

AvatarDesign follower() {
  AvatarDesign design;
  design.name = kNames[0];
  design.height_m = 1.66f;
  GuestLook& look = design.look;
  look.skin = linear_from_srgb(0xdca27a);
  look.top = linear_from_srgb(0xc4203a);
  look.legs = linear_from_srgb(0xc4203a);
  look.shoes = linear_from_srgb(0xc99a5b);
  look.hair = linear_from_srgb(0x2c1a14);
  look.tag = linear_from_srgb(0xff8a94);
  look.sleeves = Sleeves::kNone;
  look.legwear = Legwear::kSkirt;
  look.hair_style = Hair::kPonytail;
  design.pattern = ClothPattern::kPetals;
  design.pattern_colour = linear_from_srgb(0xffc04d);
  design.sash = linear_from_srgb(0x571029);
  design.eyes = linear_from_srgb(0x6a3b18);
  design.lips = linear_from_srgb(0xb03a44);
  return design;
}

AvatarDesign leader() {
  AvatarDesign design;
  design.name = kNames[1];
  design.height_m = 1.79f;
  GuestLook& look = design.look;
  look.skin = linear_from_srgb(0x9c6742);
  look.top = linear_from_srgb(0xf0e9dc);
  look.legs = linear_from_srgb(0x2a3350);
  look.shoes = linear_from_srgb(0x5a3520);
  look.hair = linear_from_srgb(0x16110f);
  look.tag = linear_from_srgb(0x8fb4ff);
  look.sleeves = Sleeves::kShort;
  look.legwear = Legwear::kTrousers;
  look.hair_style = Hair::kShort;
  design.face = FaceShape::kStrong;
  design.pattern = ClothPattern::kStripes;
  design.pattern_colour = linear_from_srgb(0x7fa3c4);
  design.sash = linear_from_srgb(0xb3202f);
  design.eyes = linear_from_srgb(0x3a2716);
  design.lips = linear_from_srgb(0x8a4a3c);
  return design;
}

}  // namespace

std::span<const std::string_view> design_names() { return kNames; }

std::optional<AvatarDesign> find_design(std::string_view name) {
  if (name == kNames[0]) return follower();
  if (name == kNames[1]) return leader();
  return std::nullopt;
}

AvatarDesign design_of(const GuestId& guest) {
  AvatarDesign design;
  design.name = guest.view();
  design.look = look_of(guest);
  const bool has_skirt = design.look.legwear == Legwear::kSkirt;
  design.face = has_skirt ? FaceShape::kSoft : FaceShape::kStrong;
  design.height_m = has_skirt ? 1.66f : 1.76f;
  design.pattern = has_skirt ? ClothPattern::kDots : ClothPattern::kStripes;
  const Vector3f& top = design.look.top;
  design.pattern_colour = 0.35f * top + Vector3f::Constant(0.6f);
  design.sash = design.look.legwear == Legwear::kSkirt ? Vector3f(0.4f * top)
                                                       : Vector3f(0.7f * design.look.tag);
  design.eyes = linear_from_srgb(0x4a3020);
  design.lips = design.look.skin.cwiseProduct(Vector3f(0.75f, 0.38f, 0.36f));
  return design;
}

}  // namespace dance
