#include "haptics/sound/sound_output.h"

#include <pulse/pulseaudio.h>

#include <array>
#include <atomic>

#include "core/base/spsc_ring.h"
#include "core/net/mono_clock.h"
#include "haptics/sound/tone_mixer.h"

namespace dance {
namespace {

constexpr std::uint32_t kRate_hz = 48000;
constexpr std::uint32_t kBuffer_ms = 20;
constexpr Duration kPatience = Duration::s(3);

}  // namespace

struct SoundOutput::Impl {
  struct Order {
    Haptic haptic;
    bool is_stop = false;
  };
  pa_threaded_mainloop* loop = nullptr;
  pa_context* context = nullptr;
  pa_stream* stream = nullptr;
  std::string sink;
  ToneMixer mixer{kRate_hz};  // of the library's thread
  SpscRing<Order, 64> orders;
  std::atomic<bool> is_alive{false};
  std::atomic<std::int64_t> latency_us{0};
  std::atomic<std::uint64_t> underflows{0};

  ~Impl() {
    if (loop) pa_threaded_mainloop_stop(loop);
    if (stream) {
      pa_stream_disconnect(stream);
      pa_stream_unref(stream);
    }
    if (context) {
      pa_context_disconnect(context);
      pa_context_unref(context);
    }
    if (loop) pa_threaded_mainloop_free(loop);
  }
  void write(std::size_t bytes);
  Result<void> start();
};

void SoundOutput::Impl::write(std::size_t bytes) {
  while (const auto order = orders.pop()) {
    if (order->is_stop)
      mixer.clear();
    else
      mixer.add(order->haptic);
  }
  std::array<float, 480> samples{};
  for (std::size_t left = bytes / sizeof(float); left > 0;) {
    const std::size_t count = std::min(left, samples.size());
    mixer.mix(std::span(samples).first(count));
    pa_stream_write(stream, samples.data(), count * sizeof(float), nullptr, 0, PA_SEEK_RELATIVE);
    left -= count;
  }
  pa_usec_t late = 0;
  int is_negative = 0;
  if (pa_stream_get_latency(stream, &late, &is_negative) == 0 && is_negative == 0)
    latency_us = static_cast<std::int64_t>(std::min<pa_usec_t>(late, 1'000'000));
}

Result<void> SoundOutput::Impl::start() {
  loop = pa_threaded_mainloop_new();
  context = loop ? pa_context_new(pa_threaded_mainloop_get_api(loop), "dance haptics") : nullptr;
  if (!context) return fail("no memory for the sound server");
  const auto no_server = [&] {
    return fail(
        std::string("no sound server: start PulseAudio or PipeWire, or set PULSE_SERVER (") +
        pa_strerror(pa_context_errno(context)) + ")");
  };
  const auto wake = [](auto*, void* waiting) {
    pa_threaded_mainloop_signal(static_cast<pa_threaded_mainloop*>(waiting), 0);
  };
  pa_context_set_state_callback(context, wake, loop);
  if (pa_context_connect(context, nullptr, PA_CONTEXT_NOAUTOSPAWN, nullptr) < 0) return no_server();
  pa_threaded_mainloop_lock(loop);
  pa_threaded_mainloop_start(loop);
  struct Unlock {
    pa_threaded_mainloop* loop;
    ~Unlock() { pa_threaded_mainloop_unlock(loop); }
  } unlock{loop};
  while (pa_context_get_state(context) != PA_CONTEXT_READY) {
    if (!PA_CONTEXT_IS_GOOD(pa_context_get_state(context))) return no_server();
    pa_threaded_mainloop_wait(loop);
  }
  const pa_sample_spec format{PA_SAMPLE_FLOAT32LE, kRate_hz, 1};
  stream = pa_stream_new(context, "haptics", &format, nullptr);
  if (!stream) return fail("the sound server refuses a stream");
  pa_stream_set_state_callback(stream, wake, loop);
  pa_stream_set_write_callback(
      stream,
      [](pa_stream*, std::size_t bytes, void* self) { static_cast<Impl*>(self)->write(bytes); },
      this);
  pa_stream_set_underflow_callback(
      stream, [](pa_stream*, void* self) { ++static_cast<Impl*>(self)->underflows; }, this);
  const auto usual = static_cast<std::uint32_t>(-1);
  const pa_buffer_attr buffer{usual, kRate_hz * kBuffer_ms / 1000 * sizeof(float), 0, usual, usual};
  const auto flags = static_cast<pa_stream_flags_t>(
      PA_STREAM_ADJUST_LATENCY | PA_STREAM_AUTO_TIMING_UPDATE | PA_STREAM_INTERPOLATE_TIMING);
  if (pa_stream_connect_playback(stream, sink.empty() ? nullptr : sink.c_str(), &buffer, flags,
                                 nullptr, nullptr) < 0)
    return fail("the sound server refuses to play");
  const MonoTime begin = mono_now();
  while (pa_stream_get_state(stream) != PA_STREAM_READY) {
    if (!PA_STREAM_IS_GOOD(pa_stream_get_state(stream)) || mono_now() - begin > kPatience)
      return fail("the sound server has no sink '" + (sink.empty() ? "default" : sink) +
                  "'; pactl list short sinks shows those there are");
    pa_threaded_mainloop_wait(loop);
  }
  pa_stream_set_state_callback(
      stream,
      [](pa_stream* of, void* self) {
        static_cast<Impl*>(self)->is_alive = pa_stream_get_state(of) == PA_STREAM_READY;
      },
      this);
  is_alive = true;
  return {};
}

Result<std::unique_ptr<HapticOutput>> SoundOutput::open(const std::string& sink) {
  auto impl = std::make_unique<Impl>();
  impl->sink = sink;
  if (auto started = impl->start(); !started) return tl::make_unexpected(started.error());
  return std::unique_ptr<HapticOutput>(new SoundOutput(std::move(impl)));
}

SoundOutput::SoundOutput(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SoundOutput::~SoundOutput() = default;

bool SoundOutput::play(const Haptic& haptic, MonoTime) {
  if (!impl_->is_alive) return false;
  impl_->orders.push({haptic, false});
  return true;
}

void SoundOutput::stop() { impl_->orders.push({Haptic(), true}); }

Duration SoundOutput::latency() const { return Duration::us(impl_->latency_us); }

std::string SoundOutput::summary() const {
  std::string line = "sound" + (impl_->sink.empty() ? "" : " on " + impl_->sink) + ", " +
                     std::to_string(latency().count_ms()) + " ms late by itself";
  if (!impl_->is_alive) line += ", the sound server has ended";
  if (impl_->underflows > 0) line += ", " + std::to_string(impl_->underflows) + " gaps";
  return line;
}

}  // namespace dance
