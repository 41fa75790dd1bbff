#include "core/sound/pulse_server.h"

#include <pulse/pulseaudio.h>

#include <cerrno>

#include "core/base/text/errno_text.h"

namespace dance {
namespace {

constexpr const char* kNoServer =
    "no sound server: start PulseAudio or PipeWire, or set PULSE_SERVER";

constexpr const char* kSilent =
    "the sound server does not answer; restart it with: systemctl --user restart pipewire-pulse, "
    "or "
    "pulseaudio --kill && pulseaudio --start";

tl::unexpected<PulseFailure> connect_failure(std::string what, bool is_silent = false) {
  return tl::make_unexpected(PulseFailure{{std::move(what)}, is_silent});
}

bool is_on_its_way(pa_context_state_t state) {
  return state != PA_CONTEXT_READY && PA_CONTEXT_IS_GOOD(state);
}

}  // namespace

tl::expected<std::unique_ptr<PulseServer>, PulseFailure> PulseServer::connect(
    const std::string& program) {
  std::unique_ptr<PulseServer> server(new PulseServer);
  errno = 0;
  server->mainloop_ = pa_mainloop_new();
  if (server->mainloop_ == nullptr)
    return connect_failure("no connection to the sound server: " +
                           errno_text(errno != 0 ? errno : ENOMEM));
  server->context_ =
      pa_context_new(pa_mainloop_get_api(server->mainloop_), ("dance " + program).c_str());
  if (server->context_ == nullptr)
    return connect_failure("no connection to the sound server: " + errno_text(ENOMEM));
  // Does not start a server: nothing would stop it again.
  if (pa_context_connect(server->context_, nullptr, PA_CONTEXT_NOAUTOSPAWN, nullptr) < 0)
    return connect_failure(std::string(kNoServer) + " (" + server->error_text() + ")");
  const MonoTime end = mono_now() + kTimeout;
  while (is_on_its_way(pa_context_get_state(server->context_)) && mono_now() < end)
    server->iterate_waiting();
  if (is_on_its_way(pa_context_get_state(server->context_))) return connect_failure(kSilent, true);
  if (!server->is_alive())
    return connect_failure(std::string(kNoServer) + " (" + server->error_text() + ")");
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

Result<void> PulseServer::await_ready(pa_stream* stream, const std::string& refused,
                                      Duration timeout) {
  iterate_until([stream] { return pa_stream_get_state(stream) != PA_STREAM_CREATING; }, timeout);
  const pa_stream_state_t state = pa_stream_get_state(stream);
  if (state == PA_STREAM_READY) return {};
  if (state == PA_STREAM_CREATING && is_alive()) return fail(kSilent);
  return fail(refused + ": " + error_text());
}

Result<void> PulseServer::await_answer(pa_operation* query, const bool& is_done) {
  if (query == nullptr) return fail("the sound server refuses a query: " + error_text());
  const bool is_answered = iterate_until([&] { return is_done; });
  if (!is_answered) pa_operation_cancel(query);
  pa_operation_unref(query);
  if (!is_answered)
    return fail(is_alive() ? kSilent
                           : "the connection to the sound server is lost (" + error_text() + ")");
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
