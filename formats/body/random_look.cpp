#include "formats/body/random_look.h"

#include "core/base/random.h"

namespace dance {
namespace {

template <typename Palette>
auto any_of(const Palette& palette, Random& random) {
  return palette[random.below(palette.size())];
}

}  // namespace

RandomLook random_look(GuestLook look, std::uint64_t seed) {
  Random random(seed);
  look.legwear = static_cast<Legwear>(random.below(3));
  look.sleeves = static_cast<Sleeves>(random.below(3));
  look.hair_style = static_cast<Hair>(random.below(4));
  look.skin = linear_from_srgb(any_of(kSkinColours, random));
  look.hair = linear_from_srgb(any_of(kHairColours, random));
  return {look, any_of(kTopColours, random)};
}

}  // namespace dance
