// What an avatar of the project's own making looks like: size, colours, clothes, hair and face.
// Two designs come with the project; any guest's look makes another.
//
// Units/frames: metres; colours are linear RGB in 0..1.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      find_design() gives nullopt for a name that no design has.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "formats/body/guest_look.h"

namespace dance {

enum class ClothPattern : std::uint8_t { kPlain, kDots, kStripes, kPetals };
enum class FaceShape : std::uint8_t { kSoft, kStrong };

struct AvatarDesign {
  std::string name;
  float height_m = 1.7f;
  // Legwear::kSkirt is a skirt that swings, the other two a sash that does.
  GuestLook look;
  FaceShape face = FaceShape::kSoft;
  ClothPattern pattern = ClothPattern::kPetals;
  Eigen::Vector3f pattern_colour = Eigen::Vector3f::Ones();
  Eigen::Vector3f sash = Eigen::Vector3f::Zero();
  Eigen::Vector3f eyes = Eigen::Vector3f::Zero();
  Eigen::Vector3f lips = Eigen::Vector3f::Zero();
};

// Those that come with the project: a follower in a dress, and a leader in shirt and trousers.
std::span<const std::string_view> design_names();
std::optional<AvatarDesign> find_design(std::string_view name);

// The clothes that a guest wears on the stage without an avatar.
AvatarDesign design_of(const GuestId& guest);

}  // namespace dance
