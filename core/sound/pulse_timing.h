// PulseTiming: an asynchronous request of a stream's timing, cancelled with the stream.
//
// Units/frames: none.
// Ownership:    holds the request until it is answered; the destructor cancels it. Part
//               of the object that is asked for, so that both go together.
// Threads:      none inside: answers come in PulseServer::iterate().
// Failure:      a request that the server refuses, or does not answer, stays without an answer.
#pragma once

struct pa_operation;
struct pa_stream;

namespace dance {

class PulseTiming {
 public:
  PulseTiming() = default;
  ~PulseTiming();
  PulseTiming(const PulseTiming&) = delete;
  PulseTiming& operator=(const PulseTiming&) = delete;

  // on_answer(stream, is_good, self), once. While an answer is on its way nothing more is asked,
  // so that a slow server has time to give one.
  void ask(pa_stream* stream, void (*on_answer)(pa_stream*, int, void*), void* self);

 private:
  pa_operation* question_ = nullptr;
};

}  // namespace dance
