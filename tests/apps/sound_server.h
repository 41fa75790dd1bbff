// A sound server of the test's own, with a loudspeaker that goes nowhere and can be listened to,
// for tests that play real sound; and the clicks that are heard on it.
//
// Units/frames: times of this machine's monotonic clock.
// Ownership:    the server ends with the object. PULSE_SERVER of this process names it, for
//               children too.
// Threads:      one.
// Failure:      is_there() is false where PulseAudio is not installed: skip.
#pragma once

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/program/child_process.h"
#include "core/sound/pulse_input.h"
#include "tests/apps/run_program.h"

namespace dance {

class SoundServer {
 public:
  static bool is_there() { return std::filesystem::exists("/usr/bin/pulseaudio"); }

  explicit SoundServer(const TestFolder& folder) {
    const std::string home = folder.path("pulse");
    std::filesystem::create_directories(home);
    std::filesystem::permissions(home, std::filesystem::perms::owner_all);
    const std::string socket = home + "/native";
    // NOLINTBEGIN(concurrency-mt-unsafe): one thread
    ::setenv("XDG_RUNTIME_DIR", home.c_str(), 1);
    ::setenv("HOME", home.c_str(), 1);
    ::setenv("PULSE_SERVER", ("unix:" + socket).c_str(), 1);
    // NOLINTEND(concurrency-mt-unsafe)
    auto child =
        ChildProcess::start({"/usr/bin/pulseaudio",
                             {"-n", "--exit-idle-time=-1", "--disable-shm=true", "-L",
                              "module-null-sink sink_name=dance rate=48000", "-L",
                              "module-native-protocol-unix socket=" + socket + " auth-anonymous=1"},
                             folder.path("pulse/output"),
                             folder.path("pulse/talk")});
    if (!child) return;
    child_ = std::make_unique<ChildProcess>(std::move(*child));
    is_open_ = wait_for([&] {
      server_ = PulseServer::connect("test").value_or(nullptr);
      return server_ != nullptr;
    });
  }
  ~SoundServer() {
    ear_.reset();
    server_.reset();
    if (child_) child_->stop(Duration::s(5));
    ::unsetenv("PULSE_SERVER");  // NOLINT(concurrency-mt-unsafe): one thread
  }
  SoundServer(const SoundServer&) = delete;
  SoundServer& operator=(const SoundServer&) = delete;

  bool is_open() const { return is_open_; }
  // The server hangs: the kernel accepts connections for it, and nothing is answered.
  void suspend() { child_->send_signal(SIGSTOP); }
  void resume() { child_->send_signal(SIGCONT); }

  // From now on clicks are listened for.
  bool listen() {
    ear_ = PulseInput::open(*server_, {"dance.monitor", kRate_hz},
                            [this](std::span<const float> samples) {
                              for (const float sample : samples) hear(sample);
                            })
               .value_or(nullptr);
    return ear_ != nullptr;
  }
  void work() {
    server_->iterate();
    if (ear_ && ++turns_ % 10 == 0) ear_->request_timing();
  }
  std::vector<MonoTime> clicks() const {
    std::vector<MonoTime> times;
    for (const std::int64_t frame : clicks_) times.push_back(ear_->time_of(frame));
    return times;
  }

 private:
  static constexpr double kRate_hz = 48000.0;
  static constexpr std::int64_t kQuiet_frames = 4800;

  void hear(float sample) {
    ++frame_;
    if (sample > -0.2f && sample < 0.2f) return;
    if (frame_ - loud_ > kQuiet_frames) clicks_.push_back(frame_ - 1);
    loud_ = frame_;
  }

  bool is_open_ = false;
  std::unique_ptr<ChildProcess> child_;
  std::unique_ptr<PulseServer> server_;
  std::unique_ptr<PulseInput> ear_;
  int turns_ = 0;
  std::int64_t frame_ = 0;
  std::int64_t loud_ = -kQuiet_frames;
  std::vector<std::int64_t> clicks_;
};

}  // namespace dance
