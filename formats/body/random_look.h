// A look by chance, for a dancer who asks to be surprised.
#pragma once

#include <cstdint>

#include "formats/body/guest_look.h"

namespace dance {

struct RandomLook {
  GuestLook look;
  std::uint32_t top = 0;  // sRGB, of kTopColours
};

// Clothes, skin and hair by chance; all else is that of `look`.
RandomLook random_look(GuestLook look, std::uint64_t seed);

}  // namespace dance
