#include "core/sound/sound_devices.h"

#include <pulse/pulseaudio.h>

#include "core/base/printable.h"
#include "core/sound/pulse_server.h"

namespace dance {
namespace {

struct DeviceQuery {
  SoundDevices found;
  std::string default_source;
  std::string default_sink;
  bool is_done = false;
};

std::string text_or_empty(const char* text) { return text != nullptr ? text : ""; }

void take_defaults(pa_context*, const pa_server_info* info, void* data) {
  auto& query = *static_cast<DeviceQuery*>(data);
  if (info != nullptr) {
    query.default_source = text_or_empty(info->default_source_name);
    query.default_sink = text_or_empty(info->default_sink_name);
  }
  query.is_done = true;
}

// What a server calls its devices anybody may have written.
template <class Info>
SoundDevice described(const Info& info, const std::string& default_name) {
  SoundDevice device;
  device.name = text_or_empty(info.name);
  device.description = printable(info.description != nullptr ? info.description : info.name);
  device.is_default = device.name == default_name;
  device.is_muted = info.mute != 0;
  return device;
}

void take_one_source(pa_context*, const pa_source_info* info, int is_last, void* data) {
  auto& query = *static_cast<DeviceQuery*>(data);
  if (is_last != 0 || info == nullptr) {
    query.is_done = true;
    return;
  }
  if (query.found.sources.size() == kMostSoundDevices || info->name == nullptr) return;
  SoundDevice device = described(*info, query.default_source);
  device.is_monitor = info->monitor_of_sink != PA_INVALID_INDEX;
  query.found.sources.push_back(std::move(device));
}

void take_one_sink(pa_context*, const pa_sink_info* info, int is_last, void* data) {
  auto& query = *static_cast<DeviceQuery*>(data);
  if (is_last != 0 || info == nullptr) {
    query.is_done = true;
    return;
  }
  if (query.found.sinks.size() == kMostSoundDevices || info->name == nullptr) return;
  SoundDevice device = described(*info, query.default_sink);
  device.leads_nowhere = device.name == "auto_null" ||
                         text_or_empty(info->driver).find("null-sink") != std::string::npos;
  query.found.sinks.push_back(std::move(device));
}

}  // namespace

Result<SoundDevices> list_sound_devices(PulseServer& server) {
  DeviceQuery query;
  pa_context* context = server.context();
  const auto answered = [&](pa_operation* question) {
    query.is_done = false;
    return server.await_answer(question, query.is_done);
  };
  if (auto done = answered(pa_context_get_server_info(context, take_defaults, &query)); !done)
    return tl::make_unexpected(done.error());
  if (auto done = answered(pa_context_get_source_info_list(context, take_one_source, &query));
      !done)
    return tl::make_unexpected(done.error());
  if (auto done = answered(pa_context_get_sink_info_list(context, take_one_sink, &query)); !done)
    return tl::make_unexpected(done.error());
  return std::move(query.found);
}

}  // namespace dance
