#include "core/sound/pulse_server.h"

#include <pulse/pulseaudio.h>

namespace dance {
namespace {

constexpr const char* kNoServer =
    "no sound server: start PulseAudio or PipeWire, or set PULSE_SERVER";

bool is_on_its_way(pa_context_state_t state) {
  return state != PA_CONTEXT_READY && PA_CONTEXT_IS_GOOD(state);
}

}  // namespace

Result<std::unique_ptr<PulseServer>> PulseServer::connect(const std::string& program) {
  std::unique_ptr<PulseServer> server(new PulseServer);
  server->mainloop_ = pa_mainloop_new();
  if (server->mainloop_ == nullptr) return fail("no memory for the sound server");
  server->context_ =
      pa_context_new(pa_mainloop_get_api(server->mainloop_), ("dance " + program).c_str());
  if (server->context_ == nullptr) return fail("no memory for the sound server");
  // Does not start a server: nothing would stop it again.
  if (pa_context_connect(server->context_, nullptr, PA_CONTEXT_NOAUTOSPAWN, nullptr) < 0)
    return fail(std::string(kNoServer) + " (" + server->error_text() + ")");
  const MonoTime end = mono_now() + kTimeout;
  while (is_on_its_way(pa_context_get_state(server->context_)) && mono_now() < end)
    server->iterate_waiting();
  if (!server->is_alive()) return fail(std::string(kNoServer) + " (" + server->error_text() + ")");
  return server;
}

PulseServer::~PulseServer() {
  if (context_ != nullptr) {
    pa_context_disconnect(context_);
    pa_context_unref(context_);
  }
  if (mainloop_ != nullptr) pa_mainloop_free(mainloop_);
}

void PulseServer::iterate() {
  // Bounded, so that a flood of events cannot block the program.
  for (int i = 0; i < 64; ++i)
    if (pa_mainloop_iterate(mainloop_, 0, nullptr) <= 0) return;
}

void PulseServer::iterate_waiting() {
  if (pa_mainloop_prepare(mainloop_, 10'000) < 0) return;
  if (pa_mainloop_poll(mainloop_) < 0) return;
  pa_mainloop_dispatch(mainloop_);
}

bool PulseServer::is_alive() const { return pa_context_get_state(context_) == PA_CONTEXT_READY; }

std::string PulseServer::error_text() const { return pa_strerror(pa_context_errno(context_)); }

bool PulseServer::becomes_ready(pa_stream* stream, Duration timeout) {
  iterate_until([stream] { return pa_stream_get_state(stream) != PA_STREAM_CREATING; }, timeout);
  return pa_stream_get_state(stream) == PA_STREAM_READY;
}

Result<void> PulseServer::await_answer(pa_operation* query, const bool& is_done) {
  if (query == nullptr) return fail("the sound server refuses a query: " + error_text());
  const bool is_answered = iterate_until([&] { return is_done; });
  if (!is_answered) pa_operation_cancel(query);
  pa_operation_unref(query);
  if (!is_answered) return fail("the sound server does not answer");
  return {};
}

MonoTime PulseServer::mono_time_of(const timeval& wall) {
  timeval now{};
  pa_gettimeofday(&now);
  const Duration age =
      Duration::s(now.tv_sec - wall.tv_sec) + Duration::us(now.tv_usec - wall.tv_usec);
  return mono_now() - age;
}

}  // namespace dance
