#include "consumers/vrchat/vrchat_consumer.h"

namespace dance {

Result<std::unique_ptr<PoseConsumer>> VrchatConsumer::open(const ConsumerOptions& options) {
  DANCE_TRY(OscOutput output, OscOutput::open(options.address, kUsualAddress));
  return std::unique_ptr<PoseConsumer>(new VrchatConsumer(options, std::move(output)));
}

VrchatConsumer::VrchatConsumer(const ConsumerOptions& options, OscOutput output)
    : guest_(options.guest), rate_(options.hz), output_(std::move(output)), writer_(output_) {}

void VrchatConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime) {
  if (!guest_.takes_pose_of(guest)) return;
  if (!rate_.lets_through(guest, pose.capture_time)) {
    ++above_rate_;
    return;
  }
  writer_.write_pose(pose);
  ++frames_;
}

void VrchatConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime) {
  if (guest_.takes(guest)) writer_.set_skeleton(skeleton);
}

std::string VrchatConsumer::summary() const {
  std::string line = "vrchat: " + std::to_string(frames_) + " poses of " +
                     (guest_.guest().is_set() ? std::string(guest_.guest().view()) : "nobody") +
                     " " + output_.summary();
  if (above_rate_ > 0)
    line += "; " + std::to_string(above_rate_) + " poses above the rate left out";
  if (guest_.others() > 0)
    line += "; " + std::to_string(guest_.others()) +
            " poses of other guests left out: VRChat takes one body";
  return line;
}

}  // namespace dance
