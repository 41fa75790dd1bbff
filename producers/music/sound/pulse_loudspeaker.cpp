#include <pulse/pulseaudio.h>

#include <algorithm>
#include <vector>

#include "core/net/mono_clock.h"
#include "core/sound/pulse_output.h"
#include "producers/music/loudspeaker.h"

namespace dance {
namespace {

constexpr double kSilence_hz = 48000.0;
// Until a suspended output reports the latency that it has while it plays.
constexpr Duration kPlayed = Duration::ms(500);
// Written at once, at most.
constexpr std::size_t kMostFrames = 4800;

struct Query {
  Loudspeaker found;
  bool is_done = false;
};

void take_default(pa_context*, const pa_server_info* info, void* data) {
  auto& query = *static_cast<Query*>(data);
  if (info != nullptr && info->default_sink_name != nullptr)
    query.found.name = info->default_sink_name;
  query.is_done = true;
}

void take_sink(pa_context*, const pa_sink_info* info, int is_last, void* data) {
  auto& query = *static_cast<Query*>(data);
  if (is_last != 0 || info == nullptr) {
    query.is_done = true;
    return;
  }
  const auto text = [](const char* t) { return std::string(t != nullptr ? t : ""); };
  query.found.description = text(info->description);
  query.found.is_muted = info->mute != 0;
  query.found.latency = Duration::us(static_cast<std::int64_t>(info->latency));
  const std::string factory = text(pa_proplist_gets(info->proplist, "factory.name"));
  query.found.leads_nowhere = query.found.name == "auto_null" ||
                              text(info->driver).find("null-sink") != std::string::npos ||
                              factory.find("null-audio-sink") != std::string::npos;
}

}  // namespace

Result<Loudspeaker> default_loudspeaker(const std::string& program) {
  DANCE_TRY(const auto server, PulseServer::connect(program));
  Query query;
  pa_context* context = server->context();
  auto answered = server->await_answer(pa_context_get_server_info(context, take_default, &query),
                                       query.is_done);
  if (!answered) return tl::make_unexpected(answered.error());
  PulseOutputOptions options;
  options.rate_hz = kSilence_hz;
  DANCE_TRY(const auto output, PulseOutput::open(*server, options, [](MonoTime, double) {}));
  const std::vector<float> silence(2 * kMostFrames, 0.0f);
  const MonoTime end = mono_now() + kPlayed;
  server->iterate_until([&] {
    const std::size_t frames = std::min(output->wanted_frames(), kMostFrames);
    if (frames > 0) output->write(std::span(silence).first(2 * frames));
    return mono_now() >= end;
  });
  query.is_done = false;
  const char* name = query.found.name.c_str();
  answered = server->await_answer(
      pa_context_get_sink_info_by_name(context, name, take_sink, &query), query.is_done);
  if (!answered) return tl::make_unexpected(answered.error());
  if (query.found.description.empty())
    return fail("the sound server has no loudspeaker: " + server->error_text() +
                "; `pactl list short sinks` names what it has");
  return query.found;
}

}  // namespace dance
