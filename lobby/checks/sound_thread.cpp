#include "lobby/checks/sound_thread.h"

#include <algorithm>

#include "core/net/mono_clock.h"
#include "lobby/checks/test_sound.h"

namespace dance {
namespace {

constexpr Duration kLookEvery = Duration::s(2);
constexpr Duration kAnswerWithin = Duration::ms(800);
constexpr Duration kVoiceAhead = Duration::ms(20);  // as `dance voice` has it
constexpr Duration kTonesAhead = Duration::ms(100);
// A stream that begins is silent first: devices wake up.
constexpr std::int64_t kLead = 14'400;  // frames
constexpr std::int64_t kTail = 24'000;

// The one that is chosen, or the default; null where there is none such.
const SoundDevice* chosen_of(const std::vector<SoundDevice>& devices, const std::string& name) {
  const auto found = std::find_if(devices.begin(), devices.end(), [&](const SoundDevice& d) {
    return name.empty() ? d.is_default : d.name == name;
  });
  return found == devices.end() ? nullptr : &*found;
}

DeviceState state_of(const SoundDevice* device, const std::string& name, bool is_real) {
  if (device == nullptr) return name.empty() ? DeviceState::kNone : DeviceState::kGone;
  if (name.empty() && !is_real) return DeviceState::kNone;
  return device->is_muted ? DeviceState::kMuted : DeviceState::kWorks;
}

std::vector<ListedSound> listed(const std::vector<SoundDevice>& devices) {
  std::vector<ListedSound> list;
  for (const bool wants_monitors : {false, true})
    for (const SoundDevice& device : devices)
      if (device.is_monitor == wants_monitors)
        list.push_back({device.name, device.description, device.is_default});
  return list;
}

}  // namespace

void SoundThread::choose(const SoundChoice& choice) {
  if (choice == choice_) return;
  choice_ = choice;
  microphone_.reset();
  end_playing();
  meter_.reset();
  report_.round_trip.reset();
  report_.state.microphone = report_.state.loudspeaker = DeviceState::kOpening;
  next_look_ = {};
}

void SoundThread::measure_round_trip() {
  report_.round_trip.reset();
  if (microphone_) play(Playing::kSweep);
}

void SoundThread::connect() {
  auto connected = PulseServer::connect("lobby");
  report_.state.server = connected ? SoundState::Server::kHere : SoundState::Server::kNone;
  if (connected) server_ = std::move(*connected);
}

void SoundThread::list_devices() {
  const auto devices = list_sound_devices(*server_);
  if (!devices) return;
  report_.microphones = listed(devices->sources);
  report_.loudspeakers = listed(devices->sinks);
  const SoundDevice* source = chosen_of(devices->sources, choice_.microphone);
  const SoundDevice* sink = chosen_of(devices->sinks, choice_.loudspeaker);
  report_.state.microphone =
      state_of(source, choice_.microphone, source != nullptr && !source->is_monitor);
  report_.state.loudspeaker =
      state_of(sink, choice_.loudspeaker, sink != nullptr && !sink->leads_nowhere);
}

void SoundThread::open_microphone() {
  PulseInputOptions options;
  options.source = choice_.microphone;
  options.name = "level";
  options.timeout = kAnswerWithin;
  auto opened = PulseInput::open(*server_, options,
                                 [this](std::span<const float> samples) { on_samples(samples); });
  if (opened)
    microphone_ = std::move(*opened);
  else
    report_.state.microphone = DeviceState::kGone;
}

// A device that was unplugged may come back; the server may have been started again.
void SoundThread::look_at_devices() {
  if (server_ && !server_->is_alive()) {
    microphone_.reset();
    end_playing();
    meter_.reset();
    server_.reset();
  }
  if (!server_) connect();
  if (!server_) return;
  list_devices();
  if (microphone_ && !microphone_->is_alive()) microphone_.reset();
  const DeviceState state = report_.state.microphone;
  const bool is_there = state == DeviceState::kWorks || state == DeviceState::kMuted;
  if (!microphone_ && is_there) open_microphone();
}

void SoundThread::on_samples(std::span<const float> samples) {
  meter_.add(samples);
  trip_.hear(samples, mono_now());
}

void SoundThread::play(Playing what) {
  end_playing();
  if (!server_) return;
  PulseOutputOptions options;
  options.sink = choice_.loudspeaker;
  options.name = "test";
  options.ahead = what == Playing::kSweep ? kVoiceAhead : kTonesAhead;
  options.timeout = kAnswerWithin;
  auto opened = PulseOutput::open(*server_, options, [](MonoTime, double) {});
  if (!opened) {
    report_.state.loudspeaker = DeviceState::kGone;
    return;
  }
  loudspeaker_ = std::move(*opened);
  playing_ = what;
}

void SoundThread::end_playing() {
  loudspeaker_.reset();
  playing_ = Playing::kNothing;
}

float SoundThread::sample_at(std::int64_t frame) const {
  const std::int64_t at = frame - kLead;
  if (playing_ == Playing::kCountIn) return count_in_sample(at);
  const bool is_sweep = at >= 0 && at < static_cast<std::int64_t>(kSweepSamples);
  return is_sweep ? test_sweep()[static_cast<std::size_t>(at)] : 0.0f;
}

void SoundThread::fill(MonoTime now) {
  const std::int64_t begin = loudspeaker_->written_frames();
  const std::int64_t sounds =
      playing_ == Playing::kCountIn ? kCountInSamples : static_cast<std::int64_t>(kSweepSamples);
  if (!loudspeaker_->is_alive() || begin > kLead + sounds + kTail) return end_playing();
  const std::size_t frames = std::min(loudspeaker_->wanted_frames(), block_.size() / 2);
  if (frames == 0) return;
  for (std::size_t i = 0; i < frames; ++i)
    block_[2 * i] = block_[2 * i + 1] = sample_at(begin + static_cast<std::int64_t>(i));
  const auto end = begin + static_cast<std::int64_t>(frames);
  if (playing_ == Playing::kSweep && begin <= kLead && kLead < end) trip_.begin(now);
  loudspeaker_->write(std::span(block_).first(2 * frames));
}

void SoundThread::work(MonoTime now) {
  if (now >= next_look_) {
    look_at_devices();
    next_look_ = mono_now() + kLookEvery;
  }
  if (server_) server_->iterate();
  if (loudspeaker_) fill(now);
  if (auto trip = trip_.take()) report_.round_trip = trip;
  report_.level = meter_.level();
  report_.is_playing = playing_ != Playing::kNothing;
}

}  // namespace dance
