// PulseInput: what a microphone hears, or what a sink plays (its monitor), as mono samples, and
// when each of them sounded, as far as the sound server knows.
//
// Units/frames: samples -1 to 1 at the requested rate; frames count from the stream's begin. `trim`
//               is a latency that the server does not know of.
// Ownership:    refers to the server, which must outlive it.
// Threads:      none inside: callbacks run in PulseServer::iterate().
// Failure:      open() names what the server refused; is_alive() is false once the stream has
//               ended.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/sound/pulse_server.h"
#include "core/sound/pulse_timing.h"
#include "core/sound/stream_clock.h"

struct pa_stream;

namespace dance {

struct PulseInputOptions {
  std::string source;  // its name for the server; "" = its default
  double rate_hz = 48000.0;
  std::string name = "listening";            // of the stream, as the server's own tools show it
  Duration timeout = PulseServer::kTimeout;  // open() waits so long for the server
};

class PulseInput {
 public:
  using OnSamples = std::function<void(std::span<const float> samples)>;

  static Result<std::unique_ptr<PulseInput>> open(PulseServer& server,
                                                  const PulseInputOptions& options,
                                                  OnSamples on_samples);
  ~PulseInput();
  PulseInput(const PulseInput&) = delete;
  PulseInput& operator=(const PulseInput&) = delete;

  bool is_alive() const;
  // Once the server's answers have come; samples before that have no time.
  bool is_timed() const { return clock_.is_known(); }
  // When the frame sounded.
  MonoTime time_of(std::int64_t frame) const { return clock_.time_of(static_cast<double>(frame)); }
  std::int64_t read_frames() const { return read_; }
  void request_timing();

 private:
  PulseInput(double rate_hz, OnSamples on_samples)
      : rate_hz_(rate_hz), on_samples_(std::move(on_samples)), clock_(rate_hz) {}
  void read_all();
  void report_timing();

  double rate_hz_;
  OnSamples on_samples_;
  StreamClock clock_;
  pa_stream* stream_ = nullptr;
  PulseTiming timing_;
  std::int64_t read_ = 0;
  std::vector<float> silence_;
};

}  // namespace dance
