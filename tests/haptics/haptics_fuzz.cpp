// Touches, beats and haptics as a stranger on the bus might send them: whatever decodes makes
// haptics that are valid, and mixes to samples within bounds.
#include <array>
#include <cstdint>

#include "core/base/assert.h"
#include "core/bus/encode.h"
#include "haptics/haptic_maker.h"
#include "haptics/sound/tone_mixer.h"
#include "tests/fuzz_target.h"

namespace {

struct ValidOnly final : dance::HapticSink {
  void on_haptic(const dance::Haptic& haptic) override {
    DANCE_ASSERT(dance::is_valid(haptic), haptic.number);
  }
};

}  // namespace

DANCE_FUZZ_TARGET(haptics) {
  using dance::Decoded;
  ValidOnly sink;
  dance::HapticMaker maker({}, 1, 1);
  dance::Touch touch;
  if (dance::decode(data, size, touch) == Decoded::kFine)
    for (int i = 0; i < 3; ++i) maker.take(touch, touch.time + dance::Duration::ms(200 * i), sink);
  dance::Beat beat;
  if (dance::decode(data, size, beat) == Decoded::kFine) {
    maker.hear(beat);
    maker.look_ahead(beat.time, sink);
  }
  dance::Haptic haptic;
  if (dance::decode(data, size, haptic) == Decoded::kFine) {
    dance::ToneMixer mixer(48000.0);
    mixer.add(haptic);
    std::array<float, 256> samples{};
    mixer.mix(samples);
    for (const float sample : samples) DANCE_ASSERT(sample >= -1.0f && sample <= 1.0f, sample);
  }
  return 0;
}
