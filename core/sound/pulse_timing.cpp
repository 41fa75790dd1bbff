#include "core/sound/pulse_timing.h"

#include <pulse/pulseaudio.h>

namespace dance {

PulseTiming::~PulseTiming() {
  if (question_ == nullptr) return;
  pa_operation_cancel(question_);
  pa_operation_unref(question_);
}

void PulseTiming::ask(pa_stream* stream, void (*on_answer)(pa_stream*, int, void*), void* self) {
  if (question_ != nullptr) {
    if (pa_operation_get_state(question_) == PA_OPERATION_RUNNING) return;
    pa_operation_unref(question_);
  }
  question_ = pa_stream_update_timing_info(stream, on_answer, self);
}

}  // namespace dance
