#include "house/house_camera.h"

#include <algorithm>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kCameraLook = Duration::ms(200);
constexpr Duration kCameraPause = Duration::s(1);  // before one that died is started again
constexpr Duration kCameraMissing =
    Duration::s(10);  // before one that found no camera is, and at most
constexpr Duration kCameraStable = Duration::s(30);  // it ran so long: its death was a chance
constexpr Duration kCameraEnds = Duration::s(2);

}  // namespace

std::vector<std::string> camera_arguments(const HostedCamera& camera, const std::string& bus) {
  std::vector<std::string> words{"--bus", bus, "--guest", std::string(camera.guest.view())};
  const auto add = [&](const char* option, const std::string& value) {
    if (value.empty()) return;
    words.emplace_back(option);
    words.push_back(value);
  };
  add("--model", camera.model);
  add("--calibration", camera.calibration);
  if (camera.height_m > 0.0) add("--height", std::to_string(camera.height_m));
  if (camera.mirror) words.emplace_back("--mirror");
  // Behind a mark, as a file's name may begin with a dash.
  words.emplace_back("--");
  if (!camera.device.empty()) words.push_back(camera.device);
  return words;
}

std::unique_ptr<HouseCamera> HouseCamera::open(const HostedCamera& camera, const std::string& bus,
                                               Poller& poller) {
  std::unique_ptr<HouseCamera> made(new HouseCamera(camera, bus, poller));
  if (auto started = made->start(); !started) {
    talk::warn("{}; {} dances without a camera", started.error().what, camera.guest.view());
    return made;
  }
  made->watch_ = poller.add_timer(mono_now() + kCameraLook,
                                  [self = made.get()](MonoTime now) { return self->look(now); });
  return made;
}

HouseCamera::HouseCamera(const HostedCamera& camera, const std::string& bus, Poller& poller)
    : guest_(camera.guest),
      arguments_(camera_arguments(camera, bus)),
      poller_(poller),
      started_(mono_now()),
      pause_(kCameraPause / 2) {}

HouseCamera::~HouseCamera() {
  if (!program_) return;
  poller_.set_deadline(watch_, MonoTime());
  program_->stop(kCameraEnds);
}

Result<void> HouseCamera::start() {
  DANCE_TRY(ChildProcess program,
            ChildProcess::start({program_folder() + "/dance-capture", arguments_, "", ""}));
  program_ = std::make_unique<ChildProcess>(std::move(program));
  return {};
}

MonoTime HouseCamera::look(MonoTime now) {
  if (is_down_) {
    is_down_ = false;
    started_ = now;
    if (auto started = start(); !started) {
      talk::warn("{}; {} dances without a camera", started.error().what, guest_.view());
      return MonoTime();
    }
    return now + kCameraLook;
  }
  if (!program_->has_ended()) return now + kCameraLook;
  if (program_->ended_well()) {
    talk::info("the capture of {} is over", guest_.view());
    return MonoTime();
  }
  if (program_->exit_code() == 2) {
    talk::warn("no camera for {}: the session file asks for what dance capture does not know",
               guest_.view());
    return MonoTime();
  }
  is_down_ = true;
  if (program_->exit_code() == 1) {
    if (!has_said_missing_)
      talk::warn(
          "no poses from the camera of {} yet, for what dance capture says; the house goes on and "
          "tries again",
          guest_.view());
    has_said_missing_ = true;
    return now + kCameraMissing;
  }
  // One that danced for a while may come back at once; one that dies each time is not to keep the
  // machine busy.
  pause_ = now - started_ > kCameraStable ? kCameraPause : std::min(pause_ * 2, kCameraMissing);
  talk::warn("the capture of {} {}; it is started again", guest_.view(), program_->exit_text());
  return now + pause_;
}

}  // namespace dance
