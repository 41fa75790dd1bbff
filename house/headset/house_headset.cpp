#include "house/headset/house_headset.h"

#include "core/program/program.h"

namespace dance {
namespace {

HostedProgram::Options headset_program(const HostedHeadset& headset, const std::string& bus,
                                       const MonoTime& newest_pose) {
  HostedProgram::Options options;
  options.path = program_folder() + "/dance-headset";
  options.name = "dance headset of " + std::string(headset.guest.view());
  options.without = "without that headset";
  options.arguments = [words = headset_arguments(headset, bus)] { return words; };
  options.works = [&newest_pose](pid_t, MonoTime started) { return newest_pose > started; };
  return options;
}

}  // namespace

HouseHeadset::HouseHeadset(const HostedHeadset& headset, const std::string& bus, SignalPort& port,
                           Poller& poller)
    : program_(headset_program(headset, bus, newest_pose_), poller) {
  port.subscribe<Pose>({Where::kCapture, headset.guest},
                       [this](const Channel&, const Pose&, MonoTime now) { newest_pose_ = now; });
}

}  // namespace dance
