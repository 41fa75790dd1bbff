// data/predict/dance.model, as bytes of this library: the assembler takes the file in.
#include "core/base/assert.h"
#include "transformers/predict/predict_model.h"

// clang-format off
asm(".section .rodata\n"
    ".balign 8\n"
    "dance_built_in_predict_model:\n"
    ".incbin \"" DANCE_PREDICT_MODEL_FILE "\"\n"
    "dance_built_in_predict_model_end:\n"
    ".byte 0\n"
    ".previous\n");
// clang-format on
extern "C" {
extern const std::uint8_t dance_built_in_predict_model[];
extern const std::uint8_t dance_built_in_predict_model_end[];
}

namespace dance {

std::shared_ptr<const PredictModel> built_in_predict_model() {
  static const std::shared_ptr<const PredictModel> kModel = [] {
    auto model =
        read_predict_model({dance_built_in_predict_model, dance_built_in_predict_model_end});
    DANCE_ASSERT(model.has_value());  // a test reads it too
    return *model;
  }();
  return kModel;
}

}  // namespace dance
