#include "voice/device/voice_devices.h"

#include <algorithm>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr double kDevice_hz = 48'000.0;
constexpr Duration kTimingRequests = Duration::ms(100);
constexpr Duration kLooks = Duration::s(2);
constexpr Duration kShortestTimeout = Duration::ms(100);
constexpr Duration kLongestTimeout = Duration::ms(800);
// A machine that is too busy for a small buffer gets a larger one.
constexpr Duration kFitLooks = Duration::s(2);
constexpr std::uint64_t kMostUnderflows = 3;
constexpr Duration kGrowth = Duration::ms(10);
// And a smaller one again, once it has been enough for a while.
constexpr int kCalmLooks = 3;
constexpr Duration kShrinkage = Duration::ms(5);
constexpr Duration kLargestBuffer = Duration::ms(80);

}  // namespace

Result<std::unique_ptr<VoiceDevices>> VoiceDevices::open(const VoiceDeviceOptions& options,
                                                         VoiceDeviceHandlers handlers) {
  std::unique_ptr<VoiceDevices> devices(new VoiceDevices(options, std::move(handlers)));
  if (auto connected = devices->connect(); !connected)
    return tl::make_unexpected(connected.error());
  if (!devices->has_microphone() && !devices->has_loudspeaker())
    return fail(devices->take_errors());
  return devices;
}

Result<void> VoiceDevices::connect() {
  DANCE_TRY(server_, PulseServer::connect("voice"));
  troubles_.clear(VoiceDevice::kServer);
  timeout_ = PulseServer::kTimeout;
  open_loudspeaker();
  open_microphone();
  open_reference();
  return {};
}

template <class Device>
void VoiceDevices::keep(VoiceDevice device, std::unique_ptr<Device>& place,
                        Result<std::unique_ptr<Device>> opened) {
  if (!opened) return troubles_.add(device, opened.error().what);
  troubles_.clear(device);
  place = std::move(*opened);
}

void VoiceDevices::open_microphone() {
  from_microphone_.count = 0;
  keep(VoiceDevice::kMicrophone, microphone_,
       PulseInput::open(*server_, {options_.microphone, kDevice_hz, "microphone", timeout_},
                        [this](std::span<const float> s) { on_microphone(s); }));
}

void VoiceDevices::open_loudspeaker() {
  PulseOutputOptions output;
  output.sink = options_.loudspeaker;
  output.name = "voices";
  output.ahead = ahead_;
  output.timeout = timeout_;
  heard_ = StreamClock(kDevice_hz);
  underflows_before_ = 0;
  keep(VoiceDevice::kLoudspeaker, loudspeaker_,
       PulseOutput::open(*server_, output,
                         [this](MonoTime at, double frame) { heard_.report(at, frame); }));
}

void VoiceDevices::open_reference() {
  const bool is_named = !options_.reference.empty();
  if (!options_.has_reference || (!is_named && !loudspeaker_)) return;
  from_reference_.count = 0;
  const std::string& sink = is_named ? options_.reference : options_.loudspeaker;
  const std::string monitor = sink.empty() ? "@DEFAULT_MONITOR@" : sink + ".monitor";
  auto opened = PulseInput::open(*server_, {monitor, kDevice_hz, "what is played", timeout_},
                                 [this](std::span<const float> s) { on_reference(s); });
  if (!opened)
    opened = fail("no echo is taken out: what " + (sink.empty() ? "the default sink" : sink) +
                  " plays cannot be heard (" + server_->error_text() +
                  "); `pactl list short sinks` names them");
  keep(VoiceDevice::kReference, reference_, std::move(opened));
}

void VoiceDevices::on_reference(std::span<const float> samples) {
  from_reference_.add(samples, reference_ ? reference_->read_frames() : 0, [&](std::int64_t begin) {
    if (reference_ && reference_->is_timed())
      reference_ahead_ = reference_->time_of(begin) - mono_now();
    handlers_.on_reference(from_reference_.frame);
  });
}

