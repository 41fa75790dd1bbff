// PulseServer: a connection with the machine's sound server (PulseAudio, or PipeWire, which speaks
// the same), driven from the program's own loop.
//
// Units/frames: the server's stamps are wall-clock times; mono_time_of() makes them this process's
//               MonoTime.
// Ownership:    owns the connection; streams on it must go before it.
// Threads:      none: everything happens in iterate(), which is to be called some hundred times a
//               second.
// Failure:      connect() says why there is no server and what to do; is_alive() is false once the
//               connection is lost. A server that hangs (it accepts the connection and does not
//               answer) has an error of its own, with the command that restarts it.
#pragma once

#include <sys/time.h>

#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/base/time.h"
#include "core/net/mono_clock.h"

struct pa_context;
struct pa_mainloop;
struct pa_operation;
struct pa_stream;

namespace dance {

struct PulseFailure : Error {
  bool is_silent = false;  // a server is there and does not answer
};

class PulseServer {
 public:
  static constexpr Duration kTimeout = Duration::s(3);

  // Waits for the server's answer, a few seconds at most.
  static tl::expected<std::unique_ptr<PulseServer>, PulseFailure> connect(
      const std::string& program);
  ~PulseServer();
  PulseServer(const PulseServer&) = delete;
  PulseServer& operator=(const PulseServer&) = delete;

  pa_context* context() const { return context_; }
  // Handles what has come; the streams' callbacks run in it.
  void iterate();
  // The same until `is_done`; false when it did not come to that in time.
  template <class IsDone>
  bool iterate_until(IsDone is_done, Duration timeout = kTimeout) {
    const MonoTime end = mono_now() + timeout;
    while (mono_now() < end) {
      if (is_done()) return true;
      if (!is_alive()) return false;
      iterate_waiting();
    }
    return is_done();
  }
  bool is_alive() const;
  std::string error_text() const;
  // Waits for a stream that was connected. The error is `refused` with the server's reason, or
  // that the server does not answer.
  Result<void> await_ready(pa_stream* stream, const std::string& refused,
                           Duration timeout = kTimeout);
  // Waits for the answer to a query, whose callback sets `is_done`.
  Result<void> await_answer(pa_operation* query, const bool& is_done);

  static MonoTime mono_time_of(const timeval& wall);

 private:
  PulseServer() = default;
  void iterate_waiting();

  pa_mainloop* mainloop_ = nullptr;
  pa_context* context_ = nullptr;
};

}  // namespace dance
