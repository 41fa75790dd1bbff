// data/music/beats.model, as bytes of this library: included by the assembler.
#include "core/base/assert.h"
#include "producers/music/tracker/beat_model.h"

// clang-format off
asm(".section .rodata\n"
    ".balign 8\n"
    "dance_built_in_beat_model:\n"
    ".incbin \"" DANCE_BEAT_MODEL_FILE "\"\n"
    "dance_built_in_beat_model_end:\n"
    ".byte 0\n"
    ".previous\n");
// clang-format on
extern "C" {
extern const std::uint8_t dance_built_in_beat_model[];
extern const std::uint8_t dance_built_in_beat_model_end[];
}

namespace dance {

std::shared_ptr<const BeatModel> built_in_beat_model() {
  static const std::shared_ptr<const BeatModel> kModel = [] {
    auto model = read_beat_model({dance_built_in_beat_model, dance_built_in_beat_model_end});
    DANCE_ASSERT(model.has_value());  // a test reads it too
    return *model;
  }();
  return kModel;
}

}  // namespace dance
