// PulseOutput: one stereo stream of sound that goes on without a break, silent where nothing is
// written in time, and what of it is heard when, as far as the sound server knows.
//
// Units/frames: a frame is two floats, -1 to 1. Frames count from the stream's begin.
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

#include "core/sound/pulse_server.h"
#include "core/sound/pulse_timing.h"

struct pa_stream;

namespace dance {

struct PulseOutputOptions {
  double rate_hz = 48000.0;
  std::string sink = {};       // its name for the server; "" = its default
  std::string name = "music";  // of the stream, as the server's own tools show it
  // Buffered ahead: shorter stalls of the machine are inaudible. The latency is compensated.
  Duration ahead = Duration::ms(300);
  Duration timeout = PulseServer::kTimeout;  // open() waits so long for the server
};

class PulseOutput {
 public:
  // Frame `frame` was heard at `at`: called several times a second.
  using OnHeard = std::function<void(MonoTime at, double frame)>;

  static Result<std::unique_ptr<PulseOutput>> open(PulseServer& server,
                                                   const PulseOutputOptions& options,
                                                   OnHeard on_heard);
  ~PulseOutput();
  PulseOutput(const PulseOutput&) = delete;
  PulseOutput& operator=(const PulseOutput&) = delete;

  bool is_alive() const;
  std::int64_t written_frames() const { return written_; }
  std::size_t wanted_frames() const;
  // Another buffer, while it plays.
  void set_ahead(Duration ahead);
  // How often the server had nothing to play in time.
  std::uint64_t underflows() const { return underflows_; }
  void write(std::span<const float> interleaved);
  // How fast frames are played: the nearest whole number a second, which is what the server can.
  // Returns the speed that it is, 1 = as opened.
  double set_speed(double speed);
  void request_timing();

 private:
  PulseOutput(double rate_hz, OnHeard on_heard)
      : rate_hz_(rate_hz), on_heard_(std::move(on_heard)) {}
  void report_timing();

  double rate_hz_;
  OnHeard on_heard_;
  pa_stream* stream_ = nullptr;
  PulseTiming timing_;
  std::int64_t written_ = 0;
  std::uint32_t playing_hz_ = 0;
  std::uint64_t underflows_ = 0;
};

}  // namespace dance
