// data/codec/body.model, embedded in this library by the assembler.
#include "core/base/assert.h"
#include "core/codec/pose_model.h"

// clang-format off
asm(".section .rodata\n"
    ".balign 8\n"
    "dance_built_in_model:\n"
    ".incbin \"" DANCE_MODEL_FILE "\"\n"
    "dance_built_in_model_end:\n"
    ".byte 0\n"
    ".previous\n");
// clang-format on
extern "C" {
extern const std::uint8_t dance_built_in_model[];
extern const std::uint8_t dance_built_in_model_end[];
}

namespace dance {

std::shared_ptr<const PoseModel> built_in_model() {
  static const std::shared_ptr<const PoseModel> kModel = [] {
    auto model = read_model({dance_built_in_model, dance_built_in_model_end});
    DANCE_ASSERT(model.has_value());  // a test reads it too
    return *model;
  }();
  return kModel;
}

}  // namespace dance
