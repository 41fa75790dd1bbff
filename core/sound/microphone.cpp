#include "core/sound/microphone.h"

#include <pulse/pulseaudio.h>

#include "core/sound/pulse_server.h"

namespace dance {
namespace {

struct MicrophoneQuery {
  Microphone found;
  bool is_done = false;
};

void take_default_source(pa_context*, const pa_server_info* info, void* data) {
  auto& query = *static_cast<MicrophoneQuery*>(data);
  if (info != nullptr && info->default_source_name != nullptr)
    query.found.name = info->default_source_name;
  query.is_done = true;
}

void take_source(pa_context*, const pa_source_info* info, int is_last, void* data) {
  auto& query = *static_cast<MicrophoneQuery*>(data);
  if (is_last != 0 || info == nullptr) {
    query.is_done = true;
    return;
  }
  query.found.description = info->description != nullptr ? info->description : info->name;
  query.found.is_muted = info->mute != 0;
  query.found.is_monitor = info->monitor_of_sink != PA_INVALID_INDEX;
}

}  // namespace

Result<Microphone> default_microphone(const std::string& program) {
  DANCE_TRY(const auto server, PulseServer::connect(program));
  MicrophoneQuery query;
  pa_context* context = server->context();
  auto answered = server->await_answer(
      pa_context_get_server_info(context, take_default_source, &query), query.is_done);
  if (!answered) return tl::make_unexpected(answered.error());
  query.is_done = false;
  const std::string name = query.found.name;
  answered = server->await_answer(
      pa_context_get_source_info_by_name(context, name.c_str(), take_source, &query),
      query.is_done);
  if (!answered) return tl::make_unexpected(answered.error());
  if (query.found.description.empty()) return fail("the sound server has no microphone");
  return query.found;
}

}  // namespace dance
