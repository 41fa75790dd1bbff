#include "core/sound/pulse_input.h"

#include <pulse/pulseaudio.h>

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr double kFragment_s = 0.01;

}  // namespace

Result<std::unique_ptr<PulseInput>> PulseInput::open(PulseServer& server,
                                                     const PulseInputOptions& options,
                                                     OnSamples on_samples) {
  const double rate_hz = options.rate_hz;
  const std::string& source = options.source;
  std::unique_ptr<PulseInput> input(new PulseInput(rate_hz, std::move(on_samples)));
  const pa_sample_spec format{PA_SAMPLE_FLOAT32LE, static_cast<std::uint32_t>(std::lround(rate_hz)),
                              1};
  input->stream_ = pa_stream_new(server.context(), options.name.c_str(), &format, nullptr);
  if (input->stream_ == nullptr)
    return fail("the sound server refuses a stream: " + server.error_text());
  const auto on_data = [](pa_stream*, std::size_t, void* self) {
    static_cast<PulseInput*>(self)->read_all();
  };
  pa_stream_set_read_callback(input->stream_, on_data, input.get());
  const auto server_default = static_cast<std::uint32_t>(-1);
  const auto fragment =
      static_cast<std::uint32_t>(kFragment_s * rate_hz) * static_cast<std::uint32_t>(sizeof(float));
  const pa_buffer_attr buffer{server_default, server_default, server_default, server_default,
                              fragment};
  if (pa_stream_connect_record(input->stream_, source.empty() ? nullptr : source.c_str(), &buffer,
                               PA_STREAM_ADJUST_LATENCY) < 0)
    return fail("the sound server refuses to record: " + server.error_text());
  const std::string named = source.empty() ? "" : " '" + source + "'";
  if (auto ready = server.await_ready(
          input->stream_,
          "the sound server has no microphone" + named + " (`pactl list short sources` names them)",
          options.timeout);
      !ready)
    return tl::make_unexpected(ready.error());
  return input;
}

PulseInput::~PulseInput() {
  if (stream_ == nullptr) return;
  pa_stream_set_read_callback(stream_, nullptr, nullptr);
  pa_stream_disconnect(stream_);
  pa_stream_unref(stream_);
}

bool PulseInput::is_alive() const { return pa_stream_get_state(stream_) == PA_STREAM_READY; }

void PulseInput::read_all() {
  while (pa_stream_readable_size(stream_) > 0) {
    const void* data = nullptr;
    std::size_t bytes = 0;
    if (pa_stream_peek(stream_, &data, &bytes) < 0 || bytes == 0) return;
    const std::size_t frames = bytes / sizeof(float);
    std::span<const float> samples(static_cast<const float*>(data), frames);
    if (data == nullptr) {  // a gap: filled with silence, so that time goes on
      silence_.assign(frames, 0.0f);
      samples = silence_;
    }
    read_ += static_cast<std::int64_t>(frames);
    on_samples_(samples);
    pa_stream_drop(stream_);
  }
}

void PulseInput::request_timing() {
  const auto on_answer = [](pa_stream*, int is_good, void* self) {
    if (is_good != 0) static_cast<PulseInput*>(self)->report_timing();
  };
  timing_.ask(stream_, on_answer, this);
}

void PulseInput::report_timing() {
  const pa_timing_info* info = pa_stream_get_timing_info(stream_);
  if (info == nullptr || info->write_index_corrupt != 0) return;
  // Frames received, plus those recorded but not received yet; of a monitor, less those that are
  // not heard yet. pa_usec_t is unsigned: signed
  // before anything is subtracted.
  const double taken = static_cast<double>(info->write_index) / sizeof(float);
  const double on_their_way_s =
      (static_cast<double>(info->source_usec) - static_cast<double>(info->sink_usec)) * 1e-6;
  clock_.report(PulseServer::mono_time_of(info->timestamp), taken + on_their_way_s * rate_hz_);
}

}  // namespace dance
