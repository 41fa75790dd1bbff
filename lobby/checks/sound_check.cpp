#include "lobby/checks/sound_check.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/base/fixed_string.h"
#include "core/base/latest.h"
#include "core/base/printable.h"
#include "core/base/spsc_ring.h"
#include "core/net/mono_clock.h"
#include "core/sound/pulse_server.h"
#include "lobby/checks/sound_thread.h"

namespace dance {
namespace {

constexpr Duration kReportEvery = Duration::ms(50);
constexpr auto kPause = std::chrono::milliseconds(20);
constexpr auto kPauseWhilePlaying = std::chrono::milliseconds(5);

using DeviceName = FixedString<255>;

struct SoundCommand {
  enum class What { kChoose, kCountIn, kRoundTrip };
  What what = What::kChoose;
  DeviceName microphone;
  DeviceName loudspeaker;
};

// A name that is longer than any device's is no device's when it is cut either.
DeviceName device_name(const std::string& name) {
  DeviceName cut;
  if (!cut.assign(std::string_view(name).substr(0, 255))) return {};
  return cut;
}

class PulseSoundCheck : public SoundCheck {
 public:
  explicit PulseSoundCheck(const SoundChoice& choice)
      : event_fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    thread_ = std::thread([this, choice] { run(choice); });
  }
  ~PulseSoundCheck() override {
    stop_ = true;
    thread_.join();
    if (event_fd_ >= 0) ::close(event_fd_);
  }

  void choose(const SoundChoice& choice) override {
    commands_.push({SoundCommand::What::kChoose, device_name(choice.microphone),
                    device_name(choice.loudspeaker)});
    shown_.round_trip.reset();
  }
  void play_count_in() override { commands_.push({SoundCommand::What::kCountIn, {}, {}}); }
  void measure_round_trip() override {
    commands_.push({SoundCommand::What::kRoundTrip, {}, {}});
    shown_.round_trip.reset();
  }

  int fd() const override { return event_fd_; }
  void read(MonoTime) override {
    std::uint64_t count = 0;
    if (event_fd_ >= 0 && ::read(event_fd_, &count, sizeof count) < 0) count = 0;
    const SoundReport* newest = reports_.take();
    if (newest == nullptr) return;
    shown_ = *newest;
    const bool has_echo = shown_.round_trip && shown_.round_trip->is_heard;
    advice_ = advise(shown_.state, shown_.level, has_echo);
  }

  const SoundLevel& level() const override { return shown_.level; }
  bool is_playing() const override { return shown_.is_playing; }
  const std::optional<RoundTrip>& round_trip() const override { return shown_.round_trip; }
  std::span<const ListedSound> microphones() const override { return shown_.microphones; }
  std::span<const ListedSound> loudspeakers() const override { return shown_.loudspeakers; }
  std::span<const Text> advice() const override { return advice_.view(); }

 private:
  void run(const SoundChoice& choice) {
    SoundThread sound(choice);
    MonoTime next_report;
    while (!stop_) {
      while (const auto command = commands_.pop()) obey(sound, *command);
      const MonoTime now = mono_now();
      sound.work(now);
      if (now >= next_report) {
        next_report = now + kReportEvery;
        reports_.put(sound.report());
        const std::uint64_t one = 1;
        // Full: its reader has much to read already.
        if (event_fd_ >= 0 && ::write(event_fd_, &one, sizeof one) < 0) continue;
      }
      std::this_thread::sleep_for(sound.report().is_playing ? kPauseWhilePlaying : kPause);
    }
  }
  static void obey(SoundThread& sound, const SoundCommand& command) {
    switch (command.what) {
      case SoundCommand::What::kChoose:
        return sound.choose(
            {std::string(command.microphone.view()), std::string(command.loudspeaker.view())});
      case SoundCommand::What::kCountIn:
        return sound.play_count_in();
      case SoundCommand::What::kRoundTrip:
        return sound.measure_round_trip();
    }
  }

  int event_fd_;
  SpscRing<SoundCommand, 16> commands_;
  Latest<SoundReport> reports_;
  std::atomic<bool> stop_{false};
  // The owner's side.
  SoundReport shown_;
  SoundAdvice advice_;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<SoundCheck> SoundCheck::start(const SoundChoice& choice) {
  return std::make_unique<PulseSoundCheck>(choice);
}

std::string sound_server_error() {
  const auto server = PulseServer::connect("lobby");
  return server ? "" : printable(server.error().what);
}

}  // namespace dance
