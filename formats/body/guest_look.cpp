#include "formats/body/guest_look.h"

#include <cmath>

#include "core/base/fnv1a.h"
#include "core/base/random.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// Chosen by eye, like the colours in the header.
constexpr std::array<std::uint32_t, 6> kTrousers{0x2b3042, 0x3d4c6b, 0x3a3532,
                                                 0x5a4a3f, 0x24292e, 0x6d6f78};
constexpr std::array<std::uint32_t, 5> kShoes{0x1c1b1d, 0xf1ece2, 0x8a5a33, 0xb02a30, 0x3a3f4a};

// Where the hash starts: chosen so that the dancers of the documents and the demo get different
// colours.
constexpr std::uint64_t kTaste = 31893;

std::uint64_t hash_of(const GuestId& guest) { return fnv1a(guest.view(), kFnvBegin ^ kTaste); }

float linear_channel(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}
float srgb_channel(float l) {
  return l <= 0.0031308f ? 12.92f * l : 1.055f * std::pow(l, 1.0f / 2.4f) - 0.055f;
}

template <std::size_t kSize>
Vector3f pick(Random& random, const std::array<std::uint32_t, kSize>& palette) {
  return linear_from_srgb(palette[random.below(kSize)]);
}

}  // namespace

Vector3f linear_from_srgb(std::uint32_t rgb) {
  const auto channel = [rgb](unsigned shift) {
    return linear_channel(static_cast<float>((rgb >> shift) & 0xffu) / 255.0f);
  };
  return {channel(16), channel(8), channel(0)};
}

Vector3f srgb_from_linear(const Vector3f& linear) {
  return {srgb_channel(linear.x()), srgb_channel(linear.y()), srgb_channel(linear.z())};
}

GuestLook look_of(const GuestId& guest) {
  Random random(hash_of(guest));
  GuestLook look;
  look.top = pick(random, kTopColours);
  look.skin = pick(random, kSkinColours);
  look.hair = pick(random, kHairColours);
  look.shoes = pick(random, kShoes);
  look.hair_style = static_cast<Hair>(random.below(4));
  look.sleeves = static_cast<Sleeves>(random.below(3));
  look.legwear = static_cast<Legwear>(random.below(3));
  look.legs = pick(random, kTrousers);
  // A skirt is the lower half of a dress: of the top's colour, a little deeper.
  if (look.legwear == Legwear::kSkirt) look.legs = 0.8f * look.top;
  look.tag = 0.75f * look.top + Vector3f::Constant(0.25f);
  return look;
}

}  // namespace dance
