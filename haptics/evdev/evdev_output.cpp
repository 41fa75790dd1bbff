#include "haptics/evdev/evdev_output.h"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>

#include "haptics/evdev/evdev_devices.h"

namespace dance {
namespace {

class KernelFile final : public ForceFeedbackFile {
 public:
  explicit KernelFile(int fd) : fd_(fd) {}
  ~KernelFile() override { close(fd_); }
  KernelFile(const KernelFile&) = delete;
  KernelFile& operator=(const KernelFile&) = delete;
  int upload(void* ff_effect) override { return ioctl(fd_, EVIOCSFF, ff_effect); }
  int remove(int id) override { return ioctl(fd_, EVIOCRMFF, id); }
  int write_event(int code, int value) override {
    input_event event{};
    event.type = EV_FF;
    event.code = static_cast<std::uint16_t>(code);
    event.value = value;
    return write(fd_, &event, sizeof event) == sizeof event ? 0 : -1;
  }
  bool is_there() override {
    int version = 0;
    return ioctl(fd_, EVIOCGVERSION, &version) >= 0 || errno != ENODEV;
  }

 private:
  int fd_;
};

std::uint16_t milliseconds(Duration duration) {
  return static_cast<std::uint16_t>(std::clamp<std::int64_t>(duration.count_ms(), 1, 0x7fff));
}

// A motor has no envelope: of a swelling one, its mean.
float level_of(const Haptic& haptic, bool rumbles) {
  if (!rumbles) return haptic.amplitude;
  const double full_s = (haptic.duration - haptic.attack - haptic.release).as_seconds();
  const double mean = (full_s + 0.5 * (haptic.attack + haptic.release).as_seconds()) /
                      std::max(haptic.duration.as_seconds(), 1e-3);
  return haptic.amplitude * static_cast<float>(mean);
}

ff_effect effect_of(const Haptic& haptic, bool rumbles, float felt, int id) {
  ff_effect effect{};
  effect.id = static_cast<std::int16_t>(id);
  effect.replay.length = milliseconds(haptic.duration);
  const auto level = [](float amplitude, float full) {
    return static_cast<int>(std::lround(std::clamp(amplitude, 0.0f, 1.0f) * full));
  };
  if (rumbles) {
    const int strength = level(felt, 65535.0f);
    effect.type = FF_RUMBLE;
    const bool is_low =
        haptic.frequency_hz > 0.0f && haptic.frequency_hz < EvdevOutput::kLowMotor_hz;
    effect.u.rumble.strong_magnitude = static_cast<std::uint16_t>(is_low ? strength : 0);
    effect.u.rumble.weak_magnitude = static_cast<std::uint16_t>(is_low ? 0 : strength);
    return effect;
  }
  effect.type = FF_PERIODIC;
  effect.u.periodic.waveform = FF_SINE;
  const float hz = haptic.frequency_hz > 0.0f ? haptic.frequency_hz : 150.0f;
  effect.u.periodic.period =
      static_cast<std::uint16_t>(std::clamp(std::lround(1000.0f / hz), 1L, 1000L));
  effect.u.periodic.magnitude = static_cast<std::int16_t>(level(felt, 32767.0f));
  effect.u.periodic.envelope.attack_length =
      static_cast<std::uint16_t>(std::min<std::int64_t>(haptic.attack.count_ms(), 0x7fff));
  effect.u.periodic.envelope.fade_length =
      static_cast<std::uint16_t>(std::min<std::int64_t>(haptic.release.count_ms(), 0x7fff));
  return effect;
}

std::size_t slots_of(int effects) {
  return static_cast<std::size_t>(std::clamp(effects, 1, static_cast<int>(EvdevOutput::kSlots)));
}

bool fits(const EvdevDevice& device, const std::string& wanted) {
  if (wanted.starts_with('/')) {
    std::error_code error;  // not there: as it is written
    const auto path = std::filesystem::weakly_canonical(wanted, error);
    return device.path == (error ? wanted : path.string());
  }
  return wanted.empty() || device.name.find(wanted) != std::string::npos;
}

}  // namespace

Result<std::unique_ptr<HapticOutput>> EvdevOutput::open(const std::string& device) {
  auto output = not_there_yet(device);
  DANCE_TRY(const std::string name, output->find());
  if (device.empty()) output->wanted_ = name;
  return output;
}

std::unique_ptr<HapticOutput> EvdevOutput::later(const std::string& device) {
  return not_there_yet(device);
}

std::unique_ptr<EvdevOutput> EvdevOutput::not_there_yet(const std::string& device) {
  auto output = std::make_unique<EvdevOutput>(device.empty() ? "a gamepad" : device, nullptr, true,
                                              static_cast<int>(kSlots));
  output->wanted_ = device;
  output->looks_ = true;
  return output;
}

Result<std::string> EvdevOutput::find() {
  std::string refused;
  for (const EvdevDevice& each : list_evdev_devices()) {
    if (!fits(each, wanted_)) continue;
    const std::string name = each.path + " (" + each.name + ")";
    if (!each.trouble.empty()) {
      refused = name + " " + each.trouble;
      continue;
    }
    const int fd = ::open(each.path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) continue;
    file_ = std::make_unique<KernelFile>(fd);
    rumbles_ = each.rumbles;
    slot_count_ = slots_of(each.effects);
    name_ = name;
    return each.name;
  }
  if (!refused.empty()) return fail(refused);
  if (!wanted_.empty())
    return fail("no device '" + wanted_ +
                "' that can rumble; dance haptics list shows those there are");
  return fail(
      "no gamepad that can rumble; connect one, and look at dance haptics list. All else works "
      "without it");
}

EvdevOutput::EvdevOutput(std::string name, std::unique_ptr<ForceFeedbackFile> file, bool rumbles,
                         int effects)
    : name_(std::move(name)),
      file_(std::move(file)),
      rumbles_(rumbles),
      slot_count_(slots_of(effects)) {}

EvdevOutput::~EvdevOutput() { stop(); }

bool EvdevOutput::play(const Haptic& haptic, MonoTime now) {
  if (!file_) return false;
  Slot* slot = slots_.data();
  for (std::size_t i = 0; i < slot_count_; ++i)
    if (slots_[i].until < slot->until) slot = &slots_[i];
  const float level = level_of(haptic, rumbles_);
  const float felt = make_room(*slot, level, now);
  if (felt < 0.01f && level > 0.0f) return true;  // what runs is as strong as may be
  ff_effect effect = effect_of(haptic, rumbles_, felt, slot->id);
  if (file_->upload(&effect) < 0 || file_->write_event(effect.id, 1) < 0) {
    if (errno == ENODEV) lose();
    return false;
  }
  slot->id = effect.id;
  slot->until = now + haptic.duration;
  slot->level = felt;
  return true;
}

float EvdevOutput::make_room(const Slot& slot, float level, MonoTime now) {
  float runs = 0.0f;
  for (const Slot& other : slots_)
    if (&other != &slot && other.until > now) runs += other.level;
  if (runs + level <= limit_) return level;
  if (level < runs) return std::clamp(limit_ - runs, 0.0f, level);
  for (Slot& other : slots_) {
    if (&other == &slot || other.until <= now) continue;
    file_->write_event(other.id, 0);
    other.until = now;
  }
  return std::min(level, limit_);
}

void EvdevOutput::lose() {
  file_ = nullptr;
  slots_ = {};
  ++lost_;
}

MonoTime EvdevOutput::work(MonoTime now) {
  // Also while nothing is played.
  if (file_ && !file_->is_there()) lose();
  if (file_ || !looks_ || (looked_.is_set() && now - looked_ < kLooks)) return {};
  looked_ = now;
  static_cast<void>(find());
  return {};
}

void EvdevOutput::stop() {
  for (Slot& slot : slots_) {
    if (file_ && slot.id >= 0) {
      file_->write_event(slot.id, 0);
      file_->remove(slot.id);
    }
    slot = Slot();
  }
}

std::string EvdevOutput::summary() const {
  std::string line = name_;
  if (!file_) line += lost_ > 0 ? ", pulled out" : ", not found yet";
  if (lost_ > 0) line += ", was pulled out " + std::to_string(lost_) + " times";
  return line;
}

}  // namespace dance
