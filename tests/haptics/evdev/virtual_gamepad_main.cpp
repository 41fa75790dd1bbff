// A gamepad of the kernel's uinput and the orders that are to make it rumble, for
// virtual_gamepad.sh: says what the kernel brings to the device, and how late.
#include <fcntl.h>
#include <linux/uinput.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <vector>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr const char* kPadName = "DanceGraph virtual gamepad";
constexpr int kOrders = 40;
constexpr int kLengths = 60;
constexpr std::size_t kEffects = 16;
constexpr Duration kOften = Duration::ms(150);
// An emulated processor is slow.
constexpr Duration kPatience = Duration::s(90);

volatile std::sig_atomic_t is_over = 0;

void say(const char* text) {
  std::puts(text);
  std::fflush(stdout);
}

class VirtualGamepad {
 public:
  explicit VirtualGamepad(Bus& bus) : bus_(bus) {}
  ~VirtualGamepad() { unplug(); }
  VirtualGamepad(const VirtualGamepad&) = delete;
  VirtualGamepad& operator=(const VirtualGamepad&) = delete;

  bool plug() {
    fd_ = open("/dev/uinput", O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (fd_ < 0) return false;
    uinput_setup setup{};
    setup.id.bustype = BUS_VIRTUAL;
    setup.ff_effects_max = kEffects;
    std::strncpy(setup.name, kPadName, sizeof setup.name - 1);
    return ioctl(fd_, UI_SET_EVBIT, EV_KEY) >= 0 && ioctl(fd_, UI_SET_KEYBIT, BTN_SOUTH) >= 0 &&
           ioctl(fd_, UI_SET_EVBIT, EV_FF) >= 0 && ioctl(fd_, UI_SET_FFBIT, FF_RUMBLE) >= 0 &&
           ioctl(fd_, UI_DEV_SETUP, &setup) >= 0 && ioctl(fd_, UI_DEV_CREATE) >= 0;
  }
  void unplug() {
    if (fd_ < 0) return;
    ioctl(fd_, UI_DEV_DESTROY);
    close(fd_);
    fd_ = -1;
  }

  // Serves the kernel for so long, or until it is enough.
  bool serve(Duration length, const std::function<bool()>& is_enough) {
    for (const MonoTime begin = mono_now(); mono_now() - begin < length && is_over == 0;) {
      if (is_enough()) return true;
      pollfd waits{fd_, POLLIN, 0};
      if (poll(&waits, 1, 5) > 0) read_all();
    }
    return is_enough();
  }
  void serve(Duration length) {
    serve(length, [] { return false; });
  }

  void order(float amplitude, Duration ahead, Duration length) {
    Haptic haptic;
    haptic.time = mono_now();
    haptic.clock_id = this_clock_id();
    haptic.number = ++ordered_;
    haptic.play_time = haptic.time + ahead;
    haptic.duration = length;
    haptic.amplitude = amplitude;
    haptic.frequency_hz = 170.0f;
    haptic.bone = Bone::kLeftHand;
    due_[static_cast<int>(length.count_ms())] = haptic.play_time;
    bus_.publish(Where::kCapture, *GuestId::parse("alice"), haptic);
  }
  // Orders until one is played: one that this machine makes too late is left out by the player.
  bool is_felt(float amplitude = 0.3f, Duration length = Duration::ms(20)) {
    const int before = plays_;
    for (const MonoTime begin = mono_now(); mono_now() - begin < kPatience && is_over == 0;) {
      order(amplitude, Duration::ms(50), length);
      if (serve(Duration::ms(400), [&] { return plays_ > before; })) return true;
    }
    return false;
  }
  void forget() {
    due_.clear();
    late_ms_.clear();
    plays_ = stops_ = uploads_ = 0;
    weak_.clear();
  }

  int plays() const { return plays_; }
  int stops() const { return stops_; }
  int uploads() const { return uploads_; }
  const std::vector<int>& weak() const { return weak_; }
  std::vector<double>& late_ms() { return late_ms_; }

 private:
  void read_all() {
    input_event event{};
    while (read(fd_, &event, sizeof event) == sizeof event) {
      const MonoTime now = mono_now();
      if (event.type == EV_UINPUT && event.code == UI_FF_UPLOAD) {
        uinput_ff_upload upload{};
        upload.request_id = static_cast<std::uint32_t>(event.value);
        ioctl(fd_, UI_BEGIN_FF_UPLOAD, &upload);
        ++uploads_;
        weak_.push_back(upload.effect.u.rumble.weak_magnitude);
        length_of_[static_cast<std::size_t>(upload.effect.id) % kEffects] =
            upload.effect.replay.length;
        upload.retval = 0;
        ioctl(fd_, UI_END_FF_UPLOAD, &upload);
      } else if (event.type == EV_UINPUT && event.code == UI_FF_ERASE) {
        uinput_ff_erase erase{};
        erase.request_id = static_cast<std::uint32_t>(event.value);
        ioctl(fd_, UI_BEGIN_FF_ERASE, &erase);
        erase.retval = 0;
        ioctl(fd_, UI_END_FF_ERASE, &erase);
      } else if (event.type == EV_FF && event.value > 0) {
        ++plays_;
        const auto due = due_.find(length_of_[event.code % kEffects]);
        if (due == due_.end()) continue;
        late_ms_.push_back((now - due->second).as_ms());
        due_.erase(due);
      } else if (event.type == EV_FF && event.code < kEffects) {
        ++stops_;
      }
    }
  }

  Bus& bus_;
  int fd_ = -1;
  std::uint32_t ordered_ = 0;
  std::map<int, MonoTime> due_;  // by the length, in which a test's orders differ
  std::array<int, kEffects> length_of_{};
  std::vector<double> late_ms_;
  std::vector<int> weak_;
  int plays_ = 0, stops_ = 0, uploads_ = 0;
};

int run(const char* bus_url) {
  auto bus = Bus::open(bus_url);
  if (!bus) return std::fprintf(stderr, "%s\n", bus.error().what.c_str()), 1;
  VirtualGamepad pad(**bus);
  if (!pad.plug()) return std::fprintf(stderr, "no uinput: %s\n", std::strerror(errno)), 1;
  say("plugged in");
  if (!pad.is_felt()) return say("nothing is felt"), 1;
  say("is felt");

  pad.serve(Duration::ms(500));
  pad.forget();
  int orders = 0;
  for (const MonoTime begin = mono_now(); pad.plays() < kOrders && mono_now() - begin < kPatience;
       ++orders) {
    const int before = pad.plays();
    pad.order(0.5f, Duration::ms(100), Duration::ms(40 + orders % kLengths));
    pad.serve(Duration::s(2), [&] { return pad.plays() > before; });
    pad.serve(kOften);
  }
  std::vector<double> late = pad.late_ms();
  if (late.empty()) return say("nothing was played"), 1;
  std::sort(late.begin(), late.end());
  const auto [least, most] = std::minmax_element(pad.weak().begin(), pad.weak().end());
  std::printf(
      "played %d of %d, uploads %d, weak motor %d to %d, earliest %.2f ms, p50 %.2f ms, most "
      "%.2f ms\n",
      pad.plays(), orders, pad.uploads(), *least, *most, late.front(), late[late.size() / 2],
      late.back());

  // Two at once, beyond a limit of 0.6; again where one of them was left out.
  for (const MonoTime begin = mono_now(); mono_now() - begin < kPatience && is_over == 0;) {
    pad.serve(Duration::s(1));
    pad.forget();
    pad.order(0.5f, Duration::ms(100), Duration::s(5));
    if (pad.serve(Duration::s(2), [&] { return pad.uploads() >= 1; })) {
      pad.order(0.4f, Duration::ms(100), Duration::s(1));
      if (pad.serve(Duration::s(2), [&] { return pad.uploads() >= 2; })) break;
    }
    pad.serve(Duration::s(5));
  }
  std::printf("limited to");
  for (const int weak : pad.weak()) std::printf(" %.2f", weak / 65535.0);
  say("");

  pad.serve(Duration::s(5));
  pad.forget();
  if (!pad.is_felt(0.5f, Duration::s(5))) say("nothing is felt that lasts");
  say("wants off");
  say(pad.serve(kPatience, [&] { return pad.stops() >= 1; }) ? "stopped" : "was not stopped");
  pad.serve(Duration::s(1));
  const int plays = pad.plays();
  for (int i = 0; i < 5; ++i) {
    pad.order(0.5f, Duration::ms(50), Duration::ms(20));
    pad.serve(kOften);
  }
  say(pad.plays() == plays ? "silent while off" : "felt while off");
  say("wants on");
  say(pad.is_felt() ? "is felt again" : "is not felt again");

  pad.unplug();
  say("pulled out");
  usleep(5'000'000);
  if (!pad.plug()) return say("cannot be plugged in again"), 1;
  pad.forget();
  say(pad.is_felt() ? "found again" : "was not found again");
  say("over");
  pad.serve(kPatience, [] { return is_over != 0; });
  return 0;
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::signal(SIGTERM, [](int) { dance::is_over = 1; });
  return argc == 2 ? dance::run(argv[1]) : 2;
}
