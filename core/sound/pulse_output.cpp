#include "core/sound/pulse_output.h"

#include <pulse/pulseaudio.h>

#include <cmath>

namespace dance {
namespace {

constexpr std::size_t kFrame_bytes = 2 * sizeof(float);

// Starts at once and never waits for data: late frames are dropped, and time goes on.
pa_buffer_attr buffer_of(Duration ahead, double rate_hz) {
  const auto bytes = static_cast<std::uint32_t>(ahead.as_seconds() * rate_hz) *
                     static_cast<std::uint32_t>(kFrame_bytes);
  const auto server_default = static_cast<std::uint32_t>(-1);
  return {server_default, bytes, 0, server_default, server_default};
}

}  // namespace

Result<std::unique_ptr<PulseOutput>> PulseOutput::open(PulseServer& server,
                                                       const PulseOutputOptions& options,
                                                       OnHeard on_heard) {
  const double rate_hz = options.rate_hz;
  std::unique_ptr<PulseOutput> output(new PulseOutput(rate_hz, std::move(on_heard)));
  output->playing_hz_ = static_cast<std::uint32_t>(std::lround(rate_hz));
  const pa_sample_spec format{PA_SAMPLE_FLOAT32LE, output->playing_hz_, 2};
  if (pa_sample_spec_valid(&format) == 0)
    return fail("the sound server does not play " + std::to_string(output->playing_hz_) +
                " samples a second; convert the music to 48000");
  output->stream_ = pa_stream_new(server.context(), options.name.c_str(), &format, nullptr);
  if (output->stream_ == nullptr)
    return fail("the sound server refuses a stream: " + server.error_text());
  const pa_buffer_attr buffer = buffer_of(options.ahead, rate_hz);
  const auto flags =
      static_cast<pa_stream_flags_t>(PA_STREAM_VARIABLE_RATE | PA_STREAM_ADJUST_LATENCY);
  if (pa_stream_connect_playback(output->stream_,
                                 options.sink.empty() ? nullptr : options.sink.c_str(), &buffer,
                                 flags, nullptr, nullptr) < 0)
    return fail("the sound server refuses to play: " + server.error_text());
  pa_stream* stream = output->stream_;
  const auto on_underflow = [](pa_stream*, void* self) {
    ++static_cast<PulseOutput*>(self)->underflows_;
  };
  pa_stream_set_underflow_callback(stream, on_underflow, output.get());
  const std::string named = options.sink.empty() ? "" : " '" + options.sink + "'";
  if (auto ready = server.await_ready(
          stream,
          "the sound server has no loudspeaker" + named + " (`pactl list short sinks` names them)",
          options.timeout);
      !ready)
    return tl::make_unexpected(ready.error());
  return output;
}

PulseOutput::~PulseOutput() {
  if (stream_ == nullptr) return;
  pa_stream_set_underflow_callback(stream_, nullptr, nullptr);
  pa_stream_disconnect(stream_);
  pa_stream_unref(stream_);
}

bool PulseOutput::is_alive() const { return pa_stream_get_state(stream_) == PA_STREAM_READY; }

std::size_t PulseOutput::wanted_frames() const {
  const std::size_t bytes = pa_stream_writable_size(stream_);
  return bytes == static_cast<std::size_t>(-1) ? 0 : bytes / kFrame_bytes;
}

void PulseOutput::write(std::span<const float> interleaved) {
  const int result = pa_stream_write(stream_, interleaved.data(), interleaved.size_bytes(), nullptr,
                                     0, PA_SEEK_RELATIVE);
  if (result == 0) written_ += static_cast<std::int64_t>(interleaved.size() / 2);
}

void PulseOutput::set_ahead(Duration ahead) {
  const pa_buffer_attr buffer = buffer_of(ahead, rate_hz_);
  pa_operation* query = pa_stream_set_buffer_attr(stream_, &buffer, nullptr, nullptr);
  if (query != nullptr) pa_operation_unref(query);
}

double PulseOutput::set_speed(double speed) {
  const auto wanted = static_cast<std::uint32_t>(std::lround(rate_hz_ * speed));
  if (wanted != playing_hz_) {
    pa_operation* query = pa_stream_update_sample_rate(stream_, wanted, nullptr, nullptr);
    if (query != nullptr) {
      pa_operation_unref(query);
      playing_hz_ = wanted;
    }
  }
  return playing_hz_ / rate_hz_;
}

void PulseOutput::request_timing() {
  const auto on_answer = [](pa_stream*, int is_good, void* self) {
    if (is_good != 0) static_cast<PulseOutput*>(self)->report_timing();
  };
  timing_.ask(stream_, on_answer, this);
}

void PulseOutput::report_timing() {
  const pa_timing_info* info = pa_stream_get_timing_info(stream_);
  if (info == nullptr || info->read_index_corrupt != 0 || info->playing == 0) return;
  // Frames that the server has taken out of our stream, less those that are still on their way to
  // the loudspeaker. pa_usec_t is unsigned: signed before anything is subtracted.
  const double taken = static_cast<double>(info->read_index) / static_cast<double>(kFrame_bytes);
  const double on_their_way_s = static_cast<double>(info->sink_usec) * 1e-6;
  on_heard_(PulseServer::mono_time_of(info->timestamp), taken - on_their_way_s * rate_hz_);
}

}  // namespace dance
