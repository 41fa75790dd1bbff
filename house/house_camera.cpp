#include "house/house_camera.h"

#include "core/program/program.h"

namespace dance {
namespace {

// `newest_pose` is when one of its dancers came last.
HostedProgram::Options camera_program(const HostedCamera& camera, const std::string& bus,
                                      const MonoTime& newest_pose) {
  HostedProgram::Options options;
  options.path = program_folder() + "/dance-capture";
  options.name = "dance capture of " + std::string(camera.guest.view());
  options.without = "without that camera";
  options.arguments = [words = camera_arguments(camera, bus)] { return words; };
  options.works = [&newest_pose](pid_t, MonoTime started) { return newest_pose > started; };
  return options;
}

}  // namespace

std::vector<std::string> camera_arguments(const HostedCamera& camera, const std::string& bus) {
  std::string guests(camera.guest.view()), heights = std::to_string(camera.height_m);
  bool has_height = camera.height_m > 0.0;
  for (const HostedCamera::Partner& partner : camera.partners) {
    guests += "," + std::string(partner.guest.view());
    heights += "," + std::to_string(partner.height_m);
    has_height = has_height || partner.height_m > 0.0;
  }
  std::vector<std::string> words{"--bus", bus, "--guest", guests};
  const auto add = [&](const char* option, const std::string& value) {
    if (value.empty()) return;
    words.emplace_back(option);
    words.push_back(value);
  };
  add("--also", camera.also);
  add("--model", camera.model);
  add("--calibration", camera.calibration);
  if (has_height) add("--height", heights);
  if (camera.mirror) words.emplace_back("--mirror");
  if (!camera.hands) add("--hands", "off");
  if (camera.face) words.emplace_back("--face");
  // Behind a mark, as a file's name may begin with a dash.
  words.emplace_back("--");
  if (!camera.device.empty()) words.push_back(camera.device);
  return words;
}

HouseCamera::HouseCamera(const HostedCamera& camera, const std::string& bus, SignalPort& port,
                         Poller& poller)
    : program_(camera_program(camera, bus, newest_pose_), poller) {
  const auto listen = [&](const GuestId& guest) {
    port.subscribe<Pose>({Where::kCapture, guest},
                         [this](const Channel&, const Pose&, MonoTime now) { newest_pose_ = now; });
  };
  listen(camera.guest);
  for (const HostedCamera::Partner& partner : camera.partners) listen(partner.guest);
}

}  // namespace dance
