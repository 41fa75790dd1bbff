#include "haptics/sound/sound_output.h"

#include <pthread.h>
#include <pulse/pulseaudio.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "core/base/spsc_ring.h"
#include "core/sound/pulse_server.h"
#include "haptics/sound/tone_mixer.h"

namespace dance {
namespace {

constexpr std::uint32_t kRate_hz = 48000;
constexpr std::uint32_t kBuffer_ms = 20;
// Between two looks for a server that went away: of 10 ms each.
constexpr int kRests = 100;

}  // namespace

struct SoundOutput::Impl {
  struct Order {
    Haptic haptic;
    bool is_stop = false;
  };
  std::unique_ptr<PulseServer> server;
  pa_stream* stream = nullptr;
  std::string sink;
  ToneMixer mixer{kRate_hz};  // of the thread
  SpscRing<Order, 64> orders;
  std::atomic<bool> is_alive{false}, ends{false};
  std::atomic<float> limit{1.0f};
  std::atomic<std::int64_t> latency_us{0};
  std::atomic<std::uint64_t> underflows{0}, losses{0};
  std::thread thread;

  ~Impl() {
    ends = true;
    if (thread.joinable()) thread.join();
    close();
  }
  void close();
  void write(std::size_t bytes);
  Result<void> connect();
  void run();
};

void SoundOutput::Impl::close() {
  is_alive = false;
  if (stream) {
    pa_stream_set_write_callback(stream, nullptr, nullptr);
    pa_stream_set_underflow_callback(stream, nullptr, nullptr);
    pa_stream_disconnect(stream);
    pa_stream_unref(stream);
    stream = nullptr;
  }
  server.reset();
}

void SoundOutput::Impl::write(std::size_t bytes) {
  while (const auto order = orders.pop()) {
    if (order->is_stop)
      mixer.clear();
    else
      mixer.add(order->haptic);
  }
  mixer.set_limit(limit);
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

Result<void> SoundOutput::Impl::connect() {
  DANCE_TRY(server, PulseServer::connect("haptics"));
  const pa_sample_spec format{PA_SAMPLE_FLOAT32LE, kRate_hz, 1};
  stream = pa_stream_new(server->context(), "haptics", &format, nullptr);
  if (!stream) return fail("the sound server refuses a stream: " + server->error_text());
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
    return fail("the sound server refuses to play: " + server->error_text());
  if (auto ready = server->await_ready(stream, "the sound server has no sink '" +
                                                   (sink.empty() ? "default" : sink) +
                                                   "' (`pactl list short sinks` names them)");
      !ready)
    return ready;
  // What waited meanwhile is of the past.
  while (orders.pop()) {
  }
  mixer.clear();
  is_alive = true;
  return {};
}

void SoundOutput::Impl::run() {
  pthread_setname_np(pthread_self(), "haptics-snd");
  const auto has_ended = [this] { return ends || pa_stream_get_state(stream) != PA_STREAM_READY; };
  while (!ends) {
    if (is_alive) {
      server->iterate_until(has_ended);
      if (!server->is_alive() || has_ended()) {
        if (!ends) ++losses;
        close();
      }
      continue;
    }
    for (int i = 0; i < kRests && !ends; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!ends && !connect()) close();
  }
}

Result<std::unique_ptr<HapticOutput>> SoundOutput::open(const std::string& sink) {
  auto impl = std::make_unique<Impl>();
  impl->sink = sink;
  if (auto connected = impl->connect(); !connected) return tl::make_unexpected(connected.error());
  return std::unique_ptr<HapticOutput>(new SoundOutput(std::move(impl)));
}

std::unique_ptr<HapticOutput> SoundOutput::later(const std::string& sink) {
  auto impl = std::make_unique<Impl>();
  impl->sink = sink;
  return std::unique_ptr<HapticOutput>(new SoundOutput(std::move(impl)));
}

SoundOutput::SoundOutput(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
  Impl* const raw = impl_.get();
  raw->thread = std::thread([raw] { raw->run(); });
}
SoundOutput::~SoundOutput() = default;

bool SoundOutput::play(const Haptic& haptic, MonoTime) {
  if (!impl_->is_alive) return false;
  impl_->orders.push({haptic, false});
  return true;
}

void SoundOutput::set_limit(float limit) { impl_->limit = limit; }

void SoundOutput::stop() { impl_->orders.push({Haptic(), true}); }

Duration SoundOutput::latency() const { return Duration::us(impl_->latency_us); }

bool SoundOutput::is_there() const { return impl_->is_alive; }

std::string SoundOutput::name() const {
  return "sound" + (impl_->sink.empty() ? "" : " on " + impl_->sink);
}

std::string SoundOutput::summary() const {
  std::string line = name() + ", " + std::to_string(latency().count_ms()) + " ms late by itself";
  if (!impl_->is_alive) line += ", no sound server now";
  if (impl_->losses > 0) line += ", lost " + std::to_string(impl_->losses) + " times";
  if (impl_->underflows > 0) line += ", " + std::to_string(impl_->underflows) + " gaps";
  return line;
}

}  // namespace dance
