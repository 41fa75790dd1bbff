// What an emulated line does to datagrams, and its one-line notation:
//   delay=80ms jitter=10ms tail=5ms loss=1% burst=3 dup=0.1% reorder=1% rate=1Mbit queue=50ms
//   seed=1
//
// Units/frames: all of it is per direction; probabilities are 0..1 inside, per cent in the
//               notation.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      parse() names the bad word and what it should be.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

struct LossySpec {
  Duration delay;     // one way
  Duration jitter;    // delay varies evenly by ± this; order is kept
  Duration tail;      // mean of a gamma-distributed delay (shape 2) on top; late ones are overtaken
  double loss = 0.0;  // part of the datagrams that is lost, on average
  double burst = 1.0;                 // mean number of datagrams lost in a row; 1 = independent
  double duplicate = 0.0;             // part that comes twice
  double reorder = 0.0;               // part that is held back so that later ones overtake it
  double rate_bps = 0.0;              // bits a second; 0 = no limit
  Duration queue = Duration::ms(50);  // with a rate: what would wait longer is dropped
  std::uint64_t seed = 1;

  // Words are parted by blanks or commas; an empty text is a perfect line.
  static Result<LossySpec> parse(std::string_view text);
};

}  // namespace dance