void VoiceDevices::on_microphone(std::span<const float> samples) {
  from_microphone_.add(
      samples, microphone_ ? microphone_->read_frames() : 0, [&](std::int64_t begin) {
        const MonoTime now = mono_now();
        const bool is_timed = microphone_ && microphone_->is_timed();
        const MonoTime captured = is_timed ? microphone_->time_of(begin) : now - kVoiceFrame;
        handlers_.on_microphone(from_microphone_.frame, captured,
                                reference_ahead_ + (now - captured));
      });
}

void VoiceDevices::work(MonoTime now) {
  if (server_) server_->iterate();
  if (now >= next_timing_) {
    next_timing_ = now + kTimingRequests;
    if (microphone_) microphone_->request_timing();
    if (reference_) reference_->request_timing();
    if (loudspeaker_) loudspeaker_->request_timing();
  }
  if (loudspeaker_) fill(now);
  if (now >= next_look_) {
    look_for_lost();
    next_look_ = mono_now() + kLooks;
  }
  if (now >= next_fit_) fit_buffer(now);
}

void VoiceDevices::fill(MonoTime now) {
  const std::size_t frames = std::min(loudspeaker_->wanted_frames(), block_.size() / 2);
  if (frames == 0) return;
  const auto stereo = std::span(block_).first(2 * frames);
  std::fill(stereo.begin(), stereo.end(), 0.0f);
  const MonoTime heard = heard_.is_known()
                             ? heard_.time_of(static_cast<double>(loudspeaker_->written_frames()))
                             : now + ahead_;
  handlers_.fill(stereo, now, heard);
  loudspeaker_->write(stereo);
}

// A headset that was unplugged may come back; the server may have been started again.
void VoiceDevices::look_for_lost() {
  if (!server_ || !server_->is_alive()) {
    microphone_.reset();
    reference_.reset();
    loudspeaker_.reset();
    server_.reset();
    if (auto connected = connect(); !connected)
      troubles_.add(VoiceDevice::kServer, connected.error().what);
    return;
  }
  if (microphone_ && !microphone_->is_alive()) microphone_.reset();
  if (loudspeaker_ && !loudspeaker_->is_alive()) loudspeaker_.reset();
  if (reference_ && !reference_->is_alive()) reference_.reset();
  // What works goes on soon: a server that answers slowly has first a short time, then longer.
  if (!microphone_ && !loudspeaker_)
    timeout_ = PulseServer::kTimeout;
  else
    timeout_ = std::clamp(timeout_, kShortestTimeout, kLongestTimeout);
  const MonoTime begin = mono_now();
  if (!loudspeaker_) open_loudspeaker();
  if (!microphone_) open_microphone();
  if (!reference_) open_reference();
  const bool is_slow = mono_now() - begin >= timeout_;
  timeout_ = is_slow ? timeout_ * 2 : kShortestTimeout;
}

void VoiceDevices::fit_buffer(MonoTime now) {
  const bool is_first = !next_fit_.is_set();
  next_fit_ = now + kFitLooks;
  if (!loudspeaker_) return;
  const std::uint64_t count = loudspeaker_->underflows();
  const std::uint64_t more = count - underflows_before_;
  underflows_before_ = count;
  // Before the first sound there is nothing to play.
  if (is_first) return;
  underflows_ += more;
  calm_looks_ = more == 0 ? calm_looks_ + 1 : 0;
  Duration ahead = ahead_;
  if (more >= kMostUnderflows) ahead = std::min(ahead + kGrowth, kLargestBuffer);
  if (calm_looks_ >= kCalmLooks) ahead = ahead - kShrinkage;
  ahead = std::max(ahead, options_.ahead);
  if (ahead == ahead_) return;
  ahead_ = ahead;
  calm_looks_ = 0;
  loudspeaker_->set_ahead(ahead);
}

}  // namespace dance
